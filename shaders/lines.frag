#version 330 core
// The mesh's lines, in one colour.

uniform vec4 colour;

out vec4 shown;

void main() { shown = colour; }
