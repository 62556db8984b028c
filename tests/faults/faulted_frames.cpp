#include "tests/faults/faulted_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/program/load.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/peers/quiet_time.hpp"
#include "tools/host/files/files.hpp"

namespace s7200::faults {
namespace {

using serial::bytes_of;
using serial::Fault;
using serial::FaultKind;
using serial::Half;
using Chance = serial::Faults::Chance;

constexpr std::uint8_t kStation = 1;
constexpr std::uint8_t kCharacterEvent = 8, kQuietEvent = 10;
constexpr std::size_t kMostShown = 5;

// What a master can see and change: outputs, and V memory below what the slave needs for itself.
constexpr std::uint32_t kRegisterBytes = 3290;

/// A whole number below `end`.
std::uint64_t below(Chance& chance, std::uint64_t end) { return chance.draw() % end; }
std::uint16_t word_below(Chance& chance, std::uint64_t end) { return static_cast<std::uint16_t>(below(chance, end)); }

/// The eight functions mostly within what exists, and now and then something else.
Bytes random_pdu(Chance& chance) {
  const bool odd = below(chance, 8) == 0;
  const std::uint16_t bit = word_below(chance, odd ? 65536 : 40), count = word_below(chance, odd ? 2100 : 24);
  const std::uint16_t word = word_below(chance, odd ? 65536 : 100), words = word_below(chance, odd ? 130 : 6);
  const std::uint16_t value = word_below(chance, 65536);
  switch (below(chance, 9)) {
    case 0:
      return modbus::read_coils(bit, count);
    case 1:
      return modbus::read_inputs(bit, count);
    case 2:
      return modbus::read_holding_registers(word, words);
    case 3:
      return modbus::read_input_registers(word_below(chance, 20), words);
    case 4:
      return modbus::write_coil(bit, value % 2 != 0);
    case 5:
      return modbus::write_register(word, value);
    case 6: {
      std::vector<bool> on;
      for (int i = 0; i < 8 * (1 + value % 3); ++i) on.push_back(below(chance, 2) != 0);
      return modbus::write_coils(static_cast<std::uint16_t>(bit & ~7), on);
    }
    case 7: {
      std::vector<std::uint16_t> values(static_cast<std::size_t>(1 + words % 60));
      for (std::uint16_t& v : values) v = word_below(chance, 65536);
      return modbus::write_registers(word, values);
    }
    default: {
      Bytes bytes(1 + below(chance, 12));
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(chance.draw());
      return bytes;
    }
  }
}

Bytes random_request(Chance& chance) {
  const std::uint64_t whom = below(chance, 20);
  const auto station = whom == 0 ? std::uint8_t{0} : whom == 1 ? static_cast<std::uint8_t>(chance.draw()) : kStation;
  return modbus::rtu_frame(station, random_pdu(chance));
}

serial::Length random_bits(Chance& chance, std::uint64_t most) {
  return {.time = 0, .microbits = static_cast<std::int64_t>(1 + below(chance, most * 1'000'000))};
}

/// Of a kind, at home in a request of so many characters.
Fault random_fault(Chance& chance, std::size_t characters) {
  Fault fault;
  constexpr auto kKindsOfRequests = static_cast<std::uint64_t>(FaultKind::Answer);  // the last kind changes answers only
  fault.kind = static_cast<FaultKind>(below(chance, kKindsOfRequests));
  fault.seed = chance.draw();
  fault.character = 1 + static_cast<std::uint32_t>(below(chance, characters));
  const std::uint64_t half = below(chance, 8);
  fault.of = half == 0 ? Half::Answer : half == 1 ? Half::Both : Half::Request;
  fault.offset = random_bits(chance, 12);
  switch (fault.kind) {
    case FaultKind::Noise:
      fault.error_rate = 1e-4 * static_cast<double>(1 + below(chance, 10)) * static_cast<double>(1 + below(chance, 30));
      break;
    case FaultKind::Flip:
      fault.bit = static_cast<int>(below(chance, 11)) - 1;
      break;
    case FaultKind::Break:
      fault.length = random_bits(chance, 40);
      break;
    case FaultKind::Glitch:
      fault.length = random_bits(chance, below(chance, 2) == 0 ? 1 : 14);
      break;
    case FaultKind::Missing:
      fault.count = 1 + static_cast<std::uint32_t>(below(chance, 7));
      break;
    case FaultKind::Extra:
      fault.character = static_cast<std::uint32_t>(below(chance, characters + 1));
      fault.count = 1 + static_cast<std::uint32_t>(below(chance, 3));
      if (below(chance, 3) == 0) fault.bytes = {kStation};
      break;
    case FaultKind::Gap:
      fault.length.time = 1 + static_cast<Time>(below(chance, 25 * kMillisecond));
      if (below(chance, 4) == 0) fault.length.time = 5 * kMillisecond + static_cast<Time>(below(chance, 2 * kMillisecond));
      break;
    case FaultKind::Collision:
      fault.count = 1 + static_cast<std::uint32_t>(below(chance, 10));
      break;
    case FaultKind::Baud:
      fault.clock_error = static_cast<std::int32_t>(below(chance, 200'000)) - 100'000;
      fault.station = below(chance, 2) == 0 ? serial::Station::Plc : serial::Station::Master;
      break;
    case FaultKind::Cut:
      fault.lasts = 1 + static_cast<Time>(below(chance, 30 * kMillisecond));
      break;
    case FaultKind::Answer:
    case FaultKind::Parity:
    case FaultKind::Framing:
    case FaultKind::Echo:
      break;
  }
  return fault;
}

/// What went in and out at the slave's port.
class Log final : public TraceSink {
 public:
  void record(const TraceRecord& r) override {
    switch (r.kind) {
      case TraceKind::CharacterIgnored:
        if (r.code != 0) break;  // the receiver was off
        [[fallthrough]];
      case TraceKind::CharacterReceived:
        received.push_back({r.byte, r.parity_error, r.framing_error, r.since, r.at});
        last = r.at;
        break;
      case TraceKind::CharacterSent:
        sent.push_back(r.byte);
        last = r.at;
        break;
      case TraceKind::ServiceBegin:
        if (r.event == kCharacterEvent || r.event == kQuietEvent) services.push_back({r.event, r.since, r.at});
        break;
      default:
        break;
    }
  }

  void clear() {
    received.clear();
    sent.clear();
    services.clear();
  }

  struct Service {
    std::uint8_t event;
    Time since, at;
  };
  std::vector<ReceivedCharacter> received;
  Bytes sent;
  std::vector<Service> services;
  Time last = 0;
};

using Frame = std::vector<ReceivedCharacter>;

/// What was received falls into frames where the quiet time passed. The timer starts when the program gets to it, and the
/// next character is noticed when the program gets to that: close to the quiet time the order in which the two were served
/// decides. When the time is up while the character's routine runs, and has not started it afresh yet, the frame ends after
/// that character.
std::vector<Frame> frames_of(const Log& log, Time quiet) {
  constexpr Time kInDoubt = 1500 * kMicrosecond, kLongestRoutine = kMillisecond;
  std::vector<Frame> frames;
  bool split_behind_this_one = true;
  for (std::size_t i = 0; i < log.received.size(); ++i) {
    const ReceivedCharacter& character = log.received[i];
    bool split = split_behind_this_one;
    split_behind_this_one = false;
    const Time since_last = i == 0 ? kNever : character.end - log.received[i - 1].end;
    if (since_last >= quiet && since_last < quiet + kInDoubt) {
      const auto served = std::find_if(log.services.begin(), log.services.end(), [&](const Log::Service& s) {
        return s.event == kCharacterEvent && s.since == character.end;
      });
      const Time at = served == log.services.end() ? character.end : served->at;
      for (const Log::Service& s : log.services) {
        const bool meant = s.event == kQuietEvent && s.since > log.received[i - 1].end && s.since < at + kLongestRoutine;
        if (!meant) continue;
        (s.at <= at ? split : split_behind_this_one) = true;
      }
    } else if (since_last >= quiet) {
      split = true;
    }
    if (split) frames.emplace_back();
    frames.back().push_back(character);
  }
  return frames;
}

bool any_parity_error(const Frame& frame) {
  return std::any_of(frame.begin(), frame.end(), [](const ReceivedCharacter& c) { return c.parity_error; });
}

bool any_framing_error(const Frame& frame) {
  return std::any_of(frame.begin(), frame.end(), [](const ReceivedCharacter& c) { return c.framing_error; });
}

/// What a slave made of something: the answer, and what a master finds in its memory afterwards.
struct Outcome {
  Bytes answer;
  std::array<std::uint8_t, 16> outputs{};
  std::array<std::uint8_t, kRegisterBytes> registers{};

  explicit Outcome(Bytes sent, const State& state) : answer(std::move(sent)) {
    std::copy_n(&state.image[image::kQ], outputs.size(), outputs.begin());
    std::copy_n(&state.image[image::kV], registers.size(), registers.begin());
  }
  bool operator==(const Outcome&) const = default;
};

class Slave {
 public:
  explicit Slave(std::shared_ptr<const Program> program) : simulation(std::move(program)) {
    simulation.cpu().set_sink(&log);
  }

  /// Sends; settle() waits for what comes of it.
  void exchange(const Bytes& request) {
    log.clear();
    log.last = simulation.time();
    simulation.master().start({.frame = serial::to_frame(request), .timeout = kShort}, simulation.time());
    simulation.finish_exchange();
  }

  /// Waits until nothing has been on the line for as long as the slave may need for what it heard and an answer of any
  /// length. The tip takes up to 0.6 ms a character (estimated times).
  void settle() {
    constexpr Time kCharacter = 800 * kMicrosecond, kScans = 40 * kMillisecond, kLongestAnswer = 255;
    const auto end = [&] {
      const Time characters = static_cast<Time>(log.received.size()) + (log.sent.empty() ? kLongestAnswer : 0);
      return log.last + kScans + characters * kCharacter;
    };
    while (simulation.time() < end())
      if (simulation.run_until(end()) != serial::Halt::Time) return;
  }

  bool in_run() const { return simulation.cpu().state().mode == Mode::Run; }
  Outcome outcome() const { return Outcome(log.sent, simulation.cpu().state()); }

  static constexpr Time kShort = 2 * kMillisecond;
  serial::Simulation simulation;
  Log log;
};

std::string shown(const std::vector<Frame>& frames) {
  std::string text;
  for (const Frame& frame : frames) {
    if (!text.empty()) text += " |";
    for (const ReceivedCharacter& c : frame)
      text += fmt::format(" {:02x}{}{}", c.byte, c.parity_error ? "p" : "", c.framing_error ? "f" : "");
  }
  return text.empty() ? " nothing" : text;
}

class Trials {
 public:
  explicit Trials(const std::shared_ptr<const Program>& program) : slave_(program), second_(program) {
    serial::Simulation& simulation = slave_.simulation;
    simulation.power_up();
    const SerialFormat slowest{300, 8, Parity::Even, 1};
    if (!simulation.run_until_ready(serial::default_quiet(slowest), 10 * kSecond))
      throw std::runtime_error("the program is not ready within 10 s");
    simulation.configure_master(simulation.cpu().state().port[0].format);
    quiet_ = simulation.cpu().state().image[image::kSM + 34] * kMillisecond;
    ready_ = simulation.snapshot();
  }

  void run_block(std::uint64_t seed, std::uint64_t frames) {
    Chance chance(seed);
    slave_.simulation.restore(ready_);
    fill(chance);
    for (std::uint64_t i = 0; i < frames; ++i) {
      place_ = fmt::format("seed {}, frame {} of the block", seed, i);
      trial(chance);
    }
  }

  Result result;

 private:
  void fill(Chance& chance) {
    Bytes content(2032);
    for (std::uint8_t& byte : content) byte = static_cast<std::uint8_t>(chance.draw());
    slave_.simulation.cpu().poke(image::kV, content);
  }

  void trial(Chance& chance) {
    serial::Simulation& simulation = slave_.simulation;
    simulation.run_until(simulation.time() + static_cast<Time>(below(chance, 2 * kMillisecond)));  // anywhere in the scan
    before_ = simulation.snapshot();
    const Outcome nothing({}, simulation.cpu().state());
    request_ = random_request(chance);
    for (std::uint64_t count = 1 + below(chance, 4) / 2; count > 0; --count)
      simulation.inject(random_fault(chance, request_.size()));
    ++result.counts.frames;
    slave_.exchange(request_);
    note_faults();
    simulation.clear_faults();
    slave_.settle();
    judge(nothing);
    check_good_frame();
  }

  void note_faults() {
    faults_.clear();
    for (const auto& injected : slave_.simulation.faults().state().injected) {
      result.counts.happened[static_cast<std::size_t>(injected.fault.kind)] += injected.count;
      faults_ += " " + serial::to_text(injected.fault);
    }
  }

  void judge(const Outcome& nothing) {
    Counts& counts = result.counts;
    const std::vector<Frame> frames = frames_of(slave_.log, quiet_);
    std::vector<Outcome> earned;  // any one of them will do
    bool owes_silence = true;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (any_parity_error(frames[i]) || !modbus::crc_ok(bytes_of(frames[i]))) continue;
      earned.push_back(earned_by(bytes_of(frames[i])));
      if (i == 0) owes_silence = false;
      if (i != 0) ++counts.right_behind_another;
      const Bytes bytes = bytes_of(frames[i]);
      if (differs_by_zeros_at_its_end(bytes))
        ++counts.zeros_at_its_end;
      else if (bytes != request_)
        ++counts.right_by_chance;
      counts.with_framing_errors_only += any_framing_error(frames[i]) ? 1U : 0U;
    }
    if (owes_silence) earned.push_back(nothing);
    count(frames);
    const Outcome got = slave_.outcome();
    counts.answered += got.answer.empty() ? 0U : 1U;
    if (slave_.in_run() && std::find(earned.begin(), earned.end(), got) != earned.end()) return;
    ++counts.wrong;
    show(fmt::format("answered '{}' instead of '{}', {} outputs and registers{}", serial::to_hex(got.answer),
                     serial::to_hex(earned[0].answer),
                     got.outputs == earned[0].outputs && got.registers == earned[0].registers ? "same" : "other",
                     slave_.in_run() ? "" : ", in STOP"),
         frames);
  }

  /// The CRC of a frame that ends with its CRC is 0, and stays 0 over zeros.
  bool differs_by_zeros_at_its_end(const Bytes& bytes) const {
    const bool longer = bytes.size() > request_.size();
    const Bytes &whole = longer ? bytes : request_, &part = longer ? request_ : bytes;
    return whole.size() > part.size() && std::equal(part.begin(), part.end(), whole.begin()) &&
           std::all_of(whole.begin() + static_cast<std::ptrdiff_t>(part.size()), whole.end(),
                       [](std::uint8_t byte) { return byte == 0; });
  }

  /// Into which of the main classes the request falls.
  void count(const std::vector<Frame>& frames) {
    Counts& counts = result.counts;
    if (frames.size() > 1) ++counts.split;
    if (std::any_of(frames.begin(), frames.end(), any_parity_error)) {
      ++counts.with_errors;
    } else if (frames.size() == 1 && bytes_of(frames[0]) == request_) {
      ++counts.untouched;
    } else if (std::none_of(frames.begin(), frames.end(), [](const Frame& f) { return modbus::crc_ok(bytes_of(f)); })) {
      ++counts.with_wrong_crc;
    }
  }

  Outcome earned_by(const Bytes& bytes) {
    second_.simulation.restore(before_);
    second_.exchange(bytes);
    second_.settle();
    return second_.outcome();
  }

  /// Behind the quiet line of settle().
  void check_good_frame() {
    serial::Simulation& simulation = slave_.simulation;
    const State& state = simulation.cpu().state();
    Bytes expected{kStation, 3, 2, state.image[image::kV], state.image[image::kV + 1]};
    modbus::add_crc(expected);
    ++result.counts.good_frames;
    slave_.exchange(modbus::rtu_frame(kStation, modbus::read_holding_registers(0, 1)));
    slave_.settle();
    if (slave_.log.sent == expected) return;
    ++result.counts.unanswered;
    show(fmt::format("a good frame after it was answered '{}' instead of '{}'", serial::to_hex(slave_.log.sent),
                     serial::to_hex(expected)),
         frames_of(slave_.log, quiet_));
  }

  void show(const std::string& what, const std::vector<Frame>& frames) {
    if (result.wrong.size() == kMostShown) return;
    result.wrong.push_back(fmt::format("{}: {}\n  request  {}\n  faults  {}\n  received{}\n", place_, what,
                                       serial::to_hex(request_), faults_, shown(frames)));
  }

  Slave slave_, second_;
  Time quiet_ = 0;
  serial::Simulation::Snapshot ready_, before_;
  Bytes request_;
  std::string place_, faults_;
};

}  // namespace

Counts& Counts::operator+=(const Counts& other) {
  frames += other.frames;
  untouched += other.untouched;
  with_errors += other.with_errors;
  with_wrong_crc += other.with_wrong_crc;
  with_framing_errors_only += other.with_framing_errors_only;
  zeros_at_its_end += other.zeros_at_its_end;
  right_by_chance += other.right_by_chance;
  split += other.split;
  right_behind_another += other.right_behind_another;
  answered += other.answered;
  good_frames += other.good_frames;
  for (std::size_t i = 0; i < happened.size(); ++i) happened[i] += other.happened[i];
  wrong += other.wrong;
  unanswered += other.unanswered;
  return *this;
}

Result run_faulted_frames(const std::shared_ptr<const Program>& program, std::uint64_t seed, std::uint64_t frames) {
  Trials trials(program);
  for (std::uint64_t sent = 0; sent < frames; sent += kBlock, ++seed)
    trials.run_block(seed, std::min(kBlock, frames - sent));
  return std::move(trials.result);
}

std::string to_text(const Counts& c) {
  std::string text = fmt::format(
      "{:9} frames with faults\n{:9}   as sent\n{:9}   with a parity error\n{:9}   with a wrong CRC, or nothing received\n"
      "{:9}   with a framing error only\n{:9}   with zeros more or fewer at its end, right CRC\n{:9}   other bytes, right "
      "CRC by "
      "chance\n{:9}   received in pieces, {} of them "
      "with a "
      "right CRC after another frame\n{:9} answered\n{:9} good frames after a quiet line\n",
      c.frames, c.untouched, c.with_errors, c.with_wrong_crc, c.with_framing_errors_only, c.zeros_at_its_end,
      c.right_by_chance, c.split, c.right_behind_another, c.answered, c.good_frames);
  text += "          faults:";
  for (const serial::FaultKindInfo& kind : serial::fault_kinds())
    text += fmt::format(" {} {}", kind.name, c.happened[static_cast<std::size_t>(kind.kind)]);
  return text + fmt::format("\n{:9} wrong answers\n{:9} good frames not answered\n", c.wrong, c.unanswered);
}

std::shared_ptr<const Program> program_of(const std::string& text, const std::string& name) {
  auto source = read_source(text, name);
  if (!source) throw std::runtime_error(fmt::format("cannot read {}: {}", name, source.why()));
  const CpuModel& model = *find_cpu("214");
  CheckResult result = check(std::move(source->parsed), model, default_times(model));
  if (!result.program) throw std::runtime_error(name + " has errors");
  return result.program;
}

std::shared_ptr<const Program> load_program(const std::string& path) {
  const auto bytes = tools::read_file(path);
  if (!bytes) throw std::runtime_error(fmt::format("cannot read {}: {}", path, bytes.why()));
  return program_of(*bytes, path);
}

}  // namespace s7200::faults
