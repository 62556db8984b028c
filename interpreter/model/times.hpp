// Execution times as data with their origin: read from CSV and corrected by CSV, never fixed in code.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/time.hpp"
#include "interpreter/model/area.hpp"

namespace s7200 {

/// One line of a table of times.
///
///   mnemonic,form,base_us,per_unit_us,unit,marker,source
///   = ,I Q,0.8,,,estimate,…
///
/// `mnemonic`: one or more, separated by blanks, all with the same time; or a name of a SystemTime, which is in brackets.
/// A trailing `(and A O)` adds the A and O forms of each LD form. `form`: the areas of the first operand for which the line
/// holds, or any words that say what the figure means. `marker`: manual, estimate, calibrated, or remembered
/// (from the manual, but not read there again). `source` may be left out.
struct TimeRow {
  std::vector<std::string> mnemonics;
  std::string form;
  Areas areas = 0;    ///< 0: any operand
  Time base = 0;      ///< with power flow and direct operands
  Time per_unit = 0;  ///< for each `unit`: bit shifted, byte moved …
  std::string unit, marker, source;
};

struct Cost {
  Time base = 0;
  Time per_unit = 0;
};

/// What takes time without being an instruction; the tables use these names. OperandArea: what an operand in the areas of
/// the line adds, unless it is the first one and the instruction has a line for its area.
enum class SystemTime { NoPowerFlow, IndirectOperand, OperandArea, InterruptEntry, ScanOverhead, EepromSave };
std::string_view name_of(SystemTime what);

class TimeTable {
 public:
  /// Adds lines before those already there: a corrected file replaces the figures it has and leaves the others.
  /// Returns errors, each `name:line: what`: unreadable figures, times that are not above 0 (labels and routine heads may be
  /// 0), unknown markers, missing columns. A text with errors changes nothing.
  std::vector<std::string> add(std::string_view csv, const std::string& name);

  /// Nothing if no line gives a time.
  std::optional<Cost> cost(std::string_view mnemonic, std::optional<Area> first_operand) const;
  const TimeRow* find(std::string_view mnemonic, std::optional<Area> first_operand) const;

  /// 0 if no line gives it.
  Time operator[](SystemTime what) const;

  /// What operands in these areas add to the basic time, in the order of the operands.
  Time added_by(std::string_view mnemonic, std::span<const std::optional<Area>> operands) const;

  const std::vector<TimeRow>& rows() const { return rows_; }

 private:
  std::vector<TimeRow> rows_;
};

/// The table as CSV; reads back as the same table.
std::string to_csv(const TimeTable& times);

/// `73` or `0.8`, in microseconds.
std::string in_microseconds(Time time);

}  // namespace s7200
