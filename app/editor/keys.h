// Which shortcut a key of a person's keyboard means, whatever its layout. Knows no toolkit: keys come as the
// character that stands on them on a US keyboard, with the one that the layout writes there.
#pragma once

#include <array>

#include "editor/commands.h"

namespace probewarp {

/// A key that was pressed.
struct LayoutKey {
    /// Its place, as the upper-case ASCII of a US keyboard ('A', '1', '['), or a Key; 0: none of these.
    int position = 0;
    char32_t label = 0;        ///< what it writes without Shift, a Unicode code point; 0: nothing
    bool latin_layout = true;  ///< see writes_latin
};

/// Whether a layout writes Latin letters, by the labels of the 26 keys where a US keyboard has A to Z. On
/// others, such as Russian and Greek ones, letters count by their places on a US keyboard.
bool writes_latin(const std::array<char32_t, 26>& labels);

/// With Ctrl, and for keys that write nothing: by the key's label, else by its place. Shift counts.
Shortcut shortcut_of_key(const LayoutKey& key, bool ctrl, bool shift);

/// Without Ctrl: `typed` is the code point that the key wrote with Shift or AltGr. With letters `shift`
/// counts and Caps Lock does not; digits and signs are what was typed, however that was.
Shortcut shortcut_of_character(char32_t typed, const LayoutKey& key, bool shift);

}  // namespace probewarp
