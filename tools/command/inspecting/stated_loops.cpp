#include "tools/command/inspecting/stated_loops.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/among.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"

namespace s7200::tools {
namespace {

std::vector<std::uint32_t> loops_of(const Program& program) {
  std::vector<std::uint32_t> loops;
  for (std::uint32_t op = 0; op < program.ops.size(); ++op)
    if (is_loop(program, op)) loops.push_back(op);
  return loops;
}

std::size_t line_of(const Program& program, std::uint32_t op) { return program.statement(op).position.line; }

std::string lines_text(const Program& program) {
  const auto loops = loops_of(program);
  if (loops.empty()) return "the program has no loops";
  return fmt::format("there are loops in lines {}",
                     stl::joined(loops, [&](std::uint32_t op) { return std::to_string(line_of(program, op)); }));
}

}  // namespace

Result<StatedLoops> stated_loops(const Program& program, std::string_view view, const std::vector<std::string>& texts) {
  StatedLoops stated;
  if (!texts.empty() && !is_among(view, {"bounds", "document"}))
    return Trouble{"--loop is for the views bounds and document"};
  for (const std::string& text : texts) {
    const std::size_t sign = std::min(text.find('='), text.size());
    const auto line = parse_decimal<std::size_t>(std::string_view(text).substr(0, sign));
    const auto times = parse_decimal<std::int64_t>(std::string_view(text).substr(std::min(sign + 1, text.size())));
    if (!line || !times || *times < 1)
      return trouble("--loop {}: it takes the line of a loop and how often it runs at most, for example --loop 445=8",
                     stl::shortened(text));
    const auto loops = loops_of(program);
    const auto found = std::ranges::find(loops, *line, [&](std::uint32_t op) { return line_of(program, op); });
    if (found == loops.end())
      return trouble("--loop {}: no FOR and no JMP back is in line {}; {}", stl::shortened(text), *line,
                     lines_text(program));
    stated[*found] = *times;
  }
  return stated;
}

}  // namespace s7200::tools
