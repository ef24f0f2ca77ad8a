//! The environment, as the kernel has it.

use crate::gpu::layout;
use crate::sampling::{CDF_NUMBERS, Cdf};
use crate::scene::{Environment, EnvironmentDistribution};
use glam::Vec3;

/// The environment's texels with their densities, which are 0 if no light is sampled there; and the choice among its rows, then that among the
/// columns of each row.
pub(in crate::gpu) fn environment(
    environment: &Environment,
    distribution: Option<&EnvironmentDistribution>,
) -> (Vec<layout::EnvironmentTexel>, Vec<[u32; 4]>) {
    let width = environment.image.as_ref().map_or(1, |image| image.width);
    let density = |texel: u32| distribution.map_or(0.0, |d| d.density([texel % width, texel / width])) as f32;
    let texel = |(radiance, index): (&Vec3, u32)| layout::EnvironmentTexel {
        radiance: radiance.to_array(),
        density: density(index),
    };
    let constant = [Vec3::ONE];
    let radiance = environment.image.as_ref().map_or(&constant[..], |image| &image.texels);
    let texels = radiance.iter().zip(0..).map(texel).collect();
    let choices = distribution.iter().flat_map(|d| std::iter::once(&d.rows).chain(&d.columns));
    (texels, choices.flat_map(search_tree).collect())
}

/// The starts of a distribution's entries, and above them every fourth, every sixteenth, ..., down to four or fewer: from the top, four in one.
/// Beyond the last is what is larger than all numbers.
fn search_tree(cdf: &Cdf) -> Vec<[u32; 4]> {
    let starts = &cdf.starts[..cdf.starts.len() - 1];
    let start = |entry: usize| *starts.get(entry).unwrap_or(&CDF_NUMBERS);
    let level = |stride: usize| {
        let firsts = (0..starts.len()).step_by(4 * stride);
        firsts.map(move |first| [0, 1, 2, 3].map(|i| start(first + i * stride)))
    };
    let strides: Vec<usize> = std::iter::successors(Some(1), |stride| Some(4 * stride))
        .take_while(|stride| *stride == 1 || *stride < starts.len())
        .collect();
    strides.into_iter().rev().flat_map(level).collect()
}

/// How many texels the search among so many entries takes.
pub(in crate::gpu) fn search_tree_size(entries: u32) -> u32 {
    let level = entries.div_ceil(4);
    level + if level > 1 { search_tree_size(level) } else { 0 }
}
