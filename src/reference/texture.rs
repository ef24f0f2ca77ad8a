//! Images on surfaces: what a material's numbers are at a point.

use super::prepared_scene::Reference;
use crate::scene::{Material, Texture};
use glam::{Affine2, DVec2, DVec4};

/// Colour and alpha of a texture at `uv`, bilinear between the centres of the texels. `v` points up: row 0 is the image's top.
///
/// The texture's transform comes first. Coordinates repeat, or stay at the border if the texture says so; one that is not finite counts as 0.
pub fn bilinear(texture: &Texture, uv: DVec2) -> DVec4 {
    image_at(texture, placed(texture, uv))
}

fn finite(x: f64) -> f64 {
    if x.is_finite() { x } else { 0.0 }
}

/// Where `uv` is in the image.
fn placed(texture: &Texture, uv: DVec2) -> DVec2 {
    let Affine2 { matrix2, translation } = texture.transform;
    matrix2.as_dmat2() * DVec2::new(finite(uv.x), finite(uv.y)) + translation.as_dvec2()
}

/// How the heights of a texture, which are the sums of its red and green, grow with u and v: differences over one texel, so that the slope is continuous where
/// that of bilinear heights jumps from texel to texel.
pub fn height_gradient(texture: &Texture, uv: DVec2) -> DVec2 {
    let size = DVec2::new(f64::from(texture.width), f64::from(texture.height));
    let place = placed(texture, uv);
    let height = |by: DVec2| {
        let texel = image_at(texture, place + by / size);
        texel.x + texel.y
    };
    let across = height(DVec2::X * 0.5) - height(DVec2::X * -0.5);
    let upwards = height(DVec2::Y * 0.5) - height(DVec2::Y * -0.5);
    texture.transform.matrix2.as_dmat2().transpose() * (DVec2::new(across, upwards) * size)
}

fn image_at(texture: &Texture, uv: DVec2) -> DVec4 {
    let (width, height) = (f64::from(texture.width), f64::from(texture.height));
    let x = finite(uv.x) * width - 0.5;
    let y = (1.0 - finite(uv.y)) * height - 0.5;
    let inside = |i: f64, n: f64| if texture.clamp { i.clamp(0.0, n - 1.0) } else { i.rem_euclid(n) };
    let texel = |column: f64, row: f64| {
        let index = inside(row, height) as usize * texture.width as usize + inside(column, width) as usize;
        DVec4::from_array(texture.texels[index].map(|number| number.to_f64()))
    };
    let (column, row) = (x.floor(), y.floor());
    let upper = texel(column, row).lerp(texel(column + 1.0, row), x - column);
    let lower = texel(column, row + 1.0).lerp(texel(column + 1.0, row + 1.0), x - column);
    upper.lerp(lower, y - row)
}

impl Reference {
    /// The texel of a material's map at `uv`; 1 without a map.
    pub(super) fn map(&self, map: Option<u32>, uv: DVec2) -> DVec4 {
        map.map_or(DVec4::ONE, |texture| bilinear(&self.scene.textures[texture as usize], uv))
    }

    /// Share of the light that meets a surface of this material at `uv`; the rest passes straight on.
    pub(super) fn opacity(&self, material: &Material, uv: DVec2) -> f64 {
        f64::from(material.opacity) * self.map(material.maps.opacity, uv).w
    }
}
