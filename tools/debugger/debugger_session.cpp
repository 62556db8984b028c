// The commands that keep a session: save, load and record; and power, which begins it anew with what the CPU has kept.
#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "interpreter/base/counted.hpp"
#include "interpreter/base/text.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/host/files.hpp"
#include "tools/host/interruption.hpp"
#include "tools/session/commands/session_file.hpp"
#include "tools/session/past/digest.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/stops/words.hpp"
#include "tools/views/machine_text.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

/// Longer ones are not run again without being asked for: a week of a slave that nobody asks takes about a minute.
constexpr Time kLongSession = 7 * 24 * 3600 * kSecond;

std::string without_quotes(const std::string& text) {
  const std::size_t length = quotation_length(text);
  return length > 1 && length == text.size() ? text.substr(1, length - 2) : text;
}

/// Object `i` of a range, with its value; a whole accumulator, which has no parts in a scenario.
Assignment object_of(const State& state, const MemoryRange& range, std::uint32_t i) {
  MemoryRange place = range;
  place.count = 1;
  const bool element = info(range.area).element != 0;
  place.number = range.number + i * (element ? 1 : s7200::bytes_of(range.width));
  place.at = range.at + i * (element ? info(range.area).element : s7200::bytes_of(range.width));
  if (range.area == Area::AC) {
    place.at -= 4 - s7200::bytes_of(range.width);
    place.width = Width::Double;
  }
  std::uint32_t value = 0;
  for (const std::uint8_t byte : place.bytes_in(state.image)) value = value << 8 | byte;
  return {place, value};
}

}  // namespace

/// `FILE [!]`: where a file goes that does not replace another one, unless `!` says so.
std::optional<Destination> Debugger::destination(const Arguments& arguments, std::string_view command, FileKind kind,
                                                 Replace unasked, std::string& why) const {
  const bool replaces = arguments.size() == 2 && arguments[1] == "!";
  if (arguments.empty() || arguments.size() > (replaces ? 2 : 1)) {
    why = expects(command, fmt::format("a file, and ! if it may replace one that exists, for example: {} a.txt", command));
    return {};
  }
  const std::string path = without_quotes(arguments[0]);
  const auto claim = [&](Replace replace, std::string& why_not) {
    WrittenFiles files = options_.written;
    return files.claim(command, path, kind, replace, why_not);
  };
  auto to = claim(replaces ? Replace::Judged : unasked, why);
  if (to && to->stream) {
    why = fmt::format("{} is not a file", path);
    return {};
  }
  std::string why_not;
  if (!to && claim(Replace::Judged, why_not)) why += fmt::format("; '{} {} !' replaces it", command, path);
  return to;
}

/// What a saved session depends on besides the program and what it began with.
std::vector<SessionOption> Debugger::session_conditions() const {
  std::vector<SessionOption> all = options_of(options_.master, history_.origin(0).clock);
  all.insert(all.end(), options_.conditions.begin(), options_.conditions.end());
  return all;
}

SessionFile Debugger::session_file() const {
  SessionFile file{
      .stations = {}, .options = session_conditions(), .recording = history_.recording(), .stops = saved_stops()};
  for (std::size_t number = 0; number < stations_.size(); ++number) {
    const Cpu& cpu = stations_[number].simulation->cpu();
    file.stations.push_back({.name = is_system() ? options_.stations[number].name : "",
                             .cpu = std::string(cpu.program().model->name),
                             .program = digest_of(cpu.program()),
                             .begin = digest_of(history_.origin(number)),
                             .state = digest_of(cpu.state())});
  }
  return file;
}

bool Debugger::has_come_to(const SessionFile& file) const {
  for (std::size_t number = 0; number < stations_.size(); ++number)
    if (digest_of(stations_[number].simulation->cpu().state()) != file.stations[number].state) return false;
  return true;
}

Debugger::Error Debugger::save(const Arguments& arguments) {
  std::string why;
  const auto to = destination(arguments, "save", {"a saved session", session_beginning()}, Replace::Own, why);
  if (!to) return why;
  const SessionFile file = session_file();
  if (!file.recording.complete) return "cannot save: " + oldest_text(history_);
  for (const Action& action : file.recording.actions)
    if (const auto* const event = std::get_if<SystemEvent>(&action))
      return fmt::format("cannot save: a step of the scenario did '{}', which saved sessions have no word for",
                         event->words);
  if (!write_result(*to, to_text(file), why)) return why;
  out_ << fmt::format("saved: {} with {} from outside{}\n", moment_text(history_.now().time),
                      counted(file.recording.actions.size(), "action"),
                      file.stops.empty() ? "" : fmt::format("; breakpoints and watches: {}", file.stops.size()));
  return {};
}

Debugger::Error Debugger::load(const Arguments& arguments) {
  const bool however_long = arguments.size() == 2 && arguments[1] == "!";
  if (arguments.size() != 1 && !however_long) return expects("load", "a file that 'save' has written");
  const std::string path = without_quotes(arguments[0]);
  std::string why;
  const auto text = read_file(path, why);
  if (!text) return fmt::format("cannot read {}: {}", path, why);
  const SessionFile here = session_file();
  std::vector<const CpuModel*> models;
  std::vector<std::string> names;
  for (const Station& station : stations_) models.push_back(station.simulation->cpu().program().model);
  for (const DebuggedStation& station : options_.stations) names.push_back(station.name);
  const auto file = session_from_text(*text, models, names, why);
  const std::string differing = file ? differences(file->options, here.options) : "";
  for (std::size_t number = 0; file && why.empty() && number < stations_.size(); ++number) {
    const SessionFile::Station &its = file->stations[number], &ours = here.stations[number];
    const std::string of = is_system() ? fmt::format("{}: ", name_of(number)) : "";
    if (its.program != ours.program)
      why = of + "it is of another program, or of other execution times or rates of PPI";
    else if (!differing.empty())
      why = fmt::format("it was saved with other options: {}", differing);
    else if (its.begin != ours.begin)
      why = of + "it began with other memory or inputs: give --memory, --ram-lost and --power-off as then";
  }
  if (why.empty() && !history_.has_hosts_of(file->recording))
    why = "a bridge belongs to it, and there is no port for that here: give --pty, --device or --tcp as then";
  if (why.empty() && !however_long && file->recording.end.time > kLongSession)
    why = fmt::format("{} of simulated time are run again, which may take long; 'load {} !' does it all the same",
                      format_duration(file->recording.end.time), path);
  const auto stops = why.empty() ? stops_of(*file, why) : std::nullopt;
  if (!why.empty()) return fmt::format("cannot load {}: {}", path, why);
  const History::Place place = history_.here();
  if (!at_length([&] { return history_.replay(file->recording); }) || !has_come_to(*file)) {
    history_.return_to(place);
    if (stop_requested()) return fmt::format("{}; nothing is loaded", interruption_text());
    return fmt::format("cannot load {}: replayed here, it comes to another state", path);
  }
  if (kept_.size() == kKeptStates) kept_.pop_front();
  kept_.push_back({command_, place, focus()});
  looked_at_.clear();
  note_new_branch();
  note_going_elsewhere();
  if (const std::size_t added = add_loaded(*stops))
    out_ << fmt::format("breakpoints and watches of that session: {}; 'break' lists them\n", added);
  show_place();
  note_the_past();
  return {};
}

/// How a station is left, as a scenario expects it.
SessionRecord::Station Debugger::record_of(std::size_t number) const {
  const State& state = stations_[number].simulation->cpu().state();
  SessionRecord::Station record{.memory = {}, .stopped = state.mode == Mode::Stop, .fatal_code = state.fatal_code};
  for (const auto& [station, range] : displayed_)
    for (std::uint32_t i = 0; i < range.count && station == number; ++i) record.memory.push_back(object_of(state, range, i));
  return record;
}

/// What was printed or expected on the way to where it stands, as far as it is so there still.
std::vector<SessionRecord::LookedAt> Debugger::looked_at_here() {
  const Moment here = history_.now();
  std::vector<SessionRecord::LookedAt> all;
  for (const auto& [station, moment, range, bytes] : looked_at_) {
    if (moment > here) continue;
    history_.go_to(moment);
    const State& state = stations_[station].simulation->cpu().state();
    if (history_.now() != moment || range.bytes_in(state.image) != bytes) continue;
    SessionRecord::LookedAt one{.station = station, .at = moment.time, .actions = moment.actions, .memory = {}};
    for (std::uint32_t i = 0; i < range.count; ++i) one.memory.push_back(object_of(state, range, i));
    all.push_back(std::move(one));
  }
  history_.go_to(here);
  std::ranges::stable_sort(all, {}, &SessionRecord::LookedAt::at);
  return all;
}

std::optional<std::size_t> Debugger::station_at_host(std::size_t host) const {
  for (std::size_t number = 0; number < stations_.size(); ++number)
    if (history_.hosts()[host]->is_on(stations_[number].simulation->line().line())) return number;
  return {};
}

Debugger::Error Debugger::record(const Arguments& arguments) {
  if (!options_.write_scenario) return "record: scenarios cannot be written here";
  std::string why;
  if (!arguments.empty() && stl::lower_case(without_quotes(arguments[0])).ends_with(".json"))
    return "record writes a scenario in YAML: name it .yaml; 'save' writes a session in JSON, which 'load' returns to";
  const auto to = destination(arguments, "record", {"a transcript"}, Replace::Never, why);  // people add to what it wrote
  if (!to) return why;
  if (const std::string requests = requests_under_way(); !requests.empty())
    return fmt::format(
        "cannot record this session: a request is under way: {}; 'continue' runs to its end, 'send cancel' gives it up; "
        "then record",
        requests);
  SessionRecord record{.session = history_.recording(), .stations = {}};
  for (std::size_t host = 0; host < history_.hosts().size(); ++host) record.host_stations.push_back(station_at_host(host));
  if (!record.session.complete) return "cannot record: " + oldest_text(history_);
  for (std::size_t number = 0; number < stations_.size(); ++number) record.stations.push_back(record_of(number));
  record.last = last_exchange();
  record.looked_at = looked_at_here();
  const auto left_out = options_.write_scenario(record, *to, why);
  if (!left_out) return fmt::format("cannot record this session: {}", why);
  for (const std::string& what : *left_out) out_ << fmt::format("left out: {}\n", what);
  out_ << fmt::format("recorded up to {}; 's7200 test {}' replays it\n", moment_text(history_.now().time),
                      stl::printable(to->path));
  return {};
}

/// Of the masters of all lines; nothing if none has asked.
std::optional<serial::Exchange> Debugger::last_exchange() const {
  std::optional<serial::Exchange> last;
  for (const Station& station : stations_) {
    const serial::Simulation& here = *station.simulation;
    if (!here.has_master() || here.master().busy() || here.master().exchange().request.empty()) continue;
    const serial::Exchange& exchange = here.master().exchange();
    if (!last || exchange.request_start > last->request_start) last = exchange;
  }
  return last;
}

/// `slave1: 01 03 00 00 00 02 c4 0b, pump: 04 …`: of all masters, each named by the first PLC on its line.
std::string Debugger::requests_under_way() {
  std::vector<const serial::Requester*> masters;
  std::string text;
  for (std::size_t number = 0; number < stations_.size(); ++number) {
    serial::Simulation& here = *stations_[number].simulation;
    if (!here.has_master() || !here.master().asks()) continue;
    if (std::ranges::find(masters, &here.master()) != masters.end()) continue;
    masters.push_back(&here.master());
    text += (text.empty() ? "" : ", ") + said_of(number) + serial::to_hex(here.master().exchange().request);
  }
  return text;
}

/// Of the PLC that it looks at; time goes on.
Debugger::Error Debugger::switch_power(bool on) {
  const std::string_view word = on ? "on" : "off";
  if (simulation().plc().powered() == on)
    return fmt::format("power {}: {} is {} power already", word, name_of(focus()), on ? "with" : "without");
  act(SetPower{on});
  out_ << fmt::format(
      "{} {}\n", name_of(focus()),
      on ? "has power again, and begins with what it has kept" : "has no power from now on; 'power on' brings it back");
  note_going_elsewhere();
  show_place();
  return {};
}

Debugger::Error Debugger::power(const Arguments& arguments) {
  Arguments words = arguments;
  const std::string first = words.empty() ? "" : stl::lower_case(words.front());
  if (words.size() == 1 && (first == "off" || first == "on")) return switch_power(first == "on");
  if (is_system() && first != "all")
    return "power of which PLCs? 'power off' and 'power on' switch this one, 'power all' switches every PLC off and on "
           "again";
  if (is_system()) words.erase(words.begin());
  const bool lost = !words.empty() && stl::lower_case(words.back()) == "lost";
  if (lost) words.pop_back();
  const auto off = words.empty() ? std::optional<Time>(0) : parse_duration(joined(words));
  if (!off)
    return expects("power",
                   fmt::format("{}how long it was off, in {}, and lost if that was too long for the RAM: power {}8h, "
                               "power {}lost",
                               is_system() ? "off, on, or all, " : "off, on, or ", kTimeUnits, is_system() ? "all " : "",
                               is_system() ? "all " : ""));
  const std::string requests = requests_under_way();
  remember();
  history_.power_cycle(lost, *off);
  looked_at_.clear();
  out_ << fmt::format("power was off{}: {}\n", *off == 0 ? "" : " for " + format_duration(*off),
                      lost ? "the EEPROM is left, RAM and clock are lost" : "retentive memory, EEPROM and clock are kept");
  if (!requests.empty())
    out_ << fmt::format("under way when power went off, and nobody waits for an answer any more: {}\n", requests);
  note_new_branch();
  note_going_elsewhere();
  show_place();
  return {};
}

}  // namespace s7200::tools
