//! The vertices of an OBJ file, as it has them and as single precision has them.

use crate::scene::load::far::origin_of;
use glam::{DVec3, Vec3};

/// `v` lines, divided by the weight if they have one; all finite.
#[derive(Debug, Default)]
pub(super) struct Positions {
    /// As the file has them.
    pub exact: Vec<DVec3>,
    /// What is subtracted before they are rounded; zero unless the faces lie far away.
    pub origin: DVec3,
}

impl Positions {
    /// Chooses the origin by the vertices that faces use, counted from 0: what no face uses may lie anywhere.
    pub(super) fn settle(&mut self, used: impl Iterator<Item = usize>) {
        let used = used.map(|vertex| self.exact[vertex]);
        let (low, high) = used.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        self.origin = origin_of(low, high);
    }

    pub(super) fn len(&self) -> usize {
        self.exact.len()
    }

    /// A vertex, counted from 0, in single precision.
    pub(super) fn rounded(&self, vertex: usize) -> Vec3 {
        (self.exact[vertex] - self.origin).as_vec3()
    }

    /// The same number, ready for computations.
    pub(super) fn at(&self, vertex: usize) -> DVec3 {
        self.rounded(vertex).as_dvec3()
    }
}
