//! A scene of luminaires that have a shape in direction.

use super::scenes::*;
use glam::{Affine3A, Vec3};
use luminaire::scene::*;
use std::f32::consts::FRAC_1_SQRT_2;
use std::sync::Arc;

/// A lamp that hangs, with other intensities to each side, upwards too.
pub fn profile() -> Arc<Profile> {
    let vertical = vec![0.0, 20.0, 45.0, 90.0, 130.0];
    let horizontal = vec![0.0, 90.0, 120.0, 270.0, 360.0];
    let candela = |row: usize, column: usize| 1.0 + ((3 * row + 5 * column) % 7) as f32 - 0.5 * column as f32;
    let last = horizontal.len() - 1;
    let rows = (0..=last).map(|row| if row == last { 0 } else { row });
    let candela = rows.flat_map(|row| (0..5).map(move |column| candela(row, column).max(0.0))).collect();
    Profile { name: "lamp.ies".into(), vertical, horizontal, candela }.into()
}

/// The room of [`cornell_like`] without walls, ceiling and lamp: two discs at infinity that overlap, one of them low, parallel light, a sky of one colour, a soft
/// spot and a sharp one, and a photometric lamp that is turned; a mirror in which the discs are seen, and the camera sees one.
pub fn stage(width: u32, height: u32) -> Scene {
    let mut scene = cornell_like(width, height);
    scene.objects.retain(|object| ![1, 2, 3, 4, 5, 6].contains(&object.mesh));
    let mirror = Material { reflection: Vec3::new(0.9, 0.8, 0.7), ..matte(Vec3::splat(0.1)) };
    let place = Affine3A::from_translation(Vec3::new(0.5, -1.5, 1.0)) * Affine3A::from_scale(Vec3::splat(0.375));
    add(&mut scene, icosphere(2), mirror, place);
    let direction = |x, y, z| Vec3::new(x, y, z).normalize();
    scene.luminaires = vec![
        Luminaire::Sun { direction: direction(0.5, -1.0, -0.3), irradiance: Vec3::new(2.0, 1.8, 1.5), angle: 12.0 },
        Luminaire::Spot {
            position: Vec3::new(-1.5, 1.0, 1.0),
            direction: direction(0.5, -1.0, -0.5),
            intensity: Vec3::new(3.0, 1.0, 1.0),
            inner: 10.0,
            outer: 30.0,
        },
        Luminaire::Infinite { direction: -Vec3::Y, irradiance: Vec3::splat(0.2) },
        Luminaire::Photometric {
            position: Vec3::new(1.25, 0.5, 0.5),
            direction: direction(-0.5, -1.0, -0.25),
            up: direction(0.0, FRAC_1_SQRT_2, FRAC_1_SQRT_2),
            intensity: Vec3::new(0.2, 0.3, 0.5),
            profile: profile(),
        },
        Luminaire::Sun { direction: direction(0.6, -1.0, -0.3), irradiance: Vec3::new(0.5, 1.0, 2.0), angle: 25.0 },
        Luminaire::Spot {
            position: Vec3::new(0.0, 1.5, 0.0),
            direction: -Vec3::Y,
            intensity: Vec3::new(1.0, 4.0, 1.0),
            inner: 15.0,
            outer: 15.0,
        },
        Luminaire::Sun { direction: direction(0.3, 0.1, 1.0), irradiance: Vec3::new(0.3, 0.2, 0.4), angle: 40.0 },
    ];
    scene.environment = Some(Environment { radiance: Vec3::new(0.1, 0.15, 0.25), image: None, rotation: 0.0 });
    scene
}
