#include "tools/yaml/yaml.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/text.hpp"

namespace s7200::tools {

const YamlNode* YamlNode::find(std::string_view key) const {
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (keys[i].text == key) return &items[i];
  return nullptr;
}

YamlNode part_of(const YamlNode& node, std::string_view text, std::size_t begin, std::size_t length) {
  YamlNode part = node;
  if (node.text_column == 0 || text != node.text) return part;
  const auto count = [](std::string_view of) { return static_cast<std::uint32_t>(stl::count_characters(of)); };
  part.position.column = node.text_column + count(text.substr(0, begin));
  part.position.length = std::max(1U, count(text.substr(std::min(begin, text.size()), length)));
  return part;
}

bool is_yaml_file(const std::filesystem::path& path) {
  const std::string extension = stl::lower_case(path.extension().string());
  return extension == ".yaml" || extension == ".yml";
}

std::string to_text(const YamlNode& node) {
  if (node.is_map()) return "a map";
  if (node.is_list()) return "a list";
  return node.text.empty() ? "nothing" : fmt::format("'{}'", stl::shortened(node.text));
}

std::shared_ptr<const stl::SourceLines> source_of(const std::string& text, const std::string& path) {
  auto source = std::make_shared<stl::SourceLines>();
  source->name = path;
  source->text = stl::split_lines(text);
  return source;
}

}  // namespace s7200::tools
