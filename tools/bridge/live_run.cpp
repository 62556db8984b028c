#include "tools/bridge/live_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "tools/host/interruption.hpp"

namespace s7200::tools {
namespace {

using namespace std::chrono_literals;
using Clock = Pace::Clock;

/// What a character of the program may have to wait for being seen at its begin; from then on its end is known and met
/// exactly. Shorter while something is going on.
constexpr auto kIdleSlice = 1ms;
constexpr auto kBusySlice = 200us;
constexpr auto kBusyFor = 200ms;
constexpr auto kSliceWithoutBridge = 10ms;

constexpr int kMostAtOnce = 16;  // things that came in, before the simulation goes on

class LiveRun final : public LiveLine {
 public:
  LiveRun(serial::Simulation& simulation, const LiveRunOptions& options, Bridge* bridge)
      : simulation_(simulation), options_(options), bridge_(bridge), pace_(simulation.time(), options.speed) {}

  std::string_view run() {
    if (bridge_) {
      simulation_.host_port().attach(format(), simulation_.time());
      if (!bridge_->start(*this, context_, failure_)) return {};
    }
    simulation_.cpu().pause_at_scan_end(options_.scans != 0);
    pace_ = Pace(simulation_.time(), options_.speed);
    planned_ = Clock::now();
    for (;;) {
      catch_up();
      if (bridge_) bridge_->turn();
      if (ended()) break;
      sleep();
    }
    if (bridge_ && simulation_.cpu().state().mode == Mode::Stop)
      options_.messages.note("the CPU went to STOP; nobody answers any more");
    return reason_;
  }

  Pace::Report pace() const { return pace_.report(); }
  const std::string& failure() const { return failure_; }

  void catch_up() override {
    if (!reason_.empty()) return;
    const Time goal = std::min(pace_.next_goal(now()), options_.end);
    while (now() < goal && reason_.empty() && !stop_asked()) {
      if (bridge_) simulation_.host_port().receive_as(bridge_->receive_format());
      simulation_.run_until(goal);
      const State& state = simulation_.cpu().state();
      if (options_.scans != 0 && state.scans >= options_.scans) reason_ = "scans";
      if (options_.strict && state.error_count != 0) reason_ = "run-time error";
      if (state.mode == Mode::Stop) reason_ = state.fatal_code ? "fatal" : "stop";
    }
    if (now() >= options_.end && reason_.empty()) reason_ = "time";
    if (pace_.reached(now(), std::min(planned_, Clock::now())) && !slow_) {
      slow_ = true;
      options_.messages.note("this computer cannot keep up: the simulation falls behind the clock");
    }
    deliver();
  }

  void send(std::span<const serial::HostCharacter> characters) override {
    busy_until_ = Clock::now() + kBusyFor;
    simulation_.host_port().send(characters, now());
  }

  std::size_t drop(std::uint64_t sender) override { return simulation_.host_port().drop(sender); }

  SerialFormat format() const override { return options_.line.over(simulation_.port_format()); }
  const LiveMessages& messages() const override { return options_.messages; }
  const serial::Simulation& simulation() const override { return simulation_; }

 private:
  bool stop_asked() const { return interrupted() || (options_.stop && *options_.stop); }

  void deliver() {
    if (!bridge_) return;
    const auto characters = simulation_.host_port().take_received();
    if (characters.empty()) return;
    busy_until_ = Clock::now() + kBusyFor;
    bridge_->received(characters);
  }

  bool ended() {
    if (stop_asked()) reason_ = "interrupted";
    if (bridge_ && reason_.empty()) {
      failure_ = bridge_->failure();
      if (!failure_.empty()) reason_ = "bridge";
    }
    return !reason_.empty();
  }

  Clock::duration slice() const {
    if (!bridge_) return kSliceWithoutBridge;
    return Clock::now() < busy_until_ || simulation_.host_port().sending() ? kBusySlice : kIdleSlice;
  }

  /// Until the next instant that matters, or something comes in.
  void sleep() {
    const Time due = bridge_ ? std::min(bridge_->due(), simulation_.host_port().character_due()) : kNever;
    planned_ = std::min(Clock::now() + slice(), pace_.when(std::min(due, options_.end)));
    timer_.expires_at(planned_);
    timer_.async_wait([](const boost::system::error_code&) {});
    context_.run_one();
    timer_.cancel();
    for (int handled = 0; handled < kMostAtOnce && context_.poll_one() != 0;) ++handled;
    planned_ = std::min(planned_, Clock::now());
  }

  serial::Simulation& simulation_;
  const LiveRunOptions& options_;
  Bridge* bridge_;
  Pace pace_;
  boost::asio::io_context context_{1};
  // A context that nobody waits for anything with stops, and does nothing from then on.
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> open_{context_.get_executor()};
  boost::asio::steady_timer timer_{context_};
  Clock::time_point planned_{}, busy_until_{};
  bool slow_ = false;
  std::string_view reason_;
  std::string failure_;
};

}  // namespace

LiveRunResult run_live(serial::Simulation& simulation, const LiveRunOptions& options, Bridge* bridge) {
  LiveRun run(simulation, options, bridge);
  const std::string_view reason = run.run();
  if (bridge) bridge->stop();
  return {reason, run.failure(), run.pace()};
}

}  // namespace s7200::tools
