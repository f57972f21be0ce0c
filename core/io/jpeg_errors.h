// libjpeg with its errors: they are reported by a jump, so every call that may jump happens inside protect(),
// where no C++ object can be jumped over. Private to io.
#pragma once

#include <csetjmp>
#include <cstddef>
#include <cstdio>  // jpeglib.h needs it and does not say so

// The order matters, so they stand apart: jerror.h numbers its messages by what jpeglib.h has defined before.
// Without that it compiles too, with other numbers than the library's.
#include <jpeglib.h>

#include <jerror.h>

namespace probewarp {

enum class JpegTrouble { none, truncated, damaged, unusual, memory, scans, markers };

/// libjpeg's error manager (first member, so that its address is ours) and where it jumps to.
struct JpegErrors {
    jpeg_error_mgr manager;
    std::jmp_buf jump;
    JpegTrouble trouble;
    bool fatal;  ///< libjpeg could not go on
    char message[JMSG_LENGTH_MAX];
};

/// on_message: as libjpeg's emit_message; a level of -1 is a warning, with which it would go on.
void set_up(JpegErrors& errors, void (*on_message)(j_common_ptr codec, int level));

/// Jumps out of the step that protect() runs.
[[noreturn]] void give_up(j_common_ptr codec, JpegTrouble trouble, bool fatal = false);

/// Runs `step`, which calls libjpeg and creates nothing that has a destructor. False where it jumped out.
template <class Step>
[[gnu::noinline]] bool protect(JpegErrors& errors, const Step& step) {
    if (setjmp(errors.jump) != 0) return false;
    step();
    return true;
}

}  // namespace probewarp
