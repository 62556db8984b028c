// The values of a scenario, out of its YAML: with `${…}` put in, or complained about at their place.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/scenario/reading/keys.hpp"
#include "tools/scenario/reading/parameters.hpp"
#include "tools/scenario/reading/text.hpp"
#include "tools/yaml/values.hpp"

namespace s7200::tools {

/// Of a node that is null, and of one that is a parameter without a value, nothing comes and nothing is complained about.
class ValueReader : public YamlValues {
 public:
  using YamlValues::YamlValues;

  Parameters parameters{};
  std::string loop{};  ///< `function = 3, count = 126`: which turn of its loops is read; stands at the end of a complaint

  void wrong(const YamlNode& node, std::string message, std::string hint = {}) override;

  /// Complains about keys that have no place in `places`, beside `action` if it is one of a step.
  void check_keys(const YamlNode& map, std::initializer_list<ScenarioKey::Where> places, std::string_view action = {});

  /// A scalar with its `${…}` put in; nothing after a complaint.
  std::optional<std::string> text(const YamlNode& node) override;

  std::optional<Time> time(const YamlNode* node);
  std::optional<Span> span(const YamlNode* node);
  std::optional<Window> window(const YamlNode* node, Time tolerance);
  Count count(const YamlNode& node);

  /// Whether the calculations in `needs:` hold; the first that does not is what is missing.
  bool has_what_it_needs(const YamlNode& map, std::string& missing);

 private:
  std::string parameter_names() const;
};

}  // namespace s7200::tools
