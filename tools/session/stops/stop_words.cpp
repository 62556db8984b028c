#include "tools/session/stops/stop_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/errors.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/model/ports.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "serial_sim/line/frame.hpp"
#include "tools/session/causes/line/two_masters.hpp"
#include "tools/session/words/words.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

using On = StopPoint::On;

struct Happening {
  std::string_view word;
  On on;
};
constexpr Happening kHappenings[] = {
    {"received", On::FrameReceived}, {"sent", On::FrameSent},         {"xmt", On::Transmit},       {"rcv", On::ReceiveEnd},
    {"error", On::RuntimeError},     {"overflow", On::QueueOverflow}, {"lost", On::LostCharacter}, {"mode", On::ModeChange},
    {"unanswered", On::Unanswered},  {"wrong", On::WrongAnswer}};

/// That it is about.
std::optional<std::uint8_t> event_in(const TraceRecord& record) {
  switch (record.kind) {
    case TraceKind::EventOccurred:
    case TraceKind::EventLost:
    case TraceKind::EventDropped:
    case TraceKind::ServiceBegin:
      return record.event;
    case TraceKind::CharacterIgnored:
      return kPorts[record.port].received;
    default:
      return {};
  }
}

constexpr std::string_view kPlaces = "a line number, SBR n, INT n, LBL n or NETWORK n";

/// What has a number of its own in the whole program.
struct Mark {
  std::string_view word;
  Structure structure;
};
constexpr Mark kMarks[] = {{"SBR", Structure::SubroutineHead}, {"INT", Structure::InterruptHead}, {"LBL", Structure::Label}};

/// The lines of one of the program's files, counted over all of them.
struct LinesOfFile {
  const std::string* name;
  std::uint32_t first, end;

  bool has(std::uint32_t line) const { return first <= line && line < end; }
};

std::vector<LinesOfFile> files_of(const stl::SourceLines& source) {
  std::vector<LinesOfFile> files{{&source.name, 1, 0}};
  for (const stl::FurtherFile& file : source.further_files) files.push_back({&file.name, file.first_line, 0});
  for (std::size_t i = 0; i < files.size(); ++i)
    files[i].end = i + 1 < files.size() ? files[i + 1].first : std::numeric_limits<std::uint32_t>::max();
  return files;
}

/// The file that is named in capitals, with its folders or without them; the first one for an empty name. Null if none is.
const LinesOfFile* file_named(std::string_view name, const std::vector<LinesOfFile>& files) {
  if (name.empty()) return &files.front();
  for (const bool with_folders : {true, false})
    for (const LinesOfFile& file : files) {
      const std::string known = stl::upper_case(*file.name);
      if (with_folders ? known == name : known.ends_with(fmt::format("/{}", name))) return &file;
    }
  return nullptr;
}

/// Why a line of a file has no instruction at or after it.
std::string no_instruction_text(const LinesOfFile& file, const Program& program) {
  const auto is_in_file = [&](const stl::Statement& statement) { return file.has(statement.position.line); };
  const auto last = std::find_if(program.statements.rbegin(), program.statements.rend(), is_in_file);
  const std::vector<stl::FurtherFile>& further = program.source.further_files;
  const bool is_first = file.name == &program.source.name;
  const std::string others =
      is_first && !further.empty()
          ? fmt::format("; write for example {}:1 for a line of another file", stl::printable(further.front().name))
          : "";
  if (last == program.statements.rend()) return fmt::format("{} has no instruction{}", stl::printable(*file.name), others);
  return fmt::format("the last instruction{} is in line {}{}", further.empty() ? "" : " of " + stl::printable(*file.name),
                     last->position.line - file.first + 1, others);
}

Result<NamedPlace> place_of_line(const std::string& text, const Program& program, const Listing& listing,
                                 std::string_view command) {
  const auto line = find_program_line(text, program, listing);
  if (!line) return line.why().empty() ? Trouble{expects(command, kPlaces)} : line.trouble();
  const std::uint32_t op = listing.op_from_line(*line).value();
  if (listing.line_of(op) == *line) return NamedPlace{op};
  return NamedPlace{op, fmt::format("{} has no instruction; the next one is in {}\n",
                                    stl::line_text(program.source, *line, 1), line_of(op, program))};
}

Result<NamedPlace> place_of_network(const std::string& text, const Listing& listing, std::string_view command) {
  const std::size_t digit = text.find_first_of("0123456789");
  const auto number = digit == std::string::npos ? std::nullopt : parse_decimal<std::uint32_t>(text.substr(digit));
  const auto op = number ? listing.op_of_network(*number) : std::nullopt;
  if (op) return NamedPlace{*op};
  return Trouble{number ? fmt::format("the program has no NETWORK {} with an instruction", *number)
                        : expects(command, kPlaces)};
}

Result<StopPoint> event_stop(const std::vector<std::string>& words, const CpuModel& model) {
  const auto number = words.size() >= 2 ? parse_decimal<std::uint8_t>(words[1]) : std::nullopt;
  const std::string what = words.size() == 3 ? stl::lower_case(words[2]) : words.size() == 2 ? "served" : "";
  if (!number || !find_event(*number) || (what != "served" && what != "occurs"))
    return Trouble{
        expects("break event", "the number of an event, and occurs or served, for example: break event 8 occurs")};
  if (const CpuSet cpus = find_event(*number)->cpus; (cpus & model.self) == 0)
    return Trouble{needs(fmt::format("event {} needs", *number), cpus)};
  return StopPoint{.on = what == "served" ? On::EventServed : On::EventOccurs, .event = *number};
}

Result<StopPoint> happening_stop(const Happening& happening, const std::vector<std::string>& words, const CpuModel& model) {
  if (const CpuSet cpus = find_instruction("RCV")->cpus; happening.on == On::ReceiveEnd && (cpus & model.self) == 0)
    return Trouble{needs("RCV needs", cpus)};
  if (words.size() == 1) return StopPoint{.on = happening.on};
  if (happening.on != On::RuntimeError) return trouble("break {} expects nothing more", happening.word);
  if (words.size() > 2 || !parse_integer("16#" + words[1]))
    return Trouble{expects("break error", "nothing or a code in hex, for example: break error 0006")};
  const auto code = error_code_of(words[1]);
  if (!code) return code.trouble();
  return StopPoint{.on = happening.on, .code = *code};
}

/// Or a beginning of one: `sbr`, `int5`, `40`.
bool is_word_of_place(std::string_view lower) {
  const std::string word = stl::upper_case(lower);
  const auto begins = [&](std::string_view name) { return word.starts_with(name); };
  return begins("NETWORK") || std::ranges::any_of(kMarks, begins, &Mark::word) || parse_decimal<std::uint32_t>(word);
}

std::string times_text(std::uint64_t n) { return n == 1 ? "once" : fmt::format("{} times", n); }

std::string happenings_text() {
  std::string text = "event n";
  for (const Happening& happening : kHappenings) text += fmt::format(", {}", happening.word);
  return text;
}

bool has_operator(std::string_view text) {
  return text.find_first_of("<>=") != std::string_view::npos || stl::lower_case(text).starts_with("not ");
}

/// Of `VW0 > 3`, or a bit alone: it stops when that comes to hold. `otherwise`: what other text was expected.
Result<StopPoint> becoming_stop(const std::string& text, const Program& program, const std::string& otherwise) {
  const auto address = parse_place(text, program);
  if (address && !address->pointer && address->range.width != Width::Bit)
    return trouble("break {0}: when? 'watch {0}' stops when it changes, 'break {0} > 3' when that comes to hold",
                   stl::printable(text));
  const auto condition = Expression::parse(text, program);
  const bool has_place = condition && !condition->places().empty();
  if (has_place) return StopPoint{.on = On::Becomes, .name = text, .condition = *condition};
  if (!has_operator(text))
    return trouble("{}; or what happens: {}; or a condition, for example: break VW0 > 3", otherwise, happenings_text());
  if (!condition) return condition.trouble();
  return trouble("break {}: no address is in it, so it never changes", stl::printable(text));
}

/// Those that are not among the words; none where an option has not got what it needs.
std::vector<std::string> options_after(const std::vector<std::string>& words, bool of_place) {
  std::vector<std::string> options;
  if (const StopOption* const last = find_stop_option(words.back()); last && !last->takes.empty()) return options;
  for (const StopOption& option : kStopOptions)
    if ((of_place || !option.for_places_only) &&
        std::ranges::none_of(words, [&](const std::string& word) { return find_stop_option(word) == &option; }))
      options.emplace_back(option.word);
  return options;
}

}  // namespace

const StopOption* find_stop_option(std::string_view word) {
  const auto found = std::ranges::find(kStopOptions, stl::lower_case(word), &StopOption::word);
  return found == std::end(kStopOptions) ? nullptr : found;
}

std::string refused_option(const StopOption& option, const StopPoint& stop) {
  if (option.word == "if" && stop.on == On::Becomes)
    return fmt::format("'{0}' is a condition already: write 'break {0} and …'", stl::printable(stop.name));
  if (!option.for_places_only || stop.on == On::Place) return {};
  return fmt::format("'{}' is for places; what happens has no power flow", option.word);
}

std::string stop_options_text() {
  std::string text;
  for (const StopOption& option : kStopOptions)
    text += fmt::format("{}{}{}{}", text.empty() ? "" : ", ", option.word, option.takes.empty() ? "" : " ", option.takes);
  return text;
}

Result<std::uint32_t> find_program_line(std::string_view text, const Program& program, const Listing& listing) {
  const std::string upper = stl::upper_case(text);
  const std::size_t colon = upper.rfind(':');
  const bool is_named = colon != std::string::npos;
  const auto number = parse_decimal<std::uint32_t>(is_named ? std::string_view(upper).substr(colon + 1) : upper);
  if (!number || *number == 0) return std::nullopt;
  const std::vector<LinesOfFile> files = files_of(program.source);
  const LinesOfFile* const file = file_named(is_named ? std::string_view(upper).substr(0, colon) : "", files);
  if (!file) return std::nullopt;
  const std::uint64_t line = std::uint64_t{file->first} + *number - 1;
  const auto op = line < file->end ? listing.op_from_line(static_cast<std::uint32_t>(line)) : std::nullopt;
  if (op && file->has(listing.line_of(*op))) return static_cast<std::uint32_t>(line);
  return Trouble{no_instruction_text(*file, program)};
}

Result<std::uint16_t> error_code_of(std::string_view text) {
  constexpr RunError kNone{};
  const auto code = parse_integer(fmt::format("16#{}", text));
  const bool is_known = code && *code > 0 && *code <= 0xFFFF && meaning_of(RunError(*code)) != meaning_of(kNone);
  if (is_known) return static_cast<std::uint16_t>(*code);
  return trouble("'{}' is not the code of a run-time error; write for example 0006 or 0091", stl::shortened(text));
}

Result<NamedPlace> find_place(const std::vector<std::string>& words, const Program& program, const Listing& listing,
                              std::string_view command) {
  const std::string text = stl::upper_case(joined(words));
  if (text.starts_with("NETWORK")) return place_of_network(text, listing, command);
  const bool in_file = text.find(':') != std::string::npos;
  const auto kind = std::ranges::find(kMarks, std::string_view(text).substr(0, 3), &Mark::word);
  if (in_file || kind == std::end(kMarks)) return place_of_line(text, program, listing, command);
  const auto number = parse_decimal<std::uint32_t>(words.size() == 1 ? std::string_view(text).substr(3) : words[1]);
  if (!number || words.size() > 2) return Trouble{expects(command, kPlaces)};
  const auto op = std::ranges::find_if(
      program.ops, [&](const Op& one) { return one.instruction->structure == kind->structure && one[0].at == *number; });
  if (op != program.ops.end()) return NamedPlace{static_cast<std::uint32_t>(op - program.ops.begin())};
  return trouble("the program has no {} {}", kind->word, *number);
}

Result<StopPoint> find_stop(const std::vector<std::string>& words, const Program& program, const Listing& listing,
                            std::string& note) {
  const std::string first = stl::lower_case(words.front());
  const auto named = [&](Result<StopPoint> stop) {
    if (stop) stop->name = stl::lower_case(joined(words));
    return stop;
  };
  for (const Happening& happening : kHappenings)
    if (first == happening.word) return named(happening_stop(happening, words, *program.model));
  if (first == "event") return named(event_stop(words, *program.model));
  const auto place = find_place(words, program, listing, "break");
  if (!place && !is_word_of_place(first)) return becoming_stop(joined(words), program, place.why());
  if (!place && has_operator(joined(words))) return becoming_stop(joined(words), program, place.why());  // 40 > VW0
  if (!place) return place.trouble();
  note = place->note;
  return named(StopPoint{.on = On::Place, .op = place->op, .needs_power = true});
}

std::vector<std::string> place_words() {
  std::vector<std::string> words{"NETWORK"};
  for (const Mark& mark : kMarks) words.emplace_back(mark.word);
  return words;
}

std::vector<std::string> numbers_of(std::string_view word, const Program& program) {
  std::set<std::uint32_t> numbers;
  for (const Mark& mark : kMarks)
    for (const Op& op : program.ops)
      if (mark.word == word && op.instruction->structure == mark.structure) numbers.insert(op[0].at);
  for (const stl::Line& line : program.source.lines)
    if (const auto* network = std::get_if<stl::NetworkHead>(&line); network && word == "NETWORK" && network->number != 0)
      numbers.insert(network->number);
  std::vector<std::string> texts;
  for (const std::uint32_t number : numbers) texts.push_back(fmt::format("{}", number));
  return texts;
}

std::vector<std::string_view> happening_words() {
  std::vector<std::string_view> words{"event"};
  for (const Happening& happening : kHappenings) words.push_back(happening.word);
  return words;
}

std::string wrong_answer_text(const Hit& hit) {
  return hit.answer.empty() ? hit.wrong : fmt::format("answered {}: {}", serial::to_hex(hit.answer), hit.wrong);
}

std::string not_an_answer_text(const History& history, const Hit& hit) {
  return hit.asker ? not_an_answer_text(history, *hit.asker, hit.answer) : "";
}

std::string values_text(const Hit& hit, const Cpu& cpu) {
  return hit.stop.on == On::Becomes ? hit.stop.condition->places_text(cpu) : "";
}

std::string value_text(const Hit& hit, const Program& program) {
  const std::string was = value_text(program, *hit.stop.range, hit.stop.value);
  const std::string is = value_text(program, *hit.stop.range, hit.value);
  return was == is ? fmt::format("{} is {} as before", hit.stop.name, is)
                   : fmt::format("{} was {}, is {}", hit.stop.name, was, is);
}

std::string skipped_text(const StopPoint& stop) {
  if (stop.skipped == 0) return {};
  return fmt::format("breakpoint {} was passed {} without power flow", stop.number, times_text(stop.skipped));
}

std::string unknown_text(const StopPoint& stop) {
  if (stop.unknown == 0) return {};
  return fmt::format("the condition of {} {} could not be computed {}: {}", stop.is_watch() ? "watch" : "breakpoint",
                     stop.number, times_text(stop.unknown), stop.why_unknown);
}

std::vector<std::string> words_after_break(const std::vector<std::string>& words, const Program& program) {
  std::vector<std::string> all;
  if (words.empty()) {
    all = place_words();
    for (const std::string_view word : happening_words()) all.emplace_back(word);
    return all;
  }
  const std::string first = stl::lower_case(words.front());
  if (first == "event" && words.size() == 1) {
    for (const InterruptEvent& event : all_events()) all.push_back(fmt::format("{}", event.number));
    return all;
  }
  if (all = words.size() == 1 ? numbers_of(stl::upper_case(first), program) : all; !all.empty()) return all;
  if (first == "event" && words.size() == 2) all = {"occurs", "served"};
  const std::vector<std::string_view> happenings = happening_words();
  const bool is_place = std::ranges::find(happenings, first) == happenings.end();
  std::ranges::copy(options_after(words, is_place), std::back_inserter(all));
  return all;
}

std::vector<std::string> words_after_watch(const std::vector<std::string>& words) {
  std::vector<std::string> all;
  const auto has = [&](std::string_view word) {
    return std::ranges::any_of(words, [&](const std::string& one) { return stl::lower_case(one) == word; });
  };
  const bool waits_for = has("read") || has("write") || has("change");
  for (const AccessWord& access : kAccesses)
    if (!waits_for && access.word.find(' ') == std::string_view::npos) all.emplace_back(access.word);
  if (stl::lower_case(words.back()) == "read" && !has("write")) all.emplace_back("write");
  std::ranges::copy(options_after(words, false), std::back_inserter(all));
  return all;
}

std::string message_text(const StopPoint& stop, const Hit& hit, const Cpu& cpu, Time now) {
  std::string text = stop.log;
  const auto replace = [&](std::string_view word, const std::string& with) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + with.size()))
      text.replace(at, word.size(), with);
  };
  if (hit.record) replace("{time}", moment_text(hit.record->at));
  if (const auto event = hit.record ? event_in(*hit.record) : std::nullopt) replace("{event}", fmt::format("{}", *event));
  return filled_in(text, cpu, now, hit.by ? &*hit.by : nullptr);
}

}  // namespace s7200::tools
