#include "tools/command/timing/measuring_target.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cstdio>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "interpreter/base/text/text.hpp"
#include "tools/calibration/measure_protocol.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/host_time.hpp"
#include "tools/host/interruption.hpp"
#include "tools/rig/files/recorded_rig.hpp"
#include "tools/slave/simulated_slave.hpp"
#include "tools/slave/slave_target.hpp"
#include "tools/views/report.hpp"

namespace s7200::tools {
namespace {

/// Lines of whole sentences.
constexpr std::array<std::string_view, 4> kHowTo{
    "measure_times.stl must be in the CPU, the CPU in RUN, and its port 0 connected.",
    "To put it there: s7200 convert stl_programs/measure_times.stl --to microwin, paste the blocks into Micro/WIN and "
    "download them.",
    "Take a CPU whose outputs are not wired to a plant. The program answers at 9600 baud, 8 data bits, even parity.",
    "SMB6 is the same for a 214 and a 224, so name the CPU with --cpu."};

/// On a terminal at every loop; else a line once in a while.
class LoopProgress {
 public:
  explicit LoopProgress(std::size_t all) : all_(all) {}

  void operator()(std::size_t done) {
    if (can_redraw(stderr)) {
      fmt::print(stderr, "\r\x1b[K{}", done == all_ ? "" : text(done));
      std::fflush(stderr);
    } else if (host_time() >= next_) {
      print_note(text(done));
      next_ += kOnceInAWhile;
    }
  }

 private:
  static constexpr Time kOnceInAWhile = 30 * kSecond;

  /// `30 of 240 loops, about 4 min left`
  std::string text(std::size_t done) const {
    const std::string so_far = fmt::format("{} of {} loops", done, all_);
    if (done == 0) return so_far;
    const double left =
        static_cast<double>(host_time() - from_) / kSecond / static_cast<double>(done) * static_cast<double>(all_ - done);
    return left < 100 ? fmt::format("{}, about {:.0f} s left", so_far, left)
                      : fmt::format("{}, about {:.0f} min left", so_far, left / 60);
  }

  std::size_t all_;
  Time from_ = host_time();
  Time next_ = from_ + kOnceInAWhile;
};

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
    result->slave_ = connect(
        target, {.baud = 9600, .data_bits = 8, .parity = Parity::Even, .stop_bits = 1},
        [](std::span<const std::uint8_t> answer) { return answer.size() == measuring::kAnswerLength; }, interruption());
    return result;
  }
  options.path = name;
  const auto program = options.load(exit_code);
  if (!program) return nullptr;
  std::vector<std::string> problems;
  const SystemPlan plan = plan_of(program);
  result->rig_ = RecordedRig::assemble(plan, {.seen = {.spots = spots_of_plcs(plan)}, .stop = interruption()}, problems);
  if (!result->rig_) throw std::runtime_error(problems.empty() ? "interrupted" : problems.front());
  result->rig_->power_up();
  auto slave = std::make_unique<SimulatedSlave>(result->rig_->simulation(), serial::MasterSettings{}, program->source.name);
  if (const auto done = slave->wait_until_ready(kNever); !done)
    throw std::runtime_error(done.why().empty() ? "the CPU went to STOP" : done.why());
  result->slave_ = std::move(slave);
  return result;
}

std::string MeasuringTarget::why_it_stopped() const {
  if (!rig_ || rig_->simulation().cpu().state().mode == Mode::Run) return {};
  return std::string(stl::trim(errors_text(rig_->simulation().cpu())));
}

std::optional<Measurement> measure(const std::string& target, const ProgramOptions& program, std::size_t loops, Time each,
                                   const std::function<void(std::uint8_t identification)>& answered, int& exit_code) {
  std::unique_ptr<MeasuringTarget> cpu;
  bool said_how = false;
  const auto say_how = [&](std::string_view why) {
    if (!std::exchange(said_how, true)) print_note(fmt::format("{}{}", why, how_to_measure(" ")));
  };
  const auto say_why = [&](const std::string& error) {
    print_error(error);
    const std::string stopped = cpu ? cpu->why_it_stopped() : "";
    if (!stopped.empty()) print_note(fmt::format("the CPU is in STOP; {}", stopped));
    return !stopped.empty();
  };
  try {
    cpu = MeasuringTarget::open(target, program, exit_code);
    if (!cpu) return {};
    Measurement measurement =
        measure_loops(cpu->slave(), loops, each, {[&] { say_how("no answer yet; "); }, answered, LoopProgress(loops)});
    if (measurement.loops.empty())
      throw std::runtime_error(measurement.broken_off.empty() ? "interrupted before anything was measured"
                                                              : measurement.broken_off);
    if (measurement.loops.size() < loops) exit_code = measurement.broken_off.empty() ? kCheckFailed : kUnusable;
    if (!measurement.broken_off.empty()) say_why(measurement.broken_off);
    return measurement;
  } catch (const WrongCpu& wrong) {
    print_error(wrong.what());
  } catch (const SlaveUnreachable& gone) {
    print_error(gone.what());
  } catch (const std::runtime_error& error) {
    if (!say_why(error.what()) && !interrupted()) say_how("");
  }
  exit_code = interrupted() ? kCheckFailed : kUnusable;
  return {};
}

std::string how_to_measure(std::string_view between) { return fmt::format("{}", fmt::join(kHowTo, between)); }

}  // namespace s7200::tools
