//! Colour profiles (ICC.1:2022) within pictures: what matters of them is their curves and their colorants.

use super::encoding::{Curve, Encoding};
use super::primaries::from_profile_xyz;
use glam::{DMat3, DVec3};
use moxcms::{ColorProfile, DataColorSpace, ProfileText, ToneReprCurve, Xyzd};

/// How much an element of the matrix to sRGB may differ from that of no change: profiles of sRGB are rounded in many ways.
const SAME: f64 = 0.01;

/// What a profile means. Where it is of a kind that is not read here (lookup tables, CMYK) or damaged, sRGB, with a warning.
pub(super) fn encoding(profile: &[u8], warnings: &mut Vec<String>) -> Encoding {
    let mut srgb = |why: String| {
        warnings.push(format!("{why}; its colours are taken as sRGB: convert it to sRGB if they are not"));
        Encoding::SRGB
    };
    let profile = match ColorProfile::new_from_slice(profile) {
        Ok(profile) => profile,
        Err(error) => return srgb(format!("its colour profile cannot be read ({error})")),
    };
    let name = description(&profile);
    match profile.color_space {
        DataColorSpace::Gray => match &profile.gray_trc {
            Some(curve) => checked([0; 3].map(|_| curve.clone()), None).unwrap_or_else(srgb),
            None => srgb(format!("its colour profile{name} has no curve")),
        },
        DataColorSpace::Rgb => match (&profile.red_trc, &profile.green_trc, &profile.blue_trc) {
            (Some(red), Some(green), Some(blue)) => {
                checked([red, green, blue].map(Clone::clone), Some(&profile)).unwrap_or_else(srgb)
            }
            // Such profiles of sRGB exist.
            _ if name.contains("sRGB") => Encoding::SRGB,
            _ => srgb(format!("its colour profile{name} is made of lookup tables, which are not read here")),
        },
        other => srgb(format!("its colour profile{name} is not one of RGB or grey ({other:?})")),
    }
}

/// The encoding of curves and, of a profile of RGB, its colorants.
fn checked(curves: [ToneReprCurve; 3], rgb: Option<&ColorProfile>) -> Result<Encoding, String> {
    let curve = Curve::Profile(curves);
    let Some(table) = curve.table(256) else { return Err("a curve of its colour profile cannot be evaluated".into()) };
    if table.iter().flatten().any(|value| !value.is_finite()) || table[255].iter().any(|white| *white < 0.5) {
        return Err("a curve of its colour profile makes no sense".into());
    }
    let matrix = rgb.map(matrix).transpose()?.flatten();
    Ok(Encoding { curve: if curve.is_srgb() { Curve::Srgb } else { curve }, matrix })
}

/// The matrix to linear sRGB; none where a profile means that of sRGB.
fn matrix(profile: &ColorProfile) -> Result<Option<DMat3>, String> {
    let column = |c: Xyzd| DVec3::new(c.x, c.y, c.z);
    let colorants = [profile.red_colorant, profile.green_colorant, profile.blue_colorant].map(column);
    let matrix = from_profile_xyz() * DMat3::from_cols(colorants[0], colorants[1], colorants[2]);
    let white = matrix * DVec3::ONE;
    if !matrix.is_finite() || matrix.determinant().abs() < 1e-3 || (white - DVec3::ONE).abs().max_element() > 0.1 {
        return Err("the colorants of its colour profile make no white".into());
    }
    // What is left of rounding would tint white.
    let matrix = DMat3::from_diagonal(white.recip()) * matrix;
    let same = (matrix - DMat3::IDENTITY).to_cols_array().iter().all(|element| element.abs() < SAME);
    Ok((!same).then_some(matrix))
}

/// What the profile calls itself, for a message.
fn description(profile: &ColorProfile) -> String {
    let name = match &profile.description {
        Some(ProfileText::PlainString(text)) => text.clone(),
        Some(ProfileText::Localizable(texts)) => texts.first().map(|text| text.value.clone()).unwrap_or_default(),
        Some(ProfileText::Description(text)) => text.ascii_string.clone(),
        None => String::new(),
    };
    let name: String = name.chars().filter(|c| !c.is_control()).take(60).collect();
    if name.is_empty() { name } else { format!(" `{name}`") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use moxcms::ColorProfile;

    fn read(profile: &ColorProfile) -> (Encoding, Vec<String>) {
        let mut warnings = Vec::new();
        (encoding(&profile.encode().unwrap(), &mut warnings), warnings)
    }

    #[test]
    fn profiles_of_rgb_and_grey() {
        assert_eq!(read(&ColorProfile::new_srgb()), (Encoding::SRGB, vec![]));
        let (p3, warnings) = read(&ColorProfile::new_display_p3());
        assert!(warnings.is_empty() && p3.curve == Curve::Srgb, "{warnings:?}");
        // Display P3 to sRGB as published.
        let red = p3.matrix.unwrap() * DVec3::X;
        assert!((red - DVec3::new(1.2249, -0.0421, -0.0196)).abs().max_element() < 2e-3, "{red}");
        let (adobe, warnings) = read(&ColorProfile::new_adobe_rgb());
        assert!(warnings.is_empty(), "{warnings:?}");
        assert!((adobe.curve.table(3).unwrap()[1][0] - 0.5f32.powf(563.0 / 256.0)).abs() < 1e-3);
        assert!((adobe.matrix.unwrap() * DVec3::ONE - DVec3::ONE).abs().max_element() < 1e-9, "white stays white");
        let mut linear = ColorProfile::new_srgb();
        let straight = Some(ToneReprCurve::Parametric(vec![1.0]));
        (linear.red_trc, linear.green_trc, linear.blue_trc) = (straight.clone(), straight.clone(), straight);
        linear.cicp = None;
        let (linear, warnings) = read(&linear);
        assert!(warnings.is_empty() && linear.curve.is_linear() && linear.matrix.is_none(), "{linear:?} {warnings:?}");
        let (grey, warnings) = read(&ColorProfile::new_gray_with_gamma(1.8));
        assert!(warnings.is_empty() && grey.matrix.is_none(), "{warnings:?}");
        assert!((grey.curve.table(3).unwrap()[1][1] - 0.5f32.powf(1.8)).abs() < 2e-3);
    }

    #[test]
    fn what_cannot_be_read_is_said() {
        let mut warnings = Vec::new();
        assert_eq!(encoding(b"not a profile", &mut warnings), Encoding::SRGB);
        assert!(warnings[0].contains("cannot be read") && warnings[0].contains("sRGB"), "{warnings:?}");
        let mut tables = ColorProfile::new_adobe_rgb();
        tables.red_trc = None;
        let (encoding, warnings) = read(&tables);
        assert_eq!(encoding, Encoding::SRGB);
        assert!(warnings.len() == 1, "{warnings:?}");
        let bytes = ColorProfile::new_display_p3().encode().unwrap();
        for length in 0..bytes.len() {
            super::encoding(&bytes[..length], &mut Vec::new());
        }
        for at in 0..bytes.len() {
            let mut bytes = bytes.clone();
            bytes[at] ^= 0xff;
            super::encoding(&bytes, &mut Vec::new());
        }
    }
}
