// project.json as text from outside: parsed within limits, and its fields taken one by one, each with a
// message that says where it is, what stands there and what was expected. Private to io.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "model/error.h"
#include "model/probe.h"

namespace probewarp {

using Json = nlohmann::ordered_json;

inline constexpr std::size_t max_project_probes = 10000;

/// Throws Error where the text is no JSON, has a key twice in one object, or holds more than a project does.
Json parse_project_json(std::span<const std::byte> bytes);

/// An object's fields, taken one by one; what is left at the end is unknown. Everything throws Error where a
/// field is not there or is not what was asked for. Refers to the JSON it is made from.
class Fields {
  public:
    /// place: of the object, empty for the whole of project.json; it stands in messages.
    Fields(const Json& json, std::string place);

    const Json& take(const char* field);
    double number(const char* field, double least, double most);
    int whole(const char* field, int least, int most);
    bool yes(const char* field);
    /// One line of at most `longest` bytes.
    std::string text(const char* field, std::size_t longest);
    /// The name of a member of the archive.
    std::string file(const char* field);
    glm::dvec2 point(const char* field, double least = -max_probe_coordinate,
                     double most = max_probe_coordinate);
    /// Throws Error for a field that was not taken.
    void finish() const;

    std::string place() const { return place_; }
    /// What to throw for a field that is not as `expected`.
    Error wrong(const std::string& field, std::string_view expected) const;

  private:
    double checked(const Json& value, const char* field, double least, double most) const;

    const Json& json_;
    std::string place_;
    std::set<std::string> taken_;
};

}  // namespace probewarp
