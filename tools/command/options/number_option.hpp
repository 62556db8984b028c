// Options with a number or a duration. Each has a range; anything else is a usage error that names the option. Values are
// read here and not by CLI11, for which 010 is 8, -1 a large number and nan in every range.
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "interpreter/base/text/numbers.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace s7200::tools {

/// `--count N`: a whole number in decimal; `take` gets it. The help says `text`, the range, and the `standard` that holds
/// without the option.
CLI::Option* add_whole_number(CLI::App& app, const std::string& name, std::function<void(std::uint64_t)> take,
                              Between<std::uint64_t> range, const std::string& text, const std::string& standard = "");

/// The same into a variable, which keeps what it has without the option.
template <std::integral Number>
CLI::Option* add_whole_number(CLI::App& app, const std::string& name, Number& value, Between<std::uint64_t> range,
                              const std::string& text, const std::string& standard = "") {
  return add_whole_number(
      app, name, [&value](std::uint64_t given) { value = static_cast<Number>(given); }, range, text, standard);
}

/// `--speed 0.5`
CLI::Option* add_real_number(CLI::App& app, const std::string& name, std::function<void(double)> take, Between<double> range,
                             const std::string& text, const std::string& standard = "");

/// `--for 2s`
CLI::Option* add_duration(CLI::App& app, const std::string& name, Time& value, const std::string& text,
                          Between<Time> range = {0, kLongestDuration});

}  // namespace s7200::tools
