// What is done to all of a probe's paint at once.
#pragma once

#include <cstddef>

#include "model/brush.h"
#include "model/share_lookup.h"

namespace probewarp {

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

/// The document with the painted values, wherever there is paint of a probe that is not locked, made what
/// actually deforms: in each texel with coverage of each painted probe's own map, the value becomes the share
/// that settles there.
Document normalised_paint(const Deformation& deformation);

/// The document in which, wherever the paint of a probe that is not locked has coverage and the probe is not
/// among the `most` heaviest there (by settled share, the first of equals), its painted value is 0. Requires
/// most > 0.
Document limited_paint(const Deformation& deformation, std::size_t most);

/// How near, in parts of the picture's longer side, a probe must be to another's mirror image.
inline constexpr double counterpart_reach = 1.0 / 20;

/// The probe that mirrors `probe` (places in the document): the one whose rest is nearest to its rest
/// reflected, where that is nearer than counterpart_reach; else itself.
std::size_t counterpart(const Document& document, std::size_t probe, const MirrorAxis& axis);

}  // namespace probewarp
