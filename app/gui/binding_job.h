// The binding of the document, worked out beside the window where it takes longer than a frame.
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "model/binding.h"

namespace probewarp {

struct App;

/// Gives up and waits for its thread when it dies.
struct BindingJob {
    Document document;  ///< what is being bound
    std::atomic<bool> given_up = false;
    std::future<std::shared_ptr<const Binding>> result;
    double since = 0;  ///< seconds of ImGui's clock

    BindingJob() = default;
    BindingJob(const BindingJob&) = delete;
    BindingJob& operator=(const BindingJob&) = delete;
    ~BindingJob() {
        given_up = true;
        if (result.valid()) result.wait();
    }
};

/// Brings the editor's deformation up to date. A binding that is ready within a few milliseconds is used at
/// once; meanwhile the last one goes on deforming, where it fits.
void update_deformation(App& app);

/// A sentence on why the deformation is not the document's own (is_deformed); empty where it is.
std::string why_not_deformed(const App& app);

}  // namespace probewarp
