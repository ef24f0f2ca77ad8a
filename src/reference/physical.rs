//! The metallic-roughness surface: how its layers share the light, what each of them is worth at a pair of directions, and which way they send a path.
//!
//! From above: a coat, of which the rest of the light gets what it lets through; then a metal beside a dielectric, both of the same microfacets;
//! below the dielectric what it lets through is partly scattered by a Lambertian body, partly goes on. What microfacets send to each
//! other is not lost: of wide microfacets a lobe of its own gives it back (Kulla and Conty, "Revisiting Physically Based Shading at Imageworks", 2017), which of
//! narrow ones would lie near the horizon alone, where no path looks for it: they are scaled (Turquin, "Practical Multiple Scattering Compensation for Microfacet
//! Models", 2019). Both have the colour of later reflections. What goes through is scaled to all that is not reflected.
//!
//! Light may go either way where it is scattered by the body, and by microfacets but for that scale: one direction is worth more than the other by the ratio of
//! what is missing at them, at most. The coat takes its share at both directions; what is transmitted by `wo` alone.

use super::fresnel::{fresnel, fresnel_conductor, reflect, refract};
use super::microfacet::{Ggx, Microfacet};
use super::warp::{cosine_hemisphere, frame};
use crate::scene::albedo_table::{DielectricAlbedo, TABLE};
use crate::scene::brushed_table::BRUSHED;
use crate::scene::{COAT_INDEX, LEAST_ALPHA, Material, conductor_average};
use glam::{DMat3, DVec3};
use std::f64::consts::PI;

/// The covariance, over directions in proportion to their cosine, of what a smooth coat and a smooth dielectric of its index reflect above what they do at normal
/// incidence, `(F - F0) / (1 - F0)`; of other indices, and of rough ones, it is less.
pub const EDGE_COVARIANCE: f64 = 0.0117;
/// A share that is divided by is at least this.
pub const LEAST_SHARE: f64 = 1e-6;
/// Of a lobe of microfacets up to this width what they send to each other is added to their reflectance, ...
pub const NARROW: f64 = 0.04;
/// ... and from this one on it is a lobe of its own; in between both.
pub const WIDE: f64 = 0.25;
/// A cosine to the normal is at least this.
pub const LEAST_COSINE: f64 = 1e-6;

/// The numbers of [`Physical`](crate::scene::Physical) at a point, its maps and the colours of vertices included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhysicalSurface {
    /// Base colour.
    pub base: DVec3,
    /// Share of metal.
    pub metallic: f64,
    /// Perceptual roughness.
    pub roughness: f64,
    /// Strength of the anisotropy.
    pub anisotropy: f64,
    /// Unit vector in which the surface is rougher.
    pub tangent: DVec3,
    /// Index of refraction behind the outward normal; 0: infinite.
    pub ior: f64,
    /// Strength of the dielectric's reflection.
    pub specular: f64,
    /// Its tint.
    pub specular_color: DVec3,
    /// A metal's (eta, k), and its reflectance averaged over directions.
    pub conductor: Option<[DVec3; 3]>,
    /// Share of what enters the dielectric that goes through it.
    pub transmission: f64,
    /// Whether somebody may be inside: the surface is that of a body which transmits somewhere.
    pub body: bool,
    /// Absorption coefficient inside, per unit of length and channel.
    pub absorption: DVec3,
    /// Strength of the coat.
    pub clearcoat: f64,
    /// Its perceptual roughness.
    pub clearcoat_roughness: f64,
    /// Its unit normal, on the side of `wo`: maps that bend the surface's do not bend it. Zero: the surface's.
    pub coat_normal: DVec3,
}

impl PhysicalSurface {
    /// Of a material that has one: its own numbers, without maps and without a tangent.
    pub fn without_maps(material: &Material) -> Option<Self> {
        let p = material.physical.as_ref()?;
        let average = |[eta, k]: [DVec3; 2]| DVec3::from_array([0, 1, 2].map(|i| conductor_average(eta[i], k[i])));
        Some(PhysicalSurface {
            base: p.base_color.as_dvec3(),
            metallic: p.metallic.into(),
            roughness: p.roughness.into(),
            anisotropy: p.anisotropy.into(),
            tangent: DVec3::ZERO,
            ior: p.ior.into(),
            specular: p.specular.into(),
            specular_color: p.specular_color.as_dvec3(),
            conductor: p.conductor.map(|pair| {
                let [eta, k] = pair.map(|v| v.as_dvec3());
                [eta, k, average([eta, k])]
            }),
            transmission: p.transmission.into(),
            body: material.is_body(),
            absorption: p.absorption(),
            clearcoat: p.clearcoat.into(),
            clearcoat_roughness: p.clearcoat_roughness.into(),
            coat_normal: DVec3::ZERO,
        })
    }

    /// Whether anything is scattered in other ways than by impulses.
    pub fn scatters(&self) -> bool {
        let body = (1.0 - self.metallic) * (1.0 - self.transmits()) * self.base != DVec3::ZERO;
        let rough_coat = self.clearcoat > 0.0 && self.clearcoat_roughness.powi(2) >= LEAST_ALPHA;
        body || !self.is_smooth() || rough_coat
    }

    /// Whether light from the other side is scattered to this one, in other ways than by impulses.
    pub fn scatters_through(&self) -> bool {
        self.transmits() > 0.0 && self.metallic < 1.0 && !self.is_smooth()
    }

    /// Widths of the microfacets, along the tangent and across (`KHR_materials_anisotropy`).
    fn widths(&self) -> [f64; 2] {
        let width = self.roughness * self.roughness;
        [width + (1.0 - width) * self.anisotropy * self.anisotropy, width]
    }

    /// Whether they are so narrow that there are impulses in their place.
    fn is_smooth(&self) -> bool {
        self.widths()[0] < LEAST_ALPHA
    }

    /// The share of transmission: an infinite index lets nothing through.
    fn transmits(&self) -> f64 {
        if self.ior == 0.0 { 0.0 } else { self.transmission }
    }

    /// What the body behind the surface absorbs in a unit of length; of a sheet nothing.
    pub fn inner_absorption(&self) -> DVec3 {
        if self.body { self.absorption } else { DVec3::ZERO }
    }

    /// What the surface reflects and transmits of even light, about: the same for all directions.
    pub fn hemispherical_albedo(&self) -> DVec3 {
        self.smooth_albedo(TABLE.edge_average(0.0, self.index()), self.metal_average(), coat_average())
    }

    /// Albedo as from straight above.
    pub fn normal_albedo(&self) -> DVec3 {
        self.smooth_albedo(0.0, self.metal(1.0), fresnel(COAT_INDEX, 1.0))
    }

    /// Albedo of the layers of a smooth surface, by what of each is reflected: of the dielectric by `(F - F0) / (1 - F0)`.
    fn smooth_albedo(&self, edge: f64, metal: DVec3, coat: f64) -> DVec3 {
        let f0 = if self.ior == 0.0 { 1.0 } else { fresnel(self.ior, 1.0) };
        let reflected = edge_colour(self.normal_reflectance(), self.specular, f0, edge);
        let dielectric = reflected + (1.0 - reflected) * self.base;
        let base = self.metallic * metal + (1.0 - self.metallic) * dielectric;
        let coat = self.clearcoat * coat;
        coat + (1.0 - coat) * base
    }

    /// The index by which Fresnel's equations go; they have no infinite one, which does not matter where all is reflected anyway.
    fn index(&self) -> f64 {
        if self.ior == 0.0 { COAT_INDEX } else { self.ior }
    }

    /// The dielectric's reflectance at normal incidence, from outside.
    fn normal_reflectance(&self) -> DVec3 {
        let f0 = if self.ior == 0.0 { 1.0 } else { fresnel(self.ior, 1.0) };
        (f0 * self.specular_color).min(DVec3::ONE) * self.specular
    }

    /// The metal's reflectance.
    fn metal(&self, cosine: f64) -> DVec3 {
        match self.conductor {
            Some([eta, k, _]) => fresnel_conductor([eta, k], cosine),
            None => self.base + (1.0 - self.base) * (1.0 - cosine).max(0.0).powi(5),
        }
    }

    /// The same, averaged over directions in proportion to their cosine.
    fn metal_average(&self) -> DVec3 {
        match self.conductor {
            Some([_, _, average]) => average,
            None => self.base + (1.0 - self.base) / 21.0,
        }
    }
}

/// A dielectric's reflectance between that at normal incidence, `f0`, and that at grazing, by `edge = (F - normal) / (1 - normal)`. Unpolarised light is
/// reflected less than at normal incidence if the index is above `2 + sqrt(3)`: then by the share of `F`.
fn edge_colour(f0: DVec3, f90: f64, normal: f64, edge: f64) -> DVec3 {
    if edge < 0.0 { f0 * (1.0 + edge * (1.0 - normal) / normal) } else { f0 + (f90 - f0) * edge }
}

/// The dielectric at one side of a surface: what it reflects.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Dielectric {
    /// Index of refraction behind the surface over that in front of it, as seen from `wo`.
    eta: f64,
    /// The larger of that and its inverse, by which the table goes.
    index: f64,
    /// Whether `wo` is inside of a body.
    inside: bool,
    /// Reflectance at normal incidence, and at grazing; from outside.
    f0: DVec3,
    f90: f64,
    /// Fresnel's reflectance at normal incidence.
    normal: f64,
    /// Width of the microfacets; 0: a smooth surface.
    alpha: f64,
    /// The colour of what is reflected more than once.
    multiple: DVec3,
}

impl Dielectric {
    /// Reflectance of a microfacet.
    fn reflectance(&self, cosine: f64) -> DVec3 {
        let f = fresnel(self.eta, cosine.min(1.0));
        if self.inside {
            return DVec3::splat(f);
        }
        self.edge_colour((f - self.normal) / (1.0 - self.normal))
    }

    fn edge_colour(&self, edge: f64) -> DVec3 {
        edge_colour(self.f0, self.f90, self.normal, edge)
    }

    /// What is missing at a cosine.
    fn missing(&self, cosine: f64) -> f64 {
        if self.alpha == 0.0 { 0.0 } else { TABLE.missing(cosine, self.alpha) }
    }

    /// The share that the surface reflects in all, seen at a cosine, where this becomes of light and this much is missing; from inside only about.
    fn albedo(&self, cosine: f64, share: &DielectricAlbedo, missing: f64) -> DVec3 {
        if self.alpha == 0.0 {
            return self.reflectance(cosine);
        }
        if self.inside {
            return DVec3::splat(1.0 - share.transmitted_inside / share.inside);
        }
        (1.0 - missing) * self.edge_colour(share.edge) + missing * self.multiple
    }

    /// The mean of that over directions in proportion to their cosine; from outside.
    fn average(&self) -> DVec3 {
        let missing = if self.alpha == 0.0 { 0.0 } else { TABLE.missing_average(self.alpha) };
        let edge = TABLE.edge_average(self.alpha, self.index);
        (1.0 - missing) * self.edge_colour(edge / (1.0 - missing)) + missing * self.multiple
    }
}

/// The colour of light that has met microfacets of this mean reflectance more than once, when it leaves them (Kulla and Conty).
fn multiple_colour(average: DVec3, missing: f64) -> DVec3 {
    average * average * (1.0 - missing) / (1.0 - average * missing)
}

/// The coat at one side of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Coat {
    /// 0: there is none.
    strength: f64,
    /// Width of its microfacets.
    alpha: f64,
    /// From the coat's frame, its normal +z, to that of the surface.
    to_surface: DMat3,
    /// The direction that light goes to, in the coat's frame.
    wo: DVec3,
}

impl Coat {
    /// Whether it is an impulse.
    fn is_smooth(&self) -> bool {
        self.alpha < LEAST_ALPHA
    }

    /// The share that it reflects, seen at a cosine to its normal.
    fn albedo(&self, cosine: f64) -> f64 {
        if self.strength == 0.0 { 0.0 } else { self.strength * coat_albedo(cosine, self.alpha) }
    }

    /// The share that it lets through on the way from a direction above the surface.
    fn passed(&self, wi: DVec3) -> f64 {
        1.0 - self.albedo(self.cosine(wi))
    }

    fn cosine(&self, wi: DVec3) -> f64 {
        self.to_surface.z_axis.dot(wi).clamp(LEAST_COSINE, 1.0)
    }

    /// The mean of the share that it lets through, over directions in proportion to their cosine.
    fn average_passed(&self) -> f64 {
        if self.strength == 0.0 { 1.0 } else { 1.0 - self.strength * coat_mean(self.alpha) }
    }
}

/// Share of the light that microfacets which reflect all do not send away at once towards a direction above them.
fn missing_towards(ggx: &Ggx, w: DVec3) -> f64 {
    if ggx.x == ggx.y { TABLE.missing(w.z.min(1.0), ggx.x) } else { BRUSHED.missing([ggx.x, ggx.y], w) }
}

/// The mean of that over directions in proportion to their cosine.
fn missing_average_of(ggx: &Ggx) -> f64 {
    if ggx.x == ggx.y { TABLE.missing_average(ggx.x) } else { BRUSHED.missing_average([ggx.x, ggx.y]) }
}

/// What a surface does with light towards one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobes {
    surface: PhysicalSurface,
    /// From the surface's frame, its shading normal +z, to the world.
    to_world: DMat3,
    /// The direction, in that frame.
    wo: DVec3,
    ggx: Ggx,
    coat: Coat,
    dielectric: Dielectric,
    /// What the coat lets through, towards `wo`.
    passed: f64,
    /// Of Lambert's lobe, but for what is reflected of `wi`.
    diffuse: DVec3,
    /// Of the lobe of later reflections, but for what is missing at `wi`.
    multiple: DVec3,
    /// What of later reflections is added to the reflectance of microfacets instead.
    again: DVec3,
    /// Factor to what microfacets of the dielectric reflect.
    reflected: f64,
    /// Factor to what they let through; zero where nothing, or where it is an impulse.
    transmitted: DVec3,
    /// Whether what is transmitted goes on unscattered.
    straight: bool,
    /// Whether it does so through microfacets that are not smooth: they and what they let through go by the reflectance at `wo`, and so add up to all.
    flat: bool,
    /// Albedos of impulses.
    impulse_reflection: DVec3,
    impulse_transmission: DVec3,
    /// Albedos, about, of what is scattered: cosine lobes, microfacets, coat.
    shares: [f64; 3],
}

/// The average of the channels.
fn mean(colour: DVec3) -> f64 {
    colour.element_sum() / 3.0
}

impl Lobes {
    /// The lobes of a surface with this shading normal towards `wo`, which is above it; `front`: on the outward side.
    pub fn new(surface: &PhysicalSurface, normal: DVec3, front: bool, wo: DVec3) -> Self {
        let p = *surface;
        let to_world = axes(normal, p.tangent, p.anisotropy != 0.0);
        let mut wo = to_world.transpose() * wo;
        wo.z = wo.z.max(LEAST_COSINE);
        let cosine = wo.z.min(1.0);
        let [along, across] = p.widths();
        let ggx = Ggx { x: along, y: across.max(LEAST_ALPHA) };
        let smooth = p.is_smooth();
        let alpha = if smooth { 0.0 } else { ggx.mean_width() };
        let missing = if smooth { 0.0 } else { missing_towards(&ggx, wo) };
        let missing_average = if smooth { 0.0 } else { missing_average_of(&ggx) };

        let inside = p.body && !front;
        let index = p.index();
        // What is hardly bent is hardly spread.
        let straight = smooth || (p.body && along * (index - 1.0) < LEAST_ALPHA);
        let flat = straight && !smooth;
        let (f0, f90, normal_reflectance) = (p.normal_reflectance(), p.specular, fresnel(index, 1.0));
        let average = edge_colour(f0, f90, normal_reflectance, TABLE.edge_average(0.0, index));
        let multiple = if flat { DVec3::ZERO } else { multiple_colour(average, missing_average) };
        let eta = if inside { 1.0 / index } else { index };
        let dielectric_alpha = if flat { 0.0 } else { alpha };
        let dielectric =
            Dielectric { eta, index, inside, f0, f90, normal: normal_reflectance, alpha: dielectric_alpha, multiple };
        let brushed = !smooth && ggx.x != ggx.y && p.metallic < 1.0;
        let share = match brushed {
            // Nothing goes by the tables.
            _ if straight => DielectricAlbedo::default(),
            true => BRUSHED.dielectric([ggx.x, ggx.y], wo, index),
            false => TABLE.dielectric(cosine, alpha, index),
        };
        let reflects = dielectric.albedo(cosine, &share, missing);

        let coated = p.clearcoat > 0.0 && (front || !p.body);
        let coat_normal = if p.coat_normal == DVec3::ZERO { DVec3::Z } else { to_world.transpose() * p.coat_normal };
        let to_surface =
            if p.coat_normal == DVec3::ZERO { DMat3::IDENTITY } else { axes(coat_normal, DVec3::ZERO, false) };
        let mut coat = Coat {
            strength: if coated { p.clearcoat } else { 0.0 },
            alpha: p.clearcoat_roughness * p.clearcoat_roughness,
            to_surface,
            wo: to_surface.transpose() * wo,
        };
        coat.wo.z = coat.wo.z.max(LEAST_COSINE);
        let coat_share = coat.albedo(coat.wo.z.min(1.0));
        let passed = 1.0 - coat_share;

        let insulator = (1.0 - p.metallic) * passed;
        let transmission = p.transmits();
        let entered = DVec3::ONE - reflects;
        // From inside there is nothing between: either the scattering body, or the boundary.
        let body = insulator * (1.0 - transmission) * p.base * if inside { DVec3::ONE } else { entered };
        // What the layers let in on average: both let in less near grazing, so that the mean of the product is more than the product of the means.
        let common = coat.strength * (1.0 - fresnel(COAT_INDEX, 1.0)) * (f90 - f0).max(DVec3::ZERO) * EDGE_COVARIANCE;
        let diffuse = match inside {
            true => body / PI,
            false => {
                let let_in = (1.0 - dielectric.average()) * coat.average_passed() + common;
                body / (PI * let_in.max(DVec3::splat(LEAST_SHARE)))
            }
        };
        let metal_multiple = multiple_colour(p.metal_average(), missing_average);
        let dielectric_multiple = if inside { DVec3::ZERO } else { multiple };
        let multiple = missing * (p.metallic * metal_multiple + (1.0 - p.metallic) * dielectric_multiple);
        let wide = ((alpha - NARROW) / (WIDE - NARROW)).clamp(0.0, 1.0);
        let of_boundary = if inside { transmission } else { 1.0 };
        let reflected = match inside {
            _ if flat => of_boundary / (1.0 - missing),
            true if !smooth => of_boundary / ((1.0 - missing) * share.inside),
            _ => of_boundary,
        };
        let through = insulator * transmission * p.base * entered;
        let transmitted = if straight {
            DVec3::ZERO
        } else if !p.body {
            through / (1.0 - missing)
        } else if inside {
            insulator * p.base * reflected
        } else {
            through / ((1.0 - missing) * share.transmitted).max(LEAST_SHARE)
        };
        let metal = (1.0 - missing) * p.metal(cosine) + missing * metal_multiple;
        let mirrored = passed * (p.metallic * metal + (1.0 - p.metallic) * of_boundary * reflects);
        let widely = passed * wide * multiple;
        let coat_colour = DVec3::splat(coat_share);
        let impulse = |colour: DVec3, is: bool| if is { colour } else { DVec3::ZERO };
        let scattered = |colour: DVec3, is: bool| mean(impulse(colour, is));
        Lobes {
            surface: p,
            to_world,
            wo,
            ggx,
            coat,
            dielectric,
            passed,
            diffuse,
            multiple: if wide > 0.0 { widely / (PI * missing_average) } else { DVec3::ZERO },
            again: (1.0 - wide) * multiple / (1.0 - missing),
            reflected,
            transmitted,
            straight,
            flat,
            impulse_reflection: impulse(mirrored, smooth) + impulse(coat_colour, coat.is_smooth()),
            impulse_transmission: impulse(through, straight),
            shares: [
                mean(body + widely),
                scattered(mirrored - widely, !smooth) + scattered(through, !straight),
                scattered(coat_colour, !coat.is_smooth()),
            ],
        }
    }

    /// The surface that they are of.
    pub fn surface(&self) -> &PhysicalSurface {
        &self.surface
    }

    /// Albedos of the reflection and the transmission by impulses.
    pub fn impulses(&self) -> [DVec3; 2] {
        [self.impulse_reflection, self.impulse_transmission]
    }

    /// Whether light goes through unscattered, from some side.
    pub fn is_clear(&self) -> bool {
        let p = &self.surface;
        self.straight && (1.0 - p.metallic) * p.transmits() * p.base != DVec3::ZERO
    }

    /// The lobes of the same surface about another normal, the coat's, too.
    pub fn about(&self, normal: DVec3, front: bool, wo: DVec3) -> Self {
        Lobes::new(&PhysicalSurface { coat_normal: DVec3::ZERO, ..self.surface }, normal, front, wo)
    }

    /// The normal, in the world, about which there are impulses. One of a coat alone goes by the coat's.
    pub fn impulse_normal(&self) -> DVec3 {
        let of_coat = self.surface.coat_normal != DVec3::ZERO && !self.straight && !self.surface.is_smooth();
        self.to_world * if of_coat { self.coat.to_surface.z_axis } else { DVec3::Z }
    }

    /// By how much the index is greater behind the surface, for what goes through.
    pub fn bend(&self) -> f64 {
        if self.surface.body { self.dielectric.eta } else { 1.0 }
    }

    /// The albedo of what is scattered, about.
    pub fn scattered_albedo(&self) -> f64 {
        self.shares.iter().sum()
    }

    /// The scattering function without the cosine, per steradian, and the density with which [`Lobes::direction`] gives `wi`, which is in the world.
    pub fn value_and_pdf(&self, wi: DVec3) -> (DVec3, f64) {
        let wi = self.to_world.transpose() * wi;
        let [cosine_share, facet_share, coat_share] = self.shares;
        let all = self.scattered_albedo();
        if all == 0.0 || wi.z == 0.0 {
            return (DVec3::ZERO, 0.0);
        }
        if wi.z < 0.0 {
            if !self.scatters_through() {
                return (DVec3::ZERO, 0.0);
            }
            let (through, eta2) = if self.surface.body {
                let eta = self.dielectric.eta;
                (self.ggx.refraction(self.wo, wi, eta), eta * eta)
            } else {
                (self.ggx.reflection(self.wo, DVec3::new(wi.x, wi.y, -wi.z)), 1.0)
            };
            let [_, transmits] = self.facet(through.cosine);
            return (
                transmits * through.value / eta2,
                facet_share * (1.0 - self.reflected_share(through.cosine)) / all * through.pdf,
            );
        }
        let cosine = wi.z.min(1.0);
        let missing = self.dielectric.missing(cosine);
        // Of what scatters widely the coat takes its share both ways, of a reflection the greater one.
        let entered = self.coat.passed(wi);
        let mut value = self.diffuse;
        if !self.dielectric.inside && value != DVec3::ZERO {
            let share = TABLE.dielectric(cosine, self.dielectric.alpha, self.dielectric.index);
            value *= entered * (DVec3::ONE - self.dielectric.albedo(cosine, &share, missing));
        }
        let mut pdf = cosine_share * wi.z / PI;
        if !self.surface.is_smooth() {
            let facet = self.ggx.reflection(self.wo, wi);
            let [reflects, _] = self.facet(facet.cosine);
            let absent = missing_towards(&self.ggx, wi);
            value += (entered / self.passed).min(1.0) * (facet.value * reflects + self.multiple * absent);
            pdf += facet_share * self.reflected_share(facet.cosine) * facet.pdf;
        }
        if coat_share > 0.0 {
            let Coat { strength, alpha, wo, .. } = self.coat;
            let above = self.coat.to_surface.transpose() * wi;
            if above.z > 0.0 {
                let Microfacet { value: once, pdf: density, cosine: to_facet } = self.coat_ggx().reflection(wo, above);
                let missing = TABLE.missing(wo.z.min(1.0), alpha);
                let again = coat_multiple(alpha) * missing / (1.0 - missing);
                // Light counts by the cosine to the coat's own normal.
                value += strength * (fresnel(COAT_INDEX, to_facet.min(1.0)) + again) * once * (above.z / wi.z);
                pdf += coat_share * density;
            }
        }
        (value, pdf / all)
    }

    /// A direction, in the world: two numbers choose it within a lobe, which `lobe` chooses, all in [0, 1). Zero where the lobe sends nothing.
    pub fn direction(&self, u: [f64; 2], lobe: f64) -> DVec3 {
        let [cosine, facets, _] = self.shares;
        let at = lobe * self.scattered_albedo();
        let wi = if at < cosine {
            cosine_hemisphere(DVec3::Z, u[0], u[1])
        } else if at < cosine + facets {
            let h = self.ggx.visible_normal(self.wo, u[0], u[1]);
            let mirrored = reflect(self.wo, h);
            let (wi, side) = if (at - cosine) / facets < self.reflected_share(self.wo.dot(h)) {
                (mirrored, 1.0)
            } else if self.surface.body {
                (refract(self.wo, h, self.dielectric.eta).unwrap_or(DVec3::ZERO), -1.0)
            } else {
                (mirrored * DVec3::new(1.0, 1.0, -1.0), -1.0)
            };
            if wi.z * side > 0.0 { wi } else { DVec3::ZERO }
        } else {
            let wi = self.coat.to_surface * self.coat_ggx().reflected(self.coat.wo, u);
            if wi.z > 0.0 { wi } else { DVec3::ZERO }
        };
        self.to_world * wi
    }

    fn coat_ggx(&self) -> Ggx {
        Ggx { x: self.coat.alpha, y: self.coat.alpha }
    }

    /// Colours of what a microfacet that is seen at a cosine reflects and lets through.
    fn facet(&self, cosine: f64) -> [DVec3; 2] {
        let p = &self.surface;
        let metal = p.metallic * p.metal(cosine);
        let of_dielectric = if self.flat { self.wo.z } else { cosine };
        let dielectric = (1.0 - p.metallic) * self.reflected * self.dielectric.reflectance(of_dielectric);
        let passes = if p.body { 1.0 - fresnel(self.dielectric.eta, cosine.min(1.0)) } else { 1.0 };
        [self.passed * (metal + dielectric + self.again), self.transmitted * passes]
    }

    /// The probability with which a path that such a microfacet was chosen for is reflected.
    fn reflected_share(&self, cosine: f64) -> f64 {
        let [reflects, transmits] = self.facet(cosine).map(mean);
        if transmits > 0.0 { reflects / (reflects + transmits) } else { 1.0 }
    }

    /// Whether light from below is scattered here.
    pub fn scatters_through(&self) -> bool {
        self.transmitted != DVec3::ZERO
    }

    /// Where impulses go about the world's unit vector `normal`: reflected, and transmitted, which is zero if nothing is.
    pub fn impulse_directions(&self, normal: DVec3, wo: DVec3) -> [DVec3; 2] {
        let transmitted = if self.surface.body { refract(wo, normal, self.dielectric.eta) } else { Some(-wo) };
        [reflect(wo, normal), transmitted.unwrap_or(DVec3::ZERO)]
    }
}

/// What a coat reflects in all, seen at a cosine.
fn coat_albedo(cosine: f64, alpha: f64) -> f64 {
    if alpha < LEAST_ALPHA {
        return fresnel(COAT_INDEX, cosine);
    }
    let missing = TABLE.missing(cosine, alpha);
    let f0 = fresnel(COAT_INDEX, 1.0);
    let edge = TABLE.dielectric(cosine, alpha, COAT_INDEX).edge;
    (1.0 - missing) * (f0 + (1.0 - f0) * edge) + missing * coat_multiple(alpha)
}

/// The mean of that over directions in proportion to their cosine.
fn coat_mean(alpha: f64) -> f64 {
    if alpha < LEAST_ALPHA {
        return coat_average();
    }
    let missing = TABLE.missing_average(alpha);
    let f0 = fresnel(COAT_INDEX, 1.0);
    let edge = TABLE.edge_average(alpha, COAT_INDEX);
    (1.0 - missing) * f0 + (1.0 - f0) * edge + missing * coat_multiple(alpha)
}

/// Of what a coat reflects more than once, the share that leaves it.
fn coat_multiple(alpha: f64) -> f64 {
    multiple_colour(DVec3::splat(coat_average()), TABLE.missing_average(alpha)).x
}

/// What a smooth coat reflects of even light.
fn coat_average() -> f64 {
    let f0 = fresnel(COAT_INDEX, 1.0);
    f0 + (1.0 - f0) * TABLE.edge_average(0.0, COAT_INDEX)
}

/// The frame about a normal: x along the tangent where it matters, and where there is one.
fn axes(normal: DVec3, tangent: DVec3, anisotropic: bool) -> DMat3 {
    let across = tangent - normal * normal.dot(tangent);
    if anisotropic && across.length_squared() > 1e-12 {
        let x = across.normalize();
        return DMat3::from_cols(x, normal.cross(x), normal);
    }
    let (x, y) = frame(normal);
    DMat3::from_cols(x, y, normal)
}
