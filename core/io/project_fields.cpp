#include "io/project_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "io/printable.h"

namespace probewarp {

namespace {

constexpr std::size_t max_json_bytes = std::size_t{16} << 20;
constexpr int max_json_depth = 8;
constexpr std::size_t max_json_objects =
    2 * max_project_probes + 8;  // a probe and its paint, the project a few
constexpr std::size_t max_json_lists =
    3 * max_project_probes + 8;              // rest, now and the paint's extent of each
constexpr std::size_t max_json_fields = 64;  // of one object

/// Whether the text begins with UTF-16's mark, of either byte order.
bool is_utf16(std::span<const std::byte> bytes) {
    if (bytes.size() < 2) return false;
    const auto mark = std::to_integer<unsigned>(bytes[0]) << 8 | std::to_integer<unsigned>(bytes[1]);
    return mark == 0xfeff || mark == 0xfffe;
}

/// Called by the parser while it parses, throws Error where there is too much, or a key twice.
class Limits {
  public:
    void check(int depth, Json::parse_event_t event, const Json& parsed) {
        if (depth > max_json_depth)
            throw Error(fmt::format("project.json is nested deeper than expected: at most {} levels",
                                    max_json_depth));
        // The library takes time in the square of an outer list's objects.
        if (event == Json::parse_event_t::object_start && ++objects_ > max_json_objects)
            throw Error(
                fmt::format("project.json holds too much; expected at most {} objects", max_json_objects));
        if (event == Json::parse_event_t::array_start && ++lists_ > max_json_lists)
            throw Error(
                fmt::format("project.json holds too much; expected at most {} lists", max_json_lists));
        const auto level = std::size_t(depth);
        if (event == Json::parse_event_t::object_start) keys_[level + 1].clear();
        if (event == Json::parse_event_t::key) add_key(level, parsed.get<std::string>());
    }

  private:
    void add_key(std::size_t level, const std::string& key) {
        if (!keys_[level].insert(key).second)
            throw Error(key.empty() ? "project.json has two fields without a name; expected none"
                                    : fmt::format("project.json has the field \"{}\" twice; expected it once",
                                                  printable(key.substr(0, 80))));
        if (keys_[level].size() > max_json_fields)
            throw Error(fmt::format("project.json has an object with too many fields; expected at most {}",
                                    max_json_fields));
    }

    std::vector<std::set<std::string>> keys_{max_json_depth + 2};  ///< of the innermost objects, by depth
    std::size_t objects_ = 0, lists_ = 0;
};

/// A value for a message: "null", "the text \"2\"", "[1,null]", "a list of 1001". However large it is, the
/// message is short, and soon made.
std::string in_words(const Json& value) {
    constexpr std::size_t longest_text = 40, longest_list = 4;
    const auto written = [](const Json& brief) {
        return brief.dump(-1, ' ', false, Json::error_handler_t::replace);
    };
    if (value.is_object()) return "an object";
    if (value.is_array()) {
        const auto is_long = [](const Json& element) {
            return element.is_structured() || element.is_string();
        };
        const bool brief = value.size() <= longest_list && std::ranges::none_of(value, is_long);
        return brief ? written(value) : fmt::format("a list of {}", value.size());
    }
    if (!value.is_string()) return written(value);
    const auto& text = value.get_ref<const std::string&>();
    return "the text " + written(text.substr(0, longest_text)) + (text.size() > longest_text ? "..." : "");
}

/// place: empty for the whole of project.json
Error is_not(const std::string& place, const Json& value, std::string_view expected) {
    return Error(fmt::format("project.json{} is {}; expected {}", place.empty() ? "" : ": " + place,
                             in_words(value), expected));
}

}  // namespace

Json parse_project_json(std::span<const std::byte> bytes) {
    if (bytes.size() > max_json_bytes) throw Error("project.json is too long; expected at most 16 MiB");
    if (is_utf16(bytes)) throw Error("project.json is saved as UTF-16; expected UTF-8");
    Limits limits;
    const auto watch = [&](int depth, Json::parse_event_t event, Json& parsed) {
        limits.check(depth, event, parsed);
        return true;
    };
    const auto* first = reinterpret_cast<const char*>(bytes.data());
    try {
        return Json::parse(first, first + bytes.size(), watch);
    } catch (const Json::parse_error& error) {
        throw Error(fmt::format("project.json is damaged at byte {}; expected JSON", error.byte));
    } catch (const Json::out_of_range&) {
        throw Error("project.json has a number that is too large; expected one that a double can hold");
    }
}

Fields::Fields(const Json& json, std::string place) : json_(json), place_(std::move(place)) {
    if (!json.is_object()) throw is_not(place_, json, "an object");
}

Error Fields::wrong(const std::string& field, std::string_view expected) const {
    const std::string place = place_.empty() ? field : place_ + "." + field;
    const auto found = json_.find(field);
    if (found != json_.end()) return is_not(place, *found, expected);
    return Error(fmt::format("project.json: {} is missing; expected {}", place, expected));
}

const Json& Fields::take(const char* field) {
    const auto found = json_.find(field);
    if (found == json_.end()) throw wrong(field, "it to be there");
    taken_.insert(field);
    return *found;
}

double Fields::number(const char* field, double least, double most) {
    return checked(take(field), field, least, most);
}

int Fields::whole(const char* field, int least, int most) {
    const Json& value = take(field);
    if (!value.is_number_integer() || value < least || value > most)
        throw wrong(field, fmt::format("a whole number from {} to {}", least, most));
    return value.get<int>();
}

bool Fields::yes(const char* field) {
    const Json& value = take(field);
    if (!value.is_boolean()) throw wrong(field, "true or false");
    return value.get<bool>();
}

std::string Fields::text(const char* field, std::size_t longest) {
    const Json& value = take(field);
    std::string text = value.is_string() ? value.get<std::string>() : std::string();
    if (!value.is_string() || text.size() > longest ||
        std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }))
        throw wrong(field, fmt::format("a line of text of at most {} bytes", longest));
    return text;
}

std::string Fields::file(const char* field) {
    std::string name = text(field, 80);
    if (name.empty()) throw wrong(field, "the name of a member of the archive");
    return name;
}

glm::dvec2 Fields::point(const char* field, double least, double most) {
    const Json& value = take(field);
    if (!value.is_array() || value.size() != 2) throw wrong(field, "two numbers");
    return {checked(value[0], field, least, most), checked(value[1], field, least, most)};
}

void Fields::finish() const {
    for (const auto& [key, value] : json_.items()) {
        if (taken_.contains(key)) continue;
        const std::string where = place_.empty() ? "" : " in " + place_;
        if (key.empty())
            throw Error(fmt::format("project.json has a field without a name{}; expected none", where));
        throw Error(fmt::format(
            "project.json has the field \"{}\"{}, which this version does not know; expected a project of "
            "this version",
            printable(key.substr(0, 80)), where));
    }
}

double Fields::checked(const Json& value, const char* field, double least, double most) const {
    if (!value.is_number() || !(value.get<double>() >= least) || !(value.get<double>() <= most))
        throw wrong(field, fmt::format("{} from {:g} to {:g}",
                                       json_.at(field).is_array() ? "numbers" : "a number", least, most));
    return value.get<double>();
}

}  // namespace probewarp
