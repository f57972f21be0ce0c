// Whether the processor or the vertex shader deforms: measured on a small mesh, once for a context.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/deform_by.h"
#include "model/deform_tiles.h"
#include "render/drawn_mesh.h"

namespace probewarp {

/// What one step of a drag takes until its vertices can be drawn, milliseconds: the least of a few.
struct DeformTimes {
    double processor = 0, shader = 0;
};

/// Measures in steps of a few milliseconds (the first ones longer, where a software rasteriser compiles), so
/// that a window stays alive meanwhile.
class DeformTrial {
  public:
    static constexpr int cells = 100, probes = 8;
    static constexpr std::size_t vertices = (cells + 1) * (cells + 1);

    /// Needs a loaded context, which must outlive it. Throws Error where that has no buffer as large.
    DeformTrial();

    bool done() const { return step_ == steps; }
    /// Throws Error where the driver cannot do what the shader needs.
    void step();
    /// Requires done().
    DeformTimes times() const { return least_; }

  private:
    static constexpr int steps = 12;  ///< by turns; the first of each is not counted

    double milliseconds_by_processor();
    double milliseconds_by_shader();
    void draw();

    std::shared_ptr<const Mesh> grid_;
    std::vector<float> weights_;
    WeightTiles tiles_;
    OthersSum others_;
    std::vector<Motion<double>> motions_;
    std::vector<DualComplex<float>> transformations_;
    std::vector<glm::vec2> now_;
    DrawnMesh mesh_;
    LazyProgram program_;
    Target target_;
    int step_ = 0;
    DeformTimes least_;
};

/// The whole trial at once; empty where the driver cannot shade it.
std::optional<DeformTimes> measured_deform_times();

struct DeformChoice {
    DeformBy by = DeformBy::processor;  ///< never automatic
    std::string why;                    ///< a clause: "llvmpipe draws in software"
};

/// A software rasteriser never shades unless that is `wanted`; else it is who was quicker, and before that is
/// known the processor. renderer: as renderer_name() gives it
DeformChoice choose_deform(DeformBy wanted, const std::string& renderer,
                           const std::optional<DeformTimes>& times);

}  // namespace probewarp
