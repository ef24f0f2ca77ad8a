//! Metals by name.

use glam::Vec3;

/// Their names, and indices of refraction and extinction coefficients in the bands of linear sRGB: measured spectra, each converted as that of a colour is. The
/// numbers are those of B. Bitterli's Tungsten (`ComplexIorData.hpp`), which other renderers have from there.
const METALS: [(&str, [[f32; 3]; 2]); 8] = [
    ("aluminium", [[1.657_46, 0.880_369, 0.521_229], [9.223_869, 6.269_523, 4.837_001]]),
    ("chromium", [[4.369_683, 2.916_702, 1.654_701], [5.206_434, 4.231_364, 3.754_947]]),
    ("copper", [[0.200_438, 0.924_033, 1.102_212], [3.912_949, 2.452_848, 2.142_188]]),
    ("gold", [[0.143_119, 0.374_957, 1.442_479], [3.983_16, 2.385_721, 1.603_215]]),
    ("mercury", [[2.398_931, 1.440_025, 0.909_551], [6.327_627, 4.371_941, 3.421_79]]),
    ("nickel", [[2.367_275, 1.663_358, 1.467_055], [4.498_833, 3.050_164, 2.345_427]]),
    ("silver", [[0.155_265, 0.116_723, 0.138_381], [4.828_343, 3.122_246, 2.146_95]]),
    ("tungsten", [[4.370_703, 3.300_297, 2.998_267], [3.500_678, 2.604_865, 2.273_193]]),
];

/// Index of refraction and extinction coefficient of a metal.
pub(super) fn by_name(name: &str) -> Option<[Vec3; 2]> {
    METALS.iter().find(|(metal, _)| *metal == name).map(|(_, numbers)| numbers.map(Vec3::from))
}

/// The name that scene files have for the metal with this index of refraction and this extinction coefficient, if it is one of those that have a name.
pub fn metal_name(numbers: [Vec3; 2]) -> Option<&'static str> {
    METALS.iter().find(|(_, metal)| metal.map(Vec3::from) == numbers).map(|(name, _)| *name)
}

/// All names.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    METALS.iter().map(|(name, _)| *name)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reflectance at normal incidence beside what the documentation of Filament ("Physically Based Rendering in Filament", base colours of metals) has, linear
    /// sRGB; the two average spectra in different ways.
    #[test]
    fn metals_have_their_colours() {
        for (name, colour) in [
            ("silver", [0.97, 0.96, 0.91]),
            ("aluminium", [0.91, 0.92, 0.92]),
            ("gold", [1.0, 0.78, 0.34]),
            ("copper", [0.97, 0.74, 0.62]),
        ] {
            let [eta, k] = by_name(name).unwrap();
            let (less, more) = (eta - 1.0, eta + 1.0);
            let reflectance = (less * less + k * k) / (more * more + k * k);
            assert!((reflectance - Vec3::from(colour)).abs().max_element() < 0.13, "{name}: {reflectance}");
            assert_eq!(metal_name([eta, k]), Some(name));
        }
        assert_eq!(names().count(), METALS.len());
    }
}
