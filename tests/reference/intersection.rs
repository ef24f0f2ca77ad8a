//! Hits: brute force against trees, against closed forms, and along edges.

use crate::common::scenes::*;
use glam::{Affine3A, DAffine3, DMat3, DVec3, Mat3, Vec3};
use luminaire::reference::Reference;
use luminaire::scene::{Mesh, Scene};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

fn in_cube(rng: &mut StdRng) -> DVec3 {
    DVec3::from_array(rng.random::<[f64; 3]>()) * 2.0 - 1.0
}

/// Triangles of all sizes, some of them needles.
fn soup(n: u32, rng: &mut StdRng) -> Mesh {
    let mut positions = vec![];
    for _ in 0..n {
        let size = 10f64.powf(rng.random_range(-3.0..0.0));
        let (corner, a, b) = (in_cube(rng), in_cube(rng) * size, in_cube(rng) * size);
        let b = if rng.random_bool(0.1) { a * 0.5 + b * 1e-3 } else { b };
        positions.extend([corner, corner + a, corner + b].map(|p| p.as_vec3()));
    }
    let triangles: Vec<_> = (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    mesh(positions, &triangles)
}

/// Moved, rotated, unevenly scaled, mirrored, sheared, far away, huge and tiny.
fn transforms() -> [Affine3A; 8] {
    let shear = Mat3::from_cols(Vec3::X, Vec3::new(0.8, 1.0, 0.0), Vec3::new(-0.5, 0.3, 1.0));
    [
        Affine3A::IDENTITY,
        Affine3A::from_rotation_z(0.7) * Affine3A::from_scale(Vec3::new(1.0, 0.05, 3.0)),
        Affine3A::from_translation(Vec3::X) * Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0)),
        Affine3A::from_mat3(shear) * Affine3A::from_rotation_x(1.0),
        Affine3A::from_translation(Vec3::new(1e5, -1e5, 3e4)),
        Affine3A::from_translation(Vec3::new(0.0, 1e6, 0.0)) * Affine3A::from_rotation_y(2.0),
        Affine3A::from_scale(Vec3::splat(1e3)),
        Affine3A::from_scale(Vec3::splat(1e-3)),
    ]
}

fn widened(map: &Affine3A) -> DAffine3 {
    let m = map.matrix3;
    DAffine3 {
        matrix3: DMat3::from_cols(m.x_axis.as_dvec3(), m.y_axis.as_dvec3(), m.z_axis.as_dvec3()),
        translation: map.translation.as_dvec3(),
    }
}

/// A world-space point to aim at: a corner, a point on an edge, or one inside a random triangle of a random object.
fn target(scene: &Scene, rng: &mut StdRng) -> DVec3 {
    let object = &scene.objects[rng.random_range(0..scene.objects.len())];
    let mesh = &scene.meshes[object.mesh as usize];
    let triangle = mesh.triangles[rng.random_range(0..mesh.triangles.len())];
    let to_world = widened(&object.object_to_world);
    let [a, b, c] = triangle.vertices.map(|v| to_world.transform_point3(mesh.positions[v as usize].as_dvec3()));
    match rng.random_range(0..3) {
        0 => a,
        1 => a.lerp(b, rng.random()),
        _ => a.lerp(b.lerp(c, rng.random()), rng.random()),
    }
}

/// Same hits, to the last bit, whether every triangle is tested or only those that the trees offer.
#[test]
fn trees_and_brute_force_agree() {
    let mut rng = StdRng::seed_from_u64(1);
    let mut scene = empty(1, 1);
    let meshes = [soup(120, &mut rng), soup(1, &mut rng), icosphere(1), cube()];
    for (i, map) in transforms().into_iter().enumerate() {
        add(&mut scene, meshes[i % meshes.len()].clone(), matte(Vec3::ZERO), map);
        add_instance(&mut scene, (i / 2) as u32, matte(Vec3::ZERO), map);
    }
    let (brute, fast) = (Reference::brute_force(&scene), Reference::new(&scene));
    let mut hits = 0;
    for i in 0..12_000 {
        let to = target(&scene, &mut rng);
        let distance = 10f64.powf(rng.random_range(-2.0..8.0));
        let mut direction = in_cube(&mut rng);
        if i % 4 == 0 {
            direction = DVec3::AXES[i / 4 % 3] * direction.x.signum();
        } else if i % 4 == 1 {
            direction[i / 4 % 3] = 0.0;
        }
        let origin = to - direction * distance;
        direction *= 10f64.powi(rng.random_range(-3..3));
        let (a, b) = (
            brute.closest_hit(origin, direction, f64::INFINITY, 0),
            fast.closest_hit(origin, direction, f64::INFINITY, 0),
        );
        assert_eq!(a, b, "ray {i} from {origin} along {direction}");
        hits += u32::from(a.is_some());
        for t_max in [0.5, 1.0, 2.0].map(|f| f * a.map_or(1.0, |hit| hit.t)) {
            let expected = brute.closest_hit(origin, direction, t_max, 0);
            assert_eq!(fast.closest_hit(origin, direction, t_max, 0), expected);
            assert_eq!(fast.occluded(origin, direction, t_max, 0), expected.is_some());
            assert_eq!(brute.occluded(origin, direction, t_max, 0), expected.is_some());
        }
    }
    assert!(hits > 6_000, "only {hits} hits: the test tests little");
}

/// From inside a closed mesh every ray hits, also straight through edges and corners.
#[test]
fn closed_meshes_do_not_leak() {
    let mut rng = StdRng::seed_from_u64(2);
    for (map, ball) in transforms().into_iter().flat_map(|m| [(m, true), (m, false)]) {
        let mut scene = empty(1, 1);
        add(&mut scene, if ball { icosphere(3) } else { cube() }, matte(Vec3::ZERO), map);
        let fast = Reference::new(&scene);
        for i in 0..5_000 {
            let origin = widened(&map).transform_point3(in_cube(&mut rng) * 0.5);
            let to = target(&scene, &mut rng);
            let hit = fast.closest_hit(origin, to - origin, f64::INFINITY, 0);
            let hit = hit.unwrap_or_else(|| panic!("ray {i} from {origin} to {to} leaks"));
            // Convex: nothing is nearer than the target. Coordinates of 1e6 are good to 1e-10 in a mesh of size 1.
            assert!((hit.t - 1.0).abs() < 1e-8, "ray {i}: t = {}", hit.t);
        }
    }
}

/// The weights, the distance and the ray meet in one point, on the sphere but for the sag of its facets.
#[test]
fn hits_lie_on_the_ray_and_on_the_surface() {
    let mut rng = StdRng::seed_from_u64(3);
    let mut scene = empty(1, 1);
    add(&mut scene, icosphere(4), matte(Vec3::ZERO), Affine3A::IDENTITY);
    let tracer = Reference::new(&scene);
    let mut hits = 0;
    for _ in 0..20_000 {
        let origin = in_cube(&mut rng) * 3.0;
        let direction = in_cube(&mut rng) * 1.2 - origin;
        // Nearest positive root of |origin + t direction| = 1; the facets are at most 2e-3 inside, and f32
        // puts the corners up to 1e-7 outside.
        let nearest = |radius: f64| {
            let (a, b, c) =
                (direction.length_squared(), origin.dot(direction), origin.length_squared() - radius * radius);
            let root = (b * b - a * c).sqrt();
            [(-b - root) / a, (-b + root) / a].into_iter().find(|t| *t > 0.0)
        };
        let hit = tracer.closest_hit(origin, direction, f64::INFINITY, 0);
        match (nearest(1.0 - 2e-3), nearest(1.0 + 1e-7), hit) {
            (Some(inner), Some(outer), hit) => {
                let hit = hit.expect("a ray into the inner sphere hits");
                let (low, high) = (inner.min(outer), inner.max(outer));
                assert!(hit.t >= low && hit.t <= high + 1e-12, "{} is not in [{low}, {high}]", hit.t);
                let [b1, b2] = hit.barycentrics;
                assert!(b1 >= 0.0 && b2 >= 0.0 && b1 + b2 <= 1.0 + 1e-15);
                let vertices = scene.meshes[0].triangles[hit.triangle as usize].vertices;
                let [a, b, c] = vertices.map(|v| scene.meshes[0].positions[v as usize].as_dvec3());
                let point = a * (1.0 - b1 - b2) + b * b1 + c * b2;
                assert!((origin + hit.t * direction - point).length() < 1e-12);
                hits += 1;
            }
            (None, None, hit) => assert_eq!(hit, None),
            _ => {} // Between the spheres: either may be right.
        }
    }
    assert!(hits > 10_000, "only {hits} hits: the test tests little");
}

/// `t` is strictly between 0 and `t_max`, in multiples of the direction.
#[test]
fn the_interval_is_open() {
    let mut scene = empty(1, 1);
    add(
        &mut scene,
        quad(Vec3::new(-1.0, -1.0, -4.0), Vec3::X * 2.0, Vec3::Y * 2.0),
        matte(Vec3::ZERO),
        Affine3A::IDENTITY,
    );
    for tracer in [Reference::new(&scene), Reference::brute_force(&scene)] {
        let origin = DVec3::new(0.25, 0.5, 0.0);
        let hit = tracer.closest_hit(origin, DVec3::new(0.0, 0.0, -2.0), f64::INFINITY, 0).expect("a hit");
        assert_eq!(hit.t, 2.0);
        assert!(tracer.closest_hit(origin, -DVec3::Z, 4.0, 0).is_none());
        assert!(tracer.closest_hit(origin, -DVec3::Z, 4.0f64.next_up(), 0).is_some());
        assert!(!tracer.occluded(origin, -DVec3::Z, 4.0, 0));
        assert!(tracer.occluded(origin, -DVec3::Z, 4.0f64.next_up(), 0));
        assert!(!tracer.occluded(origin, DVec3::Z, f64::INFINITY, 0));
        assert!(
            !tracer.occluded(origin - 4.0 * DVec3::Z, -DVec3::Z, f64::INFINITY, 0),
            "a ray that starts on a surface"
        );
        assert!(tracer.occluded(origin, -DVec3::Z * 1e-300, f64::INFINITY, 0));
        for bad in [DVec3::ZERO, DVec3::NAN, DVec3::new(0.0, f64::NAN, -1.0), DVec3::NEG_INFINITY] {
            assert!(tracer.closest_hit(origin, bad, f64::INFINITY, 0).is_none());
            assert!(!tracer.occluded(origin, bad, f64::INFINITY, 0));
        }
        assert!(tracer.closest_hit(DVec3::NAN, -DVec3::Z, f64::INFINITY, 0).is_none());
    }
}

/// Trees are built for any number of boxes and any `f32` size.
#[test]
fn extreme_meshes() {
    for scale in [1e-30f32, 1.0, 1e18, 1e30] {
        for n in [1, 2, 3, 50] {
            let mut scene = empty(1, 1);
            let mut positions = vec![];
            for i in 0..n {
                let corner = Vec3::new(i as f32, 0.0, 0.0) * scale;
                positions.extend([corner, corner + Vec3::X * scale, corner + Vec3::Y * scale]);
            }
            let triangles: Vec<_> = (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            add(&mut scene, mesh(positions, &triangles), matte(Vec3::ZERO), Affine3A::IDENTITY);
            let tracer = Reference::new(&scene);
            for i in 0..n {
                let size = f64::from(scale);
                let origin = DVec3::new(f64::from(i) + 0.25, 0.25, 1.0) * size;
                let hit = tracer.closest_hit(origin, -DVec3::Z, f64::INFINITY, 0).expect("a hit");
                assert_eq!(hit.triangle, i, "scale {scale}, {n} triangles");
                assert!((hit.t / size - 1.0).abs() < 1e-15, "scale {scale}: t = {}", hit.t);
            }
        }
    }
}
