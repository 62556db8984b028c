// What a word of a command may become: for the tab key, and for editors.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "interpreter/base/text.hpp"
#include "interpreter/cpu/forcing.hpp"
#include "interpreter/stl/printer.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/debugger/force_words.hpp"
#include "tools/debugger/stop_words.hpp"

namespace s7200::tools {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

bool begins(std::string_view word, std::string_view with) {
  return word.size() >= with.size() && stl::upper_case(word.substr(0, with.size())) == stl::upper_case(with);
}

/// Symbols, the addresses that the program uses, and the areas of the CPU.
Words addresses_of(const Program& program) {
  std::set<std::string> words;
  for (const stl::Symbol& symbol : program.source.symbols)
    if (symbol.value && std::holds_alternative<stl::Address>(*symbol.value) && symbol.name.find(' ') == std::string::npos)
      words.insert(symbol.name);
  for (const stl::Statement& statement : program.statements)
    for (const stl::Operand& operand : statement.operands) {
      if (const auto* address = std::get_if<stl::Address>(&operand.value))
        words.insert(stl::to_text(stl::Operand{.value = *address}));
      if (const auto* pointer = std::get_if<stl::Indirect>(&operand.value))
        words.insert(stl::to_text(stl::Operand{.value = *pointer}));
    }
  return {words.begin(), words.end()};
}

/// Files and folders that begin so; folders end with `/`.
Words files_of(std::string_view word) {
  const std::size_t slash = word.rfind('/');
  const std::string folder(word.substr(0, slash == std::string_view::npos ? 0 : slash + 1));
  Words words;
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code ignored;
    if (name.find(' ') == std::string::npos && (!name.starts_with('.') || word.ends_with('.')))
      words.push_back(folder + name + (entry->is_directory(ignored) ? "/" : ""));
  }
  std::sort(words.begin(), words.end());
  return words;
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
    std::string why;
    const auto range = parse_range(address, program, why);
    return !range || !forcing::possible(*range);
  });
  return addresses;
}

/// Saved sessions, and folders.
Words sessions_of(std::string_view word) {
  Words files = files_of(word);
  std::erase_if(files, [](const std::string& name) {
    std::string beginning(session_beginning().size(), '\0');
    if (name.ends_with('/')) return false;
    std::ifstream(name, std::ios::binary).read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
    return beginning != session_beginning();
  });
  return files;
}

/// Each kind with the colon before its parameters.
Words fault_words() {
  Words words{"none"};
  for (const serial::FaultKindInfo& kind : serial::fault_kinds()) words.push_back(std::string(kind.name) + ":");
  return words;
}

/// The ends of the past, and when something was done from outside, the latest first.
Words moments_of(const History& history) {
  constexpr std::size_t kMost = 20;
  Words words{"start", "end"};
  const std::vector<Moment>& done = history.action_moments();
  for (auto moment = done.rbegin(); moment != done.rend() && words.size() < kMost; ++moment) {
    std::string time = format_duration(moment->time, 9);
    std::erase(time, ' ');
    if (words.back() != time) words.push_back(std::move(time));
  }
  return words;
}

/// Whether the next word belongs to a condition.
bool is_in_condition(const std::string& before) { return before == "IF" || before == "AND" || before == "OR"; }

}  // namespace

Debugger::Offers Debugger::completions(std::string_view line) const {
  const Words words = words_of(line);
  const std::string& last = words.back();
  const Program& program = simulation().cpu().program();
  Words all;
  const auto add_commands = [&] {
    for (const Command& command : commands()) all.emplace_back(command.name);
  };
  std::string why;
  const Command* command = words.size() > 1 ? find_command(words.front(), why) : nullptr;
  Takes takes = words.size() == 1 ? Takes::Commands : command ? command->takes : Takes::Nothing;
  const Words given = words.size() > 1 ? Words(words.begin() + 1, words.end() - 1) : Words();
  const std::string before = given.empty() ? "" : stl::upper_case(given.back());
  const bool asks_who = command && (command->name == "who" || command->name == "rwho");
  const bool stops = takes == Takes::Break || takes == Takes::Watch;
  if (stops && is_in_condition(before)) takes = Takes::Addresses;
  switch (takes) {
    case Takes::Nothing:
      break;
    case Takes::Commands:
      add_commands();
      break;
    case Takes::Switch:
      all = {"on", "off"};
      break;
    case Takes::Mode:
      all = {"run", "stop"};
      break;
    case Takes::Moments:
      if (given.empty()) all = moments_of(history_);
      break;
    case Takes::Power:
      if (!is_system() || !given.empty()) all = {"lost"};
      if (is_system() && given.empty()) all = {"all", "off", "on"};
      break;
    case Takes::Frame:
      if (given.empty()) all = {"read", "write", "cancel"};
      break;
    case Takes::Stations:
      for (const DebuggedStation& station : options_.stations) all.push_back(station.name);
      break;
    case Takes::Files:
      all = files_of(last);
      break;
    case Takes::Sessions:
      all = sessions_of(last);
      break;
    case Takes::Faults:
      all = given.empty() ? fault_words() : Words();
      for (const LineStation& one : history_.line_stations())
        if (given.size() == 1 && given[0] != "none" && one.line == &simulation().line() && !one.name.empty())
          all.push_back("station=" + one.name);
      break;
    case Takes::Addresses:
      if (asks_who && before == "EVENT") {
        all = words_after_break(given, program);
        break;
      }
      all = addresses_of(program);
      if (asks_who) all.emplace_back("event");
      break;
    case Takes::Forced:
      all = forceable(addresses_of(program), program);
      if (command->name == "unforce") {
        all = {"all"};
        for (const Forced& forced : forced_in(simulation().cpu())) all.push_back(forced.place.name_of(0));
      }
      break;
    case Takes::Break:
      all = words_after_break(given, program);
      break;
    case Takes::Watch:
      all = given.empty() ? addresses_of(program) : words_after_watch(given);
      break;
    case Takes::Places:
      all = given.empty() ? place_words() : given.size() == 1 ? numbers_of(before, program) : Words();
  }
  std::erase_if(all, [&](const std::string& word) { return !begins(word, last); });
  return {last.size(), all};
}

}  // namespace s7200::tools
