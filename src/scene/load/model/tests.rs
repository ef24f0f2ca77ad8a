//! Models in code: many meshes, mirrored, flat and none; cameras and luminaires.

use super::*;
use crate::scene::build::{cube, pinhole, quad};
use crate::scene::load::bare_mesh::{self, BareMesh};
use crate::scene::load::choices::{Choices, Sky, Up};
use crate::scene::load::format::Format;
use crate::scene::load::loader::{AboutMesh, Loader};
use crate::scene::{Mesh, Projection, Scene, Side, widen};
use glam::{DMat3, DQuat, Vec2};
use std::f64::consts::FRAC_PI_2;
use std::path::Path;

fn at(x: f64, y: f64, z: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, y, z))
}

fn mirrored() -> DAffine3 {
    at(5.0, 1.0, 0.0) * DAffine3::from_scale(DVec3::new(-2.0, 1.0, 0.5))
}

/// A loader with a cube and a square of edge 2, and a model of them: each mesh's number, where it stands and its name.
fn made(placed: &[(u32, DAffine3, &str)]) -> (Loader, Model) {
    let mut loader = Loader::new(Vec::new());
    for mesh in [cube(), quad(Vec3::ZERO, 2.0 * Vec3::X, 2.0 * Vec3::Y)] {
        loader.add(mesh, AboutMesh::default()).unwrap();
    }
    let placed =
        placed.iter().map(|(mesh, matrix, name)| Placed { mesh: *mesh, matrix: *matrix, name: (*name).into() });
    (loader, Model { placed: placed.collect(), ..Model::default() })
}

fn bare((loader, model): (Loader, Model), choices: &Choices) -> crate::Result<BareMesh> {
    bare_mesh::build(Path::new("a.obj"), &model, loader, choices)
}

fn scene(made: (Loader, Model), choices: &Choices) -> Scene {
    bare(made, choices).unwrap().scene
}

/// The corners of all but the ground, in the world.
fn corners(scene: &Scene) -> Vec<DVec3> {
    let own = (0..).zip(&scene.objects).filter(|(index, _)| scene.ground != Some(*index));
    own.flat_map(|(_, object)| {
        let to_world = widen(object.object_to_world);
        scene.meshes[object.mesh as usize].corners().into_iter().map(move |corner| to_world.transform_point3(corner))
    })
    .collect()
}

#[test]
fn many_meshes_stand_where_they_are_placed() {
    let placed = [(0, at(0.0, 1.0, 0.0), "left"), (0, mirrored(), "right"), (1, at(0.0, 0.5, 3.0), "sheet")];
    let scene = scene(made(&placed), &Choices::default());
    assert_eq!(scene.warnings, Vec::<String>::new());
    let names: Vec<&str> = scene.objects.iter().map(|object| &*object.name).collect();
    assert_eq!(names, ["left", "right", "sheet", "ground"]);
    assert_eq!((scene.meshes.len(), scene.ground), (3, Some(3)));
    for ((mesh, matrix, _), object) in placed.iter().zip(&scene.objects) {
        assert_eq!((object.mesh, widen(object.object_to_world)), (*mesh, *matrix));
    }
    assert!(scene.objects[1].object_to_world.matrix3.determinant() < 0.0);
    // The camera sees all of it.
    assert_eq!(scene.tight_bounds(), (DVec3::new(-1.0, 0.0, -1.0), DVec3::new(7.0, 2.5, 3.0)));
    let eye = scene.sensor.position.as_dvec3();
    let forward = (scene.sensor.target.as_dvec3() - eye).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let Projection::Perspective { fov } = scene.sensor.projection else { panic!("{:?}", scene.sensor) };
    let half = (0.5 * f64::from(fov)).to_radians().tan();
    for corner in corners(&scene) {
        let seen = corner - eye;
        let depth = seen.dot(forward);
        let [x, y] = [right, right.cross(forward)].map(|axis| seen.dot(axis) / (half * depth));
        assert!(depth > 0.0 && x.abs() <= 1.0 && y.abs() <= 1.0, "{corner}: {x} {y}");
    }
    // The ground lies a hair below the lowest of them.
    let ground = scene.meshes[2].bounds().0.y;
    assert!((-0.01..0.0).contains(&ground), "{ground}");
}

/// A floor of one mesh and a thing of another are what one mesh of both is.
#[test]
fn a_mesh_may_be_the_ground_of_others() {
    let floor = DAffine3::from_scale(DVec3::splat(10.0)) * DAffine3::from_rotation_x(-FRAC_PI_2);
    let placed = [(0, at(4.0, 1.0, -4.0), "thing"), (1, floor, "floor")];
    assert_eq!(scene(made(&placed), &Choices::default()).ground, None);
    assert!(scene(made(&placed[..1]), &Choices::default()).ground.is_some());
}

#[test]
fn z_up_turns_what_is_placed() {
    let choices = Choices { up: Some(Up::Z), ..Choices::default() };
    let placed = [(0, at(0.0, 0.0, 1.0), "low"), (0, at(1.0, 2.0, 5.0), "high")];
    let scene = scene(made(&placed), &choices);
    let place = |index: usize| scene.objects[index].object_to_world.translation;
    assert_eq!([place(0), place(1)].map(Vec3::from), [Vec3::new(0.0, 1.0, 0.0), Vec3::new(1.0, 5.0, -2.0)]);
}

#[test]
fn what_is_empty_or_flat_is_said() {
    let mut loader = Loader::new(Vec::new());
    assert_eq!(loader.add(Mesh::default(), AboutMesh::default()), None);
    let says = |made: (Loader, Model), words: &[&str]| {
        let error = bare(made, &Choices::default()).unwrap_err();
        assert_eq!(error.exit_code(), 1);
        assert!(words.iter().all(|word| error.to_string().contains(word)), "{error}");
    };
    says((loader, Model::default()), &["a.obj", "nothing to trace", "no mesh with triangles"]);
    let flat = DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0));
    let tiny = DAffine3::from_scale(DVec3::splat(1e-40));
    let huge = at(1e39, 0.0, 0.0);
    let odd = DAffine3::from_scale(DVec3::splat(f64::NAN));
    says(made(&[(0, flat, "a"), (0, odd, "b")]), &["nothing to trace", "all of its 2 objects"]);
    for map in [flat, tiny, huge, odd] {
        let found = scene(made(&[(0, map, "gone"), (0, DAffine3::IDENTITY, "here")]), &Choices::default());
        assert_eq!(found.objects[0].name, "here");
        assert!(found.warnings.len() == 1 && found.warnings[0].contains("`gone` left out"), "{:?}", found.warnings);
    }
    says(made(&[(0, at(1e20, 0.0, 0.0), "far")]), &["1e18"]);
}

/// A camera of its own space at a place.
fn camera(name: &str, fov: f32, matrix: DAffine3) -> (Camera, DAffine3) {
    (Camera { name: name.into(), sensor: pinhole(Vec3::ZERO, -Vec3::Z, Vec3::Y, fov) }, matrix)
}

#[test]
fn cameras_stand_where_the_file_has_them() {
    let (loader, model) = made(&[(0, DAffine3::IDENTITY, "cube")]);
    // From +x, held on its side, in a space of another size.
    let aside = at(9.0, 0.0, 0.0)
        * DAffine3::from_scale(DVec3::splat(3.0))
        * DAffine3::from_mat3(DMat3::from_quat(DQuat::from_rotation_y(FRAC_PI_2) * DQuat::from_rotation_z(FRAC_PI_2)));
    let away = at(0.0, 0.0, 7.0) * DAffine3::from_rotation_y(2.0 * FRAC_PI_2);
    let flat = DAffine3::from_scale(DVec3::ZERO);
    let parallel = DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::Z));
    let cameras = vec![
        camera("aside", 50.0, aside),
        camera("", 40.0, at(0.0, 0.0, 8.0)),
        camera("aside", 40.0, away),
        camera("flat", 40.0, flat),
        camera("parallel", 40.0, parallel),
    ];
    let bare = bare((loader, Model { cameras, ..model }), &Choices::default()).unwrap();
    let found = &bare.scene;
    let names: Vec<&str> = found.cameras.iter().map(|camera| &*camera.name).collect();
    assert_eq!(names, ["aside", "camera", "aside 2"]);
    assert!(found.warnings.len() == 2 && found.warnings[0].contains("`flat`"), "{:?}", found.warnings);
    let near = |a: Vec3, b: Vec3| assert!(a.distance(b) < 1e-6, "{a} {b}");
    let sensor = &found.sensor;
    assert_eq!(*sensor, found.cameras[0].sensor);
    near(sensor.position, Vec3::new(9.0, 0.0, 0.0));
    near(sensor.target, Vec3::ZERO);
    near(sensor.up, Vec3::Z);
    assert_eq!(sensor.projection, Projection::Perspective { fov: 50.0 });
    // What looks away has a point in front of it nevertheless.
    let away = &found.cameras[2].sensor;
    assert!(away.target.z > 8.0 && away.target.x.abs() < 1e-5, "{away:?}");
    let says = |text: &str| assert!(found.notes.iter().any(|note| note.contains(text)), "{:?}", found.notes);
    says("the camera stands where the file has its camera `aside`, the first of 3: --camera NAME takes another");
}

#[test]
fn a_side_that_is_asked_for_comes_before_the_cameras_of_the_file() {
    let (loader, model) = made(&[(0, DAffine3::IDENTITY, "cube")]);
    let cameras = vec![camera("left", 50.0, at(0.0, 0.0, 8.0))];
    let choices = Choices { view: Some(Side::Left), ..Choices::default() };
    let scene = scene((loader, Model { cameras, ..model }), &choices);
    let names: Vec<&str> = scene.cameras.iter().map(|camera| &*camera.name).collect();
    assert_eq!(names, ["left 2", "left"]);
    assert!(scene.sensor.position.x < -1.0 && scene.sensor == scene.cameras[0].sensor, "{:?}", scene.sensor);
}

/// A point, a spot, parallel light and a disc, each in its own space.
fn lamps() -> Vec<(Luminaire, DAffine3)> {
    let (position, direction) = (Vec3::ZERO, Vec3::NEG_Z);
    let down = at(1.0, 4.0, 2.0) * DAffine3::from_scale(DVec3::splat(7.0)) * DAffine3::from_rotation_x(-FRAC_PI_2);
    let slanted = DAffine3::from_mat3(DMat3::from_quat(DQuat::from_euler(glam::EulerRot::XYZ, -1.1, 0.3, 0.7)));
    vec![
        (Luminaire::Point { position, intensity: Vec3::new(1.0, 2.0, 3.0) }, at(0.1, 5.0, 0.3)),
        (Luminaire::Spot { position, direction, intensity: Vec3::ONE, inner: 10.0, outer: 25.5 }, down),
        (Luminaire::Infinite { direction, irradiance: Vec3::splat(0.3) }, slanted),
        (Luminaire::Sun { direction, irradiance: Vec3::splat(0.7), angle: 0.53 }, slanted),
    ]
}

#[test]
fn luminaires_stand_where_the_file_has_them() {
    let (loader, model) = made(&[(0, DAffine3::IDENTITY, "cube")]);
    let flat = DAffine3::from_scale(DVec3::ZERO);
    let mut luminaires = lamps();
    luminaires.push((Luminaire::Infinite { direction: Vec3::NEG_Z, irradiance: Vec3::ONE }, flat));
    let bare = bare((loader, Model { luminaires, ..model }), &Choices::default()).unwrap();
    assert!(bare.scene.warnings.len() == 1 && bare.scene.warnings[0].contains("1 luminaire(s)"));
    let [point, spot, parallel, _] = &bare.scene.luminaires[..] else { panic!("{:?}", bare.scene.luminaires) };
    let Luminaire::Point { position, intensity } = point else { panic!("{point:?}") };
    assert_eq!((*position, *intensity), (Vec3::new(0.1, 5.0, 0.3), Vec3::new(1.0, 2.0, 3.0)));
    let Luminaire::Spot { position, direction, intensity, .. } = spot else { panic!("{spot:?}") };
    assert_eq!((*position, *intensity), (Vec3::new(1.0, 4.0, 2.0), Vec3::ONE));
    assert!(direction.distance(Vec3::NEG_Y) < 1e-6, "{direction}");
    let Luminaire::Infinite { direction, .. } = parallel else { panic!("{parallel:?}") };
    assert_eq!(
        direction.as_dvec3().normalize().as_vec3(),
        *direction,
        "the same unit vector for who makes it one again"
    );
    // They are the light, and there is no other, nor what would catch it.
    assert!(bare.scene.environment.is_none() && bare.scene.ground.is_none() && !bare.fill && bare.lamps == 4);
    assert!(bare.scene.notes[0].contains("lit by its 4 luminaires"), "{:?}", bare.scene.notes);
}

/// Only luminaires that light what is seen keep the sky away.
#[test]
fn luminaires_that_light_nothing_leave_the_studio() {
    let in_the_cube = at(0.0, 0.0, 0.0);
    let point = |intensity: f32| Luminaire::Point { position: Vec3::ZERO, intensity: Vec3::splat(intensity) };
    let away = at(0.0, 0.0, 5.0) * DAffine3::from_rotation_x(2.0 * FRAC_PI_2);
    let spot = |outer| {
        let (position, direction) = (Vec3::ZERO, Vec3::NEG_Z);
        Luminaire::Spot { position, direction, intensity: Vec3::ONE, inner: 0.0, outer }
    };
    let parallel = |direction| Luminaire::Infinite { direction, irradiance: Vec3::ONE };
    for (luminaire, matrix, is_studio) in [
        (point(1.0), in_the_cube, true),
        (point(1.0), at(3.0, 4.0, 5.0), false),
        (point(0.0), at(3.0, 4.0, 5.0), true),
        (spot(30.0), at(0.0, 0.0, 5.0), false),
        (spot(30.0), away, true),
        (parallel(Vec3::new(0.0, -0.6, -0.8)), DAffine3::IDENTITY, false),
        (parallel(Vec3::new(0.0, 0.0, 1.0)), DAffine3::IDENTITY, true),
    ] {
        let (loader, model) = made(&[(0, DAffine3::IDENTITY, "cube")]);
        let cameras = vec![camera("front", 40.0, at(0.0, 0.0, 8.0))];
        let said = format!("{luminaire:?} {matrix}");
        let model = Model { cameras, luminaires: vec![(luminaire, matrix)], ..model };
        let bare = bare((loader, model), &Choices::default()).unwrap();
        assert_eq!(bare.sky, if is_studio { Sky::Studio } else { Sky::None }, "{said}");
    }
}

/// What a scene file says of cameras and luminaires is what it was written from, far from the origin, too.
#[test]
fn cameras_and_luminaires_come_back_from_a_scene_file_to_the_last_bit() {
    for middle in [DVec3::ZERO, DVec3::new(654_321.25, 12.5, -7_654_321.75)] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.obj");
        let DVec3 { x, y, z } = middle;
        let text = format!("v {x} {y} {z}\nv {} {y} {z}\nv {x} {} {z}\nf 1 2 3\n", x + 1.0, y + 1.0);
        std::fs::write(&path, text).unwrap();
        let mut loader = Loader::new(Vec::new());
        let placed = std::mem::take(&mut loader.model(&path, Format::Obj, Reading::default()).unwrap().placed.iter())
            .map(|placed| Placed { name: placed.name.clone(), ..*placed })
            .collect();
        let there = DAffine3::from_translation(middle);
        let turned = there * at(0.3, 0.4, 5.0) * DAffine3::from_rotation_z(0.3);
        let mut second = camera("second", 33.3, turned);
        second.0.sensor.projection = Projection::Orthographic { height: 1.7 };
        second.0.sensor.shift = Vec2::new(0.1, -0.2);
        let cameras = vec![camera("first \"one\"", 33.3, turned * DAffine3::from_rotation_x(-0.1)), second];
        let luminaires = lamps().into_iter().map(|(luminaire, matrix)| (luminaire, there * matrix)).collect();
        let model = Model { placed, cameras, luminaires };
        let bare = bare_mesh::build(&path, &model, loader, &Choices::default()).unwrap();
        let text = crate::scene::load::scene_file::text(&bare, "", folder.path()).unwrap();
        let file = folder.path().join("a.toml");
        std::fs::write(&file, &text).unwrap();
        let read = crate::scene::load(&file).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(read.warnings, Vec::<String>::new());
        assert_eq!((read.origin == DVec3::ZERO, read.origin), (middle == DVec3::ZERO, bare.scene.origin));
        assert_eq!((&read.cameras, &read.sensor), (&bare.scene.cameras, &bare.scene.sensor), "{text}");
        assert_eq!(read.luminaires, bare.scene.luminaires, "{text}");
        let [read, bare] = [&read, &bare.scene].map(|scene| crate::part::Provenance::of(scene).digests);
        assert_eq!(read, bare);
    }
}

/// Lamps and bodies that overlap or touch, mirrored ones among them, become what they become in a scene file that places them one by one.
#[test]
fn what_overlaps_becomes_what_it_becomes_in_a_scene_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.obj");
    let mut text = String::from("mtllib a.mtl\nusemtl m\n");
    let cube = cube();
    cube.positions.iter().for_each(|p| text += &format!("v {} {} {}\n", p.x, p.y, p.z));
    for triangle in &cube.triangles {
        let [a, b, c] = triangle.vertices.map(|vertex| vertex + 1);
        text += &format!("f {a} {b} {c}\n");
    }
    std::fs::write(&path, text).unwrap();
    let beside = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)) * at(2.0 + 1e-5, 0.0, 0.0);
    let placed = [("one", DAffine3::IDENTITY), ("again", DAffine3::IDENTITY), ("beside", beside), ("far", mirrored())];
    for (mtl, word) in
        [("Kd 0 0 0\nKe 1 1 1\n", "that emit"), ("Kd 0 0 0\nKs 1 1 1\nTf 1 1 1\nNi 1.5\nillum 7\n", "glass")]
    {
        std::fs::write(folder.path().join("a.mtl"), format!("newmtl m\n{mtl}")).unwrap();
        let mut loader = Loader::new(Vec::new());
        let mesh = loader.model(&path, Format::Obj, Reading::default()).unwrap().placed[0].mesh;
        let placed_so = placed.map(|(name, matrix)| Placed { mesh, matrix, name: name.into() });
        let model = Model { placed: placed_so.into(), ..Model::default() };
        let choices = Choices { sky: Some(Sky::Studio), ground: Some(false), fill: Some(false), ..Choices::default() };
        let mut bare = bare_mesh::build(&path, &model, loader, &choices).unwrap().scene;
        crate::scene::load::finish(&mut bare).unwrap();
        let row = |matrix: &DAffine3, row: usize| {
            let [x, y, z] = matrix.matrix3.row(row).to_array();
            format!("[{x:?}, {y:?}, {z:?}, {:?}]", matrix.translation[row])
        };
        let object = |(name, matrix): &(&str, DAffine3)| {
            let [x, y, z] = [0, 1, 2].map(|index| row(matrix, index));
            format!("[[object]]\nmesh = \"a.obj\"\nname = \"{name}\"\nmatrix = [{x}, {y}, {z}]\n")
        };
        let file = folder.path().join("a.toml");
        let objects: String = placed.iter().map(object).collect();
        std::fs::write(&file, format!("[environment]\nsky = \"studio\"\n{objects}")).unwrap();
        let scene = crate::scene::load(&file).unwrap();
        let [found, expected] = [&bare, &scene].map(|scene| crate::part::Provenance::of(scene).digests);
        for what in ["geometry", "materials"] {
            assert_eq!(found[what], expected[what], "{what}: {:?} {:?}", bare.warnings, scene.warnings);
        }
        let own = |scene: &Scene| {
            let said = scene.warnings.iter().filter(|warning| !warning.contains("no [sensor]"));
            said.map(|warning| warning.replace("a.toml", "a.obj")).collect::<Vec<_>>()
        };
        assert_eq!(own(&bare), own(&scene));
        assert!(bare.warnings.iter().any(|warning| warning.contains(word)), "{:?}", bare.warnings);
        assert_eq!(scene.objects.len(), bare.objects.len());
    }
}

/// A scene file makes directions unit vectors again.
#[test]
fn unit_vectors_stay_when_they_are_made_ones_again() {
    let mut bits = 1u32;
    let mut next = || {
        bits = bits.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(bits >> 8) / f64::from(1 << 24) - 0.5
    };
    for _ in 0..20_000 {
        let found = unit(DVec3::new(next(), next(), next())).unwrap();
        assert_eq!(found.as_dvec3().normalize().as_vec3(), found);
    }
    assert_eq!([DVec3::ZERO, DVec3::NAN, DVec3::X * f64::INFINITY].map(unit), [None; 3]);
}
