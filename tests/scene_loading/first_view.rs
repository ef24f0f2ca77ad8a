//! The camera of a scene that brings none.

use super::{Folder, warned};
use luminaire::glam::{Affine3A, DMat3, DVec2, DVec3, Vec3};
use luminaire::scene::build::{add, cube, empty, icosphere, matte, mesh, quad};
use luminaire::scene::{FirstView, Mesh, Projection, Scene, Sensor};

/// The picture of most tests, 4 : 3.
fn scene() -> Scene {
    empty(64, 48)
}

fn put(scene: &mut Scene, mesh: Mesh, map: Affine3A) {
    add(scene, mesh, matte(Vec3::ONE), map);
}

/// A box between two corners; `inward`: seen from within.
fn block(scene: &mut Scene, low: [f32; 3], high: [f32; 3], inward: bool) {
    open_block(scene, low, high, inward, None);
}

/// A box without one of its sides, which a direction names.
fn open_block(scene: &mut Scene, low: [f32; 3], high: [f32; 3], inward: bool, without: Option<Vec3>) {
    let (low, high) = (Vec3::from(low), Vec3::from(high));
    let mut block = cube();
    if let Some(side) = without {
        let positions = block.positions.clone();
        block.triangles.retain(|t| t.vertices.iter().any(|v| positions[*v as usize].dot(side) < 0.5));
    }
    if inward {
        block.triangles.iter_mut().for_each(|t| t.vertices.reverse());
    }
    let map = Affine3A::from_translation(0.5 * (low + high)) * Affine3A::from_scale(0.5 * (high - low));
    put(scene, block, map);
}

fn corners(scene: &Scene) -> Vec<[DVec3; 3]> {
    let mut corners = Vec::new();
    for object in &scene.objects {
        let mesh = &scene.meshes[object.mesh as usize];
        let at = |v: u32| object.object_to_world.transform_point3(mesh.positions[v as usize]).as_dvec3();
        corners.extend(mesh.triangles.iter().map(|t| t.vertices.map(at)));
    }
    corners
}

struct Eye {
    position: DVec3,
    /// Right, up, forward.
    axes: DMat3,
    /// Tangents of half the fields of view.
    tangents: DVec2,
}

impl Eye {
    fn of(scene: &Scene, sensor: &Sensor) -> Self {
        let Projection::Perspective { fov } = sensor.projection else { panic!("{sensor:?}") };
        let forward = (sensor.target.as_dvec3() - sensor.position.as_dvec3()).normalize();
        let right = forward.cross(sensor.up.as_dvec3()).normalize();
        let half = (f64::from(fov).to_radians() / 2.0).tan();
        let aspect = f64::from(scene.film.width) / f64::from(scene.film.height);
        Eye {
            position: sensor.position.as_dvec3(),
            axes: DMat3::from_cols(right, right.cross(forward), forward),
            tangents: DVec2::new(half * aspect, half),
        }
    }

    /// Where a point is in the picture: each coordinate from -1 to 1 within it.
    fn seen(&self, point: DVec3) -> DVec2 {
        let p = self.axes.transpose() * (point - self.position);
        assert!(p.z > 0.0, "{point} is behind the camera");
        p.truncate() / p.z / self.tangents
    }

    fn towards(&self) -> DVec3 {
        -self.axes.z_axis
    }
}

/// The extent of the picture of these points: least and greatest coordinates.
fn extent(eye: &Eye, points: impl Iterator<Item = DVec3>) -> [DVec2; 2] {
    points.map(|p| eye.seen(p)).fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[a, b], p| [a.min(p), b.max(p)])
}

/// All of the scene is in the picture, in its middle, and it fills it in one direction but for a margin of 5 to 8 %.
#[track_caller]
fn fills(scene: &Scene, eye: &Eye) {
    let [low, high] = extent(eye, corners(scene).into_iter().flatten());
    assert!((low + high).abs().max_element() < 0.02, "not in the middle: {low} to {high}");
    let margin = 0.5 * (1.0 - high.max_element());
    assert!((0.05..=0.08).contains(&margin), "a margin of {margin}: {low} to {high}");
}

/// The first triangle that a ray meets: how far, and whether it is its outward side.
fn met(triangles: &[[DVec3; 3]], origin: DVec3, direction: DVec3) -> Option<(f64, bool)> {
    let mut first: Option<(f64, bool)> = None;
    for [a, b, c] in triangles {
        let normal = (b - a).cross(c - a);
        let t = normal.dot(a - origin) / normal.dot(direction);
        let p = origin + t * direction;
        let inside = [(a, b), (b, c), (c, a)].iter().all(|(a, b)| (**b - **a).cross(p - **a).dot(normal) >= -1e-9);
        if t > 0.0 && inside && first.is_none_or(|(nearest, _)| t < nearest) {
            first = Some((t, normal.dot(direction) < 0.0));
        }
    }
    first
}

/// What the rays of a small picture meet.
fn picture(scene: &Scene, eye: &Eye) -> Vec<Option<(f64, bool)>> {
    let triangles = corners(scene);
    let at = |i: usize| (i as f64 + 0.5) / 16.0 - 1.0;
    let direction =
        |ray: usize| eye.axes * (eye.tangents * DVec2::new(at(ray % 32), at(ray / 32))).extend(1.0).normalize();
    (0..32 * 32).map(|ray| met(&triangles, eye.position, direction(ray))).collect()
}

fn view(scene: &Scene) -> (Eye, String) {
    let FirstView { sensor, place, .. } = scene.first_view(Vec3::Y);
    (Eye::of(scene, &sensor), place)
}

/// A closed room of 6 by 2.7 by 6 with a table, a wardrobe and a ball.
fn furnished() -> Scene {
    let mut scene = scene();
    block(&mut scene, [-3.0, 0.0, -3.0], [3.0, 2.7, 3.0], true);
    block(&mut scene, [-1.5, 0.7, -0.6], [0.1, 0.78, 0.4], false);
    for (x, z) in [(-1.4, -0.5), (-1.4, 0.3), (0.0, -0.5), (0.0, 0.3)] {
        block(&mut scene, [x - 0.04, 0.0, z - 0.04], [x + 0.04, 0.7, z + 0.04], false);
    }
    block(&mut scene, [1.6, 0.0, -2.8], [2.9, 2.0, -2.3], false);
    let ball = Affine3A::from_translation(Vec3::new(-0.8, 1.0, 0.0)) * Affine3A::from_scale(Vec3::splat(0.22));
    put(&mut scene, icosphere(2), ball);
    scene
}

/// A ball on a floor that rises behind it, far away, towards +z or -z.
fn before_a_backdrop(sign: f32) -> Scene {
    let mut scene = scene();
    let ball = Affine3A::from_translation(0.5 * Vec3::Y) * Affine3A::from_scale(Vec3::splat(0.5));
    put(&mut scene, icosphere(3), ball);
    let profile = [(0.0, -4.0), (0.0, 1.0), (0.0, 4.0), (2.0, 8.0), (9.0, 9.3)];
    for ((y0, z0), (y1, z1)) in profile.iter().zip(&profile[1..]) {
        let (a, b) = (Vec3::new(-9.0 * sign, *y0, z0 * sign), Vec3::new(-9.0 * sign, *y1, z1 * sign));
        put(&mut scene, quad(a, b - a, 18.0 * sign * Vec3::X), Affine3A::IDENTITY);
    }
    scene
}

#[test]
fn solid_things_are_seen_from_the_right_and_above_and_fill_the_picture() {
    for (width, height) in [(64, 64), (160, 90), (60, 100), (400, 100)] {
        for thing in [cube(), icosphere(3)] {
            let mut scene = empty(width, height);
            put(&mut scene, thing, Affine3A::from_scale(Vec3::new(1.0, 2.0, 1.5)));
            let (eye, place) = view(&scene);
            assert_eq!(place, "in front, a little to the right and above");
            fills(&scene, &eye);
            let towards = eye.towards();
            assert!(towards.z > towards.x && towards.x > 0.2 && (0.1..0.5).contains(&towards.y), "{towards}");
        }
    }
}

#[test]
fn a_ball_that_is_inside_out_is_no_room() {
    let mut ball = icosphere(3);
    ball.triangles.iter_mut().for_each(|t| t.vertices.reverse());
    let mut scene = scene();
    put(&mut scene, ball, Affine3A::IDENTITY);
    fills(&scene, &view(&scene).0);
}

#[test]
fn a_closed_box_is_seen_from_outside_whatever_is_in_it() {
    let mut scene = scene();
    put(&mut scene, cube(), Affine3A::IDENTITY);
    block(&mut scene, [-0.3, -0.3, -0.3], [0.3, 0.3, 0.3], false);
    fills(&scene, &view(&scene).0);
}

#[test]
fn an_open_box_is_looked_into() {
    for side in [Vec3::Z, Vec3::X, Vec3::NEG_X, Vec3::NEG_Z] {
        // Walls that turn their outward sides to the inside, those that do not, and thick ones.
        for walls in 0..3 {
            let mut scene = scene();
            open_block(&mut scene, [-1.0, 0.0, -1.0], [1.0, 2.0, 1.0], walls != 1, Some(side));
            if walls == 2 {
                open_block(&mut scene, [-1.1, -0.1, -1.1], [1.1, 2.1, 1.1], false, Some(side));
            }
            block(&mut scene, [-0.7, 0.0, -0.7], [-0.1, 1.1, -0.1], false);
            block(&mut scene, [0.1, 0.0, 0.0], [0.6, 0.5, 0.5], false);
            let (eye, place) = view(&scene);
            assert_eq!(place, "in front of the open side");
            assert!(eye.towards().distance(side.as_dvec3()) < 1e-5, "{side}: {}", eye.towards());
            fills(&scene, &eye);
        }
    }
}

#[test]
fn a_tray_is_looked_into_from_above() {
    let mut scene = scene();
    open_block(&mut scene, [-5.0, 0.0, -5.0], [5.0, 3.0, 5.0], true, Some(Vec3::Y));
    put(&mut scene, icosphere(2), Affine3A::from_translation(Vec3::Y));
    let (eye, place) = view(&scene);
    assert_eq!(place, "above the open side");
    assert!(eye.towards().y > 0.45, "{}", eye.towards());
    fills(&scene, &eye);
}

#[test]
fn a_pipe_is_seen_from_beside_and_a_tunnel_from_its_end() {
    for inward in [false, true] {
        let mut scene = scene();
        open_block(&mut scene, [-6.0, 0.0, -1.0], [6.0, 2.0, 1.0], inward, Some(Vec3::X));
        let mesh = std::sync::Arc::make_mut(&mut scene.meshes[0]);
        let positions = mesh.positions.clone();
        mesh.triangles.retain(|t| t.vertices.iter().any(|v| positions[*v as usize].x > 0.0));
        let (eye, place) = view(&scene);
        assert_eq!(place == "in front of the open side", inward, "{place}");
        fills(&scene, &eye);
    }
}

#[test]
fn in_a_room_the_camera_stands_inside() {
    for outer in [false, true] {
        let mut scene = furnished();
        if outer {
            block(&mut scene, [-3.2, -0.2, -3.2], [3.2, 2.9, 3.2], false);
        }
        let (eye, place) = view(&scene);
        assert_eq!(place, "inside, as of a room");
        assert!(eye.position.y > 0.7 && eye.position.y < 2.0, "{}", eye.position);
        let seen: Vec<(f64, bool)> =
            picture(&scene, &eye).into_iter().map(|met| met.expect("walls all around")).collect();
        let nearest = seen.iter().fold(f64::INFINITY, |nearest, (distance, _)| nearest.min(*distance));
        assert!(nearest > 0.4, "{nearest}");
        assert!(seen.iter().all(|(_, front)| *front), "no wall from behind");
        // Table and ball are in the picture.
        let ball = eye.seen(DVec3::new(-0.8, 1.0, 0.0));
        assert!(ball.abs().max_element() < 0.9, "{ball}");
    }
}

#[test]
fn a_room_whose_walls_are_wound_the_wrong_way_is_a_room() {
    let mut scene = furnished();
    let walls = std::sync::Arc::make_mut(&mut scene.meshes[0]);
    walls.triangles.iter_mut().for_each(|t| t.vertices.reverse());
    let (eye, place) = view(&scene);
    assert_eq!(place, "inside, as of a room");
    assert!(picture(&scene, &eye).iter().all(Option::is_some));
}

#[test]
fn along_a_corridor_one_looks_from_its_end() {
    let mut scene = scene();
    block(&mut scene, [-1.0, 0.0, -12.0], [1.0, 2.5, 12.0], true);
    let (eye, place) = view(&scene);
    assert_eq!(place, "inside, as of a room");
    let p = eye.position;
    assert!(p.x.abs() < 0.8 && p.z.abs() > 8.0 && p.z.abs() < 12.0, "{p}");
    assert!(eye.towards().z * p.z.signum() > 0.9, "{}", eye.towards());
}

#[test]
fn a_glass_case_is_seen_from_outside() {
    let mut scene = scene();
    block(&mut scene, [-3.0, 0.0, -3.0], [3.0, 2.7, 3.0], true);
    let glass = &mut scene.materials[0];
    (glass.eta, glass.transmission, glass.lambert) = (Some(1.5), Vec3::ONE, Vec3::ZERO);
    put(&mut scene, icosphere(3), Affine3A::from_translation(Vec3::Y));
    let (eye, place) = view(&scene);
    assert!(!place.contains("inside"), "{place}");
    fills(&scene, &eye);
}

#[test]
fn a_thing_before_a_backdrop_is_seen_from_before_it_and_near() {
    for sign in [1.0, -1.0] {
        let scene = before_a_backdrop(sign);
        let (eye, place) = view(&scene);
        assert!(place.contains("near what stands"), "{place}");
        assert!(eye.towards().z * f64::from(sign) < -0.3, "{}", eye.towards());
        let ball = corners(&scene).into_iter().take(20 << 6).flatten();
        let [low, high] = extent(&eye, ball);
        assert!(high.max_element() < 0.9 && (high - low).max_element() > 1.2, "{low} to {high}");
        let front = picture(&scene, &eye).into_iter().flatten().filter(|(_, front)| *front).count();
        assert!(front > 900, "{front} of 1024 rays meet an outward side");
    }
}

#[test]
fn bodies_that_reach_over_the_scene_are_no_backdrop() {
    let mut scene = scene();
    block(&mut scene, [-0.4, -0.4, -5.0], [0.4, 0.4, 5.0], false);
    block(&mut scene, [-5.0, -0.05, -1.0], [5.0, 0.05, 1.0], false);
    put(&mut scene, icosphere(3), Affine3A::from_translation(Vec3::new(0.0, 0.5, -4.0)));
    fills(&scene, &view(&scene).0);
}

#[test]
fn the_side_with_something_on_it_is_shown_rather_than_a_bare_one() {
    let mut scene = scene();
    block(&mut scene, [-5.0, 0.0, -0.5], [5.0, 6.0, 0.0], false);
    for (x, y) in (0..15).map(|i| ((i % 5) as f32 * 2.0 - 4.0, (i / 5) as f32 * 2.0 + 1.0)) {
        block(&mut scene, [x - 0.5, y - 0.6, -0.8], [x + 0.5, y + 0.6, -0.5], false);
    }
    let (eye, place) = view(&scene);
    assert!(place.starts_with("behind") && eye.towards().z < -0.5, "{place}");
}

#[test]
fn a_few_vertices_far_away_do_not_count() {
    let mut scene = scene();
    put(&mut scene, icosphere(3), Affine3A::IDENTITY);
    let expected = scene.first_view(Vec3::Y);
    for far in [100.0, 1e6] {
        let stray = quad(Vec3::new(far, 0.0, 0.0), Vec3::X, Vec3::Y);
        let mut scene = scene.clone();
        put(&mut scene, stray, Affine3A::IDENTITY);
        let found = scene.first_view(Vec3::Y);
        assert!(found.sensor.position.distance(expected.sensor.position) < 1e-3, "{found:?} for {expected:?}");
    }
    // But what reaches from the thing to there is no stray, as the walls of a room around it.
    block(&mut scene, [-2.0, -1.0, -2.0], [200.0, 20.0, 20.0], true);
    assert_eq!(view(&scene).1, "inside, as of a room");
}

#[test]
fn many_triangles_in_one_place_take_no_time() {
    let start = std::time::Instant::now();
    let mut thing = icosphere(1);
    thing.triangles = thing.triangles.repeat(1000);
    let mut scene = scene();
    put(&mut scene, thing, Affine3A::IDENTITY);
    let (eye, place) = view(&scene);
    assert_eq!(place, "in front, a little to the right and above");
    fills(&scene, &eye);
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
}

#[test]
fn a_flat_thing_is_seen_from_its_outward_side() {
    let edges = [
        (Vec3::X, Vec3::Y),
        (Vec3::Y, Vec3::X),
        (Vec3::Y, Vec3::Z),
        (Vec3::Z, Vec3::Y),
        (Vec3::Z, Vec3::X),
        (Vec3::X, Vec3::Z),
    ];
    for (a, b) in edges {
        let mut scene = scene();
        put(&mut scene, quad(Vec3::ZERO, a, b), Affine3A::IDENTITY);
        let (eye, place) = view(&scene);
        let slope = eye.towards().dot(a.cross(b).as_dvec3());
        assert!(slope > 0.35, "{place}: {slope}");
        fills(&scene, &eye);
    }
}

#[test]
fn size_and_place_of_the_scene_do_not_matter() {
    let mut expected: Option<DVec3> = None;
    for scale in [1.0, 1e-6, 1e9] {
        let mut scene = scene();
        put(&mut scene, icosphere(2), Affine3A::from_scale(Vec3::splat(scale)));
        block(&mut scene, [scale, 0.0, 0.0], [2.0 * scale, scale, scale], false);
        let (eye, _) = view(&scene);
        fills(&scene, &eye);
        let position = eye.position / f64::from(scale);
        assert!(position.distance(*expected.get_or_insert(position)) < 1e-4, "{position} at scale {scale}");
    }
}

#[test]
fn what_is_thin_or_small_has_a_camera() {
    let triangle = mesh(vec![Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]);
    for thing in [triangle, quad(Vec3::ZERO, Vec3::X, 1e-6 * Vec3::Y), quad(Vec3::ZERO, Vec3::Z, 1e-6 * Vec3::X)] {
        let mut scene = scene();
        put(&mut scene, thing, Affine3A::IDENTITY);
        fills(&scene, &view(&scene).0);
    }
    // Far from the origin no camera in single precision can be near; but it is one.
    let mut scene = scene();
    put(&mut scene, cube(), Affine3A::from_translation(Vec3::splat(1e6)));
    let sensor = scene.first_view(Vec3::Y).sensor;
    assert!(sensor.position.is_finite() && sensor.position.distance(sensor.target) > 1.0, "{sensor:?}");
}

#[test]
fn another_axis_may_be_up() {
    // A quarter turn that takes +y to +z, and so +z, the front, to -y.
    let turn = Affine3A::from_rotation_x(std::f32::consts::FRAC_PI_2);
    for upright in [furnished(), before_a_backdrop(1.0)] {
        let mut turned = upright.clone();
        turned.objects.iter_mut().for_each(|object| object.object_to_world = turn * object.object_to_world);
        let [expected, found] = [upright.first_view(Vec3::Y), turned.first_view(Vec3::Z)];
        assert_eq!(found.place, expected.place);
        let position = turn.transform_point3(expected.sensor.position);
        assert!(found.sensor.position.distance(position) < 1e-3, "{} for {position}", found.sensor.position);
        assert_eq!(found.sensor.up, Vec3::Z);
    }
}

#[test]
fn threads_do_not_matter() {
    let mut scene = before_a_backdrop(1.0);
    // Enough triangles to be simplified.
    put(&mut scene, icosphere(7), Affine3A::from_translation(0.5 * Vec3::Y));
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| scene.first_view(Vec3::Y))
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn a_scene_file_without_a_sensor_says_where_the_camera_stands() {
    let scene = Folder::new()
        .with("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        .with("scene.toml", "[[object]]\nmesh = \"mesh.obj\"\n[environment]\nradiance = [1, 1, 1]\n")
        .load("scene.toml");
    warned(&scene, &["no [sensor]", "the camera stands in front, a little to the right and above"]);
    fills(&scene, &Eye::of(&scene, &scene.sensor));
}
