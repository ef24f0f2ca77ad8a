//! Primaries: which colours a file means by red, green and blue, and the matrix to those of sRGB.

use glam::{DMat3, DVec2, DVec3};

/// CIE 1931 chromaticities (x, y) of the primaries and of white.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Primaries {
    /// Of red, green and blue.
    pub rgb: [DVec2; 3],
    /// Of equal parts of them.
    pub white: DVec2,
}

/// Daylight of 6500 K, as all standards round it.
const D65: DVec2 = DVec2::new(0.3127, 0.3290);

/// Files round chromaticities: below this they mean the same ones.
const SAME: f64 = 0.001;

/// Cone responses of CIE XYZ by Bradford (Lam 1985, as ICC.1:2022 has it in annex E), by column.
const BRADFORD: DMat3 = DMat3::from_cols(
    DVec3::new(0.8951, -0.7502, 0.0389),
    DVec3::new(0.2664, 1.7135, -0.0685),
    DVec3::new(-0.1614, 0.0367, 1.0296),
);

impl Primaries {
    /// ITU-R BT.709 and sRGB.
    pub(super) const REC_709: Self = Self::new([0.64, 0.33, 0.30, 0.60, 0.15, 0.06], D65);
    /// ITU-R BT.2020.
    pub(super) const REC_2020: Self = Self::new([0.708, 0.292, 0.170, 0.797, 0.131, 0.046], D65);
    /// SMPTE EG 432-1, Display P3.
    pub(super) const P3_D65: Self = Self::new([0.680, 0.320, 0.265, 0.690, 0.150, 0.060], D65);
    /// SMPTE RP 431-2, DCI-P3.
    pub(super) const P3_DCI: Self = Self::new([0.680, 0.320, 0.265, 0.690, 0.150, 0.060], DVec2::new(0.314, 0.351));
    /// ITU-R BT.601 of 625 lines, BT.470 B and G.
    pub(super) const REC_601_625: Self = Self::new([0.64, 0.33, 0.29, 0.60, 0.15, 0.06], D65);
    /// ITU-R BT.601 of 525 lines, SMPTE 170M and 240M.
    pub(super) const REC_601_525: Self = Self::new([0.630, 0.340, 0.310, 0.595, 0.155, 0.070], D65);

    /// x and y of red, green and blue in turn.
    const fn new([rx, ry, gx, gy, bx, by]: [f64; 6], white: DVec2) -> Self {
        Primaries { rgb: [DVec2::new(rx, ry), DVec2::new(gx, gy), DVec2::new(bx, by)], white }
    }

    /// The matrix from linear values with these primaries to linear sRGB, white to white (Bradford); none where they are those of sRGB.
    ///
    /// # Errors
    /// In words that can follow "its primaries": they span no triangle, or white is none.
    pub(super) fn to_srgb(self) -> Result<Option<DMat3>, String> {
        let near = |a: DVec2, b: DVec2| (a - b).abs().cmplt(DVec2::splat(SAME)).all();
        let srgb = Self::REC_709;
        if near(self.white, srgb.white) && self.rgb.iter().zip(srgb.rgb).all(|(a, b)| near(*a, b)) {
            return Ok(None);
        }
        let matrix = self
            .to_xyz()
            .zip(srgb.to_xyz())
            .map(|(from, to)| to.inverse() * adaptation(white_xyz(self.white), white_xyz(srgb.white)) * from);
        matrix.filter(|matrix| matrix.is_finite()).map(Some).ok_or_else(|| {
            let [r, g, b] = self.rgb;
            let w = self.white;
            format!("are no colours ({} {}, {} {}, {} {}, white {} {})", r.x, r.y, g.x, g.y, b.x, b.y, w.x, w.y)
        })
    }

    /// The matrix to CIE XYZ, in which white has Y = 1.
    fn to_xyz(self) -> Option<DMat3> {
        let [r, g, b] = self.rgb.map(|c| DVec3::new(c.x, c.y, 1.0 - c.x - c.y));
        let directions = DMat3::from_cols(r, g, b);
        let usable = directions.determinant().abs() > 1e-6 && self.white.x > 1e-3 && self.white.y > 1e-3;
        let shares = usable.then(|| directions.inverse() * white_xyz(self.white))?;
        // A share of 0 or less: white does not lie between the primaries.
        (shares.min_element() > 0.0).then(|| directions * DMat3::from_diagonal(shares))
    }
}

fn white_xyz(white: DVec2) -> DVec3 {
    DVec3::new(white.x / white.y, 1.0, (1.0 - white.x - white.y) / white.y)
}

/// Bradford's adaptation of CIE XYZ from one white to another.
fn adaptation(from: DVec3, to: DVec3) -> DMat3 {
    BRADFORD.inverse() * DMat3::from_diagonal((BRADFORD * to) / (BRADFORD * from)) * BRADFORD
}

/// The matrix from CIE XYZ as colour profiles have it, with the white D50, to linear sRGB.
pub(super) fn from_profile_xyz() -> DMat3 {
    // ICC.1:2022, 7.2.16.
    const D50: DVec3 = DVec3::new(0.9642, 1.0, 0.8249);
    let srgb = Primaries::REC_709;
    let to_xyz = srgb.to_xyz().unwrap_or(DMat3::IDENTITY);
    to_xyz.inverse() * adaptation(D50, white_xyz(srgb.white))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ACES_WHITE: DVec2 = DVec2::new(0.32168, 0.33767);

    /// Rows of published matrices: BT.2087, and those of the ACES and P3 conversions by Bradford that colour-science.org tabulates.
    #[test]
    fn published_matrices() {
        let cg = Primaries::new([0.713, 0.293, 0.165, 0.830, 0.128, 0.044], ACES_WHITE);
        let aces = Primaries::new([0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.0770], ACES_WHITE);
        for (name, primaries, rows) in [
            (
                "Rec. 2020",
                Primaries::REC_2020,
                [[1.6605, -0.5876, -0.0728], [-0.1246, 1.1329, -0.0083], [-0.0182, -0.1006, 1.1187]],
            ),
            ("P3", Primaries::P3_D65, [[1.2249, -0.2249, 0.0], [-0.0421, 1.0421, 0.0], [-0.0196, -0.0786, 1.0983]]),
            ("ACEScg", cg, [[1.7051, -0.6218, -0.0833], [-0.1303, 1.1408, -0.0105], [-0.0240, -0.1290, 1.1530]]),
            ("ACES", aces, [[2.5217, -1.1341, -0.3876], [-0.2765, 1.3727, -0.0962], [-0.0154, -0.1530, 1.1684]]),
        ] {
            let matrix = primaries.to_srgb().unwrap().unwrap();
            for (row, expected) in rows.iter().enumerate() {
                let found = matrix.row(row);
                assert!((found - DVec3::from_array(*expected)).abs().max_element() < 1.1e-4, "{name} {row}: {found}");
            }
            assert!((matrix * DVec3::ONE - DVec3::ONE).abs().max_element() < 1e-12, "{name}: white is not white");
        }
    }

    #[test]
    fn what_is_srgb_or_no_colour() {
        assert_eq!(Primaries::REC_709.to_srgb(), Ok(None));
        let rounded = Primaries::new([0.6400, 0.3300, 0.3000, 0.6000, 0.1500, 0.0600], DVec2::new(0.31271, 0.32902));
        assert_eq!(rounded.to_srgb(), Ok(None));
        for (numbers, white) in [
            ([0.0; 6], DVec2::ZERO),
            ([0.64, 0.33, 0.64, 0.33, 0.15, 0.06], D65),
            ([0.64, 0.33, 0.30, 0.60, 0.15, 0.06], DVec2::new(0.7, 0.2)),
            ([f64::NAN, 0.33, 0.30, 0.60, 0.15, 0.06], D65),
            ([f64::INFINITY, 0.33, 0.30, 0.60, 0.15, 0.06], D65),
        ] {
            assert!(Primaries::new(numbers, white).to_srgb().unwrap_err().contains("no colours"), "{numbers:?}");
        }
    }

    /// The colorants of sRGB in profiles (adapted to D50), as its registered profile has them.
    #[test]
    fn colorants_of_profiles() {
        let colorants = DMat3::from_cols(
            DVec3::new(0.4361, 0.2225, 0.0139),
            DVec3::new(0.3851, 0.7169, 0.0971),
            DVec3::new(0.1431, 0.0606, 0.7141),
        );
        let identity = from_profile_xyz() * colorants;
        assert!((identity - DMat3::IDENTITY).to_cols_array().iter().all(|e| e.abs() < 1e-3), "{identity}");
    }
}
