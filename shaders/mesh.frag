#version 330 core
// Looks up the picture at rest. The fragment's own place is exact, so interpolating the way back (rather than the
// texture coordinate) leaves an undeformed picture at exactly its pixel centres.

in vec2 back;

uniform vec2 origin;
uniform vec2 scale;
uniform sampler2D picture;  // straight alpha, alpha-weighted mipmaps
uniform int last_level;

out vec4 layer;  // colour times weight, weight: sums of these stay right under filtering, folding and averaging

// The weight of a texel is its alpha, but never nothing: so a colour under zero alpha comes through where it is alone,
// and vanishes (2^-40 rounds to no alpha) beside any texel that can be seen.
const float least_weight = 1.0 / 1099511627776.0;

// Vertices are known to about this (float, pictures up to 32768 pixels): nearer a pixel's centre is on it.
const float on_centre = 1.0 / 512.0;

vec4 texel(int x, int y, int level) {
    vec4 colour = texelFetch(picture, ivec2(x, y), level);
    float weight = max(colour.a, least_weight);
    return vec4(colour.rgb * weight, weight);
}

// at: pixels of that level
vec4 bilinear(vec2 at, int level) {
    vec2 place = at - 0.5;
    vec2 centre = round(place);
    place = mix(place, centre, lessThan(abs(place - centre), vec2(on_centre)));
    vec2 corner = floor(place), part = place - corner;
    ivec2 last = textureSize(picture, level) - 1;
    ivec2 near = clamp(ivec2(corner), ivec2(0), last), far = clamp(ivec2(corner) + 1, ivec2(0), last);
    return mix(mix(texel(near.x, near.y, level), texel(far.x, near.y, level), part.x),
               mix(texel(near.x, far.y, level), texel(far.x, far.y, level), part.x), part.y);
}

void main() {
    vec2 pixel = 1.0 / scale;  // image pixels
    vec2 at = gl_FragCoord.xy * pixel + origin + back;
    vec2 across = dFdx(back) + vec2(pixel.x, 0.0), down = dFdy(back) + vec2(0.0, pixel.y);
    float footprint = max(length(across), length(down));
    // Below 2 % of shrinking there is nothing to alias, and an unshrunk picture stays exact.
    float level = footprint < 1.02 ? 0.0 : min(log2(footprint), float(last_level));
    int fine = int(level);
    layer = bilinear(at / exp2(float(fine)), fine);
    float part = level - float(fine);
    if (part > 0.0 && fine < last_level) layer = mix(layer, bilinear(at / exp2(float(fine + 1)), fine + 1), part);
}
