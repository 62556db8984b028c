#include "serial_sim/westinghouse/pc1000.hpp"

#include <algorithm>
#include <array>

#include "interpreter/base/word_bytes.hpp"

namespace s7200::westinghouse {
namespace {

constexpr std::uint32_t kPc1000Bytes = 0x20000, kByteAddresses = 0x10000;
constexpr std::uint32_t kPc1000Registers = 2048;
constexpr std::uint8_t kFaultMode = 8;
constexpr std::size_t kCount = 3;  // place of the number of bytes minus one, or of the bit

std::uint16_t address_of(std::span<const std::uint8_t> message) { return load16_low_first(&message[1]); }

Bytes header_of(std::span<const std::uint8_t> message) { return {message.begin(), message.begin() + kMessageLength}; }

}  // namespace

std::size_t Pc1000::length(std::span<const std::uint8_t> begin) {
  switch (static_cast<Opcode>(begin[0])) {
    case Opcode::BitWrite:
    case Opcode::ReadBlock:
    case Opcode::Highway:
    case Opcode::SetUnitAddress:
      return kMessageLength;
    case Opcode::WriteBlock:
      return begin.size() <= kCount ? kMessageLength + 2 : kMessageLength + begin[kCount] + 2U;
    case Opcode::Erase:
      return kMessageLength + kEraseKeyLength;
  }
  return 0;
}

bool Pc1000::check_right(std::span<const std::uint8_t> message) {
  return sum(message.first(kMessageLength - 1)) == message[kMessageLength - 1];
}

MessageReader::State MessageReader::take(const ReceivedCharacter& character) {
  deaf_ = deaf_ || character.framing_error || character.parity_error;
  if (deaf_) return State::Deaf;
  message_.push_back(character.byte);
  const std::size_t length = Pc1000::length(message_);
  if (message_.size() == kMessageLength && (length == 0 || !Pc1000::check_right(message_))) {
    deaf_ = true;
    return State::Wrong;
  }
  return length == 0 || message_.size() < length ? State::Part : State::Whole;
}

std::uint8_t Pc1000::key_byte() const {
  const unsigned position = 1U << static_cast<unsigned>(settings.key);
  return static_cast<std::uint8_t>(static_cast<unsigned>(settings.key_upper_bits) << 4 | position |
                                   (settings.fault != 0 ? kFaultMode : 0));
}

Bytes Pc1000::carry_out(Data message) {
  // A message without an operand has 00 in the operand's place.
  switch (static_cast<Opcode>(message[0])) {
    case Opcode::ReadBlock:
      return message[4] == 0 ? read(message) : Bytes{};
    case Opcode::WriteBlock:
      return message[4] == 0 ? write(message) : Bytes{};
    case Opcode::BitWrite:
      return message[4] == 0 ? write_bit(message) : Bytes{};
    case Opcode::Erase:
      return erase(message);
    default:
      return {};
  }
}

std::optional<std::uint32_t> Pc1000::first_byte(Data message) const {
  const bool by_words = settings.addresses == Pc1000Settings::Addresses::Words;
  const std::uint32_t first = by_words ? 2U * address_of(message) : address_of(message);
  if (first + message[kCount] + 1 > (by_words ? kPc1000Bytes : kByteAddresses)) return {};
  return first;
}

std::uint8_t Pc1000::byte(std::uint32_t address) const {
  return static_cast<std::uint8_t>(words.read(address / 2) >> 8 * (address % 2) & 0xFF);
}

void Pc1000::set_byte(std::uint32_t address, std::uint8_t value) {
  const unsigned word = words.read(address / 2);
  words.write(address / 2,
              static_cast<std::uint16_t>(address % 2 == 0 ? (word & 0xFF00) | value : (word & 0xFF) | value * 256U));
}

Bytes Pc1000::read(Data message) const {
  const auto first = first_byte(message);
  if (!first) return {};
  Bytes reply = header_of(message);
  for (std::uint32_t i = 0; i <= message[kCount]; ++i) reply.push_back(byte(*first + i));
  reply.push_back(data_check(std::span(reply).subspan(kMessageLength), settings.data_check));
  return reply;
}

Bytes Pc1000::write(Data message) {
  const auto first = first_byte(message);
  const bool allowed = settings.write == Pc1000Settings::WriteIn::Always || settings.key != Pc1000Settings::Key::Protect;
  const Data data = message.subspan(kMessageLength, message[kCount] + 1U);
  if (!first || !allowed || data_check(data, settings.data_check) != message.back()) return {};
  for (std::uint32_t i = 0; i < data.size(); ++i) set_byte(*first + i, data[i]);
  return header_of(message);
}

Bytes Pc1000::write_bit(Data message) {
  const std::uint8_t nibble = message[kCount] >> 4, bit = message[kCount] & 0xF;
  const bool sets = nibble == settings.set_nibble;
  const bool allowed = settings.write == Pc1000Settings::WriteIn::Always || settings.key != Pc1000Settings::Key::Protect;
  if ((!sets && nibble != 0) || !allowed) return {};
  const std::uint16_t address = address_of(message);
  const unsigned word = words.read(address), mask = 1U << bit;
  words.write(address, static_cast<std::uint16_t>(sets ? word | mask : word & ~mask));
  const bool retests = settings.retest == Pc1000Settings::RetestIn::Always || settings.key == Pc1000Settings::Key::Stop;
  if (sets && address == kRetestWord && bit == kRetestBit && retests) settings.fault = settings.lasting_fault;
  return header_of(message);
}

Bytes Pc1000::erase(Data message) {
  constexpr std::array<std::uint8_t, 4> kOperands{1, 0, 0, 0};
  if (settings.plc == Pc1000Settings::Model::Pc1100 || settings.key != Pc1000Settings::Key::Stop ||
      !std::ranges::equal(message.subspan(1, kOperands.size()), kOperands) ||
      !std::ranges::equal(message.subspan(kMessageLength), erase_key()))
    return {};
  if (settings.erases == Pc1000Settings::Erases::Memory)
    words.clear();
  else
    for (std::uint32_t word = 0; word < kPc1000Registers; ++word) words.write(word, 0);
  return header_of(message);
}

}  // namespace s7200::westinghouse
