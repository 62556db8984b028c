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
  /// `where`: the PLC; empty in a run of one program.
  void add(const Profile& profile, const std::string& where);
  const std::vector<Profile>& programs() const { return programs_; }

 private:
  std::vector<Profile> programs_;
};

/// Time by routine, the networks and instructions that took most, the scans, the interrupts.
std::string profile_text(const Profile& profile);

nlohmann::ordered_json profile_json(const Profile& profile);

/// A line for each way from a routine through calls and network to an instruction, and the nanoseconds spent there:
/// `MAIN;SBR_51;network 7;120 CALL 52 3695`. Tools that draw flame graphs read it.
std::string profile_folded(const ProfileOfPrograms& profile);

}  // namespace s7200::tools
