// closest_hit and occluded on a two-level compressed wide BVH in plain buffers. Include it through intersect.glsl.
//
// The nodes are those of Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
// BVHs" (HPG 2017), as the obvhs crate lays them out: 80 bytes for up to eight children. Triangles are tested by Woop,
// Benthin and Wald, "Watertight Ray/Triangle Intersection" (JCGT 2(1), 2013). Leaf boxes come padded (src/gpu/bvh), which
// covers the rounding of the box test.

// The top level starts at node 0, or, without INSTANCES, the only mesh does.
layout(set = 0, binding = 1) uniform usamplerBuffer nodes;

// Texels of a node.
const int NODE_TEXELS = 5;
// At most one entry a level and one more for the instances of a top-level leaf; src/gpu/accel refuses deeper trees.
const int STACK_SIZE = 32;

// A ray in the space that is being traversed, with what the box and triangle tests need of it.
struct TraversalRay {
    vec3 origin;
    vec3 inverse;      // 1 / direction; finite unless that is shorter than 1e-20
    uint octant_inv4;  // order of the children, in each byte
    vec3 direction;
    uint axis;         // largest component of the direction
    vec3 shear;
};

// Moves the largest axis to z.
vec3 permute(vec3 v, uint axis) { return axis == 0u ? v.yzx : (axis == 1u ? v.zxy : v); }

TraversalRay traversal_ray(vec3 origin, vec3 direction) {
    TraversalRay ray;
    ray.origin = origin;
    ray.direction = direction;
    vec3 size = abs(direction);
    float largest = max(size.x, max(size.y, size.z));
    // A component of zero would give infinity times zero in the box test; the substitute bends the ray by 1e-18.
    vec3 safe = mix(direction, vec3(largest * 1e-18), lessThan(size, vec3(largest * 1e-18)));
    ray.inverse = 1.0 / safe;
    ray.octant_inv4 = (safe.x < 0.0 ? 0u : 0x04040404u) | (safe.y < 0.0 ? 0u : 0x02020202u) | (safe.z < 0.0 ? 0u : 0x01010101u);
    ray.axis = size.x == largest ? 0u : (size.y == largest ? 1u : 2u);
    vec3 d = permute(direction, ray.axis);
    float z = 1.0 / d.z;
    ray.shear = vec3(d.xy * z, z);
    return ray;
}

float byte_of(uint word, uint index) { return float(bitfieldExtract(word, int(8u * index), 8)); }

// Tests the eight children of a node; returns one bit for each triangle (0 to 23) and each inner child (24 to 31, the
// nearest octant highest) that the ray may hit before `t_max`.
uint intersect_node(TraversalRay ray, float t_max, uint node, out uvec2 bases, out uint inner_mask) {
    int base = int(node) * NODE_TEXELS;
    uvec4 n0 = texelFetch(nodes, base);
    uvec4 n1 = texelFetch(nodes, base + 1);
    uvec4 nx = texelFetch(nodes, base + 2);
    uvec4 ny = texelFetch(nodes, base + 3);
    uvec4 nz = texelFetch(nodes, base + 4);
    bases = n1.xy;
    inner_mask = n0.w >> 24u;
    vec3 extent = uintBitsToFloat(uvec3(n0.w << 23u, n0.w << 15u, n0.w << 7u) & 0x7f800000u);
    vec3 scale = extent * ray.inverse;
    vec3 offset = (uintBitsToFloat(n0.xyz) - ray.origin) * ray.inverse;
    // Entry planes in xy, exit planes in zw.
    if (ray.inverse.x < 0.0) nx = nx.zwxy;
    if (ray.inverse.y < 0.0) ny = ny.zwxy;
    if (ray.inverse.z < 0.0) nz = nz.zwxy;
    int last = floatBitsToInt(t_max);
    uint mask = 0u;
    for (uint half_index = 0u; half_index < 2u; half_index++) {
        bool second = half_index == 1u;
        uint meta = second ? n1.w : n1.z;
        uvec3 entry = second ? uvec3(nx.y, ny.y, nz.y) : uvec3(nx.x, ny.x, nz.x);
        uvec3 leave = second ? uvec3(nx.w, ny.w, nz.w) : uvec3(nx.z, ny.z, nz.z);
        uint inner = (meta & (meta << 1u)) & 0x10101010u;
        uint bit_index = (meta ^ (ray.octant_inv4 & ((inner >> 4u) * 0xffu))) & 0x1f1f1f1fu;
        uint bits = (meta >> 5u) & 0x07070707u;
        for (uint child = 0u; child < 4u; child++) {
            // As integers: what is not negative compares alike, what is negative is less than that, and there is no NaN to look for.
            ivec3 t0 = floatBitsToInt(vec3(byte_of(entry.x, child), byte_of(entry.y, child), byte_of(entry.z, child)) * scale + offset);
            ivec3 t1 = floatBitsToInt(vec3(byte_of(leave.x, child), byte_of(leave.y, child), byte_of(leave.z, child)) * scale + offset);
            int near = max(max(t0.x, t0.y), max(t0.z, 0));
            // 1 + 4 * 2^-23: rays of far-away origins round by their distance, not by the box (Ize 2013).
            int far = floatBitsToInt(intBitsToFloat(min(min(t1.x, t1.y), t1.z)) * 1.0000005);
            if (near <= min(far, last)) {
                mask |= bitfieldExtract(bits, int(8u * child), 8) << bitfieldExtract(bit_index, int(8u * child), 8);
            }
        }
    }
    return mask;
}

int least(ivec3 v) { return min(min(v.x, v.y), v.z); }
int most(ivec3 v) { return max(max(v.x, v.y), v.z); }
// Of the absolute values, as integers.
float largest_size(vec3 v) { return intBitsToFloat(most(floatBitsToInt(abs(v)))); }

// Woop's test: an edge shared by two triangles gives the same numbers for both, so no ray slips through between them.
bool intersect_triangle(TraversalRay ray, float t_max, uint triangle, out float t, out vec3 weights) {
    Triangle corner = load_triangle(triangle);
    vec3 from_a = corner.a - ray.origin;
    vec3 a = permute(from_a, ray.axis);
    vec3 b = permute(corner.b - ray.origin, ray.axis);
    vec3 c = permute(corner.c - ray.origin, ray.axis);
    precise vec2 a2 = a.xy - ray.shear.xy * a.z;
    precise vec2 b2 = b.xy - ray.shear.xy * b.z;
    precise vec2 c2 = c.xy - ray.shear.xy * c.z;
    // `precise` forbids fused multiply-add, which would make the two sides of an edge differ.
    precise float u = c2.x * b2.y - c2.y * b2.x;
    precise float v = a2.x * c2.y - a2.y * c2.x;
    precise float w = b2.x * a2.y - b2.y * a2.x;
    if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) return false;
    float determinant = u + v + w;
    // Neither zero nor, of coordinates that overflow, infinite or no number.
    uint size = floatBitsToUint(abs(determinant));
    if (size == 0u || size >= INFINITY_BITS) return false;
    weights = vec3(v, w, determinant);
    // Distances of the corners.
    vec3 corners = vec3(a.z, b.z, c.z) * ray.shear.z;
    // Of a narrow triangle u, v and w are small differences of large products. Its plane is known better: by its short edges, as they are
    // before the origin is subtracted. A ray within that plane has no one distance to it, corners in one line have no plane; and no distance
    // lies outside the corners'.
    vec3 ab = corner.b - corner.a;
    vec3 bc = corner.c - corner.b;
    vec3 ca = corner.a - corner.c;
    uint longest = corner.shape & LONGEST_EDGE;
    vec3 n = cross(longest == 0u ? bc : (longest == 1u ? ca : ab), longest == 0u ? ca : (longest == 1u ? ab : bc));
    float slope = dot(n, ray.direction);
    bool plane = (corner.shape & HAS_PLANE) != 0u && abs(slope) * abs(ray.shear.z) > 1e-6 * largest_size(n);
    t = (plane ? dot(n, from_a) : dot(vec3(u, v, w), corners)) / (plane ? slope : determinant);
    // As integers, as in intersect_node.
    ivec3 distances = floatBitsToInt(corners);
    t = intBitsToFloat(min(max(floatBitsToInt(t), least(distances)), most(distances)));
    return t > 0.0 && t < t_max;
}

// With `passed`, looks for what the ray passes through holes beyond `t_min`; without, for what it meets.
bool traverse(vec3 origin, vec3 direction, float t_min, float t_max, uint salt, const bool any_hit, const bool passed, out Hit hit) {
    uvec2 stack[STACK_SIZE];
    int depth = 0;
    TraversalRay world = traversal_ray(origin, direction);
    TraversalRay ray = world;
    uint object = INSTANCES ? NONE : 0u;    // NONE while in the top level
    int object_depth = 0;                   // where the stack stood when the object was entered
    // A group of inner children: x is the index of the first, the high byte of y those still to visit, the low byte all
    // that are inner. A group of leaves: x is the index of the first, y has a bit for each still to visit.
    uvec2 inner = uvec2(0u, 0x80000000u);
    uvec2 leaves = uvec2(0u);
    hit.t = t_max;
    bool found = false;
    float determinant = 1.0;
    // A ray that is no ray (NaN, infinite or zero direction) hits nothing.
    float size = dot(abs(direction), vec3(1.0));
    if (!(size > 0.0 && size < INFINITY)) return false;

    while (true) {
        if (inner.y > 0x00ffffffu) {
            uint bit = uint(findMSB(inner.y));
            uint slot = (bit - 24u) ^ (ray.octant_inv4 & 0xffu);
            uint node = inner.x + uint(bitCount(inner.y & ~(0xffffffffu << slot) & 0xffu));
            inner.y &= ~(1u << bit);
            if (inner.y > 0x00ffffffu) stack[depth++] = inner;
            uvec2 bases;
            uint inner_mask;
            uint mask = intersect_node(ray, hit.t, node, bases, inner_mask);
            inner = uvec2(bases.x, (mask & 0xff000000u) | inner_mask);
            leaves = uvec2(bases.y, mask & 0x00ffffffu);
        }
        while (leaves.y != 0u) {
            uint bit = uint(findMSB(leaves.y));
            leaves.y &= ~(1u << bit);
            uint index = leaves.x + bit;
            if (INSTANCES && object == NONE) {
                if (inner.y > 0x00ffffffu) stack[depth++] = inner;
                if (leaves.y != 0u) stack[depth++] = leaves;
                object = index;
                object_depth = depth;
                // Relative to the object's own origin: the numbers that round are no larger than need be.
                vec4 to_world[3], to_object[3];
                object_to_world(object, to_world);
                world_to_object(object, to_object);
                vec3 from = origin - translation(to_world);
                ray = traversal_ray(row_dot(to_object, from), row_dot(to_object, direction));
                inner = uvec2(object_place(object).root_node, 0x80000000u);
                leaves.y = 0u;
            } else {
                float t;
                vec3 w;
                if (intersect_triangle(ray, hit.t, index, t, w)
                    && (passed ? t > t_min && is_passed(salt, object, index, w.xy / w.z) : !HOLES || covers(salt, object, index, w.xy / w.z))) {
                    found = true;
                    if (any_hit) return true;
                    hit = Hit(t, object, index, w.xy);
                    determinant = w.z;
                }
            }
        }
        if (inner.y <= 0x00ffffffu) {
            if (INSTANCES && object != NONE && depth == object_depth) {
                object = NONE;
                ray = world;
            }
            if (depth == 0) break;
            uvec2 top = stack[--depth];
            if (top.y > 0x00ffffffu) inner = top;
            else leaves = top;
        }
    }
    hit.barycentric /= determinant;
    return found;
}

bool closest_hit(vec3 origin, vec3 direction, float t_max, uint salt, out Hit hit) {
    return traverse(origin, direction, 0.0, t_max, salt, false, false, hit);
}

bool next_passed(vec3 origin, vec3 direction, float t_min, float t_max, uint salt, out Hit hit) {
    return traverse(origin, direction, t_min, t_max, salt, false, true, hit);
}

bool occluded(vec3 origin, vec3 direction, float t_max, uint salt) {
    Hit hit;
    return traverse(origin, direction, 0.0, t_max, salt, true, false, hit);
}
