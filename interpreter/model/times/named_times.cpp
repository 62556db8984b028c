// Where the tables are from: model/README.md.
// Not documented, modelled so:
// - cpu214_from_22x: a CPU 214 is to a CPU 22x of release 1 as one factor. It is fitted so that the first scan of
//   Application Tip 41 takes the 690 ms that its text states; all else in the tip is a check. What was only estimated for
//   the CPU 22x, the overhead of a scan and the EEPROM stay as in cpu214.
//   [NamedTimes.TheTableFromTheCpu22xIsItsFiguresTimesOneFactor]
// - S and R of one bit take what the tables have for any number, base and one bit: the manual has figures of their own for
//   a constant N = 1, of which a page of 2002 gives those of R (C 17, T 24, any other 5 µs), and the tables have no line
//   for a number. [NamedTimes.SAndROfOneBitTakeTheFiguresForAnyNumber]
#include "interpreter/model/times/named_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "interpreter/base/text/joined.hpp"
#include "interpreter/model/times/embedded_times.hpp"

namespace s7200 {
namespace {

/// The factor between a CPU 214 and a CPU 22x of release 1.
constexpr double kSlower = 1.906;

void add(TimeTable& table, std::string_view csv) {
  [[maybe_unused]] const auto errors = table.add(csv, "times");
  assert(errors.empty());
}

/// The times with which a CPU runs by default.
TimeTable own_times(const CpuModel& model) {
  TimeTable table;
  for (const std::string_view csv : model.times_csv)
    if (!csv.empty()) add(table, csv);
  return table;
}

/// The least uncertainty in percent: after the factor no figure is more certain, even one from a manual's page.
constexpr double kSureAtMost = 25;

/// Whether a figure of a CPU 22x is not an estimate; one that is taken over, `as RETI`, is as good as that figure.
bool is_of_22x(const TimeRow& row, const TimeTable& table) {
  constexpr std::string_view kAs = "as ";
  if (row.mnemonics.front() == name_of(SystemTime::EepromSave)) return false;
  const TimeRow* from = row.source.starts_with(kAs) ? table.find(row.source.substr(kAs.size()), {}) : &row;
  return from && from->marker != "estimate";
}

TimeTable cpu214_times() { return own_times(cpu214()); }
TimeTable cpu215_times() { return own_times(cpu215()); }
TimeTable cpu22x_release1_times() { return own_times(*find_cpu("224r1")); }
TimeTable cpu22x_times() { return own_times(cpu224()); }

TimeTable cpu214_from_22x_times() {
  const auto slower = [](Time time) { return static_cast<Time>(std::llround(static_cast<double>(time) * kSlower)); };
  const auto scale = [&](TimeRow& row) {
    row.base = slower(row.base);
    row.per_unit = slower(row.per_unit);
    row.source = fmt::format("{:g} × CPU 22x of release 1, {} = 690 ms; {}", kSlower, kFirstScanOfTip41, row.source);
    row.marker = "remembered";
    row.uncertainty = std::max(row.uncertainty, kSureAtMost);
  };
  const TimeTable of_22x = cpu22x_release1_times();
  return of_22x.filtered([&](const TimeRow& row) { return is_of_22x(row, of_22x); }).with(scale);
}

template <auto read>
const TimeTable& read_once() {
  static const TimeTable kTable = read();
  return kTable;
}

}  // namespace

const std::vector<NamedTimes>& named_times() {
  static const std::vector<NamedTimes> kTables{
      {"cpu214", "estimates, one of them calibrated against the first scan of Application Tip 41", kCpu212 | kCpu214, true,
       read_once<cpu214_times>},
      {"cpu215", "those of cpu214, and estimates of what the CPU 214 lacks", kCpu215 | kCpu216, true,
       read_once<cpu215_times>},
      {"cpu214_from_22x", "the figures of cpu22x_release1 that are not estimates, times one factor, over the CPU's own",
       kCpu21x, false, read_once<cpu214_from_22x_times>},
      {"cpu22x_release1", "an edition of 2002: some pages, mostly from memory", kCpu22xRelease1, true,
       read_once<cpu22x_release1_times>},
      {"cpu22x", "an edition of 2004: some pages, mostly from memory", kCpu22xRelease2, true, read_once<cpu22x_times>}};
  return kTables;
}

const NamedTimes* find_times(std::string_view name) {
  const auto found = std::ranges::find(named_times(), name, &NamedTimes::name);
  return found == named_times().end() ? nullptr : &*found;
}

std::vector<const NamedTimes*> times_of(const CpuModel& model) {
  std::vector<const NamedTimes*> tables;
  for (const bool own : {true, false})
    for (const NamedTimes& times : named_times())
      if (times.own == own && (times.cpus & model.self)) tables.push_back(&times);
  return tables;
}

std::string names_of_times(const CpuModel& model) { return stl::joined(times_of(model), &NamedTimes::name); }

}  // namespace s7200
