//! White furnaces: surfaces that absorb nothing, in white light from everywhere, over a grid of roughness, metal and transmission. All is white, or light is lost or made.

use crate::Workbench;
use crate::statistics::Estimate;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::film::{Batch, Tile};
use luminaire::gpu::probe::{Call, Function};
use luminaire::reference::physical::{Lobes, PhysicalSurface};
use luminaire::sampling::uniform;
use luminaire::scene::build::{add, empty, icosphere, pinhole};
use luminaire::scene::{Environment, Material, Physical, Scene};

/// Perceptual roughnesses of the grid: the columns.
pub const ROUGHNESSES: [f32; 8] = [0.0, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0];
/// Metallic and transmission of the grid: the rows.
pub const KINDS: [[f32; 2]; 6] = [[1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.0, 0.5], [0.5, 0.5]];
/// Pixels of a ball, each way: all see it and nothing else, up to 70 degrees from its normals.
const PIXELS: u32 = 4;
/// Pixels from ball to ball.
const PITCH: u32 = 12;
/// A ball's diameter.
const DIAMETER: u32 = 6;
/// Samples of a pixel in one batch.
const BATCH: u32 = 512;

/// A ball of the grid.
#[derive(Debug, Clone)]
pub struct Furnace {
    /// Perceptual roughness.
    pub roughness: f32,
    /// Share of metal.
    pub metallic: f32,
    /// Share of transmission.
    pub transmission: f32,
    /// Radiance of the ball in light of radiance 1, backend by backend.
    pub found: Vec<Estimate>,
}

/// All balls, far apart, under a white sky: each light that one sends to another is white, too.
fn scene() -> Scene {
    let (columns, rows) = (ROUGHNESSES.len() as u32, KINDS.len() as u32);
    let mut scene = empty(columns * PITCH, rows * PITCH);
    // Pixels are units, seen from so far away that all balls are seen straight.
    let height = (rows * PITCH) as f32;
    let far = 64.0 * height;
    scene.sensor = pinhole(Vec3::Z * far, Vec3::ZERO, Vec3::Y, (2.0 * (0.5 * height / far).atan()).to_degrees());
    scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    for (row, [metallic, transmission]) in (0..).zip(KINDS) {
        for (column, roughness) in (0..).zip(ROUGHNESSES) {
            let physical = Physical { metallic, transmission, roughness, ..Physical::default() };
            let at = |index: u32, of: u32| (index * PITCH + PITCH / 2) as f32 - (of * PITCH) as f32 / 2.0;
            let place = Affine3A::from_translation(Vec3::new(at(column, columns), -at(row, rows), 0.0))
                * Affine3A::from_scale(Vec3::splat(0.5 * DIAMETER as f32));
            add(&mut scene, icosphere(4), Material { physical: Some(physical), ..Material::default() }, place);
        }
    }
    scene
}

/// Every ball of the grid on every backend, with so many samples for each of 16 pixels.
///
/// # Errors
/// If a backend fails.
pub fn measure(bench: &Workbench, samples: u32) -> Result<Vec<Furnace>> {
    let mut scene = scene();
    let mut balls: Vec<_> = KINDS
        .iter()
        .flat_map(|&[metallic, transmission]| {
            ROUGHNESSES.map(|roughness| Furnace { roughness, metallic, transmission, found: vec![] })
        })
        .collect();
    for (seed, backend) in (1..).zip(bench.backends()) {
        scene.settings.seed = seed;
        let mut tracer = bench.tracer(&scene, backend)?;
        for (index, ball) in (0u32..).zip(&mut balls) {
            let columns = ROUGHNESSES.len() as u32;
            let corner = |index: u32| index * PITCH + (PITCH - PIXELS) / 2;
            let tile = Tile { x: corner(index % columns), y: corner(index / columns), width: PIXELS, height: PIXELS };
            let mut means = vec![];
            for first in (0..samples).step_by(BATCH as usize) {
                let group = 16.min(samples);
                let batch = Batch { tile, samples: first..samples.min(first + BATCH), group };
                let sums = tracer.trace(&batch)?.sums;
                means.extend(sums.iter().map(|sum| sum.radiance.iter().sum::<f64>() / 3.0 / f64::from(group)));
            }
            ball.found.push(Estimate::new(means.into_iter()));
        }
    }
    Ok(balls)
}

/// What a white metal sends back of even light at the roughness and the angle where it is farthest from 1.
#[derive(Debug, Clone, Copy)]
pub struct WhiteMetal {
    /// Who scattered it.
    pub backend: Backend,
    /// Perceptual roughness, 0.05 to 1.
    pub roughness: f32,
    /// Degrees from the normal, 0 to 89.9.
    pub degrees: f64,
    /// What was sent back: evenly distributed numbers choose the directions.
    pub found: f64,
}

/// Evenly distributed numbers, as bits: Roberts' sequence for three dimensions.
fn evenly(i: u32) -> [u32; 4] {
    let bits = |step: f64| ((0.5 + step * f64::from(i + 1)).fract() * 2f64.powi(32)) as u32;
    let [u, v, lobe] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3].map(bits);
    [u, v, lobe, 0]
}

/// The farthest that a white metal is from white in a white furnace, backend by backend: over roughnesses from 0.05 to 1 and angles from 0 to 89.9 degrees, with so
/// many samples each.
///
/// # Errors
/// If a backend fails.
pub fn white_metal(bench: &Workbench, samples: u32) -> Result<Vec<WhiteMetal>> {
    const ROUGHNESSES: [f32; 9] = [0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.75, 0.9, 1.0];
    const DEGREES: [f64; 8] = [0.0, 20.0, 45.0, 60.0, 75.0, 85.0, 89.0, 89.9];
    let metals = ROUGHNESSES.map(|roughness| Physical { metallic: 1.0, roughness, ..Physical::default() });
    let mut scene = empty(4, 4);
    for physical in metals {
        add(&mut scene, icosphere(0), Material { physical: Some(physical), ..Material::default() }, Affine3A::IDENTITY);
    }
    let mut worst = vec![];
    for backend in bench.backends() {
        let probe = if backend == Backend::Cpu { None } else { Some(bench.probe(&scene, backend)?) };
        let mut farthest: Option<WhiteMetal> = None;
        for (material, roughness) in (0u32..).zip(ROUGHNESSES) {
            for degrees in DEGREES {
                let (sine, cosine) = degrees.to_radians().sin_cos();
                let weights: Vec<f64> = match &probe {
                    None => {
                        let material = &scene.materials[material as usize];
                        let surface = PhysicalSurface::without_maps(material).expect("a metal");
                        let lobes = Lobes::new(&surface, DVec3::Z, true, DVec3::new(sine, 0.0, cosine));
                        let weight = |i| {
                            let [u, v, lobe, _] = evenly(i).map(uniform);
                            let wi = lobes.direction([u, v], lobe);
                            let (value, pdf) = lobes.value_and_pdf(wi);
                            if pdf > 0.0 { value.x * wi.z / pdf } else { 0.0 }
                        };
                        (0..samples).map(weight).collect()
                    }
                    Some(probe) => {
                        let wo = [sine as f32, 0.0, cosine as f32].map(f32::to_bits);
                        let call = |i| -> Call { [[wo[0], wo[1], wo[2], material], evenly(i)] };
                        let paths = probe.call(Function::Scatter, &(0..samples).map(call).collect::<Vec<_>>())?;
                        paths.iter().map(|path| f64::from(f32::from_bits(path[1][0]))).collect()
                    }
                };
                let found = weights.iter().sum::<f64>() / f64::from(samples);
                if farthest.is_none_or(|f| (found - 1.0).abs() > (f.found - 1.0).abs()) {
                    farthest = Some(WhiteMetal { backend, roughness, degrees, found });
                }
            }
        }
        worst.extend(farthest);
    }
    Ok(worst)
}
