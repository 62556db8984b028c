#include "tools/duration_option.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

namespace s7200::tools {

CLI::Option* add_duration(CLI::App& app, const std::string& name, Time& value, const std::string& text) {
  return app
      .add_option_function<std::string>(
          name,
          [&value, name](const std::string& given) {
            const auto duration = parse_duration(given);
            if (!duration)
              throw CLI::ValidationError(name, fmt::format("'{}' is no duration; write for example 250ms, 2s, 1h", given));
            value = *duration;
          },
          text)
      ->type_name("TIME");
}

}  // namespace s7200::tools
