#include "support/program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "io/file.h"
#include "io/image_file.h"

namespace probewarp::test {

namespace {

int sample8(const Image& image, int x, int y, int k) {
    const int value = pixel(image, x, y)[std::size_t(k)];
    return image.bits() == 16 ? (value + 128) / 257 : value;
}

double sample(const Image& image, int x, int y, int k) {
    return pixel(image, x, y)[std::size_t(k)] / (image.bits() == 16 ? 257.0 : 1.0);
}

}  // namespace

Outcome run_program(const std::vector<std::string>& arguments) {
    std::vector<char*> argv{const_cast<char*>(PROBEWARP_PROGRAM)};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    int errors[2];
    if (pipe2(errors, O_CLOEXEC) != 0) return {};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, errors[1], STDERR_FILENO);
    pid_t child = 0;
    const int failed = posix_spawn(&child, PROBEWARP_PROGRAM, &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(errors[1]);
    Outcome run;
    char buffer[4096];
    for (ssize_t n; failed == 0 && (n = ::read(errors[0], buffer, sizeof buffer)) > 0;)
        run.errors.append(buffer, std::size_t(n));
    close(errors[0]);
    int status = 0;
    if (failed == 0 && waitpid(child, &status, 0) == child && WIFEXITED(status))
        run.code = WEXITSTATUS(status);
    return run;
}

std::filesystem::path scratch_folder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + "." + test->name();
    std::replace(name.begin(), name.end(), '/', '.');
    const char* set =
        std::getenv("PROBEWARP_INSTRUCTION_SET");  // the same test may run under several at once
    const std::filesystem::path folder =
        std::filesystem::path(PROBEWARP_SCRATCH) / (set && *set != 0 ? set : "widest") / name;
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder;
}

Image read(const std::filesystem::path& path) { return read_picture(path).image; }

void write_png(const std::filesystem::path& path, const Image& image) {
    write_file(path, find_image_format("png")->encode(image, {}));
}

Difference difference(const Image& a, const Image& b) {
    Difference d;
    double sum = 0, most = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
            for (int k = 0; k < 4; ++k) {
                const double off = std::abs(sample(a, x, y, k) - sample(b, x, y, k));
                most = std::max(most, off);
                sum += off;
            }
    d.most = int(std::ceil(most));
    d.mean = sum / (double(a.width) * a.height * 4);
    return d;
}

Image difference_picture(const Image& a, const Image& b) {
    Image picture;
    picture.width = std::min(a.width, b.width);
    picture.height = std::min(a.height, b.height);
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const int alpha = std::abs(sample8(a, x, y, 3) - sample8(b, x, y, 3));
            for (int k = 0; k < 3; ++k) {
                const int off = std::max(alpha, std::abs(sample8(a, x, y, k) - sample8(b, x, y, k)));
                rgba.push_back(std::uint8_t(std::min(255, off * 16)));
            }
            rgba.push_back(255);
        }
    picture.rgba = std::move(rgba);
    return picture;
}

}  // namespace probewarp::test
