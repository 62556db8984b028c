// Whatever comes in on the line of the running slave: it stays in RUN, its answers carry its address and a right CRC, and
// after a quiet line a good request is answered. The input is read as a list of frames and faults; a fault that comes as
// text goes through parse_fault. S7200_FUZZ_PROGRAM names another slave than ours.
#include <cstdlib>
#include <string>

#include "serial_sim/modbus/request.hpp"
#include "tests/fuzz/slave.hpp"
#include "tests/support/source_path.hpp"

namespace s7200 {
namespace {

using serial::Fault;
using serial::FaultKind;

constexpr std::uint8_t kStation = 1;
constexpr Time kLongest = 100 * kMillisecond;  // of a gap, a break …: what goes beyond only takes time

/// What the slave sends, answer by answer.
class Answers final : public TraceSink {
 public:
  void record(const TraceRecord& r) override {
    if (r.kind == TraceKind::Transmit) sent_.clear();
    if (r.kind == TraceKind::CharacterSent) sent_.push_back(r.byte);
    if (r.kind == TraceKind::CharacterSent || r.kind == TraceKind::CharacterReceived) last_character = r.at;
    if (r.kind != TraceKind::TransmitEnd) return;
    require(modbus::crc_ok(sent_), "an answer has a right CRC");
    require(sent_[0] == kStation, "an answer has the slave's address");
    last = sent_;
  }

  Bytes last;
  Time last_character = 0;

 private:
  Bytes sent_;
};

class Slave {
 public:
  Slave() : simulation_(program()) {
    simulation_.cpu().set_sink(&answers_);
    get_ready(simulation_);
    ready_ = simulation_.snapshot();
  }

  void run(Input input) {
    simulation_.restore(ready_);
    answers_ = {};
    for (int i = 0; i < 24 && !input.empty(); ++i) step(input);
    simulation_.clear_faults();
    become_quiet();
    check_good_request();
  }

 private:
  static std::shared_ptr<const Program> program() {
    const char* const named = std::getenv("S7200_FUZZ_PROGRAM");
    const std::string path = named ? named : test::source_path("stl_programs/modbus_slave.stl");
    return program_at(path, "214");
  }

  void step(Input& input) {
    switch (input.byte() % 5) {
      case 0:
        return send(input.bytes(1 + input.byte() % 64), input, false);
      case 1:
        return send(input.bytes(1 + input.byte() % 32), input, true);
      case 2:
        return inject(input);
      case 3:
        return inject_text(input);
      default:
        simulation_.run_until(simulation_.time() + static_cast<Time>(input.word()) * kMicrosecond);
    }
  }

  void send(Bytes bytes, Input& input, bool good) {
    if (bytes.empty()) return;
    if (good) {
      bytes.insert(bytes.begin(), kStation);
      modbus::add_crc(bytes);
    }
    serial::Frame frame = serial::to_frame(bytes);
    const std::uint8_t how = input.byte();
    if ((how & 1) != 0) frame[input.byte() % frame.size()].wrong_parity = true;
    const Time gap = (how & 2) != 0 ? static_cast<Time>(input.word()) * 200 : 0;
    const Time timeout = (how & 4) != 0 ? 300 * kMillisecond : 5 * kMillisecond;
    simulation_.master().start({.frame = frame, .timeout = timeout, .gap = gap}, simulation_.time());
    simulation_.finish_exchange();
  }

  void inject(Input& input) {
    Fault fault;
    fault.kind = static_cast<FaultKind>(input.byte() % serial::kFaultKinds);
    const std::uint8_t how = input.byte();
    fault.of = static_cast<serial::Half>(how % 3);
    fault.exchange = how >> 6;
    fault.seed = input.byte();
    fault.character = input.byte() % 65;
    fault.bit = input.byte() % 11 - 1;
    fault.offset.microbits = static_cast<std::int64_t>(input.word()) * 500;
    fault.length.microbits = 1 + static_cast<std::int64_t>(input.word()) * 5000;
    fault.error_rate = static_cast<double>(input.byte()) / 256;
    fault.clock_error = (static_cast<std::int32_t>(input.byte()) - 128) * 1500;
    fault.station = static_cast<serial::Station>(how >> 2 & 1);
    fault.count = 1 + input.byte() % 20;
    fault.bytes = (how & 8) != 0 ? input.bytes(3) : Bytes{};
    fault.lasts = static_cast<Time>(input.word() + 1) * 2 * kMicrosecond;
    if ((how & 16) != 0) fault.from = static_cast<Time>(input.word()) * 2 * kMicrosecond;
    simulation_.inject(fault);
  }

  void inject_text(Input& input) {
    const Bytes bytes = input.bytes(input.byte() % 80);
    const std::string text(bytes.begin(), bytes.end());
    const serial::ParsedFault parsed = serial::parse_fault(text);
    if (!parsed.ok()) {
      require(parsed.error->column >= 1 && parsed.error->column <= text.size() + 1, "an error has a column in the text");
      return;
    }
    const serial::ParsedFault again = serial::parse_fault(to_text(parsed.fault));
    require(again.ok() && again.fault == parsed.fault, "a fault's text is read as that fault");
    const serial::BitClock clock{simulation_.cpu().state().port[0].format};
    if (parsed.fault.length.at(clock) < kLongest && parsed.fault.offset.at(clock) < kLongest)
      simulation_.inject(parsed.fault);
  }

  /// Whatever the slave is busy with, it has sent within 300 ms.
  void become_quiet() {
    const Time limit = simulation_.time() + 20 * kSecond;
    const Time begin = simulation_.time();
    const auto quiet_at = [&] { return std::max(begin, answers_.last_character) + 300 * kMillisecond; };
    while (simulation_.time() < quiet_at()) {
      require(simulation_.run_until(quiet_at()) == serial::Halt::Time, "the CPU stays in RUN");
      require(simulation_.time() < limit, "the line gets quiet");
    }
  }

  void check_good_request() {
    const State& state = simulation_.cpu().state();
    Bytes expected{kStation, 3, 2, state.image[image::kV + 20], state.image[image::kV + 21]};
    modbus::add_crc(expected);
    const Bytes request = modbus::rtu_frame(kStation, modbus::read_holding_registers(10, 1));
    simulation_.master().start({.frame = serial::to_frame(request)}, simulation_.time());
    require(simulation_.finish_exchange().response_bytes() == expected, "a good request after a quiet line is answered");
    require(state.mode == Mode::Run, "the CPU stays in RUN");
  }

  serial::Simulation simulation_;
  Answers answers_;
  serial::Simulation::Snapshot ready_;
};

}  // namespace
}  // namespace s7200

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static s7200::Slave slave;
  slave.run(s7200::Input({data, size}));
  return 0;
}
