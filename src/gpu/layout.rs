//! The structures that the host shares with the shaders (`shaders/scene.glsl`, `path_trace.comp`, `aov.comp`, `probe.comp`, `trace_rays.comp`).
//!
//! [`STRUCTS`] lists every member's offset; a test compares it with the offsets in the shipped SPIR-V. What shaders read as texels is
//! compared with the `struct` of the same name in the GLSL, and so are the constants.

use bytemuck::{Pod, Zeroable};

/// What a sample whose camera ray met nothing adds to [`PixelSum::dropped`], in a picture with alpha: groups are shorter.
pub const MISSED: u32 = 1 << 16;
/// An index that is none.
pub const NONE: u32 = u32::MAX;
/// [`Material::impulse_probability`] where the albedos say how probable an impulse is.
pub const BY_ALBEDOS: f32 = -1.0;
/// [`Material::eta`] of a mirror, which has none.
pub const MIRROR: f32 = 0.0;
/// The bits of [`Triangle::shape`] that hold the number of the longest edge.
pub const LONGEST_EDGE: u32 = 3;
/// The bit of [`Triangle::shape`] that says that the other two edges give the triangle's plane.
pub const HAS_PLANE: u32 = 4;
/// Where in [`Triangle::shape`] the number of emissive triangles begins.
pub const ORDINAL_SHIFT: u32 = 3;
/// Texels of [`Frame::filter_table`].
pub const FILTER_TEXELS: usize = 65;
/// Workgroups of the path tracer and of the first hits are squares of this many pixels a side.
pub const TILE_WORKGROUP: u32 = 8;
/// Invocations of a workgroup of the probe and of the kernel that only traces rays, in a row.
pub const ROW_WORKGROUP: u32 = 64;

/// What [`Luminaire::kind`] says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum LuminaireKind {
    /// A point.
    Point = 0,
    /// At infinity, in one direction.
    Infinite = 1,
    /// A triangle that emits.
    Area = 2,
    /// The environment, all around.
    Surroundings = 3,
    /// A point that shines into a cone.
    Spot = 4,
    /// A point with measured intensities.
    Photometric = 5,
    /// A disc at infinity.
    Sun = 6,
}

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
        /// Eye point, or a point `start` in front of it; of parallel rays, where the one in the middle of the picture begins.
        position: [f32; 4],
        /// To the middle of the picture, 1 along the line of sight; of parallel rays, their direction.
        forward: [f32; 4],
        /// Unit line of sight: `forward` but for a shift.
        axis: [f32; 4],
        /// To the right edge of the picture: at distance 1, or of the parallel rays.
        right: [f32; 4],
        /// To the upper edge.
        up: [f32; 4],
        /// Radius of the aperture; 0: a pinhole.
        lens_radius: f32,
        /// Distance of what is sharp.
        focus_distance: f32,
        /// Corners of the aperture; 0: it is round.
        lens_blades: f32,
        /// Turns by which the aperture is rotated.
        lens_rotation: f32,
        /// Ambient radiance of the simple ray tracer.
        ambient: [f32; 4],
        /// Radiance of the environment, or a factor to its image.
        environment: [f32; 3],
        /// Probability of choosing the environment among the luminaires.
        environment_probability: f32,
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
        /// Least probability with which an emissive triangle is chosen.
        least_probability: f32,
        /// Distance along the line of sight from the eye point to `position`, where rays start; 0 but for long lenses far away.
        start: f32,
        /// What is left there of a ray's offset on the lens.
        lens_at_start: f32,
        /// Texels of the search among the rows of the environment.
        environment_rows: u32,
        /// And of that among the columns of one of them.
        environment_row: u32,
        /// In the luminaire table, the first of those that are discs at infinity.
        first_sun: u32,
        /// How many these are.
        sun_count: u32,
        /// The filter's inverse cumulative distribution: 257 knots, in pixels.
        filter_table: [[f32; 4]; FILTER_TEXELS],
    }
}

shared! {
    /// A triangle in object space (binding 2): three texels, which `load_triangle` reads.
    Triangle {
        /// First corner.
        a: [f32; 3],
        /// Material, unless the object has one of its own.
        material: u32,
        /// Second corner.
        b: [f32; 3],
        /// Index in the scene's [`crate::scene::Mesh::triangles`].
        index_in_mesh: u32,
        /// Third corner.
        c: [f32; 3],
        /// [`LONGEST_EDGE`] (0: from `a` to `b`, 1: to `c`, 2: back to `a`) and [`HAS_PLANE`]; from [`ORDINAL_SHIFT`] on, how many triangles before
        /// it in the mesh emit, where there is a light tree.
        shape: u32,
    }
}

/// Normals at a triangle's corners (binding 3): three texels, of which the fourth component is nothing.
pub type VertexNormals = [[f32; 4]; 3];

/// Tangents of a triangle's corners, with their handedness (binding 16): three texels.
pub type CornerTangents = [[f32; 4]; 3];

/// Colours of a triangle's corners (binding 14): three texels, of which the fourth component is nothing.
pub type VertexColours = [[f32; 4]; 3];

shared! {
    /// An instance (binding 4): eight texels, which `object_place` and its neighbours in `scene.glsl` read.
    Object {
        /// Rows of the map to world space.
        object_to_world: [[f32; 4]; 3],
        /// Rows of its inverse.
        world_to_object: [[f32; 4]; 3],
        /// Root of the mesh's BVH.
        root_node: u32,
        /// The mesh's first triangle.
        triangle_offset: u32,
        /// Replaces the triangles' own material unless [`NONE`].
        material: u32,
        /// Index in the scene.
        scene_index: u32,
        /// Its first emissive triangle among the paths of the light tree.
        first_emitter: u32,
        /// To a multiple of 16 bytes.
        padding: [u32; 3],
    }
}

shared! {
    /// A material (binding 5): nine texels, which `load_material` reads.
    Material {
        /// Ambient albedo.
        ambient: [f32; 3],
        /// Normalisation of the glossy lobe.
        normalisation: f32,
        /// Diffuse albedo.
        lambert: [f32; 3],
        /// Probability of an impulse, or [`BY_ALBEDOS`].
        impulse_probability: f32,
        /// Glossy albedo.
        glossy: [f32; 3],
        /// Exponent of the glossy lobe.
        exponent: f32,
        /// Emitted radiance.
        emission: [f32; 3],
        /// Probability of choosing a triangle of this material for each unit of its area.
        area_density: f32,
        /// Albedo of the impulse reflection.
        reflection: [f32; 3],
        /// Index of refraction inside over that outside, or [`MIRROR`].
        eta: f32,
        /// Albedo of the impulse transmission.
        transmission: [f32; 3],
        /// Share of light that meets the surface at all.
        opacity: f32,
        /// Texture that multiplies `ambient`, or [`NONE`]; so are the next ones.
        ambient_map: u32,
        /// The one that multiplies `lambert`.
        lambert_map: u32,
        /// The one that multiplies `glossy`.
        glossy_map: u32,
        /// The one that multiplies `emission`.
        emission_map: u32,
        /// The one whose alpha multiplies `opacity`.
        opacity_map: u32,
        /// 1 if only the outward side emits.
        one_sided: u32,
        /// 1 if it is a sheet whose two sides are one surface, plus twice the texel of its [`Physical`], if it has one.
        kind: u32,
        /// Of even light from outside, what a coat lets through to the base.
        coat_transmittance: f32,
        /// The one that is a map of normals.
        normal_map: u32,
        /// Factor to its parts along tangent and bitangent.
        normal_scale: f32,
        /// The one that is a map of heights.
        bump_map: u32,
        /// World length of a height of 1.
        bump_scale: f32,
    }
}

shared! {
    /// A metallic-roughness surface (binding 16): ten texels, which `load_physical` reads.
    Physical {
        /// Base colour.
        base: [f32; 3],
        /// Share of metal.
        metallic: f32,
        /// Tint of the dielectric's reflection.
        specular_color: [f32; 3],
        /// Its strength.
        specular: f32,
        /// Natural logarithm of what is absorbed in a unit of length inside.
        absorption: [f32; 3],
        /// Perceptual roughness.
        roughness: f32,
        /// A metal's index of refraction.
        conductor_eta: [f32; 3],
        /// Strength of the anisotropy.
        anisotropy: f32,
        /// A metal's extinction coefficient.
        conductor_k: [f32; 3],
        /// In turns, from the tangent.
        anisotropy_rotation: f32,
        /// A metal's reflectance, averaged over directions.
        conductor_average: [f32; 3],
        /// Index of refraction; 0: infinite.
        ior: f32,
        /// Share of what enters that goes through.
        transmission: f32,
        /// Strength of the coat.
        clearcoat: f32,
        /// Its perceptual roughness.
        clearcoat_roughness: f32,
        /// Texel of the table of its index.
        rows: u32,
        /// A texture, or [`NONE`].
        base_map: u32,
        /// Four times a texture, and a channel; or [`NONE`]. So are the next ones, but for those of colours.
        metallic_map: u32,
        /// The same.
        roughness_map: u32,
        /// A texture.
        anisotropy_map: u32,
        /// Texture and channel.
        specular_map: u32,
        /// A texture.
        specular_color_map: u32,
        /// Texture and channel.
        transmission_map: u32,
        /// The same.
        clearcoat_map: u32,
        /// The same.
        clearcoat_roughness_map: u32,
        /// 1 if it has an index and an extinction coefficient in place of the base colour.
        conductor: u32,
        /// 1 if somebody may be inside.
        body: u32,
        /// To a multiple of 16 bytes.
        padding: u32,
    }
}

shared! {
    /// An entry of the luminaire table (binding 6): seven texels, which `load_luminaire` reads.
    Luminaire {
        /// Position, direction towards the light (of a disc: its middle), or first corner.
        a: [f32; 3],
        /// Probability of being chosen as the power heuristic has it, wherever the light is found.
        ideal_probability: f32,
        /// Second corner; spot and photometric: unit vector along the axis.
        b: [f32; 3],
        /// Area of the triangle; one minus the cosine of a spot's outer angle, or of a disc's radius.
        area: f32,
        /// Third corner; photometric: unit vector to the horizontal angle of 0.
        c: [f32; 3],
        /// Bound on the error of a point on the triangle, in each coordinate; spot: one over the width of its edge, in cosines.
        position_error: f32,
        /// Unit outward normal of the triangle; photometric: unit vector to the horizontal angle of 90 degrees.
        normal: [f32; 3],
        /// 1 if only the outward side emits.
        one_sided: f32,
        /// Intensity, irradiance or radiance without its texture.
        radiance: [f32; 3],
        /// Probability of being chosen, to the last random number.
        probability: f32,
        /// A [`LuminaireKind`].
        kind: u32,
        /// Alias table: below it, this entry.
        threshold: u32,
        /// Alias table: else that one.
        alias_index: u32,
        /// Area: the triangle, as the kernel counts them; photometric: the texel of this buffer at which the profile begins.
        triangle: u32,
        /// Area: its material.
        material: u32,
        /// To a multiple of 16 bytes.
        padding: [u32; 3],
    }
}

/// Texels at the beginning of the light tree (binding 15): the number of slots of what is chosen first, where nodes and paths begin, the probability
/// of the tree; then that of the environment, and the slot of the first disc at infinity.
pub const LIGHT_TREE_HEADER: usize = 2;

shared! {
    /// A node of the light tree: eight texels, which `light_importances` and `choose_by_tree` read.
    LightNode {
        /// For each of four children, the centre of a ball around it.
        x: [f32; 4],
        /// The same.
        y: [f32; 4],
        /// The same.
        z: [f32; 4],
        /// Its radius; negative where all light stays within a cone.
        radius: [f32; 4],
        /// Relative intensity; 0: there is no such child.
        strength: [f32; 4],
        /// Axis of the normals, x and y in 16 bits each.
        axis_xy: [u32; 4],
        /// Its z, and the sine around it, negative if both sides emit; or the cosine of the cone.
        axis_z_spread: [u32; 4],
        /// Index of a node, or that of a luminaire with the highest bit.
        link: [u32; 4],
    }
}

shared! {
    /// Texture coordinates of a triangle (binding 9): two texels, which `texture_coordinates` reads.
    TriangleUvs {
        /// Of the first corner.
        a: [f32; 2],
        /// Of the second.
        b: [f32; 2],
        /// Of the third.
        c: [f32; 2],
        /// To a multiple of 16 bytes.
        padding: [u32; 2],
    }
}

shared! {
    /// An image (binding 10): three texels, which `load_texture` reads.
    Texture {
        /// Its first texel among those of all textures.
        first_texel: u32,
        /// Texels in a row.
        width: u32,
        /// Rows.
        height: u32,
        /// 1 if it ends at its edges, 0 if it repeats.
        clamped: u32,
        /// Scalar product with (u, v, 1): where in the image, from its left edge.
        u: [f32; 3],
        /// Nothing.
        padding_u: f32,
        /// The same from its lower edge.
        v: [f32; 3],
        /// Nothing.
        padding_v: f32,
    }
}

shared! {
    /// A texel of the environment (binding 12), which `load_environment_texel` reads.
    EnvironmentTexel {
        /// Radiance without its factor.
        radiance: [f32; 3],
        /// Density of its directions, per steradian.
        density: f32,
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
        /// Samples that were not finite; with `TRANSPARENT` also [`MISSED`] for each whose camera ray met nothing.
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
