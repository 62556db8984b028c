// The answer of a slave: checked against the request byte by byte, decoded, and told in words.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "serial_sim/modbus/crc.hpp"
#include "serial_sim/peers/answer.hpp"

namespace s7200::modbus {

using serial::Verdict;

/// In an answer, `values` are the bits (0 or 1) or the registers of a read, those of file records one reference after the
/// other, and the data words of function 8. `bytes` are the data of functions 7 and 17 without their byte count, the
/// references of a maker's own kind, and all data of functions that are not in the table.
using serial::Answer;

/// Checks an answer; both texts are RTU frames. An answer of more than 4 characters is never right if its CRC is wrong.
Answer check_answer(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response);

/// Whether a frame reads bits or registers, or writes several, and cannot be an answer: its CRC is right, its count may be,
/// and an answer has other lengths. A write of one has the same form as its answer, and does not count.
bool is_request(std::span<const std::uint8_t> frame);

/// The way to name data: `register 1` or `register 40002`.
enum class Numbering : std::uint8_t { OnTheWire, Notation };

/// The answer in one line for people: `3 registers: 16#1234 16#0000 16#FFFF`, `coils 0…7: 1010 1010`, `exception 2: illegal
/// data address`, or what is wrong with it.
std::string describe(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response,
                     Numbering numbering = Numbering::OnTheWire);

}  // namespace s7200::modbus
