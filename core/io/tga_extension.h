// What the second version of TGA appends to a file: an extension area that says more of the pixels, and a
// footer with the only signature that a TGA can have. Private to io.
#pragma once

#include <vector>

#include "io/bytes.h"
#include "model/image.h"

namespace probewarp {

enum class TgaAlpha {
    unsaid,  ///< no extension area: the header's descriptor decides
    none,    ///< what stands in its place means nothing
    straight,
    premultiplied,
};

struct TgaExtension {
    TgaAlpha alpha = TgaAlpha::unsaid;
    Description description;  ///< gamma and aspect, where they are said
};

bool has_tga_footer(Bytes file);

/// Of a file without a footer, or whose footer points nowhere, nothing is said.
TgaExtension read_tga_extension(Bytes file);

/// Appends both to a file of the first version, where the description has a gamma of its own or pixels that
/// are not square; else does nothing. alpha: whether the file has straight alpha, or none.
void append_tga_extension(std::vector<std::byte>& file, const Description& description, bool alpha);

}  // namespace probewarp
