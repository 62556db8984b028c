#include "serial_sim/westinghouse/messages/hppc_message.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "interpreter/base/word_bytes.hpp"
#include "serial_sim/line/frame.hpp"

namespace s7200::westinghouse {
namespace {

using Table = std::array<std::uint16_t, 256>;

/// x^16 + x^12 + x^5 + 1, most significant bit first.
constexpr Table kPolynomial = [] {
  Table table{};
  for (unsigned index = 0; index < table.size(); ++index) {
    unsigned crc = index << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x8000U) != 0 ? crc << 1 ^ 0x1021U : crc << 1;
    table[index] = static_cast<std::uint16_t>(crc);
  }
  return table;
}();

constexpr Table kDocument = [] {
  constexpr std::size_t kOddEntry = 0x0B;
  Table table = kPolynomial;
  table[kOddEntry] = 0xB12F;
  return table;
}();

constexpr std::size_t kDestination = 2, kOpcode = 5, kAround = 8;

unsigned length_of(std::span<const std::uint8_t> message) { return load16_low_first(message.data()); }

}  // namespace

std::uint16_t hppc_fcs(std::span<const std::uint8_t> bytes, FcsTable table) {
  const Table& entries = table == FcsTable::Document ? kDocument : kPolynomial;
  std::uint16_t crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) crc = static_cast<std::uint16_t>(crc << 8 ^ entries[byte ^ crc >> 8]);
  return crc;
}

Bytes hppc_message(std::uint8_t destination, std::uint8_t source, HppcOpcode opcode, std::span<const std::uint8_t> operands,
                   FcsTable table) {
  const std::size_t length = kAround + operands.size();
  Bytes bytes{low_byte(length), high_byte(length), destination, source, 0, static_cast<std::uint8_t>(opcode)};
  bytes.insert(bytes.end(), operands.begin(), operands.end());
  const std::uint16_t fcs = hppc_fcs(bytes, table);
  bytes.push_back(high_byte(fcs));
  bytes.push_back(low_byte(fcs));
  return bytes;
}

void add_hppc_address(Bytes& to, std::uint32_t address) {
  for (int byte = 0; byte < 3; ++byte) to.push_back(static_cast<std::uint8_t>(address >> 8 * byte & 0xFF));
}

std::uint32_t hppc_address(std::span<const std::uint8_t> bytes) {
  return bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8 | static_cast<std::uint32_t>(bytes[2]) << 16;
}

Bytes hppc_read(std::uint32_t address, std::uint8_t count, const HppcLayout& layout) {
  Bytes operands;
  if (layout.read_request == HppcLayout::ReadRequest::AddressAndNumber) add_hppc_address(operands, address);
  operands.push_back(count);
  return operands;
}

Bytes hppc_write(std::uint32_t address, std::span<const std::uint8_t> data) {
  Bytes operands = hppc_read(address, static_cast<std::uint8_t>(data.size()));
  operands.insert(operands.end(), data.begin(), data.end());
  return operands;
}

Bytes hppc_bit_write(std::uint32_t address, std::uint16_t pattern, std::uint16_t mask, const HppcLayout& layout) {
  if (layout.bit_write == HppcLayout::BitWrite::MaskFirst) std::swap(pattern, mask);
  Bytes operands;
  add_hppc_address(operands, address);
  for (const std::uint16_t word : {pattern, mask}) {
    operands.push_back(static_cast<std::uint8_t>(word & 0xFF));
    operands.push_back(static_cast<std::uint8_t>(word >> 8));
  }
  return operands;
}

Bytes hppc_monitor(std::uint32_t network, std::span<const std::uint32_t> bytes, std::span<const std::uint32_t> words,
                   std::span<const std::uint32_t> double_words, const HppcLayout& layout) {
  Bytes operands;
  add_hppc_address(operands, network);
  for (const auto& list : {bytes, words, double_words}) operands.push_back(static_cast<std::uint8_t>(list.size()));
  for (const auto& list : {bytes, words, double_words})
    for (const std::uint32_t address : list) {
      const std::size_t end = operands.size() + layout.monitor_address_bytes;
      add_hppc_address(operands, address);
      operands.resize(end);
    }
  return operands;
}

bool is_whole_hppc(std::span<const std::uint8_t> message) {
  return message.size() >= kShortestHppc && message.size() == length_of(message);
}

serial::Answer check_hppc_answer(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response,
                                 FcsTable table) {
  serial::Answer answer;
  if (response.empty()) return answer;
  answer.verdict = serial::Verdict::Wrong;
  const auto wrong = [&](std::string fault) {
    answer.fault = std::move(fault);
    return answer;
  };
  if (response.size() < kShortestHppc) return wrong("too short for an answer: " + serial::to_hex(response));
  if (response.size() != length_of(response))
    return wrong(fmt::format("wrong length: {} bytes, it says {}", response.size(), length_of(response)));
  if (hppc_fcs(response, table) != 0) return wrong("wrong frame check");
  if (response[kDestination] != kApl)
    return wrong(fmt::format("for 16#{:02X}, not for 16#{:02X}", response[kDestination], kApl));
  const auto operands = response.subspan(kHppcHeader, response.size() - kAround);
  if (response[kOpcode] == static_cast<std::uint8_t>(HppcOpcode::Error)) {
    if (operands.empty()) return wrong("an error response without a code");
    answer.verdict = serial::Verdict::Exception;
    answer.exception = operands[0];
    return answer;
  }
  if (request.size() > kOpcode && response[kOpcode] != request[kOpcode])
    return wrong(fmt::format("answer to opcode {:02X}, not {:02X}", response[kOpcode], request[kOpcode]));
  answer.bytes.assign(operands.begin(), operands.end());
  answer.verdict = serial::Verdict::Right;
  return answer;
}

std::optional<HoldingRegisters> holding_registers(std::span<const std::uint8_t> table) {
  for (const std::size_t offset : {0x2EU, 0x2CU}) {
    if (table.size() < offset + 4) continue;
    const std::uint32_t base = hppc_address(table.subspan(offset)) | static_cast<std::uint32_t>(table[offset + 3]) << 24;
    if (base % 2 != 0 || base < kParameterTable || base >= kHppcMemory) continue;
    const bool has_number = table.size() >= offset + 6;
    return HoldingRegisters{base, has_number ? std::optional(load16_low_first(&table[offset + 4])) : std::nullopt};
  }
  return {};
}

std::string hppc_parameters_text(std::span<const std::uint8_t> operands) {
  constexpr std::size_t kAddress = 3;
  const auto table = operands.subspan(kAddress);
  std::string text = fmt::format("parameter table at 16#{:05X}", hppc_address(operands));
  if (const auto found = holding_registers(table)) text += fmt::format(", holding register 1 at 16#{:05X}", found->base);
  return table.empty() ? text : fmt::format("{}: {}", text, serial::to_hex(table));
}

std::string hppc_status_text(std::uint8_t status) {
  constexpr std::array<std::string_view, 5> kBits{"special function data valid", "network not found", "controlled by an MCR",
                                                  "controlled by a skip", "processor not running"};
  std::string text = fmt::format("status 16#{:02X}", status);
  std::string_view separator = ": ";
  for (std::size_t bit = 0; bit < kBits.size(); ++bit) {
    if ((status >> bit & 1) == 0) continue;
    text.append(separator).append(kBits[bit]);
    separator = ", ";
  }
  return text;
}

std::string_view hppc_error_name(std::uint16_t code) {
  switch (code) {
    case 0x01:
      return "link error";
    case 0x10:
      return "illegal opcode";
    case 0x11:
      return "invalid operand";
    case 0x12:
      return "invalid frame length";
    case 0x20:
      return "keyswitch";
    case 0x21:
      return "search word not found";
    case 0x23:
      return "edit request denied";
    case 0x24:
      return "edit session not in progress";
    case 0x25:
      return "mode error";
    case 0x26:
      return "channel error";
    case 0x4E:
      return "illegal channel";
    default:
      return "unknown code";
  }
}

}  // namespace s7200::westinghouse
