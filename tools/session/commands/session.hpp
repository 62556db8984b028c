// A session: a simulation with its past, what is looked at, and where it stops. Commands change it (command_table.hpp), and
// a face shows it. It has no terminal, no files and no threads.
//
// Every moment of the past can be reached again (history.hpp), and a command that ran something can be taken back. Of the
// stations of a system it looks at one, with which steps and addresses are concerned; all of them run.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/base/stop_token.hpp"
#include "interpreter/base/text/wrapped.hpp"
#include "serial_sim/peers/requester.hpp"
#include "tools/session/commands/answers/live_trace.hpp"
#include "tools/session/commands/onlooker.hpp"
#include "tools/session/commands/session_file.hpp"
#include "tools/session/commands/session_files.hpp"
#include "tools/session/past/history.hpp"
#include "tools/session/stops/stepper.hpp"
#include "tools/views/program/listing.hpp"

namespace s7200::tools {

/// A PLC of a system.
struct DebuggedStation {
  std::string name;
  serial::MasterSettings master{};  ///< how `send` talks on its line
};

/// How a session is begun.
struct SessionSetup {
  serial::MasterSettings master{};          ///< how `send` talks
  std::vector<DebuggedStation> stations{};  ///< of a system, which says itself how; none: one PLC without a name
  std::size_t station = 0;                  ///< that it looks at first
  std::uint8_t slave = 1;                   ///< that requests by address go to if they name none
  StopToken stop_request{};                 ///< ends a run when it becomes true; may be set by a signal handler
  /// Why a run has ended by itself, such as a bridge that has failed: said once, empty otherwise. The next one goes on.
  std::function<std::string()> take_failure = [] { return std::string(); };
  /// What is said of what a stop request has ended.
  std::function<std::string()> interruption = [] { return std::string("interrupted"); };
  std::size_t bound = History::Settings{}.bound;  ///< bytes for checkpoints of the history
  std::string records{};                          ///< that traces and captures write: "the trace"; "" for none
  bool colour = false;                            ///< timelines have colours
  std::size_t width = stl::kUsualWidth;           ///< of the lines of a timeline
  const SessionFiles* files = nullptr;            ///< null: commands read and write none, for this reason:
  std::string why_no_files = "files are neither read nor written here";
  std::vector<SessionOption> options{};  ///< that a saved session needs again, besides the master's

  /// Writes a session as a scenario. Returns what was left out, and why that cannot be recorded; trouble if
  /// nothing of it can.
  std::function<Result<std::vector<std::string>>(const SessionRecord& record, const FilePlace& to)> write_scenario{};
};

/// What is said, piece by piece.
struct Said {
  std::string text{};
  Said& operator<<(std::string_view more) {
    text += more;
    return *this;
  }
  Said& operator<<(char more) {
    text += more;
    return *this;
  }
};

class Session {
 public:
  static constexpr std::size_t kKeptStates = 64;

  /// Of one PLC.
  struct Station {
    serial::Simulation* simulation;
    Listing listing;
    std::optional<std::uint32_t> last_op{};  ///< executed last
  };

  /// Where `back` leads to.
  struct Kept {
    std::string command;
    History::Place place;
    std::size_t station = 0;  ///< that it looked at
  };

  /// Memory of a station that is printed after each stop.
  struct Displayed {
    std::size_t station = 0;
    MemoryRange range{};
  };

  /// Memory that was printed or expected, since power came back or the session began.
  struct LookedAt {
    std::shared_ptr<const PowerCycle> power{};
    std::size_t station = 0;
    Moment moment;
    MemoryRange range{};
    std::vector<std::uint8_t> bytes{};
  };

  /// An expectation that did not hold.
  struct FailedExpectation {
    std::size_t station = 0;
    Moment moment;
    std::vector<MemoryRange> memory{};
  };

  /// A run-time error of a station.
  struct StationError {
    std::size_t station = 0;
    TraceRecord record{};
  };

  /// Which executed instructions a run shows.
  enum class Show : std::uint8_t { None, Started, All };

  /// The history and the onlooker must live as long as this.
  Session(History& history, SessionSetup setup, Onlooker& onlooker);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  bool is_system() const { return !setup.stations.empty(); }
  std::size_t focus() const { return stepper.looks_at(); }
  serial::Simulation& simulation() const { return *stations[focus()].simulation; }
  const Cpu& cpu() const { return simulation().cpu(); }
  const Program& program() const { return cpu().program(); }
  const Listing& listing() const { return stations[focus()].listing; }
  const serial::MasterSettings& master(std::size_t station) const {
    return is_system() ? setup.stations[station].master : setup.master;
  }
  std::string name_of(std::size_t station) const;  ///< `slave`, or `the PLC`
  std::string said_of(std::size_t station) const;  ///< `slave: `; nothing if there is but one PLC
  std::size_t name_width() const;                  ///< of the longest, of all on the lines
  std::optional<std::uint32_t> current_op() const;
  bool stop_requested() const { return setup.stop_request.stop_requested(); }

  /// Goes over to another station, and says so.
  void look_at(std::size_t station);

  /// What ran before says nothing of what comes: it stands elsewhere now.
  void note_going_elsewhere();

  /// Lines for whoever looks on, at once, after all that was said.
  void tell(std::string_view lines);
  std::string take_said() { return std::exchange(said.text, {}); }

  std::string red(std::string text) const { return onlooker.emphasized(std::move(text), Emphasis::Trouble); }
  std::string bold(std::string text) const { return onlooker.emphasized(std::move(text), Emphasis::Place); }

  History& history;
  SessionSetup setup;
  Onlooker& onlooker;
  Stepper stepper;
  std::deque<Station> stations{};
  Said said{};              ///< by the command under way
  LiveTrace trace;          ///< `trace on`
  std::string command{};    ///< under way, as written
  std::deque<Kept> kept{};  ///< newest last
  std::vector<Displayed> displayed{};
  std::vector<LookedAt> looked_at{};  ///< on whatever branch
  std::map<std::shared_ptr<const PowerCycle>, std::vector<SessionRecord::LookedAt>> looked_at_before{};  ///< power went off
  FailedExpectation failed{};                                                                            ///< the last one
  bool expectation_failed = false;  ///< by the last command
  bool quit_asked = false;
  int next_number = 1;  ///< of a breakpoint or watch

  // Of the run under way.
  std::optional<StationError> first_error{};
  Show show = Show::None;
  std::size_t unasked = 0;  ///< transmissions

 private:
  void print_instruction(std::size_t station, const InstructionRecord& record, bool started_at);
};

}  // namespace s7200::tools
