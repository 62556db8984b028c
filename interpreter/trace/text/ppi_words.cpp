#include "interpreter/trace/text/ppi_words.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/model/area.hpp"
#include "interpreter/model/errors.hpp"
#include "interpreter/model/s7_pdu.hpp"
#include "interpreter/program/operands/operands.hpp"

namespace s7200 {
namespace {

std::string refusal_text(std::uint16_t code) { return fmt::format(": refused, error 16#{:02X}", code); }

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

}  // namespace

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

/// What a master asks the CPU for, besides variables.
std::string asked_text(const TraceRecord& r) { return r.op == s7::kUserData ? user_data_text(r) : function_text(r); }

/// What a master has asked the CPU for, and whether it got it.
std::string ppi_text(const TraceRecord& r) {
  const std::string who = fmt::format("PPI station {}", r.event);
  if (r.kind == TraceKind::PpiAccess) {
    return fmt::format("{} {} {}{}", who, does_text(PpiVerb{r.byte}), variable_text(r),
                       r.code == s7::kDone ? "" : refusal_text(r.code));
  }
  return fmt::format("{} {}{}", who, asked_text(r), r.code == 0 ? "" : refusal_text(r.code));
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

}  // namespace s7200
