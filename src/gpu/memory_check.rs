//! Whether a scene fits into the memory of a device, before anything is uploaded.

use super::layout;
use super::pack::environment::search_tree_size;
use super::pack::texture::texel_count;
use super::specialization::KernelModel;
use super::vulkan::device::Device;
use crate::memory::{available, gib};
use crate::scene::{LightTree, Luminaire, LuminaireTable, Profile, Scene};
use crate::{Error, Result};
use std::sync::Arc;

/// Bytes of the compute BVH's nodes for each triangle: 8.0 to 11.2 were measured, on meshes of 38 to 2 880 000 triangles.
const BVH_NODES: u64 = 12;
/// Bytes of a bottom-level acceleration structure and its scratch memory for each triangle, roughly: drivers differ.
const ACCELERATION_STRUCTURE: u64 = 120;

/// What a scene takes, roughly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Budget {
    /// Triangles, normals, texture coordinates, vertex colours, tangents, instances.
    geometry: u64,
    /// Nodes, or acceleration structures.
    acceleration: u64,
    textures: u64,
    environment: u64,
    /// The table, and the light tree.
    luminaires: u64,
}

impl Budget {
    /// The buffers of a scene for a kernel of this model.
    pub(super) fn of(scene: &Scene, table: &LuminaireTable, ray_query: bool, model: &KernelModel) -> Self {
        let features = &model.features;
        let triangles: u64 = scene.meshes.iter().map(|mesh| mesh.triangles.len() as u64).sum();
        let textured = features.textures || features.holes || features.anisotropy;
        let triangle = size_of::<layout::Triangle>()
            + if features.vertex_normals { size_of::<layout::VertexNormals>() } else { 0 }
            + if textured { size_of::<layout::TriangleUvs>() } else { 0 }
            + if features.vertex_colours { size_of::<layout::VertexColours>() } else { 0 }
            + if features.tangents { size_of::<layout::CornerTangents>() } else { 0 };
        let objects = scene.objects.len() as u64 * size_of::<layout::Object>() as u64;
        let texels = texel_count(&scene.textures);
        let image = scene.environment.as_ref().and_then(|environment| environment.image.as_ref());
        let tree = table.tree.as_ref().map_or(0, LightTree::bytes);
        let mut profiles: Vec<&Arc<Profile>> = Vec::new();
        for luminaire in &scene.luminaires {
            if let Luminaire::Photometric { profile, .. } = luminaire
                && !profiles.iter().any(|known| Arc::ptr_eq(known, profile))
            {
                profiles.push(profile);
            }
        }
        let profiles: usize = profiles.iter().map(|profile| profile.bytes()).sum();
        Budget {
            luminaires: (table.entries.len() * size_of::<layout::Luminaire>() + tree + profiles) as u64,
            geometry: triangles * triangle as u64 + objects,
            acceleration: triangles * if ray_query { ACCELERATION_STRUCTURE } else { BVH_NODES },
            textures: if textured { 8 * texels } else { 0 },
            environment: image.map_or(0, |image| {
                // A texel with its density, and the searches for a row, and in each row for a column.
                let rows = |entries: u32| u64::from(search_tree_size(entries));
                let searches = rows(image.height) + u64::from(image.height) * rows(image.width);
                16 * (image.texels.len() as u64 + if features.environment_sampling { searches } else { 0 })
            }),
        }
    }

    fn total(&self) -> u64 {
        self.geometry + self.acceleration + self.textures + self.environment + self.luminaires
    }

    /// Refuses what the device's largest heap cannot hold, or this machine's memory: there the buffers are made, and a software
    /// device keeps them there too.
    pub(super) fn check(&self, device: &Device) -> Result<()> {
        let heap = (device.memory, "the largest heap of its memory");
        self.fits(self.total(), &device.name, heap)?;
        let Some(free) = available() else { return Ok(()) };
        let copies = if device.software { 2 } else { 1 };
        self.fits(copies * self.total(), "this machine", (free, "what is free now"))
    }

    fn fits(&self, needed: u64, device: &str, (limit, what): (u64, &str)) -> Result<()> {
        if needed <= limit {
            return Ok(());
        }
        let Budget { geometry, acceleration, textures, environment, luminaires } = *self;
        let largest = (geometry + acceleration).max(textures).max(environment).max(luminaires);
        let reduce = match largest {
            _ if largest == textures => "make the textures smaller",
            _ if largest == environment => "make the environment's image smaller",
            _ if largest == luminaires => "make the lamps of fewer triangles",
            _ => "use fewer triangles, or instances of one mesh",
        };
        Err(Error::Limit {
            what: "the scene".into(),
            needed: format!(
                "about {} of memory (geometry {}, acceleration structures {}, textures {}, environment {}, luminaires {})",
                gib(needed),
                gib(geometry),
                gib(acceleration),
                gib(textures),
                gib(environment),
                gib(luminaires)
            ),
            device: device.into(),
            limit: format!("{}, {what}", gib(limit)),
            advice: format!("{reduce}, or take another device"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Environment, EnvironmentImage, Texture, build};
    use glam::{Affine2, Affine3A, Vec2, Vec3};
    use half::f16;

    #[test]
    fn what_does_not_fit_is_named_with_its_largest_part() {
        let mut scene = build::empty(4, 4);
        build::add(&mut scene, build::icosphere(3), build::matte(Vec3::ONE), Affine3A::IDENTITY);
        let table = LuminaireTable::new(&scene);
        let budget = Budget::of(&scene, &table, false, &KernelModel::of(&scene));
        assert_eq!(
            (budget.geometry, budget.textures, budget.environment, budget.luminaires),
            (1280 * 48 + 128, 0, 0, 0)
        );
        assert!(budget.fits(budget.total(), "a device", (budget.total(), "its heap")).is_ok());
        let error = budget.fits(budget.total(), "a device", (budget.total() - 1, "its heap")).unwrap_err().to_string();
        assert!(
            ["a device allows 0.1 MiB, its heap", "fewer triangles"].iter().all(|part| error.contains(part)),
            "{error}"
        );

        let texels: Vec<Vec3> = (0..1 << 15).map(|i| Vec3::splat(i as f32)).collect();
        let image = EnvironmentImage { name: "sky".into(), width: 256, height: 128, texels };
        let mut outside = scene.clone();
        outside.environment = Some(Environment { radiance: Vec3::ONE, image: Some(image.into()), rotation: 0.0 });
        // Columns in fours are 64, 16, 4, 1; rows 32, 8, 2, 1.
        let sky = Budget::of(&outside, &LuminaireTable::new(&outside), true, &KernelModel::of(&outside)).environment;
        assert_eq!(sky, 16 * ((1 << 15) + 128 * 85 + 43));

        let texels = vec![[f16::ONE; 4]; 1 << 16].into();
        let texture = Texture { width: 256, height: 256, texels, ..Texture::default() };
        // The same image in another place has no texels of its own.
        let moved = Texture { transform: Affine2::from_translation(Vec2::X * 0.5), ..texture.clone() };
        scene.textures.extend([texture.into(), moved.into()]);
        scene.materials[0].maps.lambert = Some(0);
        let textured = Budget::of(&scene, &table, true, &KernelModel::of(&scene));
        assert_eq!((textured.geometry, textured.textures), (1280 * 80 + 128, 8 << 16));
        let error = textured.fits(9 << 30, "this machine", (8 << 30, "what is free now")).unwrap_err().to_string();
        assert!(
            ["9216.0 MiB", "8192.0 MiB, what is free", "textures smaller"].iter().all(|part| error.contains(part)),
            "{error}"
        );
    }
}
