//! Random numbers, places and directions for rays: those of the renderer, one after another.

use glam::Vec3;
use luminaire::sampling::{random4, uniform};

/// Random numbers for places and directions: those of the renderer, one after another.
#[derive(Debug, Clone)]
pub struct Random {
    seed: u32,
    count: u32,
}

impl Random {
    /// The numbers of a seed.
    pub fn new(seed: u32) -> Self {
        Random { seed, count: 0 }
    }

    /// In [0, 1).
    pub fn uniform(&mut self) -> f64 {
        self.count += 1;
        uniform(random4(self.count, 0, 0, self.seed)[0])
    }

    /// From `low` to `high`, evenly.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// An index below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.uniform() * n as f64) as usize
    }

    /// In the cube from -1 to 1.
    pub fn in_cube(&mut self) -> Vec3 {
        Vec3::from_array([0; 3].map(|_| self.between(-1.0, 1.0) as f32))
    }

    /// A unit vector, evenly over all directions.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.in_cube();
            if v.length_squared() > 0.01 && v.length_squared() <= 1.0 {
                return v.normalize();
            }
        }
    }
}
