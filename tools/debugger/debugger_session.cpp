// The commands that keep a session: save, load and record; and power, which begins it anew with what the CPU has kept.
#include <fmt/format.h>

#include <ostream>

#include "interpreter/base/text.hpp"
#include "interpreter/program/load.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/debugger/session_file.hpp"
#include "tools/debugger/words.hpp"
#include "tools/host/interruption.hpp"
#include "tools/views/machine_text.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

std::string without_quotes(const std::string& text) {
  const std::size_t length = quotation_length(text);
  return length > 1 && length == text.size() ? text.substr(1, length - 2) : text;
}

/// Object `i` of a range, with its value.
Assignment object_of(const State& state, const MemoryRange& range, std::uint32_t i) {
  MemoryRange place = range;
  place.count = 1;
  const bool element = info(range.area).element != 0;
  place.number = range.number + i * (element ? 1 : s7200::bytes_of(range.width));
  place.at = range.at + i * (element ? info(range.area).element : s7200::bytes_of(range.width));
  std::uint32_t value = 0;
  for (const std::uint8_t byte : place.bytes_in(state.image)) value = value << 8 | byte;
  return {place, value};
}

}  // namespace

/// `FILE [!]`: where a file goes that does not replace another one, unless `!` says so.
std::optional<Destination> Debugger::destination(const Arguments& arguments, std::string_view command, FileKind kind,
                                                 std::string& why) const {
  const bool replaces = arguments.size() == 2 && arguments[1] == "!";
  if (arguments.empty() || arguments.size() > (replaces ? 2 : 1)) {
    why = expects(command, fmt::format("a file, and ! if it may replace one that exists, for example: {} a.txt", command));
    return {};
  }
  WrittenFiles files = options_.written;
  const std::string path = without_quotes(arguments[0]);
  auto to = files.claim(command, path, std::move(kind), replaces ? Replace::Judged : Replace::Own, why);
  if (to && to->stream) {
    why = fmt::format("{} is not a file", path);
    return {};
  }
  if (!to) why += fmt::format("; '{} {} !' replaces what may be replaced", command, path);
  return to;
}

/// What a saved session depends on besides the program and what it began with.
std::vector<SessionOption> Debugger::session_conditions() const {
  std::vector<SessionOption> all = options_of(options_.master, history_.origin().clock);
  all.insert(all.end(), options_.conditions.begin(), options_.conditions.end());
  return all;
}

Debugger::Error Debugger::save(const Arguments& arguments) {
  std::string why;
  const auto to = destination(arguments, "save", {"a saved session", session_beginning()}, why);
  if (!to) return why;
  if (!history_.recording().complete) return "cannot save: " + oldest_text(history_.usage());
  const Program& program = simulation_.cpu().program();
  const SessionFile file{.cpu = std::string(program.model->name),
                         .program = digest_of(program),
                         .begin = digest_of(history_.origin()),
                         .options = session_conditions(),
                         .recording = history_.recording(),
                         .state = digest_of(simulation_.cpu().state())};
  if (!write_result(*to, to_text(file), why)) return why;
  out_ << fmt::format("saved: {} with {} from outside\n", moment_text(simulation_.time()),
                      counted(file.recording.actions.size(), "action"));
  return {};
}

Debugger::Error Debugger::load(const Arguments& arguments) {
  if (arguments.size() != 1) return expects("load", "a file that 'save' has written");
  const std::string path = without_quotes(arguments[0]);
  std::string why;
  const auto text = read_file(path, why);
  if (!text) return fmt::format("cannot read {}: {}", path, why);
  const Program& program = simulation_.cpu().program();
  const auto file = session_from_text(*text, *program.model, why);
  if (file && file->program != digest_of(program)) why = "it is of another program, or of other execution times";
  const std::string differing = file ? differences(file->options, session_conditions()) : "";
  if (why.empty() && !differing.empty()) why = fmt::format("it was saved with other options: {}", differing);
  if (why.empty() && file->begin != digest_of(history_.origin()))
    why = "it began with other memory or inputs: give --memory, --ram-lost and --power-off as then";
  if (!why.empty()) return fmt::format("cannot load {}: {}", path, why);
  const History::Place here = history_.here();
  if (!at_length([&] { return history_.replay(file->recording); }) || digest_of(simulation_.cpu().state()) != file->state) {
    history_.return_to(here);
    if (stop_requested()) return fmt::format("{}; nothing is loaded", interruption_text());
    return fmt::format("cannot load {}: replayed here, it comes to another state", path);
  }
  if (kept_.size() == kKeptStates) kept_.pop_front();
  kept_.push_back({command_, here});
  note_new_branch();
  note_going_elsewhere();
  show_place();
  note_the_past();
  return {};
}

Debugger::Error Debugger::record(const Arguments& arguments) {
  if (!options_.write_scenario) return "record: scenarios cannot be written here";
  std::string why;
  const auto to = destination(arguments, "record", {"a transcript", std::string(options_.scenario_beginning)}, why);
  if (!to) return why;
  const State& state = simulation_.cpu().state();
  SessionRecord record{
      .session = history_.recording(), .memory = {}, .stopped = state.mode == Mode::Stop, .fatal_code = state.fatal_code};
  if (!record.session.complete) return "cannot record: " + oldest_text(history_.usage());
  record.session.actions.resize(record.session.now.actions);
  record.session.moments.resize(record.session.now.actions);
  for (const MemoryRange& range : displayed_)
    for (std::uint32_t i = 0; i < range.count; ++i) record.memory.push_back(object_of(state, range, i));
  if (!simulation_.master().busy() && !simulation_.master().exchange().request.empty())
    record.last = simulation_.master().exchange();
  if (!options_.write_scenario(record, *to, why)) return fmt::format("cannot record this session: {}", why);
  out_ << fmt::format("recorded up to {}; 's7200 test {}' replays it\n", moment_text(simulation_.time()),
                      stl::printable(to->path));
  return {};
}

Debugger::Error Debugger::power(const Arguments& arguments) {
  Arguments words = arguments;
  RetentiveMemory memory = simulation_.cpu().retentive_memory();
  memory.ram_lost = !words.empty() && lower_case(words.back()) == "lost";
  if (memory.ram_lost) words.pop_back();
  const auto off = words.empty() ? std::optional<Time>(0) : parse_duration(joined(words));
  if (!off) return expects("power", "how long it was off, and lost if that was too long for the RAM: power 8h, power lost");
  memory.power_off = *off;
  remember();
  history_.power_up(memory);
  out_ << fmt::format(
      "power was off{}: {}\n", *off == 0 ? "" : " for " + format_duration(*off),
      memory.ram_lost ? "the EEPROM is left, RAM and clock are lost" : "retentive memory, EEPROM and clock are kept");
  note_new_branch();
  note_going_elsewhere();
  show_place();
  return {};
}

}  // namespace s7200::tools
