#include "interpreter/program/loading/cpu_choice.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>

#include "interpreter/base/text/text.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/model/smart.hpp"
#include "interpreter/program/checking/checker.hpp"
#include "interpreter/stl/tables/symbols.hpp"

namespace s7200 {
namespace {

constexpr std::array<std::string_view, 3> kWordsOfRelease{"RELEASE", "REL", "V"};

constexpr std::string_view kBlanks = " \t", kPunctuation = " \t:=-,./*";

/// These words may stand before a CPU in a line that is about nothing else: `PLC type: CPU 224`.
constexpr std::array<std::string_view, 12> kWordsBefore{"FOR", "A",      "AN",      "THE",     "PLC", "TYPE",
                                                        "ON",  "TARGET", "SIEMENS", "SIMATIC", "S7",  "200"};

std::string_view last_word(std::string_view& text) {
  text = text.substr(0, text.find_last_not_of(kPunctuation) + 1);
  const std::size_t begin = text.find_last_of(kPunctuation) + 1;  // 0 if there is none
  const std::string_view word = text.substr(begin);
  text = text.substr(0, begin);
  return word;
}

bool is_about_nothing_else(std::string_view before) {
  for (std::string_view word = last_word(before); !word.empty(); word = last_word(before))
    if (std::ranges::find(kWordsBefore, word) == kWordsBefore.end()) return false;
  return true;
}

/// Whether a title goes on with a CPU: `Modbus slave for the CPU 224`.
bool ends_in_for(std::string_view before) {
  std::string_view word = last_word(before);
  if (word == "THE" || word == "A") word = last_word(before);
  return word == "FOR";
}

/// `REL 02.01`, `, release 1.20`, `V1.1`: takes it off the rest of a line, and returns the number before the dot; 0 for
/// none.
int take_release(std::string_view& rest) {
  std::string_view text = rest;
  text.remove_prefix(std::min(text.find_first_not_of(" \t,("), text.size()));
  const auto word = std::ranges::find_if(kWordsOfRelease, [&](std::string_view each) { return text.starts_with(each); });
  if (word == kWordsOfRelease.end()) return 0;
  text.remove_prefix(word->size());
  text.remove_prefix(std::min(text.find_first_not_of(" \t.:"), text.size()));
  int number = 0;
  const auto [end, trouble] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (trouble != std::errc{}) return 0;
  rest = text.substr(std::min(text.find_first_not_of("0123456789."), text.size()));
  return number;
}

/// A CPU as text names it.
struct NamedCpu {
  std::string name{};
  const CpuModel* model = nullptr;  ///< null: it is not modelled
  bool is_of_cn_series = false;
};

/// Takes the end of a CPU's name off the rest of a line: `XP`, ` XP`.
bool take_suffix(std::string_view& rest, std::string_view suffix) {
  const std::string_view text = rest.substr(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  if (!text.starts_with(suffix)) return false;
  rest = text.substr(suffix.size());
  return true;
}

/// `224 XP, release 2.01`: the CPU, and the rest of the line. Nothing if it is no CPU of Siemens.
std::optional<NamedCpu> cpu_at(std::string_view text, std::string_view& rest) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t:=-"), text.size()));
  constexpr std::size_t kDigits = 3;
  if (text.size() < kDigits || !std::ranges::all_of(text.substr(0, kDigits), stl::is_digit)) return {};
  NamedCpu cpu{.name = std::string(text.substr(0, kDigits))};
  rest = text.substr(kDigits);
  for (const std::string_view suffix : {"XP", "XM"})
    if (take_suffix(rest, suffix)) cpu.name += suffix;
  cpu.is_of_cn_series = take_suffix(rest, "CN");
  if (!rest.empty() && stl::is_digit(rest.front())) return {};  // a date, an order number
  const std::size_t tail = std::min(rest.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-"), rest.size());
  cpu.name += rest.substr(0, tail);
  cpu.name.erase(cpu.name.find_last_not_of('-') + 1);
  rest.remove_prefix(tail);
  const bool first_release = take_release(rest) == 1;
  cpu.model = first_release ? find_cpu(cpu.name + "r1") : nullptr;
  if (!cpu.model) cpu.model = find_cpu(cpu.name);
  if (cpu.is_of_cn_series) cpu.name += " CN";
  return cpu;
}

std::optional<NamedCpu> cpu_in_line(std::string_view comment, bool is_title) {
  const std::string upper = stl::upper_case(comment);
  const std::size_t at = upper.find("CPU");
  if (at == std::string::npos || (at > 0 && stl::is_letter(upper[at - 1]))) return {};
  const std::string_view before = std::string_view(upper).substr(0, at);
  std::string_view rest;
  auto cpu = cpu_at(std::string_view(upper).substr(at + 3), rest);
  if (!cpu || (is_title && ends_in_for(before))) return cpu;
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  const bool ends_there = rest.empty() || std::string_view(",.;:()*").find(rest.front()) != std::string_view::npos;
  if (!ends_there || !is_about_nothing_else(before)) cpu.reset();
  return cpu;
}

/// The first that is modelled; without one the first that is not.
std::optional<NamedCpu> named_in_head(const stl::Source& source) {
  std::optional<NamedCpu> unmodelled;
  const auto is_it = [&](std::optional<NamedCpu>& cpu) {
    if (cpu && !cpu->model && !unmodelled) unmodelled = cpu;
    return cpu && cpu->model;
  };
  bool is_title = true;
  for (const stl::Line& line : source.lines) {
    if (std::holds_alternative<stl::Statement>(line)) break;
    const auto* const comment = std::get_if<stl::CommentLine>(&line);
    if (!comment) continue;
    if (auto cpu = cpu_in_line(comment->text, is_title); is_it(cpu)) return cpu;
    is_title &= stl::trim(comment->text).empty();
  }
  const auto main = std::ranges::find(source.blocks, stl::Block::Kind::Main, &stl::Block::kind);
  if (main == source.blocks.end()) return unmodelled;
  auto cpu = cpu_in_line(main->title, true);
  return is_it(cpu) ? cpu : unmodelled;
}

bool is_for_smart(const stl::Source& source) {
  const auto is_of_smart = [](const stl::Line& line) {
    const auto* const statement = std::get_if<stl::Statement>(&line);
    return statement && is_instruction_of_smart(statement->mnemonic);
  };
  return !stl::symbol_of_smart(source).empty() || std::ranges::any_of(source.lines, is_of_smart);
}

}  // namespace

const CpuModel* cpu_in_head(const stl::Source& source) {
  const auto cpu = named_in_head(source);
  return cpu ? cpu->model : nullptr;
}

std::string unmodelled_cpu_in_head(const stl::Source& source) {
  const auto cpu = named_in_head(source);
  return cpu && (!cpu->model || cpu->is_of_cn_series) ? cpu->name : "";
}

bool is_cpu_line(std::string_view line) {
  const std::string first = stl::upper_case(line.substr(0, line.find_first_of(" \t:=-")));
  const auto cpu = cpu_in_line(line, false);
  return !find_instruction(first) && cpu && cpu->model;
}

const CpuModel& first_cpu_for(const stl::ParseResult& parsed) {
  constexpr std::array kCommon{&cpu214, &cpu224, &cpu226, &cpu224xp};
  std::vector<const CpuModel*> tried;
  for (const auto model : kCommon) tried.push_back(&model());
  if (is_for_smart(parsed.source)) std::swap(tried[0], tried[2]);  // the CPU 226
  for (const CpuModel* model : all_cpus())
    if (std::ranges::find(tried, model) == tried.end()) tried.push_back(model);
  if (const CpuModel* first = first_cpu_without_errors(parsed, tried)) return *first;
  const auto errors_on = [&](const CpuModel* model) {
    const auto diagnostics = decode_program(parsed, *model, default_times(*model)).diagnostics;
    return std::ranges::count(diagnostics, stl::Severity::Error, &stl::Diagnostic::severity);
  };
  return **std::ranges::min_element(tried.begin(), tried.begin() + kCommon.size(), {}, errors_on);
}

}  // namespace s7200
