// The values of a scenario, out of its YAML: with `${…}` put in, or complained about at their place.
#pragma once

#include <fmt/format.h>

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interpreter/base/text.hpp"
#include "tools/scenario/keys.hpp"
#include "tools/scenario/parameters.hpp"
#include "tools/scenario/text.hpp"
#include "tools/scenario/yaml.hpp"

namespace s7200::tools {

/// Of a node that is null, and of one that is a parameter without a value, nothing comes and nothing is complained about.
class ValueReader {
 public:
  explicit ValueReader(stl::Diagnostics& diagnostics) : complaints(diagnostics) {}

  static constexpr std::string_view kDuration = "a duration of a day at most";

  Complaints complaints;
  Parameters parameters{};
  std::string loop{};  ///< `function = 3, count = 126`: which turn of its loops is read; stands at the end of a complaint

  void wrong(const YamlNode& node, std::string message, std::string hint = {});

  /// Complains about keys that have no place in `places`, beside `action` if it is one of a step.
  void check_keys(const YamlNode& map, std::initializer_list<ScenarioKey::Where> places, std::string_view action = {});

  /// A scalar with its `${…}` put in; nothing after a complaint.
  std::optional<std::string> text(const YamlNode& node);

  /// The same of a key, if it is there and not empty.
  std::optional<std::string> optional_text(const YamlNode& map, std::string_view key);

  /// What `parse` makes of the value, if it is there; `what` it is and an `example` for the complaint.
  template <class Parse>
  auto value(const YamlNode* node, std::string_view what, std::string_view example, Parse parse)
      -> decltype(parse(std::string())) {
    if (!node) return {};
    const auto written = text(*node);
    if (!written || (written->empty() && !node->text.empty())) return {};
    auto result = parse(*written);
    if (!result)
      wrong(*node, fmt::format("'{}' is not {}", stl::shortened(*written), what),
            fmt::format("write for example {}", example));
    return result;
  }

  template <class Value>
  std::optional<Value> choice(const YamlNode* node, const std::vector<std::pair<std::string_view, Value>>& choices) {
    std::string all;
    for (const auto& [name, is] : choices) all.append(all.empty() ? "" : ", ").append(name);
    return value(node, "a choice here", all, [&](const std::string& t) -> std::optional<Value> {
      for (const auto& [name, is] : choices)
        if (lower_case(t) == name) return is;
      return {};
    });
  }

  std::optional<Time> time(const YamlNode* node);
  std::optional<Span> span(const YamlNode* node);
  std::optional<Window> window(const YamlNode* node, Time tolerance);
  std::optional<std::int64_t> number(const YamlNode* node, std::int64_t from, std::int64_t to);
  Count count(const YamlNode& node);

  /// `true` or `false`; false if it is left out.
  bool truth(const YamlNode* node);

  /// Whether the calculations in `needs:` hold; the first that does not is what is missing.
  bool has_what_it_needs(const YamlNode& map, std::string& missing);

 private:
  std::string parameter_names() const;
};

}  // namespace s7200::tools
