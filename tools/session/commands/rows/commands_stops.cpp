// The commands break, watch and delete.
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/session/commands/answers/stop_reports.hpp"
#include "tools/session/commands/instruction_words.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/session/commands/rows/commands.hpp"
#include "tools/session/stops/stop_words.hpp"
#include "tools/session/words/words.hpp"

namespace s7200::tools::commands {
namespace {

using On = StopPoint::On;

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

std::string without_pair_of_quotes(std::string text) {
  const bool quoted = text.size() >= 2 && text.front() == text.back() && (text.front() == '\'' || text.front() == '"');
  return quoted ? text.substr(1, text.size() - 2) : text;
}

/// `always`, `if …`, `hits N`, `log …` after what a stop is set on.
Result<> read_options(Words words, const Program& program, StopPoint& stop) {
  Words options;
  while (!words.empty()) {
    const std::string option = stl::lower_case(words.front());
    words.erase(words.begin());
    if (std::ranges::find(options, option) != options.end()) return trouble("'{}' is there twice; give it once", option);
    if (const StopOption* const known = find_stop_option(option)) {
      if (std::string why = refused_option(*known, stop); !why.empty()) return Trouble{std::move(why)};
      options.push_back(option);
    }
    const Words given = option == "log" ? take_text(words) : take_words(words);
    if (option == "always" && given.empty()) {
      stop.needs_power = false;
    } else if (option == "if") {
      if (given.empty()) return Trouble{expects(option, "a condition, for example: if VW100 > 8")};
      const auto condition = Expression::parse(joined(given), program);
      if (!condition) return condition.trouble();
      stop.condition = *condition;
    } else if (option == "hits") {
      const auto hits = parse_decimal<std::uint64_t>(joined(given));
      if (!hits || *hits == 0) return Trouble{expects(option, "a number above 0, for example: hits 4")};
      stop.from_hit = *hits;
    } else if (option == "log") {
      if (is_unclosed(joined(given))) return trouble("the closing {} is missing", given.front().front());
      stop.log = without_pair_of_quotes(joined(given));
      if (stop.log.empty()) return Trouble{expects(option, "a text, for example: log '{VW100} at {time}'")};
      if (const auto done = check_message(stop.log, program); !done) return done.trouble();
    } else {
      return trouble("after what it stops at come: {}", stop_options_text());
    }
  }
  return {};
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

/// {"stops": [{"number": 1, "kind": "break", "text": "line 40 …", "hits": 0, "line": 40, "op": 12}]}: `line` and `op` of
/// those at a place, `station` in a system.
Json list_stops(Session& session) {
  Json stops = Json::array();
  session.stepper.count_hits();
  for (const bool watches : {false, true})
    for (const StopPoint& s : session.stepper.stops()) {
      if (s.is_watch() != watches) continue;
      const Session::Station& of = session.stations[s.station];
      const std::string_view kind = watches ? "watch" : "break";
      std::string what = session.said_of(s.station) +
                         (s.on == On::Place ? op_text(of.simulation->cpu().program(), of.listing, s.op) : s.name);
      if (watches) what += " is " + value_of(of.simulation->cpu(), *s.range);
      session.said << fmt::format("{:<3} {}  {:>8}  {}{}\n", s.number, kind, counted(s.hits, "hit"), what, options_text(s));
      Json stop{{"number", s.number}, {"kind", kind}, {"text", what + options_text(s)}, {"hits", s.hits}};
      if (s.on == On::Place) stop.update({{"line", of.listing.line_of(s.op)}, {"op", s.op}});
      if (session.is_system()) stop["station"] = session.name_of(s.station);
      stops.push_back(std::move(stop));
    }
  if (session.stepper.stops().empty()) session.said << "no breakpoints and no watches\n";
  return {{"stops", stops}};
}

}  // namespace

Reply set_break(Session& session, const Words& arguments) {
  if (arguments.empty()) return {.json = list_stops(session)};
  Words words = arguments;
  Words place = take_words(words);
  std::string why;
  if (place.empty()) return wrong(expects("break", "a place or what happens first, for example: break 40 if VW2 > 8"));
  if (why = with_local_variables(session, place, session.current_op()); !why.empty()) return wrong(why);
  std::string note;
  auto stop = find_stop(place, session.program(), session.listing(), note);
  session.said << note;
  if (!stop) return wrong(stop.why());
  const auto of_condition = stop->on == On::Place ? std::optional(stop->op) : session.current_op();
  if (why = with_local_variables(session, words, of_condition); !why.empty()) return wrong(why);
  if (const auto done = read_options(words, session.program(), *stop); !done) return wrong(done.why());
  const std::vector<SetStop>& all = session.stepper.stops();
  const auto is_the_same = [&](const StopPoint& s) {
    return s.on == On::Place && s.op == stop->op && s.station == session.focus() && option_words(s).empty() &&
           s.needs_power == stop->needs_power;
  };
  const auto same = std::ranges::find_if(all, is_the_same);
  if (stop->on == On::Place && same != all.end() && words.empty()) {
    session.said << fmt::format("breakpoint {} is already in {}\n", same->number,
                                op_text(session.program(), session.listing(), stop->op));
    return {};
  }
  stop->number = session.next_number++;
  stop->station = session.focus();
  session.said << fmt::format("breakpoint {} {}{}\n", stop->number,
                              stop->on == On::Place ? "in " + op_text(session.program(), session.listing(), stop->op)
                                                    : "at " + stl::printable(stop->name),
                              options_text(*stop));
  if (stop->on == On::Becomes && stop->condition->value(session.cpu()).value_or(Value{}).truth())
    session.said << "  it holds now: the run stops when it comes to hold again\n";
  session.stepper.add(std::move(*stop));
  return {};
}

Reply watch(Session& session, const Words& arguments) {
  if (arguments.empty()) return {.json = list_stops(session)};
  Words words = arguments;
  Words addresses = take_words(words);
  if (addresses.empty()) return wrong(expects("watch", "an address, for example: watch VW100"));
  const AccessWord* const access = take_access(addresses);
  if (addresses.empty()) return wrong(expects("watch", "an address in front of that, for example: watch VW100 read"));
  StopPoint pattern{.on = access ? access->on : On::Change};
  std::vector<NamedRange> ranges;
  if (const std::string why = ranges_of(session, addresses, "watch", ranges); !why.empty()) return wrong(why);
  if (const auto done = read_options(words, session.program(), pattern); !done) return wrong(done.why());
  for (const auto& [range, name] : ranges) {
    StopPoint added = pattern;
    added.number = session.next_number++;
    added.station = session.focus();
    added.range = range;
    added.name = name + (added.on == On::Change ? "" : fmt::format(" {}", access->word));
    session.said << fmt::format("watch {}: {} is {}{}\n", added.number, added.name, value_of(session.cpu(), range),
                                options_text(added));
    if (added.on == On::Write)
      session.said << fmt::format("  it is for writes of instructions; 'watch {}' stops at what the system changes too\n",
                                  name);
    session.stepper.add(std::move(added));
  }
  return {};
}

Reply delete_stop(Session& session, const Words& arguments) {
  if (arguments.empty()) return wrong(expects("delete", "numbers that 'break' lists, or all"));
  if (arguments.size() == 1 && stl::lower_case(arguments[0]) == "all") {
    session.stepper.remove_all();
    return {};
  }
  for (const std::string& argument : arguments) {
    const auto number = parse_decimal<std::uint32_t>(argument);
    if (!number) return wrong(expects("delete", "numbers that 'break' lists, or all"));
    if (!session.stepper.remove(static_cast<int>(*number)))
      return wrong(fmt::format("there is no breakpoint or watch {}; 'break' lists them", *number));
  }
  return {};
}

}  // namespace s7200::tools::commands
