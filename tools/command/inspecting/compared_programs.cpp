#include "tools/command/inspecting/compared_programs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "interpreter/base/text/counted.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/terminal/terminal.hpp"

namespace s7200::tools {
namespace {

/// False after a message.
bool add_parts(ProgramFiles& program, const std::vector<std::string>& parts) {
  std::vector<SourceText> files;
  files.push_back(std::move(program.text));
  for (const std::string& path : parts) {
    auto part = read_program_text(path);
    if (!part) return false;
    files.push_back(std::move(*part));
  }
  program.text = join_files(std::move(files));
  return true;
}

}  // namespace

std::vector<std::string> ComparedFiles::all() const {
  std::vector<std::string> paths = words;
  paths.insert(paths.end(), old_parts.begin(), old_parts.end());
  paths.insert(paths.end(), new_parts.begin(), new_parts.end());
  return paths;
}

std::optional<OldAndNew> read_compared(const ComparedFiles& files) {
  int exit_code = kFine;
  auto programs = read_programs(files.words, exit_code);
  if (exit_code != kFine) return {};
  if (programs.size() != 2) {
    print_error(
        fmt::format("compare takes two programs, OLD and NEW; {} given", s7200::counted(programs.size(), "program")));
    return {};
  }
  OldAndNew both{std::move(programs[0]), std::move(programs[1]), {}};
  std::ranges::copy_if(files.words, std::back_inserter(both.old_parts),
                       [&](const std::string& path) { return path != both.older.path && path != both.newer.path; });
  both.old_parts.insert(both.old_parts.end(), files.old_parts.begin(), files.old_parts.end());
  if (!add_parts(both.older, files.old_parts) || !add_parts(both.newer, files.new_parts)) return {};
  return both;
}

}  // namespace s7200::tools
