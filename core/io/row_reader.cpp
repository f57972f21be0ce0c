#include "io/row_reader.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "io/naming_errors.h"

namespace probewarp {

namespace {

std::span<std::byte> writable_pixels(Image& image) {
    return std::visit([](auto& rgba) { return std::as_writable_bytes(std::span(rgba)); }, image.rgba);
}

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

class RowsReadBeside final : public ArrivingRows {
  public:
    RowsReadBeside(std::unique_ptr<RowReader> reader, Image& image, std::string name)
        : reader_(std::move(reader)),
          pixels_(writable_pixels(image)),
          name_(std::move(name)),
          height_(image.height) {
        try {
            thread_ = std::thread([this] { read(); });
        } catch (const std::system_error&) {  // the system has none left
            read();
        }
    }
    RowsReadBeside(const RowsReadBeside&) = delete;
    RowsReadBeside& operator=(const RowsReadBeside&) = delete;
    ~RowsReadBeside() override {
        given_up_ = true;
        if (thread_.joinable()) thread_.join();
    }

    void wait(int rows) const override {
        const auto start = Clock::now();
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return rows_ >= rows || failure_; });
        waiting_ += seconds_since(start);
        if (rows_ < rows) std::rethrow_exception(failure_);
    }

    Times times() const override {
        const std::lock_guard lock(mutex_);
        return {decoding_, waiting_};
    }

  private:
    void read() {
        try {
            naming_errors(name_, [&] {
                for (int rows = 0; rows < height_ && !given_up_;)
                    tell(rows = reader_->read(pixels_), nullptr);
            });
        } catch (...) {
            tell(0, std::current_exception());
        }
    }

    void tell(int rows, std::exception_ptr failure) {
        {
            const std::lock_guard lock(mutex_);
            rows_ = std::max(rows_, rows);
            failure_ = std::move(failure);
            decoding_ = seconds_since(start_);
        }
        changed_.notify_all();
    }

    const std::unique_ptr<RowReader> reader_;
    const std::span<std::byte> pixels_;
    const std::string name_;
    const int height_;
    const Clock::time_point start_ = Clock::now();
    std::atomic<bool> given_up_ = false;
    mutable std::mutex mutex_;  // of what follows
    mutable std::condition_variable changed_;
    int rows_ = 0;
    std::exception_ptr failure_;
    double decoding_ = 0;
    mutable double waiting_ = 0;
    std::thread thread_;  // the last: it uses all of these
};

}  // namespace

void read_all(RowReader& reader, Image& image) {
    const std::span<std::byte> pixels = writable_pixels(image);
    while (reader.read(pixels) < image.height) continue;
}

Image read_whole(RowReader& reader) {
    Image image = reader.blank();
    read_all(reader, image);
    return image;
}

std::shared_ptr<const ArrivingRows> read_beside(std::unique_ptr<RowReader> reader, Image& image,
                                                const std::string& name) {
    return std::make_shared<const RowsReadBeside>(std::move(reader), image, name);
}

}  // namespace probewarp
