//! Scattering as the GPU does it: directions against densities, densities against each other, both against the reference, energy, and
//! reciprocity; for every kind of material and every choice of directions.

use super::functions::{call, floats, units, vector};
use super::*;
use crate::common::directions::*;
use crate::common::scenes::*;
use crate::common::statistics::*;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::gpu::probe::{Call, Function, Probe};
use luminaire::reference::bsdf::bsdf_pdf;
use luminaire::reference::scatter::scatter;
use luminaire::reference::surfel::Surfel;
use luminaire::reference::warp;
use luminaire::sampling::{random4, uniform};
use luminaire::scene::{Directions, Material, coat_transmittance};
use rand::SeedableRng;
use rand::rngs::StdRng;
use rayon::prelude::*;

/// Paths that are scattered for every material and viewing direction.
const N: u32 = 24_000;
/// Of which so many are compared with the reference, one by one.
const TWINS: usize = 4_000;
/// Viewing directions, in degrees from the normal; those whose directions are counted in cells; and the last one is grazing.
const DEGREES: [(f64, bool); 4] = [(0.0, false), (45.0, true), (80.0, true), (89.9, false)];

/// Lambert, mirrors, glass from either side, and mixtures: the lecture's of 60 to 40, and one with everything.
fn without_gloss() -> Vec<Material> {
    let grey = Vec3::splat;
    vec![
        matte(Vec3::ONE),
        Material { reflection: grey(0.6), impulse_probability: Some(0.6), ..matte(Vec3::new(0.4, 0.3, 0.1)) },
        Material { reflection: Vec3::new(1.0, 0.5, 0.25), ..Material::default() },
        Material {
            reflection: Vec3::ONE,
            transmission: Vec3::new(1.0, 0.8, 0.9),
            eta: Some(1.5),
            ..Material::default()
        },
        Material { reflection: Vec3::ONE, transmission: Vec3::ONE, eta: Some(1.0 / 1.5), ..Material::default() },
    ]
}

/// Lambert under a smooth dielectric: plastic, one with a tinted coat, one of an index below 1; and in glass, which is no coat, seen from both sides.
fn coated() -> Vec<Material> {
    let grey = Vec3::splat;
    vec![
        Material { reflection: Vec3::ONE, eta: Some(1.5), ..matte(Vec3::new(0.8, 1.0, 0.1)) },
        Material {
            reflection: Vec3::new(1.0, 0.5, 0.0),
            eta: Some(2.4),
            impulse_probability: Some(0.3),
            ..matte(Vec3::ONE)
        },
        Material { reflection: grey(0.5), transmission: grey(0.5), eta: Some(1.5), ..matte(Vec3::new(0.5, 0.3, 0.1)) },
        Material { reflection: grey(0.4), transmission: grey(0.4), eta: Some(1.0 / 1.5), ..matte(grey(0.6)) },
        Material { reflection: Vec3::ONE, eta: Some(1.0 / 1.5), ..matte(grey(0.6)) },
    ]
}

/// Glossy lobes of an exponent: alone, with Lambert, and both under a coat, or in glass for an exponent of 1.
fn with_gloss(m: f64) -> [Material; 3] {
    let glossy = |glossy: Vec3, base: Material| Material { glossy, exponent: m as f32, ..base };
    let coat = Material {
        reflection: Vec3::new(0.3, 0.2, 0.1),
        transmission: Vec3::splat(if m == 1.0 { 0.3 } else { 0.0 }),
        eta: Some(1.5),
        impulse_probability: (m == 20.0).then_some(0.6),
        ..matte(Vec3::splat(0.3))
    };
    [
        glossy(Vec3::ONE, Material::default()),
        glossy(Vec3::new(0.2, 0.7, 0.1), matte(Vec3::splat(0.3))),
        glossy(Vec3::splat(0.4), coat),
    ]
}

/// One material, seen from one direction, and what is expected of it.
struct Case {
    name: String,
    material: u32,
    surfel: Surfel,
    /// As the shader sees it: single precision.
    wo: DVec3,
    /// Share of each colour that goes on in any way.
    albedo: DVec3,
    cells: Option<(Cells, Vec<f64>)>,
}

fn surfel(material: &Material) -> Surfel {
    Surfel {
        reflection: material.reflection.as_dvec3(),
        transmission: material.transmission.as_dvec3(),
        eta: material.eta.map(f64::from),
        coat_transmittance: material.eta.map_or(1.0, |eta| coat_transmittance(eta.into())),
        impulse_probability: material.impulse_probability.map(f64::from),
        ..flat_surfel(material.lambert.as_dvec3(), material.glossy.as_dvec3(), material.exponent.into())
    }
}

fn mean(colour: DVec3) -> f64 {
    colour.element_sum() / 3.0
}

impl Case {
    fn new(material: &Material, index: u32, degrees: f64, counted: bool, directions: Directions) -> Self {
        let surfel = surfel(material);
        let wo = tilted(degrees).as_vec3().as_dvec3();
        let impulses = surfel.impulses(wo);
        let passes = if surfel.is_coated() { DVec3::ONE - impulses.reflection } else { DVec3::ONE };
        let mut albedo = surfel.lambert * passes + impulses.reflection + impulses.transmission;
        if surfel.glossy != DVec3::ZERO {
            // Of a white lobe, under a coat that reflects as much as this channel's.
            let lobe = |reflection: f64| {
                let reflection = DVec3::splat(reflection);
                directional_albedo(&Surfel { lambert: DVec3::ZERO, glossy: DVec3::ONE, reflection, ..surfel }, wo)
            };
            let white = lobe(surfel.reflection.x);
            albedo += surfel.glossy
                * match surfel.is_coated() {
                    true => DVec3::new(white, lobe(surfel.reflection.y), lobe(surfel.reflection.z)),
                    false => DVec3::splat(white),
                };
        }
        let cells = counted.then(|| {
            let mirror = DVec3::new(-wo.x, -wo.y, wo.z);
            let cells = Cells { axis: mirror, power: if surfel.exponent > 100.0 { 6 } else { 2 } };
            let mut expected = cells.integrate(|wi| bsdf_pdf(&surfel, wo, wi, directions));
            let p = surfel.impulse_probability(&impulses);
            let (reflection, transmission) = (mean(impulses.reflection), mean(impulses.transmission));
            let q = if reflection > 0.0 { reflection / (reflection + transmission) } else { 0.0 };
            let below = 1.0 - p - expected.iter().sum::<f64>();
            assert!(below > -1e-3, "the density integrates to too much by {}", -below);
            // Then what is reflected, transmitted, and lost below the surface.
            expected.extend([p * q, p * (1.0 - q), below.max(0.0)]);
            expected.iter_mut().for_each(|share| *share *= f64::from(N));
            (cells, expected)
        });
        let name = format!("material {index} (m = {}) at {degrees} degrees, {directions:?}", surfel.exponent);
        Case { name, material: index, surfel, wo, albedo, cells }
    }

    fn calls(&self) -> Vec<Call> {
        let [x, y, z] = self.wo.as_vec3().to_array().map(f32::to_bits);
        (0..N).map(|i| [[x, y, z, self.material], random4(i, self.material, z, 41)]).collect()
    }

    /// By how much of itself what is computed from the lobe at `wi` may be off: `cos^m` shows the rounding of the sine `m` times, and what a
    /// coat lets through at grazing angles, or near the critical one, is a small difference.
    fn rounding(&self, wi: DVec3) -> f64 {
        let h = (self.wo + wi).normalize();
        let coat = if self.surfel.is_coated() {
            let through = |w: DVec3| (DVec3::ONE - self.surfel.impulses(w).reflection).min_element().max(1e-6);
            let eta2 = self.surfel.eta.map_or(1.0, |eta| eta * eta).min(1.0);
            let critical = |w: DVec3| if eta2 < 1.0 { 1e-7 / (w.z - (1.0 - eta2).sqrt()).abs().max(1e-9) } else { 0.0 };
            [self.wo, wi].iter().map(|w| 4e-7 / through(*w) + critical(*w)).sum()
        } else {
            0.0
        };
        5e-6 + 1e-6 * self.surfel.exponent * h.x.hypot(h.y) + 1e-6 / self.wo.dot(h) + coat
    }

    /// Whether a choice by `lobe` is so close that rounding may decide it otherwise.
    fn is_close(&self, lobe: f64) -> bool {
        let impulses = self.surfel.impulses(self.wo);
        let p = self.surfel.impulse_probability(&impulses);
        let q = mean(impulses.reflection) / mean(impulses.reflection + impulses.transmission).max(1e-300);
        let glossy = mean(self.surfel.glossy) / mean(self.surfel.lambert + self.surfel.glossy).max(1e-300);
        [p, p * q, p + (1.0 - p) * glossy].iter().any(|boundary| (lobe - boundary).abs() < 2e-6)
    }

    /// One path against the reference's with the same numbers; its density and its weight against those of the direction that it took.
    fn assert_twin(&self, random: [u32; 4], found: &Call, directions: Directions) {
        let ([.., pdf], [.., eta2]) = (floats(found[0]), floats(found[1]));
        let (wi, weight) = (vector(found[0]), vector(found[1]));
        let [u, v, lobe, _] = random.map(uniform);
        let twin = scatter(&self.surfel, self.wo, directions, [u, v, lobe]);
        let what = format!("{}, ({u}, {v}, {lobe}): {found:?} {wi} {weight} {pdf} {eta2} {twin:?}", self.name);
        assert_eq!(pdf < 0.0, twin.pdf.is_none(), "{what}");
        assert!((eta2 - twin.eta2).abs() <= 3e-7 * twin.eta2, "{what}");
        if twin.pdf.is_none() {
            assert!((wi - twin.wi).length() <= 2e-6, "{what}");
            // The shader leaves out by how much refraction concentrates radiance.
            let expected = twin.weight * twin.eta2;
            assert!((weight - expected).abs().cmple(expected * 4e-6).all(), "{what}");
            return;
        }
        // Near the horizon the cosine of what was drawn is the root of a small difference; so near the normal is the sine.
        let h = (self.wo + twin.wi).normalize();
        let low = twin.wi.z.abs().min(h.z).max(1e-3);
        assert!((wi - twin.wi).length() <= 1e-6 + 2e-5 * h.x.hypot(h.y) + 1e-6 / low, "{what}");
        // At the direction that the shader took.
        let expected = bsdf_pdf(&self.surfel, self.wo, wi, directions);
        if expected == 0.0 {
            assert!(pdf == 0.0 && weight == DVec3::ZERO, "{what}");
            return;
        }
        let tolerance = self.rounding(wi);
        assert!((pdf - expected).abs() <= tolerance * expected, "{what}: pdf {expected}");
        let expected = self.surfel.bsdf(self.wo, wi) * wi.z / expected;
        assert!((weight - expected).abs().cmple(expected * tolerance + 1e-30).all(), "{what}: weight {expected}");
    }

    /// All paths of the case: names and `p`s of its hypotheses.
    fn check(&self, calls: &[Call], paths: &[Call], evaluated: &[Call], directions: Directions) -> Vec<(String, f64)> {
        let mut counts = vec![0; self.cells.as_ref().map_or(0, |(_, expected)| expected.len())];
        for (index, ((arguments, path), evaluated)) in calls.iter().zip(paths).zip(evaluated).enumerate() {
            let [.., pdf] = floats(path[0]);
            let (wi, weight) = (vector(path[0]), vector(path[1]));
            let [.., lobe, _] = arguments[1].map(uniform);
            if index < TWINS && !self.is_close(lobe) {
                self.assert_twin(arguments[1], path, directions);
            }
            if pdf >= 0.0 {
                // The density and the weight that a direction came with are those that are found when it is asked for: the same formula,
                // which a compiler may contract otherwise.
                let ([.., again], f) = (floats(evaluated[0]), vector(evaluated[0]));
                if pdf == 0.0 {
                    assert!(again == 0.0 && weight == DVec3::ZERO, "{}: {again} {weight}", self.name);
                } else {
                    let (tolerance, expected) = (self.rounding(wi), f * wi.z);
                    assert!((pdf - again).abs() <= tolerance * pdf, "{}: {pdf} and {again}", self.name);
                    let off = (weight * pdf - expected).abs();
                    assert!(off.cmple(expected * tolerance + 1e-30).all(), "{}: {weight} {f}", self.name);
                }
            }
            if let Some((cells, _)) = &self.cells {
                let last = counts.len() - 1;
                let cell = match pdf {
                    -1.0 if wi.z > 0.0 => last - 2,
                    -1.0 => last - 1,
                    0.0 => last,
                    _ => cells.cell(wi),
                };
                counts[cell] += 1;
            }
        }
        let mut tests = Vec::new();
        if let Some((_, expected)) = &self.cells {
            // All in one cell: nothing is left to chance.
            if let Some(cell) = expected.iter().position(|expected| *expected == f64::from(N)) {
                assert_eq!(counts[cell], N, "{}", self.name);
            } else {
                tests.push((format!("{}, directions", self.name), chi_square_against(&counts, expected)));
            }
        }
        for channel in 0..3 {
            let energy = Estimate::new(paths.iter().map(|path| floats(path[1])[channel]));
            let expected = self.albedo[channel];
            assert!(expected <= 1.0 + 1e-4, "{}: albedo {expected}", self.name);
            assert!(energy.error <= 1.5e-2, "{}: {energy:?} is not sharp enough", self.name);
            // The quadrature is good to 1e-4.
            let p = energy.p_within(expected - 1e-4, expected + 1e-4);
            tests.push((format!("{}, energy {} +- {} of {expected}", self.name, energy.mean, energy.error), p));
            // Not more than arrived, whatever was expected; 2e-6 for rounding.
            if energy.mean > 1.0 + 2e-6 {
                let name = format!("{}, at most 1: {} +- {}", self.name, energy.mean, energy.error);
                tests.push((name, energy.p_within(0.0, 1.0)));
            }
        }
        tests
    }
}

/// A scene with these materials at the end; the index of the first.
fn scene_of(materials: &[Material], directions: Directions) -> (Scene, u32) {
    let mut scene = empty(4, 4);
    add(&mut scene, cube(), matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    estimator(&mut scene).directions = directions;
    let first = scene.materials.len() as u32;
    scene.materials.extend_from_slice(materials);
    (scene, first)
}

/// For each material and viewing direction: the directions of paths have the density that is claimed, impulses their probability
/// (chi-square); the density of a path is that of its direction, and all of it is what the reference does with the same numbers; what goes
/// on in all is the albedo, which is at most 1 (standard error at most 0.015). The significance is 1e-4 for all of it together.
fn check(materials: &[Material], directions: Directions) {
    let (scene, first) = scene_of(materials, directions);
    let cases: Vec<(usize, (f64, bool))> =
        (0..materials.len()).flat_map(|i| DEGREES.map(|degrees| (i, degrees))).collect();
    let cases: Vec<Case> = cases
        .par_iter()
        .map(|&(i, (degrees, counted))| Case::new(&materials[i], first + i as u32, degrees, counted, directions))
        .collect();
    on_every_backend(|backend| {
        let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
        let tests: Vec<_> = cases
            .iter()
            .flat_map(|case| {
                let calls = case.calls();
                let paths = probe.call(Function::Scatter, &calls).expect("the probe runs");
                let back: Vec<Call> =
                    calls.iter().zip(&paths).map(|(arguments, path)| [arguments[0], path[0]]).collect();
                let evaluated = probe.call(Function::Bsdf, &back).expect("the probe runs");
                case.check(&calls, &paths, &evaluated, directions)
            })
            .collect();
        print!("{directions:?}, {}: ", backend.name());
        assert_plausible(&tests);
        if directions == Directions::Bsdf && materials.iter().any(|material| material.glossy != Vec3::ZERO) {
            reciprocity(&probe, materials, first);
        }
    });
}

#[test]
fn paths_by_the_bsdf() {
    let mut materials = without_gloss();
    materials.extend(coated());
    materials.extend(EXPONENTS.into_iter().flat_map(with_gloss));
    check(&materials, Directions::Bsdf);
}

/// Narrow lobes are only found by those who look for them: exponents up to 20.
#[test]
fn paths_by_the_cosine() {
    let mut materials = without_gloss();
    materials.extend([0.0, 1.0, 20.0].into_iter().flat_map(with_gloss));
    materials.extend(coated());
    check(&materials, Directions::Cosine);
}

#[test]
fn paths_by_the_uniform_density() {
    let mut materials = without_gloss();
    materials.extend([0.0, 1.0, 20.0].into_iter().flat_map(with_gloss));
    materials.extend(coated());
    check(&materials, Directions::Uniform);
}

/// The kernel of a scene without glossy materials takes shortcuts, which a coated base takes away.
#[test]
fn paths_without_gloss() {
    check(&without_gloss(), Directions::Bsdf);
    check(&coated(), Directions::Bsdf);
}

/// Light may go either way, to 1e-6, down to grazing angles and in the lobe.
fn reciprocity(probe: &Probe, materials: &[Material], first: u32) {
    let mut rng = StdRng::seed_from_u64(42);
    let mut there = Vec::new();
    for i in 0..40_000 {
        let material = first + (i % materials.len()) as u32;
        let mut direction = |power: i32| {
            let [u, v] = units(&mut rng).map(f64::from);
            // Grazing ones among them.
            warp::uniform_hemisphere(DVec3::Z, 1.0 - (1.0 - u).powi(power).max(1e-4), v).as_vec3()
        };
        let (wo, wi) = (direction(3), direction(1));
        // Half of the pairs mirror each other, nearly.
        let near = (Vec3::new(-wo.x, -wo.y, wo.z) + 0.01 * wi).normalize();
        let wi = if (i / materials.len()).is_multiple_of(2) { wi } else { near };
        let mut pair = call([wo.x, wo.y, wo.z, 0.0], [wi.x, wi.y, wi.z, 0.0]);
        pair[0][3] = material;
        there.push(pair);
    }
    let back: Vec<Call> =
        there.iter().map(|&[[x, y, z, material], [a, b, c, _]]| [[a, b, c, material], [x, y, z, 0]]).collect();
    let found = probe.call(Function::Bsdf, &there).expect("the probe runs");
    let reversed = probe.call(Function::Bsdf, &back).expect("the probe runs");
    let mut lobes = 0;
    for ((pair, a), b) in there.iter().zip(found).zip(reversed) {
        let (a, b) = (vector(a[0]), vector(b[0]));
        assert!((a - b).abs().cmple(1e-6 * a + 1e-30).all(), "{pair:?}: {a} {b}");
        lobes += u32::from(a.x > 1.0);
    }
    assert!(lobes > 1000, "{lobes}");
}
