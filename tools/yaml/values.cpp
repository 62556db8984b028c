#include "tools/yaml/values.hpp"

#include <filesystem>

#include "interpreter/base/file_path.hpp"
#include "interpreter/base/file_source.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "tools/yaml/names.hpp"

namespace s7200::tools {

Complaints::Complaints(stl::Diagnostics& list) : list_(list) {
  for (const stl::Diagnostic& known : list) known_.emplace(known.position.line, known.position.column);
}

void Complaints::add(const YamlNode& node, std::string message, std::string hint) {
  if (known_.emplace(node.position.line, node.position.column).second)
    list_.push_back({stl::Severity::Error, node.position, std::move(message), std::move(hint)});
}

std::string beside(const std::string& file, const std::string& path) {
  if (is_standard_input(path)) return path;
  return (file_path(file).parent_path() / file_path(path)).lexically_normal().generic_string();
}

void YamlValues::wrong(const YamlNode& node, std::string message, std::string hint) {
  complaints.add(node, std::move(message), std::move(hint));
}

std::optional<std::string> YamlValues::text(const YamlNode& node) {
  if (node.is_scalar()) return node.text;
  wrong(node, "one value is needed here, not " + to_text(node));
  return {};
}

std::optional<std::string> name_from(const YamlNode& node, YamlValues& values) {
  auto written = values.text(node);
  if (!written || written->find('\0') == std::string::npos) return written;
  values.wrong(node, fmt::format("'{}' has the character NUL in it, which no name can have", stl::shortened(*written)));
  return {};
}

std::optional<std::string> YamlValues::optional_text(const YamlNode& map, std::string_view key) {
  const YamlNode* node = map.find(key);
  auto written = node ? name_from(*node, *this) : std::nullopt;
  return written && written->empty() ? std::nullopt : written;
}

std::optional<std::int64_t> YamlValues::number(const YamlNode* node, std::int64_t from, std::int64_t to) {
  return value(node, fmt::format("a number from {} to {}", from, to), fmt::format("{}, 16#{:X}", to, to),
               [&](const std::string& t) -> std::optional<std::int64_t> {
                 const auto number = parse_integer(stl::trim(t));
                 return number && *number >= from && *number <= to ? number : std::nullopt;
               });
}

std::optional<Time> YamlValues::duration(const YamlNode* node) {
  return value(node, kDuration, "250ms, 2s, 0", [](const std::string& t) -> std::optional<Time> {
    const auto time = t == "0" ? Time{0} : parse_duration(t);
    return time && *time <= kLongestYamlDuration ? time : std::nullopt;
  });
}

bool YamlValues::truth(const YamlNode* node) {
  return choice<bool>(node, {{"true", true}, {"false", false}}).value_or(false);
}

}  // namespace s7200::tools
