#include "tools/scenario/reading/value_reader.hpp"

#include <algorithm>

#include "interpreter/base/text/joined.hpp"

namespace s7200::tools {

void ValueReader::wrong(const YamlNode& node, std::string message, std::string hint) {
  if (!loop.empty()) message += fmt::format(" (with {})", loop);
  complaints.add(node, std::move(message), std::move(hint));
}

void ValueReader::check_keys(const YamlNode& map, std::initializer_list<ScenarioKey::Where> places,
                             std::string_view action) {
  const std::vector<ScenarioKey>& keys = scenario_keys();
  for (const YamlNode& key : map.keys) {
    if (key.text == action) continue;
    const auto fits = [&](const ScenarioKey& k) { return k.key == key.text && k.belongs(places, action); };
    if (std::any_of(keys.begin(), keys.end(), fits)) continue;
    std::vector<std::string_view> known;
    for (const ScenarioKey& k : keys)
      if (k.belongs(places, action)) known.push_back(k.key);
    const std::string here = action.empty() ? "here" : fmt::format("beside '{}'", action);
    wrong(key, fmt::format("'{}' has no place {}", stl::shortened(key.text), here),
          fmt::format("known: {}", fmt::join(known, ", ")));
  }
}

std::optional<std::string> ValueReader::text(const YamlNode& node) {
  if (!node.is_scalar()) {
    wrong(node, "one value is needed here, not " + to_text(node));
    return {};
  }
  if (node.text.find("${") == std::string::npos) return node.text;
  auto result = substitute(node.text, parameters);
  if (!result) wrong(node, result.why(), "parameters: " + parameter_names());
  return std::move(result).if_any();
}

std::string ValueReader::parameter_names() const {
  if (parameters.values.empty()) return "there are none; 'parameters:' at the top of the file, or --with FILE, has them";
  return stl::joined(parameters.values, [](const auto& value) { return value.first; });
}

std::optional<Time> ValueReader::time(const YamlNode* node) {
  return value(node, kDuration, "250ms, 2s, 0", [](const std::string& t) -> std::optional<Time> {
    const auto span = parse_span(t);
    return span && span->millicharacters == 0 ? std::optional(span->fixed) : std::nullopt;
  });
}

std::optional<Span> ValueReader::span(const YamlNode* node) {
  return value(node, kDuration, "20ms, 3.5 characters, 7 characters + 10ms",
               [](const std::string& t) { return parse_span(t); });
}

std::optional<Window> ValueReader::window(const YamlNode* node, Time tolerance) {
  return value(node, "a window of time", "8ms..20ms, ..20ms, 3.5 characters.., 12.5ms",
               [&](const std::string& t) { return parse_window(t, tolerance); });
}

Count ValueReader::count(const YamlNode& node) {
  return value(&node, "a count", "3, 1..3, 1..", [](const std::string& t) { return parse_count(t); }).value_or(Count{});
}

bool ValueReader::has_what_it_needs(const YamlNode& map, std::string& missing) {
  const YamlNode* needs = map.find("needs");
  if (!needs) return true;
  if (!needs->is_list()) {
    wrong(*needs, "'needs' is a list, not " + to_text(*needs), "write for example needs: [coils.count]");
    return true;
  }
  for (const YamlNode& need : needs->items) {
    const auto written = text(need);
    if (!written) continue;
    const auto holds_here = holds(*written, parameters);
    if (!holds_here) wrong(need, holds_here.why());
    if (!holds_here.value_or(true)) {
      missing = *written;
      return false;
    }
  }
  return true;
}

}  // namespace s7200::tools
