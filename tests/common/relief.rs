//! Maps of normals and heights: how they are made, a room that is full of them, and planes whose brightness is known.

use super::scenes::*;
use glam::{Affine2, Affine3A, DMat2, DVec2, DVec3, Mat2, Mat3, Vec2, Vec3, Vec4};
use luminaire::scene::*;
use std::f64::consts::PI;
use std::sync::Arc;

/// A map of the normals of a surface whose slopes along both axes of the image are these at a place within it, (0, 0) being its lower left corner.
pub fn normals(width: u32, height: u32, slopes: impl Fn(f32, f32) -> Vec2) -> Texture {
    at_centres(width, height, |u, v| (0.5 + 0.5 * (-slopes(u, v)).extend(1.0).normalize()).extend(1.0).to_array())
}

/// A map of heights, as loaders make it: two numbers that have to be added.
pub fn heights(width: u32, height: u32, at: impl Fn(f32, f32) -> f32) -> Texture {
    at_centres(width, height, |u, v| {
        let upper = half::f16::from_f32(at(u, v)).to_f32();
        [upper, at(u, v) - upper, 0.0, 1.0]
    })
}

fn at_centres(width: u32, height: u32, texel: impl Fn(f32, f32) -> [f32; 4]) -> Texture {
    let share = |i: u32, n: u32| (i as f32 + 0.5) / n as f32;
    texture(width, height, |x, y| texel(share(x, width), 1.0 - share(y, height)))
}

/// Waves whose slope is at most this, so many of them each way.
pub fn waves(steepness: f32, count: f32) -> Texture {
    let wave = move |x: f32| steepness * (std::f32::consts::TAU * count * x).sin();
    normals(32, 32, |u, v| Vec2::new(wave(u), wave(v + 0.1)))
}

/// What a material with this map of normals is.
pub fn with_normals(texture: u32, scale: f32, material: Material) -> Material {
    Material { normal_map: Some(NormalMap { texture, scale }), ..material }
}

/// What a material with this map of heights is.
pub fn with_heights(texture: u32, scale: f32, material: Material) -> Material {
    Material { bump_map: Some(BumpMap { texture, scale }), ..material }
}

/// A ball of radius 1 whose texture coordinates are longitude and latitude, with vertex normals.
pub fn mapped_ball(subdivisions: u32) -> Mesh {
    let mut ball = icosphere(subdivisions);
    // No vertex is shared across the seam, or at a pole.
    let corners: Vec<Vec3> =
        ball.triangles.iter().flat_map(|t| t.vertices.map(|v| ball.positions[v as usize])).collect();
    ball.triangles =
        (0..).zip(&ball.triangles).map(|(i, t)| Triangle { vertices: [3 * i, 3 * i + 1, 3 * i + 2], ..*t }).collect();
    let longitude = |p: Vec3| p.x.atan2(p.z) / std::f32::consts::TAU;
    ball.uvs = corners
        .chunks(3)
        .flat_map(|corners| {
            let middle = longitude(corners[0] + corners[1] + corners[2]);
            corners.iter().map(move |p| {
                let pole = p.x.hypot(p.z) < 1e-6;
                let u = if pole { middle } else { middle + (longitude(*p) - middle + 0.5).rem_euclid(1.0) - 0.5 };
                Vec2::new(u, p.y.asin() / std::f32::consts::PI)
            })
        })
        .collect();
    ball.normals = corners.clone();
    ball.positions = corners;
    ball
}

/// The room of [`cornell_like`] with relief everywhere: diffuse, glossy, coated and brushed, on mirrors, on glass that is smooth and on glass that is rough, on
/// meshes with and without vertex normals, seen from both sides, in instances that turn, stretch and mirror.
pub fn relief_room(width: u32, height: u32) -> Scene {
    let mut scene = cornell_like(width, height);
    let placed = |scale: Vec2, offset: Vec2, texture: Texture| Texture {
        transform: Affine2::from_scale_angle_translation(scale, 0.0, offset),
        ..texture
    };
    scene.textures = vec![
        waves(0.6, 2.0).into(),
        heights(24, 16, |u, v| 0.1 * (12.0 * u).sin() * (9.0 * v).cos()).into(),
        placed(Vec2::new(-1.5, 2.0), Vec2::new(0.25, 0.0), waves(1.0, 1.0)).into(),
        placed(Vec2::new(2.0, -1.0), Vec2::Y * 0.3, heights(16, 16, |u, v| (6.0 * u - 3.0).sin() * v)).into(),
    ];
    Arc::make_mut(&mut scene.textures[1]).clamp = true;
    for mesh in scene.meshes.iter_mut().map(Arc::make_mut) {
        mesh.uvs = mesh.positions.iter().map(|p| Vec2::new(0.5 * p.x + 0.3 * p.z, 0.5 * p.y - 0.4 * p.z)).collect();
    }
    let physical = |p: Physical| Material { physical: Some(p), ..Material::default() };
    scene.materials[0] = with_normals(0, 1.0, scene.materials[0].clone());
    scene.materials[2] =
        with_normals(2, 0.5, physical(Physical { anisotropy: 0.8, anisotropy_rotation: 0.5, ..copper(0.3) }));
    scene.materials[4] = with_heights(1, 0.7, scene.materials[4].clone());
    let ball = scene.materials.len() - 1;
    scene.materials[ball] = with_heights(3, 0.05, with_normals(0, 0.7, scene.materials[ball].clone()));
    let coated = Material { reflection: Vec3::ONE, eta: Some(1.5), ..scene.materials[ball - 1].clone() };
    scene.materials[ball - 1] = with_heights(3, 0.1, coated);
    let place = |x, y, z, r| Affine3A::from_translation(Vec3::new(x, y, z)) * Affine3A::from_scale(Vec3::splat(r));
    let glass = Material {
        reflection: Vec3::ONE,
        transmission: Vec3::new(0.9, 1.0, 0.95),
        eta: Some(1.5),
        ..Material::default()
    };
    add(&mut scene, mapped_ball(2), with_normals(2, 0.4, glass), place(-0.25, -0.5, 0.25, 0.5));
    let mirror = Material { reflection: Vec3::new(0.95, 0.8, 0.6), ..Material::default() };
    add(&mut scene, mapped_ball(2), with_normals(0, 1.5, mirror), place(0.9, 0.5, -0.75, 0.6));
    let frosted = Physical { roughness: 0.4, transmission: 1.0, ..Physical::default() };
    let mut slab = cube();
    slab.uvs = slab.positions.iter().map(|p| Vec2::new(p.x + 0.3 * p.z, p.y - 0.4 * p.z)).collect();
    let mirrored =
        place(-1.0, 0.75, 0.0, 1.0) * Affine3A::from_rotation_z(0.5) * Affine3A::from_scale(Vec3::new(-0.1, 0.4, 0.4));
    add(&mut scene, slab, with_normals(0, 1.0, physical(frosted)), mirrored);
    // A rough coat, and a smooth one, over what is bent below them.
    for (x, clearcoat_roughness) in [(-1.25, 0.4), (1.25, 0.0)] {
        let lacquer = Physical { clearcoat: 1.0, clearcoat_roughness, roughness: 0.6, ..Physical::default() };
        add(&mut scene, mapped_ball(2), with_normals(0, 1.0, physical(lacquer)), place(x, 1.25, -0.5, 0.3));
    }
    // Both sides of one sheet, and the back of it is what is seen.
    let mut sheet = quad(Vec3::new(1.5, -1.75, 0.5), Vec3::new(-0.5, 0.0, 0.25), Vec3::Y * 0.75);
    sheet.uvs = vec![Vec2::ZERO, Vec2::Y * 2.0, Vec2::new(-1.5, 2.0), Vec2::X * -1.5];
    add(&mut scene, sheet, with_normals(0, 1.0, matte(Vec3::new(0.3, 0.5, 0.7))), Affine3A::IDENTITY);
    scene
}

/// Coarse balls with vertex normals and smoothed terminators in the room: diffuse ones, also bent by a map, a metal, and a ball of glass, which has none.
pub fn smooth_terminators(width: u32, height: u32) -> Scene {
    let mut scene = cornell_like(width, height);
    scene.textures = vec![waves(0.4, 2.0).into()];
    estimator(&mut scene).smooth_terminator = true;
    let place =
        |x, y, z, r| Affine3A::from_translation(Vec3::new(x, y, z)) * Affine3A::from_scale(Vec3::new(r, 0.8 * r, -r));
    add(&mut scene, mapped_ball(1), matte(Vec3::new(0.7, 0.6, 0.4)), place(-0.25, -0.5, 0.25, 0.5));
    add(&mut scene, mapped_ball(1), with_normals(0, 1.0, matte(Vec3::splat(0.6))), place(0.9, 0.5, -0.75, 0.6));
    let metal = Material { physical: Some(copper(0.4)), ..Material::default() };
    add(&mut scene, mapped_ball(1), metal, place(-0.9, 0.75, -0.75, 0.5));
    let glass = Physical { roughness: 0.3, transmission: 1.0, ..Physical::default() };
    add(
        &mut scene,
        mapped_ball(1),
        Material { physical: Some(glass), ..Material::default() },
        place(0.0, 0.75, 0.0, 0.25),
    );
    scene
}

/// What bends the normals of a plane of [`planes`].
enum Relief {
    /// A map of one normal, and its scale.
    Tilt(Vec3, f32),
    /// Heights that grow by so much along both axes of the image, and their scale.
    Ramp(Vec2, f32),
}

/// How far planes are from each other.
const APART: f32 = 8.0;

/// Planes with a map of one normal, or of heights that form a ramp, one in the middle of each pixel: their texture coordinates turned, mirrored and stretched, the map
/// scaled, moved and turned, in instances that are scaled, stretched and mirrored, seen from both sides; and one whose tangents are given. All is under one light
/// from infinity; with each name goes the radiance that is seen: by the cosine to the normal that the picture shows, which is found from where the axes of the
/// image lie in the world.
pub fn planes() -> (Scene, Vec<(String, f64)>) {
    let mut scene = empty(1, 1);
    let mut expected = Vec::new();
    let one = Mat2::IDENTITY;
    let turned = Mat2::from_angle(0.7);
    let mirrored = Mat2::from_diagonal(Vec2::new(-1.0, 1.0));
    let coordinates = [
        ("as they are", one),
        ("turned", turned),
        ("mirrored", mirrored),
        ("mirrored the other way", -mirrored),
        ("mirrored and turned", mirrored * turned),
        ("smaller", 0.5 * one),
    ];
    let maps = [
        ("as it is", one, Vec2::ZERO),
        ("scaled and moved", Mat2::from_diagonal(Vec2::new(0.5, 0.25)), Vec2::new(0.25, 0.375)),
        ("mirrored", Mat2::from_diagonal(Vec2::new(-1.0, 1.0)), Vec2::X),
        ("upside down", Mat2::from_diagonal(Vec2::new(1.0, -1.0)), Vec2::Y),
        ("turned", Mat2::from_angle(1.9), Vec2::new(1.125, 0.1875)),
    ];
    let y = Mat3::from_rotation_y(0.4);
    let half_turn = Mat3::from_rotation_x(std::f32::consts::PI);
    let places = [
        ("as it is", Mat3::IDENTITY),
        ("turned", Mat3::from_rotation_x(-0.5) * y),
        ("scaled", Mat3::from_rotation_z(2.0) * 3.0),
        ("stretched", y * Mat3::from_diagonal(Vec3::new(2.0, 0.5, 0.25))),
        ("mirrored", Mat3::from_diagonal(Vec3::new(-1.0, 1.0, 1.0))),
        ("mirrored across", y * half_turn * Mat3::from_diagonal(Vec3::new(1.0, 1.0, -1.0))),
    ];
    let reliefs = [
        ("normal", Relief::Tilt(Vec3::new(0.25, 0.125, 0.9), 1.0)),
        ("stronger normal", Relief::Tilt(Vec3::new(0.125, -0.25, 0.9), 1.5)),
        ("ramp", Relief::Ramp(Vec2::new(0.25, -0.5), 0.75)),
    ];
    let mut add = |[uv, map, place]: [usize; 3], relief: &(&str, Relief), behind| {
        let (of_uv, of_map, of_place) = (coordinates[uv].0, maps[map].0, places[place].0);
        let name = format!("{}, coordinates {of_uv}, map {of_map}, plane {of_place}, behind {behind}", relief.0);
        let radiance =
            plane(&mut scene, &name, coordinates[uv].1, (maps[map].1, maps[map].2), places[place].1, &relief.1, behind);
        expected.push((name, radiance));
    };
    for relief in &reliefs {
        for i in 0..coordinates.len() {
            add([i, 0, 0], relief, false);
        }
        for i in 1..maps.len() {
            add([0, i, 0], relief, false);
        }
        for i in 1..places.len() {
            add([0, 0, i], relief, false);
        }
        add([4, 2, 4], relief, false);
        add([4, 1, 1], relief, true);
    }
    // As if turned by a quarter; the coordinates are not.
    let (name, quarter) = ("tangents that are given", Mat2::from_angle(-std::f32::consts::FRAC_PI_2));
    let radiance = plane(&mut scene, name, quarter, (one, Vec2::ZERO), Mat3::IDENTITY, &reliefs[0].1, false);
    expected.push((name.into(), radiance));
    let mesh = Arc::make_mut(scene.meshes.last_mut().expect("the last plane"));
    mesh.uvs = mesh.positions.iter().map(|p| p.truncate() + 0.5).collect();
    mesh.tangents = vec![Vec4::new(0.0, 1.0, 0.0, 1.0); 6];

    let width = expected.len() as u32;
    scene.film = FilmSettings { width, filter_radius: 1e-3, ..scene.film };
    let middle = Vec3::X * APART * 0.5 * (width - 1) as f32;
    scene.sensor = Sensor {
        projection: Projection::Orthographic { height: APART },
        ..pinhole(middle + Vec3::Z * 8.0, middle, Vec3::Y, 1.0)
    };
    scene.luminaires = vec![Luminaire::Infinite { direction: -LIT_FROM.normalize(), irradiance: Vec3::ONE }];
    estimator(&mut scene).max_bounces = Some(0);
    (scene, expected)
}

/// Neither along the normals of the planes, nor where the sign of a tilt would not matter.
const LIT_FROM: Vec3 = Vec3::new(0.4, -0.25, 1.0);

/// Adds the next plane, and gives its radiance.
fn plane(
    scene: &mut Scene,
    name: &str,
    uv: Mat2,
    (map, offset): (Mat2, Vec2),
    place: Mat3,
    relief: &Relief,
    behind: bool,
) -> f64 {
    let place = if behind { Mat3::from_rotation_x(std::f32::consts::PI) * place } else { place };
    let mut mesh = quad(Vec3::new(-0.5, -0.5, 0.0), Vec3::X, Vec3::Y);
    // The middle of the picture is in the middle.
    mesh.uvs = mesh.positions.iter().map(|p| uv * p.truncate() + 0.5).collect();
    let middle = map * Vec2::splat(0.5) + offset;
    assert!((middle.fract_gl() - 0.5).abs().max_element() < 0.45, "{name}: the seam of a ramp is seen");
    let (texture, albedo) = match relief {
        Relief::Tilt(normal, _) => (texture(4, 4, |_, _| (0.5 + 0.5 * *normal).extend(1.0).to_array()), 0.5f32),
        Relief::Ramp(slope, _) => (heights(8, 8, |u, v| 2.0 + slope.dot(Vec2::new(u, v))), 0.8),
    };
    let transform = Affine2 { matrix2: map, translation: offset };
    let texture = Texture { transform, ..texture };
    let texel = DVec3::from_array([0, 1, 2].map(|i| texture.texels[0][i].to_f64()));
    let number = scene.textures.len() as u32;
    scene.textures.push(texture.into());
    let matte = matte(Vec3::splat(albedo));
    let material = match relief {
        Relief::Tilt(_, scale) => with_normals(number, *scale, matte),
        Relief::Ramp(_, scale) => with_heights(number, *scale, matte),
    };
    let position = Vec3::X * APART * scene.objects.len() as f32;
    add(scene, mesh, material, Affine3A::from_mat3_translation(place, position));
    // Where the axes of the image lie in the world: x and y such that its column and row grow by one along each of them.
    let world = place.as_dmat3();
    let across = (world.inverse().transpose() * DVec3::Z).normalize();
    let to_plane: DMat2 = (map * uv).as_dmat2().inverse();
    let [x, y] = [to_plane.x_axis, to_plane.y_axis].map(|axis| world * axis.extend(0.0));
    let n = match relief {
        Relief::Tilt(_, scale) => {
            let scale = f64::from(*scale);
            let texel = (2.0 * texel - 1.0) * DVec3::new(scale, scale, 1.0);
            let right = x.normalize();
            let up = (y - right * right.dot(y)).normalize();
            (texel.x * right + texel.y * up + texel.z * across).normalize()
        }
        Relief::Ramp(slope, scale) => {
            // The plane through what is lifted by the height.
            let rise = slope.as_dvec2() * f64::from(*scale);
            let n = (x + rise.x * across).cross(y + rise.y * across).normalize();
            if n.dot(across) < 0.0 { -n } else { n }
        }
    };
    let side = if behind { -1.0 } else { 1.0 };
    let (across, n) = (side * across, side * n);
    let mirrored = 2.0 * n.z * n - DVec3::Z;
    let cosine = n.dot(LIT_FROM.as_dvec3().normalize());
    assert!(across.z > 0.5 && mirrored.dot(across) > 0.02 && cosine > 0.1, "{name}: {across} {n}");
    f64::from(albedo) / PI * cosine
}

/// A closed room without relief, and the same whose every surface has a flat map of normals and one of heights.
pub fn flat_rooms(side: u32) -> [Scene; 2] {
    let mut plain = cornell_like(side, side);
    for mesh in plain.meshes.iter_mut().map(Arc::make_mut) {
        mesh.uvs = mesh.positions.iter().map(|p| Vec2::new(0.5 * p.x + 0.3 * p.z, 0.5 * p.y - 0.4 * p.z)).collect();
    }
    let mut flat = plain.clone();
    flat.textures = vec![texture(2, 2, |_, _| [0.5, 0.5, 1.0, 1.0]).into(), heights(3, 3, |_, _| 0.7).into()];
    flat.materials = flat.materials.iter().map(|m| with_heights(1, 2.0, with_normals(0, 3.0, m.clone()))).collect();
    [plain, flat]
}

/// Pixels of a ball of [`white_balls`], each way.
pub const BALL: u32 = 8;

/// White balls of all kinds under a white sky, one above the other and so far from each other that none sees the others, with a map of normals whose slopes along
/// both axes go up to this.
pub fn white_balls(steepness: f32) -> (Vec<&'static str>, Scene) {
    let physical = |p: Physical| Material { physical: Some(p), ..Material::default() };
    let metal = |roughness| physical(Physical { metallic: 1.0, roughness, ..Physical::default() });
    let glass = |roughness| physical(Physical { transmission: 1.0, roughness, ..Physical::default() });
    let clear = Material { reflection: Vec3::ONE, transmission: Vec3::ONE, eta: Some(1.5), ..Material::default() };
    let brushed = physical(Physical { metallic: 1.0, roughness: 0.3, anisotropy: 0.7, ..Physical::default() });
    let balls = [
        ("Lambert", matte(Vec3::ONE)),
        ("Blinn-Phong", Material { glossy: Vec3::ONE, exponent: 50.0, ..matte(Vec3::ZERO) }),
        ("mirror", Material { reflection: Vec3::ONE, ..Material::default() }),
        ("metal 0.1", metal(0.1)),
        ("metal 0.5", metal(0.5)),
        ("brushed metal", brushed),
        ("plastic", physical(Physical { roughness: 0.3, ..Physical::default() })),
        ("smooth glass", clear),
        ("rough glass", glass(0.4)),
    ];
    let count = balls.len() as u32;
    let mut scene = empty(BALL, BALL * count);
    scene.textures = vec![waves(steepness, 4.0).into()];
    scene.sensor = Sensor {
        projection: Projection::Orthographic { height: 2.0 * count as f32 },
        ..pinhole(Vec3::Z * 4.0, Vec3::ZERO, Vec3::Y, 1.0)
    };
    for (i, (_, material)) in (0..).zip(&balls) {
        let place = Vec3::new(0.0, count as f32 - 1.0 - 2.0 * i as f32, -100.0 * i as f32);
        let material = if steepness > 0.0 { with_normals(0, 1.0, material.clone()) } else { material.clone() };
        add(&mut scene, mapped_ball(3), material, Affine3A::from_translation(place));
    }
    scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    (balls.map(|(name, _)| name).into(), scene)
}

/// The pixels of each of them that it fills.
pub fn of_balls(pixels: &[DVec3]) -> Vec<Vec<DVec3>> {
    let side = BALL as usize;
    let from_middle = |i: usize| (2 * i + 1) as f64 / side as f64 - 1.0;
    let inside =
        |(i, pixel): (usize, &DVec3)| (from_middle(i % side).hypot(from_middle(i / side)) < 0.85).then_some(*pixel);
    pixels.chunks(side * side).map(|ball| ball.iter().enumerate().filter_map(inside).collect()).collect()
}

/// A ball of so many triangles with vertex normals, lit from the side, seen in parallel; and for each pixel that it fills, the radiance of the round ball.
pub fn coarse_ball(subdivisions: u32, side: u32) -> (Scene, Vec<Option<f64>>) {
    let mut scene = empty(side, side);
    let mut ball = icosphere(subdivisions);
    ball.normals = ball.positions.clone();
    add(&mut scene, ball.clone(), matte(Vec3::ONE), Affine3A::IDENTITY);
    scene.sensor = Sensor {
        projection: Projection::Orthographic { height: 2.0 },
        ..pinhole(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO, Vec3::Y, 1.0)
    };
    let towards = Vec3::new(1.0, 0.25, 0.1).normalize();
    scene.luminaires = vec![Luminaire::Infinite { direction: -towards, irradiance: Vec3::ONE }];
    estimator(&mut scene).max_bounces = Some(0);
    let corners: Vec<[DVec2; 3]> =
        ball.triangles.iter().map(|t| t.vertices.map(|v| ball.positions[v as usize].as_dvec3().truncate())).collect();
    let covers = |p: DVec2| {
        corners.iter().any(|[a, b, c]| {
            let sides = [(*b - *a).perp_dot(p - *a), (*c - *b).perp_dot(p - *b), (*a - *c).perp_dot(p - *c)];
            sides.iter().all(|side| *side > 1e-6)
        })
    };
    const STEPS: u32 = 4;
    let truth = (0..side * side).map(|pixel| {
        let mut sum = 0.0;
        for i in 0..STEPS * STEPS {
            let [x, y] = [(pixel % side, i % STEPS), (pixel / side, i / STEPS)]
                .map(|(p, i)| 2.0 * (f64::from(p) + (f64::from(i) + 0.5) / f64::from(STEPS)) / f64::from(side) - 1.0);
            let p = DVec2::new(x, -y);
            if !covers(p) {
                return None;
            }
            let n = p.extend((1.0 - p.length_squared()).sqrt());
            sum += n.dot(towards.as_dvec3()).max(0.0) / PI;
        }
        Some(sum / f64::from(STEPS * STEPS))
    });
    (scene, truth.collect())
}

/// A sheet of albedo 1 in the plane z = 0 whose vertex normals lean inwards by an angle, with smoothed terminators: lit by parallel light from behind, `elevation` above its
/// plane and from the side `azimuth`; degrees. All of it is black.
pub fn hollow_sheet(lean: f32, elevation: f32, azimuth: f32) -> Scene {
    let mut scene = empty(12, 12);
    scene.sensor = pinhole(Vec3::new(0.3, 0.2, 3.0), Vec3::ZERO, Vec3::Y, 40.0);
    let mut sheet = quad(Vec3::new(-1.0, -1.0, 0.0), Vec3::X * 2.0, Vec3::Y * 2.0);
    let (sin, cos) = lean.to_radians().sin_cos();
    sheet.normals = sheet.positions.iter().map(|p| Vec3::Z * cos - p.normalize() * sin).collect();
    add(&mut scene, sheet, matte(Vec3::ONE), Affine3A::IDENTITY);
    let ((sin, cos), (y, x)) = (elevation.to_radians().sin_cos(), azimuth.to_radians().sin_cos());
    scene.luminaires.push(Luminaire::Infinite { direction: Vec3::new(-x * cos, -y * cos, sin), irradiance: Vec3::ONE });
    estimator(&mut scene).smooth_terminator = true;
    scene
}
