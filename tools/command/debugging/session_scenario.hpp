// A session of the debugger as a scenario: it is run once as one, and what came is expected. Knows nothing of the debugger.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/result.hpp"
#include "serial_sim/peers/requester.hpp"
#include "tools/command/options/verb/debug_options.hpp"
#include "tools/session/commands/session_files.hpp"

namespace s7200::tools {

struct SessionSteps {
  struct PowerCycle {
    bool memory_lost = false;
    Time off = 0;
  };

  /// Memory is set or forced, a frame is sent, the mode changes, the line has a fault, or none any more; or power goes off
  /// and on, from where times count anew.
  struct Step {
    Time at = 0;
    std::vector<Assignment> set{}, force{};
    std::vector<Assignment> expect{};  ///< memory has these values
    std::vector<MemoryRange> unforce{};
    std::optional<Mode> mode{};
    std::optional<serial::Request> send{};
    std::string fault{};
    std::string fault_of{};            ///< the station that it is about; empty: anyone on the line
    std::optional<Time> sent_until{};  ///< it came over a bridge: the end of the frame
    std::optional<Time> timeout{};     ///< of what is sent, if not the scenario's
    std::optional<PowerCycle> power{};
    std::string event{};     ///< of a system: `power_off: pump`
    std::string on{};        ///< a PLC of a system
    std::size_t action = 0;  ///< its number among what was done since power-up

    bool does_something() const {
      return send || power || mode ||
             !(expect.empty() && set.empty() && force.empty() && unforce.empty() && fault.empty() && event.empty());
    }
  };

  /// How a PLC must be at the end.
  struct End {
    std::string on{};  ///< its name in a system
    std::vector<Assignment> memory{};
    bool stopped = false;
    std::uint16_t fatal_code = 0;
  };

  std::vector<Step> steps{};
  Time end = 0;
  std::vector<End> ends{};
  std::optional<serial::Exchange> last{};  ///< the last exchange of the simulated master, if it is over
  std::vector<std::string> left_out{};     ///< what no step can do, and why
};

/// Writes it: of a system file if the program of the options is one. What comes too late, because steps come one after the
/// other, is left out too. False, and why not, if it cannot be written, or if it would not run as the session did.
Result<> write_session_scenario(const DebuggeeOptions& options, const std::shared_ptr<const Program>& program,
                                SessionSteps& session, const FilePlace& to);

}  // namespace s7200::tools
