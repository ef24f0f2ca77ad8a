//! The ground that a scene file asks for with `[ground]`, and that a bare model gets: a round, level, diffuse sheet.

use super::reach::LARGEST_COORDINATE;
use crate::scene::studio_sky::GROUND_ALBEDO;
use crate::scene::{Material, Mesh, Object, Scene, Triangle, widen};
use glam::{Affine3A, DVec3, Vec3};
use std::f64::consts::FRAC_PI_2;

/// The diffuse albedo of a ground of which nobody states one: as bright as the horizon of the studio sky.
pub(super) const ALBEDO: f32 = GROUND_ALBEDO as f32;
/// The radius of the ground, in radii of the ball around the model's box: shadows end far within.
const REACH: f64 = 20.0;
/// The square in the middle has this half edge in the same unit.
const MIDDLE: f64 = 2.0;
/// Squares around it are so much larger, each than the one within: where the model stands triangles are no larger than it needs, and single
/// precision knows points on them as well as on the model.
const GROWTH: f64 = 3.2;
/// Edges of the rim in a quarter of it.
const RIM: u32 = 16;
/// How far the ground is below the lowest point, as a share of the diagonal of the model's box: bottoms do not lie in it.
const GAP: f64 = 1e-4;
/// And at least so many times the largest coordinate, for the rounding of single precision.
const ROUNDINGS: f64 = 1e-5;

/// What is said of a ground.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Ground {
    /// Its y in the coordinates of the files; none: a hair below the lowest point.
    pub height: Option<f64>,
    /// Its diffuse albedo; none: that with which it is as bright as the horizon of the studio sky.
    pub albedo: Option<Vec3>,
    /// Its diameter; none: twenty times the diameter of the ball around the scene's box.
    pub size: Option<f64>,
}

/// The height of a ground that nobody states, in the coordinates of the files: a hair below the scene's lowest point, with few digits.
pub(super) fn height(scene: &Scene) -> f64 {
    let mut lowest = f64::INFINITY;
    for (_, object) in (0..).zip(&scene.objects).filter(|(index, _)| scene.ground != Some(*index)) {
        let to_world = widen(object.object_to_world);
        let mesh = &scene.meshes[object.mesh as usize];
        for vertex in mesh.triangles.iter().flat_map(|triangle| triangle.vertices) {
            lowest = lowest.min(to_world.transform_point3(mesh.positions[vertex as usize].as_dvec3()).y);
        }
    }
    let (low, high) = scene.model_bounds();
    let reach = low.abs().max(high.abs()).max_element();
    let gap = (GAP * low.distance(high)).max(ROUNDINGS * reach);
    let decimals = -gap.log10().floor();
    let step = 10f64.powf(-decimals);
    let rounded = ((lowest + scene.origin.y - gap) / step).floor() * step;
    // The nearest double of few digits, so that it is written shortly, too.
    format!("{rounded:.*}", decimals.max(0.0) as usize).parse().unwrap_or(rounded)
}

/// The diameter of a ground of which nobody states one.
pub(super) fn size(scene: &Scene) -> f64 {
    let (low, high) = scene.model_bounds();
    REACH * low.distance(high)
}

/// Adds a ground to a scene that has its objects, its origin and its camera.
pub(super) fn add(scene: &mut Scene, ground: &Ground) {
    let y = ground.height.unwrap_or_else(|| height(scene)) - scene.origin.y;
    let (low, high) = scene.model_bounds();
    let (middle, radius) = (0.5 * (low + high), 0.5 * low.distance(high));
    // No further than coordinates may reach.
    let most = 0.9 * LARGEST_COORDINATE - (middle + scene.origin).abs().max_element();
    let half = 0.5 * ground.size.unwrap_or_else(|| size(scene).min(2.0 * most.max(radius)));
    let material = scene.materials.len() as u32;
    let mesh = sheet(DVec3::new(middle.x, y, middle.z), MIDDLE * radius, half, material);
    scene.ground = Some(scene.objects.len() as u32);
    scene.objects.push(Object {
        name: "ground".into(),
        mesh: scene.meshes.len() as u32,
        object_to_world: Affine3A::IDENTITY,
        material: None,
    });
    scene.meshes.push(mesh.into());
    let albedo = ground.albedo.unwrap_or(Vec3::splat(ALBEDO));
    scene.materials.push(Material { name: "ground".into(), lambert: albedo, ambient: albedo, ..Material::default() });
}

/// A level disk: nested squares, `first` being half the edge of the innermost one, and around them a rim of this radius, so that the horizon is level
/// whichever way one looks. It faces up.
fn sheet(center: DVec3, first: f64, radius: f64, material: u32) -> Mesh {
    // The corners of the last square stay within the rim.
    let mut halves = vec![first.min(0.5 * radius)];
    while let next = halves[halves.len() - 1] * GROWTH
        && next < 0.5 * radius
    {
        halves.push(next);
    }
    let place = |x: f64, z: f64| (center + DVec3::new(x, 0.0, z)).as_vec3();
    let corner = |half: f64, i: usize| {
        let (x, z) = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)][i % 4];
        place(half * x, half * z)
    };
    let mut mesh = Mesh { name: "ground".into(), ..Mesh::default() };
    mesh.positions.extend(halves.iter().flat_map(|half| (0..4).map(move |i| corner(*half, i))));
    // From the first corner of the squares on, the same way around.
    mesh.positions.extend((0..4 * RIM).map(|k| {
        let (sin, cos) = ((f64::from(k) / f64::from(RIM) - 0.5) * FRAC_PI_2).sin_cos();
        place(-radius * cos, radius * sin)
    }));
    let mut add = |vertices: [u32; 3]| mesh.triangles.push(Triangle { vertices, material });
    add([0, 1, 2]);
    add([0, 2, 3]);
    for ring in 1..halves.len() as u32 {
        let (inner, outer) = (4 * ring - 4, 4 * ring);
        for i in 0..4 {
            let next = (i + 1) % 4;
            add([outer + i, outer + next, inner + next]);
            add([outer + i, inner + next, inner + i]);
        }
    }
    let (inner, rim) = (4 * halves.len() as u32 - 4, 4 * halves.len() as u32);
    let of_rim = |k: u32| rim + k % (4 * RIM);
    for i in 0..4 {
        let (here, next) = (inner + i, inner + (i + 1) % 4);
        for k in i * RIM..(i + 1) * RIM {
            add([of_rim(k), of_rim(k + 1), if k < i * RIM + RIM / 2 { here } else { next }]);
        }
        add([of_rim(i * RIM + RIM / 2), next, here]);
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sheet_is_whole_faces_up_and_has_its_size() {
        for (first, half) in [(1.0, 10.0), (1.0, 0.5), (2.0, 2.0), (1.0, 1000.0)] {
            let mesh = sheet(DVec3::new(1.0, 2.0, 3.0), first, half, 7);
            let mut area = 0.0;
            for triangle in &mesh.triangles {
                let [a, b, c] = triangle.vertices.map(|v| mesh.positions[v as usize].as_dvec3());
                let normal = (b - a).cross(c - a);
                assert!(normal.y > 0.0 && normal.x == 0.0 && normal.z == 0.0, "{normal}");
                assert_eq!(triangle.material, 7);
                area += 0.5 * normal.length();
            }
            let corners = f64::from(4 * RIM);
            let whole = 0.5 * corners * half * half * (4.0 * FRAC_PI_2 / corners).sin();
            assert!((area - whole).abs() < 1e-5 * whole, "{area} {whole}");
            let (low, high) = mesh.bounds();
            assert_eq!((low.y, high.y), (2.0, 2.0));
            assert!((high.x - low.x - 2.0 * half as f32).abs() < 1e-3, "{low} {high}");
        }
    }
}
