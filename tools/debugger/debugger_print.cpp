// The commands print and expect: memory, what pointers point to, and expressions.
#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text.hpp"
#include "interpreter/model/ports.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/session/commands/bad_pointers.hpp"
#include "tools/session/commands/element_text.hpp"
#include "tools/session/commands/print_forms.hpp"
#include "tools/views/machine_text.hpp"
#include "tools/views/memory.hpp"

namespace s7200::tools {
namespace {

std::uint32_t object_of(const State& state, const MemoryRange& range, std::uint32_t i) {
  const std::uint32_t step = range.area == Area::AC ? 4 : s7200::bytes_of(range.width);
  const std::uint8_t* const from = &state.image[range.at + i * step];
  if (range.width == Width::Bit) return *from >> range.bit & 1;
  if (range.width == Width::Byte) return *from;
  return range.width == Width::Word ? load16(from) : load32(from);
}

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
    text +=
        fmt::format("{:<8} {}\n", range.name_of(i), form->text(object_of(cpu.state(), range, i), range.width, range.real));
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

}  // namespace

void Debugger::print_bad_pointer(const std::string& name, const MemoryRange& pointer) {
  const std::string address = name_of(pointer, pointer.name_of(0));
  out_ << bad_pointer_text(simulation().cpu(), pointer, name, address) << '\n';
  report_writer(pointer, address);
}

/// The pointers of an instruction that it could not follow.
void Debugger::print_bad_pointers(std::uint32_t number) {
  for (const MemoryRange& pointer : bad_pointers(simulation().cpu(), number))
    print_bad_pointer("*" + pointer.name_of(0), pointer);
}

/// `VW100 (Speed)`, or as it was written.
std::string Debugger::name_of(const MemoryRange& range, std::string_view written) const {
  return name_of(range, written, simulation().cpu().program());
}

std::string Debugger::name_of(const MemoryRange& range, std::string_view written, const Program& program) {
  const stl::Symbol* symbol = symbol_of(program, range);
  if (!symbol) return stl::upper_case(written);
  return fmt::format("{} ({})", range.name_of(0), stl::printable(symbol->name));
}

/// A test of this session expects it to be so again.
void Debugger::note_looked_at(const Place& place) {
  const Cpu& cpu = simulation().cpu();
  if (const auto range = range_now(place, cpu))
    looked_at_.push_back({focus(), history_.now(), *range, range->bytes_in(cpu.state().image)});
}

void Debugger::print_place(const Place& place, const std::string& name, const PrintForm* form) {
  const Cpu& cpu = simulation().cpu();
  const auto range = range_now(place, cpu);
  if (!range) {
    print_bad_pointer(name, place.range);
    return;
  }
  note_looked_at(place);
  if (place.pointer) out_ << fmt::format("{} is {}\n", name, range->name_of(0));
  out_ << range_text(cpu, *range, form);
  if (const std::string forced = forced_text(simulation().cpu(), {bits_of(*range)}); !forced.empty())
    out_ << "       " << forced << '\n';
  if (const std::string symbol = symbol_text(cpu.program(), *range); !symbol.empty()) out_ << "         " << symbol << '\n';
  out_ << elements_text(cpu, *range) << special_text(cpu, *range);
}

Debugger::Error Debugger::print(const Arguments& arguments) {
  Arguments words = arguments;
  const PrintForm* form = nullptr;
  if (!words.empty() && words[0].size() == 2 && words[0][0] == '/') {
    form = find_print_form(words[0]);
    if (!form) return expects("print", fmt::format("a form ({}), then addresses", print_forms_meanings()));
    words.erase(words.begin());
  }
  if (words.empty()) return expects("print", "addresses or an expression, for example: print VB100:16 M31.7 *AC1");
  const Program& program = simulation().cpu().program();
  std::string why;
  std::vector<Place> places;
  for (const std::string& word : words) {
    std::string wrong;
    if (const auto place = parse_place(word, program, wrong))
      places.push_back(*place);
    else if (why.empty())
      why = wrong;
  }
  if (places.size() == words.size()) {
    for (std::size_t i = 0; i < places.size(); ++i) print_place(places[i], stl::upper_case(words[i]), form);
    return {};
  }
  std::string why_no_expression;
  const auto expression = Expression::parse(joined(words), program, why_no_expression);
  if (!expression) return has_operator(words) ? why_no_expression : why;
  for (const Place& place : expression->places()) note_looked_at(place);
  const auto value = expression->value(simulation().cpu(), why);
  out_ << fmt::format("{} {}\n", stl::printable(expression->text()),
                      value ? "= " + number_text(*value, form) : "cannot be computed: " + why);
  return {};
}

Debugger::Error Debugger::expect(const Arguments& arguments) {
  std::string why;
  if (arguments.empty()) return expects("expect", "what must hold, for example: expect VW20 = 5 and M0.1");
  const auto expression = Expression::parse(joined(arguments), simulation().cpu().program(), why);
  if (!expression) return why;
  const auto value = expression->value(simulation().cpu(), why);
  for (const Place& place : expression->places()) note_looked_at(place);
  if (value && value->truth()) return {};
  expectation_failed_ = true;
  failed_ = {focus(), history_.now(), {}};
  for (const Place& place : expression->places())
    if (const auto range = range_now(place, simulation().cpu())) failed_.memory.push_back(*range);
  std::string found = expression->places_text(simulation().cpu());
  if (!value && found.find(why) == std::string::npos) found += fmt::format("{}{}", found.empty() ? "" : "; ", why);
  return fmt::format("expected {}, which does not hold here{}{}", expression->text(), found.empty() ? "" : ": ", found);
}

}  // namespace s7200::tools
