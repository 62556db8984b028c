// The commands print, expect and display: memory, what pointers point to, and expressions.
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/session/causes/expression.hpp"
#include "tools/session/commands/answers/cause_reports.hpp"
#include "tools/session/commands/looked_at.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/session/commands/rows/commands.hpp"
#include "tools/session/words/element_text.hpp"
#include "tools/session/words/print_forms.hpp"
#include "tools/session/words/words.hpp"
#include "tools/views/state/machine_text.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools::commands {
namespace {

/// Bytes as one text, in rows.
std::string characters_text(const Cpu& cpu, const MemoryRange& range) {
  constexpr std::uint32_t kInRow = 64;
  std::string text;
  for (std::uint32_t first = 0; first < range.count; first += kInRow) {
    text += fmt::format("{:<8} '", range.name_of(first));
    for (std::uint32_t i = first; i < std::min(range.count, first + kInRow); ++i)
      text += printable_character(cpu.state().image[range.at + i]);
    text += "'\n";
  }
  return text;
}

std::string range_text(const Cpu& cpu, const MemoryRange& range, const PrintForm* form) {
  if (!form) return dump_text(cpu, range);
  if (form->joins_bytes && range.width == Width::Byte) return characters_text(cpu, range);
  std::string text;
  for (std::uint32_t i = 0; i < range.count; ++i)
    text += fmt::format("{:<8} {}\n", range.name_of(i), form->text(bits_at(cpu.state(), range, i), range.width, range.real));
  return text;
}

/// A line for each timer or counter.
std::string elements_text(const Cpu& cpu, const MemoryRange& range) {
  const std::string_view name = range.area == Area::HC ? "HSC" : info(range.area).name;
  std::string text;
  for (std::uint32_t n = range.number; n < range.number + range.count; ++n)
    if (const std::string element = element_text(cpu, range.area, n); !element.empty())
      text += fmt::format("         {}{}: {}\n", name, n, element);
  return text;
}

/// Addresses beside each other have none.
bool has_operator(const std::vector<std::string>& words) {
  return std::ranges::any_of(words, [](const std::string& word) {
    const std::string lower = stl::lower_case(word);
    return lower == "and" || lower == "or" || lower == "not" || lower == "*" ||
           word.find_first_of("(+-/<>=&") != std::string::npos;
  });
}

std::string number_text(const Value& value, const PrintForm* form) {
  const auto bits = bits_of(value);
  if (!bits) return number_text(value) + " (more than a double word)";
  if (form) return form->text(*bits, Width::Double, value.real);
  return value.real ? number_text(value) : fmt::format("{} ({})", number_text(value), hex_text(*bits, Width::Double));
}

/// {"name": "VW100", "address": "VW100", "value": "16#0005 (5)"}, with what it says added to the text.
Json print_place(Session& session, const Place& place, const std::string& name, const PrintForm* form, std::string& text) {
  const Cpu& cpu = session.cpu();
  const auto range = range_now(place, cpu);
  if (!range) {
    text += bad_pointer_report(session, name, place.range);
    return {{"name", name}, {"value", nullptr}};
  }
  note_looked_at(session, place);
  if (place.pointer) text += fmt::format("{} is {}\n", name, range->name_of(0));
  text += range_text(cpu, *range, form);
  text += forced_line(session, cpu, *range);
  if (const std::string symbol = symbol_text(cpu.program(), *range); !symbol.empty()) text += "         " + symbol + '\n';
  text += elements_text(cpu, *range) + special_text(cpu, *range);
  return {{"name", name}, {"address", range->name_of(0)}, {"value", value_of(cpu, *range)}};
}

}  // namespace

Reply print(Session& session, const Words& arguments) {
  Words words = arguments;
  const PrintForm* form = nullptr;
  if (!words.empty() && words[0].size() == 2 && words[0][0] == '/') {
    form = find_print_form(words[0]);
    if (!form) return wrong(expects("print", fmt::format("a form ({}), then addresses", print_forms_meanings())));
    words.erase(words.begin());
  }
  if (words.empty()) return wrong(expects("print", "addresses or an expression, for example: print VB100:16 M31.7 *AC1"));
  const Program& program = session.program();
  std::string why;
  std::vector<Place> places;
  for (const std::string& word : words) {
    if (const auto place = parse_place(word, program))
      places.push_back(*place);
    else if (why.empty())
      why = place.why();
  }
  if (places.size() == words.size()) {
    Reply reply{.json = {{"values", Json::array()}}};
    for (std::size_t i = 0; i < places.size(); ++i)
      reply.json["values"].push_back(print_place(session, places[i], stl::upper_case(words[i]), form, reply.text));
    return reply;
  }
  const auto expression = Expression::parse(joined(words), program);
  if (!expression) return wrong(has_operator(words) ? expression.why() : why);
  for (const Place& place : expression->places()) note_looked_at(session, place);
  const auto value = expression->value(session.cpu(), Expression::SeenBy::Outside);
  const std::string number = value ? number_text(*value, form) : "";
  return {.text = fmt::format("{} {}\n", stl::printable(expression->text()),
                              value ? "= " + number : "cannot be computed: " + value.why()),
          .json = {{"values", Json::array({{{"name", expression->text()}, {"value", value ? Json(number) : Json()}}})}}};
}

Reply expect(Session& session, const Words& arguments) {
  if (arguments.empty()) return wrong(expects("expect", "what must hold, for example: expect VW20 = 5 and M0.1"));
  const auto expression = Expression::parse(joined(arguments), session.program());
  if (!expression) return wrong(expression.why());
  const auto value = expression->value(session.cpu(), Expression::SeenBy::Outside);
  for (const Place& place : expression->places()) note_looked_at(session, place);
  if (value && value->truth()) return {};
  session.expectation_failed = true;
  session.failed = {session.focus(), session.history.now(), {}};
  for (const Place& place : expression->places())
    if (const auto range = range_now(place, session.cpu())) session.failed.memory.push_back(*range);
  std::string found = expression->places_text(session.cpu(), Expression::SeenBy::Outside);
  if (!value && found.find(value.why()) == std::string::npos)
    found += fmt::format("{}{}", found.empty() ? "" : "; ", value.why());
  return wrong(
      fmt::format("expected {}, which does not hold here{}{}", expression->text(), found.empty() ? "" : ": ", found));
}

Reply display(Session& session, const Words& arguments) {
  if (arguments.size() == 1 && stl::lower_case(arguments[0]) == "off") {
    session.displayed.clear();
    return {};
  }
  std::vector<NamedRange> added;
  if (const std::string why = ranges_of(session, arguments, "display", added); !why.empty()) return wrong(why);
  for (const NamedRange& one : added) session.displayed.push_back({session.focus(), one.range});
  if (session.displayed.empty()) session.said << "nothing is displayed; 'display VW100' adds to it\n";
  for (const auto& [station, range] : session.displayed)
    session.said << session.said_of(station) << memory_text(session, station, range);
  return {};
}

}  // namespace s7200::tools::commands
