#version 330 core
// Moves the vertices, once each, into a buffer that all drawing takes them from: the same sum as
// core/model/deform.cpp, deform_dlb.

layout(location = 0) in vec2 rest;  // image pixels

uniform samplerBuffer weights;          // #vertices x #probes, row-major
uniform samplerBuffer transformations;  // #probes: p0 and p1 of each DCN about the centre
uniform int probes;
uniform vec2 centre;  // image pixels

out vec2 now;  // image pixels

const float cancelled_share = 1e-6;
const float smallest = 1.17549435e-38;  // of what a float holds with all its digits

void main() {
    vec4 s = vec4(0.0), heaviest = vec4(0.0);
    float total = 0.0, most = -1.0;
    for (int i = 0; i < probes; ++i) {
        float weight = texelFetch(weights, gl_VertexID * probes + i).x;
        vec4 p = texelFetch(transformations, i);
        s += weight * p;
        total += abs(weight);
        if (abs(weight) > most) {
            most = abs(weight);
            heaviest = p;
        }
    }
    float least = cancelled_share * total;
    if (!(dot(s.xy, s.xy) >= max(least * least, smallest))) s = heaviest;
    vec2 v = rest - centre;
    vec2 turned = s.zw + s.y * vec2(-v.y, v.x);
    vec2 way = 2.0 / dot(s.xy, s.xy) * vec2(dot(s.xy * vec2(1.0, -1.0), turned), dot(s.xy, turned.yx));
    now = rest + (probes > 0 ? way : vec2(0.0));
}
