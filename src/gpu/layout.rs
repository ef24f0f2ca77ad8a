//! The structures that the host shares with the shaders (`shaders/scene.glsl`, `path_trace.comp`, `aov.comp`, `probe.comp`, `trace_rays.comp`).
//!
//! [`STRUCTS`] lists every member's offset; a test compares it with the offsets in the shipped SPIR-V.

use bytemuck::{Pod, Zeroable};

/// Name and byte offset of a member.
pub type Member = (&'static str, usize);

/// GLSL name, size and members of every shared structure.
pub const STRUCTS: &[(&str, usize, &[Member])] = &[
    ("Frame", size_of::<Frame>(), Frame::MEMBERS),
    ("Batch", size_of::<Batch>(), Batch::MEMBERS),
    ("PixelSum", size_of::<PixelSum>(), PixelSum::MEMBERS),
    ("Dropped", size_of::<Dropped>(), Dropped::MEMBERS),
    ("AovSum", size_of::<AovSum>(), AovSum::MEMBERS),
    ("Call", size_of::<Call>(), Call::MEMBERS),
    ("Shots", size_of::<Shots>(), Shots::MEMBERS),
];

macro_rules! shared {
    ($(#[$doc:meta])* $name:ident { $($(#[$member_doc:meta])* $member:ident: $type:ty,)* }) => {
        $(#[$doc])*
        #[repr(C)]
        #[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
        pub struct $name { $($(#[$member_doc])* pub $member: $type,)* }

        impl $name {
            /// Name and offset of every member.
            pub const MEMBERS: &[Member] = &[$((stringify!($member), std::mem::offset_of!($name, $member)),)*];
        }
    };
}

shared! {
    /// Sensor and estimator: constant during a render (binding 0).
    Frame {
        /// Eye point.
        position: [f32; 4],
        /// Unit line of sight.
        forward: [f32; 4],
        /// To the right edge of the picture: at distance 1, or of the parallel rays.
        right: [f32; 4],
        /// To the upper edge.
        up: [f32; 4],
        /// Radius of the aperture, focus distance, blades, rotation in turns.
        lens: [f32; 4],
        /// Ambient radiance of the simple ray tracer.
        ambient: [f32; 4],
        /// Radiance of the environment, or a factor to its image; w: probability of choosing it.
        environment: [f32; 4],
        /// Film width in pixels.
        width: u32,
        /// Film height in pixels.
        height: u32,
        /// Seed of the random numbers.
        seed: u32,
        /// Entries of the luminaire table.
        luminaire_count: u32,
        /// Most indirect bounces; `u32::MAX` is no limit.
        max_bounces: u32,
        /// A path of a smaller combined albedo ends.
        albedo_threshold: f32,
        /// Texels in a row of the environment.
        environment_width: u32,
        /// Rows of the environment.
        environment_height: u32,
        /// Turns by which the environment is rotated.
        environment_rotation: f32,
        /// To a multiple of 16 bytes.
        padding: [u32; 3],
        /// The filter's inverse cumulative distribution: 257 knots, in pixels.
        filter_table: [[f32; 4]; 65],
    }
}

shared! {
    /// An instance (binding 4): seven texels, which `object_place` and its neighbours in `scene.glsl` read.
    Object {
        /// Rows of the map to world space.
        object_to_world: [[f32; 4]; 3],
        /// Rows of its inverse.
        world_to_object: [[f32; 4]; 3],
        /// Root of the mesh's BVH.
        root_node: u32,
        /// The mesh's first triangle.
        triangle_offset: u32,
        /// Replaces the triangles' own material unless `u32::MAX`.
        material: u32,
        /// Index in the scene.
        scene_index: u32,
    }
}

shared! {
    /// A material (binding 5): eight texels, which `load_material` reads.
    Material {
        /// Ambient albedo; w: normalisation of the glossy lobe.
        ambient: [f32; 4],
        /// Diffuse albedo; w: probability of an impulse, or -1: by the albedos.
        lambert: [f32; 4],
        /// Glossy albedo; w: exponent.
        glossy: [f32; 4],
        /// Emitted radiance; w: probability of choosing a triangle of this material for each unit of its area.
        emission: [f32; 4],
        /// Albedo of the impulse reflection; w: eta, or 0: a mirror.
        reflection: [f32; 4],
        /// Albedo of the impulse transmission; w: opacity.
        transmission: [f32; 4],
        /// Textures that multiply ambient, lambert, glossy and emission; `u32::MAX`: none.
        maps: [u32; 4],
        /// Texture whose alpha multiplies the opacity.
        opacity_map: u32,
        /// 1 if only the outward side emits.
        one_sided: u32,
        /// To a multiple of 16 bytes.
        padding: [u32; 2],
    }
}

shared! {
    /// An entry of the luminaire table (binding 6): seven texels, which `load_luminaire` reads.
    Luminaire {
        /// Position, direction towards the light, or first corner.
        a: [f32; 4],
        /// Second corner; w: area.
        b: [f32; 4],
        /// Third corner; w: bound on the error of a point on the triangle, in each coordinate.
        c: [f32; 4],
        /// Unit outward normal of the triangle; w: 1 if only that side emits.
        normal: [f32; 4],
        /// Intensity, irradiance or radiance without its texture; w: probability of being chosen.
        radiance: [f32; 4],
        /// 0: point, 1: infinite, 2: area, 3: environment.
        kind: u32,
        /// Alias table: below it, this entry.
        threshold: u32,
        /// Alias table: else that one.
        alias_index: u32,
        /// Area: the triangle, as the kernel counts them.
        triangle: u32,
        /// Area: its material.
        material: u32,
        /// To a multiple of 16 bytes.
        padding: [u32; 3],
    }
}

shared! {
    /// Push constants of the path tracer.
    Batch {
        /// Left column of the tile.
        tile_x: u32,
        /// Top row.
        tile_y: u32,
        /// Columns.
        tile_width: u32,
        /// Rows.
        tile_height: u32,
        /// First sample.
        first_sample: u32,
        /// One past the last.
        end_sample: u32,
        /// Samples in a group.
        group: u32,
    }
}

shared! {
    /// What the path tracer writes for a pixel and group (binding 7).
    PixelSum {
        /// Radiance, added up over the finite samples.
        radiance: [f32; 3],
        /// Rays traced, of all kinds.
        rays: u32,
        /// Shadow rays among them.
        shadow_rays: u32,
        /// Samples that were not finite.
        dropped: u32,
    }
}

shared! {
    /// Samples of a batch that were not finite (binding 8).
    Dropped {
        /// How many.
        count: u32,
        /// To a multiple of 8 bytes.
        padding: u32,
        /// Index of the pixel and of the sample, of as many as there is room for.
        samples: [[u32; 2]; 15],
    }
}

shared! {
    /// What `aov.comp` writes for a pixel (binding 7).
    AovSum {
        /// Albedos, added up.
        albedo: [f32; 3],
        /// Depths.
        depth: f32,
        /// Normals.
        normal: [f32; 3],
        /// Rays that hit something.
        hits: u32,
    }
}

shared! {
    /// Push constants of the probe.
    Call {
        /// Which function.
        function: u32,
        /// How many calls.
        count: u32,
    }
}

shared! {
    /// Push constants of the kernel that only traces rays.
    Shots {
        /// Index of the first ray.
        first: u32,
        /// How many.
        count: u32,
        /// 0: the closest hit; 1: whether anything is in the way.
        any_hit: u32,
        /// A number that no result is equal to.
        never: f32,
    }
}
