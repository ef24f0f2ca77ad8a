//! The options that say what a scene gets in place of what its file says, or does not say.

use luminaire::glam::Vec3;
use luminaire::scene::{self, Choices, Scene, Side, Sky, Up};
use std::path::{Path, PathBuf};

/// What a scene gets in place of what its file says.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct SceneOptions {
    /// Light from all around: a latitude-longitude image (.hdr, .exr, ...), the same radiance from everywhere, the built-in grey sky with a soft
    /// key light, or none [default: the scene file's; of an OBJ in which less than 0.1 % of the area emits: studio, and of one that its lamps light
    /// a faint grey around it].
    #[arg(long, value_name = "FILE|R,G,B|studio|none", value_parser = sky, help_heading = "Scene")]
    sky: Option<Sky>,
    /// A grey ground under the model [default: the scene file's; of an OBJ under a sky: on, unless it brings its own].
    #[arg(long, value_name = "on|off", value_parser = on_or_off, help_heading = "Scene")]
    ground: Option<bool>,
    /// For an OBJ without vertex normals: faces that meet at less than so many degrees share them; 0 is flat [default: by the file's smoothing
    /// groups (`s`), and 40 where it has none].
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = degrees, help_heading = "Scene")]
    smooth: Option<f32>,
    /// The axis of an OBJ that points up. Programs for buildings, maps and 3D printers mostly write z [default: y].
    #[arg(long, value_name = "y|z", value_parser = up, help_heading = "Scene")]
    up: Option<Up>,
    /// A lamp at the camera of an OBJ [default: on where the camera stands in a room of which lamps light less than half, or little].
    #[arg(long, value_name = "on|off", value_parser = on_or_off, help_heading = "Scene")]
    fill: Option<bool>,
    /// The side of an OBJ that the camera looks at, from outside; its front is +z [default: where it shows best, in a room from inside].
    #[arg(long, value_name = "front|back|left|right|top", value_parser = side, help_heading = "Scene")]
    view: Option<Side>,
}

impl SceneOptions {
    /// As the library wants them.
    pub fn choices(&self) -> Choices {
        Choices {
            sky: self.sky.clone(),
            ground: self.ground,
            smooth: self.smooth,
            up: self.up,
            fill: self.fill,
            view: self.view,
        }
    }

    /// Loads a scene with them.
    ///
    /// # Errors
    /// As for [`scene::load_with`].
    pub fn load(&self, path: &Path) -> luminaire::Result<Scene> {
        scene::load_with(path, &self.choices())
    }

    /// Loads a scene of which a cut-out is wanted: a bare model stands on nothing then, unless it was asked for.
    ///
    /// # Errors
    /// As for [`scene::load_with`].
    pub fn load_cut_out(&self, path: &Path) -> luminaire::Result<Scene> {
        let mut choices = self.choices();
        if scene::is_bare(path) {
            choices.ground.get_or_insert(false);
        }
        scene::load_with(path, &choices)
    }
}

/// A sky: `studio`, `none`, three numbers, or a file.
fn sky(text: &str) -> Result<Sky, String> {
    match text.to_ascii_lowercase().as_str() {
        "studio" => return Ok(Sky::Studio),
        "none" | "off" => return Ok(Sky::None),
        "" => return Err("expected an image, three numbers R,G,B, studio or none".into()),
        _ => {}
    }
    if Path::new(text).exists() {
        return Ok(Sky::Image(text.into()));
    }
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let numbers: Vec<f32> = parts.iter().filter_map(|part| part.parse().ok()).collect();
    match numbers[..] {
        [r, g, b] if parts.len() == 3 => {
            let radiance = Vec3::new(r, g, b);
            if radiance.is_finite() && radiance.min_element() >= 0.0 {
                return Ok(Sky::Even(radiance));
            }
            Err("expected a radiance R,G,B of three finite numbers, none of them negative".into())
        }
        [grey] if parts.len() == 1 => Err(format!("expected three numbers for a radiance: {grey},{grey},{grey}")),
        _ if !numbers.is_empty() && numbers.len() == parts.len() => {
            Err("expected three numbers R,G,B for a radiance".into())
        }
        // What could be no picture's name.
        _ if Path::new(text).extension().is_none() => {
            Err("expected an image (.hdr, .exr, ...), three numbers R,G,B, studio or none; no file has this name"
                .into())
        }
        _ => Ok(Sky::Image(PathBuf::from(text))),
    }
}

fn on_or_off(text: &str) -> Result<bool, String> {
    match text {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => Err("expected on or off; more is said in a scene file, which `luminaire scene` writes".into()),
    }
}

fn side(text: &str) -> Result<Side, String> {
    Side::ALL.into_iter().find(|side| side.name() == text.to_ascii_lowercase()).ok_or_else(|| {
        "expected front, back, left, right or top; other cameras come from a file: --camera FILE.toml".into()
    })
}

fn degrees(text: &str) -> Result<f32, String> {
    let degrees = text.parse().ok().filter(|degrees| (0.0..=180.0).contains(degrees));
    degrees.ok_or_else(|| "expected degrees from 0 to 180, for example 40; 0 is flat".into())
}

fn up(text: &str) -> Result<Up, String> {
    match text {
        "y" | "Y" | "+y" => Ok(Up::Y),
        "z" | "Z" | "+z" => Ok(Up::Z),
        _ => Err("expected y or z; a model that lies otherwise is turned by `rotate` in a scene file".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sky_is_a_name_three_numbers_or_a_file() {
        assert_eq!(sky("studio"), Ok(Sky::Studio));
        assert_eq!(sky("none"), Ok(Sky::None));
        assert_eq!(sky("1, 0.5,0"), Ok(Sky::Even(Vec3::new(1.0, 0.5, 0.0))));
        assert_eq!(sky("a,b.hdr"), Ok(Sky::Image("a,b.hdr".into())));
        for (bad, words) in [
            ("", "expected an image"),
            ("red", "no file has this name"),
            ("1 1 1", "three numbers"),
            ("0.5", "0.5,0.5,0.5"),
            ("1,2", "three numbers"),
            ("1,2,3,4", "three numbers"),
            ("1,2,-3", "negative"),
            ("1,nan,3", "finite"),
        ] {
            assert!(sky(bad).unwrap_err().contains(words), "{bad}");
        }
        assert!(
            degrees("181").is_err() && degrees("nan").is_err() && degrees("-1").is_err() && degrees("0") == Ok(0.0)
        );
        assert!(up("x").is_err() && on_or_off("yes").is_err());
    }
}
