//! FLIP: how different two pictures look when they are shown in turn, from 0 (the same) to 1.
//!
//! After Andersson et al., "FLIP: A Difference Evaluator for Alternating Images" (2020), and for radiance Andersson et al., "Visualizing
//! Errors in Rendered High Dynamic Range Images" (2021). Both pictures are filtered as the eye filters them at [`PIXELS_PER_DEGREE`]; how
//! far their colours are apart, and how far their edges and points, make one number a pixel. The authors' own tool gives the same to 1e-4
//! (see the tests).

use glam::{Mat3, Vec3};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Pixels in one degree of sight: a display 3840 pixels and 0.7 m wide, seen from 0.7 m, as the authors have it.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// Contrast sensitivity: weights `a` and widths `b` (in square degrees) of Gaussians `a sqrt(pi / b) exp(-pi^2 x^2 / b)`; one for what
/// is achromatic, one for red-green, and the sum of two for blue-yellow.
const SENSITIVITY: [(f64, f64); 4] = [(1.0, 0.0047), (1.0, 0.0053), (34.1, 0.04), (13.5, 0.025)];
/// Width of an edge or a point in degrees.
const FEATURE_WIDTH: f64 = 0.082;
/// Exponent of the colours' difference.
const COLOUR_EXPONENT: f32 = 0.7;
/// Exponent of the features' difference.
const FEATURE_EXPONENT: f32 = 0.5;
/// Colour differences up to this part of the largest one are stretched ...
const KNEE: f32 = 0.4;
/// ... to this value, and those above it compressed.
const KNEE_VALUE: f32 = 0.95;

/// Linear sRGB to CIE XYZ, by columns.
const TO_XYZ: Mat3 = Mat3::from_cols_array(&[
    0.412_386_56,
    0.212_636_82,
    0.019_330_62, //
    0.357_591_5,
    0.715_183,
    0.119_197_16, //
    0.180_450_49,
    0.072_180_2,
    0.950_372_6,
]);
/// XYZ of white (D65).
const WHITE: Vec3 = Vec3::new(0.950_428_55, 1.0, 1.088_900_4);

/// FLIP of two pictures of high dynamic range.
#[derive(Debug, Clone, PartialEq)]
pub struct HighDynamicRange {
    /// The largest FLIP of each pixel over all exposures.
    pub map: Vec<f32>,
    /// First and last exposure in stops.
    pub exposures: (f32, f32),
    /// How many exposures there were, evenly between these.
    pub count: u32,
}

/// FLIP of each pixel of two pictures as a display shows them: linear RGB, clamped to [0, 1], rows from the top.
///
/// # Panics
/// If a picture does not have `width * height` pixels.
pub fn low_dynamic_range(width: usize, height: usize, image: &[[f32; 3]], reference: &[[f32; 3]]) -> Vec<f32> {
    assert!(image.len() == width * height && reference.len() == width * height);
    if image.is_empty() {
        return Vec::new();
    }
    let (image, reference) = (Seen::new(width, image), Seen::new(width, reference));
    let largest = distance(opponent(Vec3::Y), opponent(Vec3::Z)).powf(COLOUR_EXPONENT);
    let pixel = |i: usize| {
        let off = distance(image.colours[i], reference.colours[i]).powf(COLOUR_EXPONENT);
        let knee = KNEE * largest;
        let colour = if off < knee {
            off * KNEE_VALUE / knee
        } else {
            KNEE_VALUE + (off - knee) / (largest - knee) * (1.0 - KNEE_VALUE)
        };
        let [[edge, point], [reference_edge, reference_point]] = [image.features[i], reference.features[i]];
        let feature = (edge - reference_edge).abs().max((point - reference_point).abs()) / std::f32::consts::SQRT_2;
        colour.powf(1.0 - feature.powf(FEATURE_EXPONENT))
    };
    (0..width * height).into_par_iter().map(pixel).collect()
}

/// FLIP of two pictures of linear, not negative radiance, over the exposures at which the reference shows something: from its brightest pixel just
/// not burnt out to its median there, by the ACES tone mapping.
///
/// # Panics
/// If a picture does not have `width * height` pixels.
pub fn high_dynamic_range(width: usize, height: usize, image: &[[f32; 3]], reference: &[[f32; 3]]) -> HighDynamicRange {
    let (start, stop) = exposures(reference);
    let count = ((stop - start).ceil() as u32).max(2);
    let mut map = vec![0.0f32; width * height];
    for i in 0..count {
        let scale = (start + (stop - start) * i as f32 / (count - 1) as f32).exp2();
        let shown = |picture: &[[f32; 3]]| -> Vec<[f32; 3]> {
            picture.par_iter().map(|p| p.map(|v| aces(v * scale))).collect()
        };
        let here = low_dynamic_range(width, height, &shown(image), &shown(reference));
        map.par_iter_mut().zip(here).for_each(|(most, here)| *most = most.max(here));
    }
    HighDynamicRange { map, exposures: (start, stop), count }
}

/// The mean of a map of FLIP; 0 of an empty one.
pub fn mean(map: &[f32]) -> f64 {
    map.iter().map(|v| f64::from(*v)).sum::<f64>() / map.len().max(1) as f64
}

/// Numerator and denominator of the tone mapping, by descending power (K. Narkowicz's fit of ACES, after an exposure of 0.6).
const ACES: [[f32; 3]; 2] = [[0.36 * 2.51, 0.6 * 0.03, 0.0], [0.36 * 2.43, 0.6 * 0.59, 0.14]];

fn aces(v: f32) -> f32 {
    let [above, below] = ACES.map(|[a, b, c]| (a * v + b) * v + c);
    // Infinity over infinity is white.
    if v.is_finite() && below.is_finite() { (above / below).clamp(0.0, 1.0) } else { 1.0 }
}

/// First and last exposure in stops: the brightest and the median luminance of the reference come to 85 % of white.
fn exposures(reference: &[[f32; 3]]) -> (f32, f32) {
    const SHOWN: f32 = 0.85;
    let [[a, b, c], [d, e, f]] = ACES;
    let (a, b, c) = (a - SHOWN * d, b - SHOWN * e, c - SHOWN * f);
    let bright = ((b * b - 4.0 * a * c).sqrt() - b) / (2.0 * a);
    let weights = Vec3::new(0.2126, 0.7152, 0.0722);
    let mut luminance: Vec<f32> = reference.iter().map(|p| weights.dot(Vec3::from(*p)).max(0.0)).collect();
    luminance.sort_by(f32::total_cmp);
    let stops = |luminance: Option<&f32>| (bright / luminance.map_or(0.0, |l| *l).max(f32::EPSILON)).log2();
    (stops(luminance.last()), stops(luminance.get(luminance.len() / 2)))
}

/// A picture as the eye has it.
struct Seen {
    /// CIELAB with Hunt's adjustment, after the filter of contrast sensitivity.
    colours: Vec<Vec3>,
    /// Strength of edges and of points.
    features: Vec<[f32; 2]>,
}

impl Seen {
    fn new(width: usize, linear: &[[f32; 3]]) -> Self {
        // Y Cx Cz: CIELAB without its cube roots, so that a mean of colours is the colour of a mean of light.
        let flat: Vec<Vec3> = linear
            .par_iter()
            .map(|p| {
                let n = TO_XYZ * Vec3::from(*p).clamp(Vec3::ZERO, Vec3::ONE) / WHITE;
                Vec3::new(116.0 * n.y - 16.0, 500.0 * (n.x - n.y), 200.0 * (n.y - n.z))
            })
            .collect();

        let (taps, share) = sensitivity();
        let lanes: Vec<[f32; 4]> = flat.par_iter().map(|p| [p.x, p.y, p.z, p.z]).collect();
        // What is not needed any more is given up at once: at sixteen bytes a pixel each, these are most of what FLIP takes.
        let blurred = rows(width, &lanes, &taps);
        drop(lanes);
        let blurred = columns(width, &blurred, &taps);
        let to_rgb = TO_XYZ.inverse();
        let colours = blurred
            .par_iter()
            .map(|&[y, cx, first, second]| {
                let cz = first * share + second * (1.0 - share);
                let ny = (y + 16.0) / 116.0;
                let n = Vec3::new(ny + cx / 500.0, ny, ny - cz / 200.0);
                opponent((to_rgb * (n * WHITE)).clamp(Vec3::ZERO, Vec3::ONE))
            })
            .collect();
        drop(blurred);

        let taps = detectors();
        // Along the rows: Gaussian, its first and its second derivative; across them the other way round.
        let along: Vec<[f32; 4]> = taps.iter().map(|&[g, first, second]| [g, first, second, 0.0]).collect();
        let across: Vec<[f32; 4]> = taps.iter().map(|&[g, first, second]| [first, g, g, second]).collect();
        let grey: Vec<[f32; 4]> = flat.par_iter().map(|p| [(p.x + 16.0) / 116.0; 4]).collect();
        drop(flat);
        let mut filtered = rows(width, &grey, &along);
        drop(grey);
        filtered.par_iter_mut().for_each(|[g, _, _, last]| *last = *g);
        let features = columns(width, &filtered, &across)
            .par_iter()
            .map(|&[edge_y, edge_x, point_x, point_y]| [edge_x.hypot(edge_y), point_x.hypot(point_y)])
            .collect();
        Seen { colours, features }
    }
}

/// CIELAB of linear RGB, its colour scaled with its lightness (Hunt).
fn opponent(rgb: Vec3) -> Vec3 {
    const D: f32 = 6.0 / 29.0;
    let n = (TO_XYZ * rgb / WHITE).map(|t| if t > D * D * D { t.cbrt() } else { t / (3.0 * D * D) + 4.0 / 29.0 });
    let lightness = 116.0 * n.y - 16.0;
    Vec3::new(lightness, 5.0 * lightness * (n.x - n.y), 2.0 * lightness * (n.y - n.z))
}

/// HyAB: lightness and colour apart, which suits large differences.
fn distance(a: Vec3, b: Vec3) -> f32 {
    let d = a - b;
    d.x.abs() + d.y.hypot(d.z)
}

/// The four Gaussians of [`SENSITIVITY`] along one axis, each of sum 1, and the part of the first one in blue-yellow.
fn sensitivity() -> (Vec<[f32; 4]>, f32) {
    let widest = SENSITIVITY.iter().fold(0.0f64, |most, (_, b)| most.max(*b));
    let radius = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil() as i32;
    let taps: Vec<[f64; 4]> = (-radius..=radius)
        .map(|x| SENSITIVITY.map(|(_, b)| (-(PI * f64::from(x) / PIXELS_PER_DEGREE).powi(2) / b).exp()))
        .collect();
    let sums = [0, 1, 2, 3].map(|lane| taps.iter().map(|tap| tap[lane]).sum::<f64>());
    // In two dimensions the Gaussians multiply, their weights do not.
    let mass = |lane: usize| SENSITIVITY[lane].0 * (PI / SENSITIVITY[lane].1).sqrt() * sums[lane] * sums[lane];
    let share = mass(2) / (mass(2) + mass(3));
    (taps.iter().map(|tap| [0, 1, 2, 3].map(|lane| (tap[lane] / sums[lane]) as f32)).collect(), share as f32)
}

/// A Gaussian of sum 1 and its derivatives, whose positive values add up to 1 and the negative ones to -1.
fn detectors() -> Vec<[f32; 3]> {
    let deviation = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE;
    let radius = (3.0 * deviation).ceil() as i32;
    let mut taps: Vec<[f64; 3]> = (-radius..=radius)
        .map(|x| {
            let x = f64::from(x) / deviation;
            let g = (-0.5 * x * x).exp();
            [g, -x * g, (x * x - 1.0) * g]
        })
        .collect();
    for lane in 0..3 {
        let sum = |sign: f64| taps.iter().map(|tap| (sign * tap[lane]).max(0.0)).sum::<f64>();
        let (positive, negative) = (sum(1.0), sum(-1.0));
        taps.iter_mut().for_each(|tap| tap[lane] /= if tap[lane] >= 0.0 { positive } else { negative });
    }
    taps.iter().map(|tap| tap.map(|v| v as f32)).collect()
}

/// Filters every row; each of the four numbers has its own filter. The pixels at the border go on beyond it.
fn rows(width: usize, pixels: &[[f32; 4]], taps: &[[f32; 4]]) -> Vec<[f32; 4]> {
    let radius = taps.len() / 2;
    let mut out = vec![[0.0; 4]; pixels.len()];
    out.par_chunks_exact_mut(width).zip(pixels.par_chunks_exact(width)).for_each(|(out, row)| {
        let padded: Vec<_> = (0..width + 2 * radius).map(|x| row[x.saturating_sub(radius).min(width - 1)]).collect();
        for (i, tap) in taps.iter().enumerate() {
            out.iter_mut().zip(&padded[i..]).for_each(|(out, pixel)| add(out, pixel, tap));
        }
    });
    out
}

/// Filters every column, as [`rows`] does.
fn columns(width: usize, pixels: &[[f32; 4]], taps: &[[f32; 4]]) -> Vec<[f32; 4]> {
    let (radius, height) = (taps.len() / 2, pixels.len() / width);
    let mut out = vec![[0.0; 4]; pixels.len()];
    out.par_chunks_exact_mut(width).enumerate().for_each(|(y, out)| {
        for (i, tap) in taps.iter().enumerate() {
            let from = (y + i).saturating_sub(radius).min(height - 1) * width;
            out.iter_mut().zip(&pixels[from..from + width]).for_each(|(out, pixel)| add(out, pixel, tap));
        }
    });
    out
}

fn add(sum: &mut [f32; 4], pixel: &[f32; 4], tap: &[f32; 4]) {
    for lane in 0..4 {
        sum[lane] += pixel[lane] * tap[lane];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (usize, usize) = (40, 24);

    fn picture(pixel: impl Fn(usize, usize, usize) -> f64) -> Vec<[f32; 3]> {
        let (width, height) = SIZE;
        (0..width * height).map(|i| [0, 1, 2].map(|c| pixel(i % width, i / width, c) as f32)).collect()
    }

    /// Gradients with a chequered blue.
    fn smooth(k: f64) -> Vec<[f32; 3]> {
        picture(|x, y, c| match c {
            0 => (x as f64 + 0.5) / 40.0 * (1.0 - 0.1 * k),
            1 => (y as f64 + 0.5) / 24.0,
            _ => ((x / 4 + y / 4 + k as usize) % 2) as f64 * 0.5 + 0.25,
        })
    }

    /// Something like noise.
    fn noise(k: usize) -> Vec<[f32; 3]> {
        picture(|x, y, c| {
            let n = x * x * (3 + c) + y * (7 * k + 5) + x * y * (c + 2) + 11 * k * c;
            (n % (61 + 2 * k)) as f64 / (60 + 2 * k) as f64
        })
    }

    fn agrees(map: &[f32], expected_mean: f64, expected_largest: f32, pixels: [(usize, usize, f32); 2]) {
        let largest = map.iter().copied().fold(0.0, f32::max);
        assert!((mean(map) - expected_mean).abs() < 2e-5, "mean {} for {expected_mean}", mean(map));
        assert!((largest - expected_largest).abs() < 1e-4, "largest {largest} for {expected_largest}");
        for (x, y, expected) in pixels {
            let found = map[y * SIZE.0 + x];
            assert!((found - expected).abs() < 1e-4, "pixel {x} {y}: {found} for {expected}");
        }
    }

    /// Against the authors' tool (`flip-evaluator` 1.7), of which these are the numbers for the same pictures.
    #[test]
    fn agrees_with_the_authors_tool() {
        let (width, height) = SIZE;
        let ldr = |image: &[[f32; 3]], reference: &[[f32; 3]]| low_dynamic_range(width, height, image, reference);
        let map = ldr(&smooth(1.0), &smooth(0.0));
        agrees(&map, 0.232_154_40, 0.633_613, [(5, 3, 0.227_326_9), (30, 20, 0.123_369_1)]);
        let map = ldr(&noise(1), &noise(0));
        agrees(&map, 0.389_279_27, 0.960_482_8, [(5, 3, 0.292_325_6), (30, 20, 0.253_814_3)]);
        let mix: Vec<_> =
            smooth(0.0).iter().zip(noise(1)).map(|(a, b)| [0, 1, 2].map(|c| 0.7 * a[c] + 0.3 * b[c])).collect();
        let map = ldr(&mix, &smooth(0.0));
        agrees(&map, 0.379_784_98, 0.684_559_4, [(5, 3, 0.478_833_9), (30, 20, 0.431_559_8)]);
        assert!(ldr(&mix, &mix).iter().all(|v| *v == 0.0));
    }

    #[test]
    fn agrees_with_the_authors_tool_over_exposures() {
        let (width, height) = SIZE;
        let reference: Vec<_> = smooth(0.0).iter().map(|p| p.map(|v| 20.0 * v.powi(3) + 0.01)).collect();
        let image: Vec<_> = smooth(0.0)
            .iter()
            .zip(noise(1))
            .map(|(a, b)| [0, 1, 2].map(|c| 20.0 * a[c].powi(3) * (0.8 + 0.4 * b[c]) + 0.01))
            .collect();
        let hdr = high_dynamic_range(width, height, &image, &reference);
        agrees(&hdr.map, 0.057_755_69, 0.180_792, [(5, 3, 0.049_203_3), (30, 20, 0.045_657_3)]);
        assert_eq!(hdr.count, 3);
        let (start, stop) = hdr.exposures;
        assert!((start + 3.050_561).abs() < 1e-4 && (stop + 0.816_204).abs() < 1e-4, "{start} {stop}");

        let bright = |k| -> Vec<_> { noise(k).iter().map(|p| p.map(|v| 200.0 * v.powi(6))).collect() };
        let hdr = high_dynamic_range(width, height, &bright(1), &bright(0));
        agrees(&hdr.map, 0.547_975_60, 0.975_901_5, [(5, 3, 0.391_817), (30, 20, 0.376_569_3)]);
        assert_eq!(hdr.count, 4);
    }

    /// Where the tool gives up: nothing to expose for.
    #[test]
    fn a_black_reference() {
        let black = vec![[0.0; 3]; 16];
        assert_eq!(mean(&high_dynamic_range(4, 4, &black, &black).map), 0.0);
        let mut lit = black.clone();
        lit[5] = [0.1, f32::MAX, 1e30];
        let map = high_dynamic_range(4, 4, &lit, &black).map;
        assert!(map.iter().all(|v| (0.0..=1.0).contains(v)) && map[5] > 0.5, "{map:?}");
    }
}
