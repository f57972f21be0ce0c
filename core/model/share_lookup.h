// What each probe's share is anywhere on the picture: at one place, and over the whole picture as rasters.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "model/deformation.h"
#include "model/paint.h"

namespace probewarp {

/// Looks up what each probe's share is anywhere on the picture at rest: the automatic weights interpolated in
/// the mesh, with the paint of that very place settled over them, so that fine paint is not blurred by a
/// coarse mesh. Where the document's stiffness, or its limit on the probes a vertex follows, refines the
/// weights, the vertices' own weights interpolated. Beside the mesh the nearest cell's nearest place says
/// what the automatic weights are. Keeps a reference to `deformation`, which must outlive it unchanged; not
/// for two threads at once.
class ShareLookup {
  public:
    explicit ShareLookup(const Deformation& deformation);
    /// point: image pixels; shares: #probes, sums to 1 (to float's rounding)
    void at(glm::dvec2 point, std::span<float> shares) const;

  private:
    /// Probes whose maps have the same texels, so that a place is found in them once.
    struct Painted {
        PaintMap grid;  ///< the first one's map
        std::vector<std::size_t> probes;
    };

    MeshPoint nearest_place(glm::dvec2 point) const;
    /// Fills paint_ in; returns the largest coverage.
    float sample_paint(glm::dvec2 point) const;

    const Deformation& deformation_;
    std::span<const float> weights_;           ///< #vertices x #probes, row-major: what is interpolated
    std::vector<float> to_share_;              ///< #vertices: 1 / the sum of the row
    std::vector<std::uint32_t> nearest_cell_;  ///< #cells: itself where it is kept
    PictureFrame frame_;
    std::vector<Painted> painted_;                      ///< whose paint is settled here
    std::vector<std::uint8_t> locked_;                  ///< #probes
    std::vector<std::uint32_t> anchored_;               ///< the vertices that are a probe's own, ascending
    mutable std::vector<Paint> paint_;                  ///< #probes: scratch
    mutable std::array<std::vector<float>, 3> opened_;  ///< #probes each: likewise
};

/// A raster over the same rectangle and with the same texels as a paint map.
struct ShareRaster {
    int width = 0, height = 0;
    std::vector<float> share;  ///< height x width, row-major, [0, 1]
};

/// The shares of a probe (its place in the document) at the centres of the texels of `map`.
ShareRaster share_raster(const Deformation& deformation, std::size_t probe, const PaintMap& map);

/// The shares over the picture's rectangle at the centres of width x height pixels, as 1/65535, for each of
/// `probes` (places in the document): height x width, row-major. Each is rounded up or down, and a whole
/// number of 1/65535 stays what it is, so that those of all the document's probes sum to exactly 65535:
/// painted as they are, they settle to themselves.
std::vector<std::vector<std::uint16_t>> weight_images(const Deformation& deformation,
                                                      std::span<const std::size_t> probes, int width,
                                                      int height);

}  // namespace probewarp
