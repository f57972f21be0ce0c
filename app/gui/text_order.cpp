#include "gui/text_order.h"

#include <fribidi.h>

#include <algorithm>
#include <vector>

namespace probewarp {

namespace {

/// Whether a character of the blocks from Hebrew to Arabic, or of their presentation forms, is in it.
bool may_run_left(const std::string& text) {
    for (std::size_t i = 0; i + 1 < text.size(); ++i) {
        const auto lead = static_cast<unsigned char>(text[i]), next = static_cast<unsigned char>(text[i + 1]);
        const bool two_bytes = lead >= 0xD6 && lead <= 0xDF;                      // U+0580 to U+07FF
        const bool three_bytes = (lead == 0xE0 && next < 0xA4) ||                 // U+0800 to U+08FF
                                 (lead == 0xEF && next >= 0xAC && next <= 0xBB);  // U+FB00 to U+FEFF
        if (two_bytes || three_bytes) return true;
    }
    return false;
}

}  // namespace

std::string visual_order(const std::string& text) {
    if (!may_run_left(text)) return text;
    std::vector<FriBidiChar> logical(text.size() + 1), visual(text.size() + 1);
    const FriBidiStrIndex count = fribidi_charset_to_unicode(FRIBIDI_CHAR_SET_UTF8, text.c_str(),
                                                             FriBidiStrIndex(text.size()), logical.data());
    FriBidiParType line = FRIBIDI_PAR_LTR;
    if (fribidi_log2vis(logical.data(), count, &line, visual.data(), nullptr, nullptr, nullptr) == 0)
        return text;
    visual.resize(std::size_t(count));
    std::erase(visual, FriBidiChar(FRIBIDI_CHAR_FILL));  // in the place of letters that became one
    std::string out(visual.size() * 4 + 1, '\0');
    out.resize(std::size_t(fribidi_unicode_to_charset(FRIBIDI_CHAR_SET_UTF8, visual.data(),
                                                      FriBidiStrIndex(visual.size()), out.data())));
    return out;
}

}  // namespace probewarp
