// Where simulated time went: the options of `s7200 run` and `s7200 test`, and what they print and write.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/coverage/profile_report.hpp"
#include "tools/host/files/written_files.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

class ProfileOptions {
 public:
  /// Into a group of the help; null: that of options without one.
  void add_to(CLI::App& app, const char* group = nullptr);

  bool wanted() const { return shown_ || !folded_.empty(); }

  /// Throws std::invalid_argument if one cannot write to the file.
  void claim(WrittenFiles& files);

  /// Adds the profile to the results of --json.
  void add_to(nlohmann::ordered_json& results, const ProfileOfPrograms& profile) const;

  /// Prints the profile, but with --json, with a line for each of several runs, and writes the file. Returns false after a
  /// message if it cannot be written.
  bool show(const ProfileOfPrograms& profile, bool json, const std::vector<ProfiledRun>& runs = {}) const;

 private:
  bool shown_ = false;
  std::string folded_;
  std::optional<Destination> folded_to_;
};

}  // namespace s7200::tools
