#include "tools/command/options/input.hpp"

#include <fmt/format.h>

#include <utility>

#include "interpreter/base/result.hpp"
#include "interpreter/program/ladder/ladder.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/files/files.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {
namespace {

/// What came through a pipe is gone when it has been read.
Result<std::string> read_standard_input_once() {
  static bool read = false;
  if (std::exchange(read, true)) return Trouble{"it has been read already"};
  return read_standard_input();
}

}  // namespace

std::optional<std::string> read_input(const std::string& path, std::string& name) {
  const bool from_input = is_standard_input(path);
  name = from_input ? "standard input" : path;
  auto bytes = from_input ? read_standard_input_once() : read_file(path);
  if (!bytes && !interrupted()) print_error(fmt::format("cannot read {}: {}", name, bytes.why()));
  return std::move(bytes).if_any();
}

std::optional<SourceText> read_drawings(const std::string& path) {
  std::string name;
  const auto bytes = read_input(path, name);
  if (!bytes) return {};
  auto text = s7200::read_drawings(*bytes, name);
  if (!text) print_error(fmt::format("cannot read {}: {}", name, text.why()));
  return std::move(text).if_any();
}

}  // namespace s7200::tools
