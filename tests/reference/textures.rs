//! Textures and holes. Every mean has the significance 1e-4.

use crate::common::scenes::*;
use crate::common::statistics::*;
use crate::transport::{means, preset};
use glam::{Affine2, Affine3A, DVec2, DVec3, DVec4, Vec2, Vec3};
use half::f16;
use luminaire::film::Rays;
use luminaire::reference::Reference;
use luminaire::reference::texture::bilinear;
use luminaire::sampling::{random4, ray_salt};
use luminaire::scene::*;

fn texture(width: u32, texels: &[[f32; 4]], clamp: bool) -> Texture {
    let texels: Vec<[f16; 4]> = texels.iter().map(|texel| texel.map(f16::from_f32)).collect();
    let height = texels.len() as u32 / width;
    Texture { name: "texture".into(), width, height, texels: texels.into(), clamp, ..Texture::default() }
}

/// Opacities in a row.
fn alphas(alphas: &[f32]) -> Texture {
    texture(alphas.len() as u32, &alphas.iter().map(|a| [1.0, 1.0, 1.0, *a]).collect::<Vec<_>>(), true)
}

/// A quad whose coordinates run from 0 to 1 along its edges.
fn mapped_quad(corner: Vec3, a: Vec3, b: Vec3) -> Mesh {
    let uvs = vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    Mesh { uvs, ..quad(corner, a, b) }
}

#[test]
fn bilinear_at_known_points() {
    // Upper row 1 2, lower row 3 5; alpha is a fourth channel like the others.
    let texels = [[1.0, 0.0, 0.5, 0.0], [2.0, 0.0, 0.5, 1.0], [3.0, 0.0, 0.5, 0.0], [5.0, 0.0, 0.5, 1.0]];
    for clamp in [false, true] {
        let texture = texture(2, &texels, clamp);
        let at = |u: f64, v: f64| bilinear(&texture, DVec2::new(u, v));
        for (u, v, expected) in [
            (0.25, 0.75, 1.0),
            (0.75, 0.75, 2.0),
            (0.25, 0.25, 3.0),
            (0.75, 0.25, 5.0),
            (0.5, 0.75, 1.5),
            (0.5, 0.5, 2.75),
        ] {
            assert_eq!(at(u, v).x, expected, "at ({u}, {v})");
        }
        assert_eq!(at(0.5, 0.5), DVec4::new(2.75, 0.0, 0.5, 0.5));
        assert_eq!(at(0.375, 0.25).x, 3.5);
        // The border: the other side's texels, or its own.
        assert_eq!(at(0.0, 0.75).x, if clamp { 1.0 } else { 1.5 });
        assert_eq!(at(1.0, 0.25).x, if clamp { 5.0 } else { 4.0 });
        assert_eq!(at(0.25, 1.0).x, if clamp { 1.0 } else { 2.0 });
        assert_eq!(at(1.25, 0.75).x, if clamp { 2.0 } else { 1.0 });
        assert_eq!(at(-0.25, 0.75).x, if clamp { 1.0 } else { 2.0 });
        assert_eq!(at(0.25, -3.25).x, if clamp { 3.0 } else { 1.0 });
        assert_eq!(at(1e30, 0.75).y, 0.0);
        assert_eq!(at(f64::NAN, 0.75), at(0.0, 0.75));
        assert_eq!(at(0.25, f64::INFINITY), at(0.25, 0.0));
    }
}

/// `uv scale + offset` is where the picture is looked up, on every kind of map; it repeats, or ends, there. What is no number counts as 0.
#[test]
fn a_map_lies_where_its_transform_puts_it() {
    let texels: Vec<_> = (0..12).map(|i| [i as f32, (i * i) as f32, 1.0, (i % 5) as f32 / 5.0]).collect();
    for clamp in [false, true] {
        let plain = texture(4, &texels, clamp);
        for (scale, offset) in [((2.0, 2.0), (0.5, 0.0)), ((-1.0, 3.0), (0.0, 0.25)), ((0.0, 1.0), (0.75, 0.5))] {
            let (scale, offset): (Vec2, Vec2) = (scale.into(), offset.into());
            let placed =
                Texture { transform: Affine2::from_scale_angle_translation(scale, 0.0, offset), ..plain.clone() };
            for i in 0..400 {
                let uv = DVec2::new(f64::from(i % 20), f64::from(i / 20)) / 7.0 - 1.0;
                let expected = bilinear(&plain, uv * scale.as_dvec2() + offset.as_dvec2());
                assert!((bilinear(&placed, uv) - expected).length() < 1e-11, "{scale} {offset}, clamp {clamp}: {uv}");
            }
            let nowhere = bilinear(&placed, DVec2::new(f64::NAN, 0.25));
            assert_eq!(nowhere, bilinear(&placed, DVec2::new(0.0, 0.25)));
        }
    }
}

/// A lamp whose picture is there twice each way and shifted by half, which is what a floor below and a camera see of it: as of a lamp
/// with the picture painted so; as of an opacity.
#[test]
fn a_lamp_with_a_placed_picture() {
    let texel = |x: u32, y: u32| if x < 2 && y < 2 { [4.0, 1.0, 0.0, 1.0] } else { [0.5, 0.5, 1.0, 0.25] };
    let image = crate::common::scenes::texture(4, 4, texel);
    // What the first quarter of a turn each way holds, where the picture is looked up at 2 u + 0.5 and 2 v.
    let painted = crate::common::scenes::texture(8, 8, |x, y| texel((x + 2) % 4, y % 4));
    let scale = Vec2::splat(2.0);
    let placed = Texture { transform: Affine2::from_scale_angle_translation(scale, 0.0, Vec2::X * 0.5), ..image };
    let scene = |picture: &Texture| {
        let mut scene = empty(8, 8);
        scene.sensor = pinhole(Vec3::new(0.0, 3.0, 0.1), Vec3::ZERO, Vec3::Z, 60.0);
        let floor = quad(Vec3::new(-4.0, 0.0, 4.0), Vec3::X * 8.0, Vec3::Z * -8.0);
        add(&mut scene, floor, matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
        scene.textures.push(picture.clone().into());
        let maps = Maps { emission: Some(0), opacity: Some(0), ..Maps::default() };
        let panel = mapped_quad(Vec3::new(-0.75, 0.75, -0.75), Vec3::X * 1.5, Vec3::Z * 1.5);
        add(&mut scene, panel, Material { maps, ..lamp(Vec3::splat(3.0)) }, Affine3A::IDENTITY);
        scene
    };
    for light_sampling in [LightSampling::None, LightSampling::Mis] {
        let [a, b] = [&placed, &painted].map(|picture| {
            let mut scene = scene(picture);
            estimator(&mut scene).light_sampling = light_sampling;
            Reference::new(&scene)
        });
        // The same numbers, so the same samples.
        for i in 0..64 * 20 {
            let (found, expected) = (a.radiance(i % 64, i / 64).0, b.radiance(i % 64, i / 64).0);
            assert!((found - expected).length() <= 1e-9 * (1.0 + expected.length()), "{i}: {found} {expected}");
        }
    }
}

/// Every map multiplies its own number, at the point that is hit; row 0 is up.
#[test]
fn maps_multiply_their_numbers() {
    let mut scene = empty(1, 1);
    for k in 0..4 {
        let texel = |x: f32| [x, x * 0.5, 0.0, 0.25];
        let lower = texel(1.0 / (k + 2) as f32);
        scene.textures.push(texture(1, &[texel(1.0), lower, lower], true).into());
    }
    let maps = Maps { ambient: Some(0), lambert: Some(1), glossy: Some(2), emission: Some(3), opacity: None };
    let all = Vec3::new(0.5, 1.0, 0.5);
    let material = Material { ambient: all, glossy: all, emission: all, maps, ..matte(all) };
    add(&mut scene, mapped_quad(Vec3::ZERO, Vec3::X, Vec3::Y), material, Affine3A::IDENTITY);
    let tracer = Reference::new(&scene);
    for (y, upper) in [(0.95, true), (0.3, false)] {
        let hit = tracer.closest_hit(DVec3::new(0.3, y, 1.0), -DVec3::Z, f64::INFINITY, 0).expect("the quad");
        let surfel = tracer.surfel(&hit, DVec3::Z);
        assert!((surfel.uv - DVec2::new(0.3, y)).length() < 1e-7);
        for (k, number) in [surfel.ambient, surfel.lambert, surfel.glossy, surfel.emission].into_iter().enumerate() {
            let texel = if upper { 1.0 } else { f16::from_f32(1.0 / (k + 2) as f32).to_f64() };
            let half = if upper { 0.5 } else { f16::from_f32(0.5 / (k + 2) as f32).to_f64() };
            assert!((number - DVec3::new(0.5 * texel, half, 0.0)).length() < 1e-12, "map {k}: {number}");
        }
    }
}

/// Half of a white environment is seen through a black surface of opacity 0.5, whether a number or an alpha says so.
#[test]
fn half_is_seen_through_opacity_one_half() {
    for (opacity, alpha) in [(0.5, None), (1.0, Some(0.5)), (0.625, Some(0.8))] {
        let mut scene = empty(8, 8);
        scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
        scene.textures.extend(alpha.map(|alpha| alphas(&[alpha]).into()));
        let maps = Maps { opacity: alpha.map(|_| 0), ..Maps::default() };
        let black = Material { opacity, maps, ..matte(Vec3::ZERO) };
        let sheet = mapped_quad(Vec3::new(-9.0, -9.0, -2.0), Vec3::X * 18.0, Vec3::Y * 18.0);
        add(&mut scene, sheet, black, Affine3A::IDENTITY);
        // f16 rounds 0.8.
        means(&scene, 2000)[0].assert_within(0.5 - 1e-4, 0.5 + 1e-4, 5e-3);
    }
}

/// Trees and brute force agree about holes too, and a hole is one to closest hits and to shadow rays alike.
#[test]
fn holes_are_the_same_to_all_rays() {
    let mut scene = empty(1, 1);
    for k in 0..6 {
        let sheet = quad(Vec3::new(-1.0, -1.0, -1.0 - k as f32), Vec3::X * 2.0, Vec3::Y * 2.0);
        add(&mut scene, sheet, Material { opacity: 0.3, ..matte(Vec3::ONE) }, Affine3A::IDENTITY);
    }
    let (fast, brute) = (Reference::new(&scene), Reference::brute_force(&scene));
    let mut seen = [0; 7];
    for i in 0..20_000 {
        let (salt, direction) = (ray_salt(i, 0, 0, 0), DVec3::new(1e-3, 2e-3, -1.0));
        let hit = fast.closest_hit(DVec3::ZERO, direction, f64::INFINITY, salt);
        assert_eq!(hit, brute.closest_hit(DVec3::ZERO, direction, f64::INFINITY, salt));
        for tracer in [&fast, &brute] {
            assert_eq!(tracer.occluded(DVec3::ZERO, direction, 3.5, salt), hit.is_some_and(|hit| hit.t < 3.5));
        }
        seen[hit.map_or(6, |hit| hit.object as usize)] += 1;
    }
    let share = |k: i32| 20_000.0 * 0.7f64.powi(k) * if k < 6 { f64::from(0.3f32) } else { 1.0 };
    let p = chi_square_against(&seen, &(0..7).map(share).collect::<Vec<_>>());
    assert!(p >= SIGNIFICANCE, "sheets are independent: p = {p:.1e}");
}

/// A point luminaire lights a floor through a sheet whose right half is a hole, and whose left half lets a quarter pass.
#[test]
fn light_falls_through_holes() {
    let mut scene = empty(1, 1);
    scene.integrator = preset("cosine");
    add(
        &mut scene,
        quad(Vec3::new(-4.0, 0.0, -4.0), Vec3::X * 8.0, Vec3::Z * 8.0),
        matte(Vec3::ONE),
        Affine3A::IDENTITY,
    );
    scene.textures.push(alphas(&[0.75, 0.0]).into());
    let maps = Maps { opacity: Some(0), ..Maps::default() };
    let sheet = mapped_quad(Vec3::new(-4.0, 1.0, -4.0), Vec3::X * 8.0, Vec3::Z * 8.0);
    add(&mut scene, sheet, Material { maps, ..matte(Vec3::ZERO) }, Affine3A::IDENTITY);
    scene.luminaires.push(Luminaire::Point { position: Vec3::Y * 2.0, intensity: Vec3::ONE });
    let mut open = scene.clone();
    open.objects.pop();
    let (tracer, open) = (Reference::new(&scene), Reference::new(&open));
    for (x, expected) in [(-3.0, 0.34375), (3.0, 0.90625), (0.0, 0.625), (-1.0, 0.53125)] {
        let floor = open.closest_hit(DVec3::new(x, 0.5, 0.5), -DVec3::Y, f64::INFINITY, 0).expect("the floor");
        let surfel = open.surfel(&floor, DVec3::Y);
        let light = |tracer: &Reference, i: u32| {
            tracer
                .direct_light(
                    &surfel,
                    DVec3::Y,
                    DVec3::ONE,
                    random4(0, i, 1, 3),
                    ray_salt(0, i, 1, 3),
                    &mut Rays::default(),
                )
                .x
        };
        // The shadow ray passes the sheet half way, at u = 0.5 + x / 16; between the texels' centres, at a quarter and three quarters, the
        // opacity falls from 0.75 to 0.
        let through = Estimate::new((0..20_000).map(|i| light(&tracer, i) / light(&open, i)));
        through.assert_is(expected, 2e-2);
    }
}

/// A lamp with a picture, half transparent in places, lights a floor: however the light is found, it is the same.
#[test]
fn lamps_with_holes_and_pictures() {
    let mut scene = empty(4, 4);
    scene.sensor = pinhole(Vec3::new(0.0, 3.0, 0.1), Vec3::ZERO, Vec3::Z, 30.0);
    add(
        &mut scene,
        quad(Vec3::new(-4.0, 0.0, 4.0), Vec3::X * 8.0, Vec3::Z * -8.0),
        matte(Vec3::splat(0.5)),
        Affine3A::IDENTITY,
    );
    scene.textures.push(
        texture(2, &[[1.0, 2.0, 0.5, 0.2], [0.0, 1.0, 0.5, 1.0], [1.0, 0.5, 0.5, 0.5], [2.0, 0.0, 0.5, 0.8]], false)
            .into(),
    );
    let maps = Maps { emission: Some(0), opacity: Some(0), ..Maps::default() };
    let picture = Material { opacity: 0.9, maps, ..lamp(Vec3::splat(3.0)) };
    let panel = mapped_quad(Vec3::new(-0.75, 0.75, -0.75), Vec3::X * 1.5, Vec3::Z * 1.5);
    add(&mut scene, panel, picture, Affine3A::IDENTITY);
    let mut found = vec![];
    for (seed, light_sampling) in
        [LightSampling::None, LightSampling::Direct, LightSampling::Mis].into_iter().enumerate()
    {
        for area_sampling in [AreaSampling::Area, AreaSampling::SolidAngle] {
            scene.settings.seed = found.len() as u32 + seed as u32;
            let sampling = Estimator { light_sampling, area_sampling, ..Estimator::default() };
            scene.integrator = Integrator::Path(sampling);
            let mean = means(&scene, 10_000)[0];
            assert!(mean.error < 1e-2 * mean.mean, "{mean:?}");
            found.push((sampling, mean));
        }
    }
    for (sampling, mean) in &found[1..] {
        let p = same_mean(found[0].1, *mean);
        assert!(p >= SIGNIFICANCE, "{sampling:?}: {mean:?} instead of {:?}, p = {p:.1e}", found[0].1);
    }
}
