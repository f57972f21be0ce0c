// Colours that are not RGB, such as printing inks, turned into sRGB. Private to io.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "io/bytes.h"

namespace probewarp {

enum class ForeignColours {
    cmyk,           ///< ink, full is dark
    cmyk_inverted,  ///< as Adobe's programs store it: full is no ink
};

/// Converts pixels of four 8-bit samples where they lie.
class ToSrgb {
  public:
    /// profile: of these colours; without one, or where it is not for them, by the plain formula
    /// (1 - ink) (1 - black).
    ToSrgb(ForeignColours colours, Bytes profile);
    ~ToSrgb();

    /// samples: #pixels x 4; afterwards RGBA, opaque
    void convert(std::span<std::uint8_t> samples) const;

  private:
    struct Transform;
    ForeignColours colours_;
    std::unique_ptr<const Transform> transform_;  ///< null: the plain formula
};

}  // namespace probewarp
