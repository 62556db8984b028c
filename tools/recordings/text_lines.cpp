// Text as a protocol: scales, instruments and modems send lines of ASCII.
#include <fmt/format.h>

#include <algorithm>

#include "tools/recordings/readers.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;

constexpr std::uint8_t kTab = '\t', kLf = '\n', kCr = '\r', kEscape = 0x1B;

bool ends_line(std::uint8_t byte) { return byte == kCr || byte == kLf; }

bool is_of_a_text(std::uint8_t byte) {
  return (byte >= ' ' && byte <= '~') || ends_line(byte) || byte == kTab || byte == kEscape;
}

/// `"R 12.5 kg\r\n"`
std::string quoted(Data bytes) {
  std::string text = "\"";
  for (const std::uint8_t byte : bytes) {
    if (byte == kCr)
      text += "\\r";
    else if (byte == kLf)
      text += "\\n";
    else if (byte == kTab)
      text += "\\t";
    else if (byte == '"' || byte == '\\')
      text += {'\\', static_cast<char>(byte)};
    else if (is_of_a_text(byte) && byte != kEscape)
      text += static_cast<char>(byte);
    else
      text += fmt::format("\\x{:02x}", byte);
  }
  return text + '"';
}

ReadFrame read_text(const RecordedFrame& frame) {
  ReadFrame read{.direction = frame.direction, .text = quoted(frame.bytes)};
  const auto other = std::ranges::find_if_not(frame.bytes, is_of_a_text);
  if (other != frame.bytes.end())
    read.text += fmt::format("; character {} is not of a text", other - frame.bytes.begin() + 1);
  else if (frame.bytes.empty() || !ends_line(frame.bytes.back()))
    read.text += "; it has no line end";
  else
    read.right = true;
  return read;
}

/// A CR with nothing after it may have its LF to come.
std::size_t first_line(Data bytes) {
  const auto end = std::ranges::find_if(bytes, ends_line);
  if (end == bytes.end()) return 0;
  if (*end == kLf) return static_cast<std::size_t>(end - bytes.begin()) + 1;
  if (end + 1 == bytes.end()) return 0;
  return static_cast<std::size_t>(end - bytes.begin()) + (*(end + 1) == kLf ? 2U : 1U);
}

/// What is sent back is not told from what is said again.
class TextReader final : public FrameReader {
 public:
  ReadFrame read(const RecordedFrame& frame, const RecordedFrame*) override { return read_text(frame); }
  bool may_be_echoed(const RecordedFrame&) const override { return false; }
  std::size_t first_message(Data bytes, const RecordedFrame*) const override { return first_line(bytes); }
};

}  // namespace

std::unique_ptr<FrameReader> text_reader(const ChosenWords&) { return std::make_unique<TextReader>(); }

}  // namespace s7200::tools
