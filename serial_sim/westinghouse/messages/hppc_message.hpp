// Messages of the HPPC loader.
//
//   0–1   length of the whole message, low byte first     4   00
//   2     destination                                     5   opcode; an answer repeats it, or has 10
//   3     source                                          6…  operands, then the frame check, high byte first
//
// Addresses have three bytes, low byte first.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/bytes.hpp"
#include "serial_sim/peers/answer.hpp"
#include "serial_sim/westinghouse/messages/words.hpp"

namespace s7200::westinghouse {

/// The table of the frame check. Both are CCITT's but for one entry of the document's table, which is not a misprint
/// according to its text.
enum class FcsTable : std::uint8_t { Document, Polynomial };
inline constexpr auto kFcsWords =
    words_of<FcsTable>({{FcsTable::Document, "document"}, {FcsTable::Polynomial, "polynomial"}});

std::uint16_t hppc_fcs(std::span<const std::uint8_t> bytes, FcsTable table);

enum class HppcOpcode : std::uint8_t {
  Monitor = 0x09,
  BitWrite = 0x0A,
  Write = 0x0B,
  Read = 0x0C,
  Parameters = 0x0D,
  Error = 0x10
};

/// The readings of the layouts that the document leaves open [H4] [H5] [H6].
struct HppcLayout {
  enum class ReadRequest : std::uint8_t { AddressAndNumber, Number };
  enum class BitWrite : std::uint8_t { PatternFirst, MaskFirst };

  ReadRequest read_request = ReadRequest::AddressAndNumber;  ///< [H4]
  BitWrite bit_write = BitWrite::PatternFirst;               ///< [H5]
  std::uint8_t monitor_address_bytes = 3;                    ///< [H6]

  bool operator==(const HppcLayout&) const = default;
};
inline constexpr auto kReadRequestWords = words_of<HppcLayout::ReadRequest>(
    {{HppcLayout::ReadRequest::AddressAndNumber, "address_and_number"}, {HppcLayout::ReadRequest::Number, "number"}});
inline constexpr auto kBitWriteWords = words_of<HppcLayout::BitWrite>(
    {{HppcLayout::BitWrite::PatternFirst, "pattern_first"}, {HppcLayout::BitWrite::MaskFirst, "mask_first"}});
inline constexpr std::array<std::uint8_t, 2> kMonitorAddressBytes{3, 4};
inline constexpr std::array<std::string_view, 2> kMonitorAddressWords{"3", "4"};  ///< in the same order

inline constexpr std::uint8_t kIop = 0x20, kApl = 0x40, kAll = 0xFF;
inline constexpr std::size_t kShortestHppc = 8, kLongestHppc = 0x400, kHppcHeader = 6;
inline constexpr std::uint32_t kHppcMemory = 0x100000, kParameterTable = 0x80000;
inline constexpr std::size_t kMostMonitored = 256;

/// A message with length and frame check.
Bytes hppc_message(std::uint8_t destination, std::uint8_t source, HppcOpcode opcode, std::span<const std::uint8_t> operands,
                   FcsTable table);

/// Operands of the requests. A read that has no address is from 0 on.
Bytes hppc_read(std::uint32_t address, std::uint8_t count, const HppcLayout& layout = {});
Bytes hppc_write(std::uint32_t address, std::span<const std::uint8_t> data);
Bytes hppc_bit_write(std::uint32_t address, std::uint16_t pattern, std::uint16_t mask, const HppcLayout& layout = {});
Bytes hppc_monitor(std::uint32_t network, std::span<const std::uint32_t> bytes, std::span<const std::uint32_t> words,
                   std::span<const std::uint32_t> double_words, const HppcLayout& layout = {});

std::uint32_t hppc_address(std::span<const std::uint8_t> bytes);
void add_hppc_address(Bytes& to, std::uint32_t address);

/// Whether the message has as many bytes as its length says.
bool is_whole_hppc(std::span<const std::uint8_t> message);

/// Checks an answer. `bytes` of the result are its operands. An exception is an error response.
serial::Answer check_hppc_answer(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response,
                                 FcsTable table);

/// The place of the holding registers.
struct HoldingRegisters {
  std::uint32_t base;                   ///< of register 1
  std::optional<std::uint16_t> number;  ///< nothing if the table ends before it
};

/// Finds the holding registers by the first 34 (hex) bytes of the parameter table or more: at offset 2E, or at 2C in a table
/// as in the document's example [H10]. Nothing if neither is an address of a register.
std::optional<HoldingRegisters> holding_registers(std::span<const std::uint8_t> table);

/// The meaning of the operands of an answer to 0D, an address of three bytes and its data: `parameter table at 16#80000,
/// holding register 1 at 16#ABFFE: 8a 00`
std::string hppc_parameters_text(std::span<const std::uint8_t> operands);

/// The first byte of an answer to a monitor: `status 16#10: processor not running`
std::string hppc_status_text(std::uint8_t status);

/// The name of an error: `illegal opcode`
std::string_view hppc_error_name(std::uint16_t code);

}  // namespace s7200::westinghouse
