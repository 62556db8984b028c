// What a piece of YAML that others have written says, without its places: scalars with the names around them. Aliases and
// the tag of binary data may be in it, which a YamlNode has not.
#pragma once

#include <string>
#include <vector>

#include "interpreter/base/result.hpp"

namespace s7200::tools {

struct YamlField {
  std::string name{};                ///< with the names around it before it: `request data`
  std::string value{};               ///< of a scalar; the lines of a text are one, with blanks between them
  std::vector<std::string> items{};  ///< of a list of scalars, instead
  bool quoted = false;
  bool binary = false;  ///< !!binary: `value` is base64, without its blanks
};

/// The fields of a map, or of the map that is the only item of a list: at most 10 000 nodes, 16 within each other. Names do
/// not begin with a digit: `10:00:00 TX: 01 03` is a row of a log, although YAML has a key in it. Empty for other YAML,
/// trouble for what is none.
Result<std::vector<YamlField>> read_yaml_fields(const std::string& text);

}  // namespace s7200::tools
