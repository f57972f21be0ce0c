#version 330 core
// Turns the layer of weighted colours into the straight-alpha integers of a file.

uniform sampler2D layer;  // samples x samples texels a pixel
uniform int samples;
uniform vec4 background;  // straight colour; alpha 0 keeps the picture's own transparency, 1 fills
uniform float largest;    // 255 or 65535

out uvec4 rgba;

void main() {
    vec4 sum = vec4(0.0);
    ivec2 first = ivec2(gl_FragCoord.xy) * samples;
    for (int y = 0; y < samples; ++y)
        for (int x = 0; x < samples; ++x) sum += texelFetch(layer, first + ivec2(x, y), 0);
    vec3 colour = sum.a > 0.0 ? sum.rgb / sum.a : vec3(0.0);
    float alpha = sum.a / float(samples * samples);
    if (background.a > 0.0) {
        colour = mix(background.rgb, colour, alpha);
        alpha = 1.0;
    }
    rgba = uvec4(clamp(vec4(colour, alpha), 0.0, 1.0) * largest + 0.5);
}
