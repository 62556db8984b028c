// What scenarios are run on.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "interpreter/program/load.hpp"
#include "tools/scenario/reporting/messages.hpp"
#include "tools/scenario/runner.hpp"
#include "tools/scenario/suite_settings.hpp"

namespace s7200::tools {

/// Each program is read once, and checked once for each CPU and table of times.
class Programs {
 public:
  struct Loaded {
    std::shared_ptr<const Program> program{};
    TimeTable times{};    ///< that it has
    Messages messages{};  ///< why there is none; of one that there is, what is worth knowing of how it was read

    /// The first of what is wrong, in a few lines.
    std::string why() const;
  };

  /// `with`: the other files of the program's project.
  const Loaded& get(const std::string& path, const std::vector<std::string>& with, const std::string& cpu,
                    const std::string& times_table, const std::string& repairs = {});

  /// The same program, which has no errors, with a band of times.
  std::shared_ptr<const ProgramBand> band(const std::string& path, const std::vector<std::string>& with,
                                          const std::string& cpu, const std::string& times_table, const std::string& repairs,
                                          const SystemBlock& block, const BandSettings& settings);

 private:
  struct Text {
    std::optional<SourceText> text{};
    std::string why{};
  };

  using Key = std::tuple<std::vector<std::string>, std::string, std::string, std::string>;

  const Text& text_of(const std::string& path);
  std::optional<stl::ParseResult> read(const std::vector<std::string>& files, const std::string& repairs,
                                       Messages& messages);
  Loaded load(const std::vector<std::string>& files, const std::string& cpu, const std::string& times_table,
              const std::string& repairs);

  std::map<std::string, Text> texts_;
  std::map<Key, Loaded> known_;
  std::map<std::pair<Key, SystemBlock>, std::shared_ptr<const ProgramBand>> bands_;
};

/// A bench for each scenario.
struct Benches {
  std::vector<Bench> of{};
  std::unique_ptr<Slave> slave{};  ///< that all of them share, if the target is outside simulation
  bool of_programs = true;         ///< the target is one, or there is none
  std::string name{};              ///< of what is tested; of programs that scenarios name, the first one's
};

/// `target` is what all scenarios are run on; if it is empty, each is run on the program it names, and one whose program
/// cannot be had gets a bench that says why. Nothing, with messages, if the target cannot be had, or if no scenario names a
/// program. Throws as parse_slave_target() and connect() do, and std::invalid_argument for a PLC of another make that there
/// is not.
std::optional<Benches> make_benches(const std::vector<Scenario>& scenarios, const std::string& target,
                                    const SuiteSettings& settings, Programs& programs, Messages& messages);

}  // namespace s7200::tools
