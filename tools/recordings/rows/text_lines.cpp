// Text as a protocol: scales, instruments and modems send lines of ASCII, or texts between STX and ETX.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "serial_sim/line/frame.hpp"
#include "tools/recordings/readers.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;

constexpr std::uint8_t kTab = '\t', kLf = '\n', kCr = '\r', kEscape = 0x1B;

bool ends_line(std::uint8_t byte) { return byte == kCr || byte == kLf; }

bool is_of_a_text(std::uint8_t byte) {
  return (byte >= ' ' && byte <= '~') || ends_line(byte) || byte == kTab || byte == kEscape;
}

/// Bytes as a quoted text: `"R 12.5 kg\r\n"`
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

/// Characters that frame a text or are a message by themselves (ISO 1745).
constexpr std::uint8_t kStx = 0x02, kEtx = 0x03, kEtb = 0x17;
struct Signal {
  std::uint8_t byte;
  std::string_view name;
};
constexpr std::array kSignals{Signal{0x04, "EOT"}, Signal{0x05, "ENQ"}, Signal{0x06, "ACK"},
                              Signal{0x15, "NAK"}, Signal{0x11, "XON"}, Signal{0x13, "XOFF"}};

const Signal* find_signal(std::uint8_t byte) {
  const auto row = std::ranges::find(kSignals, byte, &Signal::byte);
  return row == kSignals.end() ? nullptr : &*row;
}

bool ends_block(std::uint8_t byte) { return byte == kEtx || byte == kEtb; }

/// A text between STX and ETX or ETB. A check of one or two characters may follow, which each device counts in its own way.
struct Block {
  Data text{}, check{};
  bool more_follows = false;  ///< it ends with ETB
};
std::optional<Block> block_of(Data bytes) {
  constexpr std::size_t kMostCheck = 2;
  if (bytes.empty() || bytes.front() != kStx) return {};
  const auto end = std::ranges::find_if(bytes, ends_block);
  if (end == bytes.end()) return {};
  const auto length = static_cast<std::size_t>(end - bytes.begin());
  const Data after = bytes.subspan(length + 1);
  const std::size_t line_end =
      !after.empty() && ends_line(after.back()) ? (after.size() > 1 && after[after.size() - 2] == kCr) + 1U : 0;
  if (after.size() - line_end > kMostCheck) return {};
  return Block{bytes.subspan(1, length - 1), after.first(after.size() - line_end), *end == kEtb};
}

ReadFrame read_text(const RecordedFrame& frame) {
  const Data bytes(frame.bytes);
  ReadFrame read{.direction = frame.direction, .text = quoted(frame.bytes)};
  const Signal* const signal = bytes.size() == 1 ? find_signal(bytes.front()) : nullptr;
  const auto block = block_of(bytes);
  const auto other = std::ranges::find_if_not(block ? block->text : bytes, is_of_a_text);
  if (signal != nullptr) {
    read.text = signal->name;
    read.right = true;
  } else if (block && other == block->text.end()) {
    read.text = fmt::format("STX {} {}{}", quoted(block->text), block->more_follows ? "ETB" : "ETX",
                            block->check.empty() ? "" : ", check " + serial::to_hex(block->check));
    read.right = true;
  } else if (!block && !bytes.empty() && other == bytes.end() && ends_line(bytes.back())) {
    read.right = true;
  } else if (other != (block ? block->text : bytes).end()) {
    read.text += fmt::format("; character {} is not of a text", &*other - bytes.data() + 1);
  } else {
    read.text += "; it has no line end";
  }
  return read;
}

/// A CR with nothing after it may have its LF to come.
std::size_t length_of_line(Data bytes) {
  const auto end = std::ranges::find_if(bytes, ends_line);
  if (end == bytes.end()) return 0;
  if (*end == kLf) return static_cast<std::size_t>(end - bytes.begin()) + 1;
  if (end + 1 == bytes.end()) return 0;
  return static_cast<std::size_t>(end - bytes.begin()) + (*(end + 1) == kLf ? 2U : 1U);
}

/// A block is a message with the check after it, if the bytes end there.
std::size_t first_text_message(Data bytes) {
  if (bytes.empty()) return 0;
  if (find_signal(bytes.front()) != nullptr) return 1;
  if (bytes.front() != kStx) return length_of_line(bytes);
  if (block_of(bytes)) return bytes.size();
  const auto end = std::ranges::find_if(bytes, ends_block);
  return end == bytes.end() ? 0 : static_cast<std::size_t>(end - bytes.begin()) + 1;
}

/// Whether the bytes are the beginning of a line or of a block.
bool begins_text(Data bytes) {
  const Data text = !bytes.empty() && bytes.front() == kStx ? bytes.subspan(1) : bytes;
  return std::ranges::all_of(text, is_of_a_text) &&
         (text.size() < bytes.size() || bytes.empty() || !ends_line(bytes.back()));
}

/// Reads lines of text. An answer that repeats the request cannot be told from the request sent again.
class TextReader final : public FrameReader {
 public:
  ReadFrame read(const RecordedFrame& frame, const RecordedFrame*) override { return read_text(frame); }
  bool may_be_echoed(const RecordedFrame&) const override { return false; }
  std::size_t first_message(Data bytes, const RecordedFrame*) const override { return first_text_message(bytes); }
  bool announces_more(Data bytes, Direction, const RecordedFrame*) const override { return begins_text(bytes); }
};

}  // namespace

std::unique_ptr<FrameReader> text_reader(const ChosenWords&) { return std::make_unique<TextReader>(); }

}  // namespace s7200::tools
