#include "tools/session/stops/stop_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "interpreter/base/text/text.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

std::string time_text(const Cpu& cpu, Time now, const InstructionRecord*) {
  return moment_text(std::max(cpu.state().time, now));
}

std::string scan_text(const Cpu& cpu, Time, const InstructionRecord*) { return fmt::format("{}", cpu.state().scans + 1); }

std::string line_text(const Cpu& cpu, Time, const InstructionRecord* by) {
  const auto op = by ? std::optional(by->op) : standing_at(cpu.state());
  return op ? line_number(cpu.program().statement(*op).position.line, cpu.program()) : "-";
}

std::string event_text(const Cpu& cpu, Time, const InstructionRecord*) {
  return cpu.state().in_interrupt ? fmt::format("{}", cpu.state().serving_event) : "-";
}

/// Of a message, besides expressions.
struct MessageWord {
  std::string_view word;
  std::string (*text)(const Cpu& cpu, Time now, const InstructionRecord* by);
};
constexpr MessageWord kWords[] = {{"time", time_text}, {"scan", scan_text}, {"line", line_text}, {"event", event_text}};

/// Null: it is none.
const MessageWord* find_word(std::string_view word) {
  const auto found = std::ranges::find(kWords, word, &MessageWord::word);
  return found == std::end(kWords) ? nullptr : found;
}

/// Of an address with a count, as `watch` says it; nothing of anything else.
std::optional<std::string> several_at(std::string_view text, const Cpu& cpu) {
  const auto place = parse_place(text, cpu.program());
  const auto range = place ? range_now(*place, cpu) : std::nullopt;
  if (!range || range->count == 1) return {};
  return value_text(cpu.program(), *range, range->bytes_in(cpu.state().image));
}

/// Each piece of text outside braces, and of those inside.
void split(const std::string& text, const std::function<void(std::string_view)>& outside,
           const std::function<void(std::string_view)>& inside) {
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t open = std::min(rest.find('{'), rest.size());
    const std::size_t close = rest.find('}', open);
    if (close == std::string_view::npos) return outside(rest);
    outside(rest.substr(0, open));
    inside(rest.substr(open + 1, close - open - 1));
    rest.remove_prefix(close + 1);
  }
}

}  // namespace

std::string filled_in(const std::string& text, const Cpu& cpu, Time now, const InstructionRecord* by) {
  std::string filled;
  split(
      text, [&](std::string_view part) { filled += part; },
      [&](std::string_view part) {
        if (const MessageWord* const word = find_word(part)) {
          filled += word->text(cpu, now, by);
          return;
        }
        const auto several = several_at(part, cpu);
        const auto expression = several ? std::nullopt : Expression::parse(part, cpu.program());
        const auto value = expression ? expression->value(cpu) : std::nullopt;
        filled += several ? *several : value ? number_text(*value) : expression ? "?" : fmt::format("{{{}}}", part);
      });
  return filled;
}

Result<> check_message(const std::string& text, const Program& program) {
  Result<> good;
  split(
      text, [](std::string_view) {},
      [&](std::string_view part) {
        if (find_word(part)) return;
        if (good)
          if (const auto expression = Expression::parse(part, program); !expression) good = expression.trouble();
      });
  const std::size_t open = text.rfind('{');
  if (good && open != std::string::npos && text.find('}', open) == std::string::npos)
    return trouble("'{}', column {}: the closing }} is missing", stl::shortened(text), open + 1);
  return good;
}

}  // namespace s7200::tools
