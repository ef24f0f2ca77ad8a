//! What bends shading normals: maps of normals and of heights, and what keeps their mirror directions above the surface.

use super::prepared_scene::Reference;
use super::texture::{bilinear, height_gradient};
use crate::scene::{Material, Mesh, Triangle};
use glam::{DMat2, DVec2, DVec3, Vec4};

/// A direction on a surface: where u grows, and the sign by which `normal x tangent` becomes the bitangent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tangent {
    /// Unit vector, perpendicular to the shading normal.
    pub direction: DVec3,
    /// 1, or -1 where the texture is mirrored.
    pub handedness: f64,
}

impl Tangent {
    /// The direction in which v grows, if `n` is the outward shading normal.
    pub fn bitangent(&self, n: DVec3) -> DVec3 {
        self.handedness * n.cross(self.direction)
    }

    /// The same beside another normal; none if that is the tangent itself.
    pub fn beside(&self, n: DVec3) -> Option<Tangent> {
        let across = self.direction - n * n.dot(self.direction);
        (across.length_squared() > LEAST_SQUARE).then(|| Tangent { direction: across.normalize(), ..*self })
    }
}

/// A vector whose squared length is smaller has no direction. (In single precision, too.)
pub const LEAST_SQUARE: f64 = 1e-12;
/// The cosine to the triangle's normal that a mirror direction has at least about a normal that a map has bent, unless `wo` is as low.
pub const LEAST_REFLECTED: f64 = 0.01;

impl Reference {
    /// The tangent at a point of a triangle that has these weights, beside the outward shading normal `n`; none where the mesh has none.
    pub(super) fn tangent(&self, object: u32, triangle: u32, weights: [f64; 3], n: DVec3) -> Option<Tangent> {
        let mesh = &self.scene.meshes[self.scene.objects[object as usize].mesh as usize];
        let first = 3 * triangle as usize;
        let corners: &[Vec4] = mesh.tangents.get(first..first + 3)?;
        // Tangents lie in the surface and go by the map itself, normals by its inverse transpose.
        let to_world = self.instances[object as usize].to_world.matrix3;
        let sum: DVec3 = corners.iter().zip(weights).map(|(t, weight)| weight * t.truncate().as_dvec3()).sum();
        let handedness = f64::from(corners[0].w) * to_world.determinant().signum();
        let direction = (to_world * sum).try_normalize()?;
        if handedness == 0.0 { None } else { Tangent { direction, handedness }.beside(n) }
    }

    /// The outward shading normal `n` as the material's maps bend it.
    pub(super) fn mapped_normal(
        &self,
        material: &Material,
        (mesh, triangle, corners): (&Mesh, &Triangle, [DVec3; 3]),
        uv: DVec2,
        n: DVec3,
        tangent: Option<Tangent>,
    ) -> DVec3 {
        let mut bent = n;
        if let (Some(map), Some(tangent)) = (material.normal_map, tangent) {
            let texture = &self.scene.textures[map.texture as usize];
            let texel = 2.0 * bilinear(texture, uv).truncate() - 1.0;
            let [x, y] = image_axes(texture.transform.matrix2.as_dmat2());
            let along = f64::from(map.scale) * (texel.x * x + texel.y * y);
            let sum = along.x * tangent.direction + along.y * tangent.bitangent(n) + texel.z * n;
            if sum.length_squared() > LEAST_SQUARE {
                bent = sum.normalize();
            }
        }
        if let Some(map) = material.bump_map.filter(|_| !mesh.uvs.is_empty()) {
            let slope = f64::from(map.scale) * height_gradient(&self.scene.textures[map.texture as usize], uv);
            let [a, b, c] = triangle.vertices.map(|v| mesh.uvs[v as usize].as_dvec2());
            let gradient = surface_gradient(corners, [slope.dot(b - a), slope.dot(c - a)]);
            bent = (bent - (gradient - bent * bent.dot(gradient))).normalize();
        }
        bent
    }
}

/// The axes of an image on a surface, along tangent and bitangent: where its columns grow, and what lies across that, towards its top. A transform of the texture
/// coordinates may turn the image and mirror it.
fn image_axes(transform: DMat2) -> [DVec2; 2] {
    let side = if transform.determinant() < 0.0 { -1.0 } else { 1.0 };
    // The first column of the inverse, but for its length.
    let x = (side * DVec2::new(transform.y_axis.y, -transform.x_axis.y)).normalize_or(DVec2::X);
    [x, side * x.perp()]
}

/// The gradient, within the plane of a triangle, of what grows by so much from its first corner to the second and to the third (Mikkelsen, "Surface Gradient Based
/// Bump Mapping Framework", 2020): neither a tangent nor the area of the triangle in the texture is asked for.
pub fn surface_gradient([a, b, c]: [DVec3; 3], [to_b, to_c]: [f64; 2]) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let n = ab.cross(ac);
    let gradient = (to_b * ac.cross(n) + to_c * n.cross(ab)) / n.length_squared();
    if gradient.is_finite() { gradient } else { DVec3::ZERO }
}

/// A shading normal for the side of `wo` of a triangle with the normal `geometric_normal` there: `n`, or if the mirror direction about it is (nearly) below the triangle,
/// the normal by which that direction is lifted to [`LEAST_REFLECTED`] above it. So a mirror about a bent normal shows what is there, and no half of a lobe is lost for
/// what a map bends away from the viewer. (The idea is that of Cycles, `ensure_valid_specular_reflection`; what is done here is simpler.)
pub fn guarded_normal(geometric_normal: DVec3, wo: DVec3, n: DVec3) -> DVec3 {
    let cosine = n.dot(wo);
    // A normal that faces away counts as one across the line of sight.
    let mirrored = 2.0 * cosine.max(0.0) * n - wo;
    let least = (0.9 * geometric_normal.dot(wo)).min(LEAST_REFLECTED);
    let height = geometric_normal.dot(mirrored);
    if cosine > 0.0 && height >= least {
        return n;
    }
    let along = mirrored - height * geometric_normal;
    if along.length_squared() <= LEAST_SQUARE {
        return geometric_normal;
    }
    let lifted = along.normalize() * (1.0 - least * least).sqrt() + least * geometric_normal;
    let half = wo + lifted;
    if half.length_squared() <= LEAST_SQUARE { geometric_normal } else { half.normalize() }
}
