// The plant around the CPU, on the command line: memory and inputs before and during a run, faults of its line, what is
// recorded of it, what is kept and shown after it.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interpreter/base/result.hpp"
#include "tools/command/options/plc/fault_options.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/rig/files/recorded_rig.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

class RigOptions {
 public:
  void add_to(CLI::App& app);

  /// --at, of verbs that join a system at one place.
  void add_place_to(CLI::App& app);

  /// The same of verbs that look at all its PLCs, and at one of them first.
  void add_first_station_to(CLI::App& app);

  /// Loads what is to be run: the PROGRAM, or the system file that stands in its place. False after messages: `exit_code`
  /// says which way to end.
  bool load(const CLI::App& verb, const ProgramOptions& program, int& exit_code);

  /// The same for verbs that look at all PLCs of a system.
  bool load_all(const CLI::App& verb, const ProgramOptions& program, int& exit_code);

  /// The same for a verb that runs a system as a whole: no master joins it. `more`: further options that are about one PLC.
  bool load_whole(const CLI::App& verb, const ProgramOptions& program, std::span<const std::string_view> more,
                  int& exit_code);

  /// Takes a plan of PLCs of another make, whose only line a master joins.
  void take_line(SystemPlan plan) { plan_ = std::move(plan); }

  /// Takes a plan as what is to be run as a whole.
  void take_whole(SystemPlan plan) {
    plan_ = std::move(plan);
    joins_ = false;
  }

  /// Whether what load() has loaded is a system of PLCs of another make alone: a master joins the line, and no PROGRAM runs.
  bool without_s7200() const { return plan_.plcs.empty(); }

  /// Whether what was loaded is a system file.
  bool is_system() const { return !is_of_one_program(plan_); }

  /// What was loaded.
  const SystemPlan& plan() const { return plan_; }
  /// Of a system its file.
  const std::string& system_path() const { return path_; }

  /// The simulations of a rig of what load_all() has loaded, by PLC; and the one that is looked at first.
  std::vector<serial::Simulation*> stations(Rig& rig) const;
  std::size_t first_station() const { return spot_.plc; }

  /// Which one that is, of several lines without --at; otherwise empty.
  std::string note_on_first_station() const;
  std::size_t line() const { return spot_.line; }

  /// Where it is looked at from: of a PROGRAM its PLC at --port.
  Spot spot() const { return spot_; }

  /// A PLC of a system, as it is looked at.
  struct Station {
    std::string name;
    std::string place;  ///< with its port, as --at takes it: `gateway.1`
    serial::MasterSettings master{};
  };
  /// By PLC, with `master` as it is on each line; none of a PROGRAM.
  std::vector<Station> named_stations(const serial::MasterSettings& master) const;

  /// Takes a program as what is to be run. False after messages.
  bool take(std::shared_ptr<const Program> program);

  /// Reads and opens what the plan and the options name. Null after messages. `json`: standard output is taken; `link`: so
  /// is this name, by --pty.
  std::unique_ptr<RecordedRig> assemble(bool json, const std::string& link = {});

  /// A rig like that of assemble() for another program, from any thread. Null, with `problems` if it is not for a signal.
  std::unique_ptr<RecordedRig> assemble_another(std::shared_ptr<const Program> program,
                                                std::vector<std::string>& problems) const;

  /// How a master talks on the line of what was loaded: as `given`, and for the rest as a system file says.
  serial::MasterSettings on_line(const serial::MasterSettings& given) const {
    return tools::on_line(given, plan_.lines[spot_.line]);
  }

  /// Of what was loaded: what a master asks, in words; and the program of the PLC that is looked at.
  std::string target() const;
  const std::shared_ptr<const Program>& program() const { return plan_.plcs[spot_.plc].program; }

  /// Throws std::invalid_argument if an option asks for something that is written, or shown, of one run.
  void refuse_what_is_of_one_run(std::string_view because) const;

  const ProgramSettings& settings() const { return settings_; }

  /// How a verb ends that has got no rig: as after an interruption, if there was nothing else.
  int exit_code_without_rig() const;

  /// The files that are written while it runs, by their names; empty if there are none.
  std::string recorded_files() const;

  /// The faults alone, for a line without an S7-200. Nothing after messages.
  std::optional<std::vector<serial::Fault>> faults();

  /// Whether there are faults.
  bool faulted() const { return !faults_.empty(); }

  /// --strict: whether a run-time error ends it all.
  bool strict() const { return strict_; }

  /// With --strict, whether there was one.
  bool failed_strictly(const Cpu& cpu) const { return strict_ && cpu.state().error_count != 0; }

  /// What rig_json() says of a rig with one PLC, without a PLC.
  static nlohmann::ordered_json no_json();

 private:
  bool load_one(const CLI::App& verb, const ProgramOptions& program, int& exit_code);
  bool load_program(const ProgramOptions& program, int& exit_code);
  bool load_system(const CLI::App& verb, const ProgramOptions& program, std::span<const std::string_view> more,
                   int& exit_code);
  bool find_place(int& exit_code);
  RigSurroundings surroundings(const std::string& link, std::vector<Spot> spots) const;
  Result<Spot> place_in_system() const;
  bool read_settings(const Program& program);
  bool may_have_standard_output(bool json) const;

  PlcKeyOptions keys_;
  std::string at_;
  std::string path_;  ///< of a system file
  SystemPlan plan_;
  Spot spot_;
  std::vector<Spot> stations_;  ///< of a verb that is about all PLCs: where each is looked at from
  bool looks_at_all_ = false;
  bool joins_ = true;  ///< a master, the line at the spot
  bool strict_ = false;
  std::uint64_t record_limit_ = kRecordLimit;
  bool only_interrupted_ = false;  ///< while a record waited for its reader
  FaultOptions faults_;
  ProgramSettings settings_;
};

/// How large records may grow: an option of systems too.
inline constexpr std::string_view kRecordLimitOption = "--record-limit";

/// Whether an option of a rig makes sense for a line without an S7-200.
bool is_about_the_line(std::string_view option);

/// Completes the records and keeps the memory. False after messages.
bool finish(RecordedRig& rig);

}  // namespace s7200::tools
