//! Maps of relative errors as pictures, with a scale to read them by.

use colorous::MAGMA;
use image::{Rgb, RgbImage};

/// Ends of the scale for the relative errors of a picture: 0.1 % and 100 %.
pub const RELATIVE_ERRORS: [f32; 2] = [0.001, 1.0];

/// Behind the scale, and beside a picture that is narrower than it.
const BACKGROUND: Rgb<u8> = Rgb([24, 24, 24]);
/// Ticks and numbers.
const INK: Rgb<u8> = Rgb([230, 230, 230]);
/// Values that are not a number: no colour of the scale.
const NOT_A_NUMBER: Rgb<u8> = Rgb([0, 255, 0]);
/// Least width at which the numbers of four powers of ten stand beside one another.
const LEAST_WIDTH: u32 = 160;
/// Width and height of a character in dots.
const GLYPH: (u32, u32) = (5, 7);

/// A picture of values that are not negative, such as relative errors: one pixel a value, rows from the top, on a logarithmic scale from `low`
/// (black) over violet and orange to `high` (white). What lies beyond takes the colours of the ends; NaN is green. Below it is the scale, its
/// powers of ten labelled in per cent.
///
/// # Panics
/// If there are not `width * height` values, or not `0 < low < high`.
pub fn heat_map(width: u32, height: u32, values: &[f32], low: f32, high: f32) -> RgbImage {
    assert!(values.len() == width as usize * height as usize && 0.0 < low && low < high);
    let dot = (width / 480).clamp(1, 4);
    let full_width = width.max(LEAST_WIDTH * dot);
    let mut map = RgbImage::from_pixel(full_width, height + 40 * dot, BACKGROUND);
    for (i, value) in (0..).zip(values) {
        map.put_pixel(i % width, i / width, colour(*value, low, high));
    }

    let (left, right) = (16 * dot, full_width - 16 * dot);
    let (top, bottom) = (height + 8 * dot, height + 20 * dot);
    let decades = (high / low).log10();
    for x in left..right {
        let value = low * 10f32.powf((x - left) as f32 / (right - left - 1) as f32 * decades);
        fill(&mut map, (x, top), (1, bottom - top), colour(value, low, high));
    }
    let mut free = 0;
    for power in (low.log10().floor() as i32)..=(high.log10().ceil() as i32) {
        for digit in 1..10u32 {
            let value = digit as f32 * 10f32.powi(power);
            // A power of ten that is an end of the scale must not be lost by rounding.
            let part = (value / low).log10() / decades;
            if !(-1e-4..=1.0001).contains(&part) {
                continue;
            }
            let x = left + (part.clamp(0.0, 1.0) * (right - left - 1) as f32).round() as u32;
            fill(&mut map, (x, bottom), (dot, if digit == 1 { 5 * dot } else { 2 * dot }), INK);
            let text = per_cent(power);
            let length = (text.len() as u32 * (GLYPH.0 + 1) - 1) * dot;
            let start = (x + dot / 2).saturating_sub(length / 2).min(full_width.saturating_sub(length));
            if digit == 1 && start >= free {
                write(&mut map, (start, bottom + 7 * dot), &text, dot);
                free = start + length + 4 * dot;
            }
        }
    }
    map
}

fn colour(value: f32, low: f32, high: f32) -> Rgb<u8> {
    if value.is_nan() {
        return NOT_A_NUMBER;
    }
    // Nothing at all is minus infinity here, and black.
    let part = (value / low).log10() / (high / low).log10();
    let colour = MAGMA.eval_continuous(f64::from(part.clamp(0.0, 1.0)));
    Rgb([colour.r, colour.g, colour.b])
}

/// `10^power` in per cent, without an exponent.
fn per_cent(power: i32) -> String {
    let decimals = (-power - 2).max(0) as usize;
    format!("{:.decimals$}%", 10f64.powi(power + 2))
}

/// Writes what [`per_cent`] makes.
fn write(map: &mut RgbImage, (mut x, y): (u32, u32), text: &str, dot: u32) {
    for character in text.chars() {
        // Rows from the top, five dots each, the highest bit at the left.
        let rows: [u8; GLYPH.1 as usize] = match character {
            '0' => [0b01110, 0b10001, 0b10001, 0b10001, 0b10001, 0b10001, 0b01110],
            '1' => [0b00100, 0b01100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110],
            '%' => [0b11001, 0b11010, 0b00010, 0b00100, 0b01000, 0b01011, 0b10011],
            _ => [0, 0, 0, 0, 0, 0b00100, 0b00100],
        };
        for (row, bits) in (0..).zip(rows) {
            for column in (0..GLYPH.0).filter(|column| bits >> (GLYPH.0 - 1 - column) & 1 == 1) {
                fill(map, (x + column * dot, y + row * dot), (dot, dot), INK);
            }
        }
        x += (GLYPH.0 + 1) * dot;
    }
}

/// Fills a rectangle, as far as it lies in the picture.
fn fill(map: &mut RgbImage, (x, y): (u32, u32), (width, height): (u32, u32), colour: Rgb<u8>) {
    for y in y..(y + height).min(map.height()) {
        for x in x..(x + width).min(map.width()) {
            map.put_pixel(x, y, colour);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_get_their_colours() {
        let map = heat_map(3, 2, &[0.0, 1e-3, 1.0, 7.0, f32::NAN, f32::INFINITY], 1e-3, 1.0);
        let (black, white) = (MAGMA.eval_continuous(0.0), MAGMA.eval_continuous(1.0));
        let expected = [black, black, white, white].map(|c| Rgb([c.r, c.g, c.b]));
        assert_eq!([(0, 0), (1, 0), (2, 0), (0, 1)].map(|(x, y)| *map.get_pixel(x, y)), expected);
        assert_eq!((*map.get_pixel(1, 1), *map.get_pixel(2, 1)), (NOT_A_NUMBER, expected[3]));
        assert_eq!(map.dimensions(), (LEAST_WIDTH, 42));
    }

    /// The colour of a value stands in the scale at the tick of that value.
    #[test]
    fn the_scale_shows_the_value() {
        for width in [160, 500, 2000] {
            let dot = (width / 480).clamp(1, 4);
            let map = heat_map(width, 1, &vec![0.01; width as usize], 1e-3, 1.0);
            let ticks: Vec<u32> =
                (0..width).filter(|x| *map.get_pixel(*x, 1 + 24 * dot) == INK).step_by(dot as usize).collect();
            assert_eq!(ticks.len(), 4, "{ticks:?}");
            let bar = map.get_pixel(ticks[1], 1 + 10 * dot).0;
            let off = bar.iter().zip(map.get_pixel(0, 0).0).map(|(a, b)| a.abs_diff(b)).max();
            assert!(off <= Some(3), "{bar:?}");
        }
    }

    #[test]
    fn numbers_are_per_cent() {
        assert_eq!([-4, -3, -2, -1, 0, 1].map(per_cent), ["0.01%", "0.1%", "1%", "10%", "100%", "1000%"]);
    }
}
