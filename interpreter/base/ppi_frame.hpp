// Frames of PPI, as both ends of a line know them (facts 10.9).
//
//   SD1  10 DA SA FC FCS 16         SD2  68 LE LE 68 DA SA FC data FCS 16         SD3  A2 DA SA FC data(8) FCS 16
//   E5: accepted                    DC DA SA: a token
//   DA, SA: destination and source   FC: function   LE: bytes from DA to the end of the data, 249 at most   FCS: their sum
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "interpreter/base/bytes.hpp"

namespace s7200::ppi {

inline constexpr std::uint8_t kAccepted = 0xE5;
inline constexpr std::size_t kLongestBody = 249, kLongestFrame = kLongestBody + 6, kLongestData = kLongestBody - 3;

/// Stations are 0 to 126; 127 is all of them.
inline constexpr std::uint8_t kLastStation = 126, kEveryStation = 127;
/// The bit of an address that announces more of the address in the data.
inline constexpr std::uint8_t kExtension = 0x80;

// The function of a request: its low bits say what is asked for. kFrameCount alternates from poll to poll, so that a
// repeated one is known.
inline constexpr std::uint8_t kIsRequest = 0x40, kFrameCount = 0x20, kService = 0x0F;
enum Service : std::uint8_t { kStatus = 0x09, kAnswerLow = 0x0C, kAnswerHigh = 0x0D };
inline constexpr std::uint8_t kRequestFunction = 0x6C, kPollFunction = 0x5C, kStatusFunction = 0x49;

/// The function code of a reply.
enum Reply : std::uint8_t { kSlave = 0x00, kNoResource = 0x02, kNoService = 0x03, kData = 0x08 };

/// A frame with addresses, without delimiters and check sum.
struct Body {
  std::uint8_t destination = 0, source = 0, function = 0;
  std::span<const std::uint8_t> data{};
};

/// The length of the frame that begins so; nothing while that cannot be said, 0 if it is not a frame.
std::optional<std::size_t> frame_length(std::span<const std::uint8_t> begin);

/// The body of a complete frame. Nothing if it has none, and for a wrong check sum or end.
std::optional<Body> body_of(std::span<const std::uint8_t> frame);

/// A token, passed from one master to another.
struct Token {
  std::uint8_t destination = 0, source = 0;
};

/// The token in a complete frame; nothing if the frame is not a token.
std::optional<Token> token_of(std::span<const std::uint8_t> frame);

/// SD1 without data, SD2 with data; kLongestData at most.
Bytes to_frame(const Body& body);

}  // namespace s7200::ppi
