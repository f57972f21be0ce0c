// ITU-T H.273's code points for colours (cICP in a PNG) as Little CMS's objects. Private to io.
#pragma once

#include <optional>

#include "io/colour_engine.h"
#include "model/image.h"

namespace probewarp {

/// Of colour primaries 1, 4, 5, 6, 9, 11, 12 and 22.
std::optional<Chromaticities> chromaticities_of_primaries(unsigned code);

/// From the signal to linear light, both 0 to 1, of transfer characteristics 1, 4, 5, 6, 8, 13, 14, 15, 16
/// (PQ, where 1 is 10,000 cd/m2) and 18 (HLG, the light of the scene). Null for others. Throws
/// std::bad_alloc.
ToneCurve curve_of_transfer(const ColourEngine& engine, unsigned code);

}  // namespace probewarp
