#include "tools/scenario/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "interpreter/base/text.hpp"
#include "tools/scenario/bytes_diff.hpp"
#include "tools/scenario/steps/reception.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

constexpr const char* kIndent = "    ";

std::vector<BytePattern> pattern_of(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

bool same_answer(const serial::Exchange& a, const serial::Exchange& b) {
  return a.response_bytes() == b.response_bytes() && a.parity_error() == b.parity_error() &&
         a.framing_error() == b.framing_error();
}

bool same_time(const serial::Exchange& a, const serial::Exchange& b, Time tolerance) {
  const auto one = a.latency(), other = b.latency();
  return !one || !other || std::abs(*one - *other) <= tolerance;
}

std::string came_text(const serial::Exchange& exchange) {
  const Bytes response = exchange.response_bytes();
  const Bytes request = serial::bytes_of(exchange.request);
  if (response.empty()) return request.empty() ? "nothing" : "no answer";
  const std::string says = answer_text(request, response);
  const Time latency = *exchange.latency();
  const std::string when =
      latency >= 0 ? "after " + format_duration(latency, 6) : format_duration(-latency, 6) + " before it was waited for";
  return says.empty() ? when : fmt::format("{} {}", says, when);
}

/// Side by side, from the request on.
std::string exchange_text(const Scenario& scenario, const Seen& one, const Seen& other, const std::string& one_name,
                          const std::string& other_name, bool colour) {
  const std::size_t width = std::max({one_name.size(), other_name.size(), std::size_t{9}});
  const Step& step = scenario.steps[one.step];
  const std::string place =
      step.position.line ? fmt::format(", {}:{}", stl::printable(scenario.source->name), step.position.line) : "";
  const std::string turn = step.loop.empty() ? "" : fmt::format(" (with {})", stl::printable(step.loop));
  const auto before = std::count_if(scenario.steps.begin(), scenario.steps.begin() + static_cast<std::ptrdiff_t>(one.step),
                                    [](const Step& s) { return reception_of(s) != nullptr; });
  const std::size_t number = static_cast<std::size_t>(before) + one.turn + 1;
  std::string text = fmt::format("{}exchange {}{}{}\n", kIndent, number, place, turn);
  const bool asked = !one.exchange.request.empty();
  text += fmt::format("{}{:<{}} {}\n", kIndent, "request", width,
                      asked ? serial::to_hex(one.exchange.request) : "none: a transmission that no one asked for");
  if (!same_answer(one.exchange, other.exchange))
    text += bytes_diff(pattern_of(one.exchange.response_bytes()), pattern_of(other.exchange.response_bytes()), kIndent,
                       colour, one_name, other_name);
  text += fmt::format("{}{:<{}} {}\n", kIndent, one_name, width, came_text(one.exchange));
  text += fmt::format("{}{:<{}} {}\n", kIndent, other_name, width, came_text(other.exchange));
  return text;
}

/// What both were asked in the same step.
struct Pair {
  const Seen* one;
  const Seen* other;
};

std::vector<Pair> pairs_of(const ScenarioResult& one, const ScenarioResult& other) {
  std::vector<Pair> pairs;
  const auto place = [](const Seen& seen) { return std::pair(seen.step, seen.turn); };
  auto next = other.seen.begin();
  for (const Seen& seen : one.seen) {
    while (next != other.seen.end() && place(*next) < place(seen)) ++next;
    if (next != other.seen.end() && place(*next) == place(seen)) pairs.push_back({&seen, &*next});
  }
  return pairs;
}

/// What kept a side from being asked.
std::string trouble_text(const Scenario& scenario, const ScenarioResult& result, const std::string& name) {
  std::size_t count = 0;
  std::string text;
  for (const Finding& finding : result.findings) {
    if (!finding.of_run || ++count > 1) continue;
    const std::uint32_t line = position_of(scenario, finding).line;
    text = fmt::format("{}{} could not be asked{}: {}\n", kIndent, name,
                       line ? fmt::format(", {}:{}", stl::printable(scenario.source->name), line) : "",
                       stl::printable(finding_line(scenario, finding)));
  }
  if (count > 1) text += fmt::format("{}and {} more\n", kIndent, count - 1);
  return text;
}

}  // namespace

Difference compare(const Scenario& scenario, const ScenarioResult& one, const ScenarioResult& other,
                   const std::string& one_name, const std::string& other_name, const Comparison& comparison, bool colour) {
  Difference difference;
  const std::vector<Pair> pairs = pairs_of(one, other);
  std::size_t answer = 0, time = pairs.size();
  while (answer < pairs.size() && same_answer(pairs[answer].one->exchange, pairs[answer].other->exchange)) ++answer;
  if (comparison.timing) {
    time = 0;
    while (time < pairs.size() && same_time(pairs[time].one->exchange, pairs[time].other->exchange, comparison.tolerance))
      ++time;
  }
  const auto show = [&](std::string_view heading, std::size_t i) {
    difference.found = true;
    difference.text += fmt::format("{}{}\n", kIndent, heading);
    difference.text += exchange_text(scenario, *pairs[i].one, *pairs[i].other, one_name, other_name, colour);
  };
  if (time < answer) show("the first different time", time);
  if (answer < pairs.size()) show("the first different answer", answer);
  const std::string trouble = trouble_text(scenario, one, one_name) + trouble_text(scenario, other, other_name);
  if (!trouble.empty()) difference.found = true;
  difference.text += trouble;
  return difference;
}

}  // namespace s7200::tools
