//! Pixel filters.
use super::Filter;
impl Filter {
    /// The inverse cumulative distribution.
    pub fn inverse_cdf(self, radius: f32) -> Vec<f32> {
        (0..257).map(|i| radius * (i as f32 / 128.0 - 1.0)).collect()
    }
}
