#include "tools/calibration/measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/host/interruption.hpp"

namespace s7200::tools {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kAnswer = 11;

/// Within one turn of the outer loop: far from the watchdog's 300 ms even if a CPU is twice as slow as expected.
constexpr double kInnerNs = 60e6;

/// The run begins at a tick of the timer, found by a loop of half a millisecond at most, and ends between two ticks.
constexpr double kWithinNs = 1.5e6;

/// Longer than any run: 32767 ms.
constexpr Time kTimeout = 40 * kSecond;

std::uint16_t word(const Bytes& bytes, std::size_t at) { return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]); }

Measured ask(Slave& slave, const Command& command) {
  const auto high = [](std::uint16_t value) { return static_cast<std::uint8_t>(value >> 8); };
  const auto low = [](std::uint16_t value) { return static_cast<std::uint8_t>(value & 0xFF); };
  const Bytes request{0x6D, command.loop, high(command.outer), low(command.outer), high(command.inner), low(command.inner)};
  constexpr int kAttempts = 3;
  for (int attempt = 0; attempt < kAttempts && !interrupted(); ++attempt) {
    const serial::Exchange exchange = slave.exchange({.frame = serial::to_frame(request), .timeout = kTimeout});
    slave.wait(slave.pause());
    const Bytes answer = exchange.response_bytes();
    if (answer.size() != kAnswer || !exchange.damage().empty() || answer[0] != 0x4D ||
        !std::equal(request.begin() + 1, request.end(), answer.begin() + 1))
      continue;
    if (answer[9] != kVersion)
      throw std::runtime_error(
          fmt::format("the CPU runs version {} of measure_times.stl, this command knows version {}: download that one",
                      answer[9], kVersion));
    return {word(answer, 6), answer[8], answer[9], answer[10]};
  }
  if (interrupted()) throw std::runtime_error("interrupted");
  throw std::runtime_error("no answer from measure_times.stl");
}

}  // namespace

std::size_t measured_loops(const Program& program) {
  return static_cast<std::size_t>(std::ranges::count_if(program.statements, [](const stl::Statement& statement) {
    if (statement.mnemonic != "FOR") return false;
    const auto* counter = std::get_if<stl::Address>(&statement.operands[0].value);
    return counter != nullptr && counter->number == 10;
  }));
}

Measurement measure_loops(Slave& slave, std::size_t loops, Time each, const std::function<void(std::size_t)>& progress) {
  const auto outer = static_cast<std::uint16_t>(std::max(1.0, static_cast<double>(each) / kInnerNs));
  const auto in_ns = [](const Measured& measured) { return measured.milliseconds * 1e6; };
  const Measured nothing = ask(slave, {.outer = outer});
  if (nothing.loops != loops)
    throw std::runtime_error(
        fmt::format("the CPU's program has {} loops, this command knows {}: download its own", nothing.loops, loops));
  Measurement measurement{nothing.identification, {}};
  for (std::size_t i = 0; i < loops; ++i) {
    // A first look with few repetitions says how many fit.
    const auto number = static_cast<std::uint8_t>(i);
    constexpr std::uint16_t kFew = 8;
    const double few = in_ns(ask(slave, {number, outer, kFew})) - in_ns(nothing);
    const double once = std::max(few + kWithinNs, kWithinNs) / (outer * kFew);
    const auto inner = static_cast<std::uint16_t>(std::clamp(kInnerNs / once, 1.0, 30'000.0));
    const Measured run = ask(slave, {number, outer, inner});
    const double repetitions = static_cast<double>(outer) * inner;
    measurement.loops.push_back({(in_ns(run) - in_ns(nothing)) / repetitions, kWithinNs / repetitions});
    progress(i + 1);
  }
  return measurement;
}

}  // namespace s7200::tools
