// ICC profiles: what is kept of a file's own, and one made where a file describes its colours otherwise.
// Private to io.
#pragma once

#include <vector>

#include "io/bytes.h"
#include "model/image.h"

namespace probewarp {

/// A file may have inflated or scattered its profile: no more than this is kept.
inline constexpr std::size_t max_icc_bytes = std::size_t{4} << 20;

/// The profile as an RGB picture needs it: unchanged where it is for RGB; where it is for grey, one for RGB
/// that shows equal samples alike; empty where it is for other colours, cannot be read, or is too large.
std::vector<std::byte> rgb_profile(Bytes profile);

/// An ICC profile that says of the colours what the description says: one made from its cICP, its own, or one
/// made from gamma and chromaticities, whichever comes first. Empty where they are sRGB or nothing is said.
std::vector<std::byte> profile_of(const Description& description);

}  // namespace probewarp
