#include "tools/views/text_frame.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/text.hpp"
#include "serial_sim/modbus/answer.hpp"

namespace s7200::tools {
namespace {

using Byte = std::optional<std::uint8_t>;  ///< nothing: any byte

constexpr std::uint8_t kSTX = 2, kETX = 3;

/// An escape that stands for one character.
struct Escape {
  char written, meant;
};
constexpr Escape kEscapes[] = {{'r', '\r'}, {'n', '\n'}, {'t', '\t'}, {'\\', '\\'}, {'\'', '\''}, {'"', '"'}};

bool is_printable(std::uint8_t byte) { return byte >= 0x20 && byte <= 0x7E; }

/// Reads a text one character or escape after the other.
class TextReader {
 public:
  TextReader(std::string_view text, bool any_allowed) : text_(text), any_allowed_(any_allowed) {}

  std::vector<Byte> read(std::vector<serial::FrameError>& errors) {
    std::vector<Byte> bytes;
    while (place_ < text_.size() && errors.empty()) {
      const std::size_t begin = place_;
      const auto byte = next();
      if (!byte)
        errors.push_back({begin + 1, byte.why()});
      else if (bytes.size() == serial::kLongestRawFrame)
        errors.push_back({begin + 1, fmt::format("a frame has {} bytes at most", serial::kLongestRawFrame)});
      bytes.push_back(byte.value_or(Byte{}));
    }
    if (bytes.empty()) errors.push_back({1, "a frame has one byte at least"});
    return bytes;
  }

 private:
  Result<Byte> next() {
    const stl::Character first = stl::first_character(text_.substr(place_));
    if (first.code >= 0x80)
      return trouble("'{}' is not an ASCII character; write the byte that the program uses for it, such as \\xE4",
                     text_.substr(place_, first.bytes));
    const char c = text_[place_++];
    return c == '\\' ? escape() : Byte{static_cast<std::uint8_t>(c)};
  }

  Result<Byte> escape() {
    const char c = place_ < text_.size() ? text_[place_++] : ' ';
    if (c == '?' && any_allowed_) return Byte{};
    if (c == 'x') return hex();
    for (const Escape& escape : kEscapes)
      if (escape.written == c) return static_cast<std::uint8_t>(escape.meant);
    return trouble("\\ is followed by r, n, t, xHH, \\, ' or \"{}", any_allowed_ ? ", or by ? for any character" : "");
  }

  Result<Byte> hex() {
    const serial::ParsedFrame digits = serial::parse_hex_frame(text_.substr(place_, 2));
    if (text_.size() - place_ < 2 || !digits.ok()) return Trouble{"\\x is followed by two hex digits"};
    place_ += 2;
    return digits.frame[0].byte;
  }

  std::string_view text_;
  bool any_allowed_;
  std::size_t place_ = 0;
};

std::string written(const Byte& byte) {
  if (!byte) return "\\?";
  for (const auto& [escape, meant] : kEscapes)
    if (*byte == static_cast<std::uint8_t>(meant) && meant != '\'' && meant != '"') return {'\\', escape};
  if (!is_printable(*byte) || *byte == '\'') return fmt::format("\\x{:02X}", *byte);
  return {static_cast<char>(*byte)};
}

/// The text without `${`, which would be a parameter in a scenario.
std::string without_parameters(std::string text) {
  for (std::size_t at = 0; (at = text.find("${", at)) != std::string::npos;) text.replace(at, 1, "\\x24");
  return text;
}

bool is_modbus(std::span<const std::uint8_t> request) { return modbus::crc_ok(request); }

}  // namespace

serial::ParsedFrame parse_text(std::string_view text) {
  serial::ParsedFrame parsed;
  for (const Byte& byte : TextReader(text, false).read(parsed.errors)) parsed.frame.push_back({byte.value_or(0), false});
  return parsed;
}

Result<std::vector<Byte>> parse_text_pattern(std::string_view text) {
  std::vector<serial::FrameError> errors;
  std::vector<Byte> pattern = TextReader(text, true).read(errors);
  if (errors.empty()) return pattern;
  return Trouble{errors[0].message};
}

serial::ParsedFrame parse_hex_or_quoted(std::string_view text) {
  const std::size_t begin = std::min(text.size(), text.find_first_not_of(" \t"));
  text = stl::trim_end(text);
  const std::size_t length = quotation_length(text.substr(std::min(begin, text.size())));
  if (length == 0) return serial::parse_hex_frame(text);
  if (length == std::string_view::npos)
    return {.frame = {}, .errors = {{begin + 1, fmt::format("the closing {} is missing", text[begin])}}};
  if (begin + length != text.size())
    return {.frame = {}, .errors = {{begin + length + 1, "nothing follows the closing quotation mark"}}};
  serial::ParsedFrame parsed = parse_text(text.substr(begin + 1, length - 2));
  for (serial::FrameError& error : parsed.errors) error.column += begin + 1;
  return parsed;
}

std::size_t quotation_length(std::string_view text) {
  if (text.empty() || (text.front() != '\'' && text.front() != '"')) return 0;
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i] == text.front()) return i + 1;
    if (text[i] == '\\') ++i;
  }
  return std::string_view::npos;
}

bool is_text(std::span<const std::uint8_t> bytes) {
  const auto fits = [](std::uint8_t byte) {
    return is_printable(byte) || byte == '\r' || byte == '\n' || byte == '\t' || byte == kSTX || byte == kETX;
  };
  return std::all_of(bytes.begin(), bytes.end(), fits) && std::any_of(bytes.begin(), bytes.end(), is_printable);
}

std::string quoted_text(std::span<const Byte> pattern) {
  std::vector<std::uint8_t> known;
  std::string text;
  for (const Byte& byte : pattern) {
    if (byte) known.push_back(*byte);
    text += written(byte);
  }
  return is_text(known) ? fmt::format("'{}'", without_parameters(text)) : "";
}

std::string quoted_text(std::span<const std::uint8_t> bytes) {
  return quoted_text(std::vector<Byte>(bytes.begin(), bytes.end()));
}

std::string answer_text(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response) {
  if (response.empty()) return "no answer";
  return is_modbus(request) ? modbus::describe(request, response) : quoted_text(response);
}

std::string request_text(std::span<const std::uint8_t> request) { return is_modbus(request) ? "" : quoted_text(request); }

std::optional<std::string> plain_text(std::span<const std::uint8_t> request, std::span<const std::uint8_t> bytes) {
  if (is_modbus(request) || !is_text(bytes)) return {};
  return std::string(bytes.begin(), bytes.end());
}

}  // namespace s7200::tools
