#include "model/history.h"

#include <utility>

namespace probewarp {

History new_history(Document document, bool saved) {
    History history;
    history.steps[0] = {std::move(document), {}, 0};
    history.saved = saved ? 0 : no_step;
    return history;
}

const Document& present(const History& history) { return history.steps[history.at].document; }

bool is_saved(const History& history) { return history.at == history.saved; }

namespace {

std::size_t own_paint(const Document& document, const Document& before) {
    const auto own = [](const PaintPtr& paint, const PaintPtr& other) {
        return paint && paint != other ? own_bytes(*paint, other.get()) : 0;
    };
    std::size_t bytes = own(document.stiffness, before.stiffness);
    for (const Probe& probe : document.probes) {
        const Probe* other = find_probe(before, probe.id);
        bytes += own(probe.paint, other ? other->paint : nullptr);
    }
    return bytes;
}

void forget_first(History& history) {
    history.steps.erase(history.steps.begin());
    --history.at;
    history.saved = history.saved == 0 || history.saved == no_step ? no_step : history.saved - 1;
}

}  // namespace

void commit(History& history, Document document, std::string label) {
    if (document == present(history)) return;
    const std::size_t bytes = own_paint(document, present(history));
    if (history.saved != no_step && history.saved > history.at) history.saved = no_step;
    history.steps.resize(history.at + 1);
    history.steps.push_back({std::move(document), std::move(label), bytes});
    ++history.at;
    if (history.steps.size() > max_steps) forget_first(history);
    std::size_t all = 0;
    for (const History::Step& step : history.steps) all += step.bytes;
    // The step before the present one always stays: what was just done can be undone.
    while (all > max_history_bytes && history.steps.size() > 2) {
        all -= history.steps[1].bytes;  // the first's own is what all the others are compared with
        forget_first(history);
    }
}

bool undo(History& history) {
    if (history.at == 0) return false;
    --history.at;
    return true;
}

bool redo(History& history) {
    if (history.at + 1 >= history.steps.size()) return false;
    ++history.at;
    return true;
}

}  // namespace probewarp
