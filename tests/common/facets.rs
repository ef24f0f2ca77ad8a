//! Cells of the microfacets that are seen, in which a lobe of any width is as wide as a hemisphere; and surfaces over a grid to count in them.

use super::scenes::{physical_surfel, viewed_from};
use super::statistics::chi_square_against;
use glam::{DVec3, Vec3};
use luminaire::reference::fresnel::{reflect, refract};
use luminaire::reference::microfacet::Ggx;
use luminaire::reference::surfel::Surfel;
use luminaire::scene::{LEAST_ALPHA, Physical};
use std::f64::consts::TAU;

/// Cells of normals, stretched by the widths: even in the cosine and in the azimuth.
pub struct FacetCells {
    pub ggx: Ggx,
    pub wo: DVec3,
}

impl FacetCells {
    const ROWS: usize = 10;
    const COLUMNS: usize = 14;
    /// How many there are.
    pub const COUNT: usize = Self::ROWS * Self::COLUMNS;

    /// The cell of a normal.
    pub fn cell(&self, h: DVec3) -> usize {
        let stretched = DVec3::new(h.x / self.ggx.x, h.y / self.ggx.y, h.z).normalize();
        let turn = (stretched.y.atan2(stretched.x) / TAU).rem_euclid(1.0);
        let cell = |x: f64, n: usize| ((x * n as f64) as usize).min(n - 1);
        cell(stretched.z, Self::ROWS) * Self::COLUMNS + cell(turn, Self::COLUMNS)
    }

    /// Integrals over the cells, by the midpoint rule, of a density of normals per solid angle.
    pub fn integrate(&self, density: impl Fn(DVec3) -> f64) -> Vec<f64> {
        const PARTS: usize = 10;
        let (rows, columns) = (Self::ROWS * PARTS, Self::COLUMNS * PARTS);
        let mut cells = vec![0.0; Self::COUNT];
        for i in 0..rows {
            let z = (i as f64 + 0.5) / rows as f64;
            for j in 0..columns {
                let phi = TAU * (j as f64 + 0.5) / columns as f64;
                let side = (1.0 - z * z).sqrt();
                let h = DVec3::new(self.ggx.x * side * phi.cos(), self.ggx.y * side * phi.sin(), z);
                let solid_angle = self.ggx.x * self.ggx.y / h.length().powi(3) * TAU / (rows * columns) as f64;
                cells[i / PARTS * Self::COLUMNS + j / PARTS] += density(h.normalize()) * solid_angle;
            }
        }
        cells
    }
}

/// A surface, a side of it and a direction of view, of which all directions are chosen by microfacets or widely.
pub struct Sampled {
    pub name: String,
    pub physical: Physical,
    pub thin: bool,
    pub front: bool,
    pub wo: DVec3,
    /// Widths of the microfacets.
    pub ggx: Ggx,
}

impl Sampled {
    pub fn surfel(&self) -> Surfel {
        viewed_from(&physical_surfel(&self.physical, self.thin, self.front), self.wo)
    }

    /// How light that goes through is bent.
    fn eta(&self) -> f64 {
        let index = f64::from(self.physical.ior);
        if self.front { index } else { 1.0 / index }
    }

    /// The microfacet that sends `wi` to `wo`.
    fn normal(&self, wi: DVec3) -> DVec3 {
        let sum = match wi.z > 0.0 {
            true => self.wo + wi,
            false if self.thin => self.wo + wi * DVec3::new(1.0, 1.0, -1.0),
            false => self.wo + self.eta() * wi,
        };
        sum.normalize() * if sum.z < 0.0 { -1.0 } else { 1.0 }
    }

    /// `p` (Pearson) of directions against the density that the reference claims: cell by cell above the surface and below it, and those that went nowhere,
    /// which are zero, against what the density lacks to 1; and that.
    pub fn plausibility(&self, directions: impl ExactSizeIterator<Item = DVec3>) -> (f64, f64) {
        let n = directions.len() as f64;
        let lobes = self.surfel().lobes.expect("it scatters");
        let cells = FacetCells { ggx: self.ggx, wo: self.wo };
        let above = cells.integrate(|h| {
            let (cosine, wi) = (self.wo.dot(h), reflect(self.wo, h));
            if cosine > 0.0 && wi.z > 0.0 { lobes.value_and_pdf(wi).1 * 4.0 * cosine } else { 0.0 }
        });
        let below = cells.integrate(|h| {
            let cosine = self.wo.dot(h);
            if cosine <= 0.0 || self.physical.transmission == 0.0 {
                return 0.0;
            }
            if self.thin {
                let wi = reflect(self.wo, h);
                let through = wi * DVec3::new(1.0, 1.0, -1.0);
                return if wi.z > 0.0 { lobes.value_and_pdf(through).1 * 4.0 * cosine } else { 0.0 };
            }
            let eta = self.eta();
            let Some(wi) = refract(self.wo, h, eta).filter(|wi| wi.z < 0.0) else { return 0.0 };
            let behind = wi.dot(h);
            lobes.value_and_pdf(wi).1 * (cosine + eta * behind).powi(2) / (eta * eta * -behind)
        });
        let mut expected: Vec<f64> = above.into_iter().chain(below).map(|share| share * n).collect();
        let mass = expected.iter().sum::<f64>() / n;
        expected.push((1.0 - mass).max(0.0) * n);
        let mut counts = vec![0; expected.len()];
        for wi in directions {
            counts[match wi {
                DVec3::ZERO => 2 * FacetCells::COUNT,
                wi if wi.z > 0.0 => cells.cell(self.normal(wi)),
                wi => FacetCells::COUNT + cells.cell(self.normal(wi)),
            }] += 1;
        }
        (chi_square_against(&counts, &expected), mass)
    }
}

/// Every way to choose directions, over a grid: metals (brushed, too), rough glass of every index from both sides, frosted sheets, a coat alone, and mixtures.
pub fn grid(roughnesses: &[f32], degrees: &[f64]) -> Vec<Sampled> {
    let mut all = vec![];
    for &roughness in roughnesses {
        for &degrees in degrees {
            let (theta, phi) = (degrees.to_radians(), 0.7f64);
            let wo = DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
            let mut add = |name: String, physical: Physical, thin: bool, front: bool| {
                let strength = f64::from(physical.anisotropy).powi(2);
                let width = f64::from(roughness).powi(2);
                let ggx = Ggx { x: width + (1.0 - width) * strength, y: width.max(LEAST_ALPHA) };
                let name = format!("{name}, roughness {roughness}, {degrees} degrees");
                all.push(Sampled { name, physical, thin, front, wo, ggx });
            };
            let rough = Physical { roughness, ..Physical::default() };
            add("metal".into(), Physical { metallic: 1.0, ..rough.clone() }, false, true);
            for anisotropy in [0.3, 1.0] {
                // So dark that nothing is reflected twice: that would be a wide lobe, which is narrow in these cells.
                let dark = Physical { base_color: Vec3::ZERO, specular: 1e-3, anisotropy, ..rough.clone() };
                add(format!("brushed by {anisotropy}"), dark, false, true);
            }
            for ior in [1.05, 1.5, 2.4] {
                for front in [true, false] {
                    // What is bent less goes straight on.
                    if roughness * roughness * (ior - 1.0) > 2e-4 {
                        let side = if front { "outside" } else { "inside" };
                        let glass = Physical { ior, transmission: 1.0, ..rough.clone() };
                        add(format!("glass {ior} from {side}"), glass, false, front);
                    }
                }
            }
            add(
                "sheet".into(),
                Physical { transmission: 1.0, metallic: 0.2, base_color: Vec3::new(0.9, 0.5, 0.1), ..rough.clone() },
                true,
                true,
            );
            // Nothing below it but black.
            let coat = Physical {
                clearcoat: 1.0,
                clearcoat_roughness: roughness,
                base_color: Vec3::ZERO,
                specular: 0.0,
                ..rough.clone()
            };
            add("coat".into(), coat, false, true);
            // Lobes that are not narrow in these cells.
            if roughness > 0.3 {
                let mixture = Physical {
                    clearcoat: 0.7,
                    clearcoat_roughness: roughness,
                    metallic: 0.3,
                    transmission: 0.5,
                    ..rough
                };
                add("mixture".into(), mixture.clone(), false, true);
                add("mixture from inside".into(), mixture, false, false);
            }
        }
    }
    all
}
