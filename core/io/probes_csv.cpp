// Spreadsheets and systems write the same numbers in many ways: this file takes them as they come, and
// refuses what could be read in two ways.
#include "io/probes_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "io/lower_case.h"
#include "io/printable.h"

namespace probewarp {

namespace {

constexpr double largest = 1e6;  // of any number in a row
constexpr std::size_t max_rows = 10000;
constexpr std::array<std::string_view, 7> columns{"ix", "iy", "itheta", "x", "y", "theta", "radius"};
constexpr std::string_view column_list = "ix,iy,itheta,x,y,theta,radius";

void append_utf8(std::string& text, unsigned unit) {
    if (unit < 0x80) {
        text += char(unit);
    } else if (unit < 0x800) {
        text += {char(0xC0 | unit >> 6), char(0x80 | (unit & 0x3F))};
    } else if (unit < 0xD800 || unit > 0xDFFF) {
        text += {char(0xE0 | unit >> 12), char(0x80 | (unit >> 6 & 0x3F)), char(0x80 | (unit & 0x3F))};
    } else {
        text += '?';  // half of a character that no number has
    }
}

/// The text as UTF-8, without a byte order mark. What begins with a mark of UTF-16, or with an ASCII
/// character of two bytes, is UTF-16.
std::string utf8_of(std::string_view text) {
    const auto byte = [&](std::size_t i) {
        return i < text.size() ? unsigned(static_cast<unsigned char>(text[i])) : 0x100u;
    };
    const bool little = (byte(0) == 0xFF && byte(1) == 0xFE) || (byte(0) != 0 && byte(1) == 0);
    const bool big = (byte(0) == 0xFE && byte(1) == 0xFF) || (byte(0) == 0 && byte(1) != 0 && byte(1) < 0x80);
    if (!little && !big) return std::string(text.starts_with("\xef\xbb\xbf") ? text.substr(3) : text);
    std::string converted;
    converted.reserve(text.size());
    for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
        const unsigned unit = little ? byte(i) | byte(i + 1) << 8 : byte(i) << 8 | byte(i + 1);
        if (unit != 0xFEFF) append_utf8(converted, unit);
    }
    return converted;
}

/// Takes the first line off the text, whichever way lines end in it.
std::string_view take_line(std::string_view& text) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + (text.substr(end).starts_with("\r\n") ? 2 : 1), text.size()));
    return line;
}

/// Without spaces, tabs and the spaces that do not break a line, in UTF-8 or Windows' old code page, on
/// either side.
std::string_view trimmed(std::string_view text) {
    constexpr std::array<std::string_view, 5> blanks{" ", "\t", "\xc2\xa0", "\xe2\x80\xaf", "\xa0"};
    for (bool more = true; more;) {
        more = false;
        for (const std::string_view blank : blanks) {
            if (text.starts_with(blank)) text.remove_prefix(blank.size()), more = true;
            if (text.ends_with(blank)) text.remove_suffix(blank.size()), more = true;
        }
    }
    return text;
}

bool is_quoted(std::string_view text) {
    return text.size() >= 2 && text.starts_with('"') && text.ends_with('"');
}

/// Without spaces and one pair of quotes around them.
std::string_view bare(std::string_view text) {
    text = trimmed(text);
    return is_quoted(text) ? trimmed(text.substr(1, text.size() - 2)) : text;
}

/// What stands between the separators of a line.
struct Row {
    std::array<std::string_view, columns.size()> fields;  ///< the first ones, bare
    std::size_t filled = 0;  ///< up to the last field with something in it: fields may be missing behind it
};

/// A separator between quotes separates nothing.
Row split(std::string_view line, char separator) {
    Row row;
    std::size_t start = 0, count = 0;
    bool quoted = false;
    for (std::size_t i = 0; i <= line.size(); ++i) {
        if (i < line.size() && line[i] == '"') quoted = !quoted;
        if (i < line.size() && (quoted || line[i] != separator)) continue;
        const std::string_view field = bare(line.substr(start, i - start));
        if (count < row.fields.size()) row.fields[count] = field;
        ++count, start = i + 1;
        if (!field.empty()) row.filled = count;
    }
    return row;
}

/// The line by the separator that makes seven of it; where none does, by the one that makes most of it.
Row by_likeliest_separator(std::string_view line) {
    Row best;
    for (const char separator : {';', '\t', ','}) {
        const Row row = split(line, separator);
        if (row.filled == columns.size()) return row;
        if (row.filled > best.filled) best = row;
    }
    return best;
}

/// Whether a line has nothing but what separates columns. declared: as row_of's
bool is_empty(std::string_view line, char declared) {
    return std::ranges::all_of(line, [&](char c) {
        return std::string_view(" \t\",;").find(c) != std::string_view::npos ||
               (declared != 0 && c == declared);
    });
}

/// declared: the separator, or 0 where none is known
Row row_of(std::string_view line, char declared) {
    const auto cut = [&](std::string_view text) {
        return declared != 0 ? split(text, declared) : by_likeliest_separator(text);
    };
    const Row row = cut(line);
    // A spreadsheet that took the line for one text puts it between quotes.
    return row.filled == 1 && is_quoted(trimmed(line)) ? cut(bare(line)) : row;
}

/// A number with a point or a comma, with a sign of any kind, with an exponent; or nothing.
std::optional<double> number_in(std::string_view field) {
    constexpr std::size_t longest = 64;
    constexpr std::string_view minus = "\xe2\x88\x92";  // U+2212
    if (field.size() > longest) return {};
    std::string text(field);
    if (text.starts_with(minus))
        text.replace(0, minus.size(), "-");
    else if (text.starts_with('+') && !text.starts_with("+-"))
        text.erase(0, 1);
    if (text.find(',') != std::string::npos && text.find('.') != std::string::npos) return {};
    if (std::ranges::count(text, ',') == 1) text[text.find(',')] = '.';
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || !(std::abs(value) <= largest)) return {};
    return value;
}

using Numbers = std::array<double, columns.size()>;

/// Throws Error for a row that is not seven numbers.
Numbers numbers_of(const Row& row, int line) {
    if (row.filled > columns.size())
        throw Error(
            fmt::format("line {} has {} columns; expected seven, {}: where numbers have a decimal "
                        "comma, semicolons between them, or quotes around them",
                        line, row.filled, column_list));
    if (row.filled < columns.size())
        throw Error(fmt::format("line {} has {} {}; expected seven, {}", line, row.filled,
                                row.filled == 1 ? "column" : "columns", column_list));
    Numbers numbers{};
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const std::string_view field = row.fields[i];
        if (field.empty()) throw Error(fmt::format("line {} has no {}; expected a number", line, columns[i]));
        const auto number = number_in(field);
        if (!number)
            throw Error(
                fmt::format("line {} has \"{}\" for {}; expected a number of at most a million, "
                            "without signs between thousands",
                            line, printable(field.substr(0, 40)), columns[i]));
        numbers[i] = *number;
    }
    if (!(numbers[6] > 0))
        throw Error(fmt::format("line {} has a radius of {:g}; expected one above 0", line, numbers[6]));
    return numbers;
}

/// Whether a row names the columns instead of filling them.
bool is_header(const Row& row) { return std::ranges::equal(row.fields, columns, {}, lower_case); }

/// The separator that Excel is told by a first line "sep=;", or 0.
char declared_separator(std::string_view line) {
    if (line.starts_with('"')) line.remove_prefix(1);
    return line.size() > 4 && lower_case(line.substr(0, 4)) == "sep=" ? line[4] : char(0);
}

/// Where the program's numbers are in the picture: origin at its centre, 1024 along its longer side, y up.
struct Frame {
    glm::dvec2 middle;
    double unit;
};

/// Throws Error for what a project could not hold.
void place(Probe& probe, const Numbers& numbers, const Frame& frame, int line) {
    const auto [ix, iy, itheta, x, y, theta, radius] = numbers;
    probe.rest = frame.middle + frame.unit * glm::dvec2(ix, -iy);
    probe.now = frame.middle + frame.unit * glm::dvec2(x, -y);
    probe.angle = itheta - theta;  // theirs is anticlockwise
    probe.radius = frame.unit * radius;
    const double farthest = std::max({std::abs(probe.rest.x), std::abs(probe.rest.y), std::abs(probe.now.x),
                                      std::abs(probe.now.y), probe.radius});
    if (farthest > max_probe_coordinate || std::abs(probe.angle) > max_probe_angle ||
        probe.radius < min_probe_radius)
        throw Error(fmt::format(
            "line {} is a probe too far away, turned too far, or with a radius out of range; expected one "
            "that fits a project",
            line));
}

}  // namespace

std::vector<Probe> decode_probes_csv(std::string_view bytes, const Document& document) {
    const Image& image = document.picture->image;
    const Frame frame{centre(image), std::max(image.width, image.height) / 1024.0};
    Document grown = document;
    const std::size_t before = grown.probes.size();
    const std::string converted = utf8_of(bytes);
    std::string_view text = converted;
    while (text.ends_with('\0') || text.ends_with('\x1a')) text.remove_suffix(1);  // old systems' end of file
    char separator = 0;
    bool in_probes = false, seen = false;
    for (int line = 1; !text.empty(); ++line) {
        const std::string_view row_text = take_line(text);
        if (line == 1 && (separator = declared_separator(row_text)) != 0) continue;
        const std::string_view first =
            row_text.substr(std::min(row_text.find_first_not_of(" \t\""), row_text.size()));
        if (first.starts_with('#')) {
            in_probes = lower_case(trimmed(first.substr(1))).starts_with("probes");
            seen = seen || in_probes;
            continue;
        }
        if (!in_probes) continue;
        if (is_empty(row_text, separator)) continue;
        const Row row = row_of(row_text, separator);
        if (row.filled == 0 || is_header(row)) continue;
        const Numbers numbers = numbers_of(row, line);
        place(grown.probes.emplace_back(new_probe(grown, frame.middle)), numbers, frame, line);
        if (grown.probes.size() > max_rows)
            throw Error(fmt::format("line {} is one probe too many; expected at most {}", line, max_rows));
    }
    if (!seen) throw Error("has no line that begins with #probes; expected a CSV of the iPad program");
    return {grown.probes.begin() + std::ptrdiff_t(before), grown.probes.end()};
}

}  // namespace probewarp
