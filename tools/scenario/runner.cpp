#include "tools/scenario/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <map>

#include "interpreter/base/bytes.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/trace/fan_out.hpp"
#include "serial_sim/modbus/answer.hpp"
#include "tools/host/interruption.hpp"
#include "tools/slave/simulated_slave.hpp"
#include "tools/views/machine_text.hpp"
#include "tools/views/memory.hpp"
#include "tools/views/report.hpp"
#include "tools/views/text_frame.hpp"
#include "tools/views/timeline.hpp"

namespace s7200::tools {
namespace {

constexpr Time kReadyWithin = 60 * kSecond;
constexpr Time kSlice = 10 * kSecond;  // Ctrl-C is heard in between

/// What `interrupts:` asks for.
class InterruptCounter final : public TraceSink {
 public:
  void begin() { *this = {}; }
  std::uint64_t of(const InterruptCount& asked) const {
    switch (asked.what) {
      case InterruptCount::What::Routine:
        return routine_[asked.number];
      case InterruptCount::What::Event:
        return event_[asked.number];
      case InterruptCount::What::Lost:
        return lost_;
    }
    return 0;
  }

  void record(const TraceRecord& record) override {
    if (record.kind == TraceKind::ServiceBegin) ++routine_[record.routine];
    if (record.kind == TraceKind::EventOccurred) ++event_[record.event];
    if (record.kind == TraceKind::EventLost) ++lost_;
  }

 private:
  std::array<std::uint64_t, 256> routine_{}, event_{};
  std::uint64_t lost_ = 0;
};

/// A program with all that watches it.
class Plant {
 public:
  Plant(const Scenario& scenario, std::shared_ptr<const Program> program)
      : scenario_(scenario), program_(std::move(program)), timeline_(program_, nullptr) {
    sinks_.add(&timeline_);
    sinks_.add(&interrupts_);
    power_up(nullptr);
    if (scenario.clock) cpu().set_clock(*scenario.clock);
    for (const Assignment& assignment : scenario.set) assign(*simulation_, assignment);
  }

  void power_cycle(const PowerCycleStep& step) {
    RetentiveMemory memory = cpu().retentive_memory();
    memory.ram_lost = step.memory_lost;
    memory.power_off = step.power_off;
    before_ += simulation_->time();
    power_up(&memory);
  }

  /// Runs to where the first step may begin; false if that never comes.
  bool get_ready() {
    if (scenario_.after != kNever) {
      slave_->wait(scenario_.after - simulation_->time());
      return true;
    }
    const bool ready = slave_->get_ready(kReadyWithin);
    return ready || cpu().state().mode == Mode::Stop;
  }

  void begin_exchange() {
    timeline_.begin();
    interrupts_.begin();
  }
  void end_exchange() { timeline_.end(); }

  /// Unlike a request, what is only waited for begins nothing that `interrupts` counts from.
  void begin_reception() { timeline_.begin(); }

  /// False if they do not come within a minute.
  bool wait_scans(std::uint64_t count) {
    cpu().pause_at_scan_end(true);
    const Time limit = simulation_->time() + kReadyWithin;
    for (; count > 0 && simulation_->run_until(limit) == serial::Halt::Paused; --count) {
    }
    cpu().pause_at_scan_end(false);
    simulation_->run_until(simulation_->time() + 1);  // running on, the CPU is no longer paused
    return count == 0;
  }

  /// Runs scan by scan until `holds`. False if it does not when the time is over or the CPU is in STOP.
  template <class Holds>
  bool wait_until(Holds holds, Time timeout) {
    const Time limit = simulation_->time() + timeout;
    bool held = holds();
    cpu().pause_at_scan_end(true);
    while (!held && !interrupted() && simulation_->time() < limit) {
      const serial::Halt halt = simulation_->run_until(std::min(limit, simulation_->time() + kSlice));
      held = holds();
      if (halt == serial::Halt::Stopped) break;
    }
    cpu().pause_at_scan_end(false);
    cpu().run(simulation_->time());  // it is no longer paused
    return held;
  }

  serial::Simulation& simulation() { return *simulation_; }
  Cpu& cpu() { return simulation_->cpu(); }
  Slave& slave() { return *slave_; }
  SerialFormat format() const { return scenario_.line.over(simulation_->port_format()); }
  std::uint64_t interrupts(const InterruptCount& asked) const { return interrupts_.of(asked); }
  std::string timeline(const serial::Exchange& exchange) const { return to_text(timeline_.report(), exchange, false); }
  Time time() const { return before_ + simulation_->time(); }

 private:
  void power_up(const RetentiveMemory* memory) {
    slave_.reset();
    simulation_ = std::make_unique<serial::Simulation>(program_, scenario_.field);
    simulation_->cpu().set_sink(&sinks_);
    simulation_->stop_when(&interruption());
    simulation_->power_up(memory);
    slave_ = std::make_unique<SimulatedSlave>(*simulation_, scenario_.line, program_->source.name);
  }

  const Scenario& scenario_;
  std::shared_ptr<const Program> program_;
  Timeline timeline_;
  InterruptCounter interrupts_;
  FanOut sinks_;
  std::unique_ptr<serial::Simulation> simulation_;
  std::unique_ptr<SimulatedSlave> slave_;
  Time before_ = 0;  ///< what had passed at the last power cycle
};

// --- answers ---

std::vector<BytePattern> pattern_of(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

bool matches(const std::vector<BytePattern>& pattern, const Bytes& bytes) {
  return std::equal(pattern.begin(), pattern.end(), bytes.begin(), bytes.end(),
                    [](const BytePattern& p, std::uint8_t byte) { return !p || *p == byte; });
}

Bytes with_crc(Bytes bytes) {
  modbus::add_crc(bytes);
  return bytes;
}

Bytes exception_answer(const Bytes& request, std::uint8_t code) {
  if (request.size() < 2) return {};
  return with_crc({request[0], static_cast<std::uint8_t>(request[1] | 0x80), code});
}

/// Answers to writes are the head of the request.
std::optional<Bytes> write_answer(const Bytes& request) {
  constexpr std::size_t kHead = 6;
  const bool writes =
      request.size() >= kHead && (request[1] == 5 || request[1] == 6 || request[1] == 15 || request[1] == 16);
  if (!writes) return {};
  return with_crc({request.begin(), request.begin() + kHead});
}

bool has_values(const Expected& expected, const std::vector<std::uint16_t>& found) {
  return std::equal(expected.values.begin(), expected.values.end(), found.begin(), found.end(),
                    [](const auto& e, std::uint16_t f) { return !e || *e == f; });
}

bool fulfilled(const Expected& expected, bool has_crc, const Bytes& request, const Bytes& response) {
  const modbus::Answer answer = modbus::check_answer(request, response);
  switch (expected.kind) {
    case Expected::Kind::Silence:
      return response.empty();
    case Expected::Kind::Any:
      return !response.empty() && (!has_crc || modbus::crc_ok(response));
    case Expected::Kind::Frame:
      if (!has_crc) return matches(expected.frame, response);
      return modbus::crc_ok(response) && matches(expected.frame, {response.begin(), response.end() - 2});
    case Expected::Kind::Echo:
      return response == request;
    case Expected::Kind::Exception:
      return answer.verdict == modbus::Verdict::Exception && answer.exception == expected.exception;
    case Expected::Kind::Values:
      return answer.verdict == modbus::Verdict::Right && has_values(expected, answer.values);
    case Expected::Kind::Accepted:
      return answer.verdict == modbus::Verdict::Right;
    case Expected::Kind::Refused:
      return answer.verdict == modbus::Verdict::Exception;
  }
  return false;
}

/// The CRC that belongs to a pattern without one; unknown if it has a byte that may be any.
void add_crc(std::vector<BytePattern>& pattern) {
  Bytes bytes;
  for (const BytePattern& p : pattern)
    if (p) bytes.push_back(*p);
  const bool known = bytes.size() == pattern.size();
  modbus::add_crc(bytes);
  for (std::size_t i = 2; i > 0; --i) pattern.push_back(known ? BytePattern(bytes[bytes.size() - i]) : std::nullopt);
}

/// The bytes of a list of registers or bits in an answer to `request`.
std::vector<BytePattern> values_answer(const Expected& expected, const Bytes& request) {
  std::vector<BytePattern> pattern{request[0], request[1]};
  if (request[1] >= 3) {
    pattern.push_back(static_cast<std::uint8_t>(2 * expected.values.size()));
    for (const auto& value : expected.values) {
      pattern.push_back(value ? BytePattern(static_cast<std::uint8_t>(*value >> 8)) : std::nullopt);
      pattern.push_back(value ? BytePattern(static_cast<std::uint8_t>(*value & 0xFF)) : std::nullopt);
    }
  } else {
    const std::size_t bytes = (expected.values.size() + 7) / 8;
    pattern.push_back(static_cast<std::uint8_t>(bytes));
    pattern.resize(3 + bytes, BytePattern(std::uint8_t{0}));
    for (std::size_t i = 0; i < expected.values.size(); ++i) {
      BytePattern& byte = pattern[3 + i / 8];
      if (!expected.values[i]) byte.reset();
      if (byte && *expected.values[i]) byte = static_cast<std::uint8_t>(*byte | 1U << i % 8);
    }
  }
  add_crc(pattern);
  return pattern;
}

/// The bytes that would have been right, as far as they are known; none if they are not.
std::vector<BytePattern> bytes_expected(const Expected& expected, bool has_crc, const Bytes& request) {
  switch (expected.kind) {
    case Expected::Kind::Frame: {
      std::vector<BytePattern> pattern = expected.frame;
      if (has_crc) add_crc(pattern);
      return pattern;
    }
    case Expected::Kind::Echo:
      return pattern_of(request);
    case Expected::Kind::Exception:
      return pattern_of(exception_answer(request, expected.exception));
    case Expected::Kind::Values:
      if (request.size() >= 2 && request[1] >= 1 && request[1] <= 4) return values_answer(expected, request);
      return {};
    case Expected::Kind::Accepted:
      if (const auto written = write_answer(request)) return pattern_of(*written);
      return {};
    default:
      return {};
  }
}

std::string values_text(const std::vector<std::optional<std::uint16_t>>& values) {
  constexpr std::size_t kShown = 8;
  std::string text = values.size() == 1 ? "the value" : "the values";
  const bool bits = std::all_of(values.begin(), values.end(), [](const auto& value) { return value.value_or(0) <= 1; });
  for (std::size_t i = 0; i < std::min(kShown, values.size()); ++i)
    text += !values[i] ? " .." : bits ? fmt::format(" {}", *values[i]) : fmt::format(" 16#{:04X}", *values[i]);
  return values.size() > kShown ? fmt::format("{} … {} in all", text, values.size()) : text;
}

std::string in_words(const Expected& expected, const Bytes& request) {
  switch (expected.kind) {
    case Expected::Kind::Silence:
      return request.empty() ? "nothing" : "no answer";
    case Expected::Kind::Any:
      return request.empty() ? "a transmission" : "an answer";
    case Expected::Kind::Frame:
      return quoted_text(expected.frame);
    case Expected::Kind::Echo:
      return "the request again";
    case Expected::Kind::Exception:
      return modbus::describe(request, exception_answer(request, expected.exception));
    case Expected::Kind::Values:
      return values_text(expected.values);
    case Expected::Kind::Accepted:
      return "what was asked for";
    case Expected::Kind::Refused:
      return "an exception";
  }
  return "";
}

std::string in_words(const Window& window, const SerialFormat& format) {
  const Time from = window.from.in(format), to = window.to.in(format);
  if (from == to) return format_duration(from, 6);
  if (to == kNever) return fmt::format("{} or more", format_duration(from, 6));
  if (from <= 0) return fmt::format("{} or less", format_duration(to, 6));
  return fmt::format("{} to {}", format_duration(from, 6), format_duration(to, 6));
}

bool inside(Time time, const Window& window, const SerialFormat& format, bool lower_limit_counts) {
  return (!lower_limit_counts || time >= window.from.in(format)) && time <= window.to.in(format);
}

std::string in_words(const Count& count) {
  if (count.to == count.from) return std::to_string(count.from);
  if (count.to == UINT64_MAX) return fmt::format("{} or more", count.from);
  return fmt::format("{} to {}", count.from, count.to);
}

bool inside(std::uint64_t found, const Count& count) { return found >= count.from && found <= count.to; }

std::string in_words(const InterruptCount& asked) {
  switch (asked.what) {
    case InterruptCount::What::Routine:
      return fmt::format("INT {}", asked.number);
    case InterruptCount::What::Event:
      return fmt::format("event {}", asked.number);
    case InterruptCount::What::Lost:
      return "lost events";
  }
  return "";
}

std::string real_text(const std::vector<std::uint8_t>& bytes) {
  return stl::to_text(stl::Operand{.value = stl::Real{std::bit_cast<float>(load32(bytes.data()))}});
}

/// What memory was to hold and holds. Of reals and of limits the bytes say little.
Finding memory_finding(const Program& program, const MemoryExpected& expected, const Bytes& found) {
  Finding finding{.what = expected.range.name_of(0), .expected_bytes = expected.bytes, .found_bytes = pattern_of(found)};
  if (expected.limits) {
    finding.expected = expected.written;
    finding.found = expected.range.real ? real_text(found) : value_text(program, expected.range, found);
  } else if (expected.range.width == Width::Double && expected.range.count == 1) {
    const std::string real = real_text(found);
    if (real == expected.written + ".0") finding.found = fmt::format("the real {}: write {} for it", real, real);
  }
  return finding;
}

// --- one run ---

class Run {
 public:
  Run(const Scenario& scenario, const Bench& bench) : scenario_(scenario), bench_(bench) {
    if (bench.program) plant_ = std::make_unique<Plant>(scenario, bench.program);
  }

  ScenarioResult result() {
    if (!plant_) {
      if (const std::string what = acted_inside(); !what.empty())
        return {.outcome = ScenarioResult::Outcome::Skipped, .reason = "needs a program in simulation: " + what};
    }
    if (!plant_) slave().forget_unasked();
    begin_ = plant_ ? 0 : slave().now();
    if (plant_ && !plant_->get_ready()) {
      add({.what = "ready",
           .expected = fmt::format("the first scan ended and the line quiet within {}", format_duration(kReadyWithin)),
           .found = "that never came; 'after: TIME' begins all the same",
           .of_run = true});
    } else {
      for (; step_ < scenario_.steps.size() && !interrupted() && !lost_; ++step_) do_step(scenario_.steps[step_]);
      look_at_mode();
    }
    if (interrupted()) result_.reason = "interrupted";
    result_.time = plant_ ? plant_->time() : slave().now() - begin_;
    if (!result_.findings.empty()) result_.outcome = ScenarioResult::Outcome::Failed;
    if (interrupted()) result_.outcome = ScenarioResult::Outcome::Skipped;
    if (result_.skipped_steps > 0 && result_.skipped_steps == scenario_.steps.size()) {
      result_.outcome = ScenarioResult::Outcome::Skipped;
      result_.reason = "nothing of it can be tried on " + slave().name();
    } else if (!scenario_.rule.id.empty() && result_.outcome == ScenarioResult::Outcome::Passed &&
               (result_.skipped_steps > 0 || times_unjudged_)) {
      result_.outcome = ScenarioResult::Outcome::Skipped;
      result_.reason = fmt::format("{} cannot be judged on {}", times_unjudged_ ? "its times" : "all of it", slave().name());
    }
    return std::move(result_);
  }

 private:
  Slave& slave() { return plant_ ? plant_->slave() : *bench_.slave; }
  SerialFormat format() const { return plant_ ? plant_->format() : bench_.format; }

  void add(Finding finding) {
    finding.step = std::min(step_, scenario_.steps.empty() ? 0 : scenario_.steps.size() - 1);
    result_.findings.push_back(std::move(finding));
  }

  /// What of the scenario only a program in simulation can be done to; empty if there is nothing.
  std::string acted_inside() const {
    if (!scenario_.set.empty() || scenario_.clock || !scenario_.input_file.empty()) return "it sets memory, clock or inputs";
    const auto step = std::find_if(scenario_.steps.begin(), scenario_.steps.end(), acts_inside);
    return step == scenario_.steps.end() ? "" : fmt::format("line {}, '{}'", step->position.line, step->key);
  }

  void do_step(const Step& step) {
    if (!plant_ && looks_inside(step)) {
      ++result_.skipped_steps;
      return;
    }
    std::visit([this](const auto& action) { act(action); }, step.action);
  }

  // --- exchanges ---

  /// Waits until the request is to begin; false after a finding if it is too late for that.
  bool wait_for_begin(const ExchangeStep& step) {
    Time begin = slave().now();
    if (step.at)
      begin = begin_ + *step.at;
    else if (last_end_)
      begin = *last_end_ + step.pause.value_or(scenario_.pause).in(format());
    const Time now = slave().now();
    if (step.at && begin < now && plant_) {
      add({.what = "begin",
           .expected = fmt::format("a request at {}", format_duration(begin, 6)),
           .found = fmt::format("it is {} already", format_duration(now, 6)),
           .of_run = true});
      return false;
    }
    if (begin > now) slave().wait(begin - now);
    return true;
  }

  void act(const ExchangeStep& step) {
    if (!wait_for_begin(step)) return;
    const SerialFormat line = format();
    serial::Request request{
        .frame = step.request, .timeout = step.timeout.value_or(scenario_.line.timeout), .gap = step.gap.in(line)};
    if (step.listen) request.silence = step.listen->in(line);
    if (plant_) plant_->begin_exchange();
    serial::Exchange exchange;
    try {
      exchange = slave().exchange(request);
    } catch (const std::invalid_argument& error) {
      if (!plant_) return static_cast<void>(++result_.skipped_steps);  // a way that such a frame cannot go
      return add({.what = "request", .expected = "a request that can be sent", .found = error.what(), .of_run = true});
    } catch (const SlaveLost& error) {
      lost_ = true;
      return add({.what = "slave", .expected = "that it stays there", .found = error.what(), .of_run = true});
    }
    if (plant_) plant_->end_exchange();
    if (!plant_ && request.gap != 0) times_unjudged_ = true;
    last_end_ = exchange.response.empty() ? slave().now() : exchange.response_end;
    last_remark_ = slave().remark();
    if (bench_.exchanges_wanted) result_.seen.push_back({step_, exchange});
    judge(step, exchange, line, request.timeout);
  }

  void act(const ReceiveStep& step) {
    serial::Listening listening{.timeout = step.timeout.value_or(scenario_.line.timeout)};
    if (step.listen) listening.silence = step.listen->in(format());
    if (plant_) plant_->begin_reception();
    serial::Exchange exchange;
    try {
      exchange = slave().receive(listening);
    } catch (const std::invalid_argument&) {
      return static_cast<void>(++result_.skipped_steps);  // a way on which nothing comes unasked
    } catch (const SlaveLost& error) {
      lost_ = true;
      return add({.what = "slave", .expected = "that it stays there", .found = error.what(), .of_run = true});
    }
    if (!exchange.response.empty()) last_end_ = exchange.response_end;
    if (plant_) plant_->end_exchange();
    if (bench_.exchanges_wanted) result_.seen.push_back({step_, exchange});
    const SerialFormat line = format();
    judge(step, exchange, line, listening.timeout);
    if (step.at && !plant_) times_unjudged_ = true;
    if (!step.at || !plant_ || exchange.response.empty() || inside(exchange.response_start, *step.at, line, true)) return;
    add_exchange({.what = "begin",
                  .expected = in_words(*step.at, line),
                  .found = format_duration(exchange.response_start, 6),
                  .exchange = exchange});
  }

  /// What came in the end, or that nothing did.
  std::string found_text(const Bytes& request, const Bytes& response, Time timeout) const {
    if (!response.empty()) return answer_text(request, response);
    if (!request.empty()) return fmt::format("no answer within {}", format_duration(timeout));
    const std::string nothing = fmt::format("nothing within {}", format_duration(timeout));
    return last_remark_.empty() ? nothing : fmt::format("{}; the last request {}", nothing, last_remark_);
  }

  void judge(const Reception& step, const serial::Exchange& exchange, const SerialFormat& line, Time timeout) {
    const Bytes request = serial::bytes_of(exchange.request), response = exchange.response_bytes();
    if (!step.expected.empty() || step.latency || (step.answer_gap && plant_)) ++result_.checks;
    const bool disturbed = exchange.parity_error() || exchange.framing_error();
    const bool as_expected = std::any_of(step.expected.begin(), step.expected.end(), [&](const Expected& expected) {
      return fulfilled(expected, step.has_crc, request, response);
    });
    if (!step.expected.empty() && (!as_expected || disturbed != step.disturbed)) {
      const Expected& expected = step.expected.front();
      Finding finding{.what = request.empty() ? "transmission" : "answer",
                      .expected = in_words(expected, request),
                      .expected_bytes = bytes_expected(expected, step.has_crc, request),
                      .found_bytes = pattern_of(response),
                      .exchange = exchange};
      for (std::size_t i = 1; i < step.expected.size(); ++i)
        finding.expected += " or " + in_words(step.expected[i], request);
      finding.found = found_text(request, response, timeout);
      if (step.disturbed) append(finding.expected, "with parity or framing errors");
      if (disturbed) append(finding.found, exchange.parity_error() ? "parity errors" : "framing errors");
      return add_exchange(std::move(finding));
    }
    judge_times(step, exchange, line);
  }

  static void append(std::string& words, std::string_view more) { words.append(words.empty() ? "" : ", ").append(more); }

  void judge_times(const Reception& step, const serial::Exchange& exchange, const SerialFormat& line) {
    const auto latency = latency_of(exchange);
    if (step.latency && (!latency || !inside(*latency, *step.latency, line, plant_ != nullptr)))
      add_exchange({.what = "latency",
                    .expected = in_words(*step.latency, line),
                    .found = latency                    ? format_duration(*latency, 6)
                             : exchange.request.empty() ? "nothing came"
                                                        : "no answer",
                    .exchange = exchange});
    if (!plant_ && (step.answer_gap || (step.latency && step.latency->from.in(line) > 0))) times_unjudged_ = true;
    if (!step.answer_gap || !plant_) return;
    for (std::size_t i = 1; i < exchange.response.size(); ++i) {
      const Time gap = exchange.response[i].start - exchange.response[i - 1].start - line.character_time();
      if (inside(gap, *step.answer_gap, line, true)) continue;
      return add_exchange({.what = exchange.request.empty() ? "pause inside the transmission" : "pause inside the answer",
                           .expected = in_words(*step.answer_gap, line),
                           .found = fmt::format("{} after character {}", format_duration(gap, 6), i),
                           .exchange = exchange});
    }
  }

  void add_exchange(Finding finding) {
    const serial::Exchange& exchange = *finding.exchange;
    const bool shown = exchange.response.empty() || exchange.response_start >= exchange.request_start;
    if (plant_ && shown && result_.findings.size() < kFindingsShown) finding.timeline = plant_->timeline(exchange);
    add(std::move(finding));
  }

  // --- the other steps ---

  void act(const WaitStep& step) {
    if (step.scans == 0) return slave().wait(step.time.in(format()));
    if (!plant_->wait_scans(step.scans))
      add({.what = "scans",
           .expected = fmt::format("{} scans", step.scans),
           .found = plant_->cpu().state().mode == Mode::Stop ? "the CPU is in STOP" : "they did not come within a minute"});
  }

  void act(const SetStep& step) {
    for (const Assignment& assignment : step.assignments) assign(plant_->simulation(), assignment);
  }

  void act(const MemoryStep& step) {
    ++result_.checks;
    for (const MemoryExpected& expected : step.expected) {
      const Bytes found = in_memory(expected);
      if (!expected.fits(found)) add(memory_finding(plant_->cpu().program(), expected, found));
    }
  }

  Bytes in_memory(const MemoryExpected& expected) { return bytes_of(plant_->cpu().state(), expected.range); }

  /// A program that does not get there cannot be asked what comes after it.
  void act(const WaitUntilStep& step) {
    ++result_.checks;
    const Time timeout = step.timeout.value_or(scenario_.line.timeout);
    const auto fits = [this](const MemoryExpected& expected) { return expected.fits(in_memory(expected)); };
    if (plant_->wait_until([&] { return std::all_of(step.expected.begin(), step.expected.end(), fits); }, timeout)) return;
    for (const MemoryExpected& expected : step.expected) {
      if (fits(expected)) continue;
      Finding finding = memory_finding(plant_->cpu().program(), expected, in_memory(expected));
      finding.what += fmt::format(" after {}", format_duration(timeout));
      if (plant_->cpu().state().mode == Mode::Stop) append(finding.found, "the CPU is in STOP" + why_stopped());
      finding.of_run = true;
      add(std::move(finding));
    }
  }

  void act(const InterruptsStep& step) {
    ++result_.checks;
    for (const InterruptCount& asked : step.counts) {
      const std::uint64_t found = plant_->interrupts(asked);
      if (!inside(found, asked.count))
        add({.what = in_words(asked), .expected = in_words(asked.count), .found = std::to_string(found)});
    }
  }

  static std::string_view text_of(Mode mode) { return mode == Mode::Run ? "RUN" : "STOP"; }

  void act(const ModeStep& step) {
    ++result_.checks;
    mode_expected_ = step.mode;
    const Mode mode = plant_->cpu().state().mode;
    if (mode != step.mode)
      add({.what = "mode",
           .expected = std::string(text_of(step.mode)),
           .found = std::string(text_of(mode)) + why_stopped()});
  }

  void act(const FatalStep& step) {
    ++result_.checks;
    const std::uint16_t code = plant_->cpu().state().fatal_code;
    if (step.code != 0) mode_expected_ = Mode::Stop;
    const auto text = [](std::uint16_t c) {
      return c == 0 ? std::string("none") : fmt::format("{:04X}, {}", c, meaning_of(FatalError{c}));
    };
    if (code != step.code) add({.what = "fatal error", .expected = text(step.code), .found = text(code)});
  }

  void act(const ErrorsStep& step) {
    ++result_.checks;
    const State& state = plant_->cpu().state();
    std::map<std::uint16_t, std::uint64_t> found;
    for (const RuntimeError& error : state.errors)
      if (error.count > 0) found[error.code] += error.count;
    bool right = true;
    for (const ErrorsStep::Error& error : step.errors) {
      right &= inside(found[error.code], error.count);
      found.erase(error.code);
    }
    if (right && found.empty()) return;
    std::string expected;
    for (const ErrorsStep::Error& error : step.errors)
      expected += fmt::format("{}{:04X}: {}", expected.empty() ? "" : ", ", error.code, in_words(error.count));
    const std::string all = errors_text(plant_->cpu());
    add({.what = "run-time errors", .expected = expected.empty() ? "none" : expected, .found = all.empty() ? "none" : all});
  }

  void act(const FaultStep& step) {
    if (step.fault)
      plant_->simulation().inject(*step.fault);
    else
      plant_->simulation().clear_faults();
  }

  void act(const PowerCycleStep& step) {
    plant_->power_cycle(step);
    last_end_.reset();
    last_remark_.clear();
    mode_expected_.reset();
    if (!plant_->get_ready())
      add({.what = "ready", .expected = "the line quiet after power-up", .found = "that never came", .of_run = true});
  }

  /// A STOP that nobody asked about is no success.
  void look_at_mode() {
    if (!plant_ || mode_expected_ || plant_->cpu().state().mode == Mode::Run) return;
    add({.what = "mode at the end", .expected = "RUN, or a step 'mode: stop' or 'fatal:'", .found = "STOP" + why_stopped()});
  }
  std::string why_stopped() {
    const std::string why = errors_text(plant_->cpu());
    return why.empty() ? "" : "\n" + why;
  }

  const Scenario& scenario_;
  const Bench& bench_;
  std::unique_ptr<Plant> plant_;
  std::size_t step_ = 0;
  Time begin_ = 0;                ///< of the scenario on the slave's clock, from which 'at' counts
  bool lost_ = false;             ///< the slave
  bool times_unjudged_ = false;   ///< on a slave that is no program
  std::optional<Time> last_end_;  ///< of the exchange before
  std::string last_remark_;       ///< what its request met
  std::optional<Mode> mode_expected_;
  ScenarioResult result_;
};

}  // namespace

std::optional<Time> latency_of(const serial::Exchange& exchange) {
  const auto latency = exchange.latency();
  return latency && exchange.request.empty() ? std::max<Time>(0, *latency) : latency;
}

ScenarioResult run_scenario(const Scenario& scenario, const Bench& bench) {
  if (!scenario.skipped.empty()) return {.outcome = ScenarioResult::Outcome::Skipped, .reason = scenario.skipped};
  const auto begin = std::chrono::steady_clock::now();
  ScenarioResult result = Run(scenario, bench).result();
  result.host_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace s7200::tools
