#include "tools/command/options/number_option.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <utility>

#include "interpreter/base/text/text.hpp"

namespace s7200::tools {
namespace {

std::string to_text(const Between<std::uint64_t>& range) {
  if (range.most == UINT64_MAX) return fmt::format("{} or more", range.least);
  return fmt::format("{} {} {}", range.least, range.most == range.least + 1 ? "or" : "to", range.most);
}

std::string to_text(const Between<double>& range) { return fmt::format("{} to {}", range.least, range.most); }

std::string help_text(const std::string& text, const std::string& range, const std::string& standard) {
  return fmt::format("{} ({}){}", text, range, standard.empty() ? "" : fmt::format(" [{}]", standard));
}

/// What kind of number an option takes.
struct NumberKind {
  std::string_view name;
  bool (*is)(std::string_view text);  // in any range
};

std::string wrong(const std::string& given, const NumberKind& kind, const std::string& range) {
  const std::string shown = stl::shortened(given);
  return kind.is(given) ? fmt::format("'{}' is out of range ({})", shown, range)
                        : fmt::format("'{}' is not a {} ({})", shown, kind.name, range);
}

template <class Number>
CLI::Option* add_number(CLI::App& app, const std::string& name, std::function<void(Number)> take, Between<Number> range,
                        NumberKind kind, const std::string& text, const std::string& standard) {
  return app
      .add_option_function<std::string>(
          name,
          [name, take = std::move(take), range, kind](const std::string& given) {
            const auto value = parse_decimal<Number>(given);
            if (!value || !range.has(*value)) throw CLI::ValidationError(name, wrong(given, kind, to_text(range)));
            take(*value);
          },
          help_text(text, to_text(range), standard))
      ->type_name("N");
}

}  // namespace

CLI::Option* add_whole_number(CLI::App& app, const std::string& name, std::function<void(std::uint64_t)> take,
                              Between<std::uint64_t> range, const std::string& text, const std::string& standard) {
  return add_number(app, name, std::move(take), range, {"whole number", is_whole_number}, text, standard);
}

CLI::Option* add_real_number(CLI::App& app, const std::string& name, std::function<void(double)> take, Between<double> range,
                             const std::string& text, const std::string& standard) {
  return add_number(app, name, std::move(take), range, {"number", is_real_number}, text, standard);
}

CLI::Option* add_duration(CLI::App& app, const std::string& name, Time& value, const std::string& text,
                          Between<Time> range) {
  return app
      .add_option_function<std::string>(
          name,
          [name, &value, range](const std::string& given) {
            const auto duration = parse_duration_in(given, range);
            if (!duration) throw CLI::ValidationError(name, duration.why());
            value = *duration;
          },
          text)
      ->type_name("TIME");
}

}  // namespace s7200::tools
