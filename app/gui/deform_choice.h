// Who deforms in the window: measured once, when nothing else is to be done; and the vertex shader's turn.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "render/deform_trial.h"

namespace probewarp {

struct App;

/// The measurement as far as it is.
struct DeformMeasurement {
    std::unique_ptr<DeformTrial> trial;  ///< while it is under way
    std::optional<DeformTimes> times;
    bool over = false;
};

/// Whether it is time to go on measuring: a picture is shown, and nothing moves.
bool wants_trial(const App& app);
/// Takes one step of the trial.
void advance_trial(App& app);

/// Who moves the vertices while a probe of the present document is dragged: what was asked for or is quicker,
/// as far as the shader can do it.
DeformChoice deform_choice(const App& app);

/// Whether the vertex shader moves the vertices now. It does so only while a probe is dragged: at rest the
/// processor has them, which the pointer, the brush and the export ask for.
bool is_shaded(const App& app);

/// "deform 0.31 ms, drags by processor (0.06 ms; shader 3.12 ms)": the first is what the processor took last;
/// while the shader moves the vertices "deform by shader (...)".
std::string deform_facts(const App& app);
/// What these times are, in a few sentences.
std::string deform_explanation(const App& app);

}  // namespace probewarp
