#include "tools/bridge/live_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <optional>
#include <utility>

#include "tools/host/interruption.hpp"

namespace s7200::tools {
namespace {

using namespace std::chrono_literals;
using Clock = Pace::Clock;

/// What a character of the program may have to wait for being seen at its begin; from then on its end is known and met
/// exactly. Shorter while something is going on, longer while it is known that the program sends nothing: what comes in ends
/// the wait at once, so there is only to look who has come or gone, and whether to stop.
constexpr auto kIdleSlice = 1ms;
constexpr auto kBusySlice = 200us;
constexpr auto kBusyFor = 200ms;
constexpr auto kQuietSlice = 10ms;

constexpr int kMostAtOnce = 16;  // things that came in, before the simulation goes on

}  // namespace

class LiveRun::Line final : public LiveLine {
 public:
  Line(serial::Simulation& simulation, const LiveRunOptions& options, Bridge* bridge)
      : simulation_(simulation), options_(options), bridge_(bridge), pace_(simulation.time(), options.speed) {
    simulation.cpu().use_steady_scans(SteadyScansUse::Eager);
  }

  ~Line() override {
    if (bridge_) bridge_->stop();
  }

  bool start(std::string& why) {
    if (!bridge_) return true;
    simulation_.host_port().attach(format(), simulation_.time());
    return bridge_->start(*this, context_, why);
  }

  serial::Halt run_until(Time end, std::function<bool()> goes_on) {
    end_ = end;
    goes_on_ = std::move(goes_on);
    halt_.reset();
    pace_ = Pace(simulation_.time(), options_.speed);
    planned_ = Clock::now();
    for (;;) {
      catch_up();
      if (bridge_) bridge_->turn();
      if (stop_asked()) halt_ = serial::Halt::Request;
      if (bridge_ && !halt_) failure_ = bridge_->failure();
      if (!failure_.empty()) halt_ = serial::Halt::Request;
      if (halt_) return *halt_;
      sleep();
    }
  }

  const std::string& failure() const { return failure_; }
  Pace::Report pace() const { return pace_.report(); }

  void catch_up() override {
    if (halt_) return;
    const Time goal = std::min(pace_.next_goal(now()), end_);
    while (now() < goal && !halt_ && !stop_asked()) {
      if (bridge_) simulation_.host_port().receive_as(bridge_->receive_format());
      const serial::Halt halt = simulation_.run_until(goal);
      if (halt != serial::Halt::Time && !(halt == serial::Halt::Paused && goes_on_())) halt_ = halt;
    }
    if (now() >= end_ && !halt_) halt_ = serial::Halt::Time;
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

  bool busy() const { return Clock::now() < busy_until_ || simulation_.host_port().sending(); }

  /// Until when the program is known to send nothing; now if it is not known.
  Time silent_until() const { return simulation_.cpu().alike_until(); }

  Clock::duration slice() const {
    if (!bridge_) return kQuietSlice;
    if (busy()) return kBusySlice;
    return silent_until() > now() ? kQuietSlice : kIdleSlice;
  }

  /// Until the next instant that matters, or something comes in.
  void sleep() {
    Time due = end_;
    if (bridge_) due = std::min({due, bridge_->due(), simulation_.host_port().character_due()});
    if (silent_until() > now() && !busy()) due = std::min(due, silent_until());
    planned_ = std::min(Clock::now() + slice(), pace_.when(due));
    timer_.expires_at(planned_);
    timer_.async_wait([](const boost::system::error_code&) {});
    context_.run_one();
    timer_.cancel();
    for (int handled = 0; handled < kMostAtOnce && context_.poll_one() != 0;) ++handled;
    planned_ = std::min(planned_, Clock::now());
  }

  serial::Simulation& simulation_;
  const LiveRunOptions options_;
  Bridge* bridge_;
  Pace pace_;
  boost::asio::io_context context_{1};
  // A context that nothing waits for stops, and does nothing from then on.
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> open_{context_.get_executor()};
  boost::asio::steady_timer timer_{context_};
  Clock::time_point planned_{}, busy_until_{};
  bool slow_ = false;
  Time end_ = kNever;
  std::function<bool()> goes_on_;
  std::optional<serial::Halt> halt_;  // of the run under way
  std::string failure_;
};

LiveRun::LiveRun(serial::Simulation& simulation, const LiveRunOptions& options, Bridge* bridge)
    : line_(std::make_unique<Line>(simulation, options, bridge)) {}

LiveRun::~LiveRun() = default;

bool LiveRun::start(std::string& why) { return line_->start(why); }

serial::Halt LiveRun::run_until(Time end, std::function<bool()> goes_on) {
  return line_->run_until(end, std::move(goes_on));
}

const std::string& LiveRun::failure() const { return line_->failure(); }

Pace::Report LiveRun::pace() const { return line_->pace(); }

std::string_view run_live(LiveRun& live, serial::Simulation& simulation, const LiveLimits& limits) {
  const State& state = simulation.cpu().state();
  simulation.cpu().pause_at_scan_end(limits.scans != 0);
  simulation.cpu().pause_at_error(limits.strict);
  const auto failed = [&] { return limits.strict && state.error_count != 0; };
  const auto done = [&] { return limits.scans != 0 && state.scans >= limits.scans; };
  const serial::Halt halt = live.run_until(limits.end, [&] { return !failed() && !done(); });
  if (!live.failure().empty()) return "bridge";
  if (halt == serial::Halt::Stopped) return state.fatal_code ? "fatal" : "stop";
  if (failed()) return "run-time error";
  if (done()) return "scans";
  return halt == serial::Halt::Time ? "time" : "interrupted";
}

}  // namespace s7200::tools
