//! Bodies that absorb: some that glow, some with holes. What comes out of them is known.

use super::scenes::*;
use glam::{Affine3A, DVec3, Vec2, Vec3};
use luminaire::scene::*;

/// What is left of white light behind a unit of length in the bodies here.
pub const COLOR: DVec3 = DVec3::new(0.75, 0.5, 0.25);

/// A body that absorbs; without roughness and with an index of 1 nothing is reflected or bent.
pub fn body(roughness: f32, ior: f32) -> Material {
    let physical = Physical {
        roughness,
        ior,
        transmission: 1.0,
        attenuation_color: COLOR.as_vec3(),
        attenuation_distance: 1.0,
        ..Physical::default()
    };
    Material { physical: Some(physical), ..Material::default() }
}

/// A tiny plate of albedo 0.5 in the middle of a ball of radius 1 that glows with 2, lets through and absorbs, under a white sky; seen from inside or, through what
/// the ball transmits and its holes, from outside. With what is seen: between these.
pub fn plate_in_a_glowing_ball(opacity: f32, outside: bool) -> (Scene, [DVec3; 2]) {
    let mut scene = empty(4, 4);
    let distance = if outside { 4.0 } else { 0.25 };
    scene.sensor = pinhole(Vec3::Y * distance, Vec3::ZERO, Vec3::Z, 0.01);
    let ball = icosphere(3);
    // Facets are nearer than the corners.
    let near = ball.triangles.iter().map(|t| {
        let [a, b, c] = t.vertices.map(|v| ball.positions[v as usize].as_dvec3());
        (b - a).cross(c - a).normalize().dot(a).abs()
    });
    let near = near.fold(1.0, f64::min);
    add(&mut scene, ball, Material { emission: Vec3::splat(2.0), opacity, ..body(0.0, 1.0) }, Affine3A::IDENTITY);
    let half = 1.0 / 1024.0;
    let plate = quad(Vec3::new(-half, 0.0, half), Vec3::X * 2.0 * half, Vec3::Z * -2.0 * half);
    add(&mut scene, plate, matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    // The sky comes through holes and through what is there, which glows.
    let around = 0.5 * (1.0 + 2.0 * f64::from(opacity));
    let seen = |radiance: DVec3, passed: DVec3| {
        if outside { 2.0 * f64::from(opacity) + passed * radiance } else { radiance }
    };
    (scene, [1.0, near].map(|way| seen(around * COLOR.powf(way), COLOR.powf(way))))
}

/// A rough, glowing ball that absorbs, with a plate in it and one beside it, seen from outside.
pub fn plate_in_a_rough_ball(width: u32, height: u32, opacity: f32) -> Scene {
    let mut scene = empty(width, height);
    scene.sensor = pinhole(Vec3::new(0.0, 2.5, 2.5), Vec3::new(0.0, -0.25, 0.0), Vec3::Y, 24.0);
    let glowing = Material { emission: Vec3::new(1.0, 1.5, 2.0), opacity, ..body(0.5, 1.3) };
    add(&mut scene, icosphere(1), glowing, Affine3A::IDENTITY);
    let across = |y: f32, half: f32| quad(Vec3::new(-half, y, half), Vec3::X * 2.0 * half, Vec3::Z * -2.0 * half);
    add(&mut scene, across(-0.25, 0.6), matte(Vec3::splat(0.8)), Affine3A::IDENTITY);
    add(&mut scene, across(-1.25, 1.5), matte(Vec3::splat(0.6)), Affine3A::IDENTITY);
    scene
}

/// Every choice of how light is looked for.
pub fn estimators() -> Vec<Estimator> {
    let base = Estimator::default();
    let direct = Estimator { light_sampling: LightSampling::Direct, ..base };
    vec![
        base,
        direct,
        Estimator { light_sampling: LightSampling::None, ..base },
        Estimator { light_choice: LightChoice::Tree, ..base },
        Estimator { light_choice: LightChoice::Power, area_sampling: AreaSampling::Area, ..direct },
        Estimator { extinction: Extinction::Surface, ..base },
    ]
}

/// A cube of side 2 that absorbs, under a white sky, seen from a distance along an axis; 0: from its middle.
pub fn cube_from(distance: f32, roughness: f32, opacity: f32) -> Scene {
    let mut scene = empty(2, 2);
    scene.sensor = pinhole(Vec3::Z * distance, Vec3::Z * (distance - 1.0), Vec3::Y, 0.05);
    add(&mut scene, cube(), Material { opacity, ..body(roughness, 1.0) }, Affine3A::IDENTITY);
    scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    scene
}

/// A plate of albedo 0.5 below a cube of opacity 0.5 and side 2 that absorbs; a luminaire straight above is found through its holes alone. With the radiance of the plate.
pub fn under_a_pierced_cube(parallel: bool) -> (Scene, DVec3) {
    let mut scene = empty(4, 4);
    scene.sensor = pinhole(Vec3::new(4.0, -1.25, 0.0), Vec3::new(0.0, -1.5, 0.0), Vec3::Y, 0.05);
    add(&mut scene, cube(), Material { opacity: 0.5, ..body(0.0, 1.0) }, Affine3A::IDENTITY);
    let plate = quad(Vec3::new(-1.0, -1.5, 1.0), Vec3::X * 2.0, Vec3::Z * -2.0);
    add(&mut scene, plate, matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    let irradiance = Vec3::splat(std::f32::consts::PI);
    scene.luminaires.push(if parallel {
        Luminaire::Infinite { direction: Vec3::NEG_Y, irradiance }
    } else {
        Luminaire::Point { position: Vec3::Y * 8.5, intensity: irradiance * 100.0 }
    });
    (scene, 0.5 * 0.25 * COLOR * COLOR)
}

/// The room with bodies: a glowing one with holes and a block inside, a mirrored one of index 1 with holes and vertex normals.
pub fn bodies_room(width: u32, height: u32) -> Scene {
    let mut scene = cornell_like(width, height);
    scene.textures =
        vec![texture(16, 16, |x, y| [1.0, 1.0, 1.0, if x % 4 < 2 && y % 3 > 0 { 0.0 } else { 1.0 }]).into()];
    let place = |x, y, z, r| Affine3A::from_translation(Vec3::new(x, y, z)) * Affine3A::from_scale(Vec3::splat(r));
    let mut ball = icosphere(2);
    ball.uvs = ball.positions.iter().map(|p| Vec2::new(0.5 * p.x + 0.3 * p.z, 0.5 * p.y - 0.4 * p.z)).collect();
    let mut glowing = Material { emission: Vec3::new(0.5, 0.75, 1.0), ..body(0.3, 1.5) };
    glowing.maps.opacity = Some(0);
    add(&mut scene, ball.clone(), glowing, place(-0.25, -0.5, 0.25, 0.7));
    add(&mut scene, cube(), matte(Vec3::splat(0.8)), place(-0.25, -0.5, 0.25, 0.25));
    ball.normals = ball.positions.clone();
    let mirrored = place(0.9, 0.5, -0.75, 0.6) * Affine3A::from_scale(Vec3::new(-1.0, 0.8, 1.0));
    add(&mut scene, ball, Material { opacity: 0.4, ..body(0.0, 1.0) }, mirrored);
    scene
}
