//! Words on the picture: the help, and what was just done.

use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::mono_font::iso_8859_1::FONT_9X15;
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics::text::{Baseline, Text};
use std::convert::Infallible;

/// Keys and mouse, as `luminaire view --help` and the window tell them.
pub const HELP: &str = "\
left drag          orbit around the target
middle drag        pan (also Shift + left drag)
right drag         look around
wheel              dolly
W A S D, Q E       fly; down, up; Shift: five times as fast
R or Home          back to the scene's camera
F                  frame the scene

1 2                the picture, its estimated error
3 4 5              albedo, normals, depth of the first surface
+ -                exposure, a third of a stop
B                  next backend
N                  next estimator
Space              pause

P                  save what is shown as PNG
O                  save the film as EXR
C                  write the camera as a scene file's [sensor]

H or ?             this help
Esc                quit";

/// Character width and height of the font, and the space around the text, in dots.
const CHARACTER: (i32, i32) = (9, 16);
const MARGIN: i32 = 8;

/// A picture of four bytes a pixel, to be written on in dots of `dot` by `dot` pixels.
pub struct Canvas<'a> {
    /// Rows from the top.
    pub bytes: &'a mut [u8],
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Pixels of a dot, across.
    pub dot: u32,
}

impl Canvas<'_> {
    /// Writes the help in the middle.
    pub fn help(&mut self) {
        let (columns, rows) = extent(HELP);
        let (width, height) = (self.size.0 / self.dot, self.size.1 / self.dot);
        let centred = |size: u32, text: i32| ((size as i32 - text) / 2).max(0);
        self.write(HELP, centred(width, columns), centred(height, rows));
    }

    /// Writes a line below.
    pub fn line(&mut self, text: &str) {
        let height = (self.size.1 / self.dot) as i32;
        self.write(text, 0, height - extent(text).1);
    }

    /// Darkens a box and writes into it; `x` and `y` are its corner in dots.
    fn write(&mut self, text: &str, x: i32, y: i32) {
        let (width, height) = extent(text);
        for row in y..y + height {
            for column in x..x + width {
                self.dot(column, row, |byte| byte / 5);
            }
        }
        let style = MonoTextStyle::new(&FONT_9X15, Rgb888::WHITE);
        for (row, line) in (0..).zip(text.lines()) {
            let corner = Point::new(x + MARGIN, y + MARGIN + row * CHARACTER.1);
            let Ok(_) = Text::with_baseline(line, corner, style, Baseline::Top).draw(self);
        }
    }

    /// Changes the colour of a dot, as far as it lies in the picture.
    fn dot(&mut self, x: i32, y: i32, change: impl Fn(u8) -> u8) {
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { return };
        let range = |at: u32, size: u32| at.saturating_mul(self.dot).min(size)..(at + 1).saturating_mul(self.dot).min(size);
        for row in range(y, self.size.1) {
            for column in range(x, self.size.0) {
                let at = 4 * (row as usize * self.size.0 as usize + column as usize);
                self.bytes[at..at + 3].iter_mut().for_each(|byte| *byte = change(*byte));
            }
        }
    }
}

/// Width and height of a box around a text, in dots.
fn extent(text: &str) -> (i32, i32) {
    let columns = text.lines().map(|line| line.chars().count()).max().unwrap_or(0) as i32;
    (columns * CHARACTER.0 + 2 * MARGIN, text.lines().count() as i32 * CHARACTER.1 + 2 * MARGIN)
}

impl OriginDimensions for Canvas<'_> {
    fn size(&self) -> Size {
        Size::new(self.size.0 / self.dot, self.size.1 / self.dot)
    }
}

impl DrawTarget for Canvas<'_> {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(point, _) in pixels {
            // The only colour is white.
            self.dot(point.x, point.y, |_| 255);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_help_is_written_and_cut_off_at_the_edges() {
        for (width, height, dot) in [(600, 400, 1), (1200, 800, 2), (40, 30, 1), (1, 1, 3)] {
            let mut bytes = vec![100; 4 * width as usize * height as usize];
            let mut canvas = Canvas { bytes: &mut bytes, size: (width, height), dot };
            canvas.help();
            canvas.line("saved");
            let share = |value| bytes.iter().filter(|b| **b == value).count() as f64 / bytes.len() as f64;
            if width >= 600 {
                assert!(share(255) > 0.02 && share(20) > 0.3 && share(100) > 0.25, "{} {} {}", share(255), share(20), share(100));
            }
            assert!(bytes.chunks(4).all(|pixel| pixel[3] == 100), "alpha stays");
        }
    }

    #[test]
    fn the_help_fits_a_window_of_ordinary_size() {
        assert!(extent(HELP).0 <= 600 && extent(HELP).1 <= 480, "{:?}", extent(HELP));
    }
}
