#include "tools/command/options/plc/fault_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "interpreter/base/text/text.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/command/terminal/terminal.hpp"

namespace s7200::tools {
namespace {

/// Of the text in front of the place, so that the caret is right: a byte that continues a UTF-8 character has no column.
std::size_t columns(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

}  // namespace

void FaultOptions::add_to(CLI::App& app) {
  app.add_option("--fault", texts_, "a fault of the line: s7200 help faults (repeatable)")
      ->type_name("KIND:PARAMETER=VALUE,...")
      ->allow_extra_args(false)
      ->group(help_group::kLine);
}

bool FaultOptions::prepare() {
  bool fine = true;
  for (const std::string& text : texts_) {
    const serial::ParsedFault parsed = serial::parse_fault(text);
    if (parsed.ok())
      faults_.push_back(parsed.fault);
    else
      print_fault_error(*parsed.error, text);
    fine &= parsed.ok();
  }
  return fine;
}

void print_fault_error(const serial::FaultError& error, std::string_view text) {
  const std::size_t before = std::min(error.column - 1, text.size());
  const std::size_t width = std::max<std::size_t>(columns(text.substr(before, error.length)), 1);
  print_error(fmt::format("--fault, column {}: {}", error.column, error.message));
  fmt::print(stderr, "  {}\n  {}^{}\n", stl::printable(text), std::string(columns(text.substr(0, before)), ' '),
             std::string(width - 1, '~'));
}

}  // namespace s7200::tools
