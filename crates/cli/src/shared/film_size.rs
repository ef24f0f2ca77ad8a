//! The size of a film after `--width` and `--height`, which each subcommand defines with its own limits.

use luminaire::scene::FilmSettings;

/// The size that options give a film, in pixels.
#[derive(Debug, Clone, Copy)]
pub struct FilmSize {
    /// Width, if it is given.
    pub width: Option<u32>,
    /// Height, if it is given.
    pub height: Option<u32>,
    /// The largest value of a side that is computed from the other one.
    pub largest: u32,
}

impl FilmSize {
    /// Changes the film's size. If one side is given, the other keeps the scene's aspect ratio; if none is, the size stays.
    pub fn apply(self, film: &mut FilmSettings) {
        let FilmSettings { width, height, .. } = *film;
        let scaled = |given: u32, this: u32, other: u32| {
            let exact = f64::from(given) * f64::from(this) / f64::from(other);
            exact.round().clamp(1.0, f64::from(self.largest)) as u32
        };
        (film.width, film.height) = match (self.width, self.height) {
            (None, None) => (width, height),
            (Some(w), None) => (w, scaled(w, height, width)),
            (None, Some(h)) => (scaled(h, width, height), h),
            (Some(w), Some(h)) => (w, h),
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use luminaire::scene::Filter;

    #[test]
    fn one_side_keeps_the_aspect_ratio() {
        let size = |width, height| {
            let mut film = FilmSettings { width: 300, height: 200, filter: Filter::Box, filter_radius: 0.5 };
            FilmSize { width, height, largest: 1000 }.apply(&mut film);
            (film.width, film.height)
        };
        assert_eq!(size(None, None), (300, 200));
        assert_eq!(size(Some(150), None), (150, 100));
        assert_eq!(size(None, Some(1)), (2, 1));
        assert_eq!(size(Some(1), None), (1, 1));
        assert_eq!(size(Some(7), Some(9)), (7, 9));
        assert_eq!(size(None, Some(900)), (1000, 900));
    }
}
