// Modbus TCP in logs: programs with a console print each message with its head.
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/counted.hpp"
#include "serial_sim/modbus/mbap.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tools/recordings/forms.hpp"

namespace s7200::tools {
namespace {

using Rows = std::span<const RecordedFrame>;

struct WholeMessages {
  std::size_t rows = 1;  ///< that they are in
  bool may_be_serial =
      false;  ///< a request on a serial line may look like a message, and a message may have a CRC by chance
  std::vector<modbus::TcpMessage> messages{};
};

/// A message has its length, and protocol 0.
bool may_begin_message(const Bytes& bytes) {
  constexpr std::size_t kProtocol = 2, kLength = 4;
  return bytes.size() >= kLength && load16(&bytes[kProtocol]) == 0;
}

/// Most rows are one message.
bool is_one_message(const Bytes& bytes) {
  constexpr std::size_t kHead = 6, kShortest = kHead + 2;
  return bytes.size() >= kShortest && bytes.size() <= kHead + 1 + modbus::kLongestPdu &&
         load16(&bytes[kHead - 2]) == bytes.size() - kHead;
}

modbus::TcpMessage message_of(const Bytes& bytes) {
  constexpr std::size_t kUnit = 6;
  return {load16(bytes.data()), bytes[kUnit], Bytes(bytes.begin() + kUnit + 1, bytes.end())};
}

/// The messages that the first of the rows begins with. One that is not all there may go on in the next row of its
/// direction. There are none if the rows are not whole messages.
WholeMessages first_messages(Rows rows) {
  constexpr std::size_t kMostRows = 32;
  const Bytes& first = rows.front().bytes;
  if (!may_begin_message(first)) return {};
  WholeMessages whole;
  whole.may_be_serial = modbus::crc_ok(first);
  if (is_one_message(first)) return whole.messages.push_back(message_of(first)), whole;
  if (whole.may_be_serial) return {};
  modbus::MbapReader reader;
  for (whole.rows = 1; whole.rows <= std::min(rows.size(), kMostRows); ++whole.rows) {
    const RecordedFrame& row = rows[whole.rows - 1];
    if (row.direction != rows.front().direction || row.doubt) return {};
    reader.take(row.bytes);
    while (auto message = reader.next()) whole.messages.push_back(std::move(*message));
    if (!reader.error().empty()) return {};
    if (reader.pending() == 0) return whole;
  }
  return {};
}

RecordedFrame on_a_line(const RecordedFrame& frame, const modbus::TcpMessage& message) {
  return {.at = frame.at,
          .direction = frame.direction,
          .bytes = modbus::rtu_frame(message.unit, message.pdu),
          .place = frame.place,
          .stream = 1,
          .exchange = modbus::exchange_of(message)};
}

/// What it is, is not known: a request before it may have got it for an answer.
RecordedFrame not_a_message(const RecordedFrame& row) {
  return {.at = row.at,
          .direction = row.direction,
          .place = row.place,
          .stream = 1,
          .doubt = row.doubt ? row.doubt : std::make_shared<Doubt>(Doubt{.why = "it is not a whole message of Modbus TCP"})};
}

/// A row in doubt with the reading that is one message, if there is one.
RecordedFrame settled(const RecordedFrame& row) {
  const auto reading = std::ranges::find_if(
      row.doubt->readings, [](const Reading& each) { return may_begin_message(each.bytes) && is_one_message(each.bytes); });
  RecordedFrame frame = row;
  if (reading == row.doubt->readings.end()) return frame;
  frame.bytes = reading->bytes;
  frame.doubt.reset();
  return frame;
}

/// Rows of which the same is to be said.
struct Counted {
  std::string first{};
  std::size_t count = 0;

  void add(const std::string& what) {
    if (count++ == 0) first = what;
  }
  /// `, and 3 more`
  std::string more() const { return count == 1 ? "" : fmt::format(", and {} more", count - 1); }
};

}  // namespace

void read_modbus_tcp(LineRecording& recording) {
  std::vector<RecordedFrame> frames;
  Counted others, joined, ignored;
  std::size_t over_tcp = 0;
  frames.reserve(recording.frames.size());
  for (Rows rows = recording.frames; !rows.empty();) {
    const RecordedFrame& first = rows.front();
    const RecordedFrame row = first.doubt ? settled(first) : RecordedFrame{};
    const auto [count, may_be_serial, messages] = first_messages(first.doubt ? Rows(&row, 1) : rows);
    rows = rows.subspan(count);
    if (messages.empty()) {
      if (!first.doubt) others.add(first.place);
      frames.push_back(not_a_message(first));
      continue;
    }
    if (first.doubt) ignored.add(fmt::format("{}: '{}' beside the bytes", first.place, first.doubt->word));
    over_tcp += may_be_serial ? 0U : 1U;  // however many rows it took: those of other protocols may fit together by chance
    if (count > 1) joined.add(fmt::format("{}: a message of Modbus TCP in {}", first.place, counted(count, "row")));
    for (const modbus::TcpMessage& message : messages) frames.push_back(on_a_line(first, message));
  }
  if (over_tcp <= others.count) return;
  recording.frames = std::move(frames);
  recording.notes.emplace_back("the frames are messages of Modbus TCP: each is shown as on a serial line, with its CRC");
  if (joined.count > 0)
    recording.notes.push_back(fmt::format("{}{}: joined, as only the whole is one", joined.first, joined.more()));
  if (ignored.count > 0)
    recording.notes.push_back(
        fmt::format("{}{}: not read, as the bytes are a message without it", ignored.first, ignored.more()));
  if (others.count > 0)
    recording.notes.push_back(
        fmt::format("{}: left out{}: it is not a whole message of Modbus TCP", others.first, others.more()));
}

}  // namespace s7200::tools
