#include "tools/views/state/machine_text.hpp"

#include <fmt/format.h>

#include <bit>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/special_bits.hpp"
#include "interpreter/program/operands/operands.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "interpreter/trace/text/text_trace.hpp"
#include "serial_sim/modbus/request.hpp"

namespace s7200::tools {
namespace {

constexpr std::uint8_t kTimed0 = event::kTimed0;

std::string scan_text(const State& state) { return fmt::format("scan {}", state.scans + 1); }

std::string_view phase_text(Phase phase) {
  switch (phase) {
    case Phase::ReadInputs:
      return "the system reading the inputs";
    case Phase::Program:
      return "the program";
    case Phase::Communication:
      return "the system's communication";
    case Phase::SelfTest:
      return "the system's self-test";
    case Phase::WriteOutputs:
      return "the system writing the outputs";
    case Phase::SaveToEeprom:
      return "the system saving a value to EEPROM";
  }
  return {};
}

std::string line_text(const Program& program, const Listing& listing, std::uint32_t op) {
  return fmt::format("{} {}", listing.routine_of(op), stl::printable(line_of(op, program)));
}

/// The calls as text: `SBR 63 line 700, called in SBR 51 line 340, called in main line 12`
std::string calls_text(const Cpu& cpu, const Listing& listing, std::uint32_t op) {
  const State& state = cpu.state();
  std::string text = line_text(cpu.program(), listing, op);
  for (std::size_t depth = state.call_depth; depth > 0; --depth)
    text += ", called in " + line_text(cpu.program(), listing, state.calls[depth - 1].return_to - 1);
  return text;
}

std::string where_text(const Cpu& cpu, const Listing& listing) {
  const State& state = cpu.state();
  if (state.mode == Mode::Stop) return "STOP: no program runs";
  const std::uint32_t op = state.in_interrupt ? state.saved.return_to : state.pc;
  const std::string scan =
      state.phase == Phase::Program ? calls_text(cpu, listing, op) : std::string(phase_text(state.phase));
  if (!state.in_interrupt) return scan;
  return fmt::format("{}, serving {} since {}\n           interrupted: {}", line_text(cpu.program(), listing, state.pc),
                     event_text(state.serving_event), moment_text(state.serving_since), scan);
}

std::string real_text(std::uint32_t value) { return stl::to_text(stl::Real{std::bit_cast<float>(value)}); }

std::string accumulators_text(const Cpu& cpu) {
  std::string text;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t at = image::kAC + 4 * i, value = load32(&cpu.state().image[at]);
    text += fmt::format("AC{:<9}16#{:08X} {:>11}{}\n", i, value, static_cast<std::int32_t>(value),
                        cpu.program().is_real(at) ? fmt::format(" {:>15}", real_text(value)) : "");
  }
  return text;
}

std::string flags_text(std::uint8_t flags) {
  const std::string text = special_bits_text(sm::kFlags, flags);
  return text.empty() ? "none of SM1 is set" : text;
}

std::string queue_text(const State& state, std::size_t queue, const CpuModel& model) {
  static constexpr std::string_view kNames[] = {"communication", "input/output", "timed"};
  const InterruptQueue& waiting = state.queue[queue];
  std::string text = fmt::format("{} {} of {}", kNames[queue], waiting.count, model.queue_depth[queue]);
  for (std::size_t i = 0; i < waiting.count; ++i) {
    const QueuedInterrupt& entry = waiting.entry[i];
    text += fmt::format("\n           {} since {}", waiting_text(entry), moment_text(entry.at));
  }
  return text;
}

std::string attachments_text(const State& state) {
  std::string text;
  for (std::uint8_t event = 0; event < kEvents; ++event) {
    if (state.attached[event] == kNotAttached) continue;
    const bool timed = event == kTimed0 || event == kTimed0 + 1;
    text += fmt::format("{:<11}event {} → INT {}  {}{}\n", text.empty() ? "attached" : "", event, state.attached[event],
                        find_event(event)->cause,
                        timed ? ", every " + format_duration(state.timed_interval[event - kTimed0]) : "");
  }
  return text.empty() ? "attached   no event\n" : text;
}

/// The settings in SMB30 or SMB130, in words.
std::string control_words(const State& state, std::size_t port) {
  static constexpr std::string_view kModes[] = {"PPI slave", "Freeport", "PPI master", "reserved, as PPI slave"};
  return fmt::format("{}{}", kModes[state.image[kPorts[port].control] & sm::kProtocol],
                     state.port[port].active ? ", " + format_text(state.port[port].format) : "");
}

std::string control_text(const State& state, std::size_t port) {
  const std::uint32_t at = kPorts[port].control;
  const std::uint8_t control = state.image[at];
  return fmt::format("{:<11}16#{:02X} = 2#{:08b}: {}", fmt::format("SMB{}", at - image::kSM), control, control,
                     control_words(state, port));
}

std::string routine_text(const State& state, std::uint8_t event) {
  const std::uint8_t routine = state.attached[event];
  if (routine == kNotAttached) return fmt::format("event {} is not attached", event);
  return fmt::format("event {} → INT {}", event, routine);
}

/// The answer that the port's master waits for.
std::string ppi_text(const PpiPort& port) {
  switch (port.job) {
    case PpiPort::Job::Waiting:
      return fmt::format(": a request of station {} waits for the end of the scan", port.master);
    case PpiPort::Job::Ready:
      return fmt::format(": its answer waits for a poll of station {}", port.master);
    case PpiPort::Job::None:
    case PpiPort::Job::Delivered:
      return {};
  }
  return {};
}

/// The event of a received character is of no interest in a program that receives with RCV instead.
std::string receiver_text(const Cpu& cpu, std::size_t number) {
  const State& state = cpu.state();
  const Freeport& port = state.port[number];
  std::string is = "on";
  if (port.transmitting) is = "off while sending";
  if (!port.active) is = fmt::format("PPI, station {}{}", state.station[number], ppi_text(state.ppi[number]));
  const std::uint8_t event = kPorts[number].received;
  const bool by_rcv_only = cpu.program().receives_messages[number] && state.attached[event] == kNotAttached;
  return fmt::format("receiver   {}{}; SMB2 = 16#{:02X}, parity error SM3.0 = {}", is,
                     by_rcv_only ? "" : "; " + routine_text(state, event), state.image[sm::kReceivedCharacter],
                     state.image[sm::kReceiveStatus] & sm::kParityError);
}

/// NETR and NETW that are on the list; nothing if there are none.
std::string network_text(const State& state, std::size_t port) {
  std::string text;
  const NetworkPort& network = state.network[port];
  for (std::size_t i = 0; i < network.count; ++i) {
    const NetworkPort::Job& job = network.jobs[i];
    text += fmt::format("{}{} {}", i == 0 ? "jobs       " : ", ", job.writes ? "NETW" : "NETR", byte_text(job.table));
  }
  return text.empty() ? text : text + "\n";
}

/// `no RCV waits, SMB86 = 16#20 (end character)`: the status is that of the last RCV.
std::string no_reception_text(const State& state, std::size_t port) {
  const std::uint32_t at = kPorts[port].message;
  const std::uint8_t status = state.image[at];
  const std::string meanings = special_meanings_text(at, status);
  return fmt::format("no RCV waits, SMB{} = 16#{:02X}{}", at - image::kSM, status,
                     meanings.empty() ? "" : fmt::format(" ({})", meanings));
}

/// What RCV is doing; empty in a program without RCV at this port.
std::string message_text(const Cpu& cpu, std::size_t port) {
  const State& state = cpu.state();
  if (!cpu.program().receives_messages[port]) return {};
  const MessageReceiver& message = state.port[port].message;
  const bool searching = message.phase == MessageReceiver::Phase::Search;
  return fmt::format("RCV        {}; {}\n",
                     message.phase == MessageReceiver::Phase::Off ? no_reception_text(state, port)
                     : searching                                  ? "waits for the start of a message"
                                 : fmt::format("has {} of at most {}", counted(message.stored, "character"), message.most),
                     routine_text(state, kPorts[port].received_message));
}

std::string transmitter_text(const State& state, std::size_t number) {
  const Freeport& port = state.port[number];
  std::string is = "idle";
  if (port.transmitting)
    is = port.sending_break ? "sending a break" : fmt::format("sending {:02x}, {} more to send", port.on_line, port.left);
  return fmt::format("transmitter {}; {}", is, routine_text(state, kPorts[number].sent));
}

std::string port_text(const Cpu& cpu, std::size_t port) {
  const State& state = cpu.state();
  return fmt::format("{}\n{}\n{}{}{}\n", control_text(state, port), receiver_text(cpu, port), message_text(cpu, port),
                     network_text(state, port), transmitter_text(state, port));
}

std::string master_text(const serial::Requester::State& master) {
  using Phase = serial::Requester::Phase;
  const std::string request = serial::to_hex(master.request.frame);
  switch (master.phase) {
    case Phase::Idle:
      if (master.request.frame.empty()) return "has sent nothing";
      return master.exchange.given_up ? fmt::format("idle; has given up {}", request) : "idle";
    case Phase::Sending:
      return fmt::format("sending {}: character {} of {}", request, master.sent, master.request.frame.size());
    case Phase::Waiting:
      return fmt::format("waiting for an answer to {}", request);
    case Phase::Receiving:
      return fmt::format("receiving: {}", serial::to_hex(master.exchange.response_bytes()));
  }
  return {};
}

}  // namespace

std::string control_byte_text(const State& state, std::size_t port) {
  const std::uint32_t at = kPorts[port].control;
  return fmt::format("SMB{} = 16#{:02X}: {}", at - image::kSM, state.image[at], control_words(state, port));
}

std::string moment_text(Time time) {
  const std::string clock = clock_text(time);
  return clock.substr(clock.find_first_not_of(' ')) + " ms";
}

std::string event_text(std::uint8_t event) { return fmt::format("event {} ({})", event, find_event(event)->cause); }

std::string waiting_text(const QueuedInterrupt& entry) {
  return event_text(entry.event) + (is_receive_event(entry.event) ? fmt::format(" {:02x}", entry.byte) : "");
}

namespace {

std::string start_text(const MessageReceiver& message, const ReceiveChoices& choices) {
  using namespace sm::message;
  const bool has_character = (message.control & kFromStart) != 0;
  std::string text;
  if ((message.control & kFromIdleLine) && message.idle_time > 0)
    text = "an idle line of " + format_duration(message.idle_time);
  if (message.control & kFromBreak)
    text += text.empty() ? "a break" : choices.idle_or_break ? " or a break" : " and a break";
  if (has_character)
    text += fmt::format("{}the character 16#{:02X}", text.empty() ? "" : ", then ", message.start_character);
  return text.empty() ? "any character" : text;
}

/// What has to come before a message can start has come; empty if it has not, or if nothing has to.
std::string begun_text(const MessageReceiver& message, const ReceiveChoices& choices) {
  using namespace sm::message;
  const bool asks_idle = (message.control & kFromIdleLine) != 0 && message.idle_time > 0;
  const bool asks_break = (message.control & kFromBreak) != 0;
  const bool idle = asks_idle && message.was_idle, had_break = asks_break && message.had_break;
  const bool lacks_one = asks_idle && asks_break && !choices.idle_or_break && idle != had_break;
  if (lacks_one || !(idle || had_break)) return {};
  return had_break ? "the break before it has come"
                   : fmt::format("the line has been idle for {}", format_duration(message.idle_time));
}

std::string end_text(const MessageReceiver& message) {
  using namespace sm::message;
  std::string text;
  if (message.control & kHasEnd) text = fmt::format("the character 16#{:02X} or ", message.end_character);
  text += fmt::format("{} ({} so far)", counted(message.most, "character"), message.stored);
  if (message.control & kTimed)
    text += fmt::format(" or {} {}", format_duration(message.timeout),
                        message.control & kWholeMessage ? "since its beginning" : "without a character");
  return text;
}

}  // namespace

std::string awaited_text(const MessageReceiver& message, const ReceiveChoices& choices) {
  switch (message.phase) {
    case MessageReceiver::Phase::Off:
      return {};
    case MessageReceiver::Phase::Search:
      if (const std::string begun = begun_text(message, choices); !begun.empty())
        return fmt::format(
            "the first character of a message{}; {}",
            message.control & sm::message::kFromStart ? fmt::format(", 16#{:02X}", message.start_character) : "", begun);
      return "the start of a message: " + start_text(message, choices);
    case MessageReceiver::Phase::Message:
      return "the end of its message: " + end_text(message);
  }
  return {};
}

std::string place_text(const Cpu& cpu, const Listing& listing) {
  const State& state = cpu.state();
  const std::string when = fmt::format("{}  {}", moment_text(state.time), scan_text(state));
  if (state.mode == Mode::Stop) return fmt::format("{}  STOP\n", when);
  const auto op = standing_at(state);
  if (!op) {
    const std::string where = state.instructions == 0 ? "powered up, the inputs are read first"
                                                      : fmt::format("between two scans, {}", phase_text(state.phase));
    return fmt::format("{}  {}\n > {:>5}  {}\n", when, where, line_number(listing.line_of(0), cpu.program()),
                       listing.text_of(0));
  }
  const std::string serving = state.in_interrupt ? fmt::format(" for {}", event_text(state.serving_event)) : "";
  const std::string& network = listing.network_of(*op);
  return fmt::format("{}  {}{}  S0={}{}{}\n > {:>5}  {}\n", when, listing.routine_of(*op), serving,
                     state.stack.top() ? 1 : 0, network.empty() ? "" : "  ", network,
                     line_number(listing.line_of(*op), cpu.program()), listing.text_of(*op));
}

std::string registers_text(const Cpu& cpu, const Listing& listing) {
  const State& state = cpu.state();
  std::string text =
      fmt::format("time       {}, {}, {} instructions\n", moment_text(state.time), scan_text(state), state.instructions);
  text += fmt::format("where      {}\n", where_text(cpu, listing));
  text += accumulators_text(cpu);
  text += fmt::format("flags      {}\n", flags_text(state.image[sm::kFlags]));
  text += fmt::format("interrupts {}\n", state.interrupts_enabled ? "enabled (ENI)" : "disabled (DISI, or no ENI yet)");
  for (std::size_t queue = 0; queue < kQueues; ++queue)
    text += fmt::format("{:<11}{}\n", queue == 0 ? "waiting" : "", queue_text(state, queue, *cpu.program().model));
  return text + attachments_text(state);
}

std::string stack_text(const State& state) {
  std::string text;
  for (int level = 0; level < LogicStack::kLevels; ++level)
    text += fmt::format("S{} {}{}", level, state.stack.level(level) ? 1 : 0, level + 1 < LogicStack::kLevels ? "   " : "\n");
  return text;
}

std::string port_text(const serial::Simulation& simulation) {
  std::string text;
  for (std::size_t port = 0; port < simulation.cpu().program().model->ports; ++port) {
    text += port_text(simulation.cpu(), port);
    if (port == simulation.port() && simulation.has_master())
      text += fmt::format("master     {}\n", master_text(simulation.master().state()));
  }
  return text;
}

std::string special_text(const Cpu& cpu, const MemoryRange& range) {
  if (range.area != Area::SM) return {};
  const State& state = cpu.state();
  std::string text;
  for (std::uint32_t at = range.at; at < range.at + range.bytes(); ++at) {
    const auto only = static_cast<std::uint8_t>(range.width == Width::Bit ? 1u << range.bit : 0xFFu);
    for (std::size_t port = 0; port < cpu.program().model->ports && range.width != Width::Bit; ++port)
      if (at == kPorts[port].control)
        text += fmt::format("         {}{}\n", range.bytes() > 1 ? fmt::format("SMB{}: ", at - image::kSM) : "",
                            control_words(state, port));
    const auto shown = static_cast<std::uint8_t>(range.width == Width::Bit ? only : state.image[at]);
    const std::string bits = special_bits_text(at, shown);
    if (!bits.empty()) text += fmt::format("         {}\n", bits);
    if (bits.empty() && range.width != Width::Bit && !special_bits(at).empty())
      text += fmt::format("         none of SMB{} is set\n", at - image::kSM);
  }
  return text;
}

const stl::Symbol* symbol_of(const Program& program, const MemoryRange& range) {
  for (const stl::Symbol& symbol : program.source.symbols) {
    const auto* address = symbol.value ? std::get_if<stl::Address>(&*symbol.value) : nullptr;
    if (!address || area_named(address->area) != range.area || address->number != range.number) continue;
    if (width_of(*address, range.area).value_or(Width::Double) == range.width && address->bit == range.bit) return &symbol;
  }
  return nullptr;
}

std::string symbol_name(const Program& program, const MemoryRange& range) {
  const stl::Symbol* const symbol = symbol_of(program, range);
  return symbol ? stl::printable(symbol->name) : "";
}

std::string symbol_text(const Program& program, const MemoryRange& range) {
  const stl::Symbol* symbol = symbol_of(program, range);
  if (!symbol) return {};
  return stl::printable(symbol->name) + (symbol->comment.empty() ? "" : "  // " + stl::printable(symbol->comment));
}

std::string value_text(const Program& program, const MemoryRange& range, std::span<const std::uint8_t> bytes) {
  if (range.count > 1) return serial::to_hex(bytes);
  switch (range.width) {
    case Width::Bit:
      return fmt::format("{}", bytes[0]);
    case Width::Byte:
      return fmt::format("16#{:02X} ({})", bytes[0], bytes[0]);
    case Width::Word:
      return fmt::format("16#{:04X} ({})", load16(bytes.data()), static_cast<std::int16_t>(load16(bytes.data())));
    case Width::Double: {
      const std::uint32_t value = load32(bytes.data());
      const std::string integer = range.real ? "" : fmt::format("{}", static_cast<std::int32_t>(value));
      const std::string real = range.real || program.is_real(range.at) ? real_text(value) : "";
      return fmt::format("16#{:08X} ({}{}{})", value, integer, integer.empty() || real.empty() ? "" : ", ", real);
    }
  }
  return {};
}

}  // namespace s7200::tools
