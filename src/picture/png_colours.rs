//! What a PNG says about its colours: the chunks cICP, iCCP, sRGB, gAMA and cHRM, the first of which that is there counts (PNG, third
//! edition, 4.3).

use super::encoding::{Curve, Encoding};
use super::icc;
use super::primaries::Primaries;
use glam::DVec2;
use moxcms::TransferCharacteristics;
use png::{CodingIndependentCodePoints, Info, SourceChromaticities};
use std::io::{BufRead, Seek};

/// Most bytes that chunks in front of the pixels may take.
const MOST_BYTES: usize = 16 << 20;

/// The first bytes of a PNG.
pub(super) const MAGIC: [u8; 4] = *b"\x89PNG";

/// Reads what stands in front of the pixels.
///
/// # Errors
/// In words that can follow the picture's name: it is damaged, or its colours are of a kind that is not read here.
pub(super) fn encoding(stream: impl BufRead + Seek, warnings: &mut Vec<String>) -> Result<Encoding, String> {
    let decoder = png::Decoder::new_with_limits(stream, png::Limits { bytes: MOST_BYTES });
    let reader = decoder.read_info().map_err(|e| e.to_string())?;
    said(reader.info(), warnings)
}

fn said(info: &Info, warnings: &mut Vec<String>) -> Result<Encoding, String> {
    // 2 says that nothing is said.
    if let Some(cicp) = &info.coding_independent_code_points
        && (cicp.color_primaries, cicp.transfer_function) != (2, 2)
    {
        return coded(*cicp, warnings);
    }
    if let Some(profile) = &info.icc_profile {
        return Ok(icc::encoding(profile, warnings));
    }
    if info.srgb.is_some() {
        return Ok(Encoding::SRGB);
    }
    let curve = match info.gama_chunk.map(|gamma| f64::from(gamma.into_scaled()) / 100_000.0) {
        None => Curve::Srgb,
        Some(gamma) if !(0.01..=10.0).contains(&gamma) => {
            warnings.push(format!("its gAMA chunk says {gamma}, which makes no sense; its colours are taken as sRGB"));
            Curve::Srgb
        }
        // 45455: what programs without the chunk sRGB write for it.
        Some(gamma) if (gamma - 0.45455).abs() < 0.005 => Curve::Srgb,
        Some(gamma) => Curve::Power(1.0 / gamma),
    };
    let matrix = info.chrm_chunk.map_or(Ok(None), |chunk| primaries(&chunk).to_srgb()).unwrap_or_else(|why| {
        warnings.push(format!("the primaries of its cHRM chunk {why}; they are taken as those of sRGB"));
        None
    });
    Ok(Encoding { curve, matrix })
}

/// By the numbers of ITU-T H.273.
fn coded(cicp: CodingIndependentCodePoints, warnings: &mut Vec<String>) -> Result<Encoding, String> {
    let CodingIndependentCodePoints { color_primaries, transfer_function, is_video_full_range_image, .. } = cicp;
    let convert = "convert it to sRGB, or to OpenEXR for what is brighter than white";
    if !is_video_full_range_image {
        return Err(format!("its cICP chunk says that its codes do not use their whole range, as in video: {convert}"));
    }
    let curve = match transfer_function {
        13 => Curve::Srgb,
        // The curves of standards that have one for a picture by itself.
        1 | 4 | 5 | 6 | 8 | 14 | 15 => Curve::Standard(
            TransferCharacteristics::try_from(transfer_function).map_err(|_| "its cICP chunk is damaged".to_owned())?,
        ),
        16 => return Err(format!("its cICP chunk says that it is HDR (PQ): {convert}")),
        18 => return Err(format!("its cICP chunk says that it is HDR (HLG): {convert}")),
        other => {
            warnings.push(format!(
                "its cICP chunk has the transfer function {other}, which is not read here; that of sRGB is used"
            ));
            Curve::Srgb
        }
    };
    let primaries = match color_primaries {
        1 | 2 => Primaries::REC_709,
        5 => Primaries::REC_601_625,
        6 | 7 => Primaries::REC_601_525,
        9 => Primaries::REC_2020,
        11 => Primaries::P3_DCI,
        12 => Primaries::P3_D65,
        other => {
            warnings.push(format!(
                "its cICP chunk has the primaries {other}, which are not read here; those of sRGB are used"
            ));
            Primaries::REC_709
        }
    };
    Ok(Encoding { curve, matrix: primaries.to_srgb()? })
}

fn primaries(chunk: &SourceChromaticities) -> Primaries {
    let point = |(x, y): (png::ScaledFloat, png::ScaledFloat)| {
        DVec2::new(f64::from(x.into_scaled()), f64::from(y.into_scaled())) / 100_000.0
    };
    Primaries { rgb: [chunk.red, chunk.green, chunk.blue].map(point), white: point(chunk.white) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use png::{ScaledFloat, SrgbRenderingIntent};

    fn read(info: &Info) -> (Encoding, Vec<String>) {
        let mut warnings = Vec::new();
        (said(info, &mut warnings).unwrap(), warnings)
    }

    fn with(change: impl FnOnce(&mut Info<'static>)) -> Info<'static> {
        let mut info = Info::default();
        change(&mut info);
        info
    }

    fn gamma(gamma: f32) -> Info<'static> {
        with(|info| info.gama_chunk = Some(ScaledFloat::new(gamma)))
    }

    fn code(color_primaries: u8, transfer_function: u8, is_video_full_range_image: bool) -> Info<'static> {
        let cicp = CodingIndependentCodePoints {
            color_primaries,
            transfer_function,
            matrix_coefficients: 0,
            is_video_full_range_image,
        };
        with(|info| info.coding_independent_code_points = Some(cicp))
    }

    #[test]
    fn one_chunk_alone() {
        assert_eq!(read(&Info::default()), (Encoding::SRGB, vec![]));
        assert_eq!(read(&gamma(0.45455)), (Encoding::SRGB, vec![]));
        assert_eq!(read(&gamma(1.0)), (Encoding { curve: Curve::Power(1.0), matrix: None }, vec![]));
        let Curve::Power(exponent) = read(&gamma(0.55556)).0.curve else { panic!("no power") };
        assert!((exponent - 1.8).abs() < 1e-4);
        let (odd, warnings) = read(&gamma(0.0));
        assert!(odd == Encoding::SRGB && warnings[0].contains("gAMA chunk says 0"), "{warnings:?}");
        assert!(read(&code(1, 8, true)).0.curve.is_linear() && read(&code(1, 13, true)).0 == Encoding::SRGB);
        assert!(read(&code(12, 13, true)).0.matrix.is_some() && read(&code(2, 2, true)).0 == Encoding::SRGB);
        let says = |info: &Info, what: &str| assert!(said(info, &mut Vec::new()).unwrap_err().contains(what), "{what}");
        says(&code(9, 16, true), "PQ");
        says(&code(9, 18, true), "HLG");
        says(&code(1, 13, false), "whole range");
        let (_, warnings) = read(&code(77, 99, true));
        assert!(warnings.len() == 2 && warnings[0].contains("99") && warnings[1].contains("77"), "{warnings:?}");
    }

    #[test]
    fn chromaticities() {
        let srgb = [(0.3127, 0.329), (0.64, 0.33), (0.3, 0.6), (0.15, 0.06)];
        let chunk =
            |c: [(f32, f32); 4]| with(|info| info.chrm_chunk = Some(SourceChromaticities::new(c[0], c[1], c[2], c[3])));
        assert_eq!(read(&chunk(srgb)), (Encoding::SRGB, vec![]));
        let wide = [srgb[0], (0.708, 0.292), (0.170, 0.797), (0.131, 0.046)];
        assert!((read(&chunk(wide)).0.matrix.unwrap().x_axis.x - 1.6605).abs() < 1e-3);
        let (odd, warnings) = read(&chunk([(0.0, 0.0); 4]));
        assert!(odd == Encoding::SRGB && warnings[0].contains("cHRM"), "{warnings:?}");
    }

    /// cICP before iCCP before sRGB before gAMA.
    #[test]
    fn precedence() {
        let mut info = gamma(1.0);
        info.srgb = Some(SrgbRenderingIntent::Perceptual);
        assert_eq!(read(&info).0, Encoding::SRGB);
        info.icc_profile = Some(moxcms::ColorProfile::new_display_p3().encode().unwrap().into());
        assert!(read(&info).0.matrix.is_some());
        info.coding_independent_code_points = code(1, 8, true).coding_independent_code_points;
        let coded = read(&info).0;
        assert_eq!((coded.curve.is_linear(), coded.matrix), (true, None));
    }
}
