#include "editor/number_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

namespace probewarp {

namespace {

constexpr int max_depth = 64;  // of brackets

// Signs without an ASCII likeness, and what no number has.
constexpr char times_sign = '\x80', degree_sign = '\x81', unknown = '\x82';

/// The code point at `at`, which moves behind it; 0xFFFD where the bytes are no UTF-8.
char32_t next_code_point(std::string_view text, std::size_t& at) {
    const auto byte = [&](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
    };
    const unsigned first = byte(at++);
    if (first < 0x80) return first;
    const int more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc2 ? 1 : 0;
    if (more == 0 || first > 0xf4) return 0xfffd;
    char32_t point = first & (0x3fu >> more);
    for (int k = 0; k < more; ++k) {
        if ((byte(at) & 0xc0) != 0x80) return 0xfffd;
        point = point << 6 | (byte(at++) & 0x3f);
    }
    return point;
}

/// What steers the direction or the breaking of lines, and is not seen.
bool is_invisible(char32_t c) {
    return c == 0xad || (c >= 0x200b && c <= 0x200f) || (c >= 0x202a && c <= 0x202e) ||
           (c >= 0x2060 && c <= 0x2069) || c == 0xfeff;
}

char plain_sign(char32_t c) {
    if (c >= 0xff01 && c <= 0xff5e) c -= 0xfee0;  // the full-width forms
    if (c >= 0x20 && c < 0x7f) return char(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    if (c == '\t' || c == '\n' || c == '\r' || (c >= 0x2028 && c <= 0x2029)) return ';';
    if (c == 0xa0 || (c >= 0x2000 && c <= 0x200a) || c == 0x202f || c == 0x205f || c == 0x3000) return ' ';
    if (c == 0x2212 || (c >= 0x2010 && c <= 0x2015) || c == 0xfe63) return '-';
    if (c == 0x2019 || c == 0x2bc) return '\'';
    if (c == 0xf7 || c == 0x2215 || c == 0x2044) return '/';
    if (c == 0xb7 || c == 0x22c5 || c == 0x2217) return '*';
    if (c == 0xd7) return times_sign;
    if (c == 0xb0 || c == 0xba) return degree_sign;
    return unknown;
}

std::string_view trimmed(std::string_view text, std::string_view what) {
    const std::size_t from = text.find_first_not_of(what);
    if (from == std::string_view::npos) return {};
    return text.substr(from, text.find_last_not_of(what) + 1 - from);
}

/// The text in lower-case ASCII and the signs above. Tabs and ends of lines become semicolons, except at its
/// ends. Empty where it is too long.
std::string plain(std::string_view text) {
    if (text.size() > max_number_text) return {};
    std::string out;
    for (std::size_t at = 0; at < text.size();)
        if (const char32_t c = next_code_point(text, at); !is_invisible(c)) out += plain_sign(c);
    const bool ends_lines = text.find_first_of("\t\r\n") != std::string_view::npos;
    return std::string(trimmed(out, ends_lines ? " ;" : " "));
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_separator(char c) { return c == '.' || c == ',' || c == '\'' || c == ' '; }

/// Whether the digits stand in groups of three, divided by `mark` alone.
bool is_grouped(std::string_view digits, char mark) {
    std::size_t length = 0;
    for (bool first = true;; first = false) {
        const std::size_t end = digits.find(mark);
        length = end == std::string_view::npos ? digits.size() : end;
        for (const char c : digits.substr(0, length))
            if (!is_digit(c)) return false;
        if (first ? length < 1 || length > 3 : length != 3) return false;
        if (end == std::string_view::npos) return true;
        digits.remove_prefix(end + 1);
    }
}

/// The decimal separator of a number's text, or 0 where it has none.
char decimal_of(std::string_view number) {
    const std::size_t last = number.find_last_of(".,");
    if (last == std::string_view::npos) return 0;
    return number.find(number[last]) == last ? number[last] : '\0';
}

/// A number of digits and separators without grouping, with a point; empty where it is wrongly grouped.
std::string ungrouped(std::string_view number) {
    const char decimal = decimal_of(number);
    const std::size_t point = decimal ? number.find(decimal) : number.size();
    const std::string_view whole = number.substr(0, point);
    const std::string_view fraction = decimal ? number.substr(point + 1) : std::string_view();
    for (const char c : fraction)
        if (!is_digit(c)) return {};
    const std::size_t mark = whole.find_first_of(".,' ");
    if (mark != std::string_view::npos && !is_grouped(whole, whole[mark])) return {};
    std::string out;
    for (const char c : whole)
        if (is_digit(c)) out += c;
    if (out.empty() && fraction.empty()) return {};
    return out + "." + std::string(fraction);
}

struct UnitWord {
    NumberUnit unit;
    std::string_view text;
};
/// Longer words stand before those that they begin with.
constexpr UnitWord unit_words[] = {{NumberUnit::pixels, "pixels"},  {NumberUnit::pixels, "pixel"},
                                   {NumberUnit::pixels, "px"},      {NumberUnit::degrees, "degrees"},
                                   {NumberUnit::degrees, "degree"}, {NumberUnit::degrees, "deg"},
                                   {NumberUnit::degrees, "\x81"},   {NumberUnit::percent, "%"},
                                   {NumberUnit::times, "\x80"},     {NumberUnit::times, "x"}};

/// sum: product (+ product)*; product: signed (* signed)*; signed: -* primary; primary: number or (sum), and
/// a unit.
class Parser {
  public:
    Parser(std::string_view text, NumberUnit unit) : rest_(text), unit_(unit) {}

    std::optional<double> all() {
        const auto value = sum(0);
        skip_spaces();
        return value && rest_.empty() ? value : std::nullopt;
    }

  private:
    std::string_view rest_;  ///< what has not been read yet
    NumberUnit unit_;

    void skip_spaces() { rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size())); }

    bool take(char sign) {
        skip_spaces();
        if (!rest_.starts_with(sign)) return false;
        rest_.remove_prefix(1);
        return true;
    }

    static std::optional<double> finite(double value) {
        return std::isfinite(value) ? std::optional(value) : std::nullopt;
    }

    std::optional<double> sum(int depth) {
        std::optional<double> value = product(depth);
        while (value) {
            const bool plus = take('+');
            if (!plus && !take('-')) break;
            const auto next = product(depth);
            value = next ? finite(*value + (plus ? *next : -*next)) : next;
        }
        return value;
    }

    std::optional<double> product(int depth) {
        std::optional<double> value = with_sign(depth);
        while (value) {
            const bool times = take('*') || take(times_sign);
            if (!times && !take('/')) break;
            const auto next = with_sign(depth);
            value = next ? finite(times ? *value * *next : *value / *next) : next;
        }
        return value;
    }

    std::optional<double> with_sign(int depth) {
        bool negative = false;
        for (;;)
            if (take('-'))
                negative = !negative;
            else if (!take('+'))
                break;
        const auto value = primary(depth);
        return value && negative ? -*value : value;
    }

    std::optional<double> primary(int depth) {
        std::optional<double> value;
        if (take('(')) {
            if (depth == max_depth) return {};
            value = sum(depth + 1);
            if (!value || !take(')')) return {};
        } else {
            value = number();
        }
        return value ? finite(*value * unit_factor()) : value;
    }

    /// Digits with their separators, and perhaps an exponent.
    std::optional<double> number() {
        skip_spaces();
        std::size_t end = 0;
        while (end < rest_.size() &&
               (is_digit(rest_[end]) ||
                (is_separator(rest_[end]) && end + 1 < rest_.size() && is_digit(rest_[end + 1]))))
            ++end;
        // A last separator may end a number: "5." is on its way to "5.5".
        if (end > 0 && end < rest_.size() && (rest_[end] == '.' || rest_[end] == ',')) ++end;
        std::string digits = ungrouped(rest_.substr(0, end));
        if (digits.empty()) return {};
        rest_.remove_prefix(end);
        digits += exponent();
        double value = 0;
        const char* last = digits.data() + digits.size();
        const auto [read, error] = std::from_chars(digits.data(), last, value);
        return error == std::errc() && read == last ? finite(value) : std::nullopt;
    }

    /// "e-3", or nothing.
    std::string exponent() {
        if (!rest_.starts_with('e')) return {};
        std::size_t end = 1;
        if (end < rest_.size() && (rest_[end] == '-' || rest_[end] == '+')) ++end;
        const std::size_t first = end;
        while (end < rest_.size() && is_digit(rest_[end])) ++end;
        if (end == first) return {};
        const std::string text(rest_.substr(0, end));
        rest_.remove_prefix(end);
        return text;
    }

    /// Reads the unit behind a number, if there is one. The factor is 1, but 360 for turns in degrees.
    double unit_factor() {
        skip_spaces();
        if (unit_ == NumberUnit::degrees && rest_.starts_with(times_sign) &&
            trimmed(rest_.substr(1), " ").starts_with('+')) {
            rest_.remove_prefix(1);
            return 360;
        }
        for (const UnitWord& word : unit_words)
            if (word.unit == unit_ && rest_.starts_with(word.text) && ends_word(word.text.size())) {
                rest_.remove_prefix(word.text.size());
                break;
            }
        return 1;
    }

    /// Whether behind a unit of that length no operand follows: "2 × 3" is a product, "2 ×" has a unit.
    bool ends_word(std::size_t length) const {
        const std::string_view behind = trimmed(rest_.substr(length), " ");
        return behind.empty() || std::string_view("+-*/)\x80").find(behind[0]) != std::string_view::npos;
    }
};

/// The two parts at that place, where each is a number.
std::optional<std::array<double, 2>> split_at(std::string_view text, std::size_t at, NumberUnit unit) {
    const auto first = Parser(trimmed(text.substr(0, at), " "), unit).all();
    if (!first) return {};
    const auto second = Parser(trimmed(text.substr(at + 1), " "), unit).all();
    if (!second) return {};
    return {{*first, *second}};
}

/// The only place with the sign where the text falls into two numbers. `before_space` wants one behind it.
std::optional<std::array<double, 2>> split_at_only(std::string_view text, char sign, bool before_space,
                                                   NumberUnit unit) {
    std::optional<std::array<double, 2>> found;
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text[at] != sign || (before_space && text.substr(at + 1, 1) != " ")) continue;
        if (sign == ' ' && at + 1 < text.size() && text[at + 1] == ' ') continue;  // the last of several
        const auto pair = split_at(text, at, unit);
        if (!pair) continue;
        if (found) return {};
        found = pair;
    }
    return found;
}

std::string_view without_brackets(std::string_view text) {
    for (const auto& [open, close] : {std::pair{'(', ')'}, {'[', ']'}, {'{', '}'}})
        if (text.size() > 1 && text.front() == open && text.find(close) == text.size() - 1)
            return trimmed(text.substr(1, text.size() - 2), " ");
    return text;
}

}  // namespace

std::optional<double> parse_number(std::string_view text, NumberUnit unit) {
    const std::string signs = plain(text);
    return Parser(signs, unit).all();
}

std::optional<std::array<double, 2>> parse_pair(std::string_view text, NumberUnit unit) {
    const std::string signs = plain(text);
    const std::string_view inner = without_brackets(signs);
    if (inner.find(';') != std::string_view::npos) return split_at_only(inner, ';', false, unit);
    if (const auto pair = split_at_only(inner, ',', true, unit)) return pair;
    if (const auto pair = split_at_only(inner, ',', false, unit)) return pair;
    return split_at_only(inner, ' ', false, unit);
}

bool is_unfinished_number(std::string_view text) {
    const std::string signs = plain(text);
    if (signs.empty()) return text.size() <= max_number_text;
    std::ptrdiff_t open = 0;
    for (const char c : signs) open += (c == '(') - (c == ')');
    return std::string_view("+-*/(.,\x80").find(signs.back()) != std::string_view::npos || open > 0;
}

}  // namespace probewarp
