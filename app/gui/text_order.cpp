#include "gui/text_order.h"

#include <fribidi.h>

#include <algorithm>
#include <vector>

namespace probewarp {

namespace {

/// Hebrew is the first script that runs from right to left; its characters begin with this byte.
bool may_run_left(const std::string& text) {
    return std::any_of(text.begin(), text.end(),
                       [](char c) { return static_cast<unsigned char>(c) >= 0xD6; });
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
