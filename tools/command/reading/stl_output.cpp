#include "tools/command/reading/stl_output.hpp"

#include "interpreter/base/result.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/files/written_files.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {

int write_stl(const std::vector<StlFile>& outputs, const std::vector<std::string>& inputs, bool force) {
  const auto claim = [&](Replace replace) -> Result<std::vector<Destination>> {
    WrittenFiles files;
    for (const std::string& input : inputs) files.reads(input);
    std::vector<Destination> destinations;
    for (const StlFile& output : outputs) {
      auto destination = files.claim("-o", output.path, {"STL"}, replace);
      if (!destination) return destination.trouble();
      destinations.push_back(std::move(*destination));
    }
    return destinations;
  };
  const auto destinations = claim(force ? Replace::Judged : Replace::Never);
  if (!destinations)
    return print_error(destinations.why() + (claim(Replace::Judged) ? "; --force overwrites it" : "")), kUnusable;
  catch_interruption();  // the files are written to their end
  for (std::size_t i = 0; i < outputs.size(); ++i)
    if (const auto done = write_result((*destinations)[i], outputs[i].text); !done)
      return print_error(done.why()), kUnusable;
  return kFine;
}

}  // namespace s7200::tools
