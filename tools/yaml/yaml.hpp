// A YAML text as a plain tree in which everything knows its place.
//
// What our files need of YAML: maps, lists and scalars, in block or flow form. No anchors and aliases (a few lines of them
// can stand for gigabytes), no tags, one document in a file, every key once. Size, nesting and number of nodes are bounded.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/diagnostic.hpp"

namespace s7200::tools {

struct YamlNode {
  enum class Kind : std::uint8_t { Scalar, List, Map };

  Kind kind = Kind::Scalar;
  stl::Position position{};
  std::string text{};             ///< of a scalar, without quotes; empty if nothing was written
  std::uint32_t text_column = 0;  ///< where the text begins, if it stands in its line as it is read; else 0
  std::vector<YamlNode> keys{};   ///< of a map: scalars, all different, as many as items
  std::vector<YamlNode> items{};  ///< of a list, or the values of a map

  bool is_scalar() const { return kind == Kind::Scalar; }
  bool is_list() const { return kind == Kind::List; }
  bool is_map() const { return kind == Kind::Map; }

  /// The value of a map's key; null when there is none.
  const YamlNode* find(std::string_view key) const;
};

/// A part of a scalar that was read as `text`, for a complaint: `length` bytes from byte `begin` on. The whole scalar if
/// another text stands there.
YamlNode part_of(const YamlNode& node, std::string_view text, std::size_t begin, std::size_t length);

/// Whether a file is YAML by its name: .yaml or .yml, in any case.
bool is_yaml_file(const std::filesystem::path& path);

/// The kind of a node for messages: "a map", "a list", "'text'".
std::string to_text(const YamlNode& node);

inline constexpr int kDeepestYaml = 24;             ///< maps and lists inside each other
inline constexpr std::size_t kMostYamlKeys = 1000;  ///< in one map

/// A text with the name that messages have for it.
std::shared_ptr<const stl::SourceLines> source_of(const std::string& text, const std::string& path);

/// The document being read, for messages, and its limits.
struct YamlDocument {
  std::string_view name = "a scenario";
  std::string_view least = "'program:' and 'steps:'";  ///< it has these keys
  std::size_t bytes = 1 << 20;
  std::size_t nodes = 100'000;  ///< maps, lists, keys and values
};

/// Returns nothing and adds errors if the text is not such YAML.
std::optional<YamlNode> read_yaml(const std::string& text, const stl::SourceLines& source, stl::Diagnostics& diagnostics,
                                  const YamlDocument& document = {});

}  // namespace s7200::tools
