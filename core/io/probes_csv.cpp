#include "io/probes_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

namespace probewarp {

namespace {

constexpr double largest = 1e6;  // of any number in a row
constexpr std::size_t max_rows = 10000;

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// The seven numbers of a row, or nothing.
std::optional<std::array<double, 7>> numbers(std::string_view row) {
    std::array<double, 7> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
        const bool last = i + 1 == values.size();
        const std::size_t comma = row.find(',');
        if ((comma == std::string_view::npos) != last) return {};
        const std::string_view field = trimmed(row.substr(0, comma));
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), values[i]);
        if (error != std::errc() || end != field.data() + field.size() || !(std::abs(values[i]) <= largest))
            return {};
        if (!last) row.remove_prefix(comma + 1);
    }
    return values;
}

}  // namespace

std::vector<Probe> decode_probes_csv(std::string_view text, const Document& document) {
    const Image& image = document.picture->image;
    const double unit = std::max(image.width, image.height) / 1024.0;
    const glm::dvec2 middle = centre(image);
    Document grown = document;
    const std::size_t before = grown.probes.size();
    bool in_probes = false, seen = false;
    for (int line = 1; !text.empty(); ++line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view row = trimmed(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (row.starts_with('#')) {
            in_probes = row.starts_with("#probes");
            seen = seen || in_probes;
            continue;
        }
        if (row.empty() || !in_probes) continue;
        const auto v = numbers(row);
        if (!v || !((*v)[6] > 0))
            throw Error(fmt::format(
                "line {} is wrong; expected ix,iy,itheta,x,y,theta,radius with a radius above 0", line));
        const auto [ix, iy, itheta, x, y, theta, radius] = *v;
        Probe probe = new_probe(grown, middle + unit * glm::dvec2(ix, -iy));
        probe.now = middle + unit * glm::dvec2(x, -y);
        probe.angle = itheta - theta;  // theirs is anticlockwise
        probe.radius = unit * radius;
        const double farthest = std::max({std::abs(probe.rest.x), std::abs(probe.rest.y),
                                          std::abs(probe.now.x), std::abs(probe.now.y), probe.radius});
        if (farthest > max_probe_coordinate || std::abs(probe.angle) > max_probe_angle ||
            probe.radius < min_probe_radius)
            throw Error(fmt::format(
                "line {} is a probe too far away, turned too far, or with a radius out of range", line));
        grown.probes.push_back(probe);
        if (grown.probes.size() > max_rows)
            throw Error(fmt::format("line {} is one probe too many; expected at most {}", line, max_rows));
    }
    if (!seen) throw Error("has no line that begins with #probes; expected a CSV of the iPad program");
    return {grown.probes.begin() + std::ptrdiff_t(before), grown.probes.end()};
}

}  // namespace probewarp
