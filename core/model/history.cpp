#include "model/history.h"

#include <utility>

namespace probewarp {

History new_history(Document document, bool saved) {
    History history;
    history.steps[0] = {std::move(document), {}};
    history.saved = saved ? 0 : no_step;
    return history;
}

const Document& present(const History& history) { return history.steps[history.at].document; }

bool is_saved(const History& history) { return history.at == history.saved; }

void commit(History& history, Document document, std::string label) {
    if (document == present(history)) return;
    if (history.saved != no_step && history.saved > history.at) history.saved = no_step;
    history.steps.resize(history.at + 1);
    history.steps.push_back({std::move(document), std::move(label)});
    ++history.at;
    if (history.steps.size() > max_steps) {
        history.steps.erase(history.steps.begin());
        --history.at;
        history.saved = history.saved == 0 || history.saved == no_step ? no_step : history.saved - 1;
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
