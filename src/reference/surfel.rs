//! The surface element: everything that shading needs to know about a point on a surface.

use super::hit::{Hit, interpolate, texture_coordinates, vertex_colour};
use super::normal_map::{Tangent, guarded_normal};
use super::physical::{Lobes, PhysicalSurface};
use super::prepared_scene::Reference;
use super::rounding::gamma;
use crate::scene::outward;
use glam::{DVec2, DVec3, Vec3};

/// A surface element, seen from the direction `wo` (slide "Surface Element Class"); textures are already in its numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surfel {
    /// The surface it is a part of: indices of the object, and of the triangle in its mesh.
    pub owner: [u32; 2],
    /// World position.
    pub position: DVec3,
    /// How far `position` may be from the triangle's plane through rounding, along each axis.
    pub position_error: DVec3,
    /// Unit normal of the triangle, on the side of `wo`.
    pub geometric_normal: DVec3,
    /// Unit normal interpolated from the vertices where there are any, on the side of `geometric_normal` and of `wo`.
    pub shading_normal: DVec3,
    /// Where the texture's u grows, beside the shading normal; none where the material does not ask for it, or the mesh has none.
    pub tangent: Option<Tangent>,
    /// Where the terminator is smoothed: the interpolated normal that parts above from below in place of the triangle's.
    pub horizon: Option<DVec3>,
    /// Where the terminator is smoothed: by how much `position` was moved off the triangle.
    pub lift: DVec3,
    /// Texture coordinates; 0 where there are none.
    pub uv: DVec2,
    /// Whether `wo` is on the outward side.
    pub front: bool,
    /// Emitted radiance.
    pub emission: DVec3,
    /// Albedo for the ambient term.
    pub ambient: DVec3,
    /// Diffuse albedo.
    pub lambert: DVec3,
    /// Glossy albedo at normal incidence.
    pub glossy: DVec3,
    /// Blinn-Phong exponent.
    pub exponent: f64,
    /// Albedo of the impulse reflection, Fresnel aside.
    pub reflection: DVec3,
    /// Albedo of the impulse transmission, Fresnel aside.
    pub transmission: DVec3,
    /// Index of refraction inside over that outside; none: a mirror without Fresnel.
    pub eta: Option<f64>,
    /// Whether it is both sides of a sheet at once.
    pub thin: bool,
    /// [`coat_transmittance`](crate::scene::coat_transmittance) of `eta`, where there is a coated base.
    pub coat_transmittance: f64,
    /// Probability of going on by an impulse, if the material states one.
    pub impulse_probability: Option<f64>,
    /// The lobes towards `wo` of the metallic-roughness surface that scatters in place of all these albedos, if it is one.
    pub lobes: Option<Lobes>,
}

impl Reference {
    /// The surfel at a hit, seen from the unit direction `wo`.
    pub fn surfel(&self, hit: &Hit, wo: DVec3) -> Surfel {
        let corners = self.corners(hit.object, hit.triangle);
        let [b1, b2] = hit.barycentrics;
        let weights = [1.0 - b1 - b2, b1, b2];
        let position = interpolate(weights, corners);
        // The plane is that of the corners that were hit. It equals the object-space plane under the inverse transpose.
        let [a, b, c] = corners;
        let geometric_normal = facing((b - a).cross(c - a).normalize_or_zero(), wo);

        let object = &self.scene.objects[hit.object as usize];
        let mesh = &self.scene.meshes[object.mesh as usize];
        let triangle = &mesh.triangles[hit.triangle as usize];
        let normal_to_world = self.instances[hit.object as usize].normal_to_world;
        let front = self.outward(hit).dot(geometric_normal) >= 0.0;
        let mut shading_normal = geometric_normal;
        if !mesh.normals.is_empty() {
            let normals = triangle.vertices.map(|v| mesh.normals[v as usize]);
            if normals.iter().all(|n| *n != Vec3::ZERO) {
                let interpolated = normal_to_world * interpolate(weights, normals.map(|n| n.as_dvec3()));
                let n = facing(interpolated.normalize_or_zero(), geometric_normal);
                if n.dot(wo) > 0.0 {
                    shading_normal = n;
                }
            }
        }
        let index = self.material_index(hit.object, hit.triangle) as usize;
        let material = &self.scene.materials[index];
        let (mut horizon, mut lift) = (None, DVec3::ZERO);
        // What lets light through has no side from which alone it is lit.
        let smooth_terminator = self.scene.integrator.estimator().smooth_terminator && !material.transmits();
        if smooth_terminator && shading_normal != geometric_normal {
            let normals = triangle.vertices.map(|v| mesh.normals[v as usize].as_dvec3());
            let normals = normals.map(|n| facing((normal_to_world * n).normalize_or_zero(), shading_normal));
            let up = terminator_lift(position, corners, normals, weights);
            // From no higher than rounding, as where the normals lean inwards, rays below the triangle's plane would start behind it.
            if up.dot(geometric_normal) > 2.0 * position_error(corners).dot(geometric_normal.abs()) {
                (horizon, lift) = (Some(shading_normal), up);
            }
        }
        let uv = texture_coordinates(mesh, triangle, weights);
        let map = |map: Option<u32>| self.map(map, uv).truncate();
        let outwards = if front { 1.0 } else { -1.0 };
        let unbent = shading_normal;
        let mut outward_normal = outwards * shading_normal;
        let mut tangent = match material.needs_tangents() {
            true => self.tangent(hit.object, hit.triangle, weights, outward_normal),
            false => None,
        };
        if material.bends_normal() {
            let bent = self.mapped_normal(material, (mesh, triangle, corners), uv, outward_normal, tangent);
            shading_normal = guarded_normal(geometric_normal, wo, outwards * bent);
            outward_normal = outwards * shading_normal;
            tangent = tangent.and_then(|tangent| tangent.beside(outward_normal));
        }
        let colour = vertex_colour(mesh, triangle, weights);
        let physical = self.physical_surface(index, uv, colour, tangent, outward_normal, unbent);
        Surfel {
            owner: [hit.object, hit.triangle],
            position: position + lift,
            position_error: position_error(corners),
            geometric_normal,
            shading_normal,
            tangent,
            horizon,
            lift,
            uv,
            front,
            emission: if front || !material.one_sided {
                material.emission.as_dvec3() * map(material.maps.emission)
            } else {
                DVec3::ZERO
            },
            ambient: material.ambient.as_dvec3() * map(material.maps.ambient) * colour,
            lambert: material.lambert.as_dvec3() * map(material.maps.lambert) * colour,
            glossy: material.glossy.as_dvec3() * map(material.maps.glossy),
            exponent: material.exponent.into(),
            reflection: material.reflection.as_dvec3(),
            transmission: if material.eta.is_some() { material.transmission.as_dvec3() } else { DVec3::ZERO },
            eta: material.eta.map(f64::from),
            thin: material.is_sheet(),
            coat_transmittance: self.coats[index],
            impulse_probability: material.impulse_probability.map(f64::from),
            lobes: physical.map(|surface| Lobes::new(&surface, shading_normal, front, wo)),
        }
    }
}

impl Reference {
    /// Across the outward side of what was hit, of any length. What is outside in object space stays outside in an instance that mirrors.
    pub(super) fn outward(&self, hit: &Hit) -> DVec3 {
        let mesh = &self.scene.meshes[self.scene.objects[hit.object as usize].mesh as usize];
        let normal_to_world = self.instances[hit.object as usize].normal_to_world;
        normal_to_world * outward(mesh, &mesh.triangles[hit.triangle as usize])
    }
}

impl Surfel {
    /// Whether a direction is on the side of `wo`, of the triangle and of the shading normal's plane.
    pub fn is_above(&self, wi: DVec3) -> bool {
        self.horizon().dot(wi) > 0.0 && self.shading_normal.dot(wi) > 0.0
    }

    /// The normal of the plane above which there is light: the triangle's, unless the terminator is smoothed.
    fn horizon(&self) -> DVec3 {
        self.horizon.unwrap_or(self.geometric_normal)
    }

    /// The metallic-roughness surface, if it is one.
    pub fn physical(&self) -> Option<&PhysicalSurface> {
        self.lobes.as_ref().map(Lobes::surface)
    }

    /// Whether a direction is on one side of both the triangle and the shading normal's plane.
    pub fn is_on_one_side(&self, wi: DVec3) -> bool {
        self.horizon().dot(wi) * self.shading_normal.dot(wi) > 0.0
    }

    /// The cosine by which light from a direction counts.
    pub fn cosine(&self, wi: DVec3) -> f64 {
        self.shading_normal.dot(wi).abs()
    }

    /// What a choice of luminaires has to know of the receiver: the shading normal, of length 2 if light from both of its sides is scattered.
    pub fn receiver(&self) -> DVec3 {
        let both = self.physical().is_some_and(PhysicalSurface::scatters_through);
        if both { 2.0 * self.shading_normal } else { self.shading_normal }
    }

    /// What the body absorbs, in a unit of length, into which a ray leaves in this direction.
    pub fn inner_absorption(&self, direction: DVec3) -> DVec3 {
        let inwards = (self.geometric_normal.dot(direction) < 0.0) == self.front;
        self.physical().filter(|_| inwards).map_or(DVec3::ZERO, PhysicalSurface::inner_absorption)
    }

    /// By how much more a unit of what comes from `wi` is diluted than shares of energy are: `eta^2` of what is refracted.
    pub fn dilution(&self, wi: DVec3) -> f64 {
        if self.is_above(wi) { 1.0 } else { self.lobes.as_ref().map_or(1.0, |lobes| lobes.bend().powi(2)) }
    }

    /// Whether what scatters lies under a smooth dielectric ([`crate::scene::Material::is_coated`]).
    pub fn is_coated(&self) -> bool {
        self.eta.is_some() && self.transmission == DVec3::ZERO && self.reflection != DVec3::ZERO && self.scatters()
    }

    /// Where a ray that leaves in `direction` starts: far enough from the triangle's plane not to hit it again.
    pub fn offset_ray_origin(&self, direction: DVec3) -> DVec3 {
        offset_ray_origin(self.position, self.position_error, self.geometric_normal, direction)
    }
}

/// How far a point of a triangle is below the surface that its vertex normals mean (Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021): the weighted
/// mean of its distances to the planes across the normals at the corners, along these; those above which it stands do not count.
fn terminator_lift(p: DVec3, corners: [DVec3; 3], normals: [DVec3; 3], weights: [f64; 3]) -> DVec3 {
    let to_plane = |i: usize| normals[i] * (corners[i] - p).dot(normals[i]).max(0.0);
    interpolate(weights, [to_plane(0), to_plane(1), to_plane(2)])
}

/// Bounds the rounding error of a point `b0 a + b1 b + b2 c` of a triangle, along each axis. The weights add up to 1, so
/// no partial sum exceeds the largest corner; it passes six roundings, and `b0 = 1 - b1 - b2` two more.
pub(super) fn position_error(corners: [DVec3; 3]) -> DVec3 {
    let [a, b, c] = corners.map(DVec3::abs);
    gamma(9.0) * a.max(b).max(c)
}

/// Moves a point with a bounded error off its plane, to the side of `direction` (Pharr, Jakob and Humphreys, "Physically
/// Based Rendering", section 6.8.6).
pub(super) fn offset_ray_origin(position: DVec3, error: DVec3, normal: DVec3, direction: DVec3) -> DVec3 {
    let offset = facing(normal, direction) * error.dot(normal.abs());
    let moved = position + offset;
    // The sum is rounded too: away from the plane.
    let away = |axis: usize| match offset[axis] {
        o if o > 0.0 => moved[axis].next_up(),
        o if o < 0.0 => moved[axis].next_down(),
        _ => moved[axis],
    };
    DVec3::new(away(0), away(1), away(2))
}

/// `v`, turned to the side of `side`.
fn facing(v: DVec3, side: DVec3) -> DVec3 {
    if v.dot(side) < 0.0 { -v } else { v }
}

/// The average of the channels.
pub(super) fn mean(colour: DVec3) -> f64 {
    colour.element_sum() / 3.0
}
