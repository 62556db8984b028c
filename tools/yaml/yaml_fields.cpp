#include "tools/yaml/yaml_fields.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "interpreter/base/text/text.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kMostNodes = 10'000;  // aliases can make any number of a few lines

class FieldsOfYaml {
 public:
  explicit FieldsOfYaml(const YAML::Node& map) { add(map, "", 0); }
  std::vector<YamlField> take() { return std::move(fields_); }

 private:
  void add(const YAML::Node& node, const std::string& name, int depth) {
    constexpr int kDeepest = 16;  // an alias may name what it is in
    if (depth > kDeepest || ++nodes_ > kMostNodes) return;
    if (node.IsScalar()) return add_scalar(node, name);
    if (node.IsMap())
      for (const auto& pair : node)
        if (is_name(pair.first)) add(pair.second, name + (name.empty() ? "" : " ") + pair.first.Scalar(), depth + 1);
    if (!node.IsSequence()) return;
    std::vector<std::string> items;
    for (const auto& item : node)
      if (item.IsScalar()) items.push_back(item.Scalar());
    if (!items.empty() && items.size() == node.size())
      fields_.push_back({.name = name, .items = std::move(items)});
    else
      for (const auto& item : node) add(item, name, depth + 1);
  }

  static bool is_name(const YAML::Node& key) {
    return key.IsScalar() && !key.Scalar().empty() && !stl::is_digit(key.Scalar().front());
  }

  void add_scalar(const YAML::Node& node, const std::string& name) {
    const bool binary = node.Tag() == "tag:yaml.org,2002:binary";
    std::string value = node.Scalar();
    if (binary)
      std::erase_if(value, [](char c) { return stl::is_blank(c) || c == '\n' || c == '\r'; });
    else
      std::ranges::replace(value, '\n', ' ');
    fields_.push_back({.name = name, .value = std::move(value), .quoted = node.Tag() == "!", .binary = binary});
  }

  std::vector<YamlField> fields_{};
  std::size_t nodes_ = 0;
};

}  // namespace

Result<std::vector<YamlField>> read_yaml_fields(const std::string& text) {
  try {
    const YAML::Node all = YAML::Load(text);
    const YAML::Node one = all.IsSequence() && all.size() == 1 ? all[0] : all;
    return one.IsMap() ? FieldsOfYaml(one).take() : std::vector<YamlField>{};
  } catch (const YAML::Exception&) {
    return trouble("it is not YAML");
  }
}

}  // namespace s7200::tools
