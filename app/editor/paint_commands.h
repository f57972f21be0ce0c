// The Weights menu: what is done to all of the chosen probe's paint, or to everyone's, at once.
#pragma once

#include "editor/editor.h"

namespace probewarp {

/// Why a command cannot change the chosen probe; empty where it can.
std::string needs_unlocked(const Editor& editor);
/// ... or has no paint to copy.
std::string needs_paint(const Editor& editor);
/// ... or has no paint that could be changed.
std::string needs_own_paint(const Editor& editor);
std::string needs_any_paint(const Editor& editor);
std::string needs_copied_paint(const Editor& editor);
std::string needs_stiffness(const Editor& editor);

// Each is a step of the history, at once or (where every texel is worked out anew) by a Task.
void fill_paint(Editor& editor);  ///< with the brush's value
void invert_paint(Editor& editor);
void blur_paint(Editor& editor);
void level_paint(Editor& editor, float black, float white, float gamma);
void copy_paint(Editor& editor);
void paste_paint(Editor& editor);
void mirror_left_to_right(Editor& editor);
void mirror_right_to_left(Editor& editor);
void limit_paint(Editor& editor);  ///< to 4 probes a place
void normalise_paint(Editor& editor);
void clear_paint(Editor& editor);
void clear_all_paint(Editor& editor);
void clear_stiffness(Editor& editor);

}  // namespace probewarp
