#include "tools/calibration/measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "interpreter/base/result.hpp"
#include "interpreter/base/word_bytes.hpp"

namespace s7200::tools {
namespace {

/// Within one turn of the outer loop: far from the watchdog's 300 ms even if a CPU is twice as slow as expected.
constexpr double kInnerNs = 60e6;

/// The run begins at a tick of the timer, found by a loop of half a millisecond at most, and ends between two ticks.
constexpr double kWithinNs = 1.5e6;

/// How often the program is asked, and how long it has time to answer.
struct Patience {
  int attempts;
  Time timeout;
};
/// Patience for a run: longer than any run takes (32767 ms).
constexpr Patience kForARun{3, 40 * kSecond};
/// Patience for the first answer: no loop runs, so it comes soon, unless an interrupted calibration has left a long run.
constexpr Patience kForTheFirstAnswer{14, 3 * kSecond};

/// The exclusive or of the words of `bytes`.
std::uint16_t check_of(std::span<const std::uint8_t> bytes) {
  std::uint16_t check = 0;
  for (std::size_t at = 0; at + 1 < bytes.size(); at += 2) check = static_cast<std::uint16_t>(check ^ load16(&bytes[at]));
  return check;
}

/// Whether an answer of this version is whole. Answers of the version before had no check, and fewer characters.
bool is_whole(std::span<const std::uint8_t> answer) {
  return answer.size() == measuring::kAnswerLength && answer[0] == measuring::kAnswerMark &&
         check_of(answer.subspan(1)) == 0;
}

[[noreturn]] void refuse_version(const std::string& found) {
  throw std::runtime_error(fmt::format(
      "the CPU runs {} of measure_times.stl, this command knows version {}: download that one", found, measuring::kVersion));
}

/// Asks until an answer comes; nothing once the command is interrupted. `silent` is called after each attempt that got no
/// answer.
std::optional<Measured> ask(Slave& slave, const Command& command, const Patience& patience = kForARun,
                            const std::function<void()>& silent = {}) {
  const Bytes request = command.bytes();
  bool shorter = false;
  for (int attempt = 0; attempt < patience.attempts && !slave.stop_requested(); ++attempt) {
    if (attempt > 0 && silent) silent();
    const serial::Exchange exchange = slave.exchange({.frame = serial::to_frame(request), .timeout = patience.timeout});
    slave.wait(slave.pause());
    const Bytes answer = exchange.response_bytes();
    shorter = answer.size() == measuring::kCheck && answer[0] == measuring::kAnswerMark;
    if (!exchange.damage().empty() || !is_whole(answer) ||
        !std::equal(request.begin() + 1, request.begin() + measuring::kMilliseconds, answer.begin() + 1))
      continue;
    if (answer[measuring::kVersionPlace] != measuring::kVersion)
      refuse_version(fmt::format("version {}", answer[measuring::kVersionPlace]));
    return Measured{load16(&answer[measuring::kMilliseconds]), answer[measuring::kIdentification],
                    answer[measuring::kLoops]};
  }
  if (slave.stop_requested()) return {};
  if (shorter) refuse_version("an earlier version");
  throw std::runtime_error("no answer from measure_times.stl");
}

/// Asks like ask(); trouble if the CPU is no longer there.
Result<Measured> ask_on(Slave& slave, const Command& command) {
  try {
    if (const auto measured = ask(slave, command)) return *measured;
    return std::nullopt;
  } catch (const std::runtime_error& gone) {
    return Trouble{gone.what()};
  }
}

}  // namespace

Bytes Command::bytes() const {
  Bytes bytes{measuring::kCommandMark, loop, high_byte(outer), low_byte(outer), high_byte(inner), low_byte(inner)};
  const std::uint16_t check = check_of(bytes);
  bytes.push_back(high_byte(check));
  bytes.push_back(low_byte(check));
  return bytes;
}

std::size_t measured_loops(const Program& program) {
  constexpr std::size_t kScans = 1;
  return kScans + static_cast<std::size_t>(std::ranges::count_if(program.statements, [](const stl::Statement& statement) {
           if (statement.mnemonic != "FOR") return false;
           const auto* counter = std::get_if<stl::Address>(&statement.operands[0].value);
           return counter != nullptr && counter->number == measuring::kCounterAt;
         }));
}

Measurement measure_loops(Slave& slave, std::size_t loops, Time each, const MeasurementListener& listener) {
  const auto outer = static_cast<std::uint16_t>(std::max(1.0, static_cast<double>(each) / kInnerNs));
  const auto in_ns = [](const Measured& measured) { return measured.milliseconds * 1e6; };
  const auto nothing = ask(slave, {.outer = outer}, kForTheFirstAnswer, listener.silent);
  if (!nothing) return {};
  if (nothing->loops != loops)
    throw std::runtime_error(
        fmt::format("the CPU's program has {} loops, this command knows {}: download its own", nothing->loops, loops));
  listener.answered(nothing->identification);
  Measurement measurement{.identification = nothing->identification};
  for (std::size_t i = 0; i < loops; ++i) {
    // A first look with few repetitions says how many fit.
    const auto number = static_cast<std::uint8_t>(i);
    constexpr std::uint16_t kFew = 8;
    const auto look = ask_on(slave, {number, outer, kFew});
    measurement.broken_off = look.why();
    if (!look) break;
    const double few = in_ns(*look) - in_ns(*nothing);
    const double once = std::max(few + kWithinNs, kWithinNs) / (outer * kFew);
    const auto inner = static_cast<std::uint16_t>(std::clamp(kInnerNs / once, 1.0, 30'000.0));
    const auto run = ask_on(slave, {number, outer, inner});
    measurement.broken_off = run.why();
    if (!run) break;
    const double repetitions = static_cast<double>(outer) * inner;
    measurement.loops.push_back(
        {(in_ns(*run) - in_ns(*nothing)) / repetitions, kWithinNs / repetitions, in_ns(*run) / repetitions});
    listener.measured(i + 1);
  }
  return measurement;
}

}  // namespace s7200::tools
