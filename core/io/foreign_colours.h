// Colours that are not RGB as a screen has it, such as printing inks, turned into sRGB. Private to io.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>

#include "io/bytes.h"

namespace probewarp {

/// The sample of full intensity, of integers or of floating-point numbers.
template <class Sample>
constexpr Sample full = std::is_floating_point_v<Sample> ? Sample(1) : std::numeric_limits<Sample>::max();

enum class ForeignColours {
    cmyk,  ///< printing inks, as Adobe's programs store them: full is no ink
    /// CIE L*a*b* under D50, as ICC profiles of version 4 have it: L of 100 is full, and the 256 numbers from
    /// -128 to 127 of a and b go from 0 to full. The fourth sample means nothing.
    lab,
    linear_rgb,  ///< amounts of light, of floating-point samples only. The fourth sample means nothing.
};

/// Converts pixels of four samples where they lie: of 8 bits, of 16, or floating-point ones from 0 to 1.
class ToSrgb {
  public:
    /// profile: of these colours. Without one, or where it is not for them: inks by the plain formula
    /// (1 - ink) (1 - black), light as of sRGB's primaries.
    /// bits: of the samples, 8, 16 or 32
    ToSrgb(ForeignColours colours, Bytes profile, int bits = 8);
    ~ToSrgb();

    /// samples: #pixels x 4, of the bits that were said; afterwards RGBA, opaque
    void convert(std::span<std::uint8_t> samples) const;
    void convert(std::span<std::uint16_t> samples) const;
    void convert(std::span<float> samples) const;  ///< beyond 0 and 1 where sRGB has no such colour

  private:
    struct Transform;
    /// Null for inks without a profile of them.
    static std::unique_ptr<const Transform> transform_of(ForeignColours colours, Bytes profile, int bits);
    template <class Sample>
    void convert_all(std::span<Sample> samples) const;

    std::unique_ptr<const Transform> transform_;  ///< null: the plain formula
};

}  // namespace probewarp
