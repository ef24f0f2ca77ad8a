//! Specialization constants: the kernel models no more than a scene needs.

use crate::scene::{
    AreaSampling, Directions, Environment, Extinction, Integrator, LightSampling, Luminaire, LuminaireTable, Material,
    Physical, Projection, SampledLuminaire, Sampler, Scene,
};
use glam::{Affine2, Affine3A, Vec3};

macro_rules! features {
    ($($(#[$doc:meta])* $name:ident: $text:literal,)*) => {
        /// What a scene uses. Each is a specialization constant of `shaders/scene.glsl`, in this order; a `false` removes the code, and
        /// the buffers that only this code reads shrink to the 16 bytes without which Vulkan does not bind them.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub struct Features { $($(#[$doc])* pub $name: bool,)* }

        impl Features {
            /// Everything: the kernel that can trace any scene.
            pub const ALL: Features = Features { $($name: true,)* };
            /// What each is called.
            pub const NAMES: &[&str] = &[$($text,)*];

            /// The constants' names, in lower case.
            pub const CONSTANTS: &[&str] = &[$(stringify!($name),)*];

            /// Switches the feature of this number in [`Features::NAMES`] on.
            pub fn switch_on(&mut self, number: usize) {
                *[$(&mut self.$name,)*][number] = true;
            }

            /// In the order of [`Features::NAMES`] and of the constants' ids.
            pub fn values(&self) -> Vec<bool> {
                vec![$(self.$name,)*]
            }
        }
    };
}

features! {
    /// Some material has a glossy lobe.
    glossy: "glossy lobe",
    /// Some mesh has vertex normals.
    vertex_normals: "vertex normals",
    /// More than one object, or a transform, or a material of the object's own.
    instances: "instances",
    /// Some luminaire is a point.
    point_luminaires: "point luminaires",
    /// Some luminaire is at infinity.
    infinite_luminaires: "luminaires at infinity",
    /// Some triangle emits.
    area_luminaires: "area luminaires",
    /// Light comes from where rays escape to.
    environment: "environment",
    /// Some material reflects or transmits an impulse.
    impulses: "impulses",
    /// Some material has an index of refraction.
    dielectrics: "dielectrics",
    /// Some material has a map.
    textures: "textures",
    /// Some material is not opaque everywhere.
    holes: "holes",
    /// Some material is a sheet whose two sides are one surface.
    thin: "thin sheets",
    /// Some mesh has vertex colours.
    vertex_colours: "vertex colours",
    /// Some material has a base under a smooth dielectric.
    coats: "coats",
    /// Some map is moved or scaled.
    map_transforms: "map transforms",
    /// That light has an image.
    environment_image: "image of the environment",
    /// Light is sampled from there.
    environment_sampling: "sampling of the environment",
    /// Luminaires are chosen by a tree over them.
    light_tree: "light tree",
    /// Some point luminaire shines into a cone.
    spots: "spots",
    /// Some point luminaire has measured intensities.
    profiles: "photometric profiles",
    /// Some luminaire is a disc at infinity.
    suns: "sun discs",
    /// Some material is a metallic-roughness surface.
    physical: "metallic-roughness",
    /// Some of these let light through.
    rough_transmission: "rough transmission",
    /// Some of these are bodies that absorb.
    volumes: "absorbing bodies",
    /// Some of these have a coat.
    clearcoats: "clearcoats",
    /// Some of these are brushed.
    anisotropy: "anisotropy",
    /// Some material needs to know where the texture's u grows.
    tangents: "tangents",
    /// Some material has a map that bends the shading normal.
    normal_maps: "normal maps",
    /// Some body that absorbs is not opaque everywhere.
    pierced_bodies: "holes in absorbing bodies",
}

/// The kernel that runs: the scene's features, and the choices of its integrator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KernelModel {
    /// What the scene uses.
    pub features: Features,
    /// The path tracer or the simple ray tracer.
    pub integrator: Integrator,
    /// Parallel rays in place of perspective.
    pub orthographic: bool,
    /// Where the random numbers come from.
    pub sampler: Sampler,
    /// The camera does not see where its rays escape to, and they are counted.
    pub transparent: bool,
}

impl KernelModel {
    /// The model that a scene needs.
    pub fn of(scene: &Scene) -> Self {
        Self::with(scene, &LuminaireTable::new(scene))
    }

    /// The same, where the luminaires are already known.
    pub(crate) fn with(scene: &Scene, table: &LuminaireTable) -> Self {
        let any = |kind: fn(&SampledLuminaire) -> bool| table.entries.iter().any(kind);
        let material = |uses: fn(&Material) -> bool| scene.materials.iter().any(uses);
        let physical =
            |uses: fn(&Physical) -> bool| scene.materials.iter().any(|m| m.physical.as_ref().is_some_and(uses));
        let features = Features {
            glossy: material(|m| m.glossy != Vec3::ZERO),
            vertex_normals: scene.meshes.iter().any(|m| !m.normals.is_empty()),
            instances: scene.objects.len() > 1
                || scene.objects.iter().any(|o| o.object_to_world != Affine3A::IDENTITY || o.material.is_some()),
            point_luminaires: any(
                |l| matches!(l, SampledLuminaire::Impulse(luminaire) if !matches!(luminaire, Luminaire::Infinite { .. })),
            ),
            infinite_luminaires: any(|l| matches!(l, SampledLuminaire::Impulse(Luminaire::Infinite { .. }))),
            area_luminaires: any(|l| matches!(l, SampledLuminaire::Area(_))),
            environment: scene.environment.as_ref().is_some_and(Environment::emits),
            impulses: material(Material::has_impulse),
            dielectrics: material(|m| match m.physical {
                Some(_) => m.transmits(),
                None => m.has_impulse() && m.eta.is_some(),
            }),
            textures: material(|m| {
                let own = [m.maps.ambient, m.maps.lambert, m.maps.glossy, m.maps.emission];
                m.bends_normal()
                    || own.iter().any(Option::is_some)
                    || m.physical.as_ref().is_some_and(|physical| physical.maps.any())
            }),
            holes: material(Material::has_holes),
            thin: material(Material::is_sheet),
            vertex_colours: scene.meshes.iter().any(|m| !m.colours.is_empty()),
            coats: material(Material::is_coated),
            map_transforms: scene.textures.iter().any(|texture| texture.transform != Affine2::IDENTITY),
            environment_image: scene.environment.as_ref().is_some_and(|e| e.emits() && e.image.is_some()),
            environment_sampling: any(|l| matches!(l, SampledLuminaire::Environment)),
            light_tree: table.tree.is_some(),
            spots: any(|l| matches!(l, SampledLuminaire::Impulse(Luminaire::Spot { .. }))),
            profiles: any(|l| matches!(l, SampledLuminaire::Impulse(Luminaire::Photometric { .. }))),
            suns: any(|l| matches!(l, SampledLuminaire::Sun(_))),
            physical: material(|m| m.physical.is_some()),
            rough_transmission: material(|m| m.physical.is_some() && m.transmits()),
            volumes: material(Material::absorbs),
            clearcoats: physical(|p| p.clearcoat > 0.0),
            anisotropy: physical(|p| p.anisotropy > 0.0),
            tangents: material(Material::needs_tangents),
            normal_maps: material(Material::bends_normal),
            pierced_bodies: material(|m| m.absorbs() && m.has_holes()),
        };
        KernelModel {
            features,
            integrator: scene.integrator,
            orthographic: matches!(scene.sensor.projection, Projection::Orthographic { .. }),
            sampler: scene.settings.sampler,
            transparent: scene.settings.transparent,
        }
    }

    /// Names of the specialization constants after those of [`Features::CONSTANTS`], in lower case.
    pub const CONSTANTS: [&str; 10] = [
        "orthographic",
        "sobol",
        "simple",
        "light_sampling",
        "solid_angle",
        "directions",
        "extinction",
        "threshold",
        "transparent",
        "smooth_terminator",
    ];

    /// How the kernel finds light: where nothing is sampled, by chance alone gives the same numbers.
    fn light_sampling(&self) -> LightSampling {
        let Features { point_luminaires, infinite_luminaires, area_luminaires, environment_sampling, suns, .. } =
            self.features;
        let sampled = point_luminaires || infinite_luminaires || area_luminaires || environment_sampling || suns;
        match self.integrator.estimator().light_sampling {
            LightSampling::Mis if !sampled => LightSampling::None,
            choice => choice,
        }
    }

    /// Values of the specialization constants, by their ids.
    pub(crate) fn constants(&self) -> Vec<u32> {
        let simple = matches!(self.integrator, Integrator::Simple { .. });
        let estimator = self.integrator.estimator();
        let mut constants: Vec<u32> = self.features.values().into_iter().map(u32::from).collect();
        constants.extend([
            u32::from(self.orthographic),
            u32::from(self.sampler != Sampler::Independent),
            u32::from(simple),
            light_sampling_number(self.light_sampling()),
            u32::from(estimator.area_sampling == AreaSampling::SolidAngle),
            directions_number(estimator.directions),
            extinction_number(estimator.extinction),
            u32::from(estimator.albedo_threshold.is_some()),
            u32::from(self.transparent),
            u32::from(estimator.smooth_terminator && self.features.vertex_normals),
        ]);
        constants
    }
}

/// The number that the shaders know a choice by (`LIGHT_...` in `shaders/scene.glsl`).
pub fn light_sampling_number(choice: LightSampling) -> u32 {
    match choice {
        LightSampling::None => 0,
        LightSampling::Direct => 1,
        LightSampling::Mis => 2,
    }
}

/// The number that the shaders know a choice by (`DIRECTIONS_...`).
pub fn directions_number(choice: Directions) -> u32 {
    match choice {
        Directions::Uniform => 0,
        Directions::Cosine => 1,
        Directions::Bsdf => 2,
    }
}

/// The number that the shaders know a choice by (`EXTINCTION_...`).
pub fn extinction_number(choice: Extinction) -> u32 {
    match choice {
        Extinction::Off => 0,
        Extinction::Literal => 1,
        Extinction::Surface => 2,
        Extinction::Throughput => 3,
    }
}

impl std::fmt::Display for KernelModel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self.integrator {
            Integrator::Simple { .. } => "simple ray tracer",
            Integrator::Path(_) => "path tracer",
        })?;
        f.write_str(", Lambert")?;
        for (on, name) in self.features.values().into_iter().zip(Features::NAMES) {
            if on {
                write!(f, ", {name}")?;
            }
        }
        if self.orthographic {
            f.write_str(", orthographic")?;
        }
        if self.transparent {
            f.write_str(", alpha")?;
        }
        if self.integrator.estimator().smooth_terminator {
            f.write_str(", smooth terminator")?;
        }
        Ok(())
    }
}
