//! Closed rooms of any number of triangles, or of instances: the same numbers give the same room.

use crate::random::Random;
use glam::{Affine3A, EulerRot, Quat, Vec3};
use luminaire::scene::build::*;
use luminaire::scene::{Mesh, Object, Scene, Triangle};

/// A room for the rays.
pub struct Room {
    /// Its part of a figure's name: `mesh-1e5`, `instances-1e3`.
    pub name: String,
    /// The room; the sensor is in it.
    pub scene: Scene,
    /// Corner and edges of the lamp, which hangs below the ceiling and shines down.
    pub lamp: [Vec3; 3],
}

const GREY: u32 = 0;
const LAMP: u32 = 1;
/// Balls in the room of one mesh: three in each direction.
const BALLS: u32 = 27;

/// A number of the form that names use: `1e5`, `316`.
pub(super) fn short(number: u64) -> String {
    let zeros = number.checked_ilog10().unwrap_or(0);
    if zeros >= 3 && number == 10u64.pow(zeros) { format!("1e{zeros}") } else { number.to_string() }
}

/// One mesh of about `triangles` triangles (1000 at least): a bumpy room with 27 bumpy balls, which have two thirds of them. The shape is the same for any
/// number, but for its finest bumps.
pub fn one_mesh(triangles: u64) -> Room {
    let mut scene = empty(1, 1);
    scene.sensor = pinhole(Vec3::new(0.3, 0.3, 0.88), Vec3::new(-0.2, -0.15, -1.0), Vec3::Y, 75.0);
    let mut mesh = Mesh { name: "room".into(), ..Mesh::default() };
    let steps = |share: f64| (share / 12.0).sqrt().round().max(1.0) as u32;
    let of_ball = steps(2.0 / 3.0 * triangles as f64 / f64::from(BALLS));
    for ball in 0..BALLS {
        let place = Vec3::new((ball % 3) as f32, (ball / 3 % 3) as f32, (ball / 9) as f32) - 1.0;
        let radius = 0.17 + 0.03 * (ball as f32).sin();
        grid_cube(&mut mesh, of_ball, |p| {
            let d = p.normalize();
            0.6 * place + radius * (1.0 + 0.15 * bumps(4.0 * d + 2.0 * place).x) * d
        });
    }
    let rest = triangles as f64 - mesh.triangles.len() as f64;
    grid_cube(&mut mesh, steps(rest.max(12.0)), |p| p + 0.06 * bumps(3.0 * p));
    let lamp = [Vec3::new(-0.25, 0.9, -0.25), Vec3::X * 0.5, Vec3::Z * 0.5];
    add_quad(&mut mesh, lamp, LAMP);
    scene.meshes.push(mesh.into());
    scene.objects.push(object(0, Affine3A::IDENTITY));
    finish(format!("mesh-{}", short(triangles)), scene, lamp)
}

/// `instances` bumpy balls of 972 triangles, strewn in a cube at random and free to overlap, in a room of twelve triangles: they get smaller the more
/// there are, so that they always fill the same share of the cube.
pub fn instances(instances: u64) -> Room {
    let mut scene = empty(1, 1);
    scene.sensor = pinhole(Vec3::new(0.2, 0.3, 1.4), Vec3::new(0.0, -0.1, -1.0), Vec3::Y, 60.0);
    let mut room = Mesh { name: "room".into(), ..Mesh::default() };
    grid_cube(&mut room, 1, |p| 1.5 * p);
    let lamp = [Vec3::new(-0.4, 1.45, -0.4), Vec3::X * 0.8, Vec3::Z * 0.8];
    add_quad(&mut room, lamp, LAMP);
    let mut ball = Mesh { name: "ball".into(), ..Mesh::default() };
    grid_cube(&mut ball, 9, |p| {
        let d = p.normalize();
        (1.0 + 0.15 * bumps(4.0 * d).x) * d
    });
    scene.meshes = vec![room.into(), ball.into()];
    scene.objects.push(object(0, Affine3A::IDENTITY));
    let size = 0.52 / (instances as f32).cbrt();
    let mut random = Random::new(1);
    for _ in 0..instances {
        // The bumps reach 1.15 of the radius.
        let place = random.in_cube() * (1.0 - 1.15 * size);
        let [x, y, z] = [0; 3].map(|_| random.between(0.0, std::f64::consts::TAU) as f32);
        let turn = Quat::from_euler(EulerRot::XYZ, x, y, z);
        scene.objects.push(object(1, Affine3A::from_scale_rotation_translation(Vec3::splat(size), turn, place)));
    }
    finish(format!("instances-{}", short(instances)), scene, lamp)
}

/// A room with a block and `lamps` small triangles that shine down from below its ceiling, of the same area together for any number. All in one mesh.
pub(super) fn lamps(lamps: u64) -> Scene {
    let mut scene = empty(1, 1);
    scene.sensor = pinhole(Vec3::new(0.0, 0.0, 0.95), Vec3::new(0.0, -0.2, -1.0), Vec3::Y, 75.0);
    let mut mesh = Mesh { name: "room".into(), ..Mesh::default() };
    grid_cube(&mut mesh, 1, |p| p);
    let turn = Quat::from_rotation_y(0.4);
    grid_cube(&mut mesh, 1, |p| turn * (p * Vec3::new(0.25, 0.4, 0.2)) + Vec3::new(-0.2, -0.6, -0.2));
    let side = (lamps as f64).sqrt().ceil() as u64;
    let pitch = 1.6 / side as f32;
    let edge = (2.0 * 0.05 / lamps as f32).sqrt();
    for lamp in 0..lamps {
        let middle = |i: u64| -0.8 + (i as f32 + 0.5) * pitch;
        let corner = Vec3::new(middle(lamp % side), 0.97, middle(lamp / side)) - 0.3 * edge * (Vec3::X + Vec3::Z);
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([corner, corner + edge * Vec3::X, corner + edge * Vec3::Z]);
        mesh.triangles.push(Triangle { vertices: [first, first + 1, first + 2], material: LAMP });
    }
    scene.meshes.push(mesh.into());
    scene.objects.push(object(0, Affine3A::IDENTITY));
    scene.materials = materials();
    scene
}

fn materials() -> Vec<luminaire::scene::Material> {
    let mut all = vec![matte(Vec3::splat(0.7)), lamp(Vec3::splat(20.0))];
    all[LAMP as usize].one_sided = true;
    all
}

fn finish(name: String, mut scene: Scene, lamp: [Vec3; 3]) -> Room {
    scene.materials = materials();
    Room { name, scene, lamp }
}

fn object(mesh: u32, object_to_world: Affine3A) -> Object {
    Object { name: String::new(), mesh, object_to_world, material: None }
}

/// Waves of three lengths, between about -1 and 1 in each coordinate.
fn bumps(p: Vec3) -> Vec3 {
    let wave = |p: Vec3| Vec3::new((p.y + 1.7 * p.z).sin(), (p.z + 1.3 * p.x).sin(), (p.x + 1.9 * p.y).sin());
    (wave(p) + 0.5 * wave(2.7 * p + 1.0) + 0.25 * wave(7.1 * p + 2.0)) / 1.75
}

/// Adds the faces of the cube from -1 to 1, `steps` by `steps` squares each, with every corner put where `place` says. It has no gaps: corners that
/// fall together are the same numbers.
fn grid_cube(mesh: &mut Mesh, steps: u32, place: impl Fn(Vec3) -> Vec3) {
    let at = |i: u32| -1.0 + 2.0 * (f64::from(i) / f64::from(steps)) as f32;
    for face in 0..6 {
        let (axis, side) = (face % 3, if face < 3 { 1.0 } else { -1.0 });
        let first = mesh.positions.len() as u32;
        for i in 0..=steps {
            for j in 0..=steps {
                let mut p = [0.0; 3];
                (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side, at(i), at(j));
                mesh.positions.push(place(Vec3::from_array(p)));
            }
        }
        for i in 0..steps {
            for j in 0..steps {
                let a = first + i * (steps + 1) + j;
                let (b, c, d) = (a + steps + 1, a + steps + 2, a + 1);
                for vertices in [[a, b, c], [a, c, d]] {
                    let [x, y, z] = vertices;
                    let vertices = if side > 0.0 { vertices } else { [x, z, y] };
                    mesh.triangles.push(Triangle { vertices, material: GREY });
                }
            }
        }
    }
}

/// Adds a parallelogram (corner and edges) whose front is below it where the edges are along x and z.
fn add_quad(mesh: &mut Mesh, [corner, a, b]: [Vec3; 3], material: u32) {
    let first = mesh.positions.len() as u32;
    mesh.positions.extend([corner, corner + a, corner + a + b, corner + b]);
    for vertices in [[0, 1, 2], [0, 2, 3]] {
        mesh.triangles.push(Triangle { vertices: vertices.map(|v| first + v), material });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    /// Every edge belongs to two triangles, but for those of the lamp.
    fn open_edges(mesh: &Mesh) -> usize {
        let mut edges: HashMap<[[u32; 3]; 2], i32> = HashMap::new();
        for triangle in &mesh.triangles {
            let corners = triangle.vertices.map(|v| mesh.positions[v as usize].to_array().map(f32::to_bits));
            for i in 0..3 {
                let (a, b) = (corners[i], corners[(i + 1) % 3]);
                // The two sides run along an edge in opposite directions.
                *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
            }
        }
        edges.values().filter(|count| **count != 0).count()
    }

    #[test]
    fn rooms_are_closed_and_of_their_size() {
        for triangles in [1000, 10_000, 100_000] {
            let room = one_mesh(triangles);
            let count = room.scene.triangle_count() as f64;
            assert!((0.85..1.15).contains(&(count / triangles as f64)), "{count} instead of {triangles}");
            assert_eq!(open_edges(&room.scene.meshes[0]), 4, "{triangles}");
            assert_eq!(room.scene.objects.len(), 1);
        }
        let room = instances(10);
        assert_eq!((room.scene.objects.len(), open_edges(&room.scene.meshes[1])), (11, 0));
        assert_eq!(room.scene.meshes[1].triangles.len(), 972);
        assert_eq!(
            (one_mesh(100_000).name, room.name, short(316)),
            ("mesh-1e5".into(), "instances-10".into(), "316".into())
        );
    }

    #[test]
    fn lamps_have_one_area() {
        for count in [1, 10, 1000] {
            let scene = lamps(count);
            let table = luminaire::scene::LuminaireTable::new(&scene);
            assert_eq!(table.entries.len() as u64, count);
            let area: f64 = scene.meshes[0]
                .triangles
                .iter()
                .filter(|t| t.material == LAMP)
                .map(|t| {
                    let [a, b, c] = t.vertices.map(|v| scene.meshes[0].positions[v as usize].as_dvec3());
                    let normal = (b - a).cross(c - a);
                    assert!(normal.y < 0.0, "a lamp shines up");
                    0.5 * normal.length()
                })
                .sum();
            assert!((area - 0.05).abs() < 1e-4, "{area}");
        }
    }
}
