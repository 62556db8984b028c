#include "tools/command/options/input.hpp"

#include <fmt/format.h>

#include <utility>

#include "interpreter/program/ladder/ladder.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/files/files.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {
namespace {

/// What came through a pipe is gone when it has been read.
std::optional<std::string> read_standard_input_once(std::string& why) {
  static bool read = false;
  if (std::exchange(read, true)) {
    why = "it has been read already";
    return {};
  }
  return read_standard_input(why);
}

}  // namespace

std::optional<std::string> read_input(const std::string& path, std::string& name) {
  const bool from_input = is_standard_input(path);
  name = from_input ? "standard input" : path;
  std::string why;
  auto bytes = from_input ? read_standard_input_once(why) : read_file(path, why);
  if (!bytes && !interrupted()) print_error(fmt::format("cannot read {}: {}", name, why));
  return bytes;
}

std::optional<SourceText> read_drawings(const std::string& path) {
  std::string name, why;
  const auto bytes = read_input(path, name);
  if (!bytes) return {};
  auto text = s7200::read_drawings(*bytes, name, why);
  if (!text) print_error(fmt::format("cannot read {}: {}", name, why));
  return text;
}

}  // namespace s7200::tools
