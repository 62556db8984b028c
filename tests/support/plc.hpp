// A CPU, 214 unless another is named, with a tiny program and easy times, for tests of what happens when.
//
// Every instruction takes 10 us, with or without power flow; labels and routine heads take no time. Exceptions, to fill
// time: SQRT takes 5 ms, DIV 100 ms. Entering an interrupt routine takes 40 us, saving a value to EEPROM 10 ms. Each of the
// four system parts of a scan takes 200 us. So a program of n instructions starts 200 us into its scan, and the scan takes
// 800 us + n * 10 us.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/cpu/cpu.hpp"
#include "interpreter/program/operands/address.hpp"

namespace s7200::test {

inline constexpr Time us = kMicrosecond, ms = kMillisecond;

// In the order of one instant, as in a system (serial_sim/system/dispatcher.hpp).
inline constexpr EventOwner kPlcUart{0}, kCpu{1}, kField{2};

inline TimeTable easy_times() {
  std::string csv =
      "mnemonic,form,base_us,per_unit_us,unit,marker\nLBL SBR INT,,0,,,manual\nSQRT,,5000,,,manual\nDIV,,100000,,,manual\n"
      "(interrupt entry),,40,,,manual\n(scan overhead),,800,,,manual\n(no power flow),,10,,,manual\n"
      "(indirect operand),,10,,,manual\n(EEPROM save),,10000,,,manual\n";
  for (const Instruction& instruction : all_instructions())
    if (instruction.modelled()) csv += fmt::format("{},,10,,,manual\n", instruction.mnemonic);
  TimeTable times;
  const auto errors = times.add(csv, "easy");
  EXPECT_TRUE(errors.empty()) << errors[0];
  return times;
}

inline std::shared_ptr<const Program> program_of(std::string_view stl, const CpuModel& model = cpu214()) {
  static const TimeTable kTimes = easy_times();
  const CheckResult result = check_text(stl, "test.stl", model, kTimes);
  for (const auto& diagnostic : result.diagnostics)
    if (diagnostic.severity == stl::Severity::Error) ADD_FAILURE() << stl::render(diagnostic, result.source, false);
  return result.program;
}

/// Sends at the speed of the line and records its calls.
class Port final : public SerialPort {
 public:
  struct Sent {
    std::uint8_t byte;
    Time at;
    bool operator==(const Sent&) const = default;
  };

  explicit Port(EventQueue& queue, std::uint8_t number = 0) : queue_(queue), number_(number) {}
  void configure(const SerialFormat& to, Time at) override {
    format = to;
    configured_at = at;
  }
  void enable_receiver(bool enabled, Time at) override {
    if (enabled != receiver) switched_at = at;
    receiver = enabled;
  }
  void send(std::uint8_t byte, Time at) override {
    sent.push_back({byte, at});
    queue_.schedule(at + format.character_time(), kPlcUart, number_);
  }
  void send_break(int bits, Time at) override {
    break_bits = bits;
    queue_.schedule(at + format.bit_times(bits), kPlcUart, number_);
  }

  SerialFormat format{};
  bool receiver = false;
  Time switched_at = 0, configured_at = 0;
  int break_bits = 0;
  std::vector<Sent> sent;

 private:
  EventQueue& queue_;
  std::uint8_t number_;
};

class Records final : public TraceSink {
 public:
  void record(const TraceRecord& record) override {
    if (scans || record.kind != TraceKind::ScanBegin) all.push_back(record);
  }
  bool wants_scans() const override { return scans; }

  std::vector<TraceRecord> of(TraceKind kind) const {
    std::vector<TraceRecord> found;
    std::copy_if(all.begin(), all.end(), std::back_inserter(found), [&](const TraceRecord& r) { return r.kind == kind; });
    return found;
  }
  std::vector<Time> times(TraceKind kind) const {
    std::vector<Time> times;
    for (const TraceRecord& r : of(kind)) times.push_back(r.at);
    return times;
  }
  std::vector<int> events(TraceKind kind) const {
    std::vector<int> events;
    for (const TraceRecord& r : of(kind)) events.push_back(r.event);
    return events;
  }
  std::vector<int> errors() const {
    std::vector<int> codes;
    for (const TraceRecord& r : of(TraceKind::RuntimeError)) codes.push_back(r.code);
    return codes;
  }

  std::vector<TraceRecord> all;
  bool scans = false;  ///< whether it wants the begin of each
};

class Plc {
 public:
  explicit Plc(std::string_view stl, const RetentiveMemory* memory = nullptr, const CpuModel& model = cpu214())
      : Plc(program_of(stl, model), memory) {}
  explicit Plc(std::shared_ptr<const Program> program, const RetentiveMemory* memory = nullptr)
      : cpu(std::move(program), queue, kCpu, {&port, &port1}) {
    cpu.set_sink(&records);
    cpu.power_up(true, memory);
  }
  Plc(std::string_view stl, const CpuModel& model) : Plc(stl, nullptr, model) {}
  Plc(const Plc&) = delete;

  /// Something that happens outside at an instant. Must be added in the order of time.
  void at(Time when, std::function<void()> what) {
    actions_.push_back({when, std::move(what)});
    if (actions_.size() - next_ == 1) queue.schedule(when, kField, 0);
  }
  void input_at(Time when, std::string_view point, bool level) {
    at(when, [this, when, point = std::string(point), level] { input(point, level, when); });
  }
  void character_at(Time when, std::uint8_t byte, bool parity_error = false) {
    received_at({.byte = byte, .parity_error = parity_error, .start = when, .end = when});
  }
  void received_at(const ReceivedCharacter& character, std::uint8_t on_port = 0) {
    at(character.end, [=, this] { cpu.character_received(character, on_port); });
  }

  void input(std::string_view point, bool level, Time when) {
    const MemoryRange range = place(point);
    const std::uint8_t before = cpu.state().image[image::kInputs + range.number];
    const auto mask = static_cast<std::uint8_t>(1u << range.bit);
    cpu.set_input(range.number, static_cast<std::uint8_t>(level ? before | mask : before & ~mask), when);
  }
  void input(std::string_view point, bool level) { input(point, level, cpu.time()); }
  void pulse(std::string_view point, int times = 1) {
    for (int i = 0; i < times; ++i) {
      input(point, true);
      input(point, false);
    }
  }

  void run_until(Time end) {
    while (cpu.time() < end) {
      cpu.run(end);
      while (queue.next() <= cpu.time()) dispatch(queue.pop());
    }
  }
  /// From power-up.
  void run_scans(std::uint64_t count) {
    cpu.pause_at_scan_end(true);
    while (cpu.state().scans < count && cpu.state().mode == Mode::Run) {
      cpu.run(kNever);
      while (queue.next() <= cpu.time()) dispatch(queue.pop());
    }
    cpu.pause_at_scan_end(false);
  }

  MemoryRange place(std::string_view address) const {
    const auto range = parse_range(address, *cpu.program().model);
    EXPECT_TRUE(range) << range.why();
    return range.value_or(MemoryRange{});
  }
  std::int64_t value(std::string_view address) const {
    const MemoryRange range = place(address);
    const std::uint8_t* from = &cpu.state().image[range.at];
    switch (range.width) {
      case Width::Bit: {
        const bool element = range.area == Area::T || range.area == Area::C;
        return element ? -1 : *from >> range.bit & 1;
      }
      case Width::Byte:
        return *from;
      case Width::Word:
        return static_cast<std::int16_t>(load16(from));
      case Width::Double:
        return static_cast<std::int32_t>(load32(from));
    }
    return 0;
  }
  void set(std::string_view address, std::uint32_t value_to_set) {
    const MemoryRange range = place(address);
    if (range.width == Width::Bit) {
      const auto others = static_cast<std::uint8_t>(cpu.state().image[range.at] & ~(1U << range.bit));
      value_to_set = others | value_to_set << range.bit;
    }
    std::array<std::uint8_t, 4> bytes{};
    store32(bytes.data(), value_to_set);
    cpu.poke(range.at, {bytes.data() + 4 - bytes_of(range.width), bytes_of(range.width)});
  }
  bool stopped() const { return cpu.state().mode == Mode::Stop; }

  EventQueue queue;
  Port port{queue}, port1{queue, 1};
  Records records;
  Cpu cpu;

 private:
  struct Action {
    Time when;
    std::function<void()> what;
  };

  void dispatch(const Event& event) {
    if (event.owner == kCpu) return cpu.handle(event);
    if (event.owner == kPlcUart) return cpu.character_sent(event.at, event.what);
    const Action action = actions_[next_++];
    action.what();
    if (next_ < actions_.size()) queue.schedule(actions_[next_].when, kField, 0);
  }

  std::vector<Action> actions_;
  std::size_t next_ = 0;
};

using Times = std::vector<Time>;
using Ints = std::vector<int>;

}  // namespace s7200::test
