// What the host binds. The structs' twins are in src/gpu/layout.rs; a test compares every member's offset.

// What the scene uses: computed by src/gpu/specialization.rs. A `false` removes the code.
layout(constant_id = 0) const bool GLOSSY = true;              // some material has a glossy lobe
layout(constant_id = 1) const bool VERTEX_NORMALS = true;      // some mesh has vertex normals
layout(constant_id = 2) const bool INSTANCES = true;           // more than one object, or a transform
layout(constant_id = 3) const bool POINT_LUMINAIRES = true;
layout(constant_id = 4) const bool INFINITE_LUMINAIRES = true;
layout(constant_id = 5) const bool AREA_LUMINAIRES = true;     // some material emits
layout(constant_id = 6) const bool ENVIRONMENT = true;         // light comes from where rays escape to
layout(constant_id = 7) const bool IMPULSES = true;            // some material is a mirror or a dielectric
layout(constant_id = 8) const bool DIELECTRICS = true;         // some material has an index of refraction
layout(constant_id = 9) const bool TEXTURES = true;            // some material has a map
layout(constant_id = 10) const bool HOLES = true;              // some material is not opaque everywhere
layout(constant_id = 11) const bool THIN = true;                // some material is a sheet whose two sides are one surface
layout(constant_id = 12) const bool VERTEX_COLOURS = true;     // some mesh has vertex colours
layout(constant_id = 13) const bool COATS = true;              // some material has a base under a smooth dielectric
layout(constant_id = 14) const bool MAP_TRANSFORMS = true;     // some map is moved or scaled
layout(constant_id = 15) const bool ENVIRONMENT_IMAGE = true;  // that light has an image
layout(constant_id = 16) const bool ENVIRONMENT_SAMPLING = true;    // light is sampled from there
layout(constant_id = 17) const bool LIGHT_TREE = true;         // luminaires are chosen by a tree over them
layout(constant_id = 18) const bool SPOTS = true;              // some point luminaire shines into a cone
layout(constant_id = 19) const bool PROFILES = true;           // some point luminaire has measured intensities
layout(constant_id = 20) const bool SUNS = true;               // some luminaire is a disc at infinity
layout(constant_id = 21) const bool PHYSICAL = true;           // some material is a metallic-roughness surface
layout(constant_id = 22) const bool ROUGH_TRANSMISSION = true; // some of these let light through
layout(constant_id = 23) const bool VOLUMES = true;            // some of these are bodies that absorb
layout(constant_id = 24) const bool CLEARCOATS = true;         // some of these have a coat
layout(constant_id = 25) const bool ANISOTROPY = true;         // some of these are brushed
layout(constant_id = 26) const bool TANGENTS = true;           // some material needs to know where the texture's u grows
layout(constant_id = 27) const bool NORMAL_MAPS = true;        // some material has a map that bends the shading normal
layout(constant_id = 28) const bool PIERCED_BODIES = true;     // some body that absorbs is not opaque everywhere
layout(constant_id = 29) const bool ORTHOGRAPHIC = false;
layout(constant_id = 30) const bool SOBOL = false;

// The integrator's choices (src/scene/estimator.rs).
layout(constant_id = 31) const bool SIMPLE = false;            // the simple ray tracer instead of the path tracer
layout(constant_id = 32) const uint LIGHT_SAMPLING = 2u;
layout(constant_id = 33) const bool SOLID_ANGLE = true;        // near triangles are sampled by solid angle
layout(constant_id = 34) const uint DIRECTIONS = 2u;
layout(constant_id = 35) const uint EXTINCTION = 3u;
layout(constant_id = 36) const bool THRESHOLD = false;         // paths of small albedo end

layout(constant_id = 37) const bool TRANSPARENT = false;       // the camera does not see where its rays escape to, and they are counted
layout(constant_id = 38) const bool SMOOTH_TERMINATOR = false; // rays leave from above the triangles of smooth meshes

const uint LIGHT_NONE = 0u;
const uint LIGHT_DIRECT = 1u;
const uint LIGHT_MIS = 2u;
const uint DIRECTIONS_UNIFORM = 0u;
const uint DIRECTIONS_COSINE = 1u;
const uint DIRECTIONS_BSDF = 2u;
const uint EXTINCTION_OFF = 0u;
const uint EXTINCTION_LITERAL = 1u;
const uint EXTINCTION_SURFACE = 2u;
const uint EXTINCTION_THROUGHPUT = 3u;

// Texels of the filter's table.
const int FILTER_TEXELS = 65;

layout(set = 0, binding = 0, std140) uniform Frame {
    vec4 position;                        // eye point, or a point `start` in front of it; or where the middle one of the parallel rays begins
    vec4 forward;                         // to the middle of the picture, 1 along the line of sight; or the direction of the parallel rays
    vec4 axis;                            // unit line of sight: `forward` but for a shift
    vec4 right;                           // to the right edge of the picture: at distance 1, or of the parallel rays
    vec4 up;                              // to the upper edge
    float lens_radius;                    // of the aperture; 0: a pinhole
    float focus_distance;
    float lens_blades;                    // corners of the aperture; 0: it is round
    float lens_rotation;                  // in turns
    vec4 ambient;                         // ambient radiance of the simple ray tracer
    vec3 environment;                     // radiance of the environment, or a factor to its image
    float environment_probability;        // of choosing it
    uint width;                           // film size in pixels
    uint height;
    uint seed;
    uint luminaire_count;
    uint max_bounces;
    float albedo_threshold;
    uint environment_width;               // in texels
    uint environment_height;
    float environment_rotation;           // in turns
    float least_probability;              // with which an emissive triangle is chosen
    float start;                          // distance along the line of sight at which rays start, where the eye point is too far away
    float lens_at_start;                  // what is left there of a ray's offset on the lens
    uint environment_rows;                // texels of the search among the rows of the environment
    uint environment_row;                 // and of that among the columns of one of them
    uint first_sun;                       // in the luminaire table, of those that are discs at infinity
    uint sun_count;
    vec4 filter_table[FILTER_TEXELS];     // inverse cumulative distribution of the pixel filter: 257 knots, in pixels
} frame;

// Triangles in object space.
layout(set = 0, binding = 2) uniform usamplerBuffer triangles;
// Vertex normals, three texels a triangle, where VERTEX_NORMALS.
layout(set = 0, binding = 3) uniform usamplerBuffer normals;

// Objects: three rows to world space, three rows back, and `ObjectPlace`. Texels, because lavapipe reads them several times faster than
// storage buffers.
layout(set = 0, binding = 4) uniform usamplerBuffer objects;

// In the order of the texels: whatever follows a vec3 is in its texel's w.
struct Material {
    vec3 ambient;
    float normalisation;          // of the glossy lobe: N(m)
    vec3 lambert;
    float impulse_probability;    // or BY_ALBEDOS
    vec3 glossy;
    float exponent;               // of the glossy lobe: m
    vec3 emission;
    float area_density;           // probability of choosing a triangle of this material for each unit of its area
    vec3 reflection;              // of the impulse
    float eta;                    // index of refraction inside over that outside, or MIRROR
    vec3 transmission;            // of the impulse
    float opacity;
    uint ambient_map;             // textures that multiply the albedos and the emission, or NONE
    uint lambert_map;
    uint glossy_map;
    uint emission_map;
    uint opacity_map;             // its alpha multiplies the opacity
    uint one_sided;               // 1 if only the outward side emits
    uint kind;                    // 1 if it is a sheet whose two sides are one surface, plus twice its texel in `physical`, if it has one there
    float coat_transmittance;     // where COATS: of even light from outside, what reaches the base
    uint normal_map;              // textures that bend the shading normal, or NONE
    float normal_scale;           // factor to what lies along the surface
    uint bump_map;
    float bump_scale;             // world length of a height of 1
};
// What impulse_probability is where the albedos say how probable an impulse is.
const float BY_ALBEDOS = -1.0;
// The index of refraction of what has none.
const float MIRROR = 0.0;
layout(set = 0, binding = 5) uniform usamplerBuffer materials;

const uint POINT = 0u;
const uint INFINITE = 1u;
const uint AREA = 2u;
const uint SURROUNDINGS = 3u;
const uint SPOT = 4u;
const uint PHOTOMETRIC = 5u;
const uint SUN = 6u;

// Without its slot of the alias table.
struct Luminaire {
    vec3 a;                  // point: position; infinite, sun: unit vector towards the light; area: first corner
    float ideal_probability; // of being chosen, for the power heuristic: what `triangle_density` has too
    vec3 b;                  // area: second corner; spot, photometric: unit vector along the axis
    float area;              // of the triangle; spot: one minus the cosine of the outer angle; sun: of the radius
    vec3 c;                  // area: third corner; photometric: unit vector to the horizontal angle of 0
    float position_error;    // area: bound on the error of a point on the triangle, in each coordinate; spot: one over the edge's width, in cosines
    vec3 normal;             // area: unit outward normal; photometric: unit vector to the horizontal angle of 90 degrees
    float one_sided;         // area: 1 if only the outward side emits
    vec3 radiance;           // intensity, irradiance or radiance (without its texture)
    float probability;       // of being chosen, to the last random number
    uint kind;
    uint triangle;           // area: index into `triangles`; photometric: the texel of the profile
    uint material;           // area
};
layout(set = 0, binding = 6) uniform usamplerBuffer luminaires;

// Texture coordinates, two texels a triangle: those of the first two corners, then the third's.
layout(set = 0, binding = 9) uniform usamplerBuffer uvs;
// Three texels a texture.
layout(set = 0, binding = 10) uniform usamplerBuffer textures;
// Two texels of a texture in one: four half floats each.
layout(set = 0, binding = 11) uniform usamplerBuffer texels;
// One texel a texel of the environment.
layout(set = 0, binding = 12) uniform usamplerBuffer environment_texels;
// The search among the environment's rows, then that among the columns of each row (src/gpu/pack/environment.rs).
layout(set = 0, binding = 13) uniform usamplerBuffer environment_choice;

// Vertex colours, three texels a triangle, where VERTEX_COLOURS.
layout(set = 0, binding = 14) uniform usamplerBuffer colours;


// The light tree (src/gpu/pack/light_tree.rs): a header, what is chosen beside the tree, nodes, paths.
layout(set = 0, binding = 15) uniform usamplerBuffer light_tree;

// Metallic-roughness surfaces and their tables (src/gpu/pack/physical.rs), where PHYSICAL.
layout(set = 0, binding = 16) uniform usamplerBuffer physical;

// Tangents of the corners with their handedness, three texels a triangle, where TANGENTS.
layout(set = 0, binding = 17) uniform usamplerBuffer tangents;

// No index.
const uint NONE = 0xffffffffu;
// The bits of an infinity, and of the exponent of all that is not finite.
const uint INFINITY_BITS = 0x7f800000u;

// Sizes of the structures that are read as texels.
const int TRIANGLE_TEXELS = 3;
const int OBJECT_TEXELS = 8;
const int MATERIAL_TEXELS = 9;
const int LUMINAIRE_TEXELS = 7;
const int TEXTURE_TEXELS = 3;
const int LIGHT_TREE_HEADER = 2;
const int LIGHT_NODE_TEXELS = 8;
// The bit of a link that says that it is an index of a luminaire, not of a node.
const uint LEAF = 0x80000000u;

vec3 row_dot(vec4 m[3], vec3 v) { return vec3(dot(m[0].xyz, v), dot(m[1].xyz, v), dot(m[2].xyz, v)); }
vec3 translation(vec4 m[3]) { return vec3(m[0].w, m[1].w, m[2].w); }

// A triangle, in the order of its texels.
struct Triangle {
    vec3 a;                // first corner
    uint material;         // unless the object has one of its own
    vec3 b;                // second corner
    uint index_in_mesh;    // in the scene's Mesh::triangles
    vec3 c;                // third corner
    uint shape;            // LONGEST_EDGE and HAS_PLANE; from ORDINAL_SHIFT on how many triangles before it in the mesh emit
};
// The bits of a shape: which edge is the longest (0: from a to b, 1: to c, 2: back to a), and whether the other two say what plane the
// triangle lies in.
const uint LONGEST_EDGE = 3u;
const uint HAS_PLANE = 4u;
const uint ORDINAL_SHIFT = 3u;

// Of what the caller does not use the compiler leaves the texels out.
Triangle load_triangle(uint index) {
    int base = int(index) * TRIANGLE_TEXELS;
    uvec4 a = texelFetch(triangles, base);
    uvec4 b = texelFetch(triangles, base + 1);
    uvec4 c = texelFetch(triangles, base + 2);
    return Triangle(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz), c.w);
}

// The rest of an object.
struct ObjectPlace {
    uint root_node;            // of the mesh's BVH
    uint triangle_offset;      // of the mesh's first triangle
    uint material;             // replaces the triangles' own, unless NONE
    uint scene_index;          // in Scene::objects
    uint first_emitter;        // of the light tree's paths
};

ObjectPlace object_place(uint object) {
    uvec4 t = texelFetch(objects, int(object) * OBJECT_TEXELS + 6);
    uint first_emitter = texelFetch(objects, int(object) * OBJECT_TEXELS + 7).x;
    return ObjectPlace(t.x, t.y, t.z, t.w, first_emitter);
}

// Rows of the map to world space, and of its inverse.
void object_to_world(uint object, out vec4 rows[3]) {
    for (int i = 0; i < 3; i++) rows[i] = uintBitsToFloat(texelFetch(objects, int(object) * OBJECT_TEXELS + i));
}
void world_to_object(uint object, out vec4 rows[3]) {
    for (int i = 0; i < 3; i++) rows[i] = uintBitsToFloat(texelFetch(objects, int(object) * OBJECT_TEXELS + 3 + i));
}

Material load_material(uint index) {
    int base = int(index) * MATERIAL_TEXELS;
    vec4 ambient = uintBitsToFloat(texelFetch(materials, base));
    vec4 lambert = uintBitsToFloat(texelFetch(materials, base + 1));
    vec4 glossy = uintBitsToFloat(texelFetch(materials, base + 2));
    vec4 emission = uintBitsToFloat(texelFetch(materials, base + 3));
    vec4 reflection = uintBitsToFloat(texelFetch(materials, base + 4));
    vec4 transmission = uintBitsToFloat(texelFetch(materials, base + 5));
    uvec4 maps = texelFetch(materials, base + 6);
    uvec4 last = texelFetch(materials, base + 7);
    uvec4 bent = texelFetch(materials, base + 8);
    return Material(ambient.rgb, ambient.w, lambert.rgb, lambert.w, glossy.rgb, glossy.w, emission.rgb, emission.w,
                    reflection.rgb, reflection.w, transmission.rgb, transmission.w, maps.x, maps.y, maps.z, maps.w, last.x, last.y, last.z,
                    uintBitsToFloat(last.w), bent.x, uintBitsToFloat(bent.y), bent.z, uintBitsToFloat(bent.w));
}

Luminaire load_luminaire(uint index) {
    int base = int(index) * LUMINAIRE_TEXELS;
    vec4 a = uintBitsToFloat(texelFetch(luminaires, base));
    vec4 b = uintBitsToFloat(texelFetch(luminaires, base + 1));
    vec4 c = uintBitsToFloat(texelFetch(luminaires, base + 2));
    vec4 normal = uintBitsToFloat(texelFetch(luminaires, base + 3));
    vec4 radiance = uintBitsToFloat(texelFetch(luminaires, base + 4));
    // Kind, threshold, alias, triangle.
    uvec4 choice = texelFetch(luminaires, base + 5);
    uint material = texelFetch(luminaires, base + 6).x;
    return Luminaire(a.xyz, a.w, b.xyz, b.w, c.xyz, c.w, normal.xyz, normal.w, radiance.rgb, radiance.w, choice.x, choice.w, material);
}

// A slot of an alias table (twin: src/sampling/alias.rs).
struct AliasSlot {
    uint threshold;    // below it the slot's own entry
    uint alias;        // else this one
};

AliasSlot luminaire_slot(uint slot) {
    uvec4 choice = texelFetch(luminaires, int(slot) * LUMINAIRE_TEXELS + 5);
    return AliasSlot(choice.y, choice.z);
}
