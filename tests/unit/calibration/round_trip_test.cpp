// CPUs with times that we know are measured: each figure of the table that comes of it is within its bounds.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>

#include "interpreter/model/instruction.hpp"
#include "interpreter/model/times/times_band.hpp"
#include "interpreter/model/times/times_file.hpp"
#include "interpreter/program/loading/load_times.hpp"
#include "tools/calibration/fit.hpp"
#include "tools/calibration/measure_protocol.hpp"
#include "tools/host/files/files.hpp"

namespace s7200::tools::round_trip_test {
namespace {

double base_of(const TimeTable& times, std::string_view name, std::optional<Area> area = {}) {
  const TimeRow* row = times.find(name, area);
  return row ? static_cast<double>(row->base) : 0;
}

std::optional<Area> first_area(Areas areas) {
  for (const AreaInfo& area : all_areas())
    if (contains(areas, area.area)) return area.area;
  return {};
}

double true_figure(const Form& form, const TimeTable& truth) {
  const auto cost = truth.cost(form.mnemonic, first_area(form.row->areas));
  if (!cost) return 0;
  return static_cast<double>(form.per_unit ? cost->per_unit : cost->base);
}

double duration(const Repetition& repetition, const std::vector<Form>& forms, const TimeTable& truth) {
  double ns = 0;
  for (std::size_t i = 0; i < forms.size(); ++i)
    if (repetition[i] != 0) ns += repetition[i] * true_figure(forms[i], truth);
  return ns;
}

/// What the first loops take on a CPU with these times, each measured for a second, wrong by anything that it may be.
std::vector<LoopTime> measure(const Loops& loops, std::size_t first, const TimeTable& truth, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> error(-1, 1);
  std::vector<LoopTime> times;
  for (std::size_t loop = 0; loop < first; ++loop) {
    double ns = duration(loops.loops[loop], loops.forms, truth);
    const auto interrupts = loops.interrupts.find(loop);
    if (interrupts != loops.interrupts.end())
      ns /= 1 - duration(interrupts->second, loops.forms, truth) / static_cast<double>(measuring::kInterruptEvery);
    const double within = ns * 1.5e-3, measured = ns + error(random) * within;
    times.push_back({measured, within, measured});
  }
  return times;
}

void expect_within(double figure, const TimeRange& range, const std::string& what) {
  EXPECT_GE(figure, range.least - 1) << what;
  EXPECT_LE(figure, range.most + 1) << what;
}

/// What can be asked of a table: each instruction with operands in each area that it can have in front.
void expect_within(const TimeTable& truth, const TimeTable& table) {
  const auto compare = [&](std::string_view name, std::optional<Area> area) {
    const TimeRow *of_truth = truth.find(name, area), *found = table.find(name, area);
    const TimeRow none{}, &is = of_truth ? *of_truth : none, &said = found ? *found : none;
    const std::string what = std::string(name) + (area ? " " + std::string(info(*area).name) : "");
    expect_within(static_cast<double>(is.base), range_of_base(said), what);
    expect_within(static_cast<double>(is.per_unit), range_of_unit(said), what + " per unit");
  };
  for (const SystemTime what : kSystemTimes)
    if (what != SystemTime::OperandArea) compare(name_of(what), {});
  for (const AreaInfo& area : all_areas())
    if (cpu214().size_of(area.area) > 0) compare(name_of(SystemTime::OperandArea), area.area);
  for (const Instruction& instruction : all_instructions()) {
    if (!instruction.modelled() || !(instruction.cpus & kCpu214)) continue;
    if (instruction.rules().empty() || instruction.rules().front().kind != OperandKind::Memory) {
      compare(instruction.mnemonic, {});
      continue;
    }
    for (const AreaInfo& area : all_areas())
      if (contains(instruction.operand[0].areas, area.area) && cpu214().size_of(area.area) > 0)
        compare(instruction.mnemonic, area.area);
  }
}

void expect_sums_within(const TimeTable& figures, const TimeTable& table) {
  for (const TimeRow& row : table.rows()) {
    if (row.mnemonics.front() != kSum) continue;
    double sum = 0;
    for (const std::string& part : parts_of_sum(row.form)) sum += base_of(figures, part);
    TimeRange range = range_of_base(row);
    for (double* end : {&range.least, &range.most}) *end += end == &range.least ? -3 : 3;  // parts are whole nanoseconds
    expect_within(sum, range, row.form);
  }
}

const TimeTable& known() {
  static const TimeTable kKnown = told_apart(cpu214());
  return kKnown;
}

const Loops& loops() {
  static const Loops kLoops = find_loops(cpu214(), known());
  return kLoops;
}

/// The table of a CPU with these times, of which the first loops were measured.
TimeTable calibrate(const TimeTable& truth, std::size_t first, std::uint32_t seed) {
  return calibrated(fit(loops(), measure(loops(), first, truth, seed)), known(), default_times(cpu214()), "a CPU");
}

void expect_back(const TimeTable& truth, std::uint32_t seed) {
  const TimeTable table = calibrate(truth, loops().loops.size(), seed);
  expect_within(truth, table);
  expect_sums_within(truth, table);
  expect_sums_within(table, table);
  EXPECT_EQ(std::ranges::count(table.rows(), std::vector{std::string(kSum)}, &TimeRow::mnemonics), 7);
}

/// The tables of the CPU that have a name, and random ones around each.
std::vector<TimeTable> truths(std::uint32_t random) {
  std::vector<TimeTable> tables;
  std::vector<std::string> errors;
  for (const char* name : {"cpu214", "cpu214_from_22x"}) {
    const TimeTable named = *load_times(cpu214(), name, tools::host_files(), errors);
    tables.push_back(named);
    for (std::uint32_t number = 0; number < random; ++number) tables.push_back(random_times(named, 1, number));
  }
  return tables;
}

TEST(RoundTrip, EveryFigureAndEverySumOfEveryTableIsWithinItsBounds) {
  std::uint32_t seed = 0;
  for (const TimeTable& truth : truths(50)) {
    SCOPED_TRACE(seed);
    expect_back(truth, seed++);
    if (HasFailure()) break;
  }
}

TEST(RoundTrip, OfACalibrationThatWasInterruptedToo) {
  std::uint32_t seed = 0;
  for (const TimeTable& truth : truths(3))
    for (const std::size_t first : {1U, 24U, 100U, 187U, 190U}) {
      SCOPED_TRACE(first);
      expect_within(truth, calibrate(truth, first, seed++));
    }
}

TEST(RoundTrip, RandomTablesAroundAMeasuredOneKeepItsSums) {
  for (const TimeTable& truth : truths(3)) {
    const TimeTable table = calibrate(truth, loops().loops.size(), 7);
    for (std::uint32_t number = 0; number < 40; ++number) {
      const TimeTable drawn = random_times(table, 1, number);
      expect_within(drawn, table);
      expect_sums_within(drawn, table);
    }
  }
}

TEST(RoundTrip, ATableIsReadAsItIsWritten) {
  const TimeTable table = calibrate(truths(1)[3], loops().loops.size(), 7);
  TimeTable read;
  EXPECT_EQ(read.add(to_csv(table), "t.csv"), std::vector<std::string>{});
  EXPECT_EQ(to_csv(in_use(read)), to_csv(table));
  const auto path = std::filesystem::temp_directory_path() / ("s7200_round_trip_" + std::to_string(getpid()));
  std::ofstream(path) << cpu_line("214") << to_csv(table);
  std::vector<std::string> errors;
  const auto loaded = load_times(cpu214(), path.string(), tools::host_files(), errors);
  std::filesystem::remove(path);
  ASSERT_EQ(errors, std::vector<std::string>{});
  expect_sums_within(*loaded, table);
}

}  // namespace
}  // namespace s7200::tools::round_trip_test
