// The commands save, load and record: a session in a file.
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/session/commands/looked_at.hpp"
#include "tools/session/commands/rows/commands.hpp"
#include "tools/session/commands/running.hpp"
#include "tools/session/commands/saved_stops.hpp"
#include "tools/session/commands/session_file.hpp"
#include "tools/session/past/digest.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/words/words.hpp"
#include "tools/views/state/machine_text.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools::commands {
namespace {

/// Longer ones are not run again without being asked for: a week of a slave that nobody asks takes about a minute.
constexpr Time kLongSession = 7 * 24 * 3600 * kSecond;

std::string without_quotes(const std::string& text) {
  const std::size_t length = quotation_length(text);
  return length > 1 && length == text.size() ? text.substr(1, length - 2) : text;
}

std::string newest_text(const Session& session) { return moment_text(session.history.newest().time); }

std::string no_files(const Session& session, std::string_view command) {
  return fmt::format("{}: {}", command, session.setup.why_no_files);
}

/// `FILE [!]`: where a file goes that does not replace another one, unless `!` says so. It has all of `wanted` but the path.
Result<FilePlace> place_of(const Session& session, const Words& arguments, WantedFile wanted) {
  const bool replaces = arguments.size() == 2 && arguments[1] == "!";
  if (arguments.empty() || arguments.size() > (replaces ? 2 : 1))
    return Trouble{
        expects(wanted.command,
                fmt::format("a file, and ! if it may replace one that exists, for example: {} a.txt", wanted.command))};
  if (!session.setup.files) return Trouble{no_files(session, wanted.command)};
  wanted.path = without_quotes(arguments[0]);
  if (replaces) wanted.replacing = Replacing::Anything;
  auto to = session.setup.files->place_for(wanted);
  wanted.replacing = Replacing::Anything;
  if (!to && session.setup.files->place_for(wanted))
    return trouble("{}; '{} {} !' replaces it", to.why(), wanted.command, wanted.path);
  return to;
}

/// What a saved session depends on besides the program and what it began with.
std::vector<SessionOption> session_conditions(const Session& session) {
  std::vector<SessionOption> all = options_of(session.setup.master, session.history.origin(0).clock);
  all.insert(all.end(), session.setup.options.begin(), session.setup.options.end());
  return all;
}

SessionFile session_file(const Session& session) {
  SessionFile file{.stations = {},
                   .options = session_conditions(session),
                   .recording = session.history.recording(),
                   .stops = saved_stops(session)};
  for (std::size_t number = 0; number < session.stations.size(); ++number) {
    const Cpu& cpu = session.stations[number].simulation->cpu();
    file.stations.push_back({.name = session.is_system() ? session.setup.stations[number].name : "",
                             .cpu = std::string(cpu.program().model->name),
                             .program = digest_of(cpu.program()),
                             .begin = digest_of(session.history.origin(number)),
                             .state = digest_of(cpu.state())});
  }
  return file;
}

bool has_come_to(const Session& session, const SessionFile& file) {
  for (std::size_t number = 0; number < session.stations.size(); ++number)
    if (digest_of(session.stations[number].simulation->cpu().state()) != file.stations[number].state) return false;
  return true;
}

/// How a station is left, as a scenario expects it.
SessionRecord::Station record_of(const Session& session, std::size_t number) {
  const State& state = session.stations[number].simulation->cpu().state();
  SessionRecord::Station record{.memory = {}, .stopped = state.mode == Mode::Stop, .fatal_code = state.fatal_code};
  for (const auto& [station, range] : session.displayed)
    for (std::uint32_t i = 0; i < range.count && station == number; ++i) record.memory.push_back(object_of(state, range, i));
  return record;
}

std::optional<std::size_t> station_at_host(const Session& session, std::size_t host) {
  for (std::size_t number = 0; number < session.stations.size(); ++number)
    if (session.history.hosts()[host]->is_on(session.stations[number].simulation->line().line())) return number;
  return {};
}

/// Of the masters of all lines; nothing if none has asked.
std::optional<serial::Exchange> last_exchange(const Session& session) {
  std::optional<serial::Exchange> last;
  for (const Session::Station& station : session.stations) {
    const serial::Simulation& here = *station.simulation;
    if (!here.has_master() || here.master().busy() || here.master().exchange().request.empty()) continue;
    const serial::Exchange& exchange = here.master().exchange();
    if (!last || exchange.request_start > last->request_start) last = exchange;
  }
  return last;
}

}  // namespace

Reply save(Session& session, const Words& arguments) {
  const auto to = place_of(session, arguments, {"save", {}, "a saved session", session_beginning()});
  if (!to) return wrong(to.why());
  const SessionFile file = session_file(session);
  if (!file.recording.complete) return wrong("cannot save: " + oldest_text(session.history));
  for (const Action& action : file.recording.actions)
    if (const auto* const event = std::get_if<SystemEvent>(&action))
      return wrong(
          fmt::format("cannot save: a step of the scenario did '{}', which saved sessions have no word for", event->words));
  if (const auto done = to->write(session.setup.files->saved(file)); !done) return wrong(done.why());
  session.said << fmt::format("saved: {} with {} from outside{}\n", moment_text(session.history.now().time),
                              counted(file.recording.actions.size(), "action"),
                              file.stops.empty() ? "" : fmt::format("; breakpoints and watches: {}", file.stops.size()));
  return {};
}

Reply load(Session& session, const Words& arguments) {
  const bool however_long = arguments.size() == 2 && arguments[1] == "!";
  if (arguments.size() != 1 && !however_long) return wrong(expects("load", "a file that 'save' has written"));
  const std::string path = without_quotes(arguments[0]);
  if (!session.setup.files) return wrong(no_files(session, "load"));
  const auto text = session.setup.files->read(path);
  if (!text) return wrong(fmt::format("cannot read {}: {}", path, text.why()));
  const SessionFile here = session_file(session);
  std::vector<const CpuModel*> models;
  std::vector<std::string> names;
  for (const Session::Station& station : session.stations) models.push_back(station.simulation->cpu().program().model);
  for (const DebuggedStation& station : session.setup.stations) names.push_back(station.name);
  const auto file = session.setup.files->loaded(*text, models, names);
  if (!file) return wrong(fmt::format("cannot load {}: {}", path, file.why()));
  const std::string differing = differences(file->options, here.options);
  std::string why;
  for (std::size_t number = 0; why.empty() && number < session.stations.size(); ++number) {
    const SessionFile::Station &its = file->stations[number], &ours = here.stations[number];
    const std::string of = session.is_system() ? fmt::format("{}: ", session.name_of(number)) : "";
    if (its.program != ours.program)
      why = of + "it is of another program, or of other execution times or rates of PPI";
    else if (!differing.empty())
      why = fmt::format("it was saved with other options: {}", differing);
    else if (its.begin != ours.begin)
      why = of + "it began with other memory or inputs: give --memory, --ram-lost and --power-off as then";
  }
  if (why.empty() && !session.history.has_hosts_of(file->recording))
    why = "a bridge belongs to it, and there is no port for that here: give --pty, --device or --tcp as then";
  if (why.empty() && !however_long && file->recording.end.time > kLongSession)
    why = fmt::format("{} of simulated time are run again, which may take long; 'load {} !' does it all the same",
                      format_duration(file->recording.end.time), path);
  auto stops = why.empty() ? stops_of(session, *file) : Trouble{why};
  if (!stops) return wrong(fmt::format("cannot load {}: {}", path, stops.why()));
  const History::Place place = session.history.here();
  if (!session.history.replay(file->recording) || !has_come_to(session, *file)) {
    session.history.return_to(place);
    if (session.stop_requested()) return wrong(fmt::format("{}; nothing is loaded", session.setup.interruption()));
    return wrong(fmt::format("cannot load {}: replayed here, it comes to another state", path));
  }
  remember(session, place);
  session.looked_at.clear();
  session.looked_at_before.clear();
  note_new_branch(session);
  if (const std::size_t added = add_loaded(session, *std::move(stops)))
    session.said << fmt::format("breakpoints and watches of that session: {}; 'break' lists them\n", added);
  return arrive(session);
}

Reply record(Session& session, const Words& arguments) {
  if (!session.setup.write_scenario) return wrong("record: scenarios cannot be written here");
  if (!arguments.empty() && stl::lower_case(without_quotes(arguments[0])).ends_with(".json"))
    return wrong(
        "record writes a scenario in YAML: name it .yaml; 'save' writes a session in JSON, which 'load' returns to");
  const WantedFile wanted{"record", {}, "a transcript", {}, Replacing::Nothing};  // people add to what it wrote
  const auto to = place_of(session, arguments, wanted);
  if (!to) return wrong(to.why());
  if (const std::string requests = requests_under_way(session); !requests.empty())
    return wrong(fmt::format("cannot record this session: a request is under way: {}; {}; then record", requests,
                             session.history.in_the_past()
                                 ? fmt::format("'at end' goes to {}, up to where it has run", newest_text(session))
                                 : "'continue' runs to its end, 'send cancel' gives it up"));
  SessionRecord record{.session = session.history.recording(), .stations = {}};
  for (std::size_t host = 0; host < session.history.hosts().size(); ++host)
    record.host_stations.push_back(station_at_host(session, host));
  if (!record.session.complete) return wrong("cannot record: " + oldest_text(session.history));
  for (std::size_t number = 0; number < session.stations.size(); ++number)
    record.stations.push_back(record_of(session, number));
  record.last = last_exchange(session);
  record.looked_at = looked_at_since_the_beginning(session);
  const auto left_out = session.setup.write_scenario(record, *to);
  if (!left_out) return wrong(fmt::format("cannot record this session: {}", left_out.why()));
  for (const std::string& what : *left_out) session.said << fmt::format("left out: {}\n", what);
  session.said << fmt::format("recorded up to {}; 's7200 test {}' replays it\n", moment_text(session.history.now().time),
                              stl::printable(to->path));
  if (session.history.in_the_past())
    session.said << fmt::format("what has run after that, up to {}, is not in it: 'at end' goes there\n",
                                newest_text(session));
  return {};
}

}  // namespace s7200::tools::commands
