// What surrounds one PLC: what it begins with, what drives its inputs, what is recorded of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/file_source.hpp"
#include "interpreter/cpu/state.hpp"
#include "interpreter/program/loading/system_block.hpp"
#include "interpreter/program/operands/address.hpp"
#include "interpreter/trace/signals.hpp"
#include "interpreter/trace/text/text_trace.hpp"
#include "serial_sim/field/field_script.hpp"

namespace s7200::tools {

/// The source of a PLC's retentive memory.
struct MemorySettings {
  std::string path{};     ///< empty: none is kept
  bool ram_lost = false;  ///< power was off too long: only the EEPROM is left
  Time power_off = 0;     ///< how long power was off since the file was written
};

/// The files of a PLC by their names, "" for none.
struct PlcSettings {
  SystemBlock system_block{};
  std::vector<Assignment> set{};     ///< memory and input points, before the first scan
  std::string input{};               ///< inputs over time, as CSV
  std::optional<ClockTime> clock{};  ///< time of day at power-up
  std::int32_t clock_error = 0;      ///< of its crystal, in millionths; positive: it is too fast
  Time starts = 0;                   ///< when it is powered up
  MemorySettings memory{};           ///< read at power-up, written at the end
  std::string trace{};
  TraceDetail trace_detail = TraceDetail::Way;
  std::vector<Signal> signals{};     ///< in a trace of them
  std::string output{};              ///< changes of outputs, as CSV; to FILE.vcd as a Value Change Dump
  std::vector<MemoryRange> dumps{};  ///< shown at the end
  std::vector<std::string> dump_names{};
};

/// Reads a script of inputs; nothing, with `problems` set, if the file is not such a script. An empty path is an empty
/// script.
std::optional<serial::FieldScript> read_field(const std::string& path, const AddressSpace& space, const FileSource& files,
                                              std::vector<std::string>& problems);

}  // namespace s7200::tools
