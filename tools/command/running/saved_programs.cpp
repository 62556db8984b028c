#include "tools/command/running/saved_programs.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string_view>
#include <system_error>

#include "interpreter/base/file_path.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/reading/stl_output.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/files/file_system.hpp"
#include "tools/measuring/long_listing.hpp"
#include "tools/measuring/measure.hpp"
#include "tools/measuring/mixed_program.hpp"

namespace s7200::tools {

int save_programs(const std::string& folder) {
  std::map<std::string, std::function<std::string()>> texts;
  const auto path = [&](std::string_view kind, std::uint32_t length) {
    return (file_path(folder) / fmt::format("{}_{}.stl", kind, length)).generic_string();
  };
  for (const std::uint32_t instructions : kMixedLengths)
    texts[path("mixed", instructions)] = [instructions] { return mixed_program(instructions); };
  for (const std::uint32_t lines : {100'000U, 1'000'000U})
    texts[path("listing", lines)] = [lines] { return long_listing(lines); };
  std::error_code error;
  if (!std::filesystem::is_directory(file_path(folder), error) &&
      !std::filesystem::create_directory(file_path(folder), error))
    return print_error(fmt::format("cannot make the folder {}: {}", folder, error_text(error))), kUnusable;
  for (const auto& [file, text] : texts)
    if (std::filesystem::exists(file_path(file), error))
      return print_error(fmt::format("{} exists; give --save-programs another folder", file)), kUnusable;
  for (const auto& [file, text] : texts)
    if (const int written = write_stl(file, {}, false, text()); written != kFine) return written;
  return kFine;
}

}  // namespace s7200::tools
