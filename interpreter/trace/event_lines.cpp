#include "interpreter/trace/event_lines.hpp"

#include <algorithm>

#include "interpreter/base/counted.hpp"
#include "interpreter/model/area.hpp"
#include "interpreter/model/errors.hpp"
#include "interpreter/model/ports.hpp"
#include "interpreter/model/s7_pdu.hpp"
#include "interpreter/model/special_bits.hpp"
#include "interpreter/program/operands.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/trace/line_parts.hpp"
#include "interpreter/trace/statement_text.hpp"
#include "interpreter/trace/trace_reasons.hpp"

namespace s7200 {
namespace {

std::string place_text(std::uint32_t op, const Program& program) {
  if (op == kNoRoutine) return "between two scans";
  return fmt::format("{}: {}", line_of(op, program), stl::to_text(program.statement(op)));
}

/// `0f`, as bytes of frames are written.
void append_byte(fmt::memory_buffer& text, std::uint8_t byte) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  text.push_back(kDigits[byte >> 4]);
  text.push_back(kDigits[byte & 15]);
}

void append_character(fmt::memory_buffer& text, const TraceRecord& r) {
  append_byte(text, r.byte);
  if (r.parity_error) append(text, " parity error");
  if (r.framing_error) append(text, " framing error");
}

/// Why a message has ended, after the bits of SMB86.
std::string status_text(std::uint8_t status) {
  const std::string reasons = special_meanings_text(kPorts[0].message, status);
  return fmt::format("status 16#{:02X}{}", status, reasons.empty() ? "" : fmt::format(" ({})", reasons));
}

/// What a master asks for: `VB100, 4 bytes`; `M3.1`; `VW300`; `T37, 3 in all`; as far as it is known `T37 as 2 bytes`.
std::string variable_text(const TraceRecord& r) {
  if (r.routine == s7::kSystemInformation) return "the CPU's identification";
  const auto wire = std::ranges::find(s7::kWireAreas, r.routine, &s7::WireArea::code);
  const auto bit = static_cast<std::uint8_t>(r.op % 8);
  if (wire == s7::kWireAreas.end()) return fmt::format("area 16#{:02X}, address {}.{}", r.routine, r.op / 8, bit);
  const bool is_element = info(wire->area).element != 0;
  const auto width = s7::width_of(r.type);
  if (is_element) {
    const std::string name = address_text(wire->area, Width::Word, r.op, 0);
    if (r.type == r.routine) return name + (r.count == 1 ? "" : fmt::format(", {} in all", r.count));
    return width ? fmt::format("{} as {}", name, counted(r.count, name_of(*width)))
                 : fmt::format("{} as type 16#{:02X}", name, r.type);
  }
  const Width named = bit != 0 ? Width::Bit : width.value_or(Width::Byte);
  const std::string name = address_text(wire->area, named, r.op / 8, bit);
  if (!width) return fmt::format("{} as type 16#{:02X}", name, r.type);
  return name + (r.count == 1 && *width == named ? "" : ", " + counted(r.count, name_of(*width)));
}

std::string unmodelled_ppi_text(const TraceRecord& r) {
  switch (static_cast<PpiUnmodelled>(r.code)) {
    case PpiUnmodelled::Token:
      return fmt::format("PPI token from station {} ignored: passing the token on is not modelled", r.event);
    case PpiUnmodelled::AnotherMaster:
      return fmt::format(
          "PPI station {} asks station {}: another master; without the token, which is not modelled, its "
          "frames and those of NETR and NETW here may collide",
          r.event, r.byte);
    case PpiUnmodelled::Broadcast:
      return fmt::format("PPI broadcast from station {} ignored: broadcasts are not modelled", r.event);
    case PpiUnmodelled::ExtendedAddress:
      return fmt::format("PPI frame from 16#{:02X} to 16#{:02X} ignored: addresses above 127 are not modelled", r.event,
                         r.byte);
    case PpiUnmodelled::NoRequest:
      return fmt::format("PPI station {} asks, but with no S7 request in it: it gets no answer", r.event);
  }
  return {};
}

std::string refusal_text(std::uint16_t code) { return fmt::format(": refused, error 16#{:02X}", code); }

std::string_view does_text(PpiVerb verb) {
  switch (verb) {
    case PpiVerb::Reads:
      return "reads";
    case PpiVerb::Writes:
      return "writes";
    case PpiVerb::Forces:
      return "forces";
    case PpiVerb::Unforces:
      return "unforces";
    case PpiVerb::SetsInStop:
      return "sets in STOP";
  }
  return {};
}

std::string function_text(const TraceRecord& r) {
  if (r.count == 0) return "asks for no function";
  switch (r.byte) {
    case s7::kRun:
      return "asks for RUN";
    case s7::kStop:
      return "asks for STOP";
    case s7::kSetup:
      return "sets up the communication";
    case s7::kStartUpload:
      return "starts the upload of a block";
    case s7::kUpload:
      return "fetches a part of the block";
    case s7::kEndUpload:
      return "ends the upload";
    default:
      return fmt::format("asks for function {:02X}", r.byte);
  }
}

std::string user_data_text(const TraceRecord& r) {
  if (r.count == 0) return "sends user data that name no service";
  switch (r.routine << 8 | r.byte) {
    case s7::kBlockGroup << 8 | s7::kListBlocks:
      return "asks how many blocks there are";
    case s7::kBlockGroup << 8 | s7::kListBlocksOfType:
      return "asks for the blocks of a type";
    case s7::kBlockGroup << 8 | s7::kBlockInfo:
      return "asks about a block";
    case s7::kClockGroup << 8 | s7::kReadClock:
      return "reads the clock";
    case s7::kClockGroup << 8 | s7::kSetClock:
      return "sets the clock";
    case s7::kForceGroup << 8 | s7::kForce:
      return "forces or unforces values";
    case s7::kForceGroup << 8 | s7::kSetInStop:
      return "sets outputs in STOP";
    default:
      break;
  }
  return fmt::format("asks for user data, group {}, service {}", r.routine, r.byte);
}

/// What a master has asked the CPU for.
std::string ppi_text(const TraceRecord& r) {
  const std::string who = fmt::format("PPI station {}", r.event);
  if (r.kind == TraceKind::PpiAccess) {
    return fmt::format("{} {} {}{}", who, does_text(PpiVerb{r.byte}), variable_text(r),
                       r.code == s7::kDone ? "" : refusal_text(r.code));
  }
  return fmt::format("{} {}{}", who, r.op == s7::kUserData ? user_data_text(r) : function_text(r),
                     r.code == 0 ? "" : refusal_text(r.code));
}

/// What has become of a job of the CPU as a master.
std::string network_text(const TraceRecord& r) {
  const std::string job =
      fmt::format("{} with table {}, station {}", r.routine != 0 ? "NETW" : "NETR", byte_text(r.op), r.event);
  if (r.byte & kJobActive)
    return fmt::format("{}: {} {} to be {}", job, counted(r.count, "byte"), r.count == 1 ? "is" : "are",
                       r.routine != 0 ? "written" : "read");
  const NetworkError error{static_cast<std::uint8_t>(r.byte & kJobErrorCode)};
  if (error == NetworkError::None) return job + ": done";
  return fmt::format("{}: error {}, {}", job, r.byte & kJobErrorCode, meaning_of(error));
}

}  // namespace

const std::string& EventText::event(std::uint8_t number) {
  std::string& text = events_[number];
  if (text.empty()) text = fmt::format("event {} ({})", number, find_event(number)->cause);
  return text;
}

const std::string& EventText::duration(Time time) {
  Duration& known = durations_[static_cast<std::size_t>(time) / 100 % durations_.size()];
  if (known.time != time) known = {time, format_duration(time)};
  return known.text;
}

void EventText::append_to(fmt::memory_buffer& text, const TraceRecord& r) {
  if (r.port != 0) append(text, "port ", r.port, ": ");  // port 0 goes without saying: most CPUs have no other
  const auto add = [&text](const auto&... parts) { append(text, parts...); };
  switch (r.kind) {
    case TraceKind::ScanBegin:
      return add("scan ", r.count, " begins");
    case TraceKind::ModeChange:
      return add(r.code ? "RUN" : "STOP");
    case TraceKind::EventOccurred:
      return add(event(r.event), " occurred, for INT ", r.routine);
    case TraceKind::EventLost:
      return add(event(r.event), " LOST: its queue is full");
    case TraceKind::EventDropped:
      add(event(r.event), " of ");
      append_clock(text, r.since);
      return add(" ms dropped: detached while it waited");
    case TraceKind::ServiceBegin:
      return add("INT ", r.routine, " begins: ", event(r.event), ", waited ", duration(r.at - r.since));
    case TraceKind::ServiceEnd:
      return add("INT ", r.routine, " ends: took ", duration(r.at - r.since));
    case TraceKind::Attach:
      add("ATCH: INT ", r.routine, " to ", event(r.event));
      if (r.interval) add(", every ", duration(r.interval));
      return;
    case TraceKind::Detach:
      return add("DTCH: ", event(r.event));
    case TraceKind::Transmit:
      return r.count ? add("XMT: ", counted(r.count, "character")) : add("XMT: break");
    case TraceKind::TransmitEnd:
      return add("transmit complete");
    case TraceKind::CharacterSent:
      add("sent     ");
      return append_byte(text, r.byte);
    case TraceKind::CharacterReceived:
      add("received ");
      return append_character(text, r);
    case TraceKind::CharacterIgnored:
      add("ignored  ");
      append_character(text, r);
      if (Ignored{r.code} == Ignored::NoPpiFrame) add(" and the rest up to the next pause");
      return add(": ", ignored_because(r));
    case TraceKind::CharacterDropped:
      add("dropped  ");
      append_character(text, r);
      return add(": ", ignored_because(r));
    case TraceKind::Receive:
      return add("RCV: at most ", counted(r.count, "character"));
    case TraceKind::ReceiveEnd:
      return add("RCV ends: ", counted(r.count, "character"), ", ", status_text(r.byte));
    case TraceKind::PortControl:
      add("SMB", kPorts[r.port].control - image::kSM, " = ");
      return append_hex(text, r.byte, 2);
    case TraceKind::Enable:
      return add(r.code == 1 ? "ENI: interrupts are enabled" : "DISI: interrupts are disabled");
    case TraceKind::OutputChanged:
      return add(fmt::format("QB{} = 2#{:08b}", r.op, r.byte));
    case TraceKind::AnalogChanged:
      return add("AQW", r.op, " = ", static_cast<std::int16_t>(r.count));
    case TraceKind::RuntimeError:
      return add(
          fmt::format("run-time error {:04X} ({}) in {}", r.code, meaning_of(RunError{r.code}), place_text(r.op, program_)));
    case TraceKind::FatalError:
      return add(
          fmt::format("FATAL error {:04X} ({}) in {}", r.code, meaning_of(FatalError{r.code}), place_text(r.op, program_)));
    case TraceKind::PpiService:
    case TraceKind::PpiAccess:
      return add(ppi_text(r));
    case TraceKind::NetworkJob:
      return add(network_text(r));
    case TraceKind::PpiNotModelled:
      return add(unmodelled_ppi_text(r));
    case TraceKind::PpiIgnored:
      return add("PPI frame of ", counted(r.count, "character"), " ignored: its check sum or end is wrong");
  }
}

std::string describe(const TraceRecord& record, const Program& program) {
  fmt::memory_buffer text;
  EventText(program).append_to(text, record);
  return fmt::to_string(text);
}

}  // namespace s7200
