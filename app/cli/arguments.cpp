#include "cli/arguments.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <vector>

#include "cli/commands.h"
#include "io/same_file.h"

namespace probewarp {

namespace {

/// The numbers of a comma-separated list; empty where one is none.
std::vector<double> numbers(std::string_view text) {
    std::vector<double> values;
    while (true) {
        const std::size_t comma = std::min(text.find(','), text.size());
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + comma, value);
        if (error != std::errc() || end != text.data() + comma || !(std::abs(value) <= 1e7)) return {};
        values.push_back(value);
        if (comma == text.size()) return values;
        text.remove_prefix(comma + 1);
    }
}

}  // namespace

void check_files(std::span<const UsedFile> read, std::span<const UsedFile> written) {
    if (find_open_file(read, STDERR_FILENO)) {
        // Not even the message may come into it.
        const int nowhere = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
        if (nowhere < 0 || ::dup2(nowhere, STDERR_FILENO) < 0) ::close(STDERR_FILENO);
        throw UsageError("standard error goes to a file that is read; expected another file");
    }
    if (const UsedFile* file = find_open_file(read, STDOUT_FILENO))
        throw UsageError(
            fmt::format("standard output goes to {}, which is read; expected another file", file->name));
    if (const std::string why = why_not_written(read, written); !why.empty()) throw UsageError(why);
}

Probe parse_probe(const std::string& text, const Document& document) {
    const auto wrong = [&text] {
        return UsageError(
            fmt::format("--probe {}: expected RX,RY[:X,Y[,DEG[,RADIUS]]] in image pixels and degrees, "
                        "with a radius above 0",
                        text));
    };
    const std::size_t colon = text.find(':');
    const auto rest = numbers(std::string_view(text).substr(0, colon));
    if (rest.size() != 2) throw wrong();
    Probe probe = new_probe(document, {rest[0], rest[1]});
    if (colon == std::string::npos) return probe;
    const auto now = numbers(std::string_view(text).substr(colon + 1));
    if (now.size() < 2 || now.size() > 4) throw wrong();
    probe.now = {now[0], now[1]};
    if (now.size() > 2) probe.angle = now[2] * std::numbers::pi / 180;
    if (now.size() > 3) probe.radius = now[3];
    if (!(probe.radius >= 1e-3)) throw wrong();
    return probe;
}

std::array<int, 2> parse_size(const std::string& text) {
    std::array<int, 2> size{};
    const char* const end = text.data() + text.size();
    const auto [cross, width_error] = std::from_chars(text.data(), end, size[0]);
    if (width_error == std::errc() && cross != end && *cross == 'x') {
        const auto [last, height_error] = std::from_chars(cross + 1, end, size[1]);
        if (height_error == std::errc() && last == end && size[0] > 0 && size[1] > 0) return size;
    }
    throw UsageError(fmt::format("--size {}: expected WIDTHxHEIGHT in pixels, such as 640x480", text));
}

std::optional<Colour> parse_colour(const std::string& text) {
    if (text == "none") return {};
    if (text == "white") return Colour{255, 255, 255};
    if (text == "black") return Colour{0, 0, 0};
    std::string hex = text;
    if (hex.size() == 4) hex = {hex[0], hex[1], hex[1], hex[2], hex[2], hex[3], hex[3]};
    unsigned value = 0;
    if (hex.size() == 7 && hex[0] == '#') {
        const auto [end, error] = std::from_chars(hex.data() + 1, hex.data() + 7, value, 16);
        if (error == std::errc() && end == hex.data() + 7)
            return Colour{std::uint8_t(value >> 16), std::uint8_t(value >> 8), std::uint8_t(value)};
    }
    throw UsageError(fmt::format("--background {}: expected #rrggbb, white, black or none", text));
}

void apply(const BindingOptions& o, Document& document) {
    for (const std::string& text : o.probes) document.probes.push_back(parse_probe(text, document));
    if (o.mesh) document.mesh.cells = *o.mesh;
    if (!o.alpha_threshold.empty()) {
        document.mesh.from_alpha = o.alpha_threshold != "none";
        if (document.mesh.from_alpha) document.mesh.threshold = std::stoi(o.alpha_threshold);
    }
    if (o.alpha_margin) document.mesh.margin = *o.alpha_margin;
    if (!o.weights.empty()) document.weights.scheme = o.weights;
    if (o.exponent) document.weights.exponent = *o.exponent;
    if (o.falloff) document.weights.falloff = *o.falloff;
    if (o.most) document.weights.most = *o.most;
    check_size(document);
}

std::optional<std::size_t> find_probe_named(const Document& document, const std::string& name) {
    const auto found = std::ranges::find(document.probes, name, &Probe::name);
    if (found != document.probes.end()) return std::size_t(found - document.probes.begin());
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error != std::errc() || end != name.data() + name.size()) return {};
    if (number < 1 || number > document.probes.size()) return {};
    return number - 1;
}

std::size_t probe_named(const Document& document, const std::string& name, const std::string& option) {
    if (const auto found = find_probe_named(document, name)) return *found;
    constexpr std::size_t most_listed = 100;
    std::string names;
    for (std::size_t i = 0; i < std::min(document.probes.size(), most_listed); ++i)
        names += (i == 0 ? "" : ", ") + document.probes[i].name;
    if (document.probes.size() > most_listed) names += ", ...";
    throw UsageError(fmt::format(
        "{} {}: {}", option, name,
        names.empty() ? "there are no probes" : "there is no such probe; expected one of " + names));
}

}  // namespace probewarp
