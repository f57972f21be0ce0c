#include "io/jpeg_errors.h"

namespace probewarp {

namespace {

JpegTrouble trouble_of(int code) {
    switch (code) {
        case JERR_OUT_OF_MEMORY:
        case JERR_NO_BACKING_STORE:
            return JpegTrouble::memory;
        case JERR_BAD_PRECISION:       // 12 bits a sample
        case JERR_SOF_UNSUPPORTED:     // lossless or hierarchical
        case JERR_CONVERSION_NOTIMPL:  // a number of components that has no usual meaning
            return JpegTrouble::unusual;
        default:
            return JpegTrouble::damaged;
    }
}

}  // namespace

void set_up(JpegErrors& errors, void (*on_message)(j_common_ptr codec, int level)) {
    jpeg_std_error(&errors.manager);
    errors.manager.error_exit = [](j_common_ptr codec) {
        give_up(codec, trouble_of(codec->err->msg_code), true);
    };
    errors.manager.emit_message = on_message;
    errors.manager.output_message = [](j_common_ptr) {};
    errors.trouble = JpegTrouble::none;
    errors.fatal = false;
    errors.message[0] = 0;
}

void give_up(j_common_ptr codec, JpegTrouble trouble, bool fatal) {
    auto* errors = reinterpret_cast<JpegErrors*>(codec->err);
    errors->trouble = trouble;
    errors->fatal = fatal;
    errors->manager.format_message(codec, errors->message);
    std::longjmp(errors->jump, 1);
}

}  // namespace probewarp
