// A scenario: what is done to a slave and what is expected of it, as plain data. reader.hpp reads it from YAML,
// runner.hpp runs it, report.hpp says how it went, transcript.hpp writes down what was seen.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/diagnostic.hpp"
#include "interpreter/cpu/state.hpp"
#include "interpreter/program/operands/address.hpp"
#include "serial_sim/field/field_script.hpp"
#include "serial_sim/peers/quiet_time.hpp"
#include "serial_sim/peers/requester.hpp"
#include "tools/plan/system_plan.hpp"
#include "tools/scenario/action.hpp"
#include "tools/scenario/reading/text.hpp"

namespace s7200::tools {

struct Step {
  std::string_view key{};  ///< of the action; empty if it was not written
  stl::Position position{};
  std::string note{};                 ///< shown when it fails
  std::string loop{};                 ///< `function = 3, count = 126`: which turn of its loops
  std::string on{};                   ///< in a system: the PLC or line it is about, as it was written; empty if it was not
  std::optional<Spot> spot{};         ///< that; nothing if it is about none, or about a line of a system without an S7-200
  std::optional<std::size_t> line{};  ///< the line it is about in such a system
  std::shared_ptr<const StepAction> action{};
};

/// What makes a scenario a rule of a conformance suite.
struct Rule {
  enum class Severity : std::uint8_t { Must, Should };
  std::string id{};      ///< empty: it is none
  std::string source{};  ///< section of the specification
  Severity severity = Severity::Must;
};

struct Scenario {
  std::string name{};
  stl::Position position{};
  std::shared_ptr<const stl::SourceLines> source{};  ///< the file it is from

  std::vector<std::string> with{};           ///< paths of the other files of its project
  std::vector<stl::Symbol> symbols{};        ///< of those
  std::string repair{};                      ///< slips of its listing to be repaired: `R1,R2`, `all`
  std::string program{};                     ///< path; empty if only --target names one
  bool program_given = false;                ///< by --target
  bool may_be_missing = false;               ///< skip_without names it
  std::string system{};                      ///< instead of a program, the path of a system file
  std::shared_ptr<const SystemPlan> plan{};  ///< that was read from it
  std::string on{};                          ///< what its steps are about unless they say so themselves
  std::string cpu = "214";
  bool cpu_named = false;       ///< by the key `cpu`; otherwise it is the one that was found for the program
  std::string cpu_note{};       ///< what the user has to be told about the one that was found; empty: nothing
  std::string times{};          ///< a name or a file; empty: the CPU's own
  PlcSettings plc{};            ///< of the program's PLC
  std::uint8_t port = 0;        ///< of the program's CPU, that the line is at
  serial::FieldScript field{};  ///< its inputs
  Time after = kNever;          ///< when the first step begins; kNever: the first scan has ended and the line is quiet

  std::optional<std::uint8_t> station{};  ///< of the slave, if the file says so
  serial::MasterSettings line{};          ///< with the time-out
  Span pause{serial::kQuietMilliseconds * kMillisecond, 1000 * serial::kQuietCharacters};
  Time tolerance = 0;  ///< by which a latency given as one figure may be missed

  std::optional<double> robust{};  ///< percent of the tables of a band of execution times with which it must pass
  stl::Position robust_at{};

  Rule rule{};
  std::string expected_failure{};  ///< a known gap, and why; empty: it must pass
  std::string skipped{};           ///< the reason why it is not to be run; empty if it is
  std::vector<Step> steps{};

  std::size_t step_count() const {
    std::size_t count = 0;
    for (const Step& step : steps) count += step.action->steps();
    return count;
  }

  /// Whether it is about a system without an S7-200.
  bool is_of_peers() const { return plan && plan->plcs.empty(); }

  /// Where its addresses are looked up.
  AddressSpace addresses() const { return {*find_cpu(cpu), symbols}; }
};

}  // namespace s7200::tools
