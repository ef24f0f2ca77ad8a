//! Brushed surfaces (microfacets of two widths): what they miss, and whether they are white in white light.

use crate::common::scenes::*;
use crate::physical::{albedo_of, turned};
use luminaire::reference::albedo::brushed_missing;
use luminaire::scene::Physical;
use luminaire::scene::brushed_table::BRUSHED;
use rayon::prelude::*;

/// The table against quadrature, at widths from 0.0025 to 1 of any ratio and in any direction; and its means against those of quadrature.
#[test]
fn what_brushed_lobes_miss_is_what_is_computed() {
    let mut cases = vec![];
    for along in [1.0, 0.93, 0.6, 0.3, 0.11, 0.02, 0.0025] {
        for ratio in [1.0, 0.93, 0.7, 0.5, 0.27, 0.08, 0.0025, 1e-4] {
            for degrees in [0.0, 17.0, 42.0, 66.0, 80.0, 87.0, 89.9] {
                cases.extend([0.0, 20.0, 55.0, 83.0, 90.0].map(|turn| ([along, along * ratio], degrees, turn)));
            }
        }
    }
    let worst = cases.par_iter().map(|(widths, degrees, turn)| {
        let w = turned(*degrees, *turn);
        let (found, expected) = (BRUSHED.missing(*widths, w), brushed_missing(*widths, w, 64));
        ((found - expected).abs(), format!("{widths:?} at {degrees}, {turn} degrees: {found} for {expected}"))
    });
    let (off, what) = worst.max_by(|a, b| a.0.total_cmp(&b.0)).expect("some");
    println!("off by at most {off:.1e}: {what}");
    assert!(off < 4.5e-3, "{what}");

    // Means by points that are even over the hemisphere in proportion to the cosine.
    for widths in [[1.0, 0.5], [0.8, 0.01], [0.4, 0.3], [0.1, 0.03f64]] {
        let n = 4096;
        let mean: f64 = (0..n)
            .into_par_iter()
            .map(|i| {
                let [u, v, _] = crate::physical::evenly(i);
                let wo = turned(u.sqrt().asin().to_degrees(), 360.0 * v);
                brushed_missing(widths, wo, 24) / f64::from(n)
            })
            .sum();
        let found = BRUSHED.missing_average(widths);
        println!("mean of {widths:?}: {found} for {mean}");
        assert!((found - mean).abs() < 1.5e-3, "{widths:?}: {found} for {mean}");
    }
    // What is narrow along y alone is seen from there as from above.
    let (aside, above) = (turned(60.0, 90.0), turned(0.0, 0.0));
    assert!((BRUSHED.missing([0.5, 1e-4], aside) - BRUSHED.missing([0.5, 1e-4], above)).abs() < 1e-3);
}

/// A white metal that is brushed is white in a white furnace, at every roughness, strength, angle and azimuth: within 0.5 %.
#[test]
fn white_brushed_metal_is_white() {
    let mut cases = vec![];
    for roughness in [0.05, 0.15, 0.3, 0.5, 0.8, 0.95] {
        for anisotropy in [0.05, 0.3, 0.6, 0.85, 1.0] {
            for degrees in [0.0, 35.0, 65.0, 85.0, 89.9] {
                cases.extend([0.0, 25.0, 60.0, 90.0].map(|turn| (roughness, anisotropy, degrees, turn)));
            }
        }
    }
    let worst = cases.par_iter().map(|(roughness, anisotropy, degrees, turn)| {
        let p = Physical { metallic: 1.0, roughness: *roughness, anisotropy: *anisotropy, ..Physical::default() };
        let albedo = albedo_of(&physical_surfel(&p, false, true), turned(*degrees, *turn), 4_000).x;
        let what = format!("roughness {roughness}, anisotropy {anisotropy}, at {degrees}, {turn} degrees: {albedo}");
        ((albedo - 1.0).abs(), what)
    });
    let (off, what) = worst.max_by(|a, b| a.0.total_cmp(&b.0)).expect("some");
    println!("white brushed metals are off by at most {off:.1e}: {what}");
    assert!(off <= 5e-3, "{what}");
}

/// The white brushed dielectrics of the following test: transmission, thin, seen from outside, and by how much they may be off.
const DIELECTRICS: [(&str, f32, bool, bool, f64, f64); 4] = [
    ("plastic", 0.0, false, true, 0.025, 0.006),
    ("sheet", 1.0, true, true, 0.025, 0.006),
    ("glass", 1.0, false, true, 0.06, 0.012),
    ("glass from inside", 1.0, false, false, 0.18, 0.03),
];

/// White brushed dielectrics are white as far as the numbers of the table lie close enough: over roughness, strength, index, angle and azimuth.
#[test]
fn white_brushed_dielectrics_are_nearly_white() {
    let mut failed = false;
    for (name, transmission, thin, front, most, most_rms) in DIELECTRICS {
        let mut cases = vec![];
        for roughness in [0.07, 0.25, 0.6] {
            for anisotropy in [0.3, 0.7, 1.0] {
                for ior in [1.2, 1.8] {
                    for degrees in [0.0, 50.0, 85.0] {
                        cases.extend([0.0, 40.0, 90.0].map(|turn| (roughness, anisotropy, ior, degrees, turn)));
                    }
                }
            }
        }
        let all: Vec<(f64, String)> = cases
            .par_iter()
            .map(|(roughness, anisotropy, ior, degrees, turn)| {
                let (roughness, anisotropy, ior) = (*roughness, *anisotropy, *ior);
                let p = Physical { roughness, anisotropy, ior, transmission, ..Physical::default() };
                let albedo = albedo_of(&physical_surfel(&p, thin, front), turned(*degrees, *turn), 1_500).x;
                let what = format!(
                    "{name}, roughness {roughness}, anisotropy {anisotropy}, index {ior}, at {degrees}, {turn} degrees: {albedo}"
                );
                (albedo - 1.0, what)
            })
            .collect();
        let rms = (all.iter().map(|(off, _)| off * off).sum::<f64>() / all.len() as f64).sqrt();
        for (off, what) in
            [all.iter().min_by(|a, b| a.0.total_cmp(&b.0)), all.iter().max_by(|a, b| a.0.total_cmp(&b.0))]
                .map(|extreme| extreme.expect("some"))
        {
            println!("{what} ({off:.1e}, mean {rms:.1e})");
            failed |= off.abs() > most || rms > most_rms;
        }
    }
    assert!(!failed);
}
