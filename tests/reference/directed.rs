//! Spots, discs at infinity and photometric lamps: what closed forms of `luminaire-measure` do not ask.

use crate::common::many_lamps::{some_surface, surface};
use crate::common::scenes::*;
use crate::common::stage::{profile, stage};
use crate::common::statistics::*;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::film::Rays;
use luminaire::reference::Reference;
use luminaire::reference::light_tree::light_importances;
use luminaire::reference::lost_light::lost_light;
use luminaire::reference::luminaire::spot_falloff;
use luminaire::reference::profile::photometric_intensity;
use luminaire::sampling::random4;
use luminaire::scene::light_tree::{CHILDREN, LEAF, LightTree};
use luminaire::scene::*;
use std::collections::HashSet;
use std::f64::consts::PI;

/// A floor at y = 0 that reflects half, seen from above.
fn floor() -> Scene {
    let mut scene = empty(8, 8);
    scene.sensor = pinhole(Vec3::Y * 3.0, Vec3::ZERO, Vec3::X, 20.0);
    let floor = quad(Vec3::new(-8.0, 0.0, -8.0), Vec3::Z * 16.0, Vec3::X * 16.0);
    add(&mut scene, floor, matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    scene
}

fn sun(direction: Vec3, angle: f32) -> Luminaire {
    Luminaire::Sun { direction, irradiance: Vec3::splat(3.0), angle }
}

fn spot(position: Vec3, direction: Vec3, outer: f32) -> Luminaire {
    let direction = direction.normalize();
    Luminaire::Spot { position, direction, intensity: Vec3::ONE, inner: 0.5 * outer, outer }
}

/// The mean of the samples of all pixels.
fn mean(scene: &Scene, samples: u32) -> Estimate {
    let tracer = Reference::new(scene);
    let pixels = scene.film.width * scene.film.height;
    Estimate::new((0..samples).flat_map(|s| (0..pixels).map(move |p| (p, s))).map(|(p, s)| tracer.radiance(p, s).0.y))
}

#[test]
fn a_disc_of_no_size_is_parallel_light() {
    let mut disc = stage(8, 8);
    disc.luminaires.push(sun(Vec3::new(0.0, -0.6, 0.8), 0.0));
    let mut parallel = disc.clone();
    let last = parallel.luminaires.last_mut().expect("one");
    *last = Luminaire::Infinite { direction: Vec3::new(0.0, -0.6, 0.8), irradiance: Vec3::splat(3.0) };
    let [a, b] = [&disc, &parallel].map(Reference::new);
    for pixel in 0..64 {
        assert_eq!(a.radiance(pixel, 0), b.radiance(pixel, 0));
    }
}

/// However light is found, the camera sees discs as they are, added up, and the sky behind them; of a picture with alpha they are no part.
#[test]
fn discs_are_seen() {
    let mut scene = floor();
    // Upwards, at nothing.
    scene.sensor = pinhole(Vec3::Y, Vec3::Y * 2.0, Vec3::X, 1e-3);
    scene.environment = Some(Environment { radiance: Vec3::splat(0.25), image: None, rotation: 0.0 });
    scene.luminaires = vec![sun(-Vec3::Y, 60.0), sun(Vec3::new(0.0, -0.8, 0.6), 90.0), sun(Vec3::Z, 90.0)];
    let radiance = |angle: f64| 3.0 / (PI * (0.5 * angle).to_radians().sin().powi(2));
    let expected = 0.25 + radiance(60.0) + radiance(90.0);
    for light_sampling in [LightSampling::None, LightSampling::Direct, LightSampling::Mis] {
        estimator(&mut scene).light_sampling = light_sampling;
        let found = Reference::new(&scene).radiance(9, 0).0;
        assert!((found - expected).abs().max_element() < 1e-6, "{light_sampling:?}: {found} for {expected}");
    }
    scene.settings.transparent = true;
    assert_eq!(Reference::new(&scene).radiance(9, 0).0, DVec3::ZERO);
    assert_eq!(scene.dark_because(), None);
    // By chance alone discs are found, and nothing is said of them.
    let mut by_chance = floor();
    estimator(&mut by_chance).light_sampling = LightSampling::None;
    by_chance.luminaires = vec![sun(-Vec3::Y, 60.0)];
    assert_eq!((by_chance.dark_because(), lost_light(&by_chance)), (None, vec![]));
    mean(&by_chance, 512).assert_is(1.5 / PI, 0.02);
    by_chance.luminaires = vec![spot(Vec3::Y, -Vec3::Y, 30.0)];
    assert!(by_chance.dark_because().is_some());
}

/// What is between shades, what is below the floor does not; light that a disc sends through a pane of glass and by a mirror arrives.
#[test]
fn what_is_in_the_way_of_a_disc() {
    let mut scene = floor();
    scene.luminaires = vec![sun(-Vec3::Y, 20.0)];
    scene.sensor.position = Vec3::Y * 0.5;
    let free = 1.5 / PI;
    let lid = quad(Vec3::new(-8.0, 0.0, -8.0), Vec3::X * 16.0, Vec3::Z * 16.0);
    let at = |y: f32| Affine3A::from_translation(Vec3::Y * y);
    let mut above = scene.clone();
    add(&mut above, lid.clone(), matte(Vec3::ZERO), at(1.0));
    assert_eq!(mean(&above, 16).mean, 0.0);
    let mut below = scene.clone();
    add(&mut below, lid.clone(), matte(Vec3::ZERO), at(-1.0));
    mean(&below, 64).assert_is(free, 0.01);
    // Nothing of a sheet of eta 1 is reflected.
    let pane = Material { transmission: Vec3::splat(0.5), eta: Some(1.0), thin: true, ..matte(Vec3::ZERO) };
    add(&mut scene, lid, pane, at(1.0));
    assert_eq!(lost_light(&scene), Vec::<String>::new());
    mean(&scene, 4096).assert_is(0.5 * free, 0.03);
    // Of parallel light it would be lost, and a disc is what is advised.
    scene.luminaires = vec![Luminaire::Infinite { direction: -Vec3::Y, irradiance: Vec3::splat(3.0) }];
    let said = lost_light(&scene);
    assert!(said.len() == 1 && said[0].contains("`angle`"), "{said:?}");
}

/// Glass in a cone is said, glass beside it is not; and the numbers are those of the scene, discs included.
#[test]
fn spots_in_glass_are_named() {
    let mut scene = floor();
    let glass = Material { reflection: Vec3::ONE, transmission: Vec3::ONE, eta: Some(1.5), ..matte(Vec3::ZERO) };
    add(
        &mut scene,
        icosphere(2),
        glass,
        Affine3A::from_translation(Vec3::new(2.0, 2.0, 0.0)) * Affine3A::from_scale(Vec3::splat(0.5)),
    );
    // As strong as the sun.
    let beam = |direction| match spot(Vec3::new(2.0, 4.0, 0.0), direction, 10.0) {
        Luminaire::Spot { position, direction, inner, outer, .. } => {
            Luminaire::Spot { position, direction, intensity: Vec3::splat(1e5), inner, outer }
        }
        other => other,
    };
    let profile = profile();
    let photometric = |direction| Luminaire::Photometric {
        position: Vec3::new(2.0, 4.0, 0.0),
        direction,
        up: Vec3::X,
        intensity: Vec3::splat(1e4),
        profile: Profile { vertical: vec![0.0, 5.0, 10.0, 12.0, 14.0], ..(*profile).clone() }.into(),
    };
    for (at_it, aside) in [
        (beam(-Vec3::Y), beam(Vec3::new(-1.0, -1.0, 0.0))),
        (photometric(-Vec3::Y), photometric(Vec3::new(-0.8, -0.6, 0.0))),
    ] {
        scene.luminaires = vec![sun(-Vec3::Y, 5.0), at_it];
        let said = lost_light(&scene);
        assert!(said.len() == 1 && said[0].contains("[[luminaire]] 2") && said[0].contains("small mesh"), "{said:?}");
        scene.luminaires = vec![sun(-Vec3::Y, 5.0), aside];
        assert_eq!(lost_light(&scene), Vec::<String>::new());
    }
}

/// Entries of the table to which a choice at a surface may come.
fn possible(tree: &LightTree, position: DVec3, normal: DVec3) -> HashSet<u32> {
    let (mut found, mut open) = (HashSet::new(), vec![0]);
    while let Some(node) = open.pop() {
        let node = &tree.nodes[node as usize];
        let importances = light_importances(position, normal, node);
        for child in (0..CHILDREN).filter(|child| importances[*child] > 0.0) {
            match node.link[child] {
                leaf if leaf & LEAF != 0 => drop(found.insert(leaf & !LEAF)),
                inner => open.push(inner),
            }
        }
    }
    found
}

/// Spots of all widths and photometric lamps, by themselves and among others: each may be chosen wherever it shines, and hardly one where it does not.
#[test]
fn whatever_shines_may_be_chosen() {
    for with_points in [false, true] {
        let mut scene = floor();
        for i in 0..120u32 {
            let [x, y, z, ..] = random4(i, 0, 7, 1).map(|bits| (8.0 * luminaire::sampling::uniform(bits) - 4.0) as f32);
            let [a, b, c, w] = random4(i, 1, 7, 1).map(|bits| luminaire::sampling::uniform(bits) as f32 - 0.5);
            let (position, direction) = (Vec3::new(x, y, z), Vec3::new(a, b, c).normalize());
            scene.luminaires.push(match i % 6 {
                0 if with_points => Luminaire::Point { position, intensity: Vec3::ONE },
                1 => Luminaire::Photometric {
                    position,
                    direction,
                    up: direction.any_orthonormal_vector(),
                    intensity: Vec3::ONE,
                    profile: profile(),
                },
                // From 90 degrees down to a hundredth of one.
                _ => spot(position, direction, 90.0 * 10f32.powf(-4.0 * (w + 0.5))),
            });
        }
        let tracer = Reference::new(&scene);
        let tree = tracer.light_tree().expect("a tree");
        let (mut lit, mut dark, mut in_vain) = (0, 0, 0);
        let mut check = |position: DVec3, normal: DVec3| {
            let possible = possible(tree, position, normal);
            for (index, luminaire) in (0u32..).zip(&scene.luminaires) {
                let (at, falloff): (_, &dyn Fn(DVec3) -> f64) = match luminaire {
                    Luminaire::Spot { position, direction, inner, outer, .. } => {
                        (position, &|out| spot_falloff(*direction, *inner, *outer, out))
                    }
                    Luminaire::Photometric { position, direction, up, profile, .. } => {
                        (position, &|out| photometric_intensity(profile, *direction, *up, out))
                    }
                    _ => continue,
                };
                let to_light = (at.as_dvec3() - position).normalize();
                if falloff(-to_light) > 0.0 && normal.dot(to_light) > 0.0 {
                    assert!(possible.contains(&index), "{luminaire:?} at {position}, {normal}");
                    lit += 1;
                } else {
                    dark += 1;
                    in_vain += u32::from(possible.contains(&index));
                }
            }
        };
        for number in 0..300 {
            let from = some_surface(number, 4.0);
            check(from.position, from.shading_normal);
        }
        // Within the narrow ones, which nothing meets by chance.
        for (number, luminaire) in (0u32..).zip(&scene.luminaires) {
            if let Luminaire::Spot { position, direction, outer, .. } = luminaire {
                let axis = direction.as_dvec3();
                let aside = 0.99 * f64::from(*outer).to_radians();
                for way in [0.0, aside, -aside] {
                    let out = axis * way.cos() + direction.any_orthonormal_vector().as_dvec3() * way.sin();
                    check(position.as_dvec3() + out * f64::from(1 + number % 5), -axis);
                }
            }
        }
        println!("points: {with_points}, {lit} lit, {in_vain} of {dark} in vain");
        assert!(lit > 2000 && in_vain < dark / 3, "{lit} lit, {in_vain} of {dark} in vain");
    }
}

/// Many spots over a floor: by power and by the tree the irradiance is the sum of all, and the tree needs far fewer samples.
#[test]
fn many_spots_light_as_their_sum() {
    let mut scene = floor();
    for i in 0..100 {
        scene.luminaires.push(spot(
            Vec3::new(i as f32 % 10.0 - 4.5, 1.5, (i / 10) as f32 - 4.5),
            Vec3::new(0.1, -1.0, 0.2),
            25.0,
        ));
    }
    let place = DVec3::new(0.3, 0.0, 0.6);
    let expected: f64 = scene
        .luminaires
        .iter()
        .map(|luminaire| {
            let Luminaire::Spot { position, direction, inner, outer, .. } = luminaire else { unreachable!("spots") };
            let to_light = position.as_dvec3() - place;
            let wi = to_light.normalize();
            spot_falloff(*direction, *inner, *outer, -wi) * wi.y / to_light.length_squared()
        })
        .sum();
    assert!(expected > 0.3, "{expected}");
    let mut errors = vec![];
    for light_choice in [LightChoice::Power, LightChoice::Tree] {
        estimator(&mut scene).light_choice = light_choice;
        let tracer = Reference::new(&scene);
        let from = luminaire::reference::surfel::Surfel { lambert: DVec3::ONE, ..surface(place, DVec3::Y) };
        let radiance =
            |i| tracer.direct_light(&from, DVec3::Y, DVec3::ONE, random4(0, i, 1, 5), 0, &mut Rays::default()).x;
        let found = Estimate::new((0..20_000).map(|i| radiance(i) * PI));
        found.assert_is(expected, 0.1);
        errors.push(found.error);
    }
    println!("errors by power and by the tree: {errors:?}");
    assert!(errors[1] < 0.3 * errors[0], "{errors:?}");
}
