#include "tools/trials/trial_bench.hpp"

#include <algorithm>

namespace s7200::tools {
namespace {

constexpr EventOwner kOwnerOfPorts{0}, kOwnerOfCpu{1}, kOwnerOfLine{2};
constexpr std::uint8_t kCharacter = 0;
constexpr Time kSlice = 20 * kMillisecond;  ///< that is executed in one go

}  // namespace

void TrialBench::Port::configure(const SerialFormat& format, Time) { state.format = format; }

void TrialBench::Port::enable_receiver(bool enabled, Time at) {
  if (enabled && !state.listens) state.listens_since = at;
  state.listens = enabled;
}

void TrialBench::Port::send(std::uint8_t byte, Time at) {
  if (number == bench->number_) bench->done_.sent.push_back({at, byte, bench->transmit_op_});
  state.sends = true;
  state.sent_until = at + state.format.character_time();
  bench->queue_.schedule(state.sent_until, kOwnerOfPorts, number);
}

void TrialBench::Port::send_break(int bit_times, Time at) {
  state.sends = true;
  state.sent_until = at + state.format.bit_times(bit_times);
  bench->queue_.schedule(state.sent_until, kOwnerOfPorts, number);
}

TrialBench::TrialBench(std::shared_ptr<const Program> program, std::uint8_t port)
    : program_(std::move(program)),
      cpu_(program_, queue_, kOwnerOfCpu, {&port_[0], &port_[1]}),
      number_(port),
      contacts_(cpu_) {
  for (std::uint8_t i = 0; i < port_.size(); ++i) {
    port_[i].bench = this;
    port_[i].number = i;
  }
  cpu_.use_steady_scans(SteadyScansUse::On);
  cpu_.set_sink(this);
}

void TrialBench::power_up() {
  queue_ = EventQueue();
  for (Port& port : port_) port.state = {};
  done_ = {};
  ended_ = false;
  powered_up_at_ = 0;
  cpu_.power_up();
}

void TrialBench::handle_due() {
  while (queue_.next() <= cpu_.time()) {
    const Event event = queue_.pop();
    if (event.owner == kOwnerOfCpu) cpu_.handle(event);
    if (event.owner != kOwnerOfPorts) continue;
    port_[event.what].state.sends = false;
    cpu_.character_sent(event.at, event.what);
  }
}

void TrialBench::run_until(Time end) {
  cpu_.pause_at_scan_end(static_cast<bool>(look_));
  while (cpu_.time() < end && !stopped() && !ended_) {
    cpu_.run(end, kSlice);
    handle_due();
    if (look_ && !look_(cpu_)) ended_ = true;
  }
}

std::uint8_t TrialBench::port_of(const Stimulus& stimulus) const {
  return static_cast<std::uint8_t>(stimulus.other_port ? 1 - number_ : number_);
}

/// Whether a port takes a character that has begun at `start`.
bool TrialBench::hears(std::uint8_t port, Time start, const SerialFormat& format) const {
  const PortState& state = port_[port].state;
  return state.listens && state.listens_since <= start && state.format == format;
}

/// Runs until something comes from the line; false if the run has ended before.
bool TrialBench::reach(Time at) {
  queue_.schedule(at, kOwnerOfLine, kCharacter);
  run_until(at);
  return !stopped() && !ended_;
}

Time TrialBench::give(const Stimulus& frame) {
  const std::uint8_t number = port_of(frame);
  const PortState& port = port_[number].state;
  const SerialFormat format = port.format;
  const Time to_report = format.half_bits(2 * (format.bits() - format.stop_bits) + 1);
  Time start = cpu_.time();
  for (std::size_t i = 0; i < frame.bytes.size(); ++i) {
    if (!reach(start + to_report)) return cpu_.time();
    done_.interrupted |= port.sent_until > start;
    const bool bad_stop = frame.damaged == i + 1 && frame.bad_stop;
    if (hears(number, start, format))
      cpu_.character_received(
          {.byte = static_cast<std::uint8_t>(format.data_bits == 7 ? frame.bytes[i] & 0x7F : frame.bytes[i]),
           .parity_error = frame.damaged == i + 1 && !frame.bad_stop && format.parity != Parity::None,
           .framing_error = bad_stop,
           .start = start,
           .end = start + to_report,
           .line_break = bad_stop && frame.bytes[i] == 0 && format.parity != Parity::Odd},
          number);
    start += format.character_time() + frame.gap;
  }
  const Time end = start - frame.gap, had_sent = port.sent_until;
  run_until(end + kPatience);
  while (port.sent_until > had_sent && !stopped() && !ended_ &&
         (port.sends || cpu_.time() < port.sent_until + port.format.silence()))
    run_until(std::max(cpu_.time() + 1, port.sent_until + port.format.silence()));
  return cpu_.time();
}

/// A receiver takes a break for a character of zeros without a stop bit, and hears no more of it.
Time TrialBench::give_break(const Stimulus& stimulus) {
  const std::uint8_t number = port_of(stimulus);
  const SerialFormat format = port_[number].state.format;
  const Time start = cpu_.time(), end = start + format.half_bits(2 * (format.bits() - format.stop_bits) + 1);
  if (!reach(end)) return cpu_.time();
  if (hears(number, start, format))
    cpu_.character_received({.parity_error = format.parity == Parity::Odd,
                             .framing_error = true,
                             .start = start,
                             .end = end,
                             .line_break = true},
                            number);
  run_until(start + kBreak);
  return cpu_.time();
}

Time TrialBench::cycle_power() {
  const RetentiveMemory memory = cpu_.retentive_memory();
  const State before = cpu_.state();
  queue_ = EventQueue();
  for (Port& port : port_) port.state = {};
  powered_up_at_ = before.time;
  cpu_.power_up(true, &memory, before.time);
  for (std::uint32_t byte = 0; byte < before.terminals.size(); ++byte)
    cpu_.set_input(byte, before.terminals[byte], before.time);
  poke(image::kAI, {before.analog_terminals.begin(), before.analog_terminals.end()});
  watched_value_ = static_cast<std::uint8_t>(cpu_.state().image[watched_place_] & watched_mask_);
  run_until(before.time + kReady);
  return cpu_.time();
}

Time TrialBench::apply(const Stimulus& stimulus, Time at) {
  run_until(at);
  if (stopped() || ended_) return cpu_.time();
  switch (stimulus.what) {
    case Stimulus::What::Input:
      cpu_.set_input(stimulus.place, stimulus.bytes.front(), cpu_.time());
      break;
    case Stimulus::What::Memory:
      poke(stimulus.place, stimulus.bytes);
      break;
    case Stimulus::What::Frame:
      return give(stimulus);
    case Stimulus::What::Break:
      return give_break(stimulus);
    case Stimulus::What::Power:
      return cycle_power();
  }
  return cpu_.time();
}

std::vector<Time> TrialBench::apply(const Trial& trial) {
  std::vector<Time> begun;
  for (const Stimulus& stimulus : trial) {
    run_until(cpu_.time() + stimulus.wait);
    begun.push_back(cpu_.time());
    apply(stimulus, cpu_.time());
  }
  return begun;
}

void TrialBench::record(const TraceRecord& record) {
  if (record.kind == TraceKind::OutputChanged) done_.outputs.push_back({record.at, record.op, record.byte});
  if (record.kind == TraceKind::Transmit && record.port == number_) transmit_op_ = record.op;
}

void TrialBench::instruction(const InstructionRecord& record) {
  if (watching_) contacts_.look_at(record);
  if (watched_mask_ == 0) return;
  const auto value = static_cast<std::uint8_t>(cpu_.state().image[watched_place_] & watched_mask_);
  if (value != watched_value_ || (record.powered && writers_[record.op])) last_writer_ = record.op;
  watched_value_ = value;
}

void TrialBench::watch_writes(std::uint32_t place, std::uint8_t mask, const std::vector<std::uint32_t>& writers) {
  watched_place_ = place;
  watched_mask_ = mask;
  watched_value_ = static_cast<std::uint8_t>(cpu_.state().image[place] & mask);
  writers_.assign(cpu_.program().ops.size(), false);
  for (const std::uint32_t op : writers) writers_[op] = true;
  last_writer_.reset();
}

TrialBench::Snapshot TrialBench::snapshot() const {
  Snapshot snapshot{cpu_.state(), queue_, {}, done_, powered_up_at_};
  for (std::size_t i = 0; i < port_.size(); ++i) snapshot.port[i] = port_[i].state;
  return snapshot;
}

void TrialBench::restore(const Snapshot& snapshot) {
  cpu_.restore(snapshot.cpu);
  queue_ = snapshot.queue;
  for (std::size_t i = 0; i < port_.size(); ++i) port_[i].state = snapshot.port[i];
  done_ = snapshot.done;
  powered_up_at_ = snapshot.powered_up_at;
  ended_ = false;
}

}  // namespace s7200::tools
