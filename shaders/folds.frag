#version 330 core
// Triangles that lie turned over: white with dark hatching, so that they are seen on any picture.

uniform float period;  // target pixels along a row, from one dark line to the next

out vec4 shown;

void main() {
    float off = abs(fract((gl_FragCoord.x + gl_FragCoord.y) / period) - 0.5) * period;  // from the middle of a line
    float dark = clamp(period / 4.0 - off + 0.5, 0.0, 1.0);
    shown = vec4(mix(vec3(1.0), vec3(13.0, 15.0, 18.0) / 255.0, dark), 1.0);
}
