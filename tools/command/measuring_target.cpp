#include "tools/command/measuring_target.hpp"

#include <fmt/format.h>

#include <span>
#include <stdexcept>
#include <vector>

#include "interpreter/base/text.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/slave/simulated_slave.hpp"
#include "tools/slave/slave_target.hpp"

namespace s7200::tools {
namespace {

/// Of an answer of measure_times.stl.
constexpr std::size_t kAnswerLength = 11;

}  // namespace

std::unique_ptr<MeasuringTarget> MeasuringTarget::open(const std::string& name, ProgramOptions options, int& exit_code) {
  const SlaveTarget target = parse_slave_target(name);
  switch (target.kind) {
    case SlaveTarget::Kind::ModbusTcp:
      throw std::invalid_argument("measure_times.stl does not speak Modbus; name a device, a pty or tcp://HOST:PORT");
    case SlaveTarget::Kind::Peer:
      throw std::invalid_argument(
          fmt::format("'{}' is not an S7-200: measure_times.stl cannot run there", stl::shortened(name)));
    case SlaveTarget::Kind::System:
      throw std::invalid_argument(
          fmt::format("'{}' is a system file: name the PROGRAM of the CPU that is to be measured", stl::shortened(name)));
    case SlaveTarget::Kind::Program:
    case SlaveTarget::Kind::Device:
    case SlaveTarget::Kind::Tcp:
      break;
  }
  auto result = std::make_unique<MeasuringTarget>();
  if (target.kind != SlaveTarget::Kind::Program) {
    result->slave_ = connect(target, {.baud = 9600, .data_bits = 8, .parity = Parity::Even, .stop_bits = 1},
                             [](std::span<const std::uint8_t> answer) { return answer.size() == kAnswerLength; });
    return result;
  }
  options.path = name;
  const auto program = options.load(exit_code);
  if (!program) return nullptr;
  std::vector<std::string> problems;
  result->rig_ = Rig::assemble(program, {}, problems);
  if (!result->rig_) throw std::runtime_error(problems.empty() ? "interrupted" : problems.front());
  result->rig_->power_up();
  auto slave = std::make_unique<SimulatedSlave>(result->rig_->simulation(), serial::MasterSettings{}, program->source.name);
  std::string why;
  if (!slave->wait_until_ready(kNever, why)) throw std::runtime_error(why.empty() ? "the CPU went to STOP" : why);
  result->slave_ = std::move(slave);
  return result;
}

}  // namespace s7200::tools
