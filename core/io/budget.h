// What stands between stb_image and the world: memory up to a limit, given back whatever happens, and bytes
// that end with an exception instead of zeros without end. Private to io.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "io/formats.h"

namespace probewarp {

/// The memory of one decoding. Few blocks live at a time, so a list is searched in order.
class Budget {
  public:
    explicit Budget(std::size_t limit) : left_(limit) { current() = this; }
    Budget(const Budget&) = delete;
    Budget& operator=(const Budget&) = delete;
    ~Budget() {
        for (const Block& block : blocks_) std::free(block.data);
        current() = nullptr;
    }

    /// The one that allocations draw on.
    static Budget*& current() {
        thread_local Budget* budget = nullptr;
        return budget;
    }

    /// Null beyond the limit. Zeroed: what a decoder forgets to write is at least nobody's secret.
    void* allocate(std::size_t size) {
        if (size > left_) return nullptr;
        blocks_.reserve(blocks_.size() + 1);
        void* data = std::calloc(std::max<std::size_t>(size, 1), 1);
        if (data) blocks_.push_back({data, size}), left_ -= size;
        return data;
    }

    /// Ignores what is not (or no longer) ours: stb_image frees some blocks twice.
    void release(void* data) {
        const auto at =
            std::find_if(blocks_.begin(), blocks_.end(), [&](const Block& b) { return b.data == data; });
        if (at == blocks_.end()) return;
        std::free(at->data);
        left_ += at->size;
        blocks_.erase(at);
    }

  private:
    struct Block {
        void* data;
        std::size_t size;
    };
    std::vector<Block> blocks_;
    std::size_t left_;
};

/// Bytes for stb_image's callbacks: some parts one after the other.
class Source {
  public:
    Source(std::string_view label, std::vector<Bytes> parts) : label_(label), parts_(std::move(parts)) {
        for (const Bytes part : parts_) left_ += part.size();
    }

    /// stb_image fills its own buffer (always the same, and first of all) with whatever is there, and takes
    /// an end for zeros; elsewhere it wants exactly `size` bytes, and does not always look whether they came.
    int read(char* to, int size) {
        if (!buffer_) buffer_ = to;
        const std::size_t wanted = std::size_t(size);
        if (size < 0 || left_ == 0 || (wanted > left_ && to != buffer_)) throw truncated(label_);
        return int(take(to, std::min(wanted, left_)));
    }

    void skip(int size) {
        if (size < 0 || std::size_t(size) > left_) throw truncated(label_);
        take(nullptr, std::size_t(size));
    }

    bool at_end() const { return left_ == 0; }

  private:
    std::size_t take(char* to, std::size_t size) {
        for (std::size_t done = 0; done < size;) {
            Bytes& part = parts_[next_];
            const std::size_t step = std::min(part.size(), size - done);
            if (to && step > 0) std::memcpy(to + done, part.data(), step);
            part = part.subspan(step);
            done += step;
            if (part.empty()) ++next_;
        }
        left_ -= size;
        return size;
    }

    std::string_view label_;
    std::vector<Bytes> parts_;
    std::size_t next_ = 0;
    std::size_t left_ = 0;
    char* buffer_ = nullptr;
};

}  // namespace probewarp
