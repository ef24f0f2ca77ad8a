// The metallic-roughness surface (twins: src/reference/physical.rs): how its layers share the light, what they are worth, which way they send a path.

const float LEAST_ALPHA = 1.01e-4;  // narrower microfacets are impulses
const float COAT_INDEX = 1.5;
const float EDGE_COVARIANCE = 0.0117;
const float LEAST_SHARE = 1e-6;     // what is divided by
const float LEAST_COSINE = 1e-6;
const float NARROW = 0.04;          // up to this width what microfacets send to each other is added to their reflectance, ...
const float WIDE = 0.25;            // ... and from this one on it is a lobe of its own

// Numbers along the axes of the tables (src/scene/albedo_table.rs), which src/gpu/pack/physical.rs has in `physical`.
const int ROUGH = 32;
const int STEEP = 32;
const int ROUGHNESSES = 32;
const int COSINES = 32;
const int PHYSICAL_TEXELS = 10;

// The same of brushed lobes (src/scene/brushed_table.rs).
const int ALONG = 16;
const int RATIOS = 6;
const int AROUND = 5;
const int TILTS = 24;
const int MEANS_ALONG = 31;
const int MEANS_RATIOS = 11;
const int BRUSHED_ALONG = 8;
const int BRUSHED_RATIOS = 6;
const int BRUSHED_ASIDE = 8;
const int BRUSHED_TILTS = 12;
const int BRUSHED_ROW = 4608;
const float LEAST_INSIDE = 0.05;    // what leaves a brushed dielectric at least that is seen from inside

// In the order of the texels: whatever follows a vec3 is in its texel's w.
struct Physical {
    vec3 base;
    float metallic;
    vec3 specular_color;
    float specular;
    vec3 absorption;                // per unit of length inside
    float roughness;
    vec3 conductor_eta;             // where `conductor`
    float anisotropy;
    vec3 conductor_k;
    float anisotropy_rotation;      // in turns
    vec3 conductor_average;
    float ior;                      // 0: infinite
    float transmission;
    float clearcoat;
    float clearcoat_roughness;
    uint rows;                      // texel of the table of its index
    uint base_map;                  // a texture, or NONE
    uint metallic_map;              // four times a texture and a channel, or NONE
    uint roughness_map;
    uint anisotropy_map;
    uint specular_map;
    uint specular_color_map;
    uint transmission_map;
    uint clearcoat_map;
    uint clearcoat_roughness_map;
    uint conductor;                 // 1 if it has an index and an extinction coefficient
    uint body;                      // 1 if somebody may be inside
};

// What a surface does with light towards one direction.
struct Lobes {
    Physical p;                     // maps included
    vec3 x;                         // the surface's frame, z being its shading normal
    vec3 y;
    vec3 wo;                        // in that frame
    vec2 widths;
    float alpha;                    // by which tables go; 0: smooth
    bool inside;
    float eta;                      // behind the surface over that in front of it
    vec3 f0;                        // reflectance at normal incidence
    float normal;                   // Fresnel's
    vec3 many;                      // colour of what the dielectric reflects more than once
    float clearcoat;                // strength of the coat on this side
    float coat_alpha;
    vec3 coat_normal;               // in the surface's frame; maps that bend the surface's do not bend it
    vec3 coat_wo;                   // about it
    float passed;                   // by the coat, towards wo
    vec3 diffuse;
    vec3 multiple;                  // of the lobe of later reflections, but for what is missing at wi
    vec3 again;                     // what of them is added to the reflectance of microfacets instead
    float reflected;
    vec3 transmitted;
    bool straight;                  // what is transmitted is an impulse
    bool flat_facets;               // the same, though the microfacets are not smooth: all goes by the reflectance at wo
    vec3 impulse_reflection;
    vec3 impulse_transmission;
    vec3 shares;                    // albedos, about: cosine lobes, microfacets, coat
};

vec4 physical_texel(int index) { return uintBitsToFloat(texelFetch(physical, index)); }

Physical load_physical(uint place) {
    int base = int(place);
    vec4 a = physical_texel(base);
    vec4 b = physical_texel(base + 1);
    vec4 c = physical_texel(base + 2);
    vec4 d = physical_texel(base + 3);
    vec4 e = physical_texel(base + 4);
    vec4 f = physical_texel(base + 5);
    // Not by way of a float: a small whole number is a denormal one, which may become 0.
    uvec4 g = texelFetch(physical, base + 6);
    uvec4 m = texelFetch(physical, base + 7);
    uvec4 n = texelFetch(physical, base + 8);
    uvec4 o = texelFetch(physical, base + 9);
    return Physical(a.xyz, a.w, b.xyz, b.w, c.xyz, c.w, d.xyz, d.w, e.xyz, e.w, f.xyz, f.w, uintBitsToFloat(g.x), uintBitsToFloat(g.y), uintBitsToFloat(g.z), g.w,
                    m.x, m.y, m.z, m.w, n.x, n.y, n.z, n.w, o.x, o.y, o.z);
}

bool is_thin(Material material) { return (material.kind & 1u) != 0u; }
bool is_physical(Material material) { return PHYSICAL && material.kind > 1u; }

// The channel of a texture that multiplies a number.
float number_at(uint map, vec2 uv) { return map == NONE ? 1.0 : texture_at(map >> 2u, uv)[map & 3u]; }

// The surface with its maps, and with the colour of the vertices; `anisotropy_rotation` is where `x` lies from the tangent, in turns.
Physical physical_at(Material material, vec2 uv, vec3 colour) {
    Physical p = load_physical(material.kind >> 1u);
    if (TEXTURES) {
        if (p.base_map != NONE) p.base *= texture_at(p.base_map, uv).rgb;
        if (p.specular_color_map != NONE) p.specular_color *= texture_at(p.specular_color_map, uv).rgb;
        p.metallic *= number_at(p.metallic_map, uv);
        p.roughness *= number_at(p.roughness_map, uv);
        p.specular *= number_at(p.specular_map, uv);
        if (ROUGH_TRANSMISSION) p.transmission *= number_at(p.transmission_map, uv);
        if (CLEARCOATS) {
            p.clearcoat *= number_at(p.clearcoat_map, uv);
            p.clearcoat_roughness *= number_at(p.clearcoat_roughness_map, uv);
        }
        if (ANISOTROPY && p.anisotropy > 0.0 && p.anisotropy_map != NONE) {
            vec4 texel = texture_at(p.anisotropy_map, uv);
            p.anisotropy *= texel.z;
            p.anisotropy_rotation += angle(2.0 * texel.y - 1.0, 2.0 * texel.x - 1.0) * (0.5 / PI);
        }
    }
    if (VERTEX_COLOURS) p.base *= colour;
    return p;
}

// Widths of the microfacets, along the tangent and across (KHR_materials_anisotropy).
vec2 widths(Physical p) {
    float width = p.roughness * p.roughness;
    return vec2(ANISOTROPY ? width + (1.0 - width) * p.anisotropy * p.anisotropy : width, width);
}

// Whether they are so narrow that there are impulses in their place.
bool is_smooth(Physical p) { return widths(p).x < LEAST_ALPHA; }

float transmits(Physical p) { return !ROUGH_TRANSMISSION || p.ior == 0.0 ? 0.0 : p.transmission; }

// Whether light goes through the surface, as far as its own numbers say (`Material::transmits`).
bool lets_light_through(Material material) {
    if (!is_physical(material)) return DIELECTRICS && material.eta != MIRROR && material.transmission != vec3(0.0);
    Physical p = load_physical(material.kind >> 1u);
    return p.transmission > 0.0 && p.metallic < 1.0 && p.ior != 0.0;
}

// Whether anything is scattered in other ways than by impulses.
bool scatters(Physical p) {
    if (!is_smooth(p) || (1.0 - p.metallic) * (1.0 - transmits(p)) * p.base != vec3(0.0)) return true;
    return CLEARCOATS && p.clearcoat > 0.0 && p.clearcoat_roughness * p.clearcoat_roughness >= LEAST_ALPHA;
}

// Whether light from the other side is scattered to this one, in other ways than by impulses.
bool scatters_through(Physical p) { return transmits(p) > 0.0 && p.metallic < 1.0 && !is_smooth(p); }

// The index by which Fresnel's equations go.
float index_of(Physical p) { return p.ior == 0.0 ? COAT_INDEX : p.ior; }

vec3 normal_reflectance(Physical p) {
    float f0 = p.ior == 0.0 ? 1.0 : fresnel(p.ior, 1.0);
    return min(f0 * p.specular_color, vec3(1.0)) * p.specular;
}

vec3 metal(Physical p, float cosine) {
    if (p.conductor != 0u) return fresnel_conductor(p.conductor_eta, p.conductor_k, cosine);
    float grazing = max(1.0 - cosine, 0.0);
    float square = grazing * grazing;
    return p.base + (1.0 - p.base) * (square * square * grazing);
}

vec3 metal_average(Physical p) { return p.conductor != 0u ? p.conductor_average : p.base + (1.0 - p.base) * (1.0 / 21.0); }

// Share of the light that microfacets which reflect all do not send away at once.
float missing(float cosine, float alpha) {
    float r = sqrt(alpha) * float(ROUGH - 1);
    int i = min(int(r), ROUGH - 2);
    // From the normal: one minus the steepness.
    float square = alpha * (1.0 - cosine) / (cosine + alpha);
    float back = square / (1.0 + sqrt(max(1.0 - square, 0.0))) * float(STEEP - 1);
    int j = min(int(back), STEEP - 2);
    vec4 corners = physical_texel(i * (STEEP - 1) + STEEP - 2 - j);
    vec2 roots = mix(corners.yw, corners.xz, back - float(j));
    float root = mix(roots.x, roots.y, r - float(i));
    return root * root;
}

// The mean of that over directions in proportion to their cosine.
float missing_average(float alpha) {
    float r = sqrt(alpha) * float(ROUGH - 1);
    int i = min(int(r), ROUGH - 2);
    vec4 pair = physical_texel((ROUGH - 1) * (STEEP - 1) + i);
    return mix(pair.x, pair.y, r - float(i)) * alpha * alpha;
}

// Where the tables of indices begin: first that of coats.
int coat_rows() { return (ROUGH - 1) * STEEP; }

// Where the tables of brushed lobes begin, in scenes that have some.
int brushed_rows() { return coat_rows() + ROUGHNESSES * (COSINES + 1) + BRUSHED_ROW; }

// The place on their axes, each from 0 to 1, of a direction above microfacets of these widths, the first the larger one.
vec4 brushed_place(vec2 a, vec3 w) {
    float ratio = a.y / a.x;
    vec2 p = vec2(w.x, w.y * ratio);
    p *= p;
    float flat_part = p.x + p.y;
    float longer = sqrt(w.z * w.z + flat_part);
    // One less the square of the steepness of a direction that is stretched by the ratio.
    float square = min(a.x * flat_part / ((longer + w.z) * (w.z + a.x * longer)), 1.0);
    float tilt = sqrt(square / (1.0 + sqrt(1.0 - square)));
    return vec4(sqrt(a.x), ratio, flat_part > 0.0 ? p.y / flat_part : 0.0, tilt);
}

// Linear between eight numbers: along x in a pair, along y between pairs, along z between pairs of them.
float between(uvec4 corners, vec3 at) {
    vec4 lower = vec4(unpackHalf2x16(corners.x), unpackHalf2x16(corners.y));
    vec4 upper = vec4(unpackHalf2x16(corners.z), unpackHalf2x16(corners.w));
    vec4 sides = mix(lower, upper, at.z);
    vec2 pair = mix(sides.xy, sides.zw, at.y);
    return mix(pair.x, pair.y, at.x);
}

// Share of the light that microfacets which reflect all do not send away at once towards a direction above them.
float missing_towards(vec2 a, vec3 w) {
    if (!ANISOTROPY || a.x == a.y) return missing(min(w.z, 1.0), a.x);
    vec4 place = brushed_place(a, w) * vec4(ALONG - 1, RATIOS - 1, AROUND - 1, TILTS - 1);
    ivec4 before = min(ivec4(place), ivec4(ALONG - 2, RATIOS - 2, AROUND - 2, TILTS - 2));
    place -= vec4(before);
    int at = ((before.x * (RATIOS - 1) + before.y) * (AROUND - 1) + before.z) * (TILTS - 1) + before.w + brushed_rows();
    float narrower = between(texelFetch(physical, at), place.wzy);
    float wider = between(texelFetch(physical, at + (RATIOS - 1) * (AROUND - 1) * (TILTS - 1)), place.wzy);
    float root = mix(narrower, wider, place.x);
    return root * root;
}

// The mean of that over directions in proportion to their cosine.
float missing_average_of(vec2 a) {
    if (!ANISOTROPY || a.x == a.y) return missing_average(a.x);
    vec2 place = vec2(sqrt(a.x), a.y / a.x) * vec2(MEANS_ALONG - 1, MEANS_RATIOS - 1);
    ivec2 before = min(ivec2(place), ivec2(MEANS_ALONG - 2, MEANS_RATIOS - 2));
    place -= vec2(before);
    vec4 corners = physical_texel(brushed_rows() + ALONG * (RATIOS - 1) * (AROUND - 1) * (TILTS - 1) + before.x * (MEANS_RATIOS - 1) + before.y);
    vec2 pair = mix(corners.xy, corners.zw, place.x);
    return mix(pair.x, pair.y, place.y) * a.x * a.x;
}

// What becomes of light at a rough dielectric: edge, transmitted, inside, transmitted inside (DielectricAlbedo).
vec4 dielectric_share(int rows, float cosine, float alpha) {
    float r = sqrt(alpha) * float(ROUGHNESSES - 1);
    int i = min(int(r), ROUGHNESSES - 2);
    float c = sqrt(cosine) * float(COSINES - 1);
    int j = min(int(c), COSINES - 2);
    int at = rows + i * (COSINES + 1) + j;
    vec4 above = mix(physical_texel(at), physical_texel(at + 1), c - float(j));
    at += COSINES + 1;
    return mix(above, mix(physical_texel(at), physical_texel(at + 1), c - float(j)), r - float(i));
}

// The root of one less the steepness of a cosine, of which `rest` is missing to 1.
float tilt(float cosine, float rest, float alpha) {
    float square = clamp(alpha * rest / (cosine + alpha), 0.0, 1.0);
    return sqrt(square / (1.0 + sqrt(1.0 - square)));
}

// The place on the axes of what brushed dielectrics do, but for the index.
vec4 brushed_dielectric_place(vec2 a, vec3 w) {
    float beside = length(w.xz);
    float aside = tilt(beside, w.y * w.y / (1.0 + beside), a.x);
    return vec4(sqrt(a.x), sqrt(a.y / a.x), aside, tilt(w.z / beside, w.x * w.x / (beside * (beside + w.z)), a.x));
}

// What becomes of light from w at a brushed dielectric.
vec4 brushed_dielectric_share(int rows, vec2 a, vec3 w) {
    const ivec4 lengths = ivec4(BRUSHED_ALONG, BRUSHED_RATIOS, BRUSHED_ASIDE, BRUSHED_TILTS);
    vec4 place = min(brushed_dielectric_place(a, w), vec4(1.0)) * vec4(lengths - 1);
    ivec4 before = min(ivec4(place), lengths - 2);
    place -= vec4(before);
    vec4 more = vec4(0.0);
    for (int corner = 0; corner < 16; ++corner) {
        ivec4 behind = (ivec4(corner) >> ivec4(0, 1, 2, 3)) & 1;
        vec4 weights = mix(1.0 - place, place, vec4(behind));
        ivec4 at = before + behind;
        int texel = ((at.x * BRUSHED_RATIOS + at.y) * BRUSHED_ASIDE + at.z) * BRUSHED_TILTS + at.w;
        more += weights.x * weights.y * weights.z * weights.w * physical_texel(rows + ROUGHNESSES * (COSINES + 1) + texel);
    }
    vec4 share = dielectric_share(rows, min(w.z, 1.0), seen_width(a, w)) + more;
    share.z = max(share.z, LEAST_INSIDE);
    return vec4(share.x, max(share.y, 0.0), share.z, clamp(share.w, 0.0, share.z));
}

// The mean of what is reflected by (F - F0) / (1 - F0).
float edge_average(int rows, float alpha) {
    float r = sqrt(alpha) * float(ROUGHNESSES - 1);
    int i = min(int(r), ROUGHNESSES - 2);
    int at = rows + i * (COSINES + 1) + COSINES;
    return mix(physical_texel(at).x, physical_texel(at + COSINES + 1).x, r - float(i));
}

// The colour of light that has met microfacets of this mean reflectance more than once, when it leaves them.
vec3 multiple_colour(vec3 average, float missing) { return average * average * (1.0 - missing) / (1.0 - average * missing); }

// A dielectric's reflectance between that at normal incidence, f0, and that at grazing, by edge = (F - normal) / (1 - normal).
vec3 edge_colour(vec3 f0, float f90, float normal, float edge) {
    return edge < 0.0 ? f0 * (1.0 + edge * (1.0 - normal) / normal) : f0 + (f90 - f0) * edge;
}

// Reflectance of a microfacet of the dielectric.
vec3 dielectric_reflectance(Lobes l, float cosine) {
    float f = fresnel(l.eta, min(cosine, 1.0));
    if (l.inside) return vec3(f);
    return edge_colour(l.f0, l.p.specular, l.normal, (f - l.normal) / (1.0 - l.normal));
}

// The width by which the dielectric's tables go.
float dielectric_alpha(Lobes l) { return l.flat_facets ? 0.0 : l.alpha; }

// The share that the dielectric reflects in all, seen at a cosine, where this becomes of light and this much is missing; from inside only about.
vec3 dielectric_albedo(Lobes l, float cosine, vec4 share, float missing) {
    if (dielectric_alpha(l) == 0.0) return dielectric_reflectance(l, cosine);
    if (l.inside) return vec3(1.0 - share.w / share.z);
    return (1.0 - missing) * edge_colour(l.f0, l.p.specular, l.normal, share.x) + missing * l.many;
}

// The mean of that over directions in proportion to their cosine; from outside.
vec3 dielectric_albedo_average(Lobes l, float missing) {
    if (l.flat_facets) missing = 0.0;
    float edge = edge_average(int(l.p.rows), dielectric_alpha(l));
    return (1.0 - missing) * edge_colour(l.f0, l.p.specular, l.normal, edge / (1.0 - missing)) + missing * l.many;
}

// What a smooth coat reflects of even light.
float coat_average() {
    float f0 = fresnel(COAT_INDEX, 1.0);
    return f0 + (1.0 - f0) * edge_average(coat_rows(), 0.0);
}

// Of what a coat reflects more than once, the share that leaves it.
float coat_multiple(float alpha) { return multiple_colour(vec3(coat_average()), missing_average(alpha)).x; }

// What a coat reflects in all, seen at a cosine.
float coat_albedo(float cosine, float alpha) {
    if (alpha < LEAST_ALPHA) return fresnel(COAT_INDEX, cosine);
    float lost = missing(cosine, alpha);
    float f0 = fresnel(COAT_INDEX, 1.0);
    float edge = dielectric_share(coat_rows(), cosine, alpha).x;
    return (1.0 - lost) * (f0 + (1.0 - f0) * edge) + lost * coat_multiple(alpha);
}

// The mean of that over directions in proportion to their cosine.
float coat_mean(float alpha) {
    if (alpha < LEAST_ALPHA) return coat_average();
    float lost = missing_average(alpha);
    float f0 = fresnel(COAT_INDEX, 1.0);
    return (1.0 - lost) * f0 + (1.0 - f0) * edge_average(coat_rows(), alpha) + lost * coat_multiple(alpha);
}

// The share of light from a direction above the surface that the coat lets in.
float coat_passed(Lobes l, vec3 wi) {
    if (!CLEARCOATS || l.clearcoat == 0.0) return 1.0;
    return 1.0 - l.clearcoat * coat_albedo(clamp(dot(l.coat_normal, wi), LEAST_COSINE, 1.0), l.coat_alpha);
}

// Into the coat's frame, its normal +z.
vec3 to_coat(Lobes l, vec3 w) {
    if (!NORMAL_MAPS) return w;
    return vec3(dot(from_frame(l.coat_normal, vec3(1.0, 0.0, 0.0)), w), dot(from_frame(l.coat_normal, vec3(0.0, 1.0, 0.0)), w), dot(l.coat_normal, w));
}

// Albedo of the layers of a smooth surface, by what of each is reflected: of the dielectric by (F - F0) / (1 - F0).
vec3 smooth_albedo(Physical p, float edge, vec3 metal, float coat) {
    float f0 = p.ior == 0.0 ? 1.0 : fresnel(p.ior, 1.0);
    vec3 reflected = edge_colour(normal_reflectance(p), p.specular, f0, edge);
    vec3 base = mix(reflected + (1.0 - reflected) * p.base, metal, p.metallic);
    if (!CLEARCOATS) return base;
    return p.clearcoat * coat + (1.0 - p.clearcoat * coat) * base;
}

// What the surface reflects and transmits of even light, about.
vec3 hemispherical_albedo(Physical p) { return smooth_albedo(p, edge_average(int(p.rows), 0.0), metal_average(p), CLEARCOATS ? coat_average() : 0.0); }

// Albedo as from straight above.
vec3 normal_albedo(Physical p) { return smooth_albedo(p, 0.0, metal(p, 1.0), fresnel(COAT_INDEX, 1.0)); }

// Of what is scattered, about.
float scattered_albedo(Lobes l) { return l.shares.x + l.shares.y + l.shares.z; }

// The lobes of a surface about a normal towards wo; `coat_normal` and `tangent` in the world, `front`: on the outward side.
Lobes physical_lobes(Physical p, vec3 normal, vec3 coat_normal, vec3 tangent, bool front, vec3 wo) {
    Lobes l;
    l.p = p;
    l.x = from_frame(normal, vec3(1.0, 0.0, 0.0));
    l.y = from_frame(normal, vec3(0.0, 1.0, 0.0));
    if (ANISOTROPY && p.anisotropy != 0.0) {
        vec3 across = tangent - normal * dot(normal, tangent);
        float length2 = dot(across, across);
        if (length2 > 1e-12) {
            l.x = across * inversesqrt(length2);
            l.y = cross(normal, l.x);
        }
    }
    l.wo = vec3(dot(l.x, wo), dot(l.y, wo), max(dot(normal, wo), LEAST_COSINE));
    float cosine = min(l.wo.z, 1.0);
    bool impulse = is_smooth(p);
    vec2 w = widths(p);
    l.widths = vec2(w.x, max(w.y, LEAST_ALPHA));
    l.alpha = impulse ? 0.0 : ANISOTROPY ? mean_width(l.widths) : w.x;
    float lost = impulse ? 0.0 : missing_towards(l.widths, l.wo);
    float lost_average = impulse ? 0.0 : missing_average_of(l.widths);
    // Of a round lobe instead, by which the body below goes.
    float round_average = ANISOTROPY && !impulse ? missing_average(l.alpha) : lost_average;

    bool body = ROUGH_TRANSMISSION && p.body != 0u;
    l.inside = body && !front;
    float index = index_of(p);
    // What is hardly bent is hardly spread.
    l.straight = !ROUGH_TRANSMISSION || impulse || (body && w.x * (index - 1.0) < LEAST_ALPHA);
    l.flat_facets = ROUGH_TRANSMISSION && l.straight && !impulse;
    l.f0 = normal_reflectance(p);
    l.normal = fresnel(index, 1.0);
    vec3 average = edge_colour(l.f0, p.specular, l.normal, edge_average(int(p.rows), 0.0));
    l.many = l.flat_facets ? vec3(0.0) : multiple_colour(average, lost_average);
    l.eta = l.inside ? 1.0 / index : index;
    vec4 share = vec4(0.0);
    if (ANISOTROPY && !impulse && l.widths.x != l.widths.y && p.metallic < 1.0) share = brushed_dielectric_share(int(p.rows), l.widths, l.wo);
    else if (!impulse) share = dielectric_share(int(p.rows), cosine, l.alpha);
    vec3 reflects = dielectric_albedo(l, cosine, share, lost);

    float coat = 0.0;
    l.clearcoat = 0.0;
    l.coat_alpha = 0.0;
    l.coat_normal = vec3(0.0, 0.0, 1.0);
    l.coat_wo = l.wo;
    if (CLEARCOATS && p.clearcoat > 0.0 && (front || !body)) {
        l.clearcoat = p.clearcoat;
        l.coat_alpha = p.clearcoat_roughness * p.clearcoat_roughness;
        if (NORMAL_MAPS) {
            l.coat_normal = vec3(dot(l.x, coat_normal), dot(l.y, coat_normal), dot(normal, coat_normal));
            l.coat_wo = to_coat(l, l.wo);
            l.coat_wo.z = max(l.coat_wo.z, LEAST_COSINE);
        }
        coat = l.clearcoat * coat_albedo(min(l.coat_wo.z, 1.0), l.coat_alpha);
    }
    bool coat_smooth = l.coat_alpha < LEAST_ALPHA;
    l.passed = 1.0 - coat;

    float insulator = (1.0 - p.metallic) * l.passed;
    float transmission = transmits(p);
    vec3 entered = 1.0 - reflects;
    // From inside there is nothing between: either the scattering body, or the boundary.
    vec3 body_albedo = insulator * (1.0 - transmission) * p.base;
    if (!l.inside) body_albedo *= entered;
    vec3 let_in = 1.0 - dielectric_albedo_average(l, round_average);
    if (CLEARCOATS && l.clearcoat > 0.0) {
        // Both layers let in less near grazing.
        vec3 both = (l.clearcoat * (1.0 - fresnel(COAT_INDEX, 1.0)) * EDGE_COVARIANCE) * max(p.specular - l.f0, 0.0);
        let_in = let_in * (1.0 - l.clearcoat * coat_mean(l.coat_alpha)) + both;
    }
    l.diffuse = l.inside ? body_albedo / PI : body_albedo / (PI * max(let_in, LEAST_SHARE));
    vec3 many = l.inside ? vec3(0.0) : l.many;
    vec3 metal_many = multiple_colour(metal_average(p), lost_average);
    vec3 later = lost * mix(many, metal_many, p.metallic);
    float wide = clamp((l.alpha - NARROW) / (WIDE - NARROW), 0.0, 1.0);
    vec3 widely = l.passed * wide * later;
    l.multiple = wide > 0.0 ? widely / (PI * lost_average) : vec3(0.0);
    l.again = (1.0 - wide) * later / (1.0 - lost);
    l.reflected = 1.0;
    l.transmitted = vec3(0.0);
    vec3 through = vec3(0.0);
    if (ROUGH_TRANSMISSION) {
        if (l.inside) l.reflected = transmission;
        if (l.flat_facets) l.reflected /= 1.0 - lost;
        else if (l.inside && !impulse) l.reflected /= (1.0 - lost) * share.z;
        through = insulator * transmission * p.base * entered;
        if (!l.straight) {
            if (!body) l.transmitted = through / (1.0 - lost);
            else if (l.inside) l.transmitted = insulator * p.base * l.reflected;
            else l.transmitted = through / max((1.0 - lost) * share.y, LEAST_SHARE);
        }
    }
    if (l.inside) reflects *= transmission;
    vec3 mirrored = l.passed * mix(reflects, (1.0 - lost) * metal(p, cosine) + lost * metal_many, p.metallic);
    l.impulse_reflection = (impulse ? mirrored : vec3(0.0)) + (coat_smooth ? coat : 0.0);
    l.impulse_transmission = l.straight ? through : vec3(0.0);
    float facets = (impulse ? 0.0 : mean(mirrored - widely)) + (l.straight ? 0.0 : mean(through));
    l.shares = vec3(mean(body_albedo + widely), facets, coat_smooth ? 0.0 : coat);
    return l;
}

// By how much the index is greater behind the surface, for what goes through.
float bend(Lobes l) { return ROUGH_TRANSMISSION && l.p.body != 0u ? l.eta : 1.0; }

// Whether light goes through unscattered, from some side.
bool is_clear(Lobes l) { return ROUGH_TRANSMISSION && l.straight && (1.0 - l.p.metallic) * transmits(l.p) * l.p.base != vec3(0.0); }

// Whether light from below is scattered here.
bool scatters_through(Lobes l) { return ROUGH_TRANSMISSION && l.transmitted != vec3(0.0); }

// Colours of what a microfacet that is seen at a cosine reflects and lets through.
void facet(Lobes l, float cosine, out vec3 reflects, out vec3 transmits) {
    vec3 of_dielectric = dielectric_reflectance(l, l.flat_facets ? l.wo.z : cosine);
    vec3 once = mix(l.reflected * of_dielectric, metal(l.p, cosine), l.p.metallic);
    reflects = l.passed * (once + l.again);
    transmits = vec3(0.0);
    if (scatters_through(l)) transmits = l.p.body != 0u ? l.transmitted * (1.0 - fresnel(l.eta, min(cosine, 1.0))) : l.transmitted;
}

// The probability with which a path that such a microfacet was chosen for is reflected.
float reflected_share(vec3 reflects, vec3 transmits) {
    float through = mean(transmits);
    float mirrored = mean(reflects);
    return through > 0.0 ? mirrored / (mirrored + through) : 1.0;
}

// The scattering function without the cosine and without the factor 1 / eta^2 of what is refracted, in rgb; w: the density of physical_direction. `wi` is in
// the surface's frame.
vec4 physical_value_and_pdf(Lobes l, vec3 wi) {
    float all = scattered_albedo(l);
    if (all == 0.0 || wi.z == 0.0) return vec4(0.0);
    vec3 reflects, transmits;
    if (wi.z < 0.0) {
        if (!scatters_through(l)) return vec4(0.0);
        Microfacet through = l.p.body != 0u ? microfacet_refraction(l.widths, l.wo, wi, l.eta)
                                            : microfacet_reflection(l.widths, l.wo, vec3(wi.xy, -wi.z));
        facet(l, through.cosine, reflects, transmits);
        return vec4(transmits * through.value, l.shares.y * (1.0 - reflected_share(reflects, transmits)) / all * through.pdf);
    }
    float lost = 0.0;
    if (l.alpha > 0.0 && (l.multiple != vec3(0.0) || l.diffuse != vec3(0.0))) lost = missing(min(wi.z, 1.0), l.alpha);
    // Of what scatters widely the coat takes its share both ways, of a reflection the greater one.
    float passed = coat_passed(l, wi);
    vec3 value = l.diffuse;
    if (!l.inside) value *= passed;
    if (!l.inside && value != vec3(0.0)) {
        vec4 share = l.alpha == 0.0 ? vec4(0.0) : dielectric_share(int(l.p.rows), min(wi.z, 1.0), l.alpha);
        value *= 1.0 - dielectric_albedo(l, min(wi.z, 1.0), share, lost);
    }
    float pdf = l.shares.x * wi.z * (1.0 / PI);
    if (l.alpha > 0.0) {
        Microfacet mirror = microfacet_reflection(l.widths, l.wo, wi);
        facet(l, mirror.cosine, reflects, transmits);
        float absent = ANISOTROPY && l.multiple != vec3(0.0) ? missing_towards(l.widths, wi) : lost;
        value += min(passed / l.passed, 1.0) * (mirror.value * reflects + l.multiple * absent);
        pdf += l.shares.y * reflected_share(reflects, transmits) * mirror.pdf;
    }
    if (CLEARCOATS && l.shares.z > 0.0) {
        vec3 above = to_coat(l, wi);
        if (above.z > 0.0) {
            Microfacet coat = microfacet_reflection(vec2(l.coat_alpha), l.coat_wo, above);
            float absent = missing(min(l.coat_wo.z, 1.0), l.coat_alpha);
            float again = coat_multiple(l.coat_alpha) * absent / (1.0 - absent);
            // Light counts by the cosine to the coat's own normal.
            value += l.clearcoat * (fresnel(COAT_INDEX, min(coat.cosine, 1.0)) + again) * coat.value * (above.z / wi.z);
            pdf += l.shares.z * coat.pdf;
        }
    }
    return vec4(value, pdf / all);
}

// A direction in the surface's frame; `choice` in [0, 1) picks the lobe. Zero where the lobe sends nothing.
vec3 physical_direction(Lobes l, vec2 u, float choice) {
    float at = choice * scattered_albedo(l);
    if (at < l.shares.x) return cosine_hemisphere(u);
    if (!CLEARCOATS || at < l.shares.x + l.shares.y) {
        vec3 h = visible_normal(l.widths, l.wo, u);
        vec3 reflects, transmits;
        facet(l, dot(l.wo, h), reflects, transmits);
        vec3 wi = reflect_direction(l.wo, h);
        if (!ROUGH_TRANSMISSION || at - l.shares.x < l.shares.y * reflected_share(reflects, transmits)) return wi.z > 0.0 ? wi : vec3(0.0);
        wi = l.p.body != 0u ? refract_direction(l.wo, h, l.eta) : vec3(wi.xy, -wi.z);
        return wi.z < 0.0 ? wi : vec3(0.0);
    }
    vec3 wi = microfacet_reflected(vec2(l.coat_alpha), l.coat_wo, u);
    if (!NORMAL_MAPS) return wi;
    wi = from_frame(l.coat_normal, wi);
    return wi.z > 0.0 ? wi : vec3(0.0);
}
