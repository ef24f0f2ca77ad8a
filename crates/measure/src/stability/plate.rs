//! A plate of microfacets: what the sweeps over metallic-roughness surfaces look at, and what it reflects of a lamp by the formulas of its microfacets.

use super::judge::light;
use super::light::{Spot, Tally, chart, looking_from, noise_axis, off, over_parallelogram, series, without_roulette};
use super::verdict::{Verdict, Worse};
use crate::Workbench;
use crate::chart::{Axis, Chart, Point, Series};
use crate::closed_forms::formulas::reflectance;
use glam::{Affine3A, DVec3, Vec2, Vec3};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::scene::build::{add, lamp, quad};
use luminaire::scene::{
    Directions, Environment, Estimator, Extinction, LightSampling, Material, Mesh, Physical, Scene,
};
use std::f64::consts::PI;

/// Where the camera is; it looks at the plate at the origin, whose normal is +y. The plate is brushed along x.
const EYE: Vec3 = Vec3::new(0.8, 0.6, 0.0);
/// Half the side of the lamps, at the distance 1 in the mirrored direction.
pub(super) const LAMPS: [(&str, f64); 3] = [("small", 0.003), ("middling", 0.03), ("large", 0.3)];
/// Strength of the dark plate's reflection: so little that light which meets two of its microfacets is nothing beside that which meets one. What is left
/// is known in closed form.
const STRENGTH: f32 = 1e-3;
/// Its index.
const INDEX: f64 = 1.5;
/// A lobe of this width is so narrow that the smallest lamp has all of it, but for 1e-6.
const ALL_IN_THE_LAMP: f64 = 1e-6;

/// The default, and the ways to find light that it is held against.
pub(super) const METHODS: [&str; 5] =
    ["both, with roulette", "both (MIS)", "light sampling", "visible normals", "cosine directions"];

/// A surface of a sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Step {
    /// Where it stands.
    pub x: f64,
    /// Perceptual roughness.
    pub roughness: f32,
    /// Strength of the anisotropy.
    pub anisotropy: f32,
}

impl Step {
    /// Widths of the microfacets along x and z (`KHR_materials_anisotropy`); not less than the narrowest that are scattered.
    fn widths(self) -> [f64; 2] {
        let (width, strength) = (f64::from(self.roughness).powi(2), f64::from(self.anisotropy));
        let along = width + (1.0 - width) * strength * strength;
        [along, if self.anisotropy > 0.0 { width.max(1e-4) } else { width }]
    }

    /// Black but for a weak reflection.
    fn dark(self) -> Physical {
        let Step { roughness, anisotropy, .. } = self;
        Physical { base_color: Vec3::ZERO, specular: STRENGTH, roughness, anisotropy, ..Physical::default() }
    }

    /// A metal that absorbs nothing.
    fn white(self) -> Physical {
        let Step { roughness, anisotropy, .. } = self;
        Physical { metallic: 1.0, roughness, anisotropy, ..Physical::default() }
    }

    /// What the dark plate scatters from `wi` to `wo`, by Fresnel, Trowbridge and Reitz, and Smith, times the cosine; its normal is +y.
    fn dark_lobe(self, wo: DVec3, wi: DVec3) -> f64 {
        let [x, z] = self.widths();
        let h = (wo + wi).normalize();
        let t = (h.x / x).powi(2) + (h.z / z).powi(2) + h.y * h.y;
        let lambda = |w: DVec3| 0.5 * ((1.0 + ((x * w.x).powi(2) + (z * w.z).powi(2)) / (w.y * w.y)).sqrt() - 1.0);
        let fresnel = reflectance(INDEX, wo.dot(h).min(1.0).acos());
        f64::from(STRENGTH) * fresnel / (PI * x * z * t * t) / (4.0 * wo.y * (1.0 + lambda(wo) + lambda(wi)))
    }
}

/// The plate, with texture coordinates that say which way it is brushed.
fn plate(physical: Physical, eye: Vec3) -> Scene {
    let mut scene = looking_from(eye);
    let floor = quad(Vec3::new(-2.0, 0.0, -2.0), Vec3::Z * 4.0, Vec3::X * 4.0);
    let uvs = floor.positions.iter().map(|p| Vec2::new(p.x, p.z)).collect();
    let material = Material { physical: Some(physical), ..Material::default() };
    add(&mut scene, Mesh { uvs, ..floor }, material, Affine3A::IDENTITY);
    scene
}

/// The white plate under an even sky of radiance 1.
fn under_the_sky(step: Step, eye: Vec3) -> Scene {
    let mut scene = plate(step.white(), eye);
    scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    scene
}

/// The dark plate under a lamp, and the radiance that the camera sees.
fn lit(step: Step, half: f64) -> (Scene, f64) {
    let wo = EYE.as_dvec3().normalize();
    let towards = DVec3::new(-wo.x, wo.y, 0.0);
    let [a, b] = [DVec3::new(wo.y, wo.x, 0.0), DVec3::Z].map(|edge| (2.0 * half * edge).as_vec3());
    let corner = towards.as_vec3() - 0.5 * (a + b);
    let mut scene = plate(step.dark(), EYE);
    add(&mut scene, quad(corner, a, b), lamp(Vec3::ONE), Affine3A::IDENTITY);
    let narrowest = step.widths()[1];
    if narrowest < ALL_IN_THE_LAMP {
        return (scene, f64::from(STRENGTH) * reflectance(INDEX, wo.y.acos()));
    }
    let [corner, a, b] = [corner, a, b].map(|v| v.as_dvec3());
    let normal = a.cross(b).normalize();
    // Half vectors are half as wide as the lobe.
    let truth = over_parallelogram([corner, a, b], [0.5, 0.5], 0.5 / narrowest, |point| {
        let (wi, distance2) = (point.normalize(), point.length_squared());
        step.dark_lobe(wo, wi) * normal.dot(wi).abs() / distance2
    });
    (scene, truth)
}

/// What was found of plates under the sky and under lamps.
pub(super) struct Plates {
    /// Light that the white plate reflects of the sky, over all: each way of seeing it and each backend, with the sky found by both ways.
    pub sky: Vec<Series>,
    /// Light of the middling lamp over the truth, backend by backend.
    pub lamp: Vec<Series>,
    /// Variance of a sample over the squared truth: lamp by lamp, method by method.
    pub noise: Vec<Vec<Series>>,
    /// Light that was found, over the truth.
    pub found: Vec<Vec<Series>>,
    /// Samples.
    pub tally: Tally,
}

impl Plates {
    /// Measures plates. The white one is seen from each of the eyes.
    pub(super) fn new(bench: &Workbench, steps: &[Step], eyes: &[(&str, Vec3)], samples: u32) -> Result<Self> {
        let backends = bench.backends();
        let of_lamps = || -> Vec<Vec<Series>> { LAMPS.iter().map(|_| series(METHODS)).collect() };
        let both = |(name, _): &(&str, Vec3)| backends.iter().map(move |b| format!("white metal{name}, {b}")).collect();
        let skies: Vec<String> = eyes.iter().flat_map(|eye| -> Vec<String> { both(eye) }).collect();
        let mut plates = Plates {
            sky: series(skies),
            lamp: series(backends.iter().map(|b| format!("dark plate, middling lamp, {b}"))),
            noise: of_lamps(),
            found: of_lamps(),
            tally: Tally::default(),
        };
        let default = Estimator { extinction: Extinction::Throughput, ..without_roulette(LightSampling::Mis, 0) };
        let methods = [
            default,
            without_roulette(LightSampling::Mis, 0),
            without_roulette(LightSampling::Direct, 0),
            without_roulette(LightSampling::None, 0),
            Estimator { directions: Directions::Cosine, ..without_roulette(LightSampling::None, 0) },
        ];
        for &step in steps {
            let mut measure = |scene: &Scene, truth: f64, backend: Backend, estimator| -> Result<[Point; 2]> {
                let spot = Spot::new(bench, backend, scene, estimator, samples)?;
                plates.tally.add(&spot);
                Ok([spot.share(step.x, truth), spot.noise(step.x, truth)])
            };
            for (eye, line) in eyes.iter().zip(plates.sky.chunks_mut(backends.len())) {
                let scene = under_the_sky(step, eye.1);
                for (line, &backend) in line.iter_mut().zip(&backends) {
                    line.points.push(measure(&scene, 1.0, backend, default)?[0]);
                }
            }
            let (scene, truth) = lit(step, LAMPS[1].1);
            for (line, &backend) in plates.lamp.iter_mut().zip(&backends) {
                line.points.push(measure(&scene, truth, backend, default)?[0]);
            }
            for ((noise, found), (_, half)) in plates.noise.iter_mut().zip(&mut plates.found).zip(LAMPS) {
                let (scene, truth) = lit(step, half);
                for (method, estimator) in methods.into_iter().enumerate() {
                    let [share, variance] = measure(&scene, truth, Backend::Cpu, estimator)?;
                    found[method].points.push(share);
                    noise[method].points.push(variance);
                }
            }
        }
        Ok(plates)
    }

    /// What each method is, the default first: by the noise and the light that was found under every lamp, and the default by all that was measured.
    pub(super) fn verdicts(&self, worse: Worse) -> Vec<Verdict> {
        let of = |method: usize| {
            let variances: Vec<_> = self.noise.iter().map(|lamp| &lamp[method]).collect();
            let more = if method == 0 { [&self.sky[..], &self.lamp].concat() } else { vec![] };
            let shares: Vec<_> = self.found.iter().map(|lamp| &lamp[method]).chain(&more).collect();
            light(METHODS[method], &variances, &shares, worse)
        };
        (0..METHODS.len()).map(of).collect()
    }

    /// The charts: energy, and noise lamp by lamp, over what the axis says.
    pub(super) fn charts(&self, x: &str) -> Vec<Chart> {
        let energy = [&self.sky[..], &self.lamp].concat();
        let share = Axis::linear("share found of the energy");
        let mut charts =
            vec![chart("energy", "Energy that a plate of microfacets reflects, over the truth", x, share, energy)];
        for (noise, (name, half)) in self.noise.iter().zip(LAMPS) {
            let title = format!("Noise of a dark plate that mirrors a {name} lamp ({half} of its distance)");
            charts.push(chart(&format!("noise-{name}-lamp"), &title, x, noise_axis(), noise.clone()));
        }
        charts
    }

    /// The largest variance of a sample of a method.
    pub(super) fn noisiest(&self, method: usize) -> f64 {
        let points = self.noise.iter().flat_map(|lamp| &lamp[method].points);
        points.map(|p| p.y).filter(|y| !y.is_nan()).fold(0.0, f64::max)
    }

    /// How far the light of lamps is certainly off the truth, by the default.
    pub(super) fn off_lamps(&self) -> f64 {
        let found = self.found.iter().map(|lamp| &lamp[0]).chain(&self.lamp);
        found.map(|s| off(s, 0.0..=f64::INFINITY)).fold(0.0, f64::max)
    }

    /// Least and most that the white plate was found to reflect.
    pub(super) fn white(&self) -> [f64; 2] {
        let found = || self.sky.iter().flat_map(|line| &line.points).map(|p| p.y);
        [found().fold(f64::INFINITY, f64::min), found().fold(0.0, f64::max)]
    }
}
