// Owning handles to Little CMS's objects. Private to io.
#pragma once

#include <lcms2.h>

#include <memory>
#include <new>

#include "io/bytes.h"

namespace probewarp {

/// A context of its own, in which faulty profiles are silent.
struct ColourEngine {
    cmsContext context;

    ColourEngine() : context(cmsCreateContext(nullptr, nullptr)) {
        if (!context) throw std::bad_alloc();
        cmsSetLogErrorHandlerTHR(context, [](cmsContext, cmsUInt32Number, const char*) {});
    }
    ColourEngine(const ColourEngine&) = delete;
    ColourEngine& operator=(const ColourEngine&) = delete;
    ~ColourEngine() { cmsDeleteContext(context); }
};

struct CloseProfile {
    void operator()(void* profile) const { cmsCloseProfile(profile); }
};
/// Null where there is none. Dies before its engine.
using Profile = std::unique_ptr<void, CloseProfile>;

struct FreeCurve {
    void operator()(cmsToneCurve* curve) const { cmsFreeToneCurve(curve); }
};
/// Null where there is none. Dies before its engine.
using ToneCurve = std::unique_ptr<cmsToneCurve, FreeCurve>;

struct DeleteTransform {
    void operator()(void* transform) const { cmsDeleteTransform(transform); }
};
/// Null where there is none. Dies before its engine.
using ColourTransform = std::unique_ptr<void, DeleteTransform>;

/// Null where the bytes are no ICC profile.
inline Profile open_profile(const ColourEngine& engine, Bytes icc) {
    return Profile(cmsOpenProfileFromMemTHR(engine.context, icc.data(), cmsUInt32Number(icc.size())));
}

}  // namespace probewarp
