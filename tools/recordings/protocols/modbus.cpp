#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/ppi_frame.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "serial_sim/modbus/address.hpp"
#include "serial_sim/modbus/answer.hpp"
#include "serial_sim/modbus/functions.hpp"
#include "serial_sim/modbus/mbap.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/modbus/rtu_stream.hpp"
#include "tools/recordings/protocols/heard_functions.hpp"
#include "tools/recordings/readers.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;

constexpr std::size_t kShortestRtu = 4;

/// Registers as text: `16#1234 16#0000`
std::string words_text(Data bytes) {
  std::string text;
  for (std::size_t at = 0; at + 1 < bytes.size(); at += 2)
    text += fmt::format("{}16#{:04X}", at == 0 ? "" : " ", load16(&bytes[at]));
  return text;
}

/// Bits as text, the first bit first: `1010 1010 11`
std::string bits_text(Data bytes, std::size_t count) {
  std::string text;
  for (std::size_t bit = 0; bit < std::min(count, 8 * bytes.size()); ++bit)
    text.append(bit > 0 && bit % 4 == 0 ? " " : "").append(1, (bytes[bit / 8] >> bit % 8 & 1) != 0 ? '1' : '0');
  return text;
}

/// A reference as text: `file 4, record 1, 2 registers`, `extended memory 0010:0004, 2 bytes: 12 34`
std::string reference_text(const modbus::Reference& reference) {
  const bool file = reference.type == modbus::kFileReference;
  std::string text =
      file ? fmt::format("file {}, record {}, {}", reference.file, reference.record, counted(reference.count, "register"))
      : reference.type == modbus::kExtendedMemoryReference
          ? fmt::format("extended memory {:04X}:{:04X}, {}", reference.file, reference.record,
                        counted(reference.count, "byte"))
          : fmt::format("kind 16#{:02X}, {:04X}:{:04X}, {} of them", reference.type, reference.file, reference.record,
                        reference.count);
  if (!reference.data.empty()) text += ": " + (file ? words_text(reference.data) : serial::to_hex(reference.data));
  return text;
}

/// The rest of a request after its function, for functions that carry more than an address and a number.
std::string carried_text(const modbus::FunctionRow& row, Data data) {
  using modbus::Shape;
  constexpr std::size_t kBeforeWritten = 5;  // address, count, byte count
  switch (row.shape) {
    case Shape::WriteBits:
      return data.size() > kBeforeWritten ? ": " + bits_text(data.subspan(kBeforeWritten), load16(&data[2])) : "";
    case Shape::WriteRegisters:
      return data.size() > kBeforeWritten ? ": " + words_text(data.subspan(kBeforeWritten)) : "";
    case Shape::Diagnostics: {
      if (data.size() < 2) return "";
      const std::uint16_t subfunction = load16(data.data());
      const modbus::DiagnosticRow* known = modbus::find_diagnostics_subfunction(subfunction);
      const std::string values = words_text(data.subspan(2));
      return fmt::format(" {}{}{}{}", subfunction, known ? fmt::format(", {}", known->name) : "", values.empty() ? "" : ": ",
                         values);
    }
    case Shape::ReadFile:
    case Shape::WriteFile: {
      if (data.empty()) return "";
      std::string text;
      for (const modbus::Reference& each : modbus::references_of(data.subspan(1), row.shape == Shape::WriteFile))
        text.append(text.empty() ? ": " : "; ").append(reference_text(each));
      return text;
    }
    default:
      return "";
  }
}

/// Modbus TCP knows no broadcast: its unit 0 is an address like any other.
bool is_to_all(const RecordedFrame& frame) { return frame.stream == 0 && frame.bytes[0] == modbus::kBroadcast; }

/// A request as text: `station 1, read holding registers 40001, 10 of them`
std::string modbus_request_text(const RecordedFrame& recorded) {
  const Data frame = recorded.bytes;
  const std::uint8_t station = frame[0], function = frame[1];
  const modbus::FunctionRow* row = modbus::find_function(function);
  std::string text = is_to_all(recorded) ? "all stations" : fmt::format("station {}", station);
  if (row == nullptr) {
    const std::string heard = heard_request_text(function, frame.subspan(2, frame.size() - kShortestRtu));
    return text + ", " + (heard.empty() ? fmt::format("function {}", function) : heard);
  }
  text += fmt::format(", {}", row->name);
  const std::string carried = carried_text(*row, frame.subspan(2, frame.size() - kShortestRtu));
  if (frame.size() < kShortestRtu + 4) return text + carried;
  const std::uint16_t first = load16(&frame[2]), second = load16(&frame[4]);
  for (const modbus::AreaRow& area : modbus::areas()) {
    const bool reads = area.read == row->function, one = area.write_one == row->function,
               many = area.write_many == row->function;
    if (!reads && !one && !many) continue;
    const std::string notation = modbus::notation({area.area, first});
    text += " " + (notation.empty() ? fmt::format("{} on the wire", first) : notation);
    text += one ? fmt::format(" = 16#{:04X}", second) : fmt::format(", {} of them", second);
  }
  return text + carried;
}

/// Whether a request is as long as its function says, if the function determines the length.
bool has_length_of_request(Data bytes) {
  if (bytes.size() < kShortestRtu || (bytes[1] & modbus::kExceptionFlag) != 0) return false;
  const modbus::Extent extent = modbus::extent_of_request(bytes);
  return extent == modbus::Extent::Unknown ||
         (extent == modbus::Extent::Whole &&
          modbus::extent_of_request(bytes.first(bytes.size() - 1)) == modbus::Extent::Part);
}

Bytes with_crc(Data bytes) {
  Bytes frame(bytes.begin(), bytes.end());
  modbus::add_crc(frame);
  return frame;
}

bool is_modbus_tcp(Data bytes) {
  modbus::MbapReader reader;
  reader.take(bytes);
  const bool any = reader.next().has_value();
  while (reader.next()) continue;
  return any && reader.error().empty() && reader.pending() == 0;
}

bool is_ppi(Data bytes) {
  const auto length = bytes.size() > 1 ? ppi::frame_length(bytes) : std::nullopt;
  return length == bytes.size() && (ppi::token_of(bytes) || ppi::body_of(bytes));
}

bool has_crc_turned_round(Data bytes) {
  Bytes turned(bytes.begin(), bytes.end());
  if (turned.size() >= kShortestRtu) std::swap(turned[turned.size() - 2], turned.back());
  return modbus::crc_ok(turned);
}

/// The nature of a frame whose CRC is wrong, if it can be told; else empty. What is marked as an answer is called no
/// request, nor is the reverse done.
std::string what_it_is_instead(const RecordedFrame& frame, const RecordedFrame* open) {
  const Data bytes(frame.bytes);
  if (is_ppi(bytes)) return "a frame of PPI, not of Modbus RTU";
  if (has_crc_turned_round(bytes)) return "its CRC has the high byte first: Modbus RTU sends the low byte first";
  if (is_modbus_tcp(bytes) && !may_be_rtu_request_from_0(bytes))
    return "a message of Modbus TCP, not of Modbus RTU: it has a head and no CRC";
  const Bytes completed = with_crc(bytes);
  const bool may_be_answer = open != nullptr && frame.direction != Direction::Request && open->bytes != frame.bytes;
  if (may_be_answer && fits(modbus::check_answer(open->bytes, completed))) return "an answer without its CRC";
  const std::size_t whole = may_be_answer ? modbus::length_of_answer(open->bytes, bytes) : 0;
  if (frame.direction == Direction::Answer && bytes.size() < whole)
    return fmt::format("an answer that is cut off: {} of {} bytes", bytes.size(), whole);
  if (frame.direction != Direction::Answer && bytes.size() >= 2 && modbus::find_function(bytes[1]) != nullptr &&
      has_length_of_request(completed) && modbus::extent_of_request(completed) == modbus::Extent::Whole)
    return "a request without its CRC";
  return {};
}

std::string no_message(const RecordedFrame& frame, const RecordedFrame* open) {
  const std::string instead = what_it_is_instead(frame, open);
  return instead.empty() ? "wrong CRC, or not a whole frame" : instead;
}

/// Judges a frame without its text, which callers add if they want it.
ReadFrame judge_modbus(const RecordedFrame& frame, const RecordedFrame* open) {
  const Data bytes(frame.bytes);
  ReadFrame read;
  if (open != nullptr && frame.direction != Direction::Request) {
    const modbus::Answer answer = modbus::check_answer(open->bytes, bytes);
    if (fits(answer) || frame.direction == Direction::Answer) {
      read.direction = Direction::Answer;
      read.right = fits(answer);
      return read;
    }
  }
  const bool crc = bytes.size() >= kShortestRtu && modbus::crc_ok(bytes);
  const bool whole = crc && has_length_of_request(bytes);
  read.right = crc;
  if (frame.direction == Direction::Answer || (frame.direction == Direction::Unknown && !whole)) return read;
  read.direction = Direction::Request;
  read.station = bytes[0];
  read.needs_no_answer = crc && is_to_all(frame);
  read.right = whole;
  return read;
}

/// The answer of a function that only recordings have; empty for any other.
std::string answer_of_heard_function(Data answer, Data asked) {
  if (std::min(answer.size(), asked.size()) < kShortestRtu) return {};
  const auto data_of = [](Data frame) { return frame.subspan(2, frame.size() - kShortestRtu); };
  return heard_answer_text(answer[1], data_of(asked), data_of(answer));
}

std::string modbus_text(const RecordedFrame& frame, const RecordedFrame* open, const ReadFrame& read) {
  const Data bytes(frame.bytes);
  const bool crc = read.right || (bytes.size() >= kShortestRtu && modbus::crc_ok(bytes));
  if (read.direction == Direction::Answer) {
    const std::string instead = crc ? "" : what_it_is_instead(frame, open);
    const std::string heard = read.right && instead.empty() ? answer_of_heard_function(bytes, open->bytes) : "";
    if (!heard.empty()) return heard;
    return instead.empty() ? modbus::describe(open->bytes, bytes, modbus::Numbering::Notation) : instead;
  }
  if (!crc) return no_message(frame, open);
  if (read.direction == Direction::Unknown) return "an answer without its request";
  return read.right ? modbus_request_text(frame) : "no request: it does not have the length of its function";
}

// --- Modbus ASCII (Modbus over Serial Line V1.02, 2.5.2): a colon, two digits for each byte and for the LRC, CR LF ---

bool is_digit_of_ascii(std::uint8_t character) { return hex_digit(static_cast<char>(character)).has_value(); }

/// Whether the bytes are, or begin, a frame of Modbus ASCII. A frame of RTU to station 58 has no digit after its colon.
bool begins_ascii(Data bytes) {
  return !bytes.empty() && bytes.front() == ':' && (bytes.size() == 1 || is_digit_of_ascii(bytes[1]));
}

/// The length of the frame with its CR LF; 0 if that is not there.
std::size_t first_ascii_message(Data bytes) {
  for (std::size_t at = 1; at < bytes.size(); ++at)
    if (bytes[at - 1] == '\r' && bytes[at] == '\n') return at + 1;
  return 0;
}

/// A frame of Modbus ASCII.
struct AsciiFrame {
  Bytes rtu{};          ///< the same frame as Modbus RTU has it; its CRC is wrong if the LRC is
  std::string wrong{};  ///< `wrong LRC: 8E, expected 8D`; empty if nothing is
};

/// Returns nothing for a frame that is not of Modbus ASCII.
std::optional<AsciiFrame> ascii_frame_of(Data bytes) {
  constexpr std::size_t kShortest = 9;  // a colon, station, function, LRC, CR LF
  if (bytes.size() < kShortest || !begins_ascii(bytes) || first_ascii_message(bytes) != bytes.size()) return {};
  const Data digits = bytes.subspan(1, bytes.size() - 3);
  AsciiFrame frame;
  std::uint8_t sum = 0;
  for (std::size_t at = 0; at + 1 < digits.size(); at += 2) {
    const auto high = hex_digit(static_cast<char>(digits[at])), low = hex_digit(static_cast<char>(digits[at + 1]));
    frame.rtu.push_back(static_cast<std::uint8_t>(high.value_or(0) << 4 | low.value_or(0)));
    sum = static_cast<std::uint8_t>(sum + frame.rtu.back());
  }
  const std::uint8_t lrc = frame.rtu.back(), expected = static_cast<std::uint8_t>(lrc - sum);
  frame.rtu.pop_back();
  modbus::add_crc(frame.rtu);
  if (!std::ranges::all_of(digits, is_digit_of_ascii))
    frame.wrong = "a character of it is not a hex digit";
  else if (digits.size() % 2 != 0)
    frame.wrong = "a hex digit of it is missing";
  else if (lrc != expected)
    frame.wrong = fmt::format("wrong LRC: {:02X}, expected {:02X}", lrc, expected);
  if (!frame.wrong.empty()) frame.rtu.back() ^= 0xFF;
  return frame;
}

/// A frame of either mode with what the readers of RTU need.
struct InRtu {
  RecordedFrame frame{};
  std::string wrong{};

  InRtu(const RecordedFrame& recorded, AsciiFrame ascii)
      : frame{.direction = recorded.direction, .bytes = std::move(ascii.rtu), .stream = recorded.stream},
        wrong(std::move(ascii.wrong)) {}
};
std::optional<InRtu> in_rtu(const RecordedFrame* recorded) {
  auto ascii = recorded != nullptr ? ascii_frame_of(recorded->bytes) : std::nullopt;
  return ascii ? std::optional(InRtu(*recorded, *std::move(ascii))) : std::nullopt;
}

ReadFrame read_rtu(const RecordedFrame& frame, const RecordedFrame* open, bool with_text) {
  ReadFrame read = judge_modbus(frame, open);
  if (with_text) read.text = modbus_text(frame, open, read);
  return read;
}

/// Reads a frame of RTU or ASCII after a request of either.
ReadFrame read_either(const RecordedFrame& frame, const RecordedFrame* open, bool with_text) {
  const auto ascii = in_rtu(&frame), asked = in_rtu(open);
  ReadFrame read = read_rtu(ascii ? ascii->frame : frame, asked ? &asked->frame : open, with_text);
  if (ascii && !ascii->wrong.empty()) read.text = ascii->wrong;
  return read;
}

ReadFrame read_modbus(const RecordedFrame& frame, const RecordedFrame* open) { return read_either(frame, open, true); }

/// The length of the first message. Only the length that the function determines counts: part of a long frame may have a
/// right CRC by chance.
std::size_t first_modbus_message(Data bytes, const RecordedFrame* open) {
  if (begins_ascii(bytes)) return first_ascii_message(bytes);
  constexpr std::size_t kLongest = 2 * modbus::kLongestRtuFrame;  // PLCs with limits of their own
  modbus::Crc crc;
  for (std::size_t length = 1; length <= std::min(bytes.size(), kLongest); ++length) {
    crc.take(bytes[length - 1]);
    if (length < kShortestRtu || !crc.is_at_its_end()) continue;
    const Data first = bytes.first(length);
    if (open != nullptr && fits(modbus::check_answer(open->bytes, first))) return length;
    if (modbus::extent_of_request(first) == modbus::Extent::Whole && has_length_of_request(first)) return length;
  }
  return 0;
}

/// The messages of Modbus say how long they are.
class ModbusReader final : public PlainReader<read_modbus, first_modbus_message> {
 public:
  ReadFrame judge(const RecordedFrame& frame, const RecordedFrame* open) override { return read_either(frame, open, false); }
  bool has_form(Data bytes) const override { return ascii_frame_of(bytes).has_value(); }
  bool announces_more(Data bytes, Direction direction, const RecordedFrame* open) const override {
    if (begins_ascii(bytes)) return first_ascii_message(bytes) == 0;
    const bool begins_answer =
        direction != Direction::Request && open != nullptr && bytes.size() < modbus::length_of_answer(open->bytes, bytes);
    return begins_answer || (direction != Direction::Answer && modbus::extent_of_request(bytes) == modbus::Extent::Part);
  }
};

}  // namespace

bool may_be_rtu_request_from_0(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kWhole = 8, kFirst = 2, kCount = 4;
  if (bytes.size() != kWhole || load16(&bytes[kFirst]) != 0 || load16(&bytes[kCount]) != 2) return false;
  const auto function = static_cast<modbus::Function>(bytes[1]);
  return std::ranges::any_of(modbus::areas(), [function](const modbus::AreaRow& area) {
    return area.read == function || area.write_one == function || area.write_many == function;
  });
}

std::unique_ptr<FrameReader> modbus_reader(const ChosenWords&) { return std::make_unique<ModbusReader>(); }

}  // namespace s7200::tools
