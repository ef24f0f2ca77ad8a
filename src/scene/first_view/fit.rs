//! How far a camera stands back, and where it points, so that what it shows fills the picture.

use glam::{DMat3, DVec3};

/// Steps of Newton's method towards the middle.
const CENTERINGS: usize = 4;

/// A perspective camera: the columns of `axes` are right, up and forward.
#[derive(Debug, Clone, Copy)]
pub(super) struct Eye {
    pub position: DVec3,
    pub axes: DMat3,
    /// Tangents of half the fields of view, horizontal and vertical.
    pub tangents: [f64; 2],
    /// Along the line of sight, the middle of what is shown.
    pub depth: f64,
}

/// The axes of a camera that looks along `forward`; `up` is not parallel to it.
pub(super) fn axes(forward: DVec3, up: DVec3) -> DMat3 {
    let right = forward.cross(up).normalize();
    DMat3::from_cols(right, right.cross(forward), forward)
}

/// The nearest camera with these axes that has all points in the picture, but for a margin, and in its middle; `points` visits them, each time the same.
///
/// In front of each side plane of the view pyramid lie all points: that bounds two linear functions of the eye point from each side of the picture, and
/// the narrower pair says how near it may come.
pub(super) fn fit(points: &impl Fn(&mut dyn FnMut(DVec3)), axes: DMat3, tangents: [f64; 2], margin: f64) -> Eye {
    let inner = tangents.map(|tangent| tangent * (1.0 - 2.0 * margin));
    let to_camera = axes.transpose();
    // By picture axis: how far points reach over the planes through the origin, on either side.
    let mut reach = [[f64::NEG_INFINITY; 2]; 2];
    let mut depths = [f64::INFINITY, f64::NEG_INFINITY];
    points(&mut |p| {
        let p = to_camera * p;
        for axis in 0..2 {
            for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
                reach[axis][side] = reach[axis][side].max(sign * p[axis] - inner[axis] * p.z);
            }
        }
        depths = [depths[0].min(p.z), depths[1].max(p.z)];
    });
    let back = |axis: usize| -0.5 * (reach[axis][0] + reach[axis][1]) / inner[axis];
    let extent = depths[1] - depths[0];
    // A point, or what lies on the line of sight alone, has no size.
    let z = back(0).min(back(1)).min(depths[0] - 1e-3 * extent.max(f64::MIN_POSITIVE));
    let mut eye = [0.5 * (reach[0][0] - reach[0][1]), 0.5 * (reach[1][0] - reach[1][1])];
    // Where there is room to spare the middle of the planes is not that of the picture.
    for _ in 0..CENTERINGS {
        let mut edges = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let mut at = [[0.0; 2]; 2];
        points(&mut |p| {
            let p = to_camera * p;
            for axis in 0..2 {
                let seen = (p[axis] - eye[axis]) / (p.z - z);
                if seen < edges[axis][0] {
                    (edges[axis][0], at[axis][0]) = (seen, p.z - z);
                }
                if seen > edges[axis][1] {
                    (edges[axis][1], at[axis][1]) = (seen, p.z - z);
                }
            }
        });
        for axis in 0..2 {
            let slope = 1.0 / at[axis][0] + 1.0 / at[axis][1];
            eye[axis] += (edges[axis][0] + edges[axis][1]) / slope;
        }
    }
    let position = axes * DVec3::new(eye[0], eye[1], z);
    Eye { position, axes, tangents, depth: 0.5 * (depths[0] + depths[1]) - z }
}

impl Eye {
    /// The direction of a point of the picture, each coordinate from -1 to 1, y upwards; of length 1 along the line of sight.
    pub(super) fn direction(&self, x: f64, y: f64) -> DVec3 {
        self.axes * DVec3::new(x * self.tangents[0], y * self.tangents[1], 1.0)
    }
}
