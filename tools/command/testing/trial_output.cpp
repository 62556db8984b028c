#include "tools/command/testing/trial_output.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "interpreter/base/file_path.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"

namespace s7200::tools {

bool TrialFile::claim(const std::string& option, const std::string& path, const std::string& verb,
                      const std::vector<std::string>& inputs) {
  if (path.empty()) return true;
  WrittenFiles files;
  for (const std::string& input : inputs) files.reads(input);
  auto claimed = files.claim(option, path, {"a scenario", fmt::format("# Found by s7200 {}", verb)}, Replace::Own);
  if (!claimed) print_error(claimed.why());
  destination_ = std::move(claimed).if_any();
  return destination_.has_value();
}

bool TrialFile::write(const std::string& scenario) const {
  if (const auto done = write_result(*destination_, destination_->kind.beginning + ".\n" + scenario); !done)
    return print_error(done.why()), false;
  print_note(fmt::format("{}: a scenario", destination_->path));
  return true;
}

ScenarioOrigin scenario_origin(const std::string& path, const std::string& program, const std::vector<std::string>& parts,
                               const CpuOptions& options) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::absolute(file_path(path)).parent_path();
  const auto near = [&](const std::string& file) {
    return fs::absolute(file_path(file)).lexically_relative(folder).string();
  };
  ScenarioOrigin origin{.program = near(program)};
  for (const std::string& part : parts) origin.with.push_back(near(part));
  const Repairs& repairs = options.repairs;
  if (repairs.all || !repairs.ids.empty())
    origin.head += fmt::format("repair: {}\n", repairs.all ? "all" : fmt::format("{}", fmt::join(repairs.ids, ",")));
  if (!options.times_table.empty()) origin.head += fmt::format("times: {}\n", in_quotes(options.times_table));
  return origin;
}

}  // namespace s7200::tools
