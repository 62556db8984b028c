#include "tools/command/options/verb/profile_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tools/command/options/wanted_file.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/testing/test_output.hpp"

namespace s7200::tools {

void ProfileOptions::add_to(CLI::App& app, const char* group) {
  CLI::Option* const options[] = {
      app.add_flag("--profile", shown_, "show where simulated time went: routines, networks, lines, scans, interrupts"),
      app.add_option("--profile-folded", folded_, "write the same as folded stacks, for flame graphs")->type_name("FILE")};
  for (CLI::Option* const option : options)
    if (group) option->group(group);
}

void ProfileOptions::claim(WrittenFiles& files) {
  if (folded_ == "-") throw std::invalid_argument("--profile-folded writes a file; '-' is none");
  folded_to_ = claim_wanted(files, "--profile-folded", folded_, {"folded stacks of --profile-folded", "system "});
}

void ProfileOptions::add_to(nlohmann::ordered_json& results, const ProfileOfPrograms& profile) const {
  if (!wanted()) return;
  results["profile"] = nlohmann::ordered_json::array();
  for (const Profile& each : profile.programs()) results["profile"].push_back(profile_json(each));
}

bool ProfileOptions::show(const ProfileOfPrograms& profile, bool json, const std::vector<ProfiledRun>& runs) const {
  if (shown_ && !json)
    for (const Profile& each : profile.programs()) fmt::print("\n{}", profile_text(each));
  if (shown_ && !json && !runs.empty()) fmt::print("\n{}", profile_by_run_text(runs));
  return !folded_to_ || write_wanted(folded_to_, profile_folded(profile));
}

}  // namespace s7200::tools
