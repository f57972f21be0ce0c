// The document's deformation, worked out beside the window where that takes longer than a frame: a new
// binding, or weights to be settled on a large mesh.
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <string>

#include "model/deformation.h"

namespace probewarp {

struct App;

/// Gives up and waits for its thread when it dies.
struct DeformJob {
    Document document;   ///< what is being deformed
    bool binds = false;  ///< whether it makes a binding, rather than only what follows from one
    std::atomic<bool> given_up = false;
    bool bound = false;  ///< whether there is a binding; to be looked at when it has ended
    std::future<Deformation> result;
    double milliseconds = 0;  ///< what deforming took, without the binding; there with the result
    double since = 0;         ///< seconds of ImGui's clock

    DeformJob() = default;
    DeformJob(const DeformJob&) = delete;
    DeformJob& operator=(const DeformJob&) = delete;
    ~DeformJob() {
        given_up = true;
        if (result.valid()) result.wait();
    }
};

/// Why a document could not be deformed.
struct DeformFailure {
    Document document;
    bool binding = false;  ///< whether for want of a binding, rather than of what follows from one
    std::string reason;
};

/// Brings the editor's deformation up to date. One that is ready within a few milliseconds is used at once;
/// meanwhile the last weights go on deforming, where they fit.
void update_deformation(App& app);

/// A sentence on why the deformation is not the document's own (is_deformed); empty where it is.
std::string why_not_deformed(const App& app);

}  // namespace probewarp
