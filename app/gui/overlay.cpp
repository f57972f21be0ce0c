#include "gui/overlay.h"

#include "editor/painting.h"
#include "render/overlay.h"

namespace probewarp {

OverlayKey overlay_key(const Editor& editor) {
    const bool stiffness = paints_stiffness(editor) && editor.shown_weights != ShownWeights::none;
    if (!stiffness && editor.shown_weights == ShownWeights::chosen &&
        !find_probe(editor.document, editor.selected))
        return {};
    return {editor.shown_weights, stiffness, editor.selected, editor.iso_lines, editor.weights_opacity};
}

OverlayStyle overlay_style(const OverlayKey& key) {
    return {key.stiffness || key.weights == ShownWeights::chosen, key.iso_lines, key.opacity};
}

std::vector<OverlayVertex> overlay_vertices(const Editor& editor, const OverlayKey& key) {
    if (key.weights == ShownWeights::none) return {};
    return key.stiffness ? stiffness_overlay(editor.deformation)
                         : weight_overlay(editor.deformation, key.probe);
}

}  // namespace probewarp
