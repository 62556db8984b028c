// What verbs that try programs by chance have in common: the scenarios that they write.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/command/options/plc/program_options.hpp"
#include "tools/host/files/written_files.hpp"
#include "tools/trials/trial_scenario.hpp"

namespace s7200::tools {

/// A scenario that is written. Each returns false after a message.
class TrialFile {
 public:
  /// Nothing is done for an empty path. Files that the same verb wrote are replaced. `inputs`: what it reads.
  bool claim(const std::string& option, const std::string& path, const std::string& verb,
             const std::vector<std::string>& inputs);
  bool write(const std::string& scenario) const;

 private:
  std::optional<Destination> destination_;
};

/// What a scenario of the file `path` says of its program. Paths are relative to the folder of that file.
ScenarioOrigin scenario_origin(const std::string& path, const std::string& program, const std::vector<std::string>& parts,
                               const CpuOptions& options);

}  // namespace s7200::tools
