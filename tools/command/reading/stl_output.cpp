#include "tools/command/reading/stl_output.hpp"

#include "tools/command/exit_code.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/files/written_files.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {

int write_stl(const std::vector<StlFile>& outputs, const std::vector<std::string>& inputs, bool force) {
  const auto claim = [&](Replace replace, std::string& why) {
    WrittenFiles files;
    for (const std::string& input : inputs) files.reads(input);
    std::vector<Destination> destinations;
    for (const StlFile& output : outputs) {
      auto destination = files.claim("-o", output.path, {"STL"}, replace, why);
      if (!destination) break;
      destinations.push_back(std::move(*destination));
    }
    return destinations;
  };
  std::string why, why_not;
  const auto destinations = claim(force ? Replace::Judged : Replace::Never, why);
  if (destinations.size() < outputs.size()) {
    if (claim(Replace::Judged, why_not).size() == outputs.size()) why += "; --force overwrites it";
    return print_error(why), kUnusable;
  }
  catch_interruption();  // the files are written to their end
  for (std::size_t i = 0; i < outputs.size(); ++i)
    if (!write_result(destinations[i], outputs[i].text, why)) return print_error(why), kUnusable;
  return kFine;
}

}  // namespace s7200::tools
