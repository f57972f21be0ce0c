// Undo and redo: the earlier and later values of the document, which share what did not change.
#pragma once

#include <string>
#include <vector>

#include "model/document.h"

namespace probewarp {

struct History {
    struct Step {
        Document document;
        std::string label;      ///< what was done to arrive here: "Move probe"
        std::size_t bytes = 0;  ///< of paint that the step before does not share
    };
    std::vector<Step> steps{1};  ///< at least one; the first is the document as it was opened
    std::size_t at = 0;          ///< the present one
    std::size_t saved = 0;       ///< the one that is on disk; no_step when none is
};

inline constexpr std::size_t no_step = std::size_t(-1);
inline constexpr std::size_t max_steps = 1000;
/// Of paint that the steps keep besides the present's: the oldest are forgotten beyond it.
inline constexpr std::size_t max_history_bytes = std::size_t{512} << 20;

/// A history that begins with `document`; `saved` says whether it is on disk as it stands.
History new_history(Document document, bool saved);

const Document& present(const History& history);
bool is_saved(const History& history);

/// Adds a step and forgets what had been undone. A document that equals the present one adds none.
void commit(History& history, Document document, std::string label);

/// Whether there was a step to take.
bool undo(History& history);
bool redo(History& history);

}  // namespace probewarp
