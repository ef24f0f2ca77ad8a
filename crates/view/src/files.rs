//! The files that the window writes: numbered, so that none replaces another.

use super::develop::develop;
use super::news::News;
use super::sensor_table::to_toml;
use super::shown::Shown;
use super::wanted::{Saved, Wanted};
use glam::DVec3;
use luminaire::files::{save_numbered, save_text};
use luminaire::film::Film;
use luminaire::picture::Development;
use luminaire::scene::Sensor;
use luminaire::{Result, picture};
use std::path::{Path, PathBuf};

/// Writes a camera of a scene with this origin, and how its pictures are shown, to a file whose name begins with `stem`. The news are its text, and the file's name or why it was not written.
pub fn save_camera(stem: &str, sensor: &Sensor, origin: DVec3, how: Development) -> [News; 2] {
    let text = to_toml(sensor, origin, how);
    let saved = save_numbered(names(Path::new(""), stem, "camera", "toml"), |path| save_text(path, &text));
    [News::Done(text), written(saved)]
}

/// Writes a picture of a film to a file whose name begins with `stem`. The news are the file's name or why it was not written.
pub fn save_picture(stem: &str, saved: Saved, film: &Film, wanted: &Wanted) -> News {
    let ending = match saved {
        Saved::Png => "png",
        Saved::Exr => "exr",
    };
    written(save_numbered(names(Path::new(""), stem, "view", ending), |path| {
        if saved == Saved::Exr || wanted.shown == Shown::Picture {
            film.save(path, wanted.development)
        } else {
            picture::save_png(path, &develop(film, None, wanted.shown, wanted.development).image)
        }
    }))
}

/// The news of a file: its name, or why it was not written.
fn written(saved: Result<PathBuf>) -> News {
    match saved {
        Ok(path) => News::Done(format!("{}\n", path.display())),
        Err(error) => News::Said(format!("error: {error}")),
    }
}

/// `STEM-KIND-1.ENDING`, `STEM-KIND-2.ENDING`, ... in `folder`.
fn names(folder: &Path, stem: &str, kind: &str, ending: &str) -> impl Fn(u64) -> PathBuf {
    move |number| folder.join(format!("{stem}-{kind}-{number}.{ending}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_numbered() {
        let folder = tempfile::tempdir().unwrap();
        let name = |number| folder.path().join(format!("a-view-{number}.png"));
        let save = || {
            save_numbered(names(folder.path(), "a", "view", "png"), |path| {
                picture::save_linear(path, 1, 1, &[0.0; 3], 0.0)
            })
        };
        for number in 1..4 {
            assert_eq!(save().unwrap(), name(number));
        }
        std::fs::remove_file(name(2)).unwrap();
        assert_eq!(save().unwrap(), name(2));
    }
}
