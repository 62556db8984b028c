// What a word of a command may become: for the tab key, and for editors.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "interpreter/base/text.hpp"
#include "interpreter/stl/printer.hpp"
#include "tools/debugger/debugger.hpp"
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

enum class Takes : std::uint8_t { Nothing, Addresses, Places, Files, Commands, Switch, Stations };

constexpr std::pair<std::string_view, Takes> kTakes[]{
    {"help", Takes::Commands},    {"save", Takes::Files},        {"load", Takes::Files},        {"record", Takes::Files},
    {"trace", Takes::Switch},     {"layout", Takes::Switch},     {"break", Takes::Places},      {"until", Takes::Places},
    {"runtil", Takes::Places},    {"list", Takes::Places},       {"status", Takes::Places},     {"print", Takes::Addresses},
    {"expect", Takes::Addresses}, {"display", Takes::Addresses}, {"watch", Takes::Addresses},   {"set", Takes::Addresses},
    {"input", Takes::Addresses},  {"force", Takes::Addresses},   {"unforce", Takes::Addresses}, {"who", Takes::Addresses},
    {"rwho", Takes::Addresses},   {"station", Takes::Stations}};

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
  Takes takes = words.size() == 1 ? Takes::Commands : Takes::Nothing;
  for (const auto& [name, what] : kTakes)
    if (command && command->name == name) takes = what;
  const std::string before = words.size() > 1 ? stl::upper_case(words[words.size() - 2]) : "";
  switch (takes) {
    case Takes::Nothing:
      break;
    case Takes::Commands:
      add_commands();
      break;
    case Takes::Switch:
      all = {"on", "off"};
      break;
    case Takes::Stations:
      for (const DebuggedStation& station : options_.stations) all.push_back(station.name);
      break;
    case Takes::Files:
      all = files_of(last);
      break;
    case Takes::Addresses:
      all = addresses_of(program);
      if (command->name == "who" || command->name == "rwho") all.emplace_back("event");
      break;
    case Takes::Places:
      if (all = numbers_of(before, program); !all.empty()) break;
      if (before == "IF" || before == "AND" || before == "OR") {
        all = addresses_of(program);
      } else {
        all = place_words();
        if (command->name == "break")
          for (const std::string_view word : happening_words()) all.emplace_back(word);
      }
  }
  std::erase_if(all, [&](const std::string& word) { return !begins(word, last); });
  return {last.size(), all};
}

}  // namespace s7200::tools
