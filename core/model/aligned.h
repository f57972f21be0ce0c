// Large arrays of floats as vector units like them: on whole cache lines.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace probewarp {

// Huge pages would be read a sixth quicker, but where memory is scarce or lent by another machine it takes up
// to a second to get them, each time that the weights change.
template <class T>
struct LineAllocator {
    using value_type = T;
    static constexpr std::align_val_t line{64};

    LineAllocator() = default;
    template <class U>
    LineAllocator(const LineAllocator<U>&) {}

    T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), line)); }
    void deallocate(T* place, std::size_t) { ::operator delete(place, line); }
    /// New elements have no value yet: all of them are written anyway, and these arrays are large.
    template <class U>
    void construct(U* place) {
        ::new (static_cast<void*>(place)) U;
    }
    template <class U>
    void construct(U* place, const U& value) {
        ::new (static_cast<void*>(place)) U(value);
    }
    friend bool operator==(const LineAllocator&, const LineAllocator&) { return true; }
};

using AlignedFloats = std::vector<float, LineAllocator<float>>;

}  // namespace probewarp
