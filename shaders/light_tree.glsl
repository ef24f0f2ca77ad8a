// The choice of a luminaire by the light tree (twin: src/reference/light_tree.rs): down from the root with one random number, each child in
// proportion to what may arrive of it. A second number chooses between the tree and what stands beside it, and has further bits.

// What is added to a ball's apparent size against the surface's horizon, for rounding.
const float HORIZON_MARGIN = 1e-4;
// The ball's radius over its distance counts at most as this.
const float MOST_SINE = 2.0;
// What may contribute is chosen at least by this much of the strongest.
const float LEAST_IMPORTANCE = 1e-24;
// A squared distance is at least this.
const float LEAST_DISTANCE2 = 1e-37;
// What the inner side of a closed lamp counts, which is seen from within it alone.
const float INNER_SIDE = 0.03125;
// Fewer numbers than these get further bits.
const uint LEAST_WIDTH = 0x01000000u;
// The largest fraction of 2^32 that is also a float.
const float LAST_FRACTION = 4294967040.0;
// What is added to a cosine before it is held against a cone's, for the rounding of axes to 16 bits.
const float CONE_COSINE_MARGIN = 2e-4;
// A choice among more numbers than these is none.
const float MOST_NUMBERS = 1e30;

vec4 light_texel(uint index) { return uintBitsToFloat(texelFetch(light_tree, int(index))); }

// Whether luminaires are chosen by the tree: a kernel that can may have none.
bool by_light_tree() { return LIGHT_TREE && texelFetch(light_tree, 0).y != 0u; }

// The mean of a cosine's positive part, where it may be off by `spread`: itself far above the horizon, 0 far below.
vec4 facing(vec4 cosine, vec4 spread) {
    vec4 above = max(cosine + spread, 0.0);
    return mix(above * above / (4.0 * spread), cosine, greaterThanEqual(cosine, spread));
}

// 1 where some light of a ball may arrive that stays within cones, 0 elsewhere: `cone` is their cosine around an axis, `cosine` that of the way here, `sine` the
// ball's radius over its distance.
vec4 within_cone(vec4 cone, vec4 cosine, vec4 sine) {
    vec4 other = sqrt(max(1.0 - sine * sine, 0.0));
    // The cosine of the cone's angle and the ball's together, unless they are half a turn.
    vec4 both = cone * other - sqrt(max(1.0 - cone * cone, 0.0)) * sine;
    bvec4 all_around = greaterThanEqual(max(sine, -cone - other + 1.0), vec4(1.0));
    return mix(step(both, cosine + CONE_COSINE_MARGIN), vec4(1.0), all_around);
}

// How much light of each child of a node may arrive at a surface with the normal `n`, relative to each other; 0: surely none. A normal of length 2 says
// that light from both sides counts (`receiver`).
vec4 light_importances(vec3 p, vec3 n, uint node) {
    vec4 x = light_texel(node) - p.x;
    vec4 y = light_texel(node + 1u) - p.y;
    vec4 z = light_texel(node + 2u) - p.z;
    vec4 radius = light_texel(node + 3u);
    bvec4 cone = bvec4(false);
    if (SPOTS || PROFILES) {
        cone = lessThan(radius, vec4(0.0));
        radius = abs(radius);
    }
    vec4 strength = light_texel(node + 4u);
    ivec4 axis_xy = ivec4(texelFetch(light_tree, int(node + 5u)));
    ivec4 axis_z_spread = ivec4(texelFetch(light_tree, int(node + 6u)));
    vec4 distance2 = max(x * x + y * y + z * z, LEAST_DISTANCE2);
    vec4 inverse = inversesqrt(distance2);
    vec4 near = max(distance2, radius * radius);
    float nearest = min(min(near.x, near.y), min(near.z, near.w));
    vec4 sine = min(radius * inverse, MOST_SINE);
    vec4 incident = (n.x * x + n.y * y + n.z * z) * inverse;
    if (ROUGH_TRANSMISSION && dot(n, n) > 2.0) incident = 0.5 * abs(incident);
    incident = facing(incident, sine + HORIZON_MARGIN);
    // Two numbers from -1 to 1 in 16 bits each.
    vec4 along = vec4(axis_xy << 16 >> 16) * x + vec4(axis_xy >> 16) * y + vec4(axis_z_spread << 16 >> 16) * z;
    vec4 cosine = along * inverse * (-1.0 / 32767.0);
    vec4 spread = vec4(axis_z_spread >> 16) * (1.0 / 32767.0);
    vec4 within = vec4(1.0);
    if (SPOTS || PROFILES) within = within_cone(spread, cosine, sine);
    cosine = mix(cosine, abs(cosine), lessThan(spread, vec4(0.0)));
    spread = sine + abs(spread);
    vec4 inner = mix(vec4(0.0), INNER_SIDE * facing(-cosine, spread), lessThan(strength, vec4(0.0)));
    strength = abs(strength);
    vec4 emitted = mix(max(facing(cosine, spread), inner), 1.0 + cosine, greaterThanEqual(axis_z_spread >> 16, ivec4(32767)));
    if (SPOTS || PROFILES) emitted = mix(emitted, within, cone);
    vec4 importance = max(strength * (nearest / near) * incident * emitted, LEAST_IMPORTANCE);
    bvec4 none = lessThanEqual(min(min(incident, emitted), strength), vec4(0.0));
    return mix(importance, vec4(0.0), none);
}

// Where the numbers of a node's second, third and fourth child begin: each has one at least. False: nothing of the node can contribute.
bool light_cuts(vec3 p, vec3 n, uint node, uint width, out uvec3 cuts) {
    vec4 importance = light_importances(p, n, node);
    float two = importance.x + importance.y;
    float three = two + importance.z;
    float total = three + importance.w;
    uvec3 fraction = uvec3(vec3(importance.x, two, three) / total * LAST_FRACTION);
    uvec3 unused;
    umulExtended(uvec3(width - 4u), fraction, cuts, unused);
    cuts += uvec3(1u, 2u, 3u);
    return total > 0.0;
}

// Index of a luminaire, and the probability with which it is chosen. False where nothing can contribute.
bool choose_by_tree(vec3 p, vec3 n, uint random, uint more, out uint luminaire, out float probability) {
    uvec4 header = texelFetch(light_tree, 0);
    uint slot, number;
    umulExtended(more, header.x, slot, number);
    uvec4 entry = texelFetch(light_tree, LIGHT_TREE_HEADER + int(slot));
    if (number >= entry.x) entry = texelFetch(light_tree, LIGHT_TREE_HEADER + int(entry.z));
    luminaire = entry.y;
    probability = uintBitsToFloat(entry.w);
    if (luminaire != NONE) return true;
    uint width = 0xffffffffu;
    number = min(random, width - 1u);
    float whole = float(width);
    uint node = header.y;
    while (true) {
        while (width < LEAST_WIDTH) {
            // First, as the upper bits have chosen among what stands beside the tree; below those all are as likely.
            more = more * 747796405u + 2891336453u;
            width <<= 8;
            number = number << 8 | more >> 24;
            whole *= 256.0;
        }
        uvec3 cuts;
        if (!light_cuts(p, n, node, width, cuts)) return false;
        uvec4 links = texelFetch(light_tree, int(node + 7u));
        bool second = number >= cuts.x;
        bool third = number >= cuts.y;
        bool fourth = number >= cuts.z;
        uint begin = fourth ? cuts.z : (third ? cuts.y : (second ? cuts.x : 0u));
        uint end = fourth ? width : (third ? cuts.z : (second ? cuts.y : cuts.x));
        uint link = fourth ? links.w : (third ? links.z : (second ? links.y : links.x));
        width = end - begin;
        number -= begin;
        if (link == NONE || whole > MOST_NUMBERS) return false;
        if (link >= LEAF) {
            luminaire = link & ~LEAF;
            probability *= float(width) / whole;
            return true;
        }
        node = header.y + link * uint(LIGHT_NODE_TEXELS);
    }
}

// The probability with which choose_by_tree gives the leaf at the end of a path.
float tree_probability(vec3 p, vec3 n, uvec2 path) {
    if (path == uvec2(NONE)) return 0.0;
    uvec4 header = texelFetch(light_tree, 0);
    uint width = 0xffffffffu;
    float whole = float(width);
    uint node = header.y;
    while (true) {
        while (width < LEAST_WIDTH) {
            width <<= 8;
            whole *= 256.0;
        }
        uvec3 cuts;
        if (!light_cuts(p, n, node, width, cuts) || whole > MOST_NUMBERS) return 0.0;
        uvec4 links = texelFetch(light_tree, int(node + 7u));
        uint child = path.x & 3u;
        path = uvec2(path.x >> 2 | path.y << 30, path.y >> 2);
        uint begin = child == 3u ? cuts.z : (child == 2u ? cuts.y : (child == 1u ? cuts.x : 0u));
        uint end = child == 3u ? width : (child == 2u ? cuts.z : (child == 1u ? cuts.y : cuts.x));
        uint link = child == 3u ? links.w : (child == 2u ? links.z : (child == 1u ? links.y : links.x));
        width = end - begin;
        if (link >= LEAF) return uintBitsToFloat(header.w) * (float(width) / whole);
        node = header.y + link * uint(LIGHT_NODE_TEXELS);
    }
}

// The way to the leaf of an emissive triangle, of all objects' one after the other.
uvec2 light_path(uint index) {
    uvec4 pair = texelFetch(light_tree, int(texelFetch(light_tree, 0).z + (index >> 1)));
    return (index & 1u) == 0u ? pair.xy : pair.zw;
}

// That of the triangle that a ray met.
uvec2 light_path(Hit hit) {
    Triangle triangle = load_triangle(hit.triangle);
    if (!INSTANCES) return light_path(triangle.shape >> ORDINAL_SHIFT);
    ObjectPlace place = object_place(hit.object);
    return light_path(place.first_emitter + (place.material != NONE ? triangle.index_in_mesh : triangle.shape >> ORDINAL_SHIFT));
}

// Of choosing the disc of this number among those at infinity.
float sun_probability(uint number, Luminaire sun) {
    if (!by_light_tree()) return sun.ideal_probability;
    uint slot = texelFetch(light_tree, 1).y + number;
    return uintBitsToFloat(texelFetch(light_tree, LIGHT_TREE_HEADER + int(slot)).w);
}

// Of choosing the environment.
float environment_probability() {
    return by_light_tree() ? uintBitsToFloat(texelFetch(light_tree, 1).x) : frame.environment_probability;
}
