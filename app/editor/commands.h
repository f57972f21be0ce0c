// Every command of the menus, with its shortcut: one table that menus, buttons and keys share.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "editor/editor.h"

namespace probewarp {

/// Keys as their upper-case ASCII, and these.
enum Key : int {
    key_backspace = 8,
    key_escape = 27,
    key_delete = 127,
    key_left = 256,
    key_right,
    key_up,
    key_down
};

struct Shortcut {
    int key = 0;  ///< 0: none
    bool ctrl = false, shift = false;
    friend bool operator==(const Shortcut&, const Shortcut&) = default;
};

/// "Ctrl+Shift+S"
std::string to_text(const Shortcut& shortcut);

struct Command {
    std::string_view menu;  ///< "File"
    std::string_view label;
    Shortcut shortcut;
    /// Why it cannot be used now; empty when it can. Null: it always can.
    std::string (*why_not)(const Editor& editor);
    void (*run)(Editor& editor);
    bool separated = false;  ///< a line above it in the menu
    /// Whether it is switched on; null for what is no switch.
    bool (*on)(const Editor& editor) = nullptr;
};

/// In the menus' order.
std::span<const Command> commands();

/// A second key of a command.
struct Alias {
    Shortcut key;
    std::string_view label;  ///< the command's
};
std::span<const Alias> aliases();

/// Further keys for commands of the table, and keys without a menu: nudging with the arrows, Escape.
/// `held` says that the key repeats, or that another arrow is down already: then a nudge goes on with the
/// step that the last one made. Returns whether the key meant something.
bool press_key(Editor& editor, const Shortcut& key, bool held = false);

const Command& find_command(std::string_view label);

/// Runs the command unless it cannot be used now; then the reason becomes the editor's notice.
void run(Editor& editor, const Command& command);

}  // namespace probewarp
