// Errors of what is inside a file get the file's name. Private to io.
#pragma once

#include <new>
#include <string>

#include "io/incomplete_file.h"
#include "io/printable.h"

namespace probewarp {

/// Runs `step`, whose errors become "NAME: what is wrong; what is expected".
template <class Step>
auto naming_errors(const std::string& name, const Step& step) {
    try {
        return step();
    } catch (const IncompleteFile& error) {
        throw IncompleteFile(printable(name) + ": " + printable(error.what()));
    } catch (const Error& error) {
        throw Error(printable(name) + ": " + printable(error.what()));
    } catch (const std::bad_alloc&) {
        throw Error(printable(name) + ": needs more memory than there is; expected a smaller picture");
    }
}

}  // namespace probewarp
