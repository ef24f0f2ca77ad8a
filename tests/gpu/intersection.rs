//! Hits: the compute BVH and the driver's ray queries against brute force in f64.

use super::*;
use crate::common::scenes::*;
use glam::{Affine3A, DAffine3, DMat3, DVec3, Mat3, Vec3};
use luminaire::gpu::probe::{Function, Probe};
use luminaire::reference::Reference;
use luminaire::reference::hit::Hit;
use luminaire::scene::{Mesh, Scene};
use luminaire_measure::rays::{self, Ray};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// What a backend or the oracle found: (t, object, triangle), or nothing.
type Found = Option<(f64, u32, u32)>;

fn probe(backend: &Intersector, scene: &Scene) -> Probe {
    Probe::new(&backend.device, scene, backend.ray_query).expect("a probe")
}

fn hits(probe: &Probe, function: Function, rays: &[Ray]) -> Vec<Found> {
    rays::probe_hits(probe, function, rays).expect("the probe runs").into_iter().map(found).collect()
}

fn oracle_hits(oracle: &Reference, rays: &[Ray]) -> Vec<Found> {
    rays::reference_hits(oracle, rays).into_iter().map(found).collect()
}

fn found(hit: Option<Hit>) -> Found {
    hit.map(|hit| (hit.t, hit.object, hit.triangle))
}

fn in_cube(rng: &mut StdRng) -> Vec3 {
    Vec3::from_array(rng.random::<[f32; 3]>()) * 2.0 - 1.0
}

fn on_sphere(rng: &mut StdRng) -> Vec3 {
    loop {
        let v = in_cube(rng);
        if v.length_squared() > 0.01 && v.length_squared() <= 1.0 {
            return v.normalize();
        }
    }
}

/// Loose triangles of all sizes.
fn soup(n: u32, rng: &mut StdRng) -> Mesh {
    let mut positions = vec![];
    for _ in 0..n {
        let size = 10f32.powf(rng.random_range(-2.0..0.0));
        let (corner, a, b) = (in_cube(rng), in_cube(rng) * size, in_cube(rng) * size);
        positions.extend([corner, corner + a, corner + b]);
    }
    let triangles: Vec<_> = (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    mesh(positions, &triangles)
}

/// How often a backend and the oracle disagree.
#[derive(Debug, Default)]
struct Disagreement {
    hits: usize,
    hit_or_miss: usize,
    other_triangle: usize,
    /// Difference of t where both hit the same triangle, relative to t and the size of the scene: 99.9th percentile, and largest.
    distance: [f64; 2],
}

fn disagreement(found: &[Found], expected: &[Found]) -> Disagreement {
    let mut d = Disagreement::default();
    let mut distances = vec![0.0];
    for (f, e) in found.iter().zip(expected) {
        match (f, e) {
            (Some(f), Some(e)) => {
                d.hits += 1;
                // Two triangles at one place (a shared edge) are no disagreement.
                let off = (f.0 - e.0).abs() / (e.0 + 1.0);
                if (f.1, f.2) == (e.1, e.2) || off < 1e-6 {
                    distances.push(off);
                } else {
                    d.other_triangle += 1;
                }
            }
            (None, None) => {}
            _ => d.hit_or_miss += 1,
        }
    }
    distances.sort_by(f64::total_cmp);
    let last = distances.len() - 1;
    d.distance = [distances[last - last / 1000], distances[last]];
    d
}

fn random_rays(n: usize, rng: &mut StdRng, spread: f32) -> Vec<Ray> {
    (0..n)
        .map(|i| {
            let origin = in_cube(rng) * spread;
            // Some along the axes, some not of unit length, some that end early.
            let mut direction = if i % 2 == 0 { on_sphere(rng) } else { in_cube(rng) - origin };
            if i % 10 == 0 {
                direction[i / 10 % 3] = 0.0;
            }
            let t_max = if i % 5 == 0 { rng.random::<f32>() } else { f32::INFINITY };
            Ray { origin, direction, t_max }
        })
        .collect()
}

fn instanced(rng: &mut StdRng) -> Scene {
    let mut scene = empty(1, 1);
    let shear = Mat3::from_cols(Vec3::X, Vec3::new(0.8, 1.0, 0.0), Vec3::new(-0.5, 0.3, 1.0));
    let soup = add(&mut scene, soup(300, rng), matte(Vec3::ZERO), Affine3A::IDENTITY);
    let ball = add(&mut scene, icosphere(2), matte(Vec3::ZERO), Affine3A::from_scale(Vec3::splat(0.3)));
    for i in 0..40 {
        let place = Affine3A::from_translation(in_cube(rng) * 3.0) * Affine3A::from_rotation_y(i as f32);
        let shape = match i % 4 {
            0 => Affine3A::from_scale(Vec3::new(0.5, 0.02, 1.0)),
            1 => Affine3A::from_scale(Vec3::new(-0.4, 0.4, 0.4)),
            2 => Affine3A::from_mat3(shear) * Affine3A::from_scale(Vec3::splat(0.3)),
            _ => Affine3A::from_scale(Vec3::splat(0.2)),
        };
        add_instance(&mut scene, if i % 3 == 0 { soup } else { ball }, matte(Vec3::ZERO), place * shape);
    }
    scene
}

/// Rays that graze no edge on purpose: at most 1 in 10 000 may differ, so that what is wrong for 1 in 1500 is found with a probability of 99 % in each
/// scene. t agrees to 1e-6 of itself and the size of the scene in 999 of 1000; the rest are slants.
#[test]
fn generic_rays_hit_what_brute_force_hits() {
    let mut rng = StdRng::seed_from_u64(11);
    let mut single = empty(1, 1);
    add(&mut single, soup(3000, &mut rng), matte(Vec3::ZERO), Affine3A::IDENTITY);
    single.objects[0].material = None;
    let mut one_triangle = empty(1, 1);
    add(&mut one_triangle, soup(1, &mut rng), matte(Vec3::ZERO), Affine3A::IDENTITY);
    for (name, scene, spread) in
        [("one mesh", single, 1.5), ("instances", instanced(&mut rng), 4.0), ("one triangle", one_triangle, 1.5)]
    {
        let rays = random_rays(10_000, &mut rng, spread);
        let expected = oracle_hits(&Reference::brute_force(&scene), &rays);
        on_every_backend(|backend| {
            let probe = probe(backend, &scene);
            let d = disagreement(&hits(&probe, Function::ClosestHit, &rays), &expected);
            println!("{name}, {}, of {} rays: {d:?}", backend.name(), rays.len());
            assert!(d.hit_or_miss + d.other_triangle <= rays.len() / 10_000, "{name}, {}: {d:?}", backend.name());
            assert!(d.distance[0] < 1e-6 && d.distance[1] < 1e-4, "{name}, {}: {d:?}", backend.name());

            let calls: Vec<_> = rays.iter().map(Ray::call).collect();
            let shadows = probe.call(Function::Occluded, &calls).expect("the probe runs");
            let differ = shadows.iter().zip(&expected).filter(|(s, e)| (s[0][0] != 0) != e.is_some()).count();
            assert!(differ <= rays.len() / 10_000, "{name}, {}: {differ} shadow rays differ", backend.name());
        });
    }
}

/// From inside a closed mesh, aimed at points on edges and at vertices: none may leave through our BVH. The driver's ray query
/// is not ours to mend: it is measured, and may lose 5 % at the vertices. A leak of 1 ray in 30 000 is found with a probability of 99 % over all of them.
#[test]
fn nothing_leaks_through_edges_and_vertices() {
    let mut rng = StdRng::seed_from_u64(12);
    let turned = Affine3A::from_rotation_x(0.3) * Affine3A::from_rotation_z(0.7);
    let far = Affine3A::from_translation(Vec3::new(1e3, -2e3, 500.0));
    let thin = turned * Affine3A::from_scale(Vec3::new(1.0, 0.1, 3.0));
    for (name, map) in [("as it is", Affine3A::IDENTITY), ("turned and stretched", thin), ("far away", far * turned)] {
        let mut scene = empty(1, 1);
        add(&mut scene, icosphere(3), matte(Vec3::ZERO), map);
        let mesh = &scene.meshes[0];
        for (target, share) in [("edges", 0.02), ("vertices", 0.05)] {
            let rays: Vec<Ray> = (0..25_000)
                .map(|_| {
                    let triangle = mesh.triangles[rng.random_range(0..mesh.triangles.len())];
                    let [a, b, _] = triangle.vertices.map(|v| mesh.positions[v as usize]);
                    let along = if target == "edges" { rng.random::<f32>() } else { 0.0 };
                    let to = map.transform_point3(a.lerp(b, along));
                    let origin = map.transform_point3(in_cube(&mut rng) * 0.5);
                    Ray { origin, direction: to - origin, t_max: f32::INFINITY }
                })
                .collect();
            on_every_backend(|backend| {
                let found = hits(&probe(backend, &scene), Function::ClosestHit, &rays);
                let leaks = found.iter().filter(|f| f.is_none()).count();
                println!("{name}, {target}, {}: {leaks} leaks of {} rays", backend.name(), rays.len());
                let allowed = if backend.ray_query { (share * rays.len() as f64) as usize } else { 0 };
                assert!(leaks <= allowed, "{name}, {target}, {}: {leaks} leaks", backend.name());
            });
        }
    }
}

/// Rays that skim a plane at a slope from 1e-1 to 1e-5 hit it where they should, or miss it where they should.
#[test]
fn grazing_rays_agree() {
    let mut rng = StdRng::seed_from_u64(13);
    let mut scene = empty(1, 1);
    let map = Affine3A::from_rotation_x(0.3) * Affine3A::from_rotation_z(0.7);
    add(&mut scene, quad(Vec3::new(-4.0, 0.0, -4.0), Vec3::X * 8.0, Vec3::Z * 8.0), matte(Vec3::ZERO), map);
    let rays: Vec<Ray> = (0..10_000)
        .map(|_| {
            let slope = 10f32.powf(rng.random_range(-5.0..-1.0));
            let along = Vec3::new(rng.random::<f32>() - 0.5, 0.0, rng.random::<f32>() - 0.5).normalize();
            let below = if rng.random_bool(0.5) { -1.0 } else { 1.0 };
            // Aimed to meet the plane about 1 away, in its middle.
            let origin = Vec3::new(rng.random::<f32>(), slope, rng.random::<f32>());
            let direction = along - below * slope * Vec3::Y;
            Ray {
                origin: map.transform_point3(origin),
                direction: map.transform_vector3(direction),
                t_max: f32::INFINITY,
            }
        })
        .collect();
    let expected = oracle_hits(&Reference::brute_force(&scene), &rays);
    on_every_backend(|backend| {
        let found = hits(&probe(backend, &scene), Function::ClosestHit, &rays);
        let hit_or_miss = found.iter().zip(&expected).filter(|(f, e)| f.is_some() != e.is_some()).count();
        // In units of rounding (2^-24) over the slope: how far the hit slides along the plane.
        let slide = |f: &Found, e: &Found, r: &Ray| {
            let rise = (map.inverse().transform_vector3(r.direction).y / r.direction.length()).abs();
            (f.unwrap().0 - e.unwrap().0).abs() * f64::from(rise) * 16_777_216.0
        };
        let slides = found.iter().zip(&expected).zip(&rays).filter(|((f, e), _)| f.is_some() && e.is_some());
        let largest = slides.map(|((f, e), r)| slide(f, e, r)).fold(0.0, f64::max);
        println!(
            "{}: {hit_or_miss} of {} rays differ, hits are off by {largest:.1} roundings",
            backend.name(),
            rays.len()
        );
        assert!(hit_or_miss <= 10, "{}: {hit_or_miss}", backend.name());
        assert!(largest < 100.0, "{}: {largest}", backend.name());
    });
}

/// A ray that leaves a surface does not meet it again at once, whatever the size, the place and the angle: from inside a convex
/// shell the second hit is on another triangle. What is wrong for 1 ray in 35 000 is found with a probability of 99 % over all of them.
#[test]
fn surfaces_do_not_hit_themselves() {
    let mut rng = StdRng::seed_from_u64(14);
    let turned = Affine3A::from_rotation_x(0.3) * Affine3A::from_rotation_z(0.7);
    let at = |x: f32| Affine3A::from_translation(Vec3::new(x, -0.7 * x, 0.3 * x));
    let scaled = |s: f32| Affine3A::from_scale(Vec3::splat(s));
    let maps = [
        ("plain", Affine3A::IDENTITY),
        ("turned", turned),
        ("1e3 away", at(1e3) * turned),
        ("1e5 away", at(1e5) * turned),
        ("1e4 large", scaled(1e4) * turned),
        ("1e-4 small", scaled(1e-4) * turned),
        ("flat", turned * Affine3A::from_scale(Vec3::new(1.0, 0.01, 1.0))),
        ("mirrored", Affine3A::from_scale(Vec3::new(-1.0, 2.0, 1.0)) * turned),
    ];
    for (shape, mesh) in [("cube", cube()), ("ball", icosphere(3))] {
        for (name, map) in maps {
            // Once as an instance, once with the transform in the vertices.
            for baked in [false, true] {
                let mut mesh = mesh.clone();
                let mut instance = map;
                if baked {
                    mesh.positions.iter_mut().for_each(|p| *p = map.transform_point3(*p));
                    instance = Affine3A::IDENTITY;
                }
                let mut scene = empty(1, 1);
                add(&mut scene, mesh, matte(Vec3::ZERO), instance);
                if baked {
                    scene.objects[0].material = None;
                }
                let rays: Vec<Ray> = (0..5_000)
                    .map(|_| {
                        let origin = map.transform_point3(in_cube(&mut rng) * 0.3);
                        let direction = map.transform_vector3(on_sphere(&mut rng)).normalize();
                        Ray { origin, direction, t_max: f32::INFINITY }
                    })
                    .collect();
                on_every_backend(|backend| {
                    let probe = probe(backend, &scene);
                    let first = hits(&probe, Function::ClosestHit, &rays);
                    let second = hits(&probe, Function::Leave, &rays);
                    let lost = second.iter().zip(&first).filter(|(s, f)| f.is_some() && s.is_none()).count();
                    let same = second
                        .iter()
                        .zip(&first)
                        .filter(|(s, f)| matches!((s, f), (Some(s), Some(f)) if (s.1, s.2) == (f.1, f.2)))
                        .count();
                    let place = format!("{shape}, {name}, baked {baked}, {}", backend.name());
                    assert_eq!(same, 0, "{place}: {same} of {} rays hit their own triangle", rays.len());
                    // Where the hit is within rounding of another face, the position itself may lie behind that face.
                    let (low, high) = scene.world_bounds();
                    let rounding = low.abs().max(high.abs()).max_element() * f64::from(f32::EPSILON);
                    let inverse = map.matrix3.inverse().transpose();
                    let widths = [inverse.x_axis, inverse.y_axis, inverse.z_axis].map(|a| 2.0 / f64::from(a.length()));
                    let near = 16.0 * rounding / widths.into_iter().fold(f64::INFINITY, f64::min);
                    let vertices = if backend.ray_query { 1e-3 } else { 0.0 };
                    let allowed = ((near + vertices) * rays.len() as f64) as usize;
                    println!("{place}: {lost} of {} rays got out, {allowed} may", rays.len());
                    assert!(lost <= allowed, "{place}: {lost} rays got out, {allowed} may");
                });
            }
        }
    }
}

/// Rays that are none hit nothing, and hang nothing.
#[test]
fn rays_that_are_none_miss() {
    let mut scene = empty(1, 1);
    add(&mut scene, icosphere(1), matte(Vec3::ZERO), Affine3A::IDENTITY);
    let bad = [0.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    let mut rays = Vec::new();
    for x in bad {
        for y in bad {
            rays.push(Ray { origin: Vec3::ZERO, direction: Vec3::new(x, y, 0.0), t_max: f32::INFINITY });
        }
    }
    on_every_backend(|backend| {
        // What the driver's ray query does with these is undefined.
        if !backend.ray_query {
            let found = hits(&probe(backend, &scene), Function::ClosestHit, &rays);
            assert!(found.iter().all(Option::is_none), "{found:?}");
        }
    });
}

/// Thousands of triangles in one place: the build ends, and either traces or says why not.
#[test]
fn duplicates_are_traced_or_refused() {
    let mut scene = empty(1, 1);
    let positions = vec![Vec3::new(-1.0, -1.0, -2.0), Vec3::new(1.0, -1.0, -2.0), Vec3::new(0.0, 1.0, -2.0)];
    add(&mut scene, mesh(positions, &[[0, 1, 2]; 8_000]), matte(Vec3::ZERO), Affine3A::IDENTITY);
    let ray = Ray { origin: Vec3::ZERO, direction: -Vec3::Z, t_max: f32::INFINITY };
    on_every_backend(|backend| match Probe::new(&backend.device, &scene, backend.ray_query) {
        Ok(probe) => {
            let result = probe.call(Function::ClosestHit, &[ray.call()]).expect("the probe runs");
            assert_eq!(f32::from_bits(result[0][0][0]), 2.0);
        }
        Err(luminaire::Error::Limit { .. }) => {}
        Err(e) => panic!("{e}"),
    });
}

/// The map that the oracle uses, for a test of the tests: brute force sees an instance where its transform puts it.
#[test]
fn oracle_sees_instances_in_place() {
    let mut scene = empty(1, 1);
    let map = Affine3A::from_translation(Vec3::new(0.0, 0.0, -10.0)) * Affine3A::from_scale(Vec3::new(1.0, 1.0, 2.0));
    add(&mut scene, cube(), matte(Vec3::ZERO), map);
    let found = oracle_hits(
        &Reference::brute_force(&scene),
        &[Ray { origin: Vec3::new(0.1, 0.2, 0.0), direction: -Vec3::Z, t_max: f32::INFINITY }],
    );
    let m: DAffine3 =
        DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(1.0, 1.0, 2.0)), translation: DVec3::Z * -10.0 };
    assert_eq!(found[0].map(|f| f.0), Some(-m.transform_point3(DVec3::Z).z));
}
