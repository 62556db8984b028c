// Answers: 21 bytes.
//
//   1       'g'                       19–20  XOR of bytes 3 to 18
//   2       status                    21     end character
//   3–18    data of a read
//
// Data and check code are hex digits. In answers that are not to a read neither means anything.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "serial_sim/peers/answer.hpp"

namespace s7200::pc_protocol {

inline constexpr std::size_t kAnswerLength = 21;

/// The end character as in the protocol's text; the program published with it sends 26.
inline constexpr std::uint8_t kEndCharacter = 0x26;

enum class Status : std::uint8_t { ReadDone = 1, WriteDone = 2, WrongCheckCode = 3, NotLegal = 4 };

/// The name of a refusal: `check code wrong`, `command not legal`
std::string_view refusal_name(std::uint16_t status);

/// Checks an answer. `bytes` of the result are the eight of a read; `values` stay empty, as the command does not say how
/// many are wanted. The check code is looked at in answers to reads only.
serial::Answer check_answer(std::span<const std::uint8_t> command, std::span<const std::uint8_t> response,
                            std::uint8_t end_character);

}  // namespace s7200::pc_protocol
