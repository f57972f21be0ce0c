// Loaded before the program (LD_PRELOAD) it makes what seldom fails fail on demand. The environment variable
// FAILING_CALLS names a folder; a file in it that comes and goes while the program runs holds a number:
// - `threads`: so many threads may be started from then on, counted over the program's life; the next are
//   refused.
//
// - `new`: operator new of so many bytes or more finds no memory.
//
// - `malloc`: malloc, calloc, realloc and aligned_alloc of so many bytes or more find none.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
}

namespace {

constexpr std::size_t never = SIZE_MAX;
constexpr std::size_t least = 32;  // what is smaller is never refused

/// The number in the file; `never` without one. Allocates nothing.
std::size_t limit(const char* name) {
    const char* folder = std::getenv("FAILING_CALLS");
    char path[PATH_MAX];
    if (!folder || std::snprintf(path, sizeof path, "%s/%s", folder, name) >= int(sizeof path)) return never;
    const int before = errno;
    const int fd = ::open(path, O_RDONLY | O_CLOEXEC);
    char digits[24] = {};
    const ssize_t got = fd < 0 ? -1 : ::read(fd, digits, sizeof digits - 1);
    if (fd >= 0) ::close(fd);
    errno = before;
    return got <= 0 ? never : std::strtoull(digits, nullptr, 10);
}

bool refuses(const char* name, std::size_t bytes) {
    if (bytes < least || bytes < limit(name)) return false;
    errno = ENOMEM;
    return true;
}

std::atomic<std::size_t> started = 0;

void* allocated(std::size_t bytes, std::size_t alignment) {
    void* found = refuses("new", bytes) ? nullptr : __libc_memalign(alignment, bytes);
    if (!found) throw std::bad_alloc();
    return found;
}

}  // namespace

extern "C" {

int pthread_create(pthread_t* thread, const pthread_attr_t* settings, void* (*run)(void*), void* argument) {
    using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
    static const auto create = reinterpret_cast<Create>(::dlsym(RTLD_NEXT, "pthread_create"));
    if (started >= limit("threads")) return EAGAIN;
    ++started;
    return create(thread, settings, run, argument);
}

void* malloc(std::size_t bytes) { return refuses("malloc", bytes) ? nullptr : __libc_malloc(bytes); }

void* calloc(std::size_t count, std::size_t size) {
    std::size_t bytes = 0;
    if (__builtin_mul_overflow(count, size, &bytes) || refuses("malloc", bytes)) return nullptr;
    return __libc_calloc(count, size);
}

void* realloc(void* old, std::size_t bytes) {
    return refuses("malloc", bytes) ? nullptr : __libc_realloc(old, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
    return refuses("malloc", bytes) ? nullptr : __libc_memalign(alignment, bytes);
}

}  // extern "C"

void* operator new(std::size_t bytes) { return allocated(bytes, alignof(std::max_align_t)); }
void* operator new[](std::size_t bytes) { return allocated(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
    return allocated(bytes, std::size_t(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
    return allocated(bytes, std::size_t(alignment));
}
void operator delete(void* old) noexcept { std::free(old); }
void operator delete[](void* old) noexcept { std::free(old); }
void operator delete(void* old, std::size_t) noexcept { std::free(old); }
void operator delete[](void* old, std::size_t) noexcept { std::free(old); }
void operator delete(void* old, std::align_val_t) noexcept { std::free(old); }
void operator delete[](void* old, std::align_val_t) noexcept { std::free(old); }
void operator delete(void* old, std::size_t, std::align_val_t) noexcept { std::free(old); }
void operator delete[](void* old, std::size_t, std::align_val_t) noexcept { std::free(old); }
