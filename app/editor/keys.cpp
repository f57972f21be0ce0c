#include "editor/keys.h"

#include <algorithm>

namespace probewarp {

namespace {

bool is_small_letter(char32_t c) { return c >= 'a' && c <= 'z'; }

int upper(char32_t c) { return int(is_small_letter(c) ? c - 'a' + 'A' : c); }

bool is_ascii_sign(char32_t c) { return c > ' ' && c < 0x7f; }

bool is_letter_key(int position) { return position >= 'A' && position <= 'Z'; }

bool is_digit(char32_t c) { return c >= '0' && c <= '9'; }

/// Latin letters with accents, which are no other key's: on a German keyboard the "ü" is no "[".
bool is_accented_latin(char32_t c) { return c >= 0xa0 && c < 0x250; }

}  // namespace

bool writes_latin(const std::array<char32_t, 26>& labels) {
    return std::count_if(labels.begin(), labels.end(), is_small_letter) > 13;
}

Shortcut shortcut_of_key(const LayoutKey& key, bool ctrl, bool shift) {
    // French keyboards, for one, have the digits on Shift.
    const bool shifted_digit =
        is_digit(char32_t(key.position)) && !is_digit(key.label) && !is_small_letter(key.label);
    const bool by_place =
        !is_ascii_sign(key.label) || shifted_digit || (!key.latin_layout && is_letter_key(key.position));
    return {by_place ? key.position : upper(key.label), ctrl, shift};
}

Shortcut shortcut_of_character(char32_t typed, const LayoutKey& key, bool shift) {
    if (!key.latin_layout && is_letter_key(key.position)) return {key.position, false, shift};
    if (is_ascii_sign(typed)) {
        const char32_t small = typed >= 'A' && typed <= 'Z' ? typed - 'A' + 'a' : typed;
        return {upper(small), false, is_small_letter(small) && shift};
    }
    if (key.latin_layout || is_accented_latin(typed) || !is_ascii_sign(char32_t(key.position))) return {};
    return {key.position, false, false};
}

}  // namespace probewarp
