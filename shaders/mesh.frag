#version 330 core
// Looks up the picture at rest. The fragment's own place is exact, so interpolating the way back (rather than the
// texture coordinate) leaves an undeformed picture at exactly its pixel centres.

in vec2 back;

uniform vec2 origin;
uniform vec2 scale;
uniform sampler2D picture;  // straight alpha, alpha-weighted mipmaps
uniform int last_level;

#ifdef OVERLAY
in vec4 shade;            // colour and value
uniform int heat;         // 1: the value in the heat map's colours; 0: the colour
uniform int iso_lines;    // 1: a line at every tenth of the value
uniform float opacity;
uniform vec3 heat_colours[4];
#endif

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

#ifdef OVERLAY
vec3 overlaid() {
    float at = clamp(shade.a, 0.0, 1.0) * 3.0;
    int stop = min(int(at), 2);
    vec3 colour = heat == 1 ? mix(heat_colours[stop], heat_colours[stop + 1], at - float(stop)) : shade.rgb;
    float tenths = shade.a * 10.0, step = fwidth(tenths);
    float off = abs(fract(tenths - 0.5) - 0.5);  // from the nearest whole tenth
    // Nothing ends at 0 and 1: a line there would only show where the mesh is cut.
    float tenth = round(tenths);
    bool drawn = iso_lines == 1 && tenth > 0.5 && tenth < 9.5;
    // White on dark and dark on light, about a pixel wide; where the value is flat there is no line.
    vec3 ink = dot(colour, vec3(0.3, 0.6, 0.1)) > 0.5 ? vec3(0.05) : vec3(1.0);
    float line = step > 1e-5 ? 1.0 - smoothstep(0.5, 1.3, off / step) : 0.0;
    return mix(colour, ink, drawn ? 0.8 * line : 0.0);
}
#endif

vec4 weighted_colour() {
    vec2 pixel = 1.0 / scale;  // image pixels
    vec2 at = gl_FragCoord.xy * pixel + origin + back;
    vec2 across = dFdx(back) + vec2(pixel.x, 0.0), down = dFdy(back) + vec2(0.0, pixel.y);
    float footprint = max(length(across), length(down));
    // Below 2 % of shrinking there is nothing to alias, and an unshrunk picture stays exact.
    float level = footprint < 1.02 ? 0.0 : min(log2(footprint), float(last_level));
    int fine = int(level);
    vec4 colour = bilinear(at / exp2(float(fine)), fine);
    float part = level - float(fine);
    if (part > 0.0 && fine < last_level) colour = mix(colour, bilinear(at / exp2(float(fine + 1)), fine + 1), part);
    return colour;
}

void main() {
    layer = weighted_colour();
#ifdef OVERLAY
    layer.rgb = mix(layer.rgb, overlaid() * layer.a, opacity);
#endif
}
