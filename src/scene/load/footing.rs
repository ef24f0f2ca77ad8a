//! Whether a model stands on something of its own: a floor, a landscape, a backdrop.

use crate::scene::{Scene, widen};
use glam::DVec3;

/// The model is looked at from straight above on a grid of so many cells a side.
const CELLS: usize = 32;
/// What is less than this share of the model's largest extent is flat.
const FLAT: f64 = 1e-3;
/// What is no higher than this share of the model's height is near its bottom.
const LOW: f64 = 0.1;
/// Something that lies under at least this share of the model's footprint extends over all of it.
const WHOLE: f64 = 0.9;
/// A sheet near the bottom that is seen from above on at least this share of the footprint is a floor.
const FLOOR: f64 = 0.2;
/// A single sheet on at least this share of the footprint is a landscape.
const LANDSCAPE: f64 = 0.8;
/// Two surfaces at one place are one where they are no further apart than this share of the model's height.
const SAME: f64 = 0.01;

/// What lies over a cell of the grid: the lowest and the highest surface.
type Column = Option<[f64; 2]>;

/// Whether the model brings what it stands on.
///
/// From straight above, its box is its footprint. It brings its own ground where that is covered all over, and where a good part of it is a sheet
/// with nothing below, near the bottom (a floor with walls or things on it, a backdrop), or nearly all of it at whatever heights, down to the bottom (a
/// landscape). A cube or a slab covers its footprint too, but has a bottom below its top: such things stand on the ground.
pub(super) fn brings_its_ground(scene: &Scene) -> bool {
    let (low, high) = scene.model_bounds();
    let size = high - low;
    let flat = FLAT * size.max_element();
    if size.x <= flat || size.z <= flat {
        return false;
    }
    if size.y <= flat {
        return true;
    }
    let columns = columns(scene, low, size);
    let all = columns.len() as f64;
    let share = |holds: &dyn Fn(&[f64; 2]) -> bool| columns.iter().flatten().filter(|c| holds(c)).count() as f64 / all;
    let sheet = |[bottom, top]: &[f64; 2]| top - bottom <= SAME * size.y;
    let floor = share(&|column| sheet(column) && column[1] - low.y <= LOW * size.y);
    // A roof is none: what holds it up goes down further.
    let lowest =
        columns.iter().flatten().filter(|column| sheet(column)).map(|column| column[0]).fold(f64::INFINITY, f64::min);
    let landscape = lowest - low.y <= LOW * size.y && share(&sheet) >= LANDSCAPE;
    share(&|_| true) >= WHOLE && (floor >= FLOOR || landscape)
}

/// The lowest and the highest surface over the middle of each cell.
fn columns(scene: &Scene, low: DVec3, size: DVec3) -> Vec<Column> {
    let mut columns: Vec<Column> = vec![None; CELLS * CELLS];
    let cells = CELLS as f64;
    for (index, object) in (0..).zip(&scene.objects) {
        if scene.ground == Some(index) {
            continue;
        }
        let to_world = widen(object.object_to_world);
        let mesh = &scene.meshes[object.mesh as usize];
        for triangle in &mesh.triangles {
            // In cells.
            let [a, b, c] = triangle.vertices.map(|v| {
                let p = to_world.transform_point3(mesh.positions[v as usize].as_dvec3()) - low;
                DVec3::new(p.x / size.x * cells - 0.5, p.y + low.y, p.z / size.z * cells - 0.5)
            });
            let cross = |p: DVec3, q: DVec3| p.x * q.z - p.z * q.x;
            let area = cross(b - a, c - a);
            if area == 0.0 {
                continue;
            }
            let (least, most) = (a.min(b).min(c).max(DVec3::ZERO), a.max(b).max(c).min(DVec3::splat(cells - 1.0)));
            // The second bound is of y too, where it means nothing.
            for z in least.z.ceil() as i64..=most.z.floor() as i64 {
                for x in least.x.ceil() as i64..=most.x.floor() as i64 {
                    let p = DVec3::new(x as f64, 0.0, z as f64);
                    let (u, v) = (cross(p - a, c - a) / area, cross(b - a, p - a) / area);
                    if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
                        let y = a.y + u * (b.y - a.y) + v * (c.y - a.y);
                        let column = columns[z as usize * CELLS + x as usize].get_or_insert([y, y]);
                        *column = [column[0].min(y), column[1].max(y)];
                    }
                }
            }
        }
    }
    columns
}
