//! Scenes for the light tree: lamps of all kinds around a point, and ones that are hard on numbers.

use super::scenes::*;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::reference::surfel::Surfel;
use luminaire::sampling::{random4, uniform};
use luminaire::scene::*;

/// The surface at `position` with this normal.
pub fn surface(position: DVec3, normal: DVec3) -> Surfel {
    let up = flat_surfel(DVec3::ONE, DVec3::ZERO, 1.0);
    Surfel { position, geometric_normal: normal, shading_normal: normal, ..up }
}

/// A surface in a box about the origin.
pub fn some_surface(number: u32, size: f64) -> Surfel {
    let unit = |block| random4(number, 0, block, 5).map(|bits| 2.0 * uniform(bits) - 1.0);
    let ([x, y, z, _], [a, b, c, _]) = (unit(0), unit(1));
    // Rounded as the kernel gets them.
    let normal = DVec3::new(a, b, c).normalize_or(DVec3::Y).as_vec3().as_dvec3();
    surface((size * DVec3::new(x, y, z)).as_vec3().as_dvec3(), normal)
}

/// A sky, parallel light, two points, two instances of a closed ball, a one-sided panel, a strip of two-sided triangles that a part of a mesh
/// emits, and a lamp that gets its light from the object; the same in units of `unit`.
pub fn assorted(unit: f32) -> Scene {
    let mut scene = empty(8, 8);
    let place = |x, y, z, r: f32| {
        Affine3A::from_translation(unit * Vec3::new(x, y, z)) * Affine3A::from_scale(Vec3::splat(r * unit))
    };
    let ball = add(&mut scene, icosphere(1), lamp(Vec3::new(2.0, 1.0, 0.5)), place(2.0, 1.0, 0.0, 0.5));
    add_instance(&mut scene, ball, lamp(Vec3::new(1.0, 2.0, 4.0)), place(-2.0, 1.5, 1.0, -0.25));
    let panel = quad(Vec3::new(-1.0, 0.0, -1.0), Vec3::X * 2.0, Vec3::Z * 2.0);
    let downwards = Material { one_sided: true, ..lamp(Vec3::splat(0.7)) };
    add(&mut scene, panel, downwards, place(0.0, 3.0, 0.0, 1.0));
    let mut strip = quad(Vec3::new(-1.0, -1.0, -2.0), Vec3::X * 0.125, Vec3::Y * 0.25);
    let (positions, triangles) = (strip.positions.clone(), strip.triangles.clone());
    for step in 1..20u32 {
        let moved = Vec3::X * 0.25 * step as f32;
        strip.positions.extend(positions.iter().map(|p| *p + moved));
        strip.triangles.extend(triangles.iter().map(|t| Triangle { vertices: t.vertices.map(|v| v + 4 * step), ..*t }));
    }
    // Every third triangle is dark.
    let bright = scene.materials.len() as u32;
    scene.materials.extend([lamp(Vec3::new(0.1, 3.0, 0.2)), matte(Vec3::ONE)]);
    for (index, triangle) in strip.triangles.iter_mut().enumerate() {
        triangle.material = bright + u32::from(index % 3 == 0);
    }
    scene.meshes.push(strip.into());
    let mesh = scene.meshes.len() as u32 - 1;
    scene.objects.push(Object {
        name: "strip".into(),
        mesh,
        object_to_world: place(0.0, 0.0, 0.0, 1.0),
        material: None,
    });
    add(&mut scene, cube(), lamp(Vec3::new(0.3, 0.2, 4.0)), place(0.0, -2.0, 2.0, 0.25));
    let intensity = Vec3::splat(unit * unit);
    scene.luminaires.push(Luminaire::Point { position: unit * Vec3::new(0.5, 2.0, 0.5), intensity });
    scene.luminaires.push(Luminaire::Infinite { direction: -Vec3::Y, irradiance: Vec3::new(0.1, 0.2, 0.3) });
    scene
        .luminaires
        .push(Luminaire::Point { position: unit * Vec3::new(-2.0, -1.0, -2.0), intensity: 0.5 * intensity });
    let spot = |x: f32, direction: Vec3, outer| Luminaire::Spot {
        position: unit * Vec3::new(x, 1.0, -1.0),
        direction,
        intensity: 3.0 * intensity,
        inner: 0.5 * outer,
        outer,
    };
    scene.luminaires.extend([
        spot(-1.0, -Vec3::Y, 20.0),
        spot(1.0, Vec3::new(0.6, 0.0, -0.8), 60.0),
        Luminaire::Sun { direction: Vec3::new(0.6, -0.8, 0.0), irradiance: Vec3::splat(0.2), angle: 20.0 },
        Luminaire::Photometric {
            position: unit * Vec3::new(0.5, 1.5, 2.5),
            direction: -Vec3::Y,
            up: Vec3::X,
            intensity: 0.5 * intensity,
            profile: super::stage::profile(),
        },
        spot(0.0, Vec3::Z, 90.0),
    ]);
    scene.environment = Some(Environment { radiance: Vec3::splat(0.02), image: None, rotation: 0.0 });
    scene
}

/// Name and scene, with the size of a box in which to look: assorted lamps of all sizes, thousands in one place, powers that differ by as much as
/// `f32` holds, lamps each a tenth as far away as the one before, triangles without an area among others.
#[allow(dead_code)] // Not where the kernel is tested.
pub fn hard() -> Vec<(&'static str, Scene, f64)> {
    let mut scenes =
        vec![("assorted", assorted(1.0), 3.0), ("tiny", assorted(1e-16), 3e-16), ("huge", assorted(1e13), 3e13)];
    let triangles = |corners: Vec<Vec3>| {
        let faces: Vec<[u32; 3]> = (0..corners.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        mesh(corners, &faces)
    };
    let mut one_place = empty(1, 1);
    let corners = (0..5000).flat_map(|_| [Vec3::X, Vec3::Y, Vec3::Z]).collect();
    add(&mut one_place, triangles(corners), lamp(Vec3::ONE), Affine3A::IDENTITY);
    scenes.push(("one place", one_place, 2.0));
    let mut powers = empty(1, 1);
    for step in 0..60 {
        let position = Vec3::new((step % 8) as f32, (step / 8) as f32, 1.0);
        let intensity = Vec3::splat(10f32.powi(step - 30));
        powers.luminaires.push(Luminaire::Point { position, intensity });
    }
    scenes.push(("powers", powers, 8.0));
    let mut row = empty(1, 1);
    for step in 0..50 {
        let position = Vec3::X * 10f32.powf(0.5 * (step - 25) as f32);
        row.luminaires.push(Luminaire::Point { position, intensity: Vec3::ONE });
    }
    scenes.push(("row", row, 1.0));
    let mut flat = empty(1, 1);
    let corners = (0..300).flat_map(|i| {
        let at = Vec3::new(i as f32, 1.0, 0.0);
        [at, at + Vec3::X * 0.5, if i % 3 == 0 { at } else { at + Vec3::new(0.25, 0.1, 1e-5 * i as f32) }]
    });
    add(&mut flat, triangles(corners.collect()), lamp(Vec3::ONE), Affine3A::IDENTITY);
    scenes.push(("degenerate", flat, 300.0));
    scenes
}
