//! Metallic-roughness surfaces: directions against densities, energy, reciprocity, limits.

use crate::common::directions::*;
use crate::common::scenes::*;
use crate::common::statistics::*;
use glam::{DVec3, Vec3};
use luminaire::reference::albedo;
use luminaire::reference::bsdf::bsdf_pdf;
use luminaire::reference::fresnel::fresnel;
use luminaire::reference::microfacet::Ggx;
use luminaire::reference::scatter::scatter;
use luminaire::reference::surfel::Surfel;
use luminaire::reference::warp::{frame, uniform_hemisphere};
use luminaire::sampling::{random4, uniform};
use luminaire::scene::albedo_table::TABLE;
use luminaire::scene::{Directions, Physical};
use rayon::prelude::*;
use std::f64::consts::{LN_2, PI, TAU};

fn metal(roughness: f32) -> Physical {
    Physical { metallic: 1.0, roughness, ..Physical::default() }
}

fn glass(roughness: f32, ior: f32) -> Physical {
    Physical { transmission: 1.0, roughness, ior, ..Physical::default() }
}

/// Evenly distributed numbers: Roberts' sequence for three dimensions.
fn evenly(i: u32) -> [f64; 3] {
    [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3]
        .map(|step| (0.5 + step * f64::from(i + 1)).fract())
}

/// All that is scattered towards `wo`, impulses included: the mean weight.
fn albedo_of(surfel: &Surfel, wo: DVec3, n: u32) -> DVec3 {
    let sum: DVec3 = (0..n)
        .map(|i| {
            let scattered = scatter(surfel, wo, Directions::Bsdf, evenly(i));
            scattered.weight * scattered.eta2
        })
        .sum();
    sum / f64::from(n)
}

/// Surfaces of every kind, seen from a side, and how they are called.
fn kinds() -> Vec<(String, Surfel)> {
    let mut kinds = vec![];
    let mut add = |name: String, p: &Physical, thin: bool, front: bool| {
        kinds.push((name, physical_surfel(p, thin, front)));
    };
    for roughness in [0.1, 0.3, 0.6, 1.0] {
        let plastic = Physical { roughness, base_color: Vec3::new(0.9, 0.5, 0.1), ..Physical::default() };
        add(format!("metal {roughness}"), &metal(roughness), false, true);
        add(format!("plastic {roughness}"), &plastic, false, true);
        add(format!("brushed {roughness}"), &Physical { anisotropy: 0.5, ..metal(roughness) }, false, true);
        for ior in [1.1, 1.5, 2.4] {
            add(format!("glass {roughness} {ior}"), &glass(roughness, ior), false, true);
            add(format!("glass {roughness} {ior} from inside"), &glass(roughness, ior), false, false);
        }
        add(format!("frosted sheet {roughness}"), &glass(roughness, 1.5), true, true);
        let coated = Physical { clearcoat: 0.8, clearcoat_roughness: 0.2, metallic: 0.3, transmission: 0.5, ..plastic };
        add(format!("everything {roughness}"), &coated, false, true);
        add(format!("everything {roughness} from inside"), &coated, false, false);
    }
    kinds
}

/// Directions are chosen by the density that is claimed, cell by cell; what is not chosen goes nowhere.
#[test]
fn lobes_have_their_density() {
    const N: u32 = 60_000;
    let cases: Vec<_> = kinds()
        .into_iter()
        .flat_map(|(name, surfel)| [10.0, 50.0, 82.0].map(|at| (name.clone(), surfel, at)))
        .collect();
    let tests: Vec<(String, f64)> = cases
        .par_iter()
        .enumerate()
        .map(|(index, (name, surfel, degrees))| {
            // Across what is brushed, too.
            let turned = |w: DVec3| DVec3::new(0.8 * w.x, 0.6 * w.x, w.z);
            let wo = turned(tilted(*degrees));
            let lobes = surfel.lobes(wo).expect("it has lobes");
            // Narrow about what a smooth surface reflects and transmits.
            let through = lobes.impulse_directions(DVec3::Z, wo)[1];
            let above = Cells { axis: turned(tilted(-degrees)), power: 3 };
            let p = surfel.physical.expect("a surface");
            let straight = through == DVec3::ZERO || (p.roughness > 0.5 && p.ior < 1.2);
            let below = Cells { axis: if straight { -wo } else { through }, power: 4 };
            let density = |side: f64| {
                move |wi: DVec3| if wi.z * side > 0.0 { f64::from(N) * lobes.value_and_pdf(wi).1 } else { 0.0 }
            };
            let mut expected = above.integrate_by::<8>(density(1.0));
            let cells_above = expected.len();
            expected.extend(below.integrate_by::<12>(density(-1.0)));
            let mass = expected.iter().sum::<f64>() / f64::from(N);
            assert!(mass <= 1.0 + 2e-3, "{name} at {degrees}: a density of {mass}");
            expected.push((1.0 - mass).max(0.0) * f64::from(N));
            let mut counts = vec![0; expected.len()];
            for i in 0..N {
                let [u, v, lobe, _] = random4(i, index as u32, 1, 17).map(uniform);
                let wi = lobes.direction([u, v], lobe);
                assert!(wi == DVec3::ZERO || (wi.length() - 1.0).abs() < 1e-9, "{name}: {wi}");
                let cell = match wi.z {
                    0.0 => expected.len() - 1,
                    z if z > 0.0 => above.cell(wi),
                    _ => cells_above + below.cell(wi),
                };
                counts[cell] += 1;
            }
            (format!("{name} at {degrees} degrees"), chi_square_against(&counts, &expected))
        })
        .collect();
    assert_plausible(&tests);
}

/// What a path is given is the value of its direction over its density, whichever way directions are chosen, with impulses and without.
#[test]
fn scatter_gives_value_over_density() {
    let smooth = Physical { roughness: 0.0, base_color: Vec3::splat(0.6), transmission: 0.3, ..Physical::default() };
    let mut all = kinds();
    for front in [true, false] {
        all.push(("smooth".into(), physical_surfel(&smooth, false, front)));
    }
    for (name, surfel) in all {
        for directions in [Directions::Bsdf, Directions::Cosine, Directions::Uniform] {
            let wo = tilted(35.0);
            for i in 0..200 {
                let [u, v, lobe, _] = random4(i, 5, 5, 5).map(uniform);
                let scattered = scatter(&surfel, wo, directions, [u, v, lobe]);
                let Some(pdf) = scattered.pdf.filter(|pdf| *pdf > 0.0) else { continue };
                assert_eq!(pdf, bsdf_pdf(&surfel, wo, scattered.wi, directions));
                let expected = surfel.bsdf(wo, scattered.wi) * scattered.wi.z.abs() / pdf;
                assert!((scattered.weight - expected).length() <= 1e-9 * expected.length(), "{name}");
                assert!(
                    directions != Directions::Bsdf || scattered.weight.max_element() * scattered.eta2 < 20.0,
                    "{name}: {scattered:?}"
                );
            }
        }
        // All ways to choose directions find the same.
        let wo = tilted(35.0);
        let mean = |directions| {
            let weights = (0..40_000).map(|i| {
                let scattered = scatter(&surfel, wo, directions, random_numbers(i));
                scattered.weight.x * scattered.eta2
            });
            Estimate::new(weights)
        };
        if surfel.physical.is_some_and(|p| p.roughness > 0.5) {
            let (a, b) = (mean(Directions::Bsdf), mean(Directions::Uniform));
            let z = (a.mean - b.mean) / a.error.hypot(b.error);
            assert!(two_sided(z) > SIGNIFICANCE / 40.0, "{name}: {a:?} {b:?}");
        }
    }
}

fn random_numbers(i: u32) -> [f64; 3] {
    let [u, v, lobe, _] = random4(i, 9, 9, 3).map(uniform);
    [u, v, lobe]
}

/// A white metal in a white furnace is white, at every roughness and angle: within 0.5 %.
#[test]
fn white_rough_metal_is_white() {
    let roughnesses = [0.0, 0.005, 0.02, 0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.75, 0.9, 1.0];
    let worst: Vec<f64> = roughnesses
        .par_iter()
        .flat_map_iter(|roughness| {
            [0.0, 20.0, 45.0, 60.0, 75.0, 85.0, 89.0, 89.9].map(|degrees| {
                let albedo = albedo_of(&physical_surfel(&metal(*roughness), false, true), tilted(degrees), 40_000).x;
                assert!((albedo - 1.0).abs() <= 5e-3, "roughness {roughness} at {degrees} degrees: {albedo}");
                (albedo - 1.0).abs()
            })
        })
        .collect();
    println!("white metals are off by at most {:.2e}", worst.iter().fold(0.0, |a: f64, b| a.max(*b)));
}

/// White glass, white plastic, and mixtures: nothing is gained at any angle, and of what has no coat nothing is lost, within 1 %.
#[test]
fn white_surfaces_lose_and_gain_nothing() {
    let mut cases = vec![];
    for roughness in [0.0, 0.05, 0.2, 0.4, 0.7, 1.0] {
        for ior in [1.0, 1.05, 1.5, 2.4] {
            for (transmission, metallic) in [(1.0, 0.0), (0.0, 0.0), (0.5, 0.0), (0.5, 0.5)] {
                for (thin, front) in [(false, true), (false, false), (true, true)] {
                    if transmission > 0.0 || (front && !thin) {
                        cases.push((Physical { metallic, transmission, ..glass(roughness, ior) }, thin, front));
                    }
                }
            }
        }
    }
    // Numbers of the table lie far apart for what is hardly bent, and near grazing.
    let most = |ior: f32, degrees: f64| if ior < 1.2 || degrees > 80.0 { 0.02 } else { 0.01 };
    let worst: Vec<(f64, String)> = cases
        .par_iter()
        .flat_map_iter(|(p, thin, front)| {
            [0.0, 45.0, 70.0, 85.0, 89.5].map(|degrees| {
                let albedo = albedo_of(&physical_surfel(p, *thin, *front), tilted(degrees), 12_000).x;
                let Physical { roughness, ior, transmission, metallic, .. } = p;
                let what = format!(
                    "roughness {roughness}, index {ior}, transmission {transmission}, metallic {metallic}, thin {thin}, front {front}, at {degrees} \
                     degrees: {albedo}"
                );
                ((albedo - 1.0) * 0.01 / most(*ior, degrees), what)
            })
        })
        .collect();
    for (_, what) in worst.iter().filter(|(off, _)| off.abs() > 0.01) {
        println!("{what}");
    }
    let (off, what) = worst.iter().max_by(|a, b| a.0.abs().total_cmp(&b.0.abs())).expect("some");
    println!("off by at most {off:.2e} (of what is allowed as 0.01): {what}");
    assert!(off.abs() <= 0.01, "{what}");
}

/// Coated and brushed surfaces, of every colour: no channel sends out more than arrives.
#[test]
fn coats_and_brushes_gain_nothing() {
    let mut cases = vec![];
    for roughness in [0.05, 0.3, 0.6, 1.0] {
        for clearcoat_roughness in [0.0, 0.3, 1.0] {
            for metallic in [0.0, 0.5, 1.0] {
                for (transmission, anisotropy) in [(0.0, 0.0), (0.6, 0.0), (0.0, 0.7)] {
                    let specular_color = Vec3::new(2.0, 1.0, 0.0);
                    let base = Physical {
                        metallic,
                        transmission,
                        anisotropy,
                        roughness,
                        specular_color,
                        ..Physical::default()
                    };
                    cases.push(Physical { clearcoat: 1.0, clearcoat_roughness, ..base.clone() });
                    if clearcoat_roughness == 0.0 {
                        cases.push(base);
                    }
                }
            }
        }
    }
    let found: Vec<(bool, String, f64)> = cases
        .par_iter()
        .flat_map_iter(|p| {
            [0.0, 60.0, 85.0].map(|degrees| {
                let albedo = albedo_of(&physical_surfel(p, false, true), tilted(degrees), 8_000);
                // Numbers of the table are a little off, those for what is brushed more so.
                let most = if p.anisotropy > 0.0 { 1.05 } else { 1.01 };
                let (low, high) = (albedo.min_element(), albedo.max_element());
                let least = if p.anisotropy > 0.0 { 0.9 } else { 0.97 };
                let Physical { roughness, clearcoat, clearcoat_roughness, metallic, transmission, anisotropy, .. } = p;
                let what = format!(
                    "roughness {roughness}, coat {clearcoat} {clearcoat_roughness}, metallic {metallic}, transmission {transmission}, \
                     anisotropy {anisotropy}, {degrees} degrees: {albedo}"
                );
                (low < least || high > most, what, high)
            })
        })
        .collect();
    for (_, what, _) in found.iter().filter(|(off, ..)| *off) {
        println!("{what}");
    }
    println!("at most {}", found.iter().fold(0.0, |a: f64, (_, _, b)| a.max(*b)));
    assert!(!found.iter().any(|(off, ..)| *off));
}

/// Light may go either way through the body below a dielectric, and by microfacets but for what is added of later reflections; a coat takes its share by what
/// it lets through of one of the directions: these ratios are what they are said to be.
#[test]
fn reciprocity_fails_by_no_more_than_is_said() {
    let pair = |i: u32| {
        let [a, b, c, d] = random4(i, 5, 8, 2).map(uniform);
        let wo = uniform_hemisphere(DVec3::Z, 1.0 - (1.0 - a).powi(3).max(1e-5), b);
        (wo, uniform_hemisphere(DVec3::Z, c, d))
    };
    for (name, surfel) in kinds() {
        let p = surfel.physical.expect("one");
        if p.transmission > 0.0 || p.clearcoat > 0.0 {
            continue;
        }
        for i in 0..500 {
            let (wo, wi) = pair(i);
            let (there, back) = (surfel.bsdf(wo, wi), surfel.bsdf(wi, wo));
            let missing = |w: DVec3| TABLE.missing(w.z, (p.roughness * p.roughness).max(p.anisotropy));
            let bound = 1.0 / (1.0 - missing(wo).max(missing(wi)));
            let ratio = (there / back).max(back / there).max_element();
            assert!(ratio <= bound * (1.0 + 1e-9), "{name}: {there} {back}, {ratio} above {bound}");
            // A white metal's is the ratio of what is missing.
            if p.metallic == 1.0 && p.anisotropy == 0.0 {
                let expected = (1.0 - missing(wi)) / (1.0 - missing(wo));
                assert!((there.x / back.x / expected - 1.0).abs() < 1e-6, "{name}: {there} {back} {expected}");
            }
        }
    }
    // A coat takes its share by one of the directions: what the other lets through over that bounds the ratio.
    let coated = Physical { clearcoat: 1.0, clearcoat_roughness: 0.0, metallic: 0.0, specular: 0.0, ..metal(0.5) };
    let surfel = physical_surfel(&coated, false, true);
    for i in 0..500 {
        let (wo, wi) = pair(i);
        let (there, back) = (surfel.bsdf(wo, wi).x, surfel.bsdf(wi, wo).x);
        let bound = (1.0 - fresnel(1.5, wo.z)) / (1.0 - fresnel(1.5, wi.z));
        assert!((there / back / bound - 1.0).abs() < 1e-9, "{there} {back} {bound}");
    }
}

/// Towards roughness 0 neither energy nor colour jumps, and there it is the impulse of the smooth surface.
#[test]
fn the_limit_of_no_roughness_is_smooth() {
    for metallic in [0.0, 1.0] {
        for transmission in [0.0, 1.0] {
            for degrees in [0.0, 50.0, 75.0] {
                let at = |roughness: f64| {
                    let p = Physical {
                        base_color: Vec3::new(0.9, 0.6, 0.2),
                        metallic,
                        transmission,
                        roughness: roughness as f32,
                        ..Physical::default()
                    };
                    albedo_of(&physical_surfel(&p, false, true), tilted(degrees), 6_000)
                };
                let mut before = at(1.0);
                for step in 1..=60 {
                    let now = at(10f64.powf(-0.1 * f64::from(step)));
                    let jump = (now - before).abs().max_element();
                    assert!(
                        jump < 0.15,
                        "metallic {metallic}, transmission {transmission}, {degrees}, step {step}: {before} {now}"
                    );
                    before = now;
                }
                let (rough, smooth) = (at(0.010_001), at(0.009_999));
                assert!(
                    (rough - smooth).abs().max_element() < 3e-3,
                    "{metallic} {transmission} {degrees}: {rough} {smooth}"
                );
            }
        }
    }
}

/// The distribution of normals has the surface's area (its density times the cosine integrates to 1), what is seen of it the surface's projection; and the albedo of
/// width 1, seen from above, is 1 - ln 2.
#[test]
fn microfacets_have_the_area_of_the_surface() {
    let ggx = Ggx { x: 0.5, y: 0.2 };
    let wo = DVec3::new(0.5, 0.3, 0.0) + 0.4 * DVec3::Z;
    let wo = wo.normalize();
    let (n, mut area, mut seen) = (2000, 0.0, 0.0);
    for i in 0..n {
        for j in 0..n / 4 {
            let z = (f64::from(i) + 0.5) / f64::from(n);
            let phi = TAU * (f64::from(j) + 0.5) / f64::from(n / 4);
            let h = DVec3::new((1.0 - z * z).sqrt() * phi.cos(), (1.0 - z * z).sqrt() * phi.sin(), z);
            let measure = TAU / f64::from(n) / f64::from(n / 4);
            area += ggx.density(h) * z * measure;
            seen += ggx.density(h) * wo.dot(h).max(0.0) / (1.0 + ggx.lambda(wo)) * measure;
        }
    }
    assert!((area - 1.0).abs() < 1e-3, "{area}");
    assert!((seen / wo.z - 1.0).abs() < 1e-3, "{seen} {}", wo.z);
    let missing = albedo::missing(1.0, 1.0, 512);
    assert!((missing - LN_2).abs() < 1e-4, "{missing}");
    assert!((TABLE.missing(1.0, 1.0) - LN_2).abs() < 1e-3);
}

/// Some numbers of the table, made again; and between its numbers.
#[test]
fn the_table_is_what_is_computed() {
    for (cosine, alpha) in [(1.0, 1.0), (0.3, 1.0), (0.02, 0.0625), (0.7, 0.2), (0.003, 0.0025), (0.11, 0.5)] {
        let (found, expected) = (TABLE.missing(cosine, alpha), albedo::missing(cosine, alpha, 400));
        assert!((found - expected).abs() < 3e-3, "{cosine} {alpha}: {found} {expected}");
    }
    for (cosine, alpha, eta) in [(1.0, 0.5, 1.5), (0.3, 0.2, 1.5), (0.5, 0.9, 1.33), (0.8, 0.04, 2.4), (0.2, 0.3, 1.1)]
    {
        let (found, expected) =
            (TABLE.dielectric(cosine, alpha, eta), albedo::dielectric_albedo(cosine, alpha, eta, 400));
        let off = [
            found.edge - expected.edge,
            found.transmitted - expected.transmitted,
            found.inside - expected.inside,
            found.transmitted_inside - expected.transmitted_inside,
        ];
        assert!(off.iter().all(|off| off.abs() < 1.5e-2), "{cosine} {alpha} {eta}: {found:?} {expected:?}");
    }
}

/// A smooth surface is what the lecture's impulses are: a mirror of the metal's reflectance, glass of the same index.
#[test]
fn smooth_surfaces_are_impulses() {
    for front in [true, false] {
        let old = Surfel {
            reflection: DVec3::ONE,
            transmission: DVec3::new(0.5, 0.7, 0.9),
            eta: Some(1.5),
            front,
            ..flat_surfel(DVec3::ZERO, DVec3::ZERO, 0.0)
        };
        let new = physical_surfel(&Physical { base_color: Vec3::new(0.5, 0.7, 0.9), ..glass(0.0, 1.5) }, false, front);
        for degrees in [0.0, 30.0, 41.0, 60.0, 88.0] {
            let (a, b) = (old.impulses(tilted(degrees)), new.impulses(tilted(degrees)));
            assert!((a.reflection - b.reflection).length() < 1e-6, "{degrees}: {a:?} {b:?}");
            assert!((a.transmission - b.transmission).length() < 1e-6, "{degrees}: {a:?} {b:?}");
            assert!(a.reflected == b.reflected && a.transmitted == b.transmitted && a.eta == b.eta);
        }
        assert!(!new.scatters());
    }
    let (t, _) = frame(DVec3::Z);
    assert!(t.is_finite() && PI > 3.0);
}
