#include "tools/measuring/statements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/model/errors.hpp"
#include "interpreter/model/times/named_times.hpp"
#include "interpreter/program/operands/constants.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/peers/quiet_time.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tools/measuring/band.hpp"

namespace s7200::tools {
namespace {

using Verdict = Statement::Verdict;

Verdict verdict_of(bool holds) { return holds ? Verdict::Holds : Verdict::Fails; }

// --- what manuals print ---

/// A time that a manual prints for some CPUs.
struct PrintedTime {
  CpuSet cpus;
  std::string_view mnemonic;
  std::optional<Area> area;
  std::string_view what;
  Time least, most;
  std::string_view source;
};

constexpr std::string_view kGerman2002 = "S7-200 manual, German edition 2002, 448";
constexpr std::string_view kFrench2004 = "S7-200 manual, French edition 2004, appendix F";

/// Five percent to each side of a figure: a measurement that is farther off contradicts it.
constexpr PrintedTime about(CpuSet cpus, std::string_view mnemonic, std::optional<Area> area, std::string_view what,
                            Time figure, std::string_view source) {
  return {cpus, mnemonic, area, what, figure * 95 / 100, figure * 105 / 100, source};
}

const std::array kPrintedTimes{
    PrintedTime{kCpu21x,
                name_of(SystemTime::EepromSave),
                {},
                "saving a value to EEPROM takes 15 to 20 ms",
                15 * kMillisecond,
                20 * kMillisecond,
                "S7-200 manual C230-02 7-16"},
    about(kCpu22xRelease1, "RCV", {}, "RCV takes 80 us", 80 * kMicrosecond, kGerman2002),
    about(kCpu22xRelease1, "RET", {}, "RET takes 13 us", 13 * kMicrosecond, kGerman2002),
    about(kCpu22xRelease1, "RETI", {}, "RETI takes 23 us", 23 * kMicrosecond, kGerman2002),
    about(kCpu22xRelease1, "PID", {}, "PID takes 750 us", 750 * kMicrosecond, kGerman2002),
    about(kCpu22xRelease2, "LD", Area::I, "LD of an input takes 0.22 us", 220, "S7-200 manual, table 1-1, second hand"),
    about(kCpu22xRelease2, name_of(SystemTime::IndirectOperand), {}, "a pointer operand adds 14 us", 14 * kMicrosecond,
          kFrench2004),
    about(kCpu22xRelease2, name_of(SystemTime::NoPowerFlow), {}, "an instruction without power flow takes 1 us",
          kMicrosecond, kFrench2004),
};

/// A line that names `source` and is as it was made from it: who changes a figure in a copy may leave the source beside it.
bool is_fitted(const TimeRow& row, std::string_view source) {
  const auto is_as_it_was = [&row](const TimeRow& own) {
    return own.source == row.source && own.marker == row.marker && own.form == row.form && own.base == row.base &&
           own.per_unit == row.per_unit && std::ranges::find(own.mnemonics, row.mnemonics.front()) != own.mnemonics.end();
  };
  return row.source.find(source) != std::string::npos && std::ranges::any_of(named_times(), [&](const NamedTimes& named) {
           return std::ranges::any_of(named.table().rows(), is_as_it_was);
         });
}

void check_printed_times(const CpuModel& model, const TimeTable& times, std::vector<Statement>& statements) {
  for (const PrintedTime& printed : kPrintedTimes) {
    if (!(printed.cpus & model.self)) continue;
    const TimeRow* const row = times.find(printed.mnemonic, printed.area);
    const Time found = row ? row->base : 0;
    statements.push_back({std::string(printed.what), std::string(printed.source), in_microseconds(found) + " us",
                          verdict_of(found >= printed.least && found <= printed.most),
                          row && is_fitted(*row, printed.source)});
  }
}

// --- what Application Tip 41 says of itself ---

/// A row of the table in the tip's SBR 50.
struct Rate {
  std::uint32_t baud;
  std::int64_t port_control, quiet_ms;  ///< SMB30 and SMB34
};
constexpr std::array<Rate, 7> kRates{{{300, 0x5D, 166},
                                      {600, 0x59, 84},
                                      {1200, 0x55, 43},
                                      {2400, 0x51, 22},
                                      {4800, 0x4D, 12},
                                      {9600, 0x49, 6},
                                      {19200, 0x45, 5}}};
constexpr Rate k38400{38400, 0x41, 5};

/// The times of the slave for the longest request that it takes, 60 registers, and for a read.
struct Served {
  bool all_answered = false;
  std::size_t lost = 0;  ///< events, of characters or others
};

class Tip41 {
 public:
  Tip41(const SourceText& text, const CpuModel& model, const TimeTable& times) : text_(text), model_(model), times_(times) {}

  Time first_scan() const {
    serial::Simulation simulation(program(kUsual));
    start(simulation);
    return simulation.cpu().state().longest_scan;
  }

  /// Whether the watchdog stops it in the first scan, with the WDR that its loop for the CRC table has, or without.
  bool watchdog_stops_it(bool with_wdr) const {
    serial::Simulation simulation(program(kUsual, with_wdr));
    start(simulation);
    return simulation.cpu().state().fatal_code == static_cast<std::uint16_t>(FatalError::Watchdog);
  }

  Served serve(const Rate& rate) const {
    serial::Simulation simulation(program(rate));
    LostEvents lost;
    simulation.cpu().set_sink(&lost);
    if (!start(simulation)) return {};
    const std::vector<std::uint16_t> values(60, 0x5AA5);
    bool answered = true;
    for (const Bytes& request : {modbus::write_registers(0, values), modbus::read_holding_registers(0, 2)}) {
      simulation.master().start({.frame = serial::to_frame(modbus::rtu_frame(1, request))}, simulation.time());
      answered &= !simulation.finish_exchange().timed_out;
      simulation.run_until(simulation.time() + serial::default_quiet(simulation.freeport().format));
    }
    return {answered, lost.take()};
  }

 private:
  static constexpr Rate kUsual{9600, 0x49, 6};

  std::shared_ptr<const Program> program(const Rate& rate, bool with_wdr = true) const {
    stl::ParseResult parsed = text_.parsed;
    if (!with_wdr) replace_wdr(parsed.source);
    set_constant(parsed.source, "SMB30", {.value = rate.port_control}, false);
    set_constant(parsed.source, "SMB34", {.value = rate.quiet_ms}, false);
    return check(std::move(parsed), model_, times_).program;
  }

  /// Replaces WDR in SBR 62.
  static void replace_wdr(stl::Source& source) {
    bool inside = false;
    for (stl::Line& line : source.lines) {
      auto* statement = std::get_if<stl::Statement>(&line);
      if (!statement) continue;
      if (statement->mnemonic == "SBR") inside = std::get<stl::Integer>(statement->operands[0].value).value == 62;
      if (!inside || statement->mnemonic != "WDR") continue;
      statement->mnemonic = "NOP";
      statement->operands = {{.value = stl::Integer{0}}};
    }
  }

  static bool start(serial::Simulation& simulation) {
    simulation.power_up();
    const bool ready =
        simulation.run_until_ready([&] { return serial::default_quiet(simulation.freeport().format); }, 60 * kSecond);
    simulation.configure_master(simulation.freeport().format);
    return ready;
  }

  const SourceText& text_;
  const CpuModel& model_;
  const TimeTable& times_;
};

std::string in_milliseconds(Time time) { return fmt::format("{:.1f} ms", static_cast<double>(time) / kMillisecond); }

bool is_fitted_to_first_scan(const TimeTable& times) {
  return std::ranges::any_of(times.rows(), [](const TimeRow& row) { return is_fitted(row, kFirstScanOfTip41); });
}

/// The time of the first scan; the tip's text rounds it: 690 ms in one place, 700 ms in another.
constexpr Between<Time> kFirstScan{655 * kMillisecond, 735 * kMillisecond};

void check_first_scan(const Tip41& tip, Statement& statement) {
  const Time first = tip.first_scan();
  statement.found = in_milliseconds(first);
  statement.verdict = verdict_of(kFirstScan.has(first));
}

void check_wdr(const Tip41& tip, Statement& statement) {
  const bool stopped = tip.watchdog_stops_it(true), stopped_without = tip.watchdog_stops_it(false);
  statement.verdict = verdict_of(!stopped && stopped_without);
  statement.found = fmt::format("with it the watchdog {}, without it {}", stopped ? "stops the CPU" : "does nothing",
                                stopped_without ? "it stops the CPU" : "it does nothing");
}

void check_rates(const Tip41& tip, Statement& statement) {
  statement.verdict = Verdict::Holds;
  statement.found = "60 registers written and 2 read at each rate, no event lost";
  for (const Rate& rate : kRates) {
    const Served served = tip.serve(rate);
    if (served.all_answered && served.lost == 0) continue;
    statement.verdict = Verdict::Fails;
    statement.found = fmt::format("{} at {} baud, {} characters or events lost",
                                  served.all_answered ? "answers" : "no answer", rate.baud, served.lost);
    return;
  }
}

void check_38400(const Tip41& tip, Statement& statement) {
  const Served served = tip.serve(k38400);
  statement.verdict = verdict_of(!served.all_answered || served.lost > 0);
  statement.found = fmt::format("{}, {} characters or events lost during a request for 60 registers",
                                served.all_answered ? "answers" : "no answer", served.lost);
}

/// A statement of the tip about itself, and how it is checked.
struct OfTip41 {
  std::string_view what, where;
  bool of_first_scan;  ///< to which figures may be fitted
  void (*check)(const Tip41& tip, Statement& statement);
  const Between<Time>* accepted = nullptr;  ///< what agrees with it, if it is a time

  std::string text() const {
    if (!accepted) return std::string(what);
    return fmt::format("{} ({} to {} ms)", what, accepted->least / kMillisecond, accepted->most / kMillisecond);
  }
};
constexpr std::array<OfTip41, 4> kOfTip41{
    {{"the first scan takes about 690 ms, elsewhere about 700", "SBR 62 and text", true, check_first_scan, &kFirstScan},
     {"the loop for its CRC table needs its WDR, and no more", "SBR 62", true, check_wdr},
     {"it serves from 300 to 19200 baud", "SBR 50", false, check_rates},
     {"it does not work correctly at 38400 baud", "SBR 50", false, check_38400}}};

void check_tip41(const CpuModel& model, const TimeTable& times, const SourceText* text, std::vector<Statement>& statements) {
  const bool fitted = is_fitted_to_first_scan(times);
  for (const OfTip41& of : kOfTip41) {
    Statement statement{of.text(), fmt::format("Application Tip 41, {}", of.where)};
    if (model.self != kCpu214)
      statement.found = "the tip is a program for the CPU 214";
    else if (text)
      of.check(Tip41(*text, model, times), statement);
    else
      statement.found = "needs the document: --tip41 FILE";
    statement.fitted = of.of_first_scan && fitted && statement.verdict != Verdict::Fails;
    statements.push_back(std::move(statement));
  }
}

}  // namespace

std::vector<Statement> check_statements(const CpuModel& model, const TimeTable& times, const SourceText* tip41) {
  std::vector<Statement> statements;
  if (model.self == kCpu214 || tip41) check_tip41(model, times, tip41, statements);
  check_printed_times(model, times, statements);
  return statements;
}

bool is_tip41(const SourceText& text) {
  std::set<std::int64_t> subroutines, interrupts;
  for (const stl::Line& line : text.parsed.source.lines) {
    const auto* statement = std::get_if<stl::Statement>(&line);
    if (!statement || statement->operands.empty()) continue;
    const auto* number = std::get_if<stl::Integer>(&statement->operands[0].value);
    if (number && statement->mnemonic == "SBR") subroutines.insert(number->value);
    if (number && statement->mnemonic == "INT") interrupts.insert(number->value);
  }
  return subroutines == std::set<std::int64_t>{50, 51, 52, 53, 54, 55, 56, 57, 61, 62, 63} &&
         interrupts == std::set<std::int64_t>{120, 121, 122, 123, 124, 125};
}

}  // namespace s7200::tools
