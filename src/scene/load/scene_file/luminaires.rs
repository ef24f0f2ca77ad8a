//! The luminaires without an area as tables: the model's own, the lamp at the camera, and what others there may be.

use super::words::{keys, number, point, quoted, triple};
use crate::scene::Luminaire;
use crate::scene::load::bare_mesh::BareMesh;
use glam::DVec3;

/// A table for each luminaire, and comments with all kinds.
pub(super) fn tables(bare: &BareMesh) -> String {
    let mut text = String::new();
    let luminaires = &bare.scene.luminaires;
    for (index, luminaire) in luminaires.iter().enumerate() {
        let is_fill = bare.fill && index + 1 == luminaires.len();
        let what = if is_fill { "The lamp at the camera." } else { "A luminaire of the model." };
        text += &format!("\n# {what}\n{}", table(luminaire, bare.scene.origin));
    }
    text + LUMINAIRES
}

/// The table of one luminaire, in a scene with this origin.
fn table(luminaire: &Luminaire, origin: DVec3) -> String {
    let kind = |kind: &str| ("kind", quoted(kind), "");
    const INTENSITY: &str = "radiant intensity, RGB";
    const IRRADIANCE: &str = "irradiance on a surface that faces it";
    "[[luminaire]]\n".to_owned()
        + &match luminaire {
            Luminaire::Point { position, intensity } => keys(&[
                kind("point"),
                ("position", point(*position, origin), ""),
                ("intensity", triple(*intensity), INTENSITY),
            ]),
            Luminaire::Spot { position, direction, intensity, inner, outer } => keys(&[
                kind("spot"),
                ("position", point(*position, origin), ""),
                ("direction", triple(*direction), "in which the light travels"),
                ("intensity", triple(*intensity), INTENSITY),
                ("inner_angle", number(*inner), "degrees from the axis up to which it is whole"),
                ("outer_angle", number(*outer), "degrees from the axis beyond which there is no light"),
            ]),
            Luminaire::Infinite { direction, irradiance } => keys(&[
                kind("infinite"),
                ("direction", triple(*direction), "in which the light travels"),
                ("irradiance", triple(*irradiance), IRRADIANCE),
            ]),
            Luminaire::Sun { direction, irradiance, angle } => keys(&[
                kind("infinite"),
                ("direction", triple(*direction), "in which the light travels"),
                ("irradiance", triple(*irradiance), IRRADIANCE),
                ("angle", number(*angle), "diameter of its disc in degrees"),
            ]),
            // No model brings one: their files have no name here.
            Luminaire::Photometric { position, direction, up, intensity, profile } => keys(&[
                kind("point"),
                ("position", point(*position, origin), ""),
                ("profile", quoted(&profile.name), "an IES file"),
                ("direction", triple(*direction), "where its vertical angle of 0 looks"),
                ("up", triple(*up), "the side to which its horizontal angle of 0 looks"),
                ("intensity", triple(*intensity), "a factor to it"),
            ]),
        }
}

const LUMINAIRES: &str = "
# Luminaires without an area, as many as you like; one with an area is a mesh whose material emits.
# [[luminaire]]
# kind = \"point\"                         # intensity: radiant intensity, RGB
# position = [0, 1, 0]
# intensity = [1, 1, 1]
# [[luminaire]]
# kind = \"point\"                         # one that shines as a photometric file says
# position = [0, 3, 0]
# profile = \"lamp.ies\"                   # an IES file (LM-63), in candela
# direction = [0, -1, 0]                 # where its vertical angle of 0 looks; without it down
# up = [1, 0, 0]                         # the side to which its horizontal angle of 0 looks; without it up, or +x where `direction` is vertical
# intensity = [1, 1, 1]                  # a factor to it
# [[luminaire]]
# kind = \"spot\"                          # a point that shines into a cone: no light beyond outer_angle from direction, all of it within inner_angle
# position = [0, 3, 0]
# direction = [0, -1, 0]
# intensity = [1, 1, 1]
# inner_angle = 20                       # degrees from the axis, 0 to outer_angle; without it 0
# outer_angle = 30                       # degrees from the axis, 0.0001 to 90
# [[luminaire]]
# kind = \"infinite\"                      # direction in which the light travels; irradiance on a surface that faces it
# direction = [0.3, -0.8, -0.7]
# irradiance = [1, 1, 1]
# angle = 0                              # diameter of a disc that is seen and has soft shadows: 0.53 is the sun's, at most 180
";
