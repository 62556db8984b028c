// Where to stop: the commands break, watch and delete, what a saved session has of them, and what is said when a run comes
// to a stop.
#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "interpreter/base/counted.hpp"
#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"
#include "interpreter/trace/text_trace.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/session/causes/two_masters.hpp"
#include "tools/session/stops/stop_words.hpp"
#include "tools/session/stops/words.hpp"
#include "tools/views/execution_text.hpp"
#include "tools/views/machine_text.hpp"
#include "tools/views/memory.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

using On = StopPoint::On;
using Words = std::vector<std::string>;

/// The words up to the next option.
Words take_words(Words& words) {
  const auto end = std::ranges::find_if(words, find_stop_option);
  Words taken(words.begin(), end);
  words.erase(words.begin(), end);
  return taken;
}

/// A text in quotes, or all the words.
Words take_text(Words& words) {
  const char quote = words.empty() ? ' ' : words.front().front();
  auto end = words.end();
  if (quote == '\'' || quote == '"') {
    end = std::find_if(words.begin(), words.end(), [&](const std::string& word) {
      return word.back() == quote && (&word != &words.front() || word.size() > 1);
    });
    if (end != words.end()) ++end;
  }
  Words taken(words.begin(), end);
  words.erase(words.begin(), end);
  return taken;
}

bool is_unclosed(const std::string& text) {
  return !text.empty() && (text.front() == '\'' || text.front() == '"') && (text.size() == 1 || text.back() != text.front());
}

std::string without_quotes(std::string text) {
  const bool quoted = text.size() >= 2 && text.front() == text.back() && (text.front() == '\'' || text.front() == '"');
  return quoted ? text.substr(1, text.size() - 2) : text;
}

/// `always`, `if …`, `hits N`, `log …` after what a stop is set on.
bool read_options(Words words, const Program& program, StopPoint& stop, std::string& why) {
  Words options;
  while (!words.empty()) {
    const std::string option = stl::lower_case(words.front());
    words.erase(words.begin());
    if (std::ranges::find(options, option) != options.end())
      return why = fmt::format("'{}' is there twice; give it once", option), false;
    if (const StopOption* const known = find_stop_option(option)) {
      if (why = refused_option(*known, stop); !why.empty()) return false;
      options.push_back(option);
    }
    const Words given = option == "log" ? take_text(words) : take_words(words);
    if (option == "always" && given.empty()) {
      stop.needs_power = false;
    } else if (option == "if") {
      if (given.empty()) return why = expects(option, "a condition, for example: if VW100 > 8"), false;
      const auto condition = Expression::parse(joined(given), program, why);
      if (!condition) return false;
      stop.condition = *condition;
    } else if (option == "hits") {
      const auto hits = parse_decimal<std::uint64_t>(joined(given));
      if (!hits || *hits == 0) return why = expects(option, "a number above 0, for example: hits 4"), false;
      stop.from_hit = *hits;
    } else if (option == "log") {
      if (is_unclosed(joined(given))) return why = fmt::format("the closing {} is missing", given.front().front()), false;
      stop.log = without_quotes(joined(given));
      if (stop.log.empty()) return why = expects(option, "a text, for example: log '{VW100} at {time}'"), false;
      if (!check_message(stop.log, program, why)) return false;
    } else {
      why = fmt::format("after what it stops at come: {}", stop_options_text());
      return false;
    }
  }
  return true;
}

/// Takes `read`, `write`, `read write` or `change` off the end of the words; null if there is none.
const AccessWord* take_access(Words& words) {
  for (const AccessWord& access : kAccesses) {
    const Words its_words = stl::split_words(access.word);
    if (words.size() < its_words.size()) continue;
    const auto end = words.end() - static_cast<std::ptrdiff_t>(its_words.size());
    const auto same = [](const std::string& word, const std::string& one) { return stl::lower_case(word) == one; };
    if (!std::equal(end, words.end(), its_words.begin(), same)) continue;
    words.erase(end, words.end());
    return &access;
  }
  return nullptr;
}

std::string options_text(const StopPoint& stop) {
  std::string text;
  if (stop.on == On::Place && !stop.needs_power) text += ", always";
  if (stop.condition && stop.on != On::Becomes) text += fmt::format(", if {}", stl::printable(stop.condition->text()));
  if (stop.from_hit > 1) text += fmt::format(", from hit {}", stop.from_hit);
  if (!stop.log.empty()) text += fmt::format(", logs '{}'", stl::printable(stop.log));
  return text;
}

/// As they are written: ` if VW2 > 8 hits 4`.
std::string option_words(const StopPoint& stop) {
  std::string text;
  if (stop.condition && stop.on != On::Becomes) text += fmt::format(" if {}", stl::printable(stop.condition->text()));
  if (stop.from_hit > 1) text += fmt::format(" hits {}", stop.from_hit);
  if (!stop.log.empty()) text += fmt::format(" log '{}'", stl::printable(stop.log));
  return text;
}

}  // namespace

std::optional<StopPoint> Debugger::stop_of(const Arguments& words, std::string& why) {
  std::string note;
  auto stop = find_stop(words, simulation().cpu().program(), listing(), why, note);
  out_ << note;
  return stop;
}

Debugger::Error Debugger::set_break(const Arguments& arguments) {
  if (arguments.empty()) {
    list_stops();
    return {};
  }
  Words words = arguments;
  Words place = take_words(words);
  std::string why;
  if (place.empty()) return expects("break", "a place or what happens first, for example: break 40 if VW2 > 8");
  if (Error error = with_local_variables(place, current_op())) return error;
  auto stop = stop_of(place, why);
  if (stop)
    if (Error error = with_local_variables(words, stop->on == On::Place ? std::optional(stop->op) : current_op()))
      return error;
  if (!stop || !read_options(words, simulation().cpu().program(), *stop, why)) return why;
  const std::vector<SetStop>& all = stepper_.stops();
  const auto is_the_same = [&](const StopPoint& s) {
    return s.on == On::Place && s.op == stop->op && s.station == focus() && option_words(s).empty() &&
           s.needs_power == stop->needs_power;
  };
  const auto same = std::ranges::find_if(all, is_the_same);
  if (stop->on == On::Place && same != all.end() && words.empty()) {
    out_ << fmt::format("breakpoint {} is already in {}\n", same->number, op_text(stop->op));
    return {};
  }
  stop->number = next_number_++;
  stop->station = focus();
  out_ << fmt::format("breakpoint {} {}{}\n", stop->number,
                      stop->on == On::Place ? "in " + op_text(stop->op) : "at " + stl::printable(stop->name),
                      options_text(*stop));
  if (stop->on == On::Becomes && stop->condition->value(simulation().cpu(), why).value_or(Value{}).truth())
    out_ << "  it holds now: the run stops when it comes to hold again\n";
  stepper_.add(std::move(*stop));
  return {};
}

Debugger::Error Debugger::watch(const Arguments& arguments) {
  if (arguments.empty()) {
    list_stops();
    return {};
  }
  Words words = arguments;
  Words addresses = take_words(words);
  if (addresses.empty()) return expects("watch", "an address, for example: watch VW100");
  const AccessWord* const access = take_access(addresses);
  if (addresses.empty()) return expects("watch", "an address in front of that, for example: watch VW100 read");
  StopPoint pattern{.on = access ? access->on : On::Change};
  std::vector<Named> ranges;
  if (Error error = ranges_of(addresses, "watch", ranges)) return error;
  std::string why;
  if (!read_options(words, simulation().cpu().program(), pattern, why)) return why;
  for (const auto& [range, name] : ranges) {
    StopPoint added = pattern;
    added.number = next_number_++;
    added.station = focus();
    added.range = range;
    added.name = name + (added.on == On::Change ? "" : fmt::format(" {}", access->word));
    out_ << fmt::format("watch {}: {} is {}{}\n", added.number, added.name, value_of(simulation().cpu(), range),
                        options_text(added));
    if (added.on == On::Write)
      out_ << fmt::format("  it is for writes of instructions; 'watch {}' stops at what the system changes too\n", name);
    stepper_.add(std::move(added));
  }
  return {};
}

std::string Debugger::value_of(const Cpu& cpu, const MemoryRange& range) {
  return value_text(cpu.program(), range, range.bytes_in(cpu.state().image));
}

void Debugger::list_stops() {
  stepper_.count_hits();
  for (const bool watches : {false, true})
    for (const StopPoint& s : stepper_.stops()) {
      if (s.is_watch() != watches) continue;
      const Station& of = stations_[s.station];
      std::string what = said_of(s.station) + (s.on == On::Place ? op_text(of.listing, s.op) : s.name);
      if (watches) what += " is " + value_of(of.simulation->cpu(), *s.range);
      out_ << fmt::format("{:<3} {}  {:>8}  {}{}\n", s.number, watches ? "watch" : "break", counted(s.hits, "hit"), what,
                          options_text(s));
    }
  if (stepper_.stops().empty()) out_ << "no breakpoints and no watches\n";
}

Debugger::Error Debugger::delete_stop(const Arguments& arguments) {
  if (arguments.empty()) return expects("delete", "numbers that 'break' lists, or all");
  if (arguments.size() == 1 && stl::lower_case(arguments[0]) == "all") {
    stepper_.remove_all();
    return {};
  }
  for (const std::string& argument : arguments) {
    const auto number = parse_decimal<std::uint32_t>(argument);
    if (!number) return expects("delete", "numbers that 'break' lists, or all");
    if (!stepper_.remove(static_cast<int>(*number)))
      return fmt::format("there is no breakpoint or watch {}; 'break' lists them", *number);
  }
  return {};
}

std::string Debugger::mark_of(std::uint32_t op) const {
  const bool breakpoint = std::ranges::any_of(
      stepper_.stops(), [&](const StopPoint& s) { return s.on == On::Place && s.op == op && s.station == focus(); });
  return std::string(breakpoint ? "*" : " ") + (op == current_op() ? bold(">") : " ");
}

// --- in a saved session ---

namespace {

/// `VW100:4`, `VD20:real`, `AC1:byte`: as parse_place() reads it.
std::string address_of(const MemoryRange& range) {
  const bool part = range.area == Area::AC && range.width != Width::Double;
  const std::string_view type = range.real ? ":real" : !part ? "" : range.width == Width::Byte ? ":byte" : ":word";
  return range.name_of(0) + (range.count > 1 ? fmt::format(":{}", range.count) : "") + std::string(type);
}

SessionFile::SavedStop saved(const StopPoint& stop) {
  const auto access = std::ranges::find(kAccesses, stop.on, &AccessWord::on);
  return {.number = stop.number,
          .station = stop.station,
          .on = stop.is_watch() ? address_of(*stop.range) : stop.name,
          .access = stop.is_watch() ? std::string(access->word) : "",
          .always = stop.on == On::Place && !stop.needs_power,
          .condition = stop.condition && stop.on != On::Becomes ? stop.condition->text() : "",
          .from_hit = stop.from_hit,
          .log = stop.log};
}

}  // namespace

std::vector<SessionFile::SavedStop> Debugger::saved_stops() const {
  std::vector<SessionFile::SavedStop> all;
  for (const StopPoint& stop : stepper_.stops()) all.push_back(saved(stop));
  return all;
}

std::optional<StopPoint> Debugger::stop_of(const SessionFile::SavedStop& saved, std::string& why) const {
  const Station& of = stations_[saved.station];
  const Program& program = of.simulation->cpu().program();
  std::string note;
  std::optional<StopPoint> stop;
  if (saved.access.empty()) {
    stop = find_stop(stl::split_words(saved.on), program, of.listing, why, note);
  } else if (const auto place = parse_place(saved.on, program, why); place && !place->pointer) {
    const auto access = std::ranges::find(kAccesses, saved.access, &AccessWord::word);
    if (access == std::end(kAccesses)) return {};
    stop = StopPoint{.on = access->on, .range = place->range, .name = name_of(place->range, saved.on, program)};
    if (stop->on != On::Change) stop->name += fmt::format(" {}", access->word);
  }
  if (stop && !saved.condition.empty()) stop->condition = Expression::parse(saved.condition, program, why);
  if (!stop || !why.empty() || !check_message(saved.log, program, why)) return {};
  stop->number = saved.number;
  stop->station = saved.station;
  if (saved.always) stop->needs_power = false;
  stop->from_hit = saved.from_hit;
  stop->log = saved.log;
  return stop;
}

std::optional<std::vector<StopPoint>> Debugger::stops_of(const SessionFile& file, std::string& why) const {
  std::vector<StopPoint> stops;
  for (const SessionFile::SavedStop& saved : file.stops) {
    std::string wrong;
    const auto stop = stop_of(saved, wrong);
    if (!stop)
      return why = fmt::format("it is damaged: a breakpoint or watch at '{}'", stl::shortened(saved.on)), std::nullopt;
    stops.push_back(*stop);
  }
  return stops;
}

/// Those that are not there already, each with its number if no other one has that. How many they are.
std::size_t Debugger::add_loaded(std::vector<StopPoint> stops) {
  std::size_t added = 0;
  for (StopPoint& stop : stops) {
    const auto is_same = [&](const StopPoint& other) {
      SessionFile::SavedStop its = saved(other);
      its.number = stop.number;
      return its == saved(stop);
    };
    if (std::ranges::any_of(stepper_.stops(), is_same)) continue;
    if (std::ranges::find(stepper_.stops(), stop.number, &StopPoint::number) != stepper_.stops().end())
      stop.number = next_number_;
    next_number_ = std::max(next_number_, stop.number + 1);
    stepper_.add(std::move(stop));
    ++added;
  }
  return added;
}

// --- a run has come to a stop ---

void Debugger::report_hits(const Stop& stop) {
  for (const Hit& hit : stop.hits) hit.stop.is_watch() ? report_access(hit) : report_breakpoint(hit);
  for (const StopPoint& s : stepper_.stops())
    if (const std::string skipped = skipped_text(s); !skipped.empty())
      out_ << fmt::format("{}; 'break {} always{}' stops there then too\n", skipped, s.name, option_words(s));
  for (const StopPoint& s : stepper_.stops())
    if (const std::string unknown = unknown_text(s); !unknown.empty()) out_ << unknown << '\n';
}

/// At the oldest moment: what waits for a number of hits has none before it was set.
void Debugger::report_uncounted() {
  for (const SetStop& s : stepper_.stops())
    if (s.from_hit > 1)
      out_ << fmt::format("{} {} counts its hits from {} on, where it was set\n", s.is_watch() ? "watch" : "breakpoint",
                          s.number, moment_text(stepper_.counts_since(s)));
}

void Debugger::report_breakpoint(const Hit& hit) {
  const Program& program = stations_[hit.stop.station].simulation->cpu().program();
  const std::string hits = hit.stop.hits == 0   ? ""
                           : hit.stop.hits == 1 ? ", hit for the first time"
                                                : fmt::format(", hit {} times", hit.stop.hits);
  const std::string name = hit.stop.on == On::Place ? "" : ", " + hit.stop.name;
  out_ << said_of(hit.stop.station) << bold(fmt::format("breakpoint {}{}{}", hit.stop.number, name, hits)) << '\n';
  if (const std::string values = values_text(hit, stations_[hit.stop.station].simulation->cpu()); !values.empty())
    out_ << fmt::format("  {}\n", values);
  if (hit.stop.on == On::Becomes) report_changer(hit);
  if (hit.record) out_ << fmt::format("  {}  {}\n", moment_text(hit.record->at), describe(*hit.record, program));
  if (!hit.frame.empty()) out_ << fmt::format("  {}{}\n", serial::to_hex(hit.frame), asked_by(hit));
  if (!hit.wrong.empty()) out_ << fmt::format("  {}\n", wrong_answer_text(hit));
  if (const std::string mixed = not_an_answer_text(history_, hit); !mixed.empty()) out_ << fmt::format("  {}\n", mixed);
}

/// `  asked by pump`, if it is known.
std::string Debugger::asked_by(const Hit& hit) const {
  if (!hit.asker) return {};
  const bool is_named = is_system() && hit.asker->kind == Asker::Kind::Plc;
  const std::string text = asked_by_text(history_, *hit.asker, is_named ? options_.stations[hit.asker->number].name : "");
  return text.empty() ? "" : "  " + text;
}

void Debugger::report_access(const Hit& hit) {
  const Station& station = stations_[hit.stop.station];
  const Program& program = station.simulation->cpu().program();
  out_ << said_of(hit.stop.station) << bold(fmt::format("watch {}: {}", hit.stop.number, value_text(hit, program))) << '\n';
  report_changer(hit);
}

/// The instruction, or who else has changed memory.
void Debugger::report_changer(const Hit& hit) {
  const Station& station = stations_[hit.stop.station];
  const Cpu& cpu = station.simulation->cpu();
  if (hit.by) {
    out_ << fmt::format("  by {} {}\n", station.listing.routine_of(hit.by->op),
                        execution_text(execution_of(*hit.by, cpu), cpu.program()));
    return;
  }
  const bool by_system = !hit.action && !hit.planned && hit.stop.range;
  out_ << "  by " << changer_text(history_, hit.action, hit.planned)
       << (by_system ? forced_text(cpu, {bits_of(*hit.stop.range)}) : "") << '\n';
}

void Debugger::print_message(const StopPoint& stop, const Hit& hit) {
  hide_progress();
  const Cpu& cpu = stations_[stop.station].simulation->cpu();
  const std::string text = message_text(stop, hit, cpu, history_.now().time);
  out_ << fmt::format("{}{}\n", said_of(stop.station), stl::printable(text));
}

}  // namespace s7200::tools
