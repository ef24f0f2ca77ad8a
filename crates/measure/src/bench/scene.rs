//! A scene of the benchmark.

use luminaire::Result;
use luminaire::scene::{self, Scene};
use std::path::{Path, PathBuf};

/// A scene under its name.
#[derive(Debug, Clone)]
pub struct BenchScene {
    /// The file's name without its ending; unlike those of the others.
    pub name: String,
    /// The file.
    pub path: PathBuf,
    /// The scene, its film in the size of the benchmark.
    pub scene: Scene,
}

impl BenchScene {
    /// Loads scenes, their films resized to `size`: a width alone keeps the aspect ratio.
    ///
    /// # Errors
    /// If one cannot be loaded.
    pub fn load(paths: &[PathBuf], size: (u32, Option<u32>)) -> Result<Vec<BenchScene>> {
        let mut scenes: Vec<BenchScene> = Vec::new();
        for path in paths {
            let mut scene = scene::load(path)?;
            let (width, height) = (f64::from(scene.film.width), f64::from(scene.film.height));
            scene.film.width = size.0;
            scene.film.height =
                size.1.unwrap_or((f64::from(size.0) * height / width).round().clamp(1.0, 65536.0) as u32);
            let name = name(path, |name| scenes.iter().any(|other| other.name == name));
            scenes.push(BenchScene { name, path: path.clone(), scene });
        }
        Ok(scenes)
    }
}

/// The stem of a file as a part of names, numbered where it is taken.
fn name(path: &Path, taken: impl Fn(&str) -> bool) -> String {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let stem: String = stem.chars().map(|c| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '-' }).collect();
    let numbered = (2u32..).map(|n| format!("{stem}-{n}"));
    std::iter::once(stem.clone()).chain(numbered).find(|name| !taken(name)).unwrap_or(stem.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_different_and_have_no_slash() {
        assert_eq!(name(Path::new("a/b c.toml"), |_| false), "b-c");
        assert_eq!(name(Path::new("x/box.obj"), |name| ["box", "box-2"].contains(&name)), "box-3");
    }
}
