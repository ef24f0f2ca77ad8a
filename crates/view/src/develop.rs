//! Developing: from a film to the 8-bit picture that a window shows.

use super::first_hit::FirstHit;
use super::shown::Shown;
use image::RgbImage;
use luminaire::film::Film;
use luminaire::picture::{Development, to_srgb8};
use luminaire_measure::heat_map::{RELATIVE_ERRORS, heat_map};

/// A film as it is shown.
#[derive(Debug, Clone)]
pub struct Developed {
    /// The picture; an error map has its scale below.
    pub image: RgbImage,
    /// Width and height of the film: the image's, without a scale.
    pub size: (u32, u32),
}

/// Develops a film; where it has no sample yet, `before` is seen. An error map is black while nothing is known.
pub fn develop(film: &Film, before: Option<&Film>, shown: Shown, how: impl Into<Development>) -> Developed {
    let bytes = match shown {
        Shown::Error => return Developed { image: error_map(film), size: (film.width, film.height) },
        Shown::Picture => to_srgb8(&linear(film, before), how),
        Shown::First(FirstHit::Albedo) => to_srgb8(&linear(film, before), 0.0),
        // As normals are mostly shown: -1 to 1 as 0 to 255.
        Shown::First(FirstHit::Normal) => {
            let byte = |v: &f32| (127.5 + 127.5 * v.clamp(-1.0, 1.0)).round() as u8;
            linear(film, before).iter().map(byte).collect()
        }
        Shown::First(FirstHit::Depth) => depth(&linear(film, before)),
    };
    let image = RgbImage::from_raw(film.width, film.height, bytes).expect("three bytes a pixel");
    Developed { image, size: (film.width, film.height) }
}

/// Mean radiance of all pixels.
fn linear(film: &Film, before: Option<&Film>) -> Vec<f32> {
    let mut linear = film.to_linear();
    let Some(before) = before else { return linear };
    for (pixel, rgb) in linear.chunks_exact_mut(3).enumerate().filter(|(pixel, _)| film.samples[*pixel] == 0) {
        let (x, y) = (pixel as u32 % film.width, pixel as u32 / film.width);
        let at = |at: u32, size: u32, coarse: u32| (u64::from(at) * u64::from(coarse) / u64::from(size)) as usize;
        let (x, y) = (at(x, film.width, before.width), at(y, film.height, before.height));
        rgb.copy_from_slice(&before.mean(y * before.width as usize + x).map(|v| v as f32));
    }
    linear
}

fn error_map(film: &Film) -> RgbImage {
    let [low, high] = RELATIVE_ERRORS;
    match film.error_map() {
        Some(errors) => heat_map(film.width, film.height, &errors.relative, low, high),
        None => RgbImage::new(film.width, film.height),
    }
}

/// Depths as greys: the nearest white, the farthest dark, nothing black.
fn depth(pixels: &[f32]) -> Vec<u8> {
    let depths = || pixels.chunks_exact(3).map(|p| (p[1] > 0.0).then_some(p[0] / p[1]));
    let nearest = depths().flatten().fold(f32::INFINITY, f32::min);
    let farthest = depths().flatten().fold(0.0, f32::max);
    let range = (farthest - nearest).max(f32::MIN_POSITIVE);
    let byte = |depth: f32| (255.0 - 223.0 * (depth - nearest) / range).round() as u8;
    depths().flat_map(|depth| [depth.map_or(0, byte); 3]).collect()
}

impl Developed {
    /// Fills `out`, rows of `size.0` pixels of four bytes, with the picture scaled to that size. An error map's scale covers the last rows, in its
    /// own size. `reversed` puts blue first.
    pub fn fill(&self, size: (u32, u32), reversed: bool, out: &mut [u8]) {
        let line = 3 * self.image.width() as usize;
        let rows: Vec<&[u8]> = self.image.as_raw().chunks_exact(line).collect();
        let (film, scale) = rows.split_at(self.size.1 as usize);
        let at = |at: u32, size: u32, of: u32| (u64::from(at) * u64::from(of) / u64::from(size)) as usize;
        let columns: Vec<usize> = (0..size.0).map(|x| 3 * at(x, size.0, self.size.0)).collect();
        for (y, out) in (0..size.1).zip(out.chunks_exact_mut(4 * size.0 as usize)) {
            let in_scale = (y as usize + scale.len()).checked_sub(size.1 as usize);
            let row = in_scale.map_or_else(|| film[at(y, size.1, self.size.1)], |row| scale[row]);
            for (x, pixel) in out.chunks_exact_mut(4).enumerate() {
                let column = if in_scale.is_some() { (3 * x).min(line - 3) } else { columns[x] };
                let [r, g, b] = [row[column], row[column + 1], row[column + 2]];
                pixel.copy_from_slice(&if reversed { [b, g, r, 255] } else { [r, g, b, 255] });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;
    use luminaire::film::{Batch, PixelSum, Tile};

    /// A film whose first `known` pixels have a sample, of these values.
    fn film(width: u32, values: &[[f64; 3]], known: u32) -> Film {
        let mut film = Film::new(width, values.len() as u32 / width).unwrap();
        for (pixel, radiance) in (0..known).zip(values) {
            let tile = Tile { x: pixel % width, y: pixel / width, width: 1, height: 1 };
            let sum = PixelSum { radiance: *radiance, ..PixelSum::default() };
            film.add(&Batch { tile, samples: 0..1, group: 1 }, &[sum]);
        }
        film
    }

    #[test]
    fn pixels_without_samples_show_what_was_before() {
        let (black, grey, white) = ([0.0; 3], [0.25; 3], [1.0; 3]);
        let fine = film(4, &[black; 8], 3);
        let coarse = film(2, &[white, grey], 2);
        let developed = develop(&fine, Some(&coarse), Shown::Picture, 2.0);
        let found: Vec<u8> = developed.image.pixels().map(|p| p.0[0]).collect();
        assert_eq!(found, [0, 0, 0, 255, 255, 255, 255, 255]);
        let darker = develop(&fine, Some(&coarse), Shown::Picture, 0.0);
        assert_eq!(darker.image.get_pixel(3, 0), &Rgb([137; 3]));
    }

    #[test]
    fn normals_and_depths_have_their_colours() {
        let normals = film(2, &[[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]], 2);
        let developed = develop(&normals, None, Shown::First(FirstHit::Normal), 5.0);
        assert_eq!(developed.image.as_raw(), &[128, 128, 255, 0, 128, 128]);
        // Half of the second pixel's samples met something; none of the third's.
        let depths = film(3, &[[2.0, 1.0, 0.0], [2.0, 0.5, 0.0], [0.0, 0.0, 0.0]], 3);
        let developed = develop(&depths, None, Shown::First(FirstHit::Depth), 0.0);
        assert_eq!(developed.image.pixels().map(|p| p.0[0]).collect::<Vec<_>>(), [255, 32, 0]);
    }

    #[test]
    fn a_window_of_another_size_is_filled() {
        let developed = develop(&film(2, &[[1.0, 0.0, 0.0], [0.0; 3]], 2), None, Shown::Picture, 0.0);
        let mut out = [7; 4 * 4 * 2];
        developed.fill((4, 2), true, &mut out);
        let row = [0, 0, 255, 255, 0, 0, 255, 255, 0, 0, 0, 255, 0, 0, 0, 255];
        assert_eq!(out[..16], row);
        assert_eq!(out[16..], row);
        // An error map's scale lies over its last rows, and a window that is smaller than the scale is filled with it.
        let mut map = film(60, &[[1.0; 3]; 60 * 50], 60 * 50);
        map.samples.iter_mut().for_each(|samples| *samples = 2);
        let developed = develop(&map, None, Shown::Error, 0.0);
        let mut out = vec![7; 4 * 60 * 50];
        developed.fill((60, 50), false, &mut out);
        assert_eq!(out[4 * 60 * 11], 24, "the background of the scale");
        let mut out = vec![7; 4 * 3 * 2];
        developed.fill((3, 2), false, &mut out);
        assert!(out.chunks(4).all(|pixel| pixel[3] == 255));
    }
}
