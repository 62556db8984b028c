#include "tools/debugger/stop_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "interpreter/base/text.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools {
namespace {

std::optional<std::string> word_text(std::string_view word, const Cpu& cpu, Time now, const InstructionRecord* by) {
  const State& state = cpu.state();
  if (word == "time") return moment_text(std::max(state.time, now));
  if (word == "scan") return fmt::format("{}", state.scans + 1);
  if (word == "line") {
    const auto op = by ? std::optional(by->op) : standing_at(state);
    return op ? fmt::format("{}", cpu.program().statement(*op).position.line) : "-";
  }
  if (word == "event") return state.in_interrupt ? fmt::format("{}", state.serving_event) : "-";
  return {};
}

/// Of an address with a count, as `watch` says it; nothing of anything else.
std::optional<std::string> several_at(std::string_view text, const Cpu& cpu) {
  std::string why;
  const auto place = parse_place(text, cpu.program(), why);
  const auto range = place ? range_now(*place, cpu) : std::nullopt;
  if (!range || range->count == 1) return {};
  return value_text(cpu.program(), *range, range->bytes_in(cpu.state().image));
}

constexpr std::string_view kWords[] = {"time", "scan", "line", "event"};

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
        std::string why;
        const auto word = word_text(part, cpu, now, by);
        const auto several = word ? word : several_at(part, cpu);
        const auto expression = several ? std::nullopt : Expression::parse(part, cpu.program(), why);
        const auto value = expression ? expression->value(cpu, why) : std::nullopt;
        filled += several ? *several : value ? number_text(*value) : expression ? "?" : fmt::format("{{{}}}", part);
      });
  return filled;
}

bool check_message(const std::string& text, const Program& program, std::string& why) {
  bool good = true;
  split(
      text, [](std::string_view) {},
      [&](std::string_view part) {
        for (const std::string_view word : kWords)
          if (part == word) return;
        good = good && Expression::parse(part, program, why).has_value();
      });
  const std::size_t open = text.rfind('{');
  if (good && open != std::string::npos && text.find('}', open) == std::string::npos)
    why = fmt::format("'{}', column {}: the closing }} is missing", stl::shortened(text), open + 1);
  return good && why.empty();
}

}  // namespace s7200::tools
