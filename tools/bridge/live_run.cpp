#include "tools/bridge/live_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <optional>
#include <set>
#include <utility>

#include "tools/bridge/mix_up.hpp"
#include "tools/views/state/port_mode.hpp"

namespace s7200::tools {
namespace {

using namespace std::chrono_literals;
using Clock = Pace::Clock;

/// How long a character of the program may wait until it is seen; from then on its end is known and met exactly. The slice
/// is shorter while something is going on, and longer while it is known that the program sends nothing: characters that come
/// in end the wait at once, so that it only has to look for clients that come or go, and for a stop.
constexpr auto kIdleSlice = 1ms;
constexpr auto kBusySlice = 200us;
constexpr auto kBusyFor = 200ms;
constexpr auto kQuietSlice = 50ms;

constexpr int kMostAtOnce = 16;  // things that came in, before the simulation goes on

class SimulationMachine final : public LiveMachine {
 public:
  SimulationMachine(serial::Simulation& simulation, bool in_stop_too) : simulation_(simulation), in_stop_too_(in_stop_too) {}
  Time time() const override { return simulation_.time(); }
  serial::Halt run_until(Time end) override {
    const bool stopped = simulation_.cpu().state().mode == Mode::Stop;
    return stopped && in_stop_too_ ? simulation_.system().run_until(end) : simulation_.run_until(end);
  }
  Time silent_until() const override { return simulation_.cpu().alike_until(); }

  /// Passes steady scans over eagerly only while nobody asks: a look at every pair of scans costs too much while masters do.
  void is_in_use(bool in_use) override {
    const SteadyScansUse wanted = in_use ? SteadyScansUse::On : SteadyScansUse::Eager;
    if (std::exchange(steady_, wanted) != wanted) simulation_.cpu().use_steady_scans(wanted);
  }

 private:
  std::optional<SteadyScansUse> steady_{};
  serial::Simulation& simulation_;
  bool in_stop_too_;
};

std::vector<LiveEnd> end_of(serial::Simulation& simulation, const LiveRunOptions& options, Bridge* bridge) {
  if (!bridge) return {};
  return {{.bridge = bridge,
           .port = &simulation.host_port(),
           .line = &simulation.line(),
           .plc = &simulation.plc(),
           .plc_port = simulation.port(),
           .settings = options.line,
           .why_no_modbus = [&simulation] { return why_no_freeport(simulation.cpu(), simulation.port()); }}};
}

}  // namespace

class LiveRun::Engine {
 public:
  Engine(LiveMachine& machine, const std::vector<LiveEnd>& ends, const LiveRunOptions& options)
      : machine_(machine), options_(options), pace_(machine.time(), options.speed) {
    for (const LiveEnd& end : ends) lines_.push_back(std::make_unique<Line>(*this, end));
  }

  Result<> start() {
    return with_each(lines_, [&](const auto& line) { return line->start(context_); });
  }

  serial::Halt run_until(Time end, std::function<bool()> goes_on, const std::function<void()>& meanwhile) {
    end_ = end;
    goes_on_ = std::move(goes_on);
    halt_.reset();
    pace_ = Pace(now(), options_.speed);
    planned_ = Clock::now();
    for (;;) {
      catch_up();
      for (const auto& line : lines_) line->turn();
      if (stop_asked()) halt_ = serial::Halt::Request;
      for (const auto& line : lines_)
        if (!halt_ && line->has_failed()) fail(*line);
      if (halt_) return *halt_;
      meanwhile();
      if (options_.before_wait) options_.before_wait();
      sleep();
    }
  }

  const std::string& failure() const { return failure_; }
  std::string take_failure() { return std::exchange(untold_, {}); }
  Pace::Report pace() const { return pace_.report(); }
  std::uint64_t collisions(const serial::SharedLine* on) const {
    std::uint64_t all = 0;
    for (const auto& line : lines_) all += line->is_on(on) ? line->collisions() : 0;
    return all;
  }

 private:
  class Line final : public LiveLine {
   public:
    Line(Engine& engine, const LiveEnd& end) : engine_(engine), end_(end) {}
    ~Line() override { end_.bridge->stop(); }

    Result<> start(boost::asio::io_context& context) {
      end_.port->attach(format(), now());
      return end_.bridge->start(*this, context);
    }

    Bridge& bridge() const { return *end_.bridge; }
    bool is_on(const serial::SharedLine* line) const { return end_.line == line; }
    std::uint64_t collisions() const { return collisions_; }
    bool has_failed() const { return !gone_ && !end_.bridge->failure().empty(); }
    /// Stops the bridge; nothing is at this end of the line from now on.
    void give_up() {
      gone_ = true;
      end_.bridge->stop();
    }
    Time due() const { return gone_ ? kNever : end_.bridge->due(); }
    void turn() {
      if (!gone_) end_.bridge->turn();
    }
    void listen() {
      if (!gone_) end_.port->receive_as(end_.bridge->receive_format(), now());
    }
    void deliver() {
      const auto characters = end_.port->take_received();
      if (gone_ || characters.empty()) return;
      engine_.busy();
      end_.bridge->received(characters);
    }

    void catch_up() override { engine_.catch_up(); }
    void send(std::span<const serial::HostCharacter> characters) override {
      engine_.busy();
      tell_mix_up(characters);
      note_collision();
      end_.port->send(characters, now());
    }
    std::size_t drop(std::uint64_t sender) override { return end_.port->drop(sender); }
    void end_break(std::uint64_t sender, Time lasts) override {
      engine_.busy();
      end_.port->end_break(sender, lasts, now());
    }

    Time now() const override { return engine_.now(); }
    const serial::HostPort& host_port() const override { return *end_.port; }
    SerialFormat program_format() const override {
      return end_.plc ? end_.plc->cpu().state().port[end_.plc_port].format : end_.without_program;
    }
    SerialFormat format() const override {
      return end_.settings.over(end_.plc ? end_.plc->port_format(end_.plc_port) : end_.without_program);
    }
    bool program_is_up() const override { return !end_.plc || end_.plc->cpu().state().scans > 0; }
    std::string why_no_modbus() const override { return end_.why_no_modbus ? end_.why_no_modbus() : ""; }
    Time last_activity() const override { return end_.line->last_activity(); }
    const LiveMessages& messages() const override { return engine_.options_.messages; }

   private:
    /// Tells each mistake once, since it stays the same.
    void tell_mix_up(std::span<const serial::HostCharacter> characters) {
      constexpr std::size_t kLooksAtOnly = 512;  // longer than any frame
      if (characters.size() > kLooksAtOnly || !program_is_up()) return;
      Bytes bytes;
      for (const serial::HostCharacter& character : characters) bytes.push_back(character.byte);
      const State* const state = end_.plc ? &end_.plc->cpu().state() : nullptr;
      const std::string note = mix_up(bytes, state, end_.plc_port);
      if (!note.empty() && told_.insert(note).second) messages().note(note);
    }

    /// Said once: what collides is lost, and the master asks again.
    void note_collision() {
      const bool collides = end_.plc && !end_.port->sending() && is_sending(end_.plc->cpu().state(), end_.plc_port);
      if (collides && collisions_++ == 0)
        messages().note(
            fmt::format("a collision at {}: a master spoke while port {} of the PLC was sending; what both sent "
                        "is lost",
                        format_duration(now()), end_.plc_port));
    }

    Engine& engine_;
    const LiveEnd end_;
    std::uint64_t collisions_ = 0;
    bool gone_ = false;
    std::set<std::string> told_;
  };

  void fail(Line& line) {
    untold_ = line.bridge().failure();
    if (failure_.empty()) failure_ = untold_;
    line.give_up();
    halt_ = serial::Halt::Request;
  }

  Time now() const { return machine_.time(); }
  void busy() { busy_until_ = Clock::now() + kBusyFor; }
  bool stop_asked() const { return options_.stop.stop_requested() || options_.pause.stop_requested(); }

  void catch_up() {
    if (halt_) return;
    const Time goal = std::min(pace_.next_goal(now()), end_);
    machine_.is_in_use(in_use());
    while (now() < goal && !halt_ && !stop_asked()) {
      for (const auto& line : lines_) line->listen();
      const serial::Halt halt = machine_.run_until(goal);
      if (halt != serial::Halt::Time && !(halt == serial::Halt::Paused && goes_on_())) halt_ = halt;
    }
    if (now() >= end_ && !halt_) halt_ = serial::Halt::Time;
    if (pace_.reached(now(), std::min(planned_, Clock::now())) && !slow_) {
      slow_ = true;
      options_.messages.note("this computer cannot keep up: the simulation falls behind the clock");
    }
    for (const auto& line : lines_) line->deliver();
  }

  bool in_use() const {
    return Clock::now() < busy_until_ ||
           std::ranges::any_of(lines_, [](const auto& line) { return line->host_port().sending(); });
  }

  Clock::duration slice() const {
    if (lines_.empty()) return kQuietSlice;
    if (in_use()) return kBusySlice;
    return machine_.silent_until() > now() ? kQuietSlice : kIdleSlice;
  }

  /// Sleeps until the next instant that matters, or until something comes in.
  void sleep() {
    Time due = end_;
    for (const auto& line : lines_) due = std::min({due, line->due(), line->host_port().character_due()});
    if (machine_.silent_until() > now() && !in_use()) due = std::min(due, machine_.silent_until());
    planned_ = std::min(Clock::now() + slice(), pace_.when(due));
    timer_.expires_at(planned_);
    timer_.async_wait([](const boost::system::error_code&) {});
    context_.run_one();
    timer_.cancel();
    for (int handled = 0; handled < kMostAtOnce && context_.poll_one() != 0;) ++handled;
    planned_ = std::min(planned_, Clock::now());
  }

  LiveMachine& machine_;
  const LiveRunOptions options_;
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
  std::string failure_, untold_;
  std::vector<std::unique_ptr<Line>> lines_;  // their bridges stop before the context goes
};

LiveRun::LiveRun(serial::Simulation& simulation, const LiveRunOptions& options, Bridge* bridge)
    : LiveRun(std::make_unique<SimulationMachine>(simulation, options.in_stop_too), end_of(simulation, options, bridge),
              options) {}

LiveRun::LiveRun(std::unique_ptr<LiveMachine> machine, const std::vector<LiveEnd>& ends, const LiveRunOptions& options)
    : machine_(std::move(machine)), engine_(std::make_unique<Engine>(*machine_, ends, options)) {}

LiveRun::~LiveRun() = default;

Result<> LiveRun::start() { return engine_->start(); }

serial::Halt LiveRun::run_until(Time end, std::function<bool()> goes_on, const std::function<void()>& meanwhile) {
  return engine_->run_until(end, std::move(goes_on), meanwhile);
}

const std::string& LiveRun::failure() const { return engine_->failure(); }

std::string LiveRun::take_failure() { return engine_->take_failure(); }

Pace::Report LiveRun::pace() const { return engine_->pace(); }

std::uint64_t LiveRun::collisions(const serial::SharedLine* line) const { return engine_->collisions(line); }

std::string_view run_live(LiveRun& live, serial::Simulation& simulation, const LiveLimits& limits) {
  const State& state = simulation.cpu().state();
  simulation.cpu().pause_at_scan_end(limits.scans != 0);
  simulation.cpu().pause_at_error(limits.strict);
  const auto failed = [&] { return limits.strict && state.error_count != 0; };
  const auto done = [&] { return limits.scans != 0 && state.scans >= limits.scans; };
  const auto go_on = [&] { return live.run_until(limits.end, [&] { return !failed() && !done(); }); };
  serial::Halt halt = go_on();
  while (halt == serial::Halt::Stopped && limits.stopped && state.fatal_code == 0) {
    limits.stopped();
    halt = go_on();
  }
  if (!live.failure().empty()) return "bridge";
  if (halt == serial::Halt::Stopped) return state.fatal_code ? "fatal" : "stop";
  if (failed()) return "run-time error";
  if (done()) return "scans";
  return halt == serial::Halt::Time ? "time" : "interrupted";
}

}  // namespace s7200::tools
