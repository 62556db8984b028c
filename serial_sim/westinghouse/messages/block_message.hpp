// The six-byte messages of the PC1000 LAN and of the Westnet II highway, and the blocks of data after them.
//
//   opcode, four bytes, check    a check is the sum of the bytes before it; that of a block is of its data only [L4]
//
// Words are low byte first.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "interpreter/base/bytes.hpp"
#include "serial_sim/peers/answer.hpp"
#include "serial_sim/westinghouse/messages/words.hpp"

namespace s7200::westinghouse {

enum class Opcode : std::uint8_t {
  BitWrite = 0x03,
  ReadBlock = 0x05,
  WriteBlock = 0x07,
  Highway = 0x09,  ///< Westnet II
  SetUnitAddress = 0x0A,
  Erase = 0x0F,
};

/// The second byte of a message with Opcode::Highway.
enum class HighwayCommand : std::uint8_t {
  SetAddress,
  ReadRemoteAddress,
  ReadHighwayStatus,
  OpenSession,
  CloseSession,
  ReadSessionStatus,
  ReadLocalAddress,
};

inline constexpr std::size_t kMessageLength = 6, kEraseKeyLength = 16, kMostBlockBytes = 256;
inline constexpr std::uint8_t kHighwayError = 0xFF;  ///< the first of two bytes [W5]
inline constexpr std::uint8_t kNoSession = 0x80;     ///< of a session status
inline constexpr std::uint16_t kRetestWord = 0x8205;
inline constexpr std::uint8_t kRetestBit = 1;

std::uint8_t sum(std::span<const std::uint8_t> bytes);

/// The check of a block: the sum of its data, or their XOR.
enum class DataCheck : std::uint8_t { Sum, Xor };
inline constexpr auto kDataCheckWords = words_of<DataCheck>({{DataCheck::Sum, "sum"}, {DataCheck::Xor, "xor"}});
std::uint8_t data_check(std::span<const std::uint8_t> data, DataCheck by);

Bytes message(Opcode opcode, std::uint8_t b1 = 0, std::uint8_t b2 = 0, std::uint8_t b3 = 0, std::uint8_t b4 = 0);

/// The messages, from their second to their sixth byte; `bytes` is 1 to 256, `data` as long.
Bytes set_unit_address(std::uint8_t unit);
Bytes read_block(std::uint16_t address, std::size_t bytes);
Bytes write_block(std::uint16_t address, std::span<const std::uint8_t> data, DataCheck by = DataCheck::Sum);
Bytes write_bit(std::uint16_t address, std::uint8_t bit, bool on);
Bytes retest();
Bytes erase();
Bytes highway(HighwayCommand command, std::uint8_t highway = 0, std::uint8_t drop = 0, std::uint8_t subdrop = 0);

/// Whether a message with Opcode::BitWrite is a retest().
bool is_retest(std::span<const std::uint8_t> message);

/// The bytes that PLCs want to see before they erase.
std::span<const std::uint8_t> erase_key();

/// Whether there is as much of an answer as its beginning says.
bool is_whole_answer(std::span<const std::uint8_t> response);

/// Checks an answer. `bytes` of the result are the data of a read, keyswitch and fault register of a set unit address, or
/// the three bytes after a highway command. An exception is a two-byte error of the highway.
serial::Answer check_block_answer(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response,
                                  DataCheck by = DataCheck::Sum);

/// The message `wrong data check`, and whether it is right by the other rule.
std::string wrong_data_check(std::span<const std::uint8_t> data, std::uint8_t check, DataCheck by);

/// The meaning of `bytes` in the answer to a set unit address: `keyswitch in stop, fault register 16#0204`.
std::string unit_text(std::span<const std::uint8_t> bytes);

/// The meaning of `bytes` in the answer to a highway command: `session of 00.22.00`.
std::string highway_text(std::span<const std::uint8_t> request, std::span<const std::uint8_t> bytes);

/// The name of a highway's error: `invalid drop addressed`
std::string_view highway_error_name(std::uint16_t code);

}  // namespace s7200::westinghouse
