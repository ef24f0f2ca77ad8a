//! A material while it is still being read: what nobody has said yet is `None`.

use super::Material;
use glam::Vec3;

/// The exponent of a glossy material that states none.
pub(super) const DEFAULT_EXPONENT: f32 = 10.0;
/// The diffuse albedo of a material that states no colour at all.
pub(super) const DEFAULT_LAMBERT: Vec3 = Vec3::splat(0.8);

/// What MTL and scene file say about a material.
#[derive(Debug, Clone, Default)]
pub(super) struct Draft {
    /// Its name.
    pub name: String,
    /// `Ka`.
    pub ambient: Option<Vec3>,
    /// `Kd`.
    pub diffuse: Option<Vec3>,
    /// `Ks`.
    pub glossy: Option<Vec3>,
    /// `Ns`.
    pub exponent: Option<f32>,
    /// `Ke`.
    pub emission: Option<Vec3>,
    /// What the MTL file asks for and nothing models, ready to be a warning.
    pub not_modelled: Option<String>,
}

impl Draft {
    /// A material of which nothing but the name is known.
    pub(super) fn named(name: &str) -> Self {
        Draft { name: name.to_owned(), ..Draft::default() }
    }

    /// Replaces the colours and the exponent that `other` states.
    pub(super) fn overlay(&mut self, other: &Draft) {
        self.ambient = other.ambient.or(self.ambient);
        self.diffuse = other.diffuse.or(self.diffuse);
        self.glossy = other.glossy.or(self.glossy);
        self.exponent = other.exponent.or(self.exponent);
        self.emission = other.emission.or(self.emission);
    }

    /// Fills in the defaults and scales down what would create energy; each such decision is a warning.
    ///
    /// A missing diffuse albedo is 0.8, but 0 where the material is described by a glossy albedo or an emission alone; a
    /// missing ambient albedo is the diffuse one.
    pub(super) fn finish(&self, warnings: &mut Vec<String>) -> Material {
        let name = &self.name;
        warnings.extend(self.not_modelled.clone());
        let mut glossy = self.glossy.unwrap_or(Vec3::ZERO);
        let other_colour = self.glossy.is_some() || self.emission.is_some();
        let mut lambert = self.diffuse.unwrap_or(if other_colour { Vec3::ZERO } else { DEFAULT_LAMBERT });
        let ambient = self.ambient.unwrap_or(lambert);
        if glossy != Vec3::ZERO && self.exponent.is_none() {
            warnings
                .push(format!("material `{name}` is glossy but states no exponent (Ns); {DEFAULT_EXPONENT} is used"));
        }
        let sum = (lambert + glossy).max_element();
        if sum > 1.0 {
            let mut factor = 1.0 / sum;
            while (lambert * factor + glossy * factor).max_element() > 1.0 {
                factor *= 1.0 - f32::EPSILON;
            }
            lambert *= factor;
            glossy *= factor;
            // Below that it is the rounding of the sum, which nobody needs to hear about.
            if sum > 1.000_01 {
                warnings.push(format!(
                    "material `{name}` would create energy: diffuse + glossy albedo reach {sum}; both are scaled by {factor:.4}"
                ));
            }
        }
        let exponent = self.exponent.unwrap_or(DEFAULT_EXPONENT);
        let emission = self.emission.unwrap_or(Vec3::ZERO);
        Material { name: name.clone(), ambient, lambert, glossy, exponent, emission, ..Material::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn albedos_never_exceed_one_after_scaling() {
        for i in 0..2000 {
            let x = 0.5 + i as f32 * 0.001_37;
            let draft = Draft {
                diffuse: Some(Vec3::new(x, 0.3, x * 0.7)),
                glossy: Some(Vec3::new(0.9, x * 1.9, 0.1)),
                ..Draft::named("m")
            };
            let material = draft.finish(&mut Vec::new());
            assert!((material.lambert + material.glossy).max_element() <= 1.0, "{material:?}");
        }
    }

    #[test]
    fn a_lamp_without_kd_is_black_and_an_empty_material_is_grey() {
        let mut warnings = Vec::new();
        assert_eq!(Draft::named("m").finish(&mut warnings).lambert, DEFAULT_LAMBERT);
        let lamp = Draft { emission: Some(Vec3::ONE), ..Draft::named("lamp") };
        assert_eq!(lamp.finish(&mut warnings).lambert, Vec3::ZERO);
        assert!(warnings.is_empty());
    }
}
