// Execution times as data with provenance: read from CSV, corrected by CSV, never compiled in.
#pragma once

#include <optional>
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
/// `mnemonic`: one or more, separated by blanks, all with the same time; or one of the names of SystemTime in brackets;
/// a trailing `(and A O)` adds the A and O forms of each LD form. `form`: areas of the first operand that the line is for,
/// or any words to say what the figure means. `marker`: manual, estimate or calibrated. `source` may be left out.
struct TimeRow {
  std::vector<std::string> mnemonics;
  std::string form;
  Areas areas = 0;    ///< 0: every operand
  Time base = 0;      ///< with power flow and direct operands
  Time per_unit = 0;  ///< for each `unit`: bit shifted, byte moved …
  std::string unit, marker, source;
};

struct Cost {
  Time base = 0;
  Time per_unit = 0;
};

/// What costs time without being an instruction; the names stand in the tables.
enum class SystemTime { NoPowerFlow, IndirectOperand, InterruptEntry, ScanOverhead, EepromSave };
std::string_view name_of(SystemTime what);

class TimeTable {
 public:
  /// Adds lines in front of those already there: a corrected file replaces figure by figure and leaves the others.
  /// Errors, each `name:line: what`: unreadable figures, times that are not above 0 (labels and routine heads may be 0),
  /// unknown markers, missing columns. Nothing is taken from a text with errors.
  std::vector<std::string> add(std::string_view csv, const std::string& name);

  /// Nothing when no line gives a time.
  std::optional<Cost> cost(std::string_view mnemonic, std::optional<Area> first_operand) const;
  const TimeRow* find(std::string_view mnemonic, std::optional<Area> first_operand) const;

  /// 0 when no line gives it.
  Time operator[](SystemTime what) const;

  const std::vector<TimeRow>& rows() const { return rows_; }

 private:
  std::vector<TimeRow> rows_;
};

/// The same table as CSV; reads back to itself.
std::string to_csv(const TimeTable& times);

/// `73` or `0.8`, in microseconds.
std::string in_microseconds(Time time);

}  // namespace s7200
