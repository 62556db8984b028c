// A position of a session as a file. A run is deterministic, so the file has no state in it but, if the session began with
// power coming back, the memory that was kept. It has digests of the program and of what the session began with, all that
// was done to the PLC from outside with its moments, and where the session stood. Who loads it replays that, and compares
// the digest of the state it comes to. Breakpoints and watches come with it; they count their hits anew.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// The format of every version, without its number.
inline constexpr std::string_view kAnySessionFormat = "s7200 session ";

/// How the file begins: it is known by this.
std::string session_beginning();

/// What a session depends on besides program and memory, by the name of the option: `--gap`, `2 ms`.
struct SessionOption {
  std::string name, value;

  bool operator==(const SessionOption&) const = default;
};

/// How a master talks, and the time of day at power-up.
std::vector<SessionOption> options_of(const serial::MasterSettings& master, const ClockTime& clock);

/// `--gap 2 ms (here none), --baud 19200 (here as the port)`: those that are not the same; nothing if all are.
std::string differences(const std::vector<SessionOption>& then, const std::vector<SessionOption>& now);

/// A session as it is to be written as a scenario.
struct SessionRecord {
  struct Station {
    std::vector<Assignment> memory;  ///< that is displayed, with its values
    bool stopped = false;
    std::uint16_t fatal_code = 0;
  };

  /// Memory that was printed or expected, at its time.
  struct LookedAt {
    std::size_t station = 0;
    Time at = 0;
    std::size_t actions = 0;  ///< done before it
    std::vector<Assignment> memory{};
  };

  Recording session;                                        ///< up to its `now`
  std::vector<std::vector<LookedAt>> looked_at{};           ///< by power-up, in their order
  std::vector<Station> stations;                            ///< all
  std::vector<std::optional<std::size_t>> host_stations{};  ///< by host port, one on its line; nothing if there is none
  std::optional<serial::Exchange> last{};                   ///< if it is over
};

struct SessionFile {
  /// A PLC: its model; digests of the program, of the state that the session began with, and of where it stood.
  struct Station {
    std::string name;  ///< empty: it is the only one
    std::string cpu, program, begin, state;
  };

  /// A breakpoint or a watch, in the words of its command.
  struct SavedStop {
    int number = 0;
    std::size_t station = 0;
    std::string on{};      ///< `int 123`, `event 8 served`; of a watch its address
    std::string access{};  ///< of a watch: `read`, `change`; empty: it is a breakpoint
    bool always = false;
    std::string condition{};
    std::uint64_t from_hit = 1;
    std::string log{};

    bool operator==(const SavedStop&) const = default;
  };

  std::vector<Station> stations;
  std::vector<SessionOption> options;
  Recording recording;
  std::vector<SavedStop> stops{};
};

std::string to_text(const SessionFile& file);

/// `models` and `names` are those of the PLCs here. Trouble if it is not such a file, damaged, of
/// another version of the file, or of other PLCs.
Result<SessionFile> session_from_text(std::string_view text, std::span<const CpuModel* const> models,
                                      std::span<const std::string> names);

}  // namespace s7200::tools
