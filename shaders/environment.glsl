// Light from where rays escape to: a latitude-longitude image, +y up, -z in its middle; twins in src/reference/environment.rs.

// Column and row, in texels from the upper left, where a direction falls.
vec2 environment_point(vec3 direction) {
    float column = angle(direction.x, -direction.z) * (0.5 / PI) + 0.5 + frame.environment_rotation;
    float row = angle(length(direction.xz), direction.y) * (1.0 / PI);
    return vec2(column - floor(column), row) * vec2(frame.environment_width, frame.environment_height);
}

struct EnvironmentTexel {
    vec3 radiance;    // without its factor
    float density;    // of its directions, per steradian
};

EnvironmentTexel load_environment_texel(int index) {
    vec4 texel = uintBitsToFloat(texelFetch(environment_texels, index));
    return EnvironmentTexel(texel.rgb, texel.a);
}

EnvironmentTexel environment_texel(int x, int y) {
    int width = int(frame.environment_width);
    x = x < 0 ? x + width : (x >= width ? x - width : x);
    y = clamp(y, 0, int(frame.environment_height) - 1);
    // A direction that is not a number may give any column.
    return load_environment_texel(y * width + clamp(x, 0, width - 1));
}

// Radiance from a direction, bilinear between the centres of texels.
vec3 environment_radiance(vec3 direction) {
    if (!ENVIRONMENT_IMAGE) return frame.environment;
    vec2 p = environment_point(direction) - 0.5;
    vec2 low = floor(p);
    vec2 f = p - low;
    int x = int(low.x);
    int y = int(low.y);
    vec3 upper = mix(environment_texel(x, y).radiance, environment_texel(x + 1, y).radiance, f.x);
    vec3 lower = mix(environment_texel(x, y + 1).radiance, environment_texel(x + 1, y + 1).radiance, f.x);
    return mix(upper, lower, f.y) * frame.environment;
}

// The density with which sample_environment gives a direction, per steradian.
float environment_density(vec3 direction) {
    if (!ENVIRONMENT_SAMPLING) return 0.0;
    vec2 p = environment_point(direction);
    return environment_texel(int(p.x), int(p.y)).density;
}

// As many numbers are told apart (src/sampling/cdf.rs).
const uint CDF_NUMBERS = 2147483648u;

// Which of `n` entries a number chooses, by the search that begins at this texel: the last one whose numbers begin at or before it. `place`
// is how far into the entry the number falls.
uint search(uint first, uint n, uint number, out float place) {
    uint entry = 0u;
    uint end = CDF_NUMBERS;
    uvec4 starts;
    bvec3 behind;
    // Every 4^k-th start, from the top: the part of them in which the number lies is four in the next level.
    for (int shift = max(findMSB(n - 1u), 0) & ~1; shift >= 0; shift -= 2) {
        starts = texelFetch(environment_choice, int(first + entry));
        first += (n + (4u << shift) - 1u) >> (shift + 2);
        behind = lessThanEqual(starts.yzw, uvec3(number));
        entry = 4u * entry + uint(behind.x) + uint(behind.y) + uint(behind.z);
        if (!behind.z) end = behind.y ? starts.w : (behind.x ? starts.z : starts.y);
    }
    uint start = behind.z ? starts.w : (behind.y ? starts.z : (behind.x ? starts.y : starts.x));
    place = (float(number - start) + 0.5) / float(end - start);
    return entry;
}

// A direction by the light that comes from it: a row, a column, then evenly over the texel's solid angle.
vec3 sample_environment(uvec2 random, out float density) {
    uint width = frame.environment_width;
    uint height = frame.environment_height;
    float u, v;
    uint row = search(0u, height, random.x >> 1u, v);
    uint columns = frame.environment_rows + row * frame.environment_row;
    uint column = search(columns, width, random.y >> 1u, u);
    density = load_environment_texel(int(row * width + column)).density;
    vec2 azimuth = sin_cos_turns((float(column) + u) / float(width) - 0.5 - frame.environment_rotation);
    // By 1 - cosine of the angle from the nearer pole, 2 sin^2 of its half, which does not cancel.
    bool south = 2u * row >= height;
    float step = 0.25 / float(height);
    float upper = sin_cos_turns(float(south ? height - row : row) * step).x;
    float lower = sin_cos_turns(float(south ? height - row - 1u : row + 1u) * step).x;
    float height_below_pole = 2.0 * mix(upper * upper, lower * lower, v);
    float cosine = south ? height_below_pole - 1.0 : 1.0 - height_below_pole;
    float sine = sqrt(height_below_pole * (2.0 - height_below_pole));
    return vec3(sine * azimuth.x, cosine, -sine * azimuth.y);
}
