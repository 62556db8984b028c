#include "tools/scenario/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "interpreter/base/text.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tools/scenario/bytes_diff.hpp"
#include "tools/scenario/steps/exchange.hpp"
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
  std::string text = fmt::format("{}exchange {}{}{}\n", kIndent, before + 1, place, turn);
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
  auto next = other.seen.begin();
  for (const Seen& seen : one.seen) {
    while (next != other.seen.end() && next->step < seen.step) ++next;
    if (next != other.seen.end() && next->step == seen.step) pairs.push_back({&seen, &*next});
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

/// Requests that are mostly fine.
class TrafficMaker {
 public:
  TrafficMaker(std::uint32_t seed, std::uint8_t station) : random_(seed), station_(station) {}

  serial::Frame next() {
    const unsigned kind = below(30);
    const std::uint8_t station = kind == 0 ? 0 : kind == 1 ? static_cast<std::uint8_t>(station_ + 1) : station_;
    Bytes frame = modbus::rtu_frame(station, damaged(pdu()));
    if (kind == 2) frame[below(static_cast<unsigned>(frame.size()))] ^= static_cast<std::uint8_t>(1U << below(8));
    if (kind == 3) frame.resize(1 + below(static_cast<unsigned>(frame.size() - 1)));
    return serial::to_frame(frame);
  }

 private:
  unsigned below(unsigned limit) { return static_cast<unsigned>(random_() % limit); }
  std::uint16_t word() { return static_cast<std::uint16_t>(random_()); }

  /// Near the begin, near a limit, or anywhere.
  std::uint16_t first() {
    static constexpr unsigned kLimits[] = {16, 64, 1000, 32768, 65535};
    const unsigned kind = below(10);
    if (kind == 0) return word();
    if (kind == 1) return static_cast<std::uint16_t>(kLimits[below(5)] - 2 + below(4));
    return static_cast<std::uint16_t>(below(kind < 6 ? 16 : 64));
  }
  std::uint16_t count(unsigned limit) {
    const unsigned kind = below(12);
    if (kind == 0) return word();
    if (kind == 1) return static_cast<std::uint16_t>(limit - 1 + below(3));
    if (kind == 2) return 0;
    return static_cast<std::uint16_t>(1 + below(20));
  }

  Bytes pdu() {
    switch (below(9)) {
      case 0:
        return modbus::read_coils(first(), count(2000));
      case 1:
        return modbus::read_inputs(first(), count(2000));
      case 2:
        return modbus::read_holding_registers(first(), count(125));
      case 3:
        return modbus::read_input_registers(first(), count(125));
      case 4: {
        Bytes coil = modbus::write_coil(first(), below(2) != 0);
        if (below(8) == 0) coil[4] = static_cast<std::uint8_t>(word());
        return coil;
      }
      case 5:
        return modbus::write_register(first(), word());
      case 6: {
        std::vector<bool> coils(1 + below(32));
        for (std::size_t i = 0; i < coils.size(); ++i) coils[i] = below(2) != 0;
        return modbus::write_coils(first(), coils);
      }
      case 7: {
        std::vector<std::uint16_t> values(below(20) == 0 ? 120 + below(4) : 1 + below(12));
        for (std::uint16_t& value : values) value = word();
        return modbus::write_registers(first(), values);
      }
      default:
        return {static_cast<std::uint8_t>(below(256)), 0, 0, 0, 1};
    }
  }

  Bytes damaged(Bytes pdu) {
    const unsigned kind = below(40);
    if (kind == 0) pdu.push_back(0);
    if (kind == 1 && pdu.size() > 1) pdu.pop_back();
    if (kind == 2 && pdu.size() > 5) pdu[5] = static_cast<std::uint8_t>(word());
    return pdu;
  }

  std::mt19937 random_;
  std::uint8_t station_;
};

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

Scenario random_traffic(std::size_t exchanges, std::uint32_t seed, std::uint8_t station) {
  Scenario scenario;
  scenario.name = fmt::format("{} random requests, seed {}", exchanges, seed);
  scenario.source = std::make_shared<stl::SourceLines>(stl::SourceLines{.name = "random traffic", .text = {}});
  scenario.line.timeout = kSecond;  // through TCP the longest frames take 0.3 s each way before an answer is seen
  TrafficMaker make(seed, station);
  for (std::size_t i = 0; i < exchanges; ++i) {
    auto exchange = std::make_shared<ExchangeStep>();
    exchange->request = make.next();
    scenario.steps.push_back({.action = std::move(exchange)});
  }
  return scenario;
}

}  // namespace s7200::tools
