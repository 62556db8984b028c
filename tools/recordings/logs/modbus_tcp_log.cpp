// Modbus TCP in logs: programs with a console print each message with its head.
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/counted.hpp"
#include "serial_sim/modbus/mbap.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/readers.hpp"

namespace s7200::tools {
namespace {

using Rows = std::span<const RecordedFrame>;

struct WholeMessages {
  std::size_t rows = 1;  ///< that they are in
  std::vector<modbus::TcpMessage> messages{};
};

/// A message has its length, and protocol 0.
bool may_begin_message(const Bytes& bytes) {
  constexpr std::size_t kProtocol = 2, kLength = 4;
  return bytes.size() >= kLength && load16(&bytes[kProtocol]) == 0;
}

/// Whether the bytes are one message, as in most rows.
bool is_one_message(const Bytes& bytes) {
  constexpr std::size_t kHead = 6, kShortest = kHead + 2;
  return bytes.size() >= kShortest && bytes.size() <= kHead + 1 + modbus::kLongestPdu &&
         load16(&bytes[kHead - 2]) == bytes.size() - kHead;
}

bool is_message(const Bytes& bytes) { return may_begin_message(bytes) && is_one_message(bytes); }

/// The messages that the first of the rows begins with, which is not just one. One that is not all there may go on in the
/// next row of its direction. There are none if the rows are not whole messages.
WholeMessages first_messages(Rows rows) {
  constexpr std::size_t kMostRows = 32;
  const Bytes& first = rows.front().bytes;
  if (!may_begin_message(first)) return {};
  WholeMessages whole;
  if (modbus::crc_ok(first)) return {};  // a request on a serial line may look like a message
  modbus::MbapReader reader;
  for (whole.rows = 1; whole.rows <= std::min(rows.size(), kMostRows); ++whole.rows) {
    const RecordedFrame& row = rows[whole.rows - 1];
    const bool wrapped = row.direction == Direction::Unknown && !row.at;
    if ((row.direction != rows.front().direction && !wrapped) || (row.doubt && row.bytes.empty())) return {};
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

/// Turns a row that is one message into a frame on a serial line.
RecordedFrame on_a_line(RecordedFrame row) {
  constexpr std::size_t kUnit = 6;
  row.stream = 1;
  row.exchange = modbus::exchange_of({load16(row.bytes.data()), row.bytes[kUnit], {}});
  row.bytes.erase(row.bytes.begin(), row.bytes.begin() + kUnit);
  modbus::add_crc(row.bytes);
  return row;
}

/// A row that is not a message: a request before it may have got it for an answer.
RecordedFrame not_a_message(const RecordedFrame& row) {
  return {.at = row.at,
          .direction = row.direction,
          .place = row.place,
          .stream = 1,
          .doubt = row.doubt ? row.doubt : std::make_shared<Doubt>(Doubt{.why = "it is not a whole message of Modbus TCP"})};
}

/// The reading of a doubtful row that is one message; null if there is none.
const Reading* reading_of(const RecordedFrame& row) {
  const auto& readings = row.doubt->readings;
  const auto found = std::ranges::find_if(readings, is_message, &Reading::bytes);
  return found == readings.end() ? nullptr : &*found;
}

/// Whether more rows begin with messages than with anything else.
bool is_mostly_modbus_tcp(Rows rows) {
  std::size_t over_tcp = 0, others = 0;
  while (!rows.empty()) {
    const RecordedFrame& first = rows.front();
    std::size_t count = 1;
    const Reading* const reading = first.doubt ? reading_of(first) : nullptr;
    const bool is_unknown = first.doubt && first.bytes.empty();
    if (!first.doubt && may_be_rtu_request_from_0(first.bytes)) {
      // says nothing of the others
    } else if (reading != nullptr) {
      over_tcp += !modbus::crc_ok(reading->bytes);
    } else if (!is_unknown && is_message(first.bytes)) {
      over_tcp += !modbus::crc_ok(first.bytes);  // by chance a message may have a CRC
    } else if (!is_unknown) {
      const WholeMessages whole = first_messages(rows);
      count = whole.rows;
      over_tcp += !whole.messages.empty();  // however many rows it took: those of other protocols may fit by chance
      others += whole.messages.empty();
    }
    rows = rows.subspan(count);
  }
  return over_tcp > others;
}

/// Rows of which the same is to be said.
struct Counted {
  std::string first{};
  std::size_t count = 0;

  void add(const std::string& what) {
    if (count++ == 0) first = what;
  }
  /// The number of further rows: `, and 3 more`
  std::string more() const { return count == 1 ? "" : fmt::format(", and {} more", count - 1); }
};

}  // namespace

void read_modbus_tcp(LineRecording& recording) {
  if (!is_mostly_modbus_tcp(recording.frames)) return;
  std::vector<RecordedFrame> frames;
  Counted others, joined, ignored;
  frames.reserve(recording.frames.size());
  for (std::span<RecordedFrame> rows = recording.frames; !rows.empty();) {
    RecordedFrame& first = rows.front();
    if (const Reading* const reading = first.doubt ? reading_of(first) : nullptr) {
      if (reading->without_word) ignored.add(fmt::format("{}: '{}' beside the bytes", first.place, first.doubt->word));
      first.bytes = reading->bytes;
      first.doubt.reset();
    }
    if (!first.doubt && is_message(first.bytes)) {
      frames.push_back(on_a_line(std::move(first)));
      rows = rows.subspan(1);
      continue;
    }
    const WholeMessages whole = first_messages(rows);
    rows = rows.subspan(whole.rows);
    if (whole.messages.empty()) {
      if (!first.doubt) others.add(first.place);
      frames.push_back(not_a_message(first));
      continue;
    }
    if (whole.rows > 1)
      joined.add(fmt::format("{}: a message of Modbus TCP in {}", first.place, counted(whole.rows, "row")));
    for (const modbus::TcpMessage& message : whole.messages) frames.push_back(on_a_line(first, message));
  }
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
