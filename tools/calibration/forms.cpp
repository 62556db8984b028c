#include "tools/calibration/forms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/model/times/named_times.hpp"
#include "interpreter/model/times/times_file.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tools/calibration/measure_program.hpp"
#include "tools/calibration/measurement.hpp"

namespace s7200::tools {
namespace {

/// First operands that have the same line in each of the tables.
struct Kind {
  std::vector<const TimeRow*> lines;
  Areas areas = 0;
};

/// The kinds of an instruction. The time that an area adds to any instruction is not a kind of its own.
std::vector<Kind> kinds_of(const Instruction& instruction, const CpuModel& model,
                           const std::vector<const NamedTimes*>& tables) {
  const TimeTable& own_table = tables.front()->table();
  std::vector<Kind> kinds;
  for (const AreaInfo& area : all_areas()) {
    if (!contains(instruction.operand[0].areas, area.area) || model.size_of(area.area) == 0) continue;
    std::vector<const TimeRow*> lines;
    for (const NamedTimes* each : tables) lines.push_back(each->table().find(instruction.mnemonic, area.area));
    const TimeRow* own = lines.front();
    if (!own || (own->areas == 0 && own_table.find(name_of(SystemTime::OperandArea), area.area))) continue;
    const auto known = std::ranges::find(kinds, lines, &Kind::lines);
    if (known == kinds.end())
      kinds.push_back({lines, set_of(area.area)});
    else
      known->areas |= set_of(area.area);
  }
  return kinds;
}

/// The row with bounds in place of a percentage; they include the figures of all tables for its operands.
TimeRow bounded(TimeRow row, const std::vector<const NamedTimes*>& tables) {
  TimeRange base = range_of_base(row), unit = range_of_unit(row);
  const auto hold = [](TimeRange& range, const TimeRange& other) {
    range = {std::min(range.least, other.least), std::max(range.most, other.most)};
  };
  std::vector<std::optional<Area>> operands{std::nullopt};
  for (const AreaInfo& area : all_areas())
    if (row.areas == 0 || contains(row.areas, area.area)) operands.emplace_back(area.area);
  const bool adds = row.mnemonics.front() == name_of(SystemTime::OperandArea);
  for (const NamedTimes* each : tables)
    for (const auto& operand : operands) {
      const TimeRow* other = each->table().find(row.mnemonics.front(), operand);
      if (!other) {
        if (adds && operand) base.least = 0;
        continue;
      }
      hold(base, range_of_base(*other));
      hold(unit, range_of_unit(*other));
      if (other->per_unit > 0) row.unit = other->unit;
    }
  row.uncertainty = 0;
  row.base_within = farthest(row.base, base);
  row.per_unit_within = farthest(row.per_unit, unit);
  return row;
}

/// Times with which an instruction's time, in ns, tells by its digits what it consisted of:
///
///   100'000  the instruction   1'000s  units, 99 at most   100s  pointers, 9 at most   10s  operands in an area that adds
///   time
///
/// A scan with all loops stays below the watchdog's 300 ms with them.
constexpr Time kBase = 100'000, kPerUnit = 1'000, kPointer = 100, kArea = 10;

/// The parts of an instruction's time besides its base.
struct Parts {
  explicit Parts(Time took)
      : units(static_cast<double>(took % kBase / kPerUnit)),
        pointers(static_cast<double>(took % kPerUnit / kPointer)),
        areas(static_cast<double>(took % kPointer / kArea)) {}

  double units, pointers, areas;
};

TimeTable telling_times(const TimeTable& times) {
  const auto telling = [](const std::string& name) {
    return name == name_of(SystemTime::IndirectOperand) ? kPointer
           : name == name_of(SystemTime::OperandArea)   ? kArea
                                                        : kBase;
  };
  return times.with([&](TimeRow& row) {
    row.base = telling(row.mnemonics.front());
    row.per_unit = row.per_unit == 0 ? 0 : kPerUnit;
  });
}

/// How often each form was executed.
using Counts = std::map<std::size_t, double>;

/// Takes an executed instruction apart, once the counting is on.
class FormCounter final : public TraceSink {
 public:
  FormCounter(const Program& program, const TimeTable& times, std::vector<Form>& forms)
      : program_(program), times_(times), forms_(forms) {}

  bool wants_instructions() const override { return true; }
  void instruction(const InstructionRecord& record) override {
    const Op& op = program_.ops[record.op];
    if (!record.powered) return count(SystemTime::NoPowerFlow, {}, 1);
    const std::string mnemonic(op.instruction->mnemonic);
    const std::vector<Area> areas = areas_of(record.op);
    const TimeRow* row = times_.find(mnemonic, areas.empty() ? std::nullopt : std::optional(areas.front()));
    const Parts parts(record.end - record.at);
    count({mnemonic, row}, 1);
    count({mnemonic, row, true}, parts.units);
    count(SystemTime::IndirectOperand, {}, parts.pointers);
    for (const Area area : areas)  // a loop has operands of one such area at most
      if (times_.find(name_of(SystemTime::OperandArea), area)) return count(SystemTime::OperandArea, area, parts.areas);
  }

  void count(SystemTime what, std::optional<Area> area, double times) {
    count({std::string(name_of(what)), times_.find(name_of(what), area)}, times);
  }

  Counts take() { return std::exchange(counts_, {}); }

 private:
  /// The areas of those operands that are addresses.
  std::vector<Area> areas_of(std::uint32_t op) const {
    std::vector<Area> areas;
    for (const stl::Operand& operand : program_.statement(op).operands)
      if (const auto* address = std::get_if<stl::Address>(&operand.value))
        if (const auto area = area_named(address->area)) areas.push_back(*area);
    return areas;
  }

  void count(const Form& form, double times) {
    if (times == 0) return;
    auto known = std::ranges::find(forms_, form);
    if (known == forms_.end()) known = forms_.insert(forms_.end(), form);
    counts_[static_cast<std::size_t>(known - forms_.begin())] += times;
  }

  const Program& program_;
  const TimeTable& times_;
  std::vector<Form>& forms_;
  Counts counts_;
};

/// Gives the CPU a command as if it had come over the line.
void command(Cpu& cpu, const Command& command) {
  cpu.poke(image::kV + measuring::kCommandAt, command.bytes());
  cpu.poke(image::kM + measuring::kCompleteByte, std::array{measuring::kCompleteBit});
}

/// The instructions of the repetitions alone: those between the beginning of the outer loop and the answer, those of
/// interrupts apart.
class Window final : public TraceSink {
 public:
  Window(const Program& program, FormCounter& repetitions, FormCounter& interrupts)
      : program_(program), repetitions_(repetitions), interrupts_(interrupts) {}
  bool wants_instructions() const override { return true; }
  void instruction(const InstructionRecord& record) override {
    const std::string_view mnemonic = program_.ops[record.op].instruction->mnemonic;
    if (mnemonic == "WDR") inside_ = true;
    if (mnemonic == "XMT") inside_ = false;  // and other scans may follow
    if (inside_) (in_interrupt_ ? interrupts_ : repetitions_).instruction(record);
    in_interrupt_ = in_service_;
  }
  void record(const TraceRecord& record) override {
    if (record.kind == TraceKind::ServiceBegin) in_interrupt_ = in_service_ = true;
    if (record.kind == TraceKind::ServiceEnd) in_service_ = false;  // by the instruction that is recorded next
    if (!inside_) return;
    if (record.kind == TraceKind::ServiceBegin) interrupts_.count(SystemTime::InterruptEntry, {}, 1);
    if (record.kind == TraceKind::ServiceEnd) ++services_;
    if (record.kind == TraceKind::ScanBegin) repetitions_.count(SystemTime::ScanOverhead, {}, 1);
  }

  /// The number of interrupts that were served.
  int services() const { return services_; }

 private:
  const Program& program_;
  FormCounter &repetitions_, &interrupts_;
  bool inside_ = false, in_interrupt_ = false, in_service_ = false;
  int services_ = 0;
};

Repetition in_order(const Counts& counts, std::size_t forms, double each) {
  Repetition repetition(forms, 0);
  for (const auto& [form, times] : counts) repetition[form] = times / each;
  return repetition;
}

}  // namespace

Time farthest(Time figure, const TimeRange& range) {
  const auto ns = static_cast<double>(figure);
  return static_cast<Time>(std::ceil(std::max(ns - range.least, range.most - ns)));
}

std::shared_ptr<const Program> measuring_program(const CpuModel& model, const TimeTable& times) {
  return check_text(kMeasureTimes, "measure_times.stl", model, times).program;
}

TimeTable told_apart(const CpuModel& model) {
  TimeTable own = default_times(model);
  const auto tables = times_of(model);
  std::vector<TimeRow> rows;
  for (const Instruction& instruction : all_instructions()) {
    if (!instruction.modelled() || !(instruction.cpus & model.self) || instruction.rules().empty()) continue;
    const std::vector<Kind> kinds = kinds_of(instruction, model, tables);
    if (kinds.size() < 2) continue;
    for (const Kind& kind : kinds) {
      rows.push_back(*kind.lines.front());
      rows.back().mnemonics = {std::string(instruction.mnemonic)};
      rows.back().areas = kind.areas;
      rows.back().form = names_of(kind.areas);
    }
  }
  const auto adds_more = [&](const TimeRow& row) {
    return row.mnemonics.front() == name_of(SystemTime::OperandArea) && model.size_of(*area_named(row.form)) > 0 &&
           !own.find(row.mnemonics.front(), area_named(row.form));
  };
  for (const NamedTimes* each : tables) std::ranges::copy_if(each->table().rows(), std::back_inserter(rows), adds_more);
  own.add(TimeTable(std::move(rows)));
  const TimeTable used = in_use(own);
  std::vector<TimeRow> lines;
  for (TimeRow row : used.rows())
    for (const std::string& mnemonic : std::vector(row.mnemonics)) {
      row.mnemonics = {mnemonic};
      lines.push_back(bounded(row, tables));
    }
  return TimeTable(std::move(lines));
}

Loops find_loops(const CpuModel& model, const TimeTable& times) {
  Loops found;
  const auto program = measuring_program(model, telling_times(times));
  if (!program) return found;
  FormCounter repetitions(*program, times, found.forms), interrupts(*program, times, found.forms);
  const auto run = [&](std::size_t loop, std::uint16_t times_over) {
    serial::Simulation simulation(program);
    Cpu& cpu = simulation.cpu();
    simulation.power_up();
    cpu.pause_at_scan_end(true);
    simulation.run_until(10 * kSecond);
    command(cpu, {.loop = static_cast<std::uint8_t>(loop), .outer = 1, .inner = times_over});
    Window window(*program, repetitions, interrupts);
    cpu.set_sink(&window);
    for (std::uint16_t scan = 0; scan <= times_over; ++scan)  // of the last loop, whose repetitions they are
      simulation.run_until(simulation.time() + 100 * kSecond);
    cpu.set_sink(nullptr);
    return window.services();
  };
  struct Counted {
    Counts once_more, in_interrupts;
    double services;
  };
  std::vector<Counted> counted;
  for (std::size_t loop = 0; loop < measured_loops(*program); ++loop) {
    run(loop, 2);
    Counts once_more = repetitions.take();
    interrupts.take();
    const int services = run(loop, 1);
    for (const auto& [form, times_once] : repetitions.take()) once_more[form] -= times_once;
    counted.push_back({std::move(once_more), interrupts.take(), static_cast<double>(services)});
  }
  for (const auto& [once_more, in_interrupts, services] : counted) {
    found.loops.push_back(in_order(once_more, found.forms.size(), 1));
    if (services > 0) found.interrupts[found.loops.size() - 1] = in_order(in_interrupts, found.forms.size(), services);
  }
  return found;
}

}  // namespace s7200::tools
