// What is done to a simulation from outside, as plain data: so that it can be done again, at the same moment.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "interpreter/program/operands/address.hpp"
#include "serial_sim/faults/fault.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tools/plan/system_plan.hpp"
#include "tools/session/past/line_stations.hpp"

namespace s7200::tools {

/// Memory is written as a programming device would; I addresses are the input points.
struct SetMemory {
  std::vector<Assignment> assignments;
};

/// Whether only input points are switched, as the command `input` does it.
bool are_inputs(const SetMemory& set);

/// The master puts a frame on the line.
struct SendFrame {
  SerialFormat format{};
  serial::Request request;
};

/// The master gives its request up. What it was doing is said for those who write it down.
struct CancelRequest {
  std::size_t sent = 0;    ///< characters that have begun
  Time waited = 0;         ///< since the end of the request; 0 before
  Time sent_until = 0;     ///< end of the last of these characters, if that is yet to come
  bool answering = false;  ///< an answer has begun
};

/// Points and memory that hold a value until they are released.
struct Force {
  std::vector<Assignment> assignments;  ///< each is forcing::possible()
};
struct Unforce {
  std::vector<MemoryRange> places;
};

/// The next instruction is another one, of the same routine. No programming device can do that.
struct Jump {
  std::uint32_t to = 0;
};

/// A fault of the line from now on, or none any more.
struct InjectFault {
  std::optional<serial::Fault> fault{};
  std::string of{};  ///< the station of the line that it is about; empty: of anyone there
};

/// The logic stack of the routine that runs is another one. No programming device can do that either.
struct SetStack {
  LogicStack stack{};
};

/// A programming device asks for RUN or STOP.
struct SetMode {
  Mode mode{};
};

/// One PLC loses power, or has it again, as it happens to a station of a system.
struct SetPower {
  bool on = false;
};

/// A step of a scenario does to a system what could stand in its file: power, cables, faults.
struct SystemEvent {
  EventPlan event{};
  std::string words{};  ///< `slave2: power off`
};

using Action = std::variant<SetMemory, SendFrame, CancelRequest, Jump, serial::HostCall, Force, Unforce, SetStack,
                            InjectFault, SetMode, SetPower, SystemEvent>;

/// `host`: the port that a HostCall is made to. `of`: the station that a fault is about. A SystemEvent is done by the rig.
void perform(const Action& action, serial::Simulation& simulation, serial::HostPort* host = nullptr,
             const LineStation* of = nullptr);

/// `set VW100`, `input I0.3`, `send 01 03 …`: what it was, in a few words.
std::string describe(const Action& action);

}  // namespace s7200::tools
