// PLCs and lines as plain data: who there is, and who is on which line. system_reader.hpp reads it from YAML; a rig is built
// from it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/program/operands/address.hpp"
#include "interpreter/program/program.hpp"
#include "serial_sim/faults/fault.hpp"
#include "serial_sim/field/field_script.hpp"
#include "serial_sim/line/line_settings.hpp"
#include "serial_sim/peers/automaton.hpp"
#include "serial_sim/peers/poller.hpp"
#include "serial_sim/peers/requester.hpp"
#include "serial_sim/system/plc.hpp"
#include "tools/plan/bridge_kinds.hpp"
#include "tools/plan/plc_settings.hpp"

namespace s7200::tools {

struct PlcPlan {
  std::string name;  ///< empty: it is the only one, from the command line
  std::shared_ptr<const Program> program;
  PlcSettings settings{};
  serial::FieldScript field{};
  std::optional<RetentiveMemory> kept{};  ///< with which it powers up first; nothing: what its memory file says
  std::optional<std::uint8_t> address{};  ///< of its Modbus slave, if the file gives it one
};

/// A master that polls, or a simulated PLC of another make.
struct PeerPlan {
  /// An output of a PLC, to which the sync signal is wired.
  struct Output {
    std::size_t plc = 0;
    serial::OutputPoint point{};
  };

  std::string name;
  serial::PollPlan polls{};                              ///< of a master; without requests it is none
  std::shared_ptr<const serial::Automaton> automaton{};  ///< of another PLC; null: it is none
  std::optional<Output> sync{};                          ///< of another PLC: what drives its sync signal
};

/// A bridge, at which programs and devices of this computer join a line in real time.
struct BridgePlan {
  std::string name;
  BridgeKind kind{};
  std::string where;  ///< a link, [ADDRESS:]PORT, a device
};

/// A station on a line: a number in the list of its kind.
struct StationPlan {
  enum class Kind : std::uint8_t { Plc, Peer, Bridge };
  Kind kind{};
  std::size_t number = 0;
  std::uint8_t port = 0;  ///< of a PLC
};

/// A fault of a line, of anyone there or of one station.
struct FaultPlan {
  serial::Fault fault{};
  std::optional<std::size_t> station{};  ///< of the line's stations
};

/// Plans for faults that any station of a line may have.
std::vector<FaultPlan> of_anyone(const std::vector<serial::Fault>& faults);

/// Something that is done to the system at an instant.
struct EventPlan {
  enum class What : std::uint8_t { PowerOff, PowerOn, Cut, Mend, Set, Fault, ClearFaults };
  What what{};
  Time at = 0;
  StationPlan station{};          ///< PowerOff, PowerOn: a PLC or a peer
  std::size_t plc = 0;            ///< Set
  std::size_t line = 0;           ///< Cut, Mend, Fault, ClearFaults
  std::size_t near = 0;           ///< Cut: so many of the line's stations stay on this side
  std::vector<Assignment> set{};  ///< Set
  FaultPlan fault{};              ///< Fault
};

/// The subject of an event: a station, or a whole line.
struct EventSubject {
  std::optional<StationPlan> station{};  ///< a PLC or a peer
  std::size_t line = 0;                  ///< without a station
};
EventSubject subject_of(const EventPlan& event);

struct LinePlan {
  std::string name;
  serial::LineSettings settings{};  ///< of masters on it, as far as not as its first PLC sets its port
  std::vector<FaultPlan> faults{};
  std::optional<std::size_t> master{};         ///< the station that asks, for faults of requests and answers
  std::optional<std::uint64_t> contention{1};  ///< the seed of what drivers that disagree give; nothing: space wins
  std::vector<std::string> captures{};
  std::vector<StationPlan> stations{};  ///< in their order along the cable
};

struct SystemPlan {
  std::vector<PlcPlan> plcs;
  std::vector<PeerPlan> peers;
  std::vector<BridgePlan> bridges;
  std::vector<LinePlan> lines;
  std::vector<EventPlan> events;  ///< in the order of time
};

/// What a user says of the PLC that a PROGRAM is, and of the line at one of its ports.
struct ProgramSettings : PlcSettings {
  std::vector<serial::Fault> faults{};  ///< of the line, from power-up on
  std::uint32_t port = 0;               ///< of the PLC, that the line with everything on it is at
  std::vector<std::string> captures{};  ///< of the line: FILE.vcd, FILE.pcap
};

/// The plan of a PROGRAM: one PLC on a line of its own, both without a name. Its CPU has what the settings ask for.
SystemPlan plan_of(std::shared_ptr<const Program> program, const ProgramSettings& settings = {},
                   serial::FieldScript field = {});

/// The same with the file of inputs that the settings name. Nothing, with `problems`, if it cannot be read, or if the CPU
/// does not have the port.
std::optional<SystemPlan> read_plan_of(std::shared_ptr<const Program> program, const ProgramSettings& settings,
                                       const FileSource& files, std::vector<std::string>& problems);

/// The plan of a PLC of another make, alone on a line; neither has a name.
SystemPlan plan_of_other_plc(std::shared_ptr<const serial::Automaton> automaton,
                             const std::vector<serial::Fault>& faults = {}, std::vector<std::string> captures = {});

/// Whether it is the plan of a PROGRAM, where nothing has a name.
bool is_of_one_program(const SystemPlan& plan);

/// A place in a system, where one more station joins it: beside a PLC, on the line that one of its ports is on.
struct Spot {
  std::size_t line = 0;
  std::size_t plc = 0;
  std::uint8_t port = 0;
  bool operator==(const Spot&) const = default;
};

const std::string& name_of(const SystemPlan& plan, const StationPlan& station);

/// The settings of a master on a line: its own, and for the rest those of the line.
serial::MasterSettings on_line(serial::MasterSettings master, const LinePlan& line);

/// The line's first PLC along the cable; null if there is none.
const StationPlan* first_plc(const LinePlan& line);

/// The line's first PLC of another make along the cable; null if there is none.
const StationPlan* first_other_plc(const SystemPlan& plan, const LinePlan& line);

/// The format of a line without an S7-200: that of its first PLC of another make; the default format if there is none.
SerialFormat format_without_s7200(const SystemPlan& plan, const LinePlan& line);

/// The spot that `name` means: a line, at its first PLC; or a PLC, `gateway`, or one of its ports, `gateway.1`. An empty
/// name is the only line. Trouble if there is none.
Result<Spot> find_spot(const SystemPlan& plan, std::string_view name);

/// The line of that name; an empty name is the only line. Trouble if there is none.
Result<std::size_t> find_line(const SystemPlan& plan, std::string_view name);

/// The first place of each PLC on a line, by number. Each is on a line.
std::vector<Spot> spots_of_plcs(const SystemPlan& plan);

/// Why no master can join there: the line has as many stations as it takes. Empty if one can.
std::string why_no_room(const SystemPlan& plan, std::size_t line);

/// Why no master can ask a PLC of another make there: none is there, or no room. Empty if one can.
std::string why_no_other_plc(const SystemPlan& plan, std::size_t line);

/// The first line that a master can join.
std::optional<std::size_t> first_askable_line(const SystemPlan& plan);

/// Lets nothing be recorded, and no memory be read or kept.
void forget_files(SystemPlan& plan);

/// Lets the system run every scan of its PLCs: none is passed over.
void run_every_scan(SystemPlan& plan);

}  // namespace s7200::tools
