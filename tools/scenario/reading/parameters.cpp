#include "tools/scenario/reading/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "interpreter/base/diagnostic.hpp"
#include "interpreter/base/text/text.hpp"

namespace s7200::tools {
namespace {

constexpr const char* kReasonExample = "write for example expected_failures: {SL-gap-2: 'it has no clock for that'}";

/// Takes over what a tree says: a.b for maps in maps.
class ParameterTree {
 public:
  ParameterTree(Parameters& parameters, std::vector<ParameterName>& names, Complaints& complaints)
      : parameters_(parameters), names_(names), complaints_(complaints) {}

  void read(const YamlNode& map, const std::string& prefix) {
    if (!map.is_map())
      return complaints_.add(map, "parameters are a map, not " + to_text(map), "write for example: station: 1");
    for (std::size_t i = 0; i < map.keys.size() && i < map.items.size(); ++i) read_one(map.keys[i], map.items[i], prefix);
  }

 private:
  void read_one(const YamlNode& key, const YamlNode& value, const std::string& prefix) {
    const std::string name = prefix + key.text;
    const auto fits = [](char c) { return stl::is_letter(c) || stl::is_digit(c) || c == '_'; };
    if (!std::all_of(key.text.begin(), key.text.end(), fits) || !stl::is_letter(key.text.front()))
      return complaints_.add(key, fmt::format("'{}' is not the name of a parameter", stl::shortened(key.text)),
                             "letters, digits and _");
    if (value.is_map()) return read(value, name + ".");
    names_.push_back({name, key.position});
    if (value.is_scalar()) {
      if (value.text.empty()) {
        parameters_.empty.insert(name);
      } else {
        parameters_.values[name] = value.text;
      }
      return;
    }
    std::vector<std::string>& list = parameters_.lists[name];
    list.clear();
    for (const YamlNode& item : value.items) {
      if (!item.is_scalar()) return complaints_.add(item, "a list of parameters has plain values only");
      list.push_back(item.text);
      parameters_.values[name + "." + item.text] = "1";
    }
  }

  Parameters& parameters_;
  std::vector<ParameterName>& names_;
  Complaints& complaints_;
};

/// The tree without them.
YamlNode take_expected_failures(const YamlNode& root, GivenParameters& given, Complaints& complaints) {
  YamlNode rest = root;
  for (std::size_t i = 0; i < rest.keys.size() && i < rest.items.size(); ++i) {
    if (rest.keys[i].text != "expected_failures") continue;
    const YamlNode map = rest.items[i];
    const auto at = static_cast<std::ptrdiff_t>(i);
    rest.keys.erase(rest.keys.begin() + at);
    rest.items.erase(rest.items.begin() + at);
    if (!map.is_map()) complaints.add(map, "'expected_failures' is a map, not " + to_text(map), kReasonExample);
    for (std::size_t k = 0; k < map.keys.size() && k < map.items.size(); ++k) {
      const bool has_reason = map.items[k].is_scalar() && !map.items[k].text.empty();
      if (!has_reason) complaints.add(map.items[k], "an expected failure without a reason", kReasonExample);
      given.expected_failures.push_back({{map.keys[k].text, map.keys[k].position}, map.items[k].text});
    }
    break;
  }
  return rest;
}

}  // namespace

void read_parameter_tree(const YamlNode& map, Parameters& parameters, std::vector<ParameterName>& names,
                         Complaints& complaints) {
  ParameterTree(parameters, names, complaints).read(map, "");
}

std::optional<GivenParameters> read_parameters(const std::string& text, const std::string& path,
                                               stl::Diagnostics& diagnostics) {
  GivenParameters given;
  given.source = source_of(text, path);
  const auto root = read_yaml(text, *given.source, diagnostics);
  if (!root) return {};
  Complaints complaints(diagnostics);
  read_parameter_tree(take_expected_failures(*root, given, complaints), given.parameters, given.names, complaints);
  for (const char* name : {"program", "times", "skip_without"})
    if (const auto found = given.parameters.values.find(name); found != given.parameters.values.end())
      found->second = beside(path, found->second);
  stl::sort(diagnostics);
  if (has_errors(diagnostics)) return {};
  return given;
}

}  // namespace s7200::tools
