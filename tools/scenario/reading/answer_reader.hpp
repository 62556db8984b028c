// What is expected of an exchange, and the values in it, out of YAML.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/scenario/expected_answer.hpp"
#include "tools/scenario/reading/value_reader.hpp"

namespace s7200::tools {

/// `silence`, `exception 2`, `01 03 ..`, `{text: 'OK'}`, `[16#1234, ..]`
std::optional<Expected> read_expected(ValueReader& values, const YamlNode& node);

/// What stands in a step at `expect:` or `expect_one_of:`; nothing if there is neither.
std::vector<Expected> read_expectations(ValueReader& values, const YamlNode& step);

/// What stands in `{text: …}`.
std::optional<std::string> text_inside(ValueReader& values, const YamlNode& map);

/// A list of numbers up to `largest`, with a sign too if that is more than 1; `..` is any, where that makes sense.
std::vector<std::optional<std::uint16_t>> read_numbers(ValueReader& values, const YamlNode& list, std::int64_t largest,
                                                       bool any_allowed);

}  // namespace s7200::tools
