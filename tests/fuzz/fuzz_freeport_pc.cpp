// Whatever comes in at our slave of a PC, and whatever comes back to its master. The input is a list of frames and pauses.
// Promises: the slave stays in RUN and answers nothing but whole answers with a status that there is, for a read with a
// right check code; memory that a PC cannot reach stays as it is; after a quiet line a good read has its answer. A command
// has one form, and an answer that is right has what it is to have.
#include <algorithm>
#include <string>

#include "serial_sim/pc_protocol/answer.hpp"
#include "serial_sim/pc_protocol/command.hpp"
#include "tests/fuzz/slave.hpp"
#include "tests/support/source_path.hpp"

namespace s7200 {
namespace {

using pc_protocol::Command;
using Data = std::span<const std::uint8_t>;

constexpr std::uint8_t kStation = 2;
constexpr std::uint32_t kStationByte = 4900, kLimitWord = 4902;  // in V memory, of the slave
constexpr Time kQuiet = 400 * kMillisecond;                      // its message that breaks off has ended, and its answer

/// What the slave sends, answer by answer.
class Answers final : public TraceSink {
 public:
  void record(const TraceRecord& r) override {
    if (r.kind == TraceKind::Transmit) sent_.clear();
    if (r.kind == TraceKind::CharacterSent) sent_.push_back(r.byte);
    if (r.kind != TraceKind::TransmitEnd) return;
    const serial::Answer answer = pc_protocol::check_answer({}, sent_, pc_protocol::kEndCharacter);
    const bool is_write = sent_.size() > 1 && sent_[1] == static_cast<std::uint8_t>(pc_protocol::Status::WriteDone);
    require(answer.verdict == serial::Verdict::Right || answer.verdict == serial::Verdict::Exception || is_write,
            "an answer is one of the protocol");
    require(sent_.size() == pc_protocol::kAnswerLength, "an answer is whole");
  }

 private:
  Bytes sent_;
};

/// A command of the right form is what it says, and any other is none.
void check_form(Data bytes) {
  const auto command = pc_protocol::parse_command(bytes);
  if (!command) return;
  require(command->data.size() <= pc_protocol::kMostBytes, "a command has eight bytes at most");
  const auto again = pc_protocol::parse_command(pc_protocol::to_bytes(*command));
  require(again && *again == *command, "a command is read as it is written");
}

/// What comes back to a master, as it stands.
void check_judgement(Data command, Data response) {
  const serial::Answer answer = pc_protocol::check_answer(command, response, pc_protocol::kEndCharacter);
  require((answer.verdict == serial::Verdict::Wrong) == !answer.fault.empty(), "what is wrong is said");
  require(answer.bytes.size() <= pc_protocol::kMostBytes, "an answer has eight bytes at most");
}

class Slave {
 public:
  Slave() : simulation_(program_at(test::source_path("stl_programs/freeport_host_slave.stl"), "224")) {
    simulation_.cpu().set_sink(&answers_);
    get_ready(simulation_);
    ready_ = simulation_.snapshot();
  }

  void run(Input input) {
    simulation_.restore(ready_);
    answers_ = {};
    for (int i = 0; i < 24 && !input.empty(); ++i) step(input);
    simulation_.run_until(simulation_.time() + kQuiet);
    check_good_read();
  }

 private:
  void step(Input& input) {
    switch (input.byte() % 4) {
      case 0:
        return send(input.bytes(1 + input.byte() % 40), input);
      case 1:
        return send(command(input), input);
      case 2: {  // one character of a good command is another
        Bytes changed = command(input);
        const std::uint8_t place = input.byte();
        changed[place % changed.size()] = input.byte();
        return send(changed, input);
      }
      default:
        simulation_.run_until(simulation_.time() + Time{input.byte()} * kMillisecond);
    }
  }

  static Bytes command(Input& input) {
    const std::uint8_t how = input.byte();
    Command command{.type = (how & 1) != 0 ? pc_protocol::Type::Write : pc_protocol::Type::Read,
                    .station = (how & 2) != 0 ? input.byte() : kStation,
                    .address = {.area = (how & 4) != 0 ? pc_protocol::Area::Q : pc_protocol::Area::V,
                                .number = static_cast<std::uint16_t>(input.word())},
                    .data = {}};
    if (command.type == pc_protocol::Type::Write) command.data = input.bytes(1 + input.byte() % pc_protocol::kMostBytes);
    return pc_protocol::to_bytes(command);
  }

  void send(const Bytes& bytes, Input& input) {
    if (bytes.empty()) return;
    check_form(bytes);
    const std::uint8_t how = input.byte();
    const Time gap = (how & 1) != 0 ? Time{input.byte()} * 50 * kMicrosecond : 0;
    const Time timeout = (how & 2) != 0 ? 300 * kMillisecond : 5 * kMillisecond;
    simulation_.master().start({.frame = serial::to_frame(bytes), .timeout = timeout, .gap = gap}, simulation_.time());
    check_judgement(bytes, simulation_.finish_exchange().response_bytes());
    check_judgement(bytes, input.bytes(how / 4 % 24));
    const State& state = simulation_.cpu().state();
    require(state.mode == Mode::Run, "the CPU stays in RUN");
    require(state.image[image::kV + kStationByte] == kStation, "its station stays as it is");
    require(load16(&state.image[image::kV + kLimitWord]) == kStationByte, "and what a PC can reach");
  }

  void check_good_read() {
    constexpr std::uint16_t kPlace = 1008;
    const Bytes asked = pc_protocol::to_bytes(
        {.type = pc_protocol::Type::Read, .station = kStation, .address = {.number = kPlace}, .data = {}});
    simulation_.master().start({.frame = serial::to_frame(asked)}, simulation_.time());
    const Bytes response = simulation_.finish_exchange().response_bytes();
    const serial::Answer answer = pc_protocol::check_answer(asked, response, pc_protocol::kEndCharacter);
    require(answer.verdict == serial::Verdict::Right, "a good read after a quiet line is answered");
    const std::uint8_t* const memory = &simulation_.cpu().state().image[image::kV + kPlace];
    require(std::equal(answer.bytes.begin(), answer.bytes.end(), memory), "with what the memory has");
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
