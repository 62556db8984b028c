// What surrounds the PLC of a page: how it is powered up, and what its line is like; as the `options` of a message
// (docs/page_protocol.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/program/loading/slips.hpp"
#include "interpreter/program/program.hpp"
#include "serial_sim/faults/fault.hpp"
#include "serial_sim/field/field_script.hpp"
#include "tools/plan/plc_settings.hpp"
#include "tools/session/commands/reply.hpp"

namespace s7200::tools::page {

struct Surroundings {
  std::uint8_t port = 0;  ///< that is on the line with the master
  PlcSettings plc{};
  serial::FieldScript field{};
  std::vector<serial::Fault> faults{};
  std::optional<RetentiveMemory> kept{};  ///< with which it powers up
};

/// The options that say so, of a PLC that runs `program`. `repairs`: those of its listing.
Json options_of(const Program& program, const Surroundings& around, const Repairs& repairs = {});

// Reading them. Each brings trouble if an option is wrong or there is no such option.

/// The CPU that they name; of a message that names none, null.
Result<const CpuModel*> cpu_of_options(const Json& options);
Result<Repairs> repairs_of_options(const Json& options);
/// The table of execution times that they have; without one that of the CPU.
Result<TimeTable> times_of_options(const Json& options, const CpuModel& model);
Result<Surroundings> surroundings_of_options(const Json& options, const Program& program);

}  // namespace s7200::tools::page
