//! Rough surfaces as many small smooth ones: Trowbridge and Reitz's distribution of their normals ("GGX": Walter et al., "Microfacet Models for
//! Refraction through Rough Surfaces", 2007) with Smith's masking (Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs",
//! JCGT 3(2), 2014). Directions are in the surface's frame, its normal +z; `wo` is above it.

use super::fresnel::reflect;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Widths of the distribution along x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ggx {
    /// Along x, above 0.
    pub x: f64,
    /// Along y, above 0.
    pub y: f64,
}

/// The value of a lobe of microfacets that reflect or transmit all, and what else one needs to know of it at a pair of directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Microfacet {
    /// Per steradian, without the cosine; of refraction as shares of energy, that is without the factor `1 / eta^2` to radiance.
    pub value: f64,
    /// Density of `wi`, per steradian, if the microfacet is chosen by [`Ggx::visible_normal`].
    pub pdf: f64,
    /// Cosine between `wo` and the microfacet's normal.
    pub cosine: f64,
}

impl Microfacet {
    /// There is no microfacet that would do it.
    pub const NONE: Microfacet = Microfacet { value: 0.0, pdf: 0.0, cosine: 1.0 };
}

impl Ggx {
    /// Density of normals over the area of the surface, per steradian: times the cosine it integrates to 1.
    pub fn density(&self, h: DVec3) -> f64 {
        let (x, y) = (h.x / self.x, h.y / self.y);
        let t = x * x + y * y + h.z * h.z;
        1.0 / (PI * self.x * self.y * t * t)
    }

    /// Smith's Lambda: by how much more microfacets there are that would be seen from `w` than are.
    pub fn lambda(&self, w: DVec3) -> f64 {
        let (x, y) = (self.x * w.x, self.y * w.y);
        0.5 * ((1.0 + (x * x + y * y) / (w.z * w.z)).sqrt() - 1.0)
    }

    /// The normal of a microfacet that is seen from `wo`, in proportion to how large it looks: density `G1(wo) max(wo . h, 0) D(h) / wo.z` (Heitz,
    /// "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018), by the spherical caps of Dupuy and Benyoub, "Sampling Visible GGX Normals with
    /// Spherical Caps", 2023.
    pub fn visible_normal(&self, wo: DVec3, u: f64, v: f64) -> DVec3 {
        let stretched = DVec3::new(wo.x * self.x, wo.y * self.y, wo.z).normalize();
        // Evenly over the part of the sphere that is reflected there by a hemisphere.
        let below = v * (1.0 + stretched.z);
        let (sin, cos) = (TAU * u).sin_cos();
        let side = (below * (2.0 - below)).max(0.0).sqrt();
        let h = DVec3::new(side * cos, side * sin, 1.0 - below) + stretched;
        DVec3::new(h.x * self.x, h.y * self.y, h.z).normalize()
    }

    /// The width of a distribution that is the same all around with the same mean square.
    pub fn mean_width(&self) -> f64 {
        if self.x == self.y { self.x } else { (0.5 * (self.x * self.x + self.y * self.y)).sqrt() }
    }

    /// Microfacets that reflect `wi` into `wo`, both above; masking and shadowing are correlated by height.
    pub fn reflection(&self, wo: DVec3, wi: DVec3) -> Microfacet {
        let h = (wo + wi).normalize();
        let (lambda_o, lambda_i) = (self.lambda(wo), self.lambda(wi));
        let d = self.density(h) / (4.0 * wo.z);
        Microfacet { value: d / (wi.z * (1.0 + lambda_o + lambda_i)), pdf: d / (1.0 + lambda_o), cosine: wo.dot(h) }
    }

    /// Microfacets that refract `wi`, below, into `wo`; `eta` is the index below over that above. Masking and shadowing are independent: they are on two sides.
    pub fn refraction(&self, wo: DVec3, wi: DVec3, eta: f64) -> Microfacet {
        let sum = wo + eta * wi;
        // The normal is in the medium of the lesser index.
        let h = (if sum.z < 0.0 { -sum } else { sum }).normalize_or_zero();
        let (cos_o, cos_i) = (wo.dot(h), wi.dot(h));
        if cos_o <= 0.0 || cos_i >= 0.0 {
            return Microfacet::NONE;
        }
        // How densely microfacets lie about `wi`.
        let jacobian = -cos_i * eta * eta / (cos_o + eta * cos_i).powi(2);
        let pdf = self.density(h) * cos_o * jacobian / (wo.z * (1.0 + self.lambda(wo)));
        Microfacet { value: pdf / (-wi.z * (1.0 + self.lambda(wi))), pdf, cosine: cos_o }
    }

    /// A direction from which microfacets reflect light into `wo`; zero if it would be below.
    pub fn reflected(&self, wo: DVec3, [u, v]: [f64; 2]) -> DVec3 {
        let wi = reflect(wo, self.visible_normal(wo, u, v));
        if wi.z > 0.0 { wi } else { DVec3::ZERO }
    }
}
