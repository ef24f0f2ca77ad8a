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
    vec2 p = environment_point(direction);
    return environment_texel(int(p.x), int(p.y)).density;
}

// A direction by the light that comes from it: a texel by the alias table, then evenly over its solid angle.
vec3 sample_environment(uint random, vec2 u, out float density) {
    uint width = frame.environment_width;
    uint slot, fraction;
    umulExtended(random, width * frame.environment_height, slot, fraction);
    AliasSlot entry = environment_slot(slot);
    uint texel = fraction < entry.threshold ? slot : entry.alias;
    uint row = texel / width;
    density = load_environment_texel(int(texel)).density;
    vec2 azimuth = sin_cos_turns((float(texel - row * width) + u.x) / float(width) - 0.5 - frame.environment_rotation);
    // By 1 - cosine of the angle from the nearer pole, 2 sin^2 of its half, which does not cancel.
    uint height = frame.environment_height;
    bool south = 2u * row >= height;
    float step = 0.25 / float(height);
    float upper = sin_cos_turns(float(south ? height - row : row) * step).x;
    float lower = sin_cos_turns(float(south ? height - row - 1u : row + 1u) * step).x;
    float height_below_pole = 2.0 * mix(upper * upper, lower * lower, u.y);
    float cosine = south ? height_below_pole - 1.0 : 1.0 - height_below_pole;
    float sine = sqrt(height_below_pole * (2.0 - height_below_pole));
    return vec3(sine * azimuth.x, cosine, -sine * azimuth.y);
}
