// Execution times as data with their origin: read from CSV and corrected by CSV, never fixed in code.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interpreter/base/time.hpp"
#include "interpreter/model/area.hpp"

namespace s7200 {

/// One line of a table of times.
///
///   mnemonic,form,base_us,per_unit_us,unit,marker,source,uncertainty_percent
///   = ,I Q,0.8,,,estimate,…,330
///
/// `mnemonic`: one or more, separated by blanks, all with the same time; or a name of a SystemTime, which is in brackets.
/// `form`: the areas of the first operand for which the line holds, or words that say what the figure means. `marker`:
/// manual, measured (on a real CPU), calibrated, remembered (from the manual, but not read there again), or estimate.
/// `uncertainty_percent`: with 25, the true figures lie between those of the line / 1.25 and × 1.25; left out, as `source`
/// may be, the marker says how sure they are. `base_within_us`, `per_unit_within_us`: in place of a percentage, how far the
/// true figures are from these at most. A line `(sum)` is of what is known only together, by names in its form: `CALL +
/// RET`. Lines that begin with # are comments; `# CPU 224` says whose times these are.
struct TimeRow {
  std::vector<std::string> mnemonics;
  std::string form;
  Areas areas = 0;    ///< 0: any operand
  Time base = 0;      ///< with power flow and direct operands
  Time per_unit = 0;  ///< for each `unit`: bit shifted, byte moved …
  std::string unit, marker, source;
  double uncertainty = 0;  ///< percent
  Time base_within = 0, per_unit_within = 0;

  bool operator==(const TimeRow&) const = default;
};

/// The range in which a true figure lies, in ns.
struct TimeRange {
  double least = 0, most = 0;

  bool operator==(const TimeRange&) const = default;
};
TimeRange range_of_base(const TimeRow& row);
TimeRange range_of_unit(const TimeRow& row);

/// The name of a line for a sum.
inline constexpr std::string_view kSum = "(sum)";

/// The name of a sum, `CALL + RET`, and the names in it.
std::string form_of_sum(const std::vector<std::string>& parts);
std::vector<std::string> parts_of_sum(std::string_view form);

struct Cost {
  Time base = 0;
  Time per_unit = 0;
};

/// Times that are not those of an instruction, by their names in the tables. OperandArea: the time that an operand in the
/// areas of the line adds, unless it is the first one and the instruction has a line for its area.
enum class SystemTime { NoPowerFlow, IndirectOperand, OperandArea, InterruptEntry, ScanOverhead, EepromSave };
inline constexpr std::array kSystemTimes{SystemTime::NoPowerFlow,    SystemTime::IndirectOperand, SystemTime::OperandArea,
                                         SystemTime::InterruptEntry, SystemTime::ScanOverhead,    SystemTime::EepromSave};
std::string_view name_of(SystemTime what);

class TimeTable {
 public:
  TimeTable() = default;
  explicit TimeTable(std::vector<TimeRow> rows) : rows_(std::move(rows)) {}

  /// Adds lines before those already there: a corrected file replaces the figures it has and leaves the others.
  /// Returns errors, each `name:line: what`: unreadable figures, times that are not above 0 (labels and routine heads may be
  /// 0), unknown markers, missing columns, quotes that are not closed. A text with errors changes nothing.
  std::vector<std::string> add(std::string_view csv, const std::string& name);

  /// Adds the lines of another table before those already there.
  void add(const TimeTable& correction);

  /// The time of an instruction; nothing if no line has it.
  std::optional<Cost> cost(std::string_view mnemonic, std::optional<Area> first_operand) const;
  const TimeRow* find(std::string_view mnemonic, std::optional<Area> first_operand) const;

  /// The time of `what`; 0 if no line has it.
  Time operator[](SystemTime what) const;

  /// The time that operands in these areas add to the basic time, in the order of the operands.
  Time added_by(std::string_view mnemonic, std::span<const std::optional<Area>> operands) const;

  const std::vector<TimeRow>& rows() const { return rows_; }

  /// A table of the lines for which `wanted` holds.
  template <class Wanted>
  TimeTable filtered(Wanted wanted) const {
    TimeTable kept;
    for (const TimeRow& row : rows_)
      if (wanted(row)) kept.rows_.push_back(row);
    return kept;
  }

  /// The table with other figures in its lines: `change` gets each line.
  template <class Change>
  TimeTable with(Change change) const {
    TimeTable changed = *this;
    for (TimeRow& row : changed.rows_) change(row);
    return changed;
  }

 private:
  std::vector<TimeRow> rows_;
};

/// The table as CSV; reads back as the same table.
std::string to_csv(const TimeTable& times);

/// A time in microseconds: `73` or `0.8`.
std::string in_microseconds(Time time);

}  // namespace s7200
