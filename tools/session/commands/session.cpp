#include "tools/session/commands/session.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/text.hpp"
#include "tools/session/commands/answers/stop_reports.hpp"
#include "tools/session/stops/stop_words.hpp"
#include "tools/views/program/execution_text.hpp"
#include "tools/views/report.hpp"
#include "tools/views/state/machine_text.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

/// The first few of a run.
std::string text_of_unasked(Session& session, const SentByPlc& sent) {
  constexpr std::size_t kShown = 3;
  if (++session.unasked > kShown) return {};
  const serial::Exchange& last = session.simulation().master().exchange();
  return unasked_text(sent.bytes) +
         fmt::format("         from {} to {}{}\n", moment_text(sent.from), moment_text(sent.to),
                     last.timed_out || last.given_up ? ", after the master had given up" : "") +
         (session.unasked == kShown ? "         no more of this run are shown; 'break sent' stops at each\n" : "");
}

}  // namespace

Session::Session(History& its_history, SessionSetup its_setup, Onlooker& its_onlooker)
    : history(its_history),
      setup(std::move(its_setup)),
      onlooker(its_onlooker),
      stepper(history, setup.stop_request),
      trace(*this) {
  for (std::size_t station = 0; station < history.stations(); ++station) {
    serial::Simulation& simulation = history.station(station);
    stations.push_back({&simulation, Listing(simulation.cpu().program())});
    trace.add(simulation.cpu().program());
  }
  stepper.look_at(setup.station);
  stepper.set_host_timeout(setup.master.timeout);
  stepper.on_record = [this](std::size_t station, const TraceRecord& record) {
    if (record.kind == TraceKind::RuntimeError && !first_error) first_error = {station, record};
    trace.note(station, record);
  };
  stepper.on_instruction = [this](std::size_t station, const InstructionRecord& record, bool started_at) {
    print_instruction(station, record, started_at);
  };
  stepper.on_message = [this](const StopPoint& stop, const Hit& hit) {
    const std::string text = message_text(stop, hit, stations[stop.station].simulation->cpu(), history.now().time);
    tell(fmt::format("{}{}\n", said_of(stop.station), stl::printable(text)));
  };
  stepper.on_answer = [this](std::size_t station, const serial::Exchange& exchange) {
    tell(answer_text(*this, station, exchange));
  };
  stepper.on_unasked = [this](const SentByPlc& sent) {
    if (const std::string text = text_of_unasked(*this, sent); !text.empty()) tell(text);
  };
}

std::string Session::name_of(std::size_t station) const {
  return is_system() ? stl::printable(setup.stations[station].name) : "the PLC";
}

std::string Session::said_of(std::size_t station) const { return is_system() ? name_of(station) + ": " : ""; }

std::size_t Session::name_width() const {
  std::size_t longest = 0;
  for (const DebuggedStation& station : setup.stations) longest = std::max(longest, station.name.size());
  for (const LineStation& station : history.line_stations()) longest = std::max(longest, station.name.size());
  return longest;
}

std::optional<std::uint32_t> Session::current_op() const {
  const State& state = cpu().state();
  if (state.mode == Mode::Run) return standing_at(state).value_or(0);
  return state.fatal_code != 0 && state.fatal_op != kNoRoutine ? std::optional(state.fatal_op) : stations[focus()].last_op;
}

void Session::look_at(std::size_t station) {
  if (station == focus()) return;
  stepper.look_at(station);
  said << fmt::format("now at {}\n", name_of(station));
}

void Session::note_going_elsewhere() {
  for (Station& station : stations) station.last_op.reset();
  trace.lose_the_way();
}

void Session::tell(std::string_view lines) { onlooker.tell(take_said() + std::string(lines)); }

void Session::print_instruction(std::size_t number, const InstructionRecord& record, bool started_at) {
  Station& station = stations[number];
  station.last_op = record.op;
  if (number == focus()) onlooker.executed(record);
  trace.note(number, record);
  if (number != focus() || show == Show::None || (show == Show::Started && !started_at)) return;
  const Cpu& of = station.simulation->cpu();
  tell(
      fmt::format("   {}  {}\n", describe(execution_of(record, of), of.program()), format_duration(record.end - record.at)));
}

}  // namespace s7200::tools
