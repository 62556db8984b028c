// Bytes that someone else sends at his own pace: standard input, a client of a server.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace s7200::tools {

class InputStream {
 public:
  enum class Came : std::uint8_t { Bytes, Nothing, End, Failure };
  struct Reading {
    Came came = Came::Nothing;
    std::size_t count = 0;  ///< of bytes
    std::string why{};      ///< of a failure
  };

  virtual ~InputStream() = default;

  /// Waits for bytes at most so long, and less when a signal comes.
  virtual Reading read(std::span<char> into, std::chrono::milliseconds at_most) = 0;
};

/// Standard input. It is to be read from one thread at a time.
InputStream& standard_input();

}  // namespace s7200::tools
