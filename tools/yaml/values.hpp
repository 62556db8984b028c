// The values of a YAML tree, or what is wrong with them, at their place.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interpreter/base/text/text.hpp"
#include "interpreter/base/time.hpp"
#include "tools/yaml/yaml.hpp"

namespace s7200::tools {

/// Collects the mistakes in one file. A mistake in a loop is made in every turn of it and told once; so is a mistake that
/// the parser of YAML has found before.
class Complaints {
 public:
  explicit Complaints(stl::Diagnostics& list);
  void add(const YamlNode& node, std::string message, std::string hint = {});
  std::size_t count() const { return list_.size(); }

 private:
  stl::Diagnostics& list_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> known_;
};

/// A path in a file: from the folder of that file.
std::string beside(const std::string& file, const std::string& path);

inline constexpr Time kLongestYamlDuration = 24 * 3600 * kSecond;

/// Reads the values of nodes. A node that is null gives nothing and no complaint.
class YamlValues {
 public:
  explicit YamlValues(stl::Diagnostics& diagnostics) : complaints(diagnostics) {}
  virtual ~YamlValues() = default;

  Complaints complaints;

  virtual void wrong(const YamlNode& node, std::string message, std::string hint = {});

  /// Reads a scalar; nothing after a complaint.
  virtual std::optional<std::string> text(const YamlNode& node);

  /// Reads the scalar of a key, if it is there and not empty.
  std::optional<std::string> optional_text(const YamlNode& map, std::string_view key);

  /// Reads the value with `parse`, if it is there; `what` it is and an `example` are for the complaint.
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
        if (stl::upper_case(t) == stl::upper_case(std::string(name))) return is;
      return {};
    });
  }

  std::optional<std::int64_t> number(const YamlNode* node, std::int64_t from, std::int64_t to);

  static constexpr std::string_view kDuration = "a duration with its unit, of a day at most";

  /// Reads a duration of at most a day.
  std::optional<Time> duration(const YamlNode* node);

  /// Reads `true` or `false`; false if the node is null.
  bool truth(const YamlNode* node);
};

}  // namespace s7200::tools
