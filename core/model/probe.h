// A probe: a place on the picture that a person drags and turns.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <string>

#include "math/motion.h"
#include "model/paint.h"

namespace probewarp {

struct Colour {
    std::uint8_t r = 0, g = 0, b = 0;
    friend bool operator==(const Colour&, const Colour&) = default;
};

/// What a project file holds. Whatever reads probes keeps to it, so that what was opened can be saved and
/// opened again.
inline constexpr double max_probe_coordinate = 1e7;  // image pixels, of rest and now and the radius
inline constexpr double max_probe_angle = 1e6;       // radians
inline constexpr double min_probe_radius = 1e-3;     // image pixels
inline constexpr int max_probe_id = 2'000'000'000;

struct Probe {
    int id = 0;  ///< unique in its document, > 0
    std::string name;
    Colour colour;
    glm::dvec2 rest{0};   ///< image pixels: where it was put on the undeformed picture
    glm::dvec2 now{0};    ///< image pixels: where it is now
    double angle = 0;     ///< radians, clockwise as seen, unwrapped: 4 pi is two turns
    double radius = 100;  ///< image pixels, > 0: how far it reaches
    bool locked = false;  ///< cannot be moved by hand, and painting others leaves its share alone
    bool visible = true;  ///< drawn on the canvas; a hidden probe still deforms
    PaintPtr paint;       ///< over its automatic weights; null: none

    friend bool operator==(const Probe&, const Probe&) = default;
};

/// What the probe does to the plane about `centre` (image pixels): turn by the angle about rest, then move
/// rest to now. Nothing at all, exactly, for a probe that was not moved.
Motion<double> motion_of(const Probe& probe, glm::dvec2 centre);

/// Whether the probe stands where it was put, unturned.
bool at_rest(const Probe& probe);
void put_to_rest(Probe& probe);

/// Colours of new probes in turn: Okabe and Ito's, which colour-blind people can tell apart, then lighter
/// ones.
Colour probe_colour(int index);

/// "#rrggbb".
std::string to_hex(Colour colour);

}  // namespace probewarp
