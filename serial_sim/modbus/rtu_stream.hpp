// Modbus RTU over a stream of bytes, which knows no silences between frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace s7200::modbus {

/// How many bytes the first request of a stream has, with its CRC, which is right; 0 if none is complete. That is all of the
/// stream, or as much as its function has (V1.1b3, section 6); or the shortest begin with a right CRC, where the length
/// cannot be told or is not kept to.
std::size_t first_request(std::span<const std::uint8_t> stream);

/// How much of a request has come, whatever its CRC.
enum class Extent : std::uint8_t {
  Part,     ///< less than its function has, or than any request
  Whole,    ///< as much as its function has, or more
  Unknown,  ///< the length of its function is not known
};
Extent extent_of_request(std::span<const std::uint8_t> stream);

/// Whether it is a whole request of Modbus RTU but for its CRC.
bool lacks_crc(std::span<const std::uint8_t> bytes);

/// How many bytes the answer to a request has, with its CRC, by what the stream begins with: one more than there are as
/// long as that cannot be told. 0 if the stream does not begin with an answer to the request, or its function does not say
/// how long one is.
std::size_t length_of_answer(std::span<const std::uint8_t> request, std::span<const std::uint8_t> stream);

}  // namespace s7200::modbus
