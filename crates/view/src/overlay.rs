//! Text over the picture: the help ([`HELP`]), and a line at the upper edge.

use embedded_graphics::mono_font::iso_8859_1::{FONT_5X8, FONT_6X10, FONT_9X15};
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics::text::{Baseline, Text};
use std::convert::Infallible;

/// Keys and mouse, for `luminaire view --help` and the window.
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
X                  exposure by what is seen
T                  next tone curve
B                  next backend
N                  next estimator
Space              pause

P                  save what is shown as PNG
O                  save the film as EXR
C                  write the camera (--camera FILE)

H or ?             this help
Esc                quit";

/// From large to small: the first in which a text fits is taken, or else the last.
const FONTS: [&MonoFont; 3] = [&FONT_9X15, &FONT_6X10, &FONT_5X8];
/// The space around a text, in dots.
const MARGIN: i32 = 8;
/// The space between two lines, in dots.
const LEADING: i32 = 1;

/// A picture of four bytes a pixel to write on. What is written has dots of `dot` by `dot` pixels, so that it can be read on a dense screen.
pub struct Canvas<'a> {
    /// Rows from the top.
    pub bytes: &'a mut [u8],
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// The side of a dot in pixels.
    pub dot: u32,
}

impl Canvas<'_> {
    /// Writes the help in the middle.
    pub fn help(&mut self) {
        let (font, text) = self.fitting(HELP);
        let centred = |size: u32, text: i32| ((size as i32 - text) / 2).max(0);
        self.write(HELP, font, centred(self.size.0 / self.dot, text.0), centred(self.size.1 / self.dot, text.1));
    }

    /// Writes a line at the upper edge.
    pub fn line(&mut self, text: &str) {
        let (font, _) = self.fitting(text);
        self.write(text, font, 0, 0);
    }

    /// The font for a text, and the size of the box around it in dots.
    fn fitting(&self, text: &str) -> (&'static MonoFont<'static>, (i32, i32)) {
        let sizes = FONTS.map(|font| (font, extent(text, font)));
        let fits = |(width, height): (i32, i32)| {
            width <= (self.size.0 / self.dot) as i32 && height <= (self.size.1 / self.dot) as i32
        };
        sizes.into_iter().find(|(_, size)| fits(*size)).unwrap_or(sizes[FONTS.len() - 1])
    }

    /// Darkens a box and writes into it; `x` and `y` are its corner in dots.
    fn write(&mut self, text: &str, font: &MonoFont, x: i32, y: i32) {
        let (width, height) = extent(text, font);
        for row in y..y + height {
            for column in x..x + width {
                self.dot(column, row, |byte| byte / 5);
            }
        }
        let style = MonoTextStyle::new(font, Rgb888::WHITE);
        for (row, line) in (0..).zip(text.lines()) {
            let corner = Point::new(x + MARGIN, y + MARGIN + row * (font.character_size.height as i32 + LEADING));
            let Ok(_) = Text::with_baseline(line, corner, style, Baseline::Top).draw(self);
        }
    }

    /// Changes the colour of a dot, as far as it lies in the picture.
    fn dot(&mut self, x: i32, y: i32, change: impl Fn(u8) -> u8) {
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { return };
        let range =
            |at: u32, size: u32| at.saturating_mul(self.dot).min(size)..(at + 1).saturating_mul(self.dot).min(size);
        for row in range(y, self.size.1) {
            for column in range(x, self.size.0) {
                let at = 4 * (row as usize * self.size.0 as usize + column as usize);
                self.bytes[at..at + 3].iter_mut().for_each(|byte| *byte = change(*byte));
            }
        }
    }
}

/// Width and height of a box around a text, in dots.
fn extent(text: &str, font: &MonoFont) -> (i32, i32) {
    let columns = text.lines().map(|line| line.chars().count()).max().unwrap_or(0) as i32;
    let (width, height) = (font.character_size.width as i32, font.character_size.height as i32 + LEADING);
    (columns * width + 2 * MARGIN, text.lines().count() as i32 * height + 2 * MARGIN)
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
            canvas.line("a line that is longer than the narrow window");
            let share = |value: u8| bytes.iter().filter(|b| **b == value).count() as f64 / bytes.len() as f64;
            if width >= 600 {
                assert!(
                    share(255) > 0.02 && share(20) > 0.3 && share(100) > 0.25,
                    "{} {} {}",
                    share(255),
                    share(20),
                    share(100)
                );
            }
            assert!(bytes.chunks(4).all(|pixel| pixel[3] == 100), "alpha stays");
        }
    }

    #[test]
    fn the_help_fits_small_windows() {
        let (large, small) = (extent(HELP, &FONT_9X15), extent(HELP, &FONT_5X8));
        assert!(large.0 <= 600 && large.1 <= 440 && small.0 <= 330 && small.1 <= 240, "{large:?} {small:?}");
    }
}
