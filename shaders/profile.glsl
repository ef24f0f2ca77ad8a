// Photometric profiles: the intensity of a lamp in a direction; the twins are in src/reference/profile.rs. A profile lies behind the luminaires: a texel with how
// many vertical and horizontal angles there are, then their numbers, four a texel: vertical angles, horizontal angles, candelas (src/gpu/pack/luminaire.rs).

float profile_number(uint profile, uint index) {
    return uintBitsToFloat(texelFetch(luminaires, int(profile + 1u + (index >> 2)))[index & 3u]);
}

// Which two of `n` rising angles from `first` on a number lies between, as the index of the lower, and how far it is from there to the upper.
uint interval(uint profile, uint first, uint n, float x, out float share) {
    uint low = 0u;
    uint high = n - 1u;
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (profile_number(profile, first + middle) <= x) low = middle;
        else high = middle;
    }
    float a = profile_number(profile, first + low);
    float b = profile_number(profile, first + low + 1u);
    share = clamp((x - a) / (b - a), 0.0, 1.0);
    return low;
}

// Candelas of a profile at these angles in degrees: bilinear, and 0 beyond the vertical ones.
float candela(uint profile, float vertical, float horizontal) {
    uvec4 size = texelFetch(luminaires, int(profile));
    uint rows = size.x;
    if (vertical < profile_number(profile, 0u) || vertical > profile_number(profile, rows - 1u)) return 0.0;
    float v, h;
    uint lower = interval(profile, 0u, rows, vertical, v);
    uint at = size.x + size.y + lower;
    float a = mix(profile_number(profile, at), profile_number(profile, at + 1u), v);
    if (size.y == 1u) return a;
    uint left = interval(profile, size.x, size.y, horizontal, h);
    at += left * rows;
    a = mix(profile_number(profile, at), profile_number(profile, at + 1u), v);
    float b = mix(profile_number(profile, at + rows), profile_number(profile, at + rows + 1u), v);
    return mix(a, b, h);
}

// Candelas in which a luminaire sends along `direction`, a unit vector.
float photometric_intensity(Luminaire light, vec3 direction) {
    const float degrees = 180.0 / PI;
    float x = dot(direction, light.c);
    float y = dot(direction, light.normal);
    float vertical = min(angle(length(vec2(x, y)), dot(direction, light.b)) * degrees, 180.0);
    float horizontal = angle(y, x) * degrees;
    return candela(light.triangle, vertical, horizontal < 0.0 ? horizontal + 360.0 : horizontal);
}
