// A file descriptor that closes itself. Private to io.
#pragma once

#include <unistd.h>

namespace probewarp {

/// fd: negative where there is none
struct Descriptor {
    int fd;

    explicit Descriptor(int number) : fd(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (fd >= 0) ::close(fd);
    }
};

}  // namespace probewarp
