//! Directions of microfacets as the kernel chooses them, against the reference's density, over a grid; and furnaces over a grid.

use super::functions::{call, floats, vector};
use super::*;
use crate::common::facets::grid;
use crate::common::scenes::*;
use crate::common::statistics::*;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::gpu::probe::{Call, Function, INSIDE, Probe};
use luminaire::sampling::random4;
use luminaire::scene::Material;
use rayon::prelude::*;

/// The kernel's directions of every kind, from both sides, fall into cells as the reference's density says.
#[test]
fn directions_have_their_density_over_a_grid() {
    const N: u32 = 8000;
    let grid = grid(&[0.05, 0.2, 0.5, 1.0], &[20.0, 80.0]);
    let mut scene = empty(4, 4);
    add(&mut scene, cube(), matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    let first = scene.materials.len() as u32;
    let materials = grid.iter().map(|case| Material {
        physical: Some(case.physical.clone()),
        thin: case.thin,
        ..Material::default()
    });
    scene.materials.extend(materials);
    on_every_backend(|backend| {
        let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
        let calls: Vec<Call> = (first..)
            .zip(&grid)
            .flat_map(|(material, case)| {
                let wo = case.wo.as_vec3();
                (0..N).map(move |i| {
                    let mut call = call([wo.x, wo.y, wo.z, 0.0], [0.0; 4]);
                    call[0][3] = material | if case.front { 0 } else { INSIDE };
                    call[1] = random4(i, material, u32::from(case.front), 43);
                    call
                })
            })
            .collect();
        let found = probe.call(Function::Scatter, &calls).expect("the probe runs");
        let tests: Vec<_> = grid
            .par_iter()
            .zip(found.par_chunks(N as usize))
            .map(|(case, paths)| {
                let directions = paths.iter().map(|path| {
                    let [.., pdf] = floats(path[0]);
                    assert!(pdf >= 0.0, "{}: an impulse", case.name);
                    // What is below the horizon goes nowhere.
                    if pdf == 0.0 { DVec3::ZERO } else { vector(path[0]) }
                });
                let (p, _) = case.plausibility(directions);
                (format!("{}, {}", case.name, backend.name()), p)
            })
            .collect();
        assert_plausible(&tests);
    });
}
