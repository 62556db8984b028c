#include "tools/command/stl_output.hpp"

#include "tools/command/exit_code.hpp"
#include "tools/command/terminal.hpp"
#include "tools/host/interruption.hpp"
#include "tools/host/written_files.hpp"

namespace s7200::tools {

int write_stl(const std::string& output, const std::vector<std::string>& inputs, bool force, const std::string& text) {
  const auto claim = [&](Replace replace, std::string& why) {
    WrittenFiles files;
    for (const std::string& input : inputs) files.reads(input);
    return files.claim("-o", output, {"STL"}, replace, why);
  };
  std::string why, why_not;
  const auto destination = claim(force ? Replace::Judged : Replace::Never, why);
  if (!destination && claim(Replace::Judged, why_not)) why += "; --force overwrites it";
  if (!destination) return print_error(why), kUnusable;
  catch_interruption();  // the file is written to its end
  if (write_result(*destination, text, why)) return kFine;
  print_error(why);
  return kUnusable;
}

}  // namespace s7200::tools
