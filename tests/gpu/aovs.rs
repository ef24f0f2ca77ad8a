//! What the camera sees first: against a closed form, and the kernel against the reference.

use super::*;
use crate::common::scenes::*;
use glam::{Affine3A, Vec3};
use luminaire::film::{AovSum, Aovs, Tile};
use luminaire::picture::Values;
use luminaire::reference::Reference;
use luminaire::render::{self, Tracer};
use luminaire::scene::Material;
use luminaire::scene::build::{add, empty, lamp, matte, quad};

/// The layers of a whole film.
fn aovs(tracer: &mut dyn Tracer, size: (u32, u32), samples: u32) -> luminaire::Result<Aovs> {
    let never = std::sync::atomic::AtomicBool::new(false);
    Ok(render::aovs(tracer, size, samples, &never)?.expect("nobody stopped it"))
}

/// A wall three units away that covers the left half of the picture: depth along the line of sight, its normal, its albedo.
#[test]
fn a_wall_in_half_of_the_picture() {
    let mut scene = empty(16, 12);
    let wall = quad(Vec3::new(-9.0, -9.0, -3.0), Vec3::new(9.0, 0.0, 0.0), Vec3::new(0.0, 18.0, 0.0));
    add(&mut scene, wall, matte([0.25, 0.5, 0.75]), Affine3A::IDENTITY);
    let behind = quad(Vec3::new(-1.0, -1.0, 5.0), Vec3::X, Vec3::Y);
    add(&mut scene, behind, lamp([1.0; 3]), Affine3A::IDENTITY);
    let check = |tracer: &mut dyn Tracer| {
        let found = aovs(tracer, (16, 12), 9).unwrap();
        let channels = found.channels();
        let value =
            |name: &str, pixel: usize| match &channels.iter().find(|(n, _)| n == name).expect("the channel is there").1
            {
                Values::Float(values) => values[pixel],
                Values::Integer(values) => values[pixel] as f32,
            };
        for pixel in 0..16 * 12 {
            let left = pixel % 16 < 8;
            let expected =
                [("albedo.R", 0.25), ("albedo.G", 0.5), ("albedo.B", 0.75), ("N.X", 0.0), ("N.Y", 0.0), ("N.Z", 1.0)];
            for (name, on_the_wall) in expected {
                let expected = if left { on_the_wall } else { 0.0 };
                assert!(
                    (value(name, pixel) - expected).abs() < 1e-6,
                    "{name} of pixel {pixel}: {}",
                    value(name, pixel)
                );
            }
            let depth = value("Z", pixel);
            assert!(if left { (depth - 3.0).abs() < 1e-5 } else { depth == 1e10 }, "depth of pixel {pixel}: {depth}");
            assert_eq!(found.sums[pixel].hits, if left { 9 } else { 0 });
        }
    };
    check(&mut Reference::new(&scene));
    on_every_backend(|backend| check(&mut backend.tracer(&scene)));
}

/// The same rays hit the same surfaces: glass, textures, holes, instances, vertex normals.
#[test]
fn first_hits_are_the_references() {
    let (width, height, samples) = (40, 30, 8);
    for scene in
        [cornell_like(width, height), glass_room(width, height), textured_room(width, height), open_air(width, height)]
    {
        let expected = aovs(&mut Reference::new(&scene), (width, height), samples).unwrap();
        assert!(expected.sums.iter().any(|sum| sum.hits == samples));
        on_every_backend(|backend| {
            let found = aovs(&mut backend.tracer(&scene), (width, height), samples).unwrap();
            let numbers = |sum: &AovSum| {
                let [a, b, c] = sum.albedo;
                let [x, y, z] = sum.normal;
                [a, b, c, x, y, z, sum.depth, sum.hits as f32]
            };
            // A ray that just misses an edge on one side hits it on the other.
            let differ = (expected.sums.iter().zip(&found.sums))
                .filter(|(e, f)| numbers(e).iter().zip(numbers(f)).any(|(e, f)| (e - f).abs() > 1e-3 * (1.0 + e.abs())))
                .count();
            assert!(differ <= 3, "{} on {}: {differ} pixels differ", scene.path.display(), backend.name());
        });
    }
}

/// Plastic is as bright as its base and what the coat reflects from straight above; where a map makes the base black, there is no jump. Nor is
/// there on what is all coat. Glass has the larger one of its two.
#[test]
fn the_albedo_of_plastic_has_no_jump_at_black() {
    let plastic = Material { reflection: Vec3::ONE, eta: Some(1.5), ..matte(Vec3::ONE) };
    let glass = Material { transmission: Vec3::splat(0.5), ..matte(Vec3::splat(0.25)) };
    let glass = Material { reflection: Vec3::splat(0.25), eta: Some(1.5), ..glass };
    let bare = Material { lambert: Vec3::ZERO, ..plastic.clone() };
    for (material, texel, expected) in [
        (&plastic, 0.0f32, 0.04),
        (&plastic, 1.0 / 256.0, 0.04 + 0.96 / 256.0),
        (&plastic, 0.5, 0.52),
        (&bare, 1.0, 0.04),
        (&glass, 1.0, 0.75),
    ] {
        let mut scene = empty(4, 4);
        let mut wall = quad(Vec3::new(-9.0, -9.0, -3.0), Vec3::new(18.0, 0.0, 0.0), Vec3::new(0.0, 18.0, 0.0));
        wall.uvs = vec![glam::Vec2::ZERO; wall.positions.len()];
        scene.textures.push(texture(1, 1, |_, _| [texel, texel, texel, 1.0]).into());
        let mut material = material.clone();
        material.maps.lambert = (material.lambert != Vec3::ZERO).then_some(0);
        add(&mut scene, wall, material, Affine3A::IDENTITY);
        let behind = quad(Vec3::new(-1.0, -1.0, 5.0), Vec3::X, Vec3::Y);
        add(&mut scene, behind, lamp([1.0; 3]), Affine3A::IDENTITY);
        let check = |name: &str, tracer: &mut dyn Tracer| {
            for sum in aovs(tracer, (4, 4), 4).unwrap().sums {
                let found = sum.albedo[0] / sum.hits as f32;
                assert!(sum.hits == 4 && (found - expected).abs() < 1e-5, "{name}, {texel}: {found}, {expected}");
            }
        };
        check("reference", &mut Reference::new(&scene));
        on_every_backend(|backend| check(backend.name(), &mut backend.tracer(&scene)));
    }
}

/// A piece of the film, and samples from the middle.
#[test]
fn tiles_and_samples_are_those_that_were_asked_for() {
    let scene = cornell_like(40, 30);
    let tile = Tile { x: 7, y: 11, width: 13, height: 5 };
    let expected = Reference::new(&scene).aovs(tile, 5..9).unwrap();
    assert_eq!(expected.len(), 65);
    on_every_backend(|backend| {
        let found = backend.tracer(&scene).aovs(tile, 5..9).unwrap();
        assert_eq!(found.len(), 65);
        let near = expected.iter().zip(&found).filter(|(e, f)| (e.depth - f.depth).abs() < 1e-3 * e.depth).count();
        assert!(near >= 64, "{near} of 65 on {}", backend.name());
    });
}
