#include "interpreter/trace/text_trace.hpp"

#include <fmt/format.h>

#include <iterator>
#include <ostream>

#include "interpreter/model/errors.hpp"
#include "interpreter/model/ports.hpp"
#include "interpreter/model/special_bits.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200 {
namespace {

std::string event_text(std::uint8_t number) { return fmt::format("event {} ({})", number, find_event(number)->cause); }

std::string place_text(std::uint32_t op, const Program& program) {
  if (op == kNoRoutine) return "between two scans";
  const stl::Statement& statement = program.statement(op);
  return fmt::format("line {}: {}", statement.position.line, stl::to_text(statement));
}

std::string character_text(const TraceRecord& r) {
  return fmt::format("{:02x}{}{}", r.byte, r.parity_error ? " parity error" : "", r.framing_error ? " framing error" : "");
}

/// Why a message has ended, after the bits of SMB86.
std::string status_text(std::uint8_t status) {
  const std::string reasons = special_meanings_text(kPorts[0].message, status);
  return fmt::format("status 16#{:02X}{}", status, reasons.empty() ? "" : fmt::format(" ({})", reasons));
}

/// Port 0 goes without saying: most CPUs have no other.
std::string port_text(const TraceRecord& r) { return r.port == 0 ? "" : fmt::format("port {}: ", r.port); }

std::string what_text(const TraceRecord& r, const Program& program) {
  switch (r.kind) {
    case TraceKind::ScanBegin:
      return fmt::format("scan {} begins", r.count);
    case TraceKind::ModeChange:
      return r.code ? "RUN" : "STOP";
    case TraceKind::EventOccurred:
      return fmt::format("{} occurred, for INT {}", event_text(r.event), r.routine);
    case TraceKind::EventLost:
      return fmt::format("{} LOST: its queue is full", event_text(r.event));
    case TraceKind::EventDropped:
      return fmt::format("{} of {} ms dropped: detached while it waited", event_text(r.event), clock_text(r.since));
    case TraceKind::ServiceBegin:
      return fmt::format("INT {} begins: {}, waited {}", r.routine, event_text(r.event), format_duration(r.at - r.since));
    case TraceKind::ServiceEnd:
      return fmt::format("INT {} ends: took {}", r.routine, format_duration(r.at - r.since));
    case TraceKind::Attach:
      return fmt::format("ATCH: INT {} to {}{}", r.routine, event_text(r.event),
                         r.interval ? fmt::format(", every {}", format_duration(r.interval)) : "");
    case TraceKind::Detach:
      return fmt::format("DTCH: {}", event_text(r.event));
    case TraceKind::Transmit:
      return r.count ? fmt::format("XMT: {} characters", r.count) : "XMT: break";
    case TraceKind::TransmitEnd:
      return "transmit complete";
    case TraceKind::CharacterSent:
      return fmt::format("sent     {:02x}", r.byte);
    case TraceKind::CharacterReceived:
      return fmt::format("received {}", character_text(r));
    case TraceKind::CharacterIgnored:
      if (r.code == 1) return fmt::format("ignored  {}: the port is not in Freeport mode", character_text(r));
      return fmt::format("ignored  {}: event {} is not attached", character_text(r), kPorts[r.port].received);
    case TraceKind::CharacterDropped:
      return fmt::format("dropped  {}: RCV waits for the start of a message", character_text(r));
    case TraceKind::Receive:
      return fmt::format("RCV: at most {} characters", r.count);
    case TraceKind::ReceiveEnd:
      return fmt::format("RCV ends: {} characters, {}", r.count, status_text(r.byte));
    case TraceKind::PortControl:
      return fmt::format("SMB{} = 16#{:02X}", kPorts[r.port].control - image::kSM, r.byte);
    case TraceKind::Enable:
      return r.code == 1 ? "ENI: interrupts are enabled" : "DISI: interrupts are disabled";
    case TraceKind::OutputChanged:
      return fmt::format("QB{} = 2#{:08b}", r.op, r.byte);
    case TraceKind::AnalogChanged:
      return fmt::format("AQW{} = {}", r.op, static_cast<std::int16_t>(r.count));
    case TraceKind::RuntimeError:
      return fmt::format("run-time error {:04X} ({}) in {}", r.code, meaning_of(RunError{r.code}),
                         place_text(r.op, program));
    case TraceKind::FatalError:
      return fmt::format("FATAL error {:04X} ({}) in {}", r.code, meaning_of(FatalError{r.code}), place_text(r.op, program));
  }
  return {};
}

}  // namespace

std::string clock_text(Time at) {
  fmt::memory_buffer text;
  append_clock(text, at);
  return fmt::to_string(text);
}

std::string describe(const TraceRecord& r, const Program& program) { return port_text(r) + what_text(r, program); }

TextTrace::TextTrace(std::ostream& out, std::shared_ptr<const Program> program, bool instructions)
    : out_(out),
      program_(std::move(program)),
      reasons_(*program_),
      instructions_(instructions),
      instruction_lines_(*program_) {
  out_ << kFirstLine << '\n';
}

void TextTrace::record(const TraceRecord& record) {
  const std::string reason = reasons_.of(record);
  if (record.kind == TraceKind::ScanBegin && !instructions_) return;
  line_.clear();
  append_clock(line_, record.at);
  fmt::format_to(std::back_inserter(line_), "  {}{}\n", describe(record, *program_), reason);
  out_.write(line_.data(), static_cast<std::streamsize>(line_.size()));
}

void TextTrace::instruction(const InstructionRecord& record) {
  line_.clear();
  instruction_lines_.append_line(line_, record);
  out_.write(line_.data(), static_cast<std::streamsize>(line_.size()));
}

}  // namespace s7200
