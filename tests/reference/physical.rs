//! Metallic-roughness surfaces: directions against densities, energy, reciprocity, limits.

use crate::common::directions::*;
use crate::common::scenes::*;
use crate::common::statistics::*;
use crate::transport::means;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::reference::albedo;
use luminaire::reference::bsdf::bsdf_pdf;
use luminaire::reference::fresnel::{fresnel, fresnel_conductor};
use luminaire::reference::microfacet::Ggx;
use luminaire::reference::scatter::scatter;
use luminaire::reference::surfel::Surfel;
use luminaire::reference::warp::uniform_hemisphere;
use luminaire::sampling::{random4, uniform};
use luminaire::scene::albedo_table::TABLE;
use luminaire::scene::brushed_table::BRUSHED;
use luminaire::scene::*;
use rayon::prelude::*;
use std::f64::consts::{LN_2, PI, TAU};

fn metal(roughness: f32) -> Physical {
    Physical { metallic: 1.0, roughness, ..Physical::default() }
}

fn glass(roughness: f32, ior: f32) -> Physical {
    Physical { transmission: 1.0, roughness, ior, ..Physical::default() }
}

/// Evenly distributed numbers: Roberts' sequence for three dimensions.
pub fn evenly(i: u32) -> [f64; 3] {
    [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3]
        .map(|step| (0.5 + step * f64::from(i + 1)).fract())
}

/// All that is scattered towards `wo`, impulses included: the mean weight.
pub fn albedo_of(surfel: &Surfel, wo: DVec3, n: u32) -> DVec3 {
    let surfel = &viewed_from(surfel, wo);
    let sum: DVec3 = (0..n)
        .map(|i| {
            let scattered = scatter(surfel, wo, Directions::Bsdf, evenly(i));
            scattered.weight * scattered.eta2
        })
        .sum();
    sum / f64::from(n)
}

/// A direction, so many degrees from +z and turned by so many from x.
pub fn turned(degrees: f64, turn: f64) -> DVec3 {
    let ((sin, cos), (y, x)) = (degrees.to_radians().sin_cos(), turn.to_radians().sin_cos());
    DVec3::new(sin * x, sin * y, cos)
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
        // Narrower ones are too narrow for cells.
        let brushed = Physical { anisotropy: 0.5, ..metal(roughness.max(0.3)) };
        add(format!("brushed {roughness}"), &brushed, false, true);
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
    const N: u32 = 40_000;
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
            let lobes = viewed_from(surfel, wo).lobes.expect("it has lobes");
            // Narrow about what a smooth surface reflects and transmits.
            let through = lobes.impulse_directions(DVec3::Z, wo)[1];
            let above = Cells { axis: turned(tilted(-degrees)), power: 3 };
            let p = surfel.physical().expect("a surface");
            let straight = through == DVec3::ZERO || (p.roughness > 0.5 && p.ior < 1.2);
            let below = Cells { axis: if straight { -wo } else { through }, power: 4 };
            let density = |side: f64| {
                move |wi: DVec3| if wi.z * side > 0.0 { f64::from(N) * lobes.value_and_pdf(wi).1 } else { 0.0 }
            };
            let mut expected = above.integrate_by::<6>(density(1.0));
            let cells_above = expected.len();
            expected.extend(below.integrate_by::<10>(density(-1.0)));
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
        let surfel = viewed_from(&surfel, tilted(35.0));
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
            let weights = (0..10_000).map(|i| {
                let scattered = scatter(&surfel, wo, directions, random_numbers(i));
                scattered.weight.x * scattered.eta2
            });
            Estimate::new(weights)
        };
        if surfel.physical().is_some_and(|p| p.roughness > 0.5) {
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
                let albedo = albedo_of(&physical_surfel(&metal(*roughness), false, true), tilted(degrees), 8_000).x;
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
                let albedo = albedo_of(&physical_surfel(p, *thin, *front), tilted(degrees), 4_000).x;
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
                let albedo = albedo_of(&physical_surfel(p, false, true), tilted(degrees), 3_000);
                // Numbers of the table are a little off.
                let (least, most) = (0.97, 1.01);
                let (low, high) = (albedo.min_element(), albedo.max_element());
                // Of what a coat lets through to a rough metal and back the lesser share counts.
                let least = if p.clearcoat > 0.0 { 0.94 } else { least };
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

/// Light may go either way through the body below a dielectric, through a coat, and by microfacets but for what is added of later reflections, where the ratio is what
/// it is said to be.
#[test]
fn reciprocity_fails_by_no_more_than_is_said() {
    let pair = |i: u32| {
        let [a, b, c, d] = random4(i, 5, 8, 2).map(uniform);
        let wo = uniform_hemisphere(DVec3::Z, 1.0 - (1.0 - a).powi(3).max(1e-5), b);
        (wo, uniform_hemisphere(DVec3::Z, c, d))
    };
    for (name, surfel) in kinds() {
        let p = surfel.physical().expect("one");
        if p.transmission > 0.0 || p.clearcoat > 0.0 {
            continue;
        }
        for i in 0..500 {
            let (wo, wi) = pair(i);
            let (there, back) = (viewed_from(&surfel, wo).bsdf(wo, wi), viewed_from(&surfel, wi).bsdf(wi, wo));
            let width = p.roughness * p.roughness;
            let ggx = Ggx { x: width + (1.0 - width) * p.anisotropy * p.anisotropy, y: width };
            let missing = |w: DVec3| match p.anisotropy > 0.0 && ggx.x > ggx.y {
                true => BRUSHED.missing([ggx.x, ggx.y], w),
                false => TABLE.missing(w.z, ggx.x),
            };
            let bound = 1.0 / (1.0 - missing(wo).max(missing(wi)));
            let ratio = (there / back).max(back / there).max_element();
            assert!(ratio <= bound * (1.0 + 1e-9), "{name}: {there} {back}, {ratio} above {bound}");
            // A white metal's, if it is narrow, is the ratio of what is missing.
            if p.metallic == 1.0 && p.roughness < 0.2 {
                let expected = (1.0 - missing(wi)) / (1.0 - missing(wo));
                assert!((there.x / back.x / expected - 1.0).abs() < 1e-6, "{name}: {there} {back} {expected}");
            }
        }
    }
    // A coat takes its share at both directions.
    for (metallic, clearcoat_roughness) in [(0.0, 0.0), (0.0, 0.5), (1.0, 0.0)] {
        let coated = Physical { clearcoat: 1.0, clearcoat_roughness, specular: 0.0, metallic, ..metal(1.0) };
        let surfel = physical_surfel(&coated, false, true);
        for i in 0..500 {
            let (wo, wi) = pair(i);
            let (there, back) = (viewed_from(&surfel, wo).bsdf(wo, wi).x, viewed_from(&surfel, wi).bsdf(wi, wo).x);
            let bound = 1.0 + 1e-9 + if clearcoat_roughness > 0.0 { 0.02 } else { 0.0 };
            assert!((there / back).max(back / there) < bound, "{coated:?}: {there} {back}");
        }
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
                    albedo_of(&physical_surfel(&p, false, true), tilted(degrees), 2_000)
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
                let (rough, smooth) = (at(0.010_051), at(0.010_048));
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

/// What narrow lobes send to other microfacets, seen from straight above: an integral over the microfacets' angle alone, with nothing of the code that the table
/// is made by. Nearly all of it is sent by the few that are steep.
#[test]
fn what_narrow_lobes_miss_is_not_lost() {
    for alpha in [0.01f64, 0.02, 0.04, 0.09, 0.2, 1.0] {
        let square = alpha * alpha;
        // Equal steps of the logarithm of the tangent; beyond 45 degrees what is mirrored goes below the surface.
        let (least, n) = ((alpha * 1e-4).ln(), 1 << 16);
        let reflected: f64 = (0..n)
            .map(|i| {
                let step = -least / f64::from(n);
                let tan = (least + (f64::from(i) + 0.5) * step).exp();
                let cos2 = 1.0 / (1.0 + tan * tan);
                let density = square / (PI * (cos2 * (square - 1.0) + 1.0).powi(2));
                let tan_out = 2.0 * tan / (1.0 - tan * tan);
                let lambda = 0.5 * ((1.0 + square * tan_out * tan_out).sqrt() - 1.0);
                // D cos G2 dw, with dw = 2 pi sin dtheta and dtheta = cos^2 dtan.
                density * cos2.sqrt() / (1.0 + lambda) * 2.0 * PI * tan * cos2.sqrt() * cos2 * tan * step
            })
            .sum();
        let found = TABLE.missing(1.0, alpha);
        println!("{alpha}: {found} {}", 1.0 - reflected);
        assert!((found - (1.0 - reflected)).abs() < 3e-4, "{alpha}: {found} {}", 1.0 - reflected);
    }
    for (cosine, alpha) in [(0.6, 0.04), (0.3, 0.04), (0.8, 0.09)] {
        let (found, expected) = (TABLE.missing(cosine, alpha), albedo::missing(cosine, alpha, 1000));
        assert!((found - expected).abs() < 5e-4, "{cosine} {alpha}: {found} {expected}");
    }
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
            let wo = tilted(degrees);
            let (a, b) = (old.impulses(wo), viewed_from(&new, wo).impulses(wo));
            assert!((a.reflection - b.reflection).length() < 1e-6, "{degrees}: {a:?} {b:?}");
            assert!((a.transmission - b.transmission).length() < 1e-6, "{degrees}: {a:?} {b:?}");
            assert!(a.reflected == b.reflected && a.transmitted == b.transmitted && a.eta == b.eta);
        }
        assert!(!new.scatters());
    }
}

/// Light through a frosted pane and a rough body that absorbs is the same however it is looked for: by paths alone, by light sampling, by both, from either side of the
/// surfaces, with the luminaires in a tree, and with paths that end by the surface's albedo.
#[test]
fn light_through_rough_glass_is_found_alike() {
    let mut scene = empty(4, 4);
    scene.sensor = pinhole(Vec3::new(0.0, 0.4, 3.0), Vec3::new(0.0, 0.4, 0.0), Vec3::Y, 40.0);
    let physical = |p: Physical| Material { physical: Some(p), ..Material::default() };
    let across = |y: f32, half: f32| quad(Vec3::new(-half, y, half), Vec3::X * 2.0 * half, Vec3::Z * -2.0 * half);
    add(&mut scene, across(0.0, 2.0), matte(Vec3::splat(0.7)), Affine3A::IDENTITY);
    let frosted = Physical { roughness: 0.6, transmission: 0.8, ..Physical::default() };
    add(&mut scene, across(1.2, 1.5), Material { thin: true, ..physical(frosted) }, Affine3A::IDENTITY);
    let body = Physical {
        roughness: 0.6,
        transmission: 1.0,
        attenuation_color: Vec3::new(0.5, 0.7, 0.9),
        attenuation_distance: 0.5,
        clearcoat: 0.5,
        clearcoat_roughness: 0.5,
        ..Physical::default()
    };
    let place = Affine3A::from_translation(Vec3::new(0.3, 0.5, 0.2)) * Affine3A::from_scale(Vec3::splat(0.45));
    add(&mut scene, icosphere(1), physical(body), place);
    for x in [-0.8, 0.5] {
        add(
            &mut scene,
            quad(Vec3::new(x, 1.7, 0.25), Vec3::X * 0.5, Vec3::Z * -0.5),
            lamp(Vec3::splat(8.0)),
            Affine3A::IDENTITY,
        );
    }
    let mean = |estimator: Estimator, seed: u32| {
        let mut scene = scene.clone();
        scene.integrator = Integrator::Path(estimator);
        scene.settings.seed = seed;
        means(&scene, 2500)[0]
    };
    let base = Estimator::default();
    let expected = mean(Estimator { light_choice: LightChoice::Power, ..base }, 1);
    for (seed, estimator) in [
        Estimator { light_choice: LightChoice::Tree, ..base },
        Estimator { light_sampling: LightSampling::None, ..base },
        Estimator { light_sampling: LightSampling::Direct, light_choice: LightChoice::Tree, ..base },
        Estimator { directions: Directions::Uniform, ..base },
        Estimator { directions: Directions::Cosine, ..base },
        Estimator { extinction: Extinction::Surface, ..base },
    ]
    .into_iter()
    .enumerate()
    {
        let found = mean(estimator, 2 + seed as u32);
        println!("{found:?} for {expected:?}");
        assert!(found.error < 0.05 * found.mean, "{estimator:?}: {found:?} is not sharp enough");
        let p = same_mean(found, expected);
        assert!(p >= SIGNIFICANCE, "{estimator:?}: {found:?} instead of {expected:?}, p = {p:.1e}");
    }
}

/// Values and densities as Mitsuba 3.9.1 has them: `roughconductor` with GGX of widths 0.3 and 0.1, `roughdielectric` of width 0.2 and index 1.5, from outside
/// and from inside. Its masking and shadowing are independent, and its densities have Fresnel's share; ours, which this test divides out, are not.
#[test]
fn microfacets_are_those_of_mitsuba() {
    let direction = |theta: f64, phi: f64| {
        let (theta, phi) = (theta.to_radians(), phi.to_radians());
        DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
    };
    let close =
        |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 2e-5, "{found} instead of {expected}");
    let ggx = Ggx { x: 0.3, y: 0.1 };
    let [eta, k] = copper(0.0).conductor.expect("it is one").map(|v| v.as_dvec3());
    for (o, i, value, pdf) in [
        ([30.0, 10.0], [40.0, 170.0], DVec3::new(0.454131, 0.295836, 0.244193), 0.4845055639743805),
        ([70.0, 0.0], [60.0, 200.0], DVec3::new(0.0427378, 0.028548, 0.0244544), 0.04782027378678322),
        ([5.0, 40.0], [20.0, 100.0], DVec3::new(0.10487, 0.0683052, 0.0562306), 0.11018268764019012),
    ] {
        let (wo, wi) = (direction(o[0], o[1]), direction(i[0], i[1]));
        let facet = ggx.reflection(wo, wi);
        close(facet.pdf, pdf);
        let (a, b) = (ggx.lambda(wo), ggx.lambda(wi));
        let apart = (1.0 + a + b) / ((1.0 + a) * (1.0 + b));
        let found = facet.value * apart * wi.z * fresnel_conductor([eta, k], facet.cosine);
        (0..3).for_each(|channel| close(found[channel], value[channel]));
    }
    let ggx = Ggx { x: 0.2, y: 0.2 };
    for (o, i, value, pdf) in [
        ([30.0, 10.0], [160.0, 185.0], 17.7397, 39.967105865478516),
        ([60.0, 0.0], [140.0, 190.0], 1.92448, 4.360351085662842),
        ([30.0, 10.0], [35.0, 195.0], 0.084867, 0.08528111129999161),
        ([150.0, 10.0], [20.0, 195.0], 0.257409, 0.11455539613962173),
        ([155.0, 0.0], [50.0, 170.0], 2.1264, 0.9583023190498352),
        ([150.0, 10.0], [145.0, 190.0], 0.13757, 0.13824108242988586),
    ] {
        let (mut wo, mut wi) = (direction(o[0], o[1]), direction(i[0], i[1]));
        let mut eta = 1.5;
        if wo.z < 0.0 {
            (wo.z, wi.z, eta) = (-wo.z, -wi.z, 1.0 / eta);
        }
        if wi.z > 0.0 {
            let facet = ggx.reflection(wo, wi);
            let f = fresnel(eta, facet.cosine);
            let (a, b) = (ggx.lambda(wo), ggx.lambda(wi));
            close(f * facet.pdf, pdf);
            close(f * facet.value * wi.z * (1.0 + a + b) / ((1.0 + a) * (1.0 + b)), value);
        } else {
            let facet = ggx.refraction(wo, wi, eta);
            let through = 1.0 - fresnel(eta, facet.cosine);
            close(through * facet.pdf, pdf);
            close(through * facet.value * -wi.z / (eta * eta), value);
        }
    }
}
