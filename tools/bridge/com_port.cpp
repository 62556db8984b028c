#include "tools/bridge/com_port.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "serial_sim/line/line_settings.hpp"

namespace s7200::tools {
namespace {

// Codes of Telnet.
constexpr std::uint8_t kIac = 255, kDont = 254, kDo = 253, kWont = 252, kWill = 251, kSub = 250, kSubEnd = 240;
constexpr std::uint8_t kBinary = 0, kSuppressGoAhead = 3, kComPort = 44;
constexpr std::array kOptions{kBinary, kSuppressGoAhead, kComPort};

// RFC 2217, 3: commands of the client; an answer has the same number and 100 more.
enum Command : std::uint8_t {
  kSignature = 0,
  kSetBaudRate = 1,
  kSetDataSize = 2,
  kSetParity = 3,
  kSetStopSize = 4,
  kSetControl = 5,
  kNotifyLineState = 6,
  kNotifyModemState = 7,
  kSetLineStateMask = 10,
  kSetModemStateMask = 11,
  kPurgeData = 12
};
constexpr std::uint8_t kAnswer = 100;
constexpr std::string_view kName = "s7200";

/// The code of SET-PARITY for a Parity.
constexpr std::uint8_t parity_code(Parity parity) { return parity == Parity::None ? 1 : parity == Parity::Odd ? 2 : 3; }
constexpr std::optional<Parity> parity_of(std::uint8_t code) {
  constexpr std::array<std::optional<Parity>, 4> kParities{std::nullopt, Parity::None, Parity::Odd, Parity::Even};
  return code < kParities.size() ? kParities[code] : std::nullopt;
}

// Codes of SET-CONTROL: those that ask and those that set.
constexpr std::uint8_t kFlowOutAsked = 0, kFlowOutLast = 3, kBreakAsked = 4, kBreakOn = 5, kBreakOff = 6, kDtrAsked = 7,
                       kDtrOn = 8, kDtrOff = 9, kRtsAsked = 10, kRtsOn = 11, kRtsOff = 12, kFlowInAsked = 13,
                       kFlowInLast = 16;

// Bits of the line's state (RFC 2217, 3; those of a 16550).
constexpr std::uint8_t kParityErrorBit = 0x04, kFramingErrorBit = 0x08, kBreakBit = 0x10;

std::uint8_t errors_of(const ReceivedCharacter& character) {
  if (character.line_break) return kBreakBit;
  return static_cast<std::uint8_t>((character.parity_error ? kParityErrorBit : 0) |
                                   (character.framing_error ? kFramingErrorBit : 0));
}

void put(std::vector<std::uint8_t>& out, std::uint8_t byte) {
  if (byte == kIac) out.push_back(kIac);
  out.push_back(byte);
}

void put_command(std::vector<std::uint8_t>& out, std::uint8_t command, std::span<const std::uint8_t> value) {
  out.insert(out.end(), {kIac, kSub, kComPort, command});
  for (const std::uint8_t byte : value) put(out, byte);
  out.insert(out.end(), {kIac, kSubEnd});
}

}  // namespace

std::vector<std::uint8_t> ComPort::take(std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes)
    if (error_.empty()) take(byte);
  return std::exchange(out_, {});
}

void ComPort::take(std::uint8_t byte) {
  switch (state_) {
    case State::Data:
      if (byte == kIac)
        state_ = State::Command;
      else
        port_.character(byte);
      return;
    case State::Command:
      state_ = State::Data;
      if (byte == kIac) return port_.character(byte);
      if (byte >= kWill && byte <= kDont) {
        verb_ = byte;
        state_ = State::Option;
      } else if (byte == kSub) {
        command_.clear();
        state_ = State::Subnegotiation;
      }
      return;  // other commands of Telnet mean nothing to a serial port
    case State::Option:
      state_ = State::Data;
      return negotiate(verb_, byte);
    case State::Subnegotiation:
      if (byte == kIac)
        state_ = State::SubnegotiationCommand;
      else
        command_.push_back(byte);
      break;
    case State::SubnegotiationCommand:
      state_ = byte == kIac ? State::Subnegotiation : State::Data;
      if (byte == kIac)
        command_.push_back(byte);
      else if (byte == kSubEnd)
        command();
      break;
  }
  if (command_.size() > kMostOfCommand) error_ = "this is not RFC 2217: a command of it has at most 10 bytes";
}

/// Answers a verb of Telnet. An option that both sides have agreed on is not answered again, or the two would go on for ever
/// (RFC 854).
void ComPort::negotiate(std::uint8_t verb, std::uint8_t option) {
  const bool known = std::ranges::find(kOptions, option) != kOptions.end();
  const bool about_client = verb == kWill || verb == kWont, on = verb == kWill || verb == kDo;
  const auto place = static_cast<unsigned>(std::ranges::find(kOptions, option) - kOptions.begin());
  const std::uint32_t bit = 1U << (2 * place + (about_client ? 1 : 0));
  if (known && ((confirmed_ & bit) != 0) == on) return;
  if (!known && !on) return;
  if (known) confirmed_ = on ? confirmed_ | bit : confirmed_ & ~bit;
  const bool agree = known && on;
  out_.insert(out_.end(), {kIac, about_client ? (agree ? kDo : kDont) : (agree ? kWill : kWont), option});
}

SerialFormat ComPort::format() const {
  SerialFormat format = port_.format();
  if (baud_ != 0) format.baud = baud_;
  if (data_bits_ != 0) format.data_bits = data_bits_;
  if (const auto parity = parity_of(parity_)) format.parity = *parity;
  if (stop_bits_ != 0) format.stop_bits = stop_bits_;
  return format;
}

void ComPort::command() {
  if (command_.size() < 2 || command_[0] != kComPort) return;
  const std::uint8_t what = command_[1];
  const std::span value = std::span(command_).subspan(2);
  const std::uint8_t first = value.empty() ? 0 : value[0];
  switch (what) {
    case kSignature:
      if (value.empty()) answer(what, std::vector<std::uint8_t>(kName.begin(), kName.end()));
      return;
    case kSetBaudRate: {
      if (value.size() != 4) return;
      const std::uint32_t baud =
          std::uint32_t{value[0]} << 24 | std::uint32_t{value[1]} << 16 | std::uint32_t{value[2]} << 8 | value[3];
      if (baud >= serial::kSlowestBaud && baud <= serial::kFastestBaud) baud_ = baud;
      const std::uint32_t now = format().baud;
      return answer(what, std::array{static_cast<std::uint8_t>(now >> 24), static_cast<std::uint8_t>(now >> 16),
                                     static_cast<std::uint8_t>(now >> 8), static_cast<std::uint8_t>(now)});
    }
    case kSetDataSize:
      if (first == 7 || first == 8) data_bits_ = first;
      return answer(what, static_cast<std::uint8_t>(format().data_bits));
    case kSetParity:
      if (parity_of(first)) parity_ = first;
      return answer(what, parity_code(format().parity));
    case kSetStopSize:
      if (first == 1 || first == 2) stop_bits_ = first;
      return answer(what, static_cast<std::uint8_t>(format().stop_bits));
    case kSetControl:
      return set_control(first);
    case kSetLineStateMask:
      line_errors_ = first;
      return answer(what, first);
    case kSetModemStateMask:
      return answer(what, first);
    case kPurgeData:
      if (first == 2 || first == 3) port_.purge();  // what it has sent, and both ways
      return answer(what, first);
    default:
      return;  // suspend and resume: it is held back by TCP
  }
}

void ComPort::set_control(std::uint8_t value) {
  if (value >= 1 && value <= kFlowOutLast) flow_out_ = value;
  if (value > kFlowInAsked && value <= kFlowInLast) flow_in_ = value;
  if (value == kDtrOn || value == kDtrOff) dtr_ = value == kDtrOn;
  if (value == kRtsOn || value == kRtsOff) rts_ = value == kRtsOn;
  if (value == kBreakOn && !break_) port_.begin_break();
  if (value == kBreakOff && break_) port_.end_break();
  if (value == kBreakOn || value == kBreakOff) break_ = value == kBreakOn;
  if (value <= kFlowOutLast)
    answer(kSetControl, flow_out_);
  else if (value <= kBreakOff)
    answer(kSetControl, break_ ? kBreakOn : kBreakOff);
  else if (value <= kDtrOff)
    answer(kSetControl, dtr_ ? kDtrOn : kDtrOff);
  else if (value <= kRtsOff)
    answer(kSetControl, rts_ ? kRtsOn : kRtsOff);
  else
    answer(kSetControl, flow_in_);
}

void ComPort::answer(std::uint8_t command, std::span<const std::uint8_t> value) {
  put_command(out_, static_cast<std::uint8_t>(kAnswer + command), value);
}

std::vector<std::uint8_t> ComPort::received(std::span<const ReceivedCharacter> characters) const {
  std::vector<std::uint8_t> out;
  for (const ReceivedCharacter& character : characters) {
    const auto told = static_cast<std::uint8_t>(errors_of(character) & line_errors_);
    if (told != 0) put_command(out, kAnswer + kNotifyLineState, std::span(&told, 1));
    put(out, character.byte);
  }
  return out;
}

}  // namespace s7200::tools
