#include "model/probe.h"

#include <fmt/format.h>

namespace probewarp {

Motion<double> motion_of(const Probe& probe, glm::dvec2 centre) {
    return motion(probe.angle, to_complex(probe.rest - centre), to_complex(probe.now - centre));
}

bool at_rest(const Probe& probe) { return probe.rest == probe.now && probe.angle == 0; }

void put_to_rest(Probe& probe) {
    probe.now = probe.rest;
    probe.angle = 0;
}

Colour probe_colour(int index) {
    static constexpr std::array<Colour, 12> colours{{{0xe6, 0x9f, 0x00},
                                                     {0x56, 0xb4, 0xe9},
                                                     {0x00, 0x9e, 0x73},
                                                     {0xf0, 0xe4, 0x42},
                                                     {0xcc, 0x79, 0xa7},
                                                     {0xd5, 0x5e, 0x00},
                                                     {0xf3, 0xcf, 0x80},
                                                     {0xab, 0xda, 0xf4},
                                                     {0x80, 0xcf, 0xb9},
                                                     {0xf8, 0xf2, 0xa1},
                                                     {0xe6, 0xbc, 0xd3},
                                                     {0xea, 0xaf, 0x80}}};
    return colours[std::size_t(index) % colours.size()];
}

std::string to_hex(Colour colour) { return fmt::format("#{:02x}{:02x}{:02x}", colour.r, colour.g, colour.b); }

}  // namespace probewarp
