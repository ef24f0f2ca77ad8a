//! Environments, and their images.

use super::choices::Sky;
use super::near_name::instead_of;
use crate::picture::decode::ImageFile;
use crate::scene::{Environment, EnvironmentImage};
use crate::{Error, Result};
use glam::Vec3;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Most texels of an environment, 16384 x 8192: choosing among them takes several times the memory of the image itself.
const MOST_TEXELS: u64 = 1 << 27;

/// The environment that a chosen sky is; none if there is none or it is black, the latter with a warning.
///
/// # Errors
/// [`Error::Read`] if its image cannot be used.
pub(super) fn of(sky: &Sky, files: &mut Vec<PathBuf>, warnings: &mut Vec<String>) -> Result<Option<Environment>> {
    let (radiance, image) = match sky {
        Sky::None => return Ok(None),
        Sky::Even(radiance) if *radiance == Vec3::ZERO => return Ok(None),
        Sky::Even(radiance) => (*radiance, None),
        Sky::Studio => (Vec3::ONE, Some(EnvironmentImage::studio())),
        Sky::Image(path) => {
            files.extend(Some(path.clone()).filter(|path| path.is_file()));
            let read = read(path, warnings).map_err(|reason| Error::read(path, reason + &instead_of(path)))?;
            if read.is_none() {
                return Ok(None);
            }
            (Vec3::ONE, read)
        }
    };
    Ok(Some(Environment { radiance, image: image.map(Arc::new), rotation: 0.0 }))
}

/// Reads a latitude-longitude image; none if it is black. What is negative or not finite is replaced, with a warning.
///
/// # Errors
/// In words that can follow the file's name.
pub(super) fn read(path: &Path, warnings: &mut Vec<String>) -> std::result::Result<Option<EnvironmentImage>, String> {
    let too_many = |texels| {
        format!("it has {texels} texels, and an environment at most {MOST_TEXELS}: make a smaller image of it")
    };
    let image = ImageFile::open(path, MOST_TEXELS, too_many)?;
    if image.cube {
        return Err("it holds the six sides of a cube, and an environment is a latitude-longitude image: convert it, for example with \
                    `exrenvmap -l IN out.exr`"
            .into());
    }
    warnings.extend(image.warnings.iter().map(|warning| format!("{}: {warning}", path.display())));
    let (width, height) = (image.width, image.height);
    // One row or column has no shape that could be wrong.
    if width.min(height) > 1 && width.abs_diff(2 * height) > width / 8 {
        warnings.push(format!(
            "{}: the environment has {width} x {height} texels, and a latitude-longitude image twice as many columns as rows: it is \
             stretched; convert a cube, a cross or a picture of a mirror ball to latitude and longitude",
            path.display()
        ));
    }
    let (mut odd, mut infinite) = (0u64, 0u64);
    let mut texels: Vec<Vec3> = (0..image.len())
        .map(|texel| {
            let [r, g, b, _] = image.linear(texel);
            let colour = Vec3::new(r, g, b);
            let rounding = image.rounding() * colour.abs().max_element();
            odd += u64::from(colour.is_nan() || colour.min_element() < -rounding);
            // In this order a NaN becomes 0.
            colour.max(Vec3::ZERO).map(|channel| if channel.is_nan() { 0.0 } else { channel })
        })
        .collect();
    if odd > 0 {
        let why = if image.rounding() > 0.0 { " (colours that sRGB cannot show)" } else { "" };
        warnings.push(format!("{}: {odd} texels are negative or NaN{why}; 0 is used there", path.display()));
    }
    let largest = texels.iter().flat_map(|t| t.to_array()).filter(|c| c.is_finite()).fold(0.0, f32::max);
    for texel in texels.iter_mut().filter(|texel| !texel.is_finite()) {
        infinite += 1;
        *texel = texel.min(Vec3::splat(largest.max(1.0)));
    }
    if infinite > 0 {
        warnings.push(format!(
            "{}: {infinite} texels are infinite; the largest finite value is used there",
            path.display()
        ));
    }
    if texels.iter().all(|texel| *texel == Vec3::ZERO) {
        warnings.push(format!("{}: the environment is black; there is none", path.display()));
        return Ok(None);
    }
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    Ok(Some(EnvironmentImage { name, width: image.width, height: image.height, texels }))
}
