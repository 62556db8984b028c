#include "serial_sim/modbus/request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace s7200::modbus {
namespace {

void add_word(Bytes& bytes, std::uint16_t word) {
  bytes.push_back(static_cast<std::uint8_t>(word >> 8));
  bytes.push_back(static_cast<std::uint8_t>(word & 0xFF));
}

Bytes pdu(Function function, std::uint16_t first, std::uint16_t second) {
  Bytes bytes{static_cast<std::uint8_t>(function)};
  add_word(bytes, first);
  add_word(bytes, second);
  return bytes;
}

std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t place) {
  return static_cast<std::uint16_t>(bytes[place] << 8 | bytes[place + 1]);
}

}  // namespace

Bytes read_coils(std::uint16_t first, std::uint16_t count) { return pdu(Function::ReadCoils, first, count); }

Bytes read_inputs(std::uint16_t first, std::uint16_t count) { return pdu(Function::ReadInputs, first, count); }

Bytes read_holding_registers(std::uint16_t first, std::uint16_t count) {
  return pdu(Function::ReadHoldingRegisters, first, count);
}

Bytes read_input_registers(std::uint16_t first, std::uint16_t count) {
  return pdu(Function::ReadInputRegisters, first, count);
}

Bytes write_coil(std::uint16_t address, bool on) { return pdu(Function::WriteCoil, address, on ? 0xFF00 : 0x0000); }

Bytes write_register(std::uint16_t address, std::uint16_t value) { return pdu(Function::WriteRegister, address, value); }

Bytes write_coils(std::uint16_t first, const std::vector<bool>& on) {
  Bytes bytes = pdu(Function::WriteCoils, first, static_cast<std::uint16_t>(on.size()));
  Bytes packed((on.size() + 7) / 8);
  for (std::size_t coil = 0; coil < on.size(); ++coil) {
    if (on[coil]) packed[coil / 8] = static_cast<std::uint8_t>(packed[coil / 8] | 1U << coil % 8);
  }
  bytes.push_back(static_cast<std::uint8_t>(packed.size()));
  bytes.insert(bytes.end(), packed.begin(), packed.end());
  return bytes;
}

Bytes write_registers(std::uint16_t first, std::span<const std::uint16_t> values) {
  Bytes bytes = pdu(Function::WriteRegisters, first, static_cast<std::uint16_t>(values.size()));
  bytes.push_back(static_cast<std::uint8_t>(2 * values.size()));
  for (const std::uint16_t value : values) add_word(bytes, value);
  return bytes;
}

Bytes rtu_frame(std::uint8_t station, std::span<const std::uint8_t> pdu) {
  Bytes frame;
  frame.reserve(pdu.size() + 3);
  frame.push_back(station);
  frame.insert(frame.end(), pdu.begin(), pdu.end());
  add_crc(frame);
  return frame;
}

namespace {

struct ExceptionName {
  std::uint8_t code;
  std::string_view name;
};

// Modbus Application Protocol V1.1b3, section 7.
constexpr std::array<ExceptionName, 9> kExceptionNames{{
    {1, "illegal function"},
    {2, "illegal data address"},
    {3, "illegal data value"},
    {4, "server device failure"},
    {5, "acknowledge"},
    {6, "server device busy"},
    {8, "memory parity error"},
    {10, "gateway path unavailable"},
    {11, "gateway target device failed to respond"},
}};

std::string_view exception_name(std::uint8_t code) {
  const auto known = std::find_if(kExceptionNames.begin(), kExceptionNames.end(),
                                  [code](const ExceptionName& e) { return e.code == code; });
  return known == kExceptionNames.end() ? "unknown code" : known->name;
}

/// Nothing but the data of a PDU: station, function and CRC are off.
using Data = std::span<const std::uint8_t>;

constexpr std::size_t kAroundData = 4;  // station, function, two bytes of CRC

Data data_of(std::span<const std::uint8_t> frame) { return frame.subspan(2, frame.size() - kAroundData); }

std::string wrong_length(std::size_t expected, std::size_t found) {
  return fmt::format("wrong length: {} data bytes, expected {}", found, expected);
}

/// Data of an answer to a read: how many bytes follow, then they.
std::string wrong_read_length(Data answer, std::size_t expected_bytes) {
  if (answer.size() != 1 + expected_bytes) return wrong_length(1 + expected_bytes, answer.size());
  if (answer[0] != expected_bytes) return fmt::format("wrong byte count: {}, expected {}", answer[0], expected_bytes);
  return {};
}

std::string describe_bits(std::string_view name, Data asked, Data answer) {
  const unsigned first = word_at(asked, 0);
  const unsigned count = word_at(asked, 2);
  if (std::string wrong = wrong_read_length(answer, (count + 7) / 8); !wrong.empty()) return wrong;
  if (count == 0) return fmt::format("no {}s", name);
  std::string bits;
  for (unsigned bit = 0; bit < count; ++bit) {
    if (bit > 0 && bit % 4 == 0) bits += ' ';
    bits += (answer[1 + bit / 8] >> bit % 8 & 1) != 0 ? '1' : '0';
  }
  if (count == 1) return fmt::format("{} {}: {}", name, first, bits);
  return fmt::format("{}s {}…{}: {}", name, first, first + count - 1, bits);
}

std::string plural(unsigned count, std::string_view name) {
  return fmt::format("{} {}{}", count, name, count == 1 ? "" : "s");
}

std::string describe_registers(Data asked, Data answer) {
  const unsigned count = word_at(asked, 2);
  if (std::string wrong = wrong_read_length(answer, 2 * std::size_t{count}); !wrong.empty()) return wrong;
  std::string text = plural(count, "register") + ":";
  for (unsigned place = 0; place < count; ++place) text += fmt::format(" 16#{:04X}", word_at(answer, 1 + 2 * place));
  return text;
}

/// Answers to writes repeat the first four data bytes of the request.
std::string describe_write(Function function, Data asked, Data answer) {
  constexpr std::size_t kRepeated = 4;
  if (answer.size() != kRepeated) return wrong_length(kRepeated, answer.size());
  if (!std::equal(answer.begin(), answer.end(), asked.begin())) return "does not repeat the request: " + to_hex(answer);
  const unsigned first = word_at(answer, 0);
  const std::uint16_t second = word_at(answer, 2);
  switch (function) {
    case Function::WriteCoil:
      return fmt::format("coil {} written: {}", first, second == 0 ? 0 : 1);
    case Function::WriteRegister:
      return fmt::format("register {} written: 16#{:04X}", first, second);
    case Function::WriteCoils:
      return fmt::format("{} written from {} on", plural(second, "coil"), first);
    default:
      return fmt::format("{} written from {} on", plural(second, "register"), first);
  }
}

std::string describe_data(std::uint8_t function, Data asked, Data answer) {
  switch (static_cast<Function>(function)) {
    case Function::ReadCoils:
      return describe_bits("coil", asked, answer);
    case Function::ReadInputs:
      return describe_bits("input", asked, answer);
    case Function::ReadHoldingRegisters:
    case Function::ReadInputRegisters:
      return describe_registers(asked, answer);
    case Function::WriteCoil:
    case Function::WriteRegister:
    case Function::WriteCoils:
    case Function::WriteRegisters:
      return describe_write(static_cast<Function>(function), asked, answer);
  }
  return fmt::format("function {}: {}", function, to_hex(answer));
}

}  // namespace

std::string describe(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response) {
  constexpr std::uint8_t kExceptionFlag = 0x80;
  constexpr std::size_t kAddressAndCount = 4;

  if (response.empty()) return "no answer";
  if (response.size() <= kAroundData) return "too short for an answer: " + to_hex(response);
  if (!crc_ok(response)) return "wrong CRC";
  if (request.size() < 2) return "answer to no request: " + to_hex(response);
  if (response[0] != request[0]) return fmt::format("answer of station {}, not {}", response[0], request[0]);

  const std::uint8_t function = request[1];
  const Data answer = data_of(response);
  if (response[1] == (function | kExceptionFlag)) {
    if (answer.size() != 1) return wrong_length(1, answer.size());
    return fmt::format("exception {}: {}", answer[0], exception_name(answer[0]));
  }
  if (response[1] != function) return fmt::format("answer to function {}, not {}", response[1], function);
  if (request.size() < kAroundData + kAddressAndCount) return fmt::format("function {}: {}", function, to_hex(answer));
  return describe_data(function, data_of(request), answer);
}

Frame to_frame(std::span<const std::uint8_t> bytes) {
  Frame frame;
  frame.reserve(bytes.size());
  for (const std::uint8_t byte : bytes) frame.push_back({byte, false});
  return frame;
}

Bytes bytes_of(std::span<const FrameCharacter> frame) {
  Bytes bytes;
  bytes.reserve(frame.size());
  for (const FrameCharacter& character : frame) bytes.push_back(character.byte);
  return bytes;
}

void append_crc(Frame& frame) {
  Bytes bytes = bytes_of(frame);
  add_crc(bytes);
  for (std::size_t i = frame.size(); i < bytes.size(); ++i) frame.push_back({bytes[i], false});
}

bool has_wrong_parity(std::span<const FrameCharacter> frame) {
  return std::any_of(frame.begin(), frame.end(), [](const FrameCharacter& character) { return character.wrong_parity; });
}

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// Value of a hex digit; -1 for anything else.
int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

ParsedFrame parse_hex_frame(std::string_view text) {
  ParsedFrame parsed;
  const auto error = [&](std::size_t place, std::string message) {
    parsed.errors.push_back({place + 1, std::move(message)});
  };
  const auto at = [&](std::size_t place) { return place < text.size() ? text[place] : ' '; };

  std::size_t place = 0;
  while (place < text.size()) {
    const std::size_t first = place++;
    if (is_blank(at(first))) continue;
    const int high = hex_digit(at(first));
    const int low = hex_digit(at(place));
    if (high < 0) {
      error(first, fmt::format("'{}' is no hex digit", at(first)));
    } else if (is_blank(at(place))) {
      error(first, fmt::format("a byte is two hex digits, 0{} for {}", at(first), at(first)));
    } else if (low >= 0) {
      ++place;
      const bool wrong_parity = at(place) == 'p' || at(place) == 'P';
      if (wrong_parity) ++place;
      if (parsed.frame.size() == kLongestRawFrame) {
        error(first, fmt::format("a frame has {} bytes at most", kLongestRawFrame));
        break;
      }
      parsed.frame.push_back({static_cast<std::uint8_t>(high << 4 | low), wrong_parity});
    }
  }
  if (parsed.frame.empty() && parsed.ok()) error(0, "a frame has one byte at least");
  return parsed;
}

std::string to_hex(std::span<const std::uint8_t> bytes) { return fmt::format("{:02x}", fmt::join(bytes, " ")); }

std::string to_hex(std::span<const FrameCharacter> frame) {
  std::string text;
  for (const FrameCharacter& character : frame) {
    if (!text.empty()) text += ' ';
    fmt::format_to(std::back_inserter(text), "{:02x}{}", character.byte, character.wrong_parity ? "p" : "");
  }
  return text;
}

}  // namespace s7200::modbus
