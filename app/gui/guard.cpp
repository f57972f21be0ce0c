#include "gui/guard.h"

#include <algorithm>
#include <cstring>
#include <new>
#include <string_view>

#include "gui/app.h"

namespace probewarp {

namespace {

constexpr const char* no_memory = "There is not enough memory for that.";
constexpr const char* no_reason = "Something failed for an unknown reason.";

void keep(Trouble& trouble, std::string_view reason) noexcept {
    const std::size_t length = std::min(reason.size(), trouble.reason.size() - 1);
    std::memcpy(trouble.reason.data(), reason.data(), length);
    trouble.reason[length] = '\0';
}

}  // namespace

std::string failure_text(const std::exception_ptr& failure) {
    try {
        std::rethrow_exception(failure);
    } catch (const std::bad_alloc&) {
        return no_memory;
    } catch (const std::exception& error) {
        return error.what();
    } catch (...) {
        return no_reason;
    }
}

App& app_of(GLFWwindow* window) { return *static_cast<App*>(glfwGetWindowUserPointer(window)); }

void recover(App& app) noexcept {
    try {
        throw;
    } catch (const std::bad_alloc&) {
        keep(app.trouble, no_memory);
    } catch (const std::exception& error) {
        keep(app.trouble, error.what());
    } catch (...) {
        keep(app.trouble, no_reason);
    }
    if (app.editor.gesture) cancel(app.editor);
    app.trouble.restores = true;
    app.wake();
}

void settle_trouble(App& app) noexcept {
    Trouble& trouble = app.trouble;
    try {
        if (trouble.restores) restore(app.editor);
        trouble.restores = false;
        if (trouble.reason[0] != '\0') say(app, Tone::error, trouble.reason.data());
        trouble.reason[0] = '\0';
    } catch (const std::exception&) {  // there will be memory again: tried before every frame
        app.wake();
    }
}

}  // namespace probewarp
