// A program on the simulated line, for tests: load, send frames, look at its memory.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "interpreter/analysis/warnings/check.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/peers/quiet_time.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tests/support/source_path.hpp"
#include "tools/host/files/files.hpp"

namespace s7200::test {

/// The text of a file as UTF-8; empty, and the test fails, when it cannot be read.
inline std::string text_of(const std::string& path) {
  auto bytes = tools::read_file(path);
  EXPECT_TRUE(bytes) << path << ": " << bytes.why();
  return bytes ? *bytes : std::string{};
}

/// The text with every `from` changed to `to`; the test fails when there is none.
inline std::string changed(std::string text, std::string_view from, std::string_view to) {
  std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "no '" << from << "' in the program";
  for (; at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
  return text;
}

/// A checked program, for the CPU that its first line names or the 214; null, and the test fails, when the text has errors.
inline std::shared_ptr<const Program> compile(const std::string& text) {
  const CpuModel& model = *find_cpu(cpu_named_in(text));
  CheckResult result = check_text(text, "test", model, default_times(model));
  for (const stl::Diagnostic& diagnostic : result.diagnostics)
    ADD_FAILURE() << stl::render(diagnostic, result.source, false);
  return result.program;
}

inline std::string slave_text() { return text_of(source_path("stl_programs/modbus_slave.stl")); }

/// A Modbus slave's setting for a baud rate: SMB30 with even parity, SMB34.
struct RateSetting {
  std::uint32_t baud;
  const char* port_control;
  const char* quiet_ms;
};

inline constexpr std::array<RateSetting, 7> kRateSettings{{{300, "16#5D", "166"},
                                                           {600, "16#59", "84"},
                                                           {1200, "16#55", "43"},
                                                           {2400, "16#51", "22"},
                                                           {4800, "16#4D", "12"},
                                                           {9600, "16#49", "6"},
                                                           {19200, "16#45", "5"}}};
inline constexpr RateSetting k38400{38400, "16#41", "5"};

/// The text of a slave that is set to 9600 baud, set to another rate.
inline std::string at_rate(const std::string& text, const RateSetting& rate) {
  return changed(changed(text, "MOVB    16#49, SMB30", std::string("MOVB ") + rate.port_control + ", SMB30"),
                 "MOVB    6, SMB34", std::string("MOVB ") + rate.quiet_ms + ", SMB34");
}

/// Counts what happened; with `instructions`, sees every one of them too.
struct CountingSink : TraceSink {
  explicit CountingSink(bool every_instruction = false) : instructions_wanted(every_instruction) {}
  void record(const TraceRecord& record) override {
    ++count[static_cast<std::size_t>(record.kind)];
    last[static_cast<std::size_t>(record.kind)] = record;
  }
  void instruction(const InstructionRecord&) override { ++instructions; }
  bool wants_instructions() const override { return instructions_wanted; }
  std::uint64_t of(TraceKind kind) const { return count[static_cast<std::size_t>(kind)]; }
  const TraceRecord& last_of(TraceKind kind) const { return last[static_cast<std::size_t>(kind)]; }

  bool instructions_wanted;
  std::uint64_t instructions = 0;
  std::array<std::uint64_t, 32> count{};
  std::array<TraceRecord, 32> last{};
};

class SlaveBench {
 public:
  explicit SlaveBench(std::shared_ptr<const Program> program) : simulation_(std::move(program)) {}
  explicit SlaveBench(const std::string& text) : SlaveBench(compile(text)) {}

  serial::Simulation& simulation() { return simulation_; }
  Cpu& cpu() { return simulation_.cpu(); }
  const State& state() const { return simulation_.cpu().state(); }
  SerialFormat format() const { return state().port[0].format; }

  /// Powers up and runs until a master may begin. `content`: of all V memory before the first scan.
  void start(std::uint8_t content = 0) {
    simulation_.power_up();
    cpu().poke(image::kV, Bytes(4096, content));
    constexpr SerialFormat kSlowest{300, 8, Parity::Even, 1};
    ASSERT_TRUE(simulation_.run_until_ready(serial::default_quiet(kSlowest), 10 * kSecond));
    simulation_.configure_master(format());
  }

  void run_for(Time time) { simulation_.run_until(simulation_.time() + time); }

  /// Sends a frame as it is; back when the exchange is over, 3.5 characters after the answer.
  const serial::Exchange& send(const serial::Request& request) {
    simulation_.master().start(request, simulation_.time());
    return simulation_.finish_exchange();
  }

  /// The bytes of the answer to a raw frame, none when nothing came; then quiet.
  Bytes raw(const serial::Frame& frame) {
    last_ = send({.frame = frame, .timeout = kTimeout});
    run_for(serial::default_quiet(format()));
    EXPECT_FALSE(last_.parity_error() || last_.framing_error() || last_.too_long);
    return last_.response_bytes();
  }

  /// Answer without its CRC, which must be right.
  Bytes ask(std::span<const std::uint8_t> pdu, std::uint8_t station = 1) {
    Bytes answer = raw(serial::to_frame(modbus::rtu_frame(station, pdu)));
    if (answer.empty()) return answer;
    EXPECT_TRUE(modbus::crc_ok(answer)) << serial::to_hex(answer);
    answer.resize(answer.size() - 2);
    return answer;
  }

  /// The same from hex to hex: station and PDU, no CRC; `-` when no answer came.
  std::string ask(const std::string& hex) {
    const Bytes frame = serial::bytes_of(serial::parse_hex_frame(hex).frame);
    const Bytes answer = ask(std::span(frame).subspan(1), frame[0]);
    return answer.empty() ? "-" : serial::to_hex(answer);
  }

  /// Raw hex, nothing appended, `p` for wrong parity; the whole answer or `-`.
  std::string ask_raw(const std::string& hex) {
    const Bytes answer = raw(serial::parse_hex_frame(hex).frame);
    return answer.empty() ? "-" : serial::to_hex(answer);
  }

  const serial::Exchange& last() const { return last_; }

  std::uint8_t vb(std::uint32_t at) const { return state().image[image::kV + at]; }
  std::uint16_t vw(std::uint32_t at) const { return load16(&state().image[image::kV + at]); }
  std::uint8_t qb(std::uint32_t at) const { return state().image[image::kQ + at]; }
  void set_vw(std::uint32_t at, std::uint16_t value) {
    const std::array<std::uint8_t, 2> bytes{static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value & 0xFF)};
    cpu().poke(image::kV + at, bytes);
  }
  void set_vb(std::uint32_t at, std::uint8_t value) { cpu().poke(image::kV + at, std::span(&value, 1)); }
  void set_qb(std::uint32_t at, std::uint8_t value) { cpu().poke(image::kQ + at, std::span(&value, 1)); }

  void set_input(std::uint32_t byte, std::uint8_t value) { cpu().set_input(byte, value, simulation_.time()); }

  static constexpr Time kTimeout = 2 * kSecond;

 private:
  serial::Simulation simulation_;
  serial::Exchange last_;
};

}  // namespace s7200::test
