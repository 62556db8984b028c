#include "tools/session/commands/rows/completion.hpp"

#include <algorithm>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/cpu/units/forcing.hpp"
#include "tools/session/commands/rows/command_table.hpp"
#include "tools/session/stops/stop_words.hpp"
#include "tools/session/words/address_words.hpp"
#include "tools/session/words/force_words.hpp"

namespace s7200::tools {
namespace {

bool begins(std::string_view word, std::string_view with) {
  return word.size() >= with.size() && stl::upper_case(word.substr(0, with.size())) == stl::upper_case(with);
}

Words words_of(std::string_view line) {
  Words words(1);
  for (const char c : line) {
    if (c == ';')
      words.assign(1, "");
    else if (c != ' ' && c != '\t')
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  }
  return words;
}

/// Those that can be forced.
Words forceable(Words addresses, const Program& program) {
  std::erase_if(addresses, [&](const std::string& address) {
    const auto range = parse_range(address, program);
    return !range || !forcing::possible(*range);
  });
  return addresses;
}

/// Saved sessions, and folders.
Words sessions_of(const SessionFiles& files, std::string_view word) {
  Words names = files.names(word);
  std::erase_if(names,
                [&](const std::string& name) { return !name.ends_with('/') && !files.begins(name, session_beginning()); });
  return names;
}

/// Each kind with the colon before its parameters.
Words fault_words() {
  Words words;
  for (const serial::FaultKindInfo& kind : serial::fault_kinds()) words.push_back(std::string(kind.name) + ":");
  return words;
}

/// When something was done from outside, the latest first.
Words moments_of(const History& history) {
  constexpr std::size_t kMost = 20;
  Words words;
  const std::vector<Moment>& done = history.action_moments();
  for (auto moment = done.rbegin(); moment != done.rend() && words.size() < kMost; ++moment) {
    std::string time = format_duration(moment->time, 9);
    std::erase(time, ' ');
    if (words.empty() || words.back() != time) words.push_back(std::move(time));
  }
  return words;
}

constexpr std::string_view kOperators = "(<>=+-*/";

/// Whether this word connects values, or begins one.
bool connects_values(std::string_view word) {
  const std::string before = stl::upper_case(word);
  return before == "AND" || before == "OR" || before == "NOT" || kOperators.find(before.back()) != std::string_view::npos;
}

bool is_word(const std::string& word, std::string_view wanted) { return stl::upper_case(word) == wanted; }

/// Whether a value of a condition may be next: after `if`, and after what connects values there.
bool wants_value(const Words& given) {
  if (std::ranges::none_of(given, [](const std::string& word) { return is_word(word, "IF"); })) return false;
  return is_word(given.back(), "IF") || connects_values(given.back());
}

/// The addresses behind what `last` has up to its last operator: `(VW2+M` may become `(VW2+MB0`.
Words values_in(std::string_view last, Words addresses) {
  const std::string written(last.substr(0, last.find_last_of(kOperators) + 1));
  for (std::string& address : addresses) address.insert(0, written);
  return addresses;
}

/// What may come of a condition: its values, and once more `not` after one.
Words wish_words(const Words& given, std::string_view last, const Program& program) {
  if (!given.empty() && !connects_values(given.back())) return {};
  Words words = values_in(last, address_words(program));
  if (given.size() == 1 && is_word(given.back(), "NOT")) words.emplace_back("not");
  return words;
}

/// `Q0.0 at 20ms within 5s`
Words change_words(const Words& given, const Session& session) {
  if (given.empty()) return address_words(session.program());
  if (is_word(given.back(), "AT")) {
    Words moments = moments_of(session.history);
    moments.insert(moments.begin(), {"start", "end"});
    return moments;
  }
  Words words;
  if (is_word(given.back(), "WITHIN")) return words;
  for (const char* const next : {"at", "within"})
    if (std::ranges::none_of(given, [&](const std::string& word) { return stl::lower_case(word) == next; }))
      words.emplace_back(next);
  return words;
}

/// A place, or a condition and how long it may take.
Words goal_words(const Words& given, std::string_view last, const Program& program) {
  if (given.size() == 1 && !connects_values(given.back()))
    if (Words numbers = numbers_of(stl::upper_case(given.back()), program); !numbers.empty()) return numbers;
  Words words = given.empty() ? place_words() : Words();
  const Words wish = wish_words(given, last, program);
  words.insert(words.end(), wish.begin(), wish.end());
  if (wish.empty() && !given.empty() && !is_word(given.back(), "WITHIN")) words.emplace_back("within");
  return words;
}

Words words_after(const Session& session, const CommandRow& command, const Words& given, std::string_view last) {
  const Program& program = session.program();
  const bool is_first = given.empty();
  const std::string before = is_first ? "" : stl::upper_case(given.back());
  Words all = is_first ? stl::split_words(command.words) : Words();
  const auto add = [&all](const Words& more) { all.insert(all.end(), more.begin(), more.end()); };
  switch (command.takes) {
    case Takes::Nothing:
      break;
    case Takes::Commands:
      add(command_names());
      break;
    case Takes::Moments:
      if (is_first) add(moments_of(session.history));
      break;
    case Takes::Power:
      if (!session.is_system() || !is_first) add({"lost"});
      if (is_first) add({"off", "on"});
      if (session.is_system() && is_first) add({"all"});
      break;
    case Takes::Stations:
      for (const DebuggedStation& station : session.setup.stations) all.push_back(station.name);
      break;
    case Takes::Files:
      if (session.setup.files) add(session.setup.files->names(last));
      break;
    case Takes::Sessions:
      if (session.setup.files) add(sessions_of(*session.setup.files, last));
      break;
    case Takes::Faults:
      if (is_first) add(fault_words());
      for (const LineStation& one : session.history.line_stations())
        if (given.size() == 1 && before != "NONE" && one.line == &session.simulation().line() && !one.name.empty())
          all.push_back("station=" + one.name);
      break;
    case Takes::Addresses:
    case Takes::Values:
      add(address_words(program));
      break;
    case Takes::Writers:
      add(before == "EVENT" ? words_after_break(given, program) : address_words(program));
      break;
    case Takes::Forced:
      add(forceable(address_words(program), program));
      break;
    case Takes::ForcedNow:
      for (const Forced& forced : forced_in(session.cpu())) all.push_back(forced.place.name_of(0));
      break;
    case Takes::Break:
      add(wants_value(given) ? values_in(last, address_words(program)) : words_after_break(given, program));
      break;
    case Takes::Watch:
      add(is_first             ? address_words(program)
          : wants_value(given) ? values_in(last, address_words(program))
                               : words_after_watch(given));
      break;
    case Takes::Goals:
      add(goal_words(given, last, program));
      break;
    case Takes::Wishes:
      add(wish_words(given, last, program));
      break;
    case Takes::Changes:
      add(change_words(given, session));
      break;
    case Takes::Places:
      if (given.size() < 2) add(is_first ? place_words() : numbers_of(before, program));
  }
  return all;
}

}  // namespace

Offers completions(const Session& session, std::string_view line) {
  const Words words = words_of(line);
  const std::string& last = words.back();
  const auto command = words.size() > 1 ? find_command(words.front()) : Trouble{};
  Words all = words.size() == 1 ? command_names() : Words();
  if (command) all = words_after(session, *command, {words.begin() + 1, words.end() - 1}, last);
  std::erase_if(all, [&](const std::string& word) { return !begins(word, last); });
  return {last.size(), all};
}

}  // namespace s7200::tools
