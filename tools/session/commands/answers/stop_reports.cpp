#include "tools/session/commands/answers/stop_reports.hpp"

#include <fmt/format.h>

#include "interpreter/base/text/text.hpp"
#include "interpreter/trace/text/text_trace.hpp"
#include "tools/session/causes/line/two_masters.hpp"
#include "tools/session/causes/writer.hpp"
#include "tools/session/commands/answers/cause_reports.hpp"
#include "tools/session/commands/instruction_words.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/stops/stop_words.hpp"
#include "tools/session/words/bad_pointers.hpp"
#include "tools/views/program/execution_text.hpp"
#include "tools/views/report.hpp"
#include "tools/views/state/machine_text.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

using On = StopPoint::On;

/// At the oldest moment: what waits for a number of hits has none before it was set.
void report_uncounted(Session& session) {
  for (const SetStop& s : session.stepper.stops())
    if (s.from_hit > 1)
      session.said << fmt::format("{} {} counts its hits from {} on, where it was set\n",
                                  s.is_watch() ? "watch" : "breakpoint", s.number,
                                  moment_text(session.stepper.counts_since(s)));
}

/// `  asked by pump`, if it is known.
std::string asked_by(const Session& session, const Hit& hit) {
  if (!hit.asker) return {};
  const bool is_named = session.is_system() && hit.asker->kind == Asker::Kind::Plc;
  const std::string text =
      asked_by_text(session.history, *hit.asker, is_named ? session.setup.stations[hit.asker->number].name : "");
  return text.empty() ? "" : "  " + text;
}

/// The instruction, or who else has changed memory.
void report_changer(Session& session, const Hit& hit) {
  const Session::Station& station = session.stations[hit.stop.station];
  const Cpu& cpu = station.simulation->cpu();
  if (hit.by) {
    session.said << fmt::format("  by {} {}\n", station.listing.routine_of(hit.by->op),
                                execution_text(execution_of(*hit.by, cpu), cpu.program()));
    return;
  }
  const bool by_system = !hit.action && !hit.planned && hit.stop.range;
  session.said << "  by " << changer_text(session.history, hit.action, hit.planned)
               << (by_system ? forced_text(session, cpu, {bits_of(*hit.stop.range)}) : "") << '\n';
}

void report_access(Session& session, const Hit& hit) {
  const Session::Station& station = session.stations[hit.stop.station];
  const Program& program = station.simulation->cpu().program();
  session.said << session.said_of(hit.stop.station)
               << session.bold(fmt::format("watch {}: {}", hit.stop.number, value_text(hit, program))) << '\n';
  report_changer(session, hit);
}

void report_breakpoint(Session& session, const Hit& hit) {
  const Program& program = session.stations[hit.stop.station].simulation->cpu().program();
  const std::string hits = hit.stop.hits == 0   ? ""
                           : hit.stop.hits == 1 ? ", hit for the first time"
                                                : fmt::format(", hit {} times", hit.stop.hits);
  const std::string name = hit.stop.on == On::Place ? "" : ", " + hit.stop.name;
  session.said << session.said_of(hit.stop.station)
               << session.bold(fmt::format("breakpoint {}{}{}", hit.stop.number, name, hits)) << '\n';
  if (const std::string values = values_text(hit, session.stations[hit.stop.station].simulation->cpu()); !values.empty())
    session.said << fmt::format("  {}\n", values);
  if (hit.stop.on == On::Becomes) report_changer(session, hit);
  if (hit.record) session.said << fmt::format("  {}  {}\n", moment_text(hit.record->at), describe(*hit.record, program));
  if (!hit.frame.empty()) session.said << fmt::format("  {}{}\n", serial::to_hex(hit.frame), asked_by(session, hit));
  if (!hit.wrong.empty()) session.said << fmt::format("  {}\n", wrong_answer_text(hit));
  if (const std::string mixed = not_an_answer_text(session.history, hit); !mixed.empty())
    session.said << fmt::format("  {}\n", mixed);
}

/// Outputs and what the program has computed are those of a scan that is not over.
std::string within_scan_text(const Session& session, const RunTo& run) {
  const State& state = session.cpu().state();
  const bool is_within = run.of_all && session.simulation().plc().executes() && standing_at(state).value_or(0) != 0;
  if (!is_within) return {};
  return fmt::format("; it stands within a scan; 'continue {} scan' goes on to the end of it", format_duration(run.limit));
}

void report_cpu_stop(Session& session) {
  const State& state = session.cpu().state();
  const auto last_op = session.stations[session.focus()].last_op;
  if (state.fatal_code != 0) {
    const std::string place = state.fatal_op == kNoRoutine
                                  ? "between two scans"
                                  : "in " + op_text(session.program(), session.listing(), state.fatal_op);
    session.said << session.said_of(session.focus())
                 << session.red(fmt::format("the CPU went to STOP: fatal error {:04X}, {},", state.fatal_code,
                                            meaning_of(FatalError{state.fatal_code})))
                 << "\n  " << place << '\n';
  } else if (last_op) {
    session.said << fmt::format("{}the CPU went to STOP; the last instruction was in {}\n", session.said_of(session.focus()),
                                op_text(session.program(), session.listing(), *last_op));
  }
}

}  // namespace

void report(Session& session, const Stop& stop, const RunTo& run, std::uint64_t errors) {
  if (session.first_error) {
    const auto& [station, error] = *session.first_error;
    session.said << session.said_of(station)
                 << session.red(describe(error, session.stations[station].simulation->cpu().program()));
    session.said << (errors > 1 ? fmt::format(" and {} more; 'errors' lists them\n", errors - 1) : "\n");
    const bool is_of_focus = station == session.focus() && error.op != kNoRoutine;
    for (const MemoryRange& pointer : is_of_focus ? bad_pointers(session.cpu(), error.op) : std::vector<MemoryRange>{})
      session.said << bad_pointer_report(session, "*" + pointer.name_of(0), pointer);
  }
  report_hits(session, stop);
  report_reason(session, stop, run);
  show_place(session);
}

void report_hits(Session& session, const Stop& stop) {
  for (const Hit& hit : stop.hits) hit.stop.is_watch() ? report_access(session, hit) : report_breakpoint(session, hit);
  for (const StopPoint& s : session.stepper.stops())
    if (const std::string skipped = skipped_text(s); !skipped.empty())
      session.said << fmt::format("{}; 'break {} always{}' stops there then too\n", skipped, s.name, option_words(s));
  for (const StopPoint& s : session.stepper.stops())
    if (const std::string unknown = unknown_text(s); !unknown.empty()) session.said << unknown << '\n';
}

void report_reason(Session& session, const Stop& stop, const RunTo& run) {
  switch (stop.reason) {
    case StopReason::Goal:
    case StopReason::StopPoint:
    case StopReason::Answer:
      return;
    case StopReason::Limit:
      session.said << fmt::format("{} of simulated time passed with nothing to stop for{}{}\n", format_duration(run.limit),
                                  run.limit == RunTo::kUsualLimit ? " (the limit; 'continue TIME' sets another)" : "",
                                  within_scan_text(session, run));
      return;
    case StopReason::Request: {
      const std::string failure = session.setup.take_failure();
      session.said << (failure.empty() ? session.setup.interruption() : failure) << '\n';
      return;
    }
    case StopReason::CpuStopped:
      report_cpu_stop(session);
      return;
    case StopReason::Oldest:
      session.said << at_oldest_text(session.history) << '\n';
      report_uncounted(session);
      return;
  }
}

std::string answer_text(const Session& session, std::size_t station, const serial::Exchange& exchange) {
  const serial::Plc& plc = session.stations[station].simulation->plc();
  const bool stands = exchange.timed_out && plc.powered() && !plc.executes();
  return exchange_text(exchange, session.master(station).timeout) + not_an_answer_text(session.history, station, exchange) +
         (stands ? "         the CPU is in STOP, where no program answers\n" : "");
}

std::string option_words(const StopPoint& stop) {
  std::string text;
  if (stop.condition && stop.on != On::Becomes) text += fmt::format(" if {}", stl::printable(stop.condition->text()));
  if (stop.from_hit > 1) text += fmt::format(" hits {}", stop.from_hit);
  if (!stop.log.empty()) text += fmt::format(" log '{}'", stl::printable(stop.log));
  return text;
}

}  // namespace s7200::tools
