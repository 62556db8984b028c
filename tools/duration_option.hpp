// Durations as options: `--for 2s`.
#pragma once

#include <string>

#include "interpreter/base/time.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace s7200::tools {

/// An option with a duration; usage errors are CLI11's. `value` keeps what it has when the option is not given.
CLI::Option* add_duration(CLI::App& app, const std::string& name, Time& value, const std::string& text);

}  // namespace s7200::tools
