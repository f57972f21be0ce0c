#version 330 core
// Places the deformed mesh in the target and hands on how far each vertex moved.

layout(location = 0) in vec2 rest;  // image pixels
layout(location = 1) in vec2 now;   // image pixels

uniform vec2 origin;  // image pixels: what the target's first corner shows
uniform vec2 scale;   // target pixels per image pixel
uniform vec2 size;    // of the target, pixels

#ifdef OVERLAY
layout(location = 2) in vec4 overlay;  // colour and value
out vec4 shade;
#endif

out vec2 back;  // image pixels: from where the vertex is to where it was

void main() {
    back = rest - now;
#ifdef OVERLAY
    shade = overlay;
#endif
    // The target's first row is the picture's top row: image y grows with the row, so nothing is ever flipped.
    gl_Position = vec4((now - origin) * scale / size * 2.0 - 1.0, 0.0, 1.0);
}
