//! The files that the window writes: numbered, so that none replaces another.

use super::develop::develop;
use super::news::News;
use super::sensor_table::to_toml;
use super::shown::Shown;
use super::wanted::{Saved, Wanted};
use glam::DVec3;
use luminaire::film::Film;
use luminaire::scene::Sensor;
use luminaire::{Result, picture};
use std::path::{Path, PathBuf};

/// Writes a camera of a scene with this origin to a file whose name begins with `stem`. The news are its text, and the file's name or why it was not written.
pub fn save_camera(stem: &str, sensor: &Sensor, origin: DVec3) -> [News; 2] {
    let text = to_toml(sensor, origin);
    let path = free_name(Path::new(""), stem, "camera", "toml");
    let written = written(luminaire::files::save_text(&path, &text), &path);
    [News::Done(text), written]
}

/// Writes a picture of a film to a file whose name begins with `stem`. The news are the file's name or why it was not written.
pub fn save_picture(stem: &str, saved: Saved, film: &Film, wanted: &Wanted) -> News {
    let ending = match saved {
        Saved::Png => "png",
        Saved::Exr => "exr",
    };
    let path = free_name(Path::new(""), stem, "view", ending);
    let result = if saved == Saved::Exr || wanted.shown == Shown::Picture {
        film.save(&path, wanted.exposure)
    } else {
        picture::save_png(&path, &develop(film, None, wanted.shown, wanted.exposure).image)
    };
    written(result, &path)
}

/// The news of a file: its name, or why it was not written.
fn written(result: Result<()>, path: &Path) -> News {
    match result {
        Ok(()) => News::Done(format!("{}\n", path.display())),
        Err(error) => News::Said(format!("error: {error}")),
    }
}

/// The first of `STEM-KIND-1.ENDING`, `STEM-KIND-2.ENDING`, ... in `folder` that does not exist yet.
fn free_name(folder: &Path, stem: &str, kind: &str, ending: &str) -> PathBuf {
    let names = (1u64..).map(|number| folder.join(format!("{stem}-{kind}-{number}.{ending}")));
    // A symbolic link that leads nowhere counts as a file, too, and is not replaced.
    let mut free = names.filter(|path| path.symlink_metadata().is_err());
    free.next().expect("numbers do not end before names do")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_numbered() {
        let folder = tempfile::tempdir().unwrap();
        let name = |number| folder.path().join(format!("a-view-{number}.png"));
        for number in 1..4 {
            assert_eq!(free_name(folder.path(), "a", "view", "png"), name(number));
            std::fs::write(name(number), "").unwrap();
        }
        std::fs::remove_file(name(2)).unwrap();
        assert_eq!(free_name(folder.path(), "a", "view", "png"), name(2));
    }
}
