#version 330 core
// Shows the layer in the window: over a checkerboard inside the picture's frame, dimmed on the canvas beside it.

uniform sampler2D layer;  // one texel a pixel
uniform vec4 frame;       // left, top, right, bottom of the picture's frame, target pixels
uniform float square;     // side of a checkerboard square, target pixels
uniform vec3 light;
uniform vec3 dark;
uniform vec3 canvas;

out vec4 shown;

void main() {
    vec2 at = gl_FragCoord.xy;
    vec4 sum = texelFetch(layer, ivec2(at), 0);
    bool inside = at.x >= frame.x && at.y >= frame.y && at.x < frame.z && at.y < frame.w;
    vec2 checks = floor((at - frame.xy) / square);
    vec3 ground = !inside ? canvas : mod(checks.x + checks.y, 2.0) < 0.5 ? light : dark;
    float strength = inside ? 1.0 : 0.4;  // what an export of the frame would cut off
    shown = vec4(ground * (1.0 - sum.a * strength) + sum.rgb * strength, 1.0);
}
