#include "gui/shown_weights.h"

#include "editor/painting.h"
#include "render/overlay.h"

namespace probewarp {

OverlayKey overlay_key(const Editor& editor) {
    const bool pins = paints_stiffness(editor) && editor.shown_weights != ShownWeights::none;
    if (!pins && editor.shown_weights == ShownWeights::chosen &&
        !find_probe(editor.document, editor.selected))
        return {};
    return {editor.shown_weights,
            pins,
            pins ? editor.document.stiffness : nullptr,
            editor.selected,
            editor.iso_lines,
            editor.weights_opacity};
}

OverlayStyle overlay_style(const OverlayKey& key) {
    return {key.pins || key.weights == ShownWeights::chosen, key.iso_lines, key.opacity};
}

std::vector<OverlayVertex> overlay_vertices(const Editor& editor, const OverlayKey& key) {
    if (key.weights == ShownWeights::none) return {};
    return key.pins ? stiffness_overlay(editor.deformation, key.stiffness.get())
                    : weight_overlay(editor.deformation, key.probe);
}

}  // namespace probewarp
