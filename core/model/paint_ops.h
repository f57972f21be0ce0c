// What is done to all of a probe's paint at once, and the weights over the whole picture as rasters.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "model/brush.h"
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
    /// Fills paint_ in; returns whether there is any coverage.
    bool sample_paint(glm::dvec2 point) const;

    const Deformation& deformation_;
    std::span<const float> weights_;           ///< #vertices x #probes, row-major: what is interpolated
    std::vector<float> to_share_;              ///< #vertices: 1 / the sum of the row
    std::vector<std::uint32_t> nearest_cell_;  ///< #cells: itself where it is kept
    PictureFrame frame_;
    std::vector<Painted> painted_;      ///< whose paint is settled here
    std::vector<std::uint8_t> locked_;  ///< #probes
    mutable std::vector<Paint> paint_;  ///< #probes: scratch
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

/// A map like `map` (its size and extent) that covers everything with these values.
PaintMap paint_of(const PaintMap& map, const ShareRaster& raster);

/// A map like `map` that covers everything with one value.
PaintMap filled(const PaintMap& map, float value);

// The operations on a probe's shares, which give new ones.

/// 1 - share.
ShareRaster inverted(ShareRaster raster);

/// A Gaussian of standard deviation `radius` texels (0 changes nothing), cut at four of them. What lies
/// beyond the edge counts for nothing, so that a constant stays one.
ShareRaster blurred(const ShareRaster& raster, double radius);

/// black becomes 0, white 1, what is between follows ((s - black) / (white - black))^(1 / gamma). Requires
/// black < white, gamma > 0.
ShareRaster levelled(ShareRaster raster, float black, float white, float gamma);

/// A side of an axis, as seen by one who looks along it: from below upwards where its angle is 0.
enum class Side { left, right };

/// `onto` with everything beyond the axis, seen from side `side`, replaced by what `from` has on that side,
/// reflected; what `onto` has on the side itself stays. Where `from` has no paint there, there is none on the
/// other. For a probe and its counterpart: each one's map onto the other's makes the weights symmetric.
PaintMap mirrored_paint(const PaintMap& onto, const PaintMap& from, const PictureFrame& frame,
                        const MirrorAxis& axis, Side side);

/// The map with what is on one side of the axis reflected to the other: mirrored_paint onto itself.
PaintMap mirrored_paint(const PaintMap& map, const PictureFrame& frame, const MirrorAxis& axis, Side side);

/// The document with the painted values, wherever there is paint, made what actually deforms: in each texel
/// with coverage of each painted probe's own map, the value becomes the share that settles there.
Document normalised_paint(const Deformation& deformation);

/// The document in which, wherever a probe's paint has coverage and the probe is not among the `most`
/// heaviest there (by settled share, the first of equals), its painted value is 0. Requires most > 0.
Document limited_paint(const Deformation& deformation, std::size_t most);

/// How near, in parts of the picture's longer side, a probe must be to another's mirror image.
inline constexpr double counterpart_reach = 1.0 / 20;

/// The probe that mirrors `probe` (places in the document): the one whose rest is nearest to its rest
/// reflected, where that is nearer than counterpart_reach; else itself.
std::size_t counterpart(const Document& document, std::size_t probe, const MirrorAxis& axis);

}  // namespace probewarp
