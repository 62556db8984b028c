// Where the simulated time of runs went, in words, as JSON, and as folded stacks.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/coverage/profile.hpp"

namespace s7200::tools {

/// The profiles of several runs. Programs with the same name, CPU and text are one.
class ProfileOfPrograms {
 public:
  void add(const Profile& profile, const ProfileOrigin& origin);
  void add(const ProfileOfPrograms& other, const ProfileOrigin& origin);
  const std::vector<Profile>& programs() const { return programs_; }

 private:
  std::vector<Profile> programs_;
};

/// Time by routine, the networks and instructions that took most, the scans, the interrupts.
std::string profile_text(const Profile& profile);

nlohmann::ordered_json profile_json(const Profile& profile);

/// The same of one run of several, without its networks and instructions.
nlohmann::ordered_json profile_summary_json(const Profile& profile);

/// One run of several.
struct ProfiledRun {
  std::string name{};
  const ProfileOfPrograms* profile = nullptr;
};

/// A line for each run and program: simulated time, scans, the longest of them, and the longest wait of an interrupt.
std::string profile_by_run_text(const std::vector<ProfiledRun>& runs);

/// A line for each way from a routine through calls and network to an instruction, and the nanoseconds spent there:
/// `MAIN;SBR_51;network 7;120 CALL 52 3695`. Tools that draw flame graphs read it.
std::string profile_folded(const ProfileOfPrograms& profile);

}  // namespace s7200::tools
