#include "tools/recordings/conversation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

#include "serial_sim/modbus/mbap.hpp"
#include "serial_sim/westinghouse/loader_session.hpp"
#include "serial_sim/westinghouse/messages/block_message.hpp"
#include "serial_sim/westinghouse/messages/hppc_message.hpp"
#include "tools/recordings/protocols/westinghouse.hpp"
#include "tools/recordings/readers.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;

constexpr std::array kBlockOptions{
    ReaderOption{"--data-check", "FORM", "what the check of a block of data is", westinghouse::kDataCheckWords},
};
constexpr std::array kLoaderOptions{
    ReaderOption{"--dle", "FORM", "a byte 10 in what the PLC sends", westinghouse::kDleWords},
};
constexpr std::array kHppcOptions{
    ReaderOption{"--read-request", "FORM", "operands of a read", westinghouse::kReadRequestWords},
    ReaderOption{"--bit-write", "FORM", "order of the words of a bit write", westinghouse::kBitWriteWords},
    ReaderOption{"--monitor-address-bytes", "BYTES", "of each address of a monitor", westinghouse::kMonitorAddressWords},
};

constexpr std::array kProtocols{
    RecordedProtocol{.name = "modbus", .reader = modbus_reader},
    RecordedProtocol{.name = "ppi", .reader = ppi_reader, .of_the_cpu = true},
    RecordedProtocol{.name = "freeport-pc", .reader = freeport_pc_reader},
    RecordedProtocol{.name = "pc1000-lan", .reader = block_reader, .options = kBlockOptions, .of_other_makes = true},
    RecordedProtocol{.name = "westnet", .reader = block_reader, .options = kBlockOptions, .of_other_makes = true},
    RecordedProtocol{
        .name = "pc500-loader", .reader = pc500_loader_reader, .options = kLoaderOptions, .of_other_makes = true},
    RecordedProtocol{.name = "hppc", .reader = hppc_reader, .options = kHppcOptions, .of_other_makes = true},
    RecordedProtocol{.name = "text", .reader = text_reader},
};

/// The characters [begin, end) of a frame, as a frame of their own.
RecordedFrame part_of(const RecordedFrame& frame, std::size_t begin, std::size_t end, const Stamps& stamps) {
  const auto cut = [&](const auto& list) {
    return std::remove_cvref_t<decltype(list)>(list.begin() + static_cast<std::ptrdiff_t>(begin),
                                               list.begin() + static_cast<std::ptrdiff_t>(end));
  };
  RecordedFrame part{.at = frame.at,
                     .direction = frame.direction,
                     .bytes = cut(frame.bytes),
                     .place = frame.place,
                     .stream = frame.stream,
                     .exchange = frame.exchange,
                     .doubt = frame.doubt,
                     .more_was_lost = frame.more_was_lost && end == frame.bytes.size()};
  const auto damaged = std::ranges::lower_bound(frame.damaged, begin);
  for (auto each = damaged; each != frame.damaged.end() && *each < end; ++each) part.damaged.push_back(*each - begin);
  if (!frame.times.empty()) {
    part.times = cut(frame.times);
    part.at = part.times.empty() ? std::nullopt : std::optional(part.times.front());
  } else if (frame.at && stamps.at_end) {
    *part.at -= static_cast<Time>(frame.bytes.size() - end) * stamps.character;
  } else if (frame.at) {
    *part.at += static_cast<Time>(begin) * stamps.character;
  }
  return part;
}

/// Whether the bytes of a row hold unless another reading of it is a right frame.
bool has_bytes(const RecordedFrame& row) { return !row.doubt || !row.bytes.empty(); }

/// Rows of one direction may be pieces of a frame. So may a row without time and direction below any: programs wrap long
/// lines.
bool may_be_divided(const RecordedFrame& before, const RecordedFrame& after) {
  const bool says_nothing = after.direction == Direction::Unknown && !after.at;
  const bool goes_on = before.direction == after.direction || says_nothing;
  return goes_on && before.stream == after.stream && has_bytes(before) && has_bytes(after);
}

/// Whether a log has both in one row, so that it does not say when the second began. Characters with times do.
bool share_row(const RecordedFrame& before, const RecordedFrame& after, const Stamps& stamps) {
  return !stamps.exact && after.times.empty() && !after.place.empty() && before.place == after.place;
}

/// Whether the second frame follows so soon that a log may have divided one frame there: programs see characters late and in
/// pieces. In a capture no frame ends with less than a character of silence.
bool follows_closely(const RecordedFrame& before, const RecordedFrame& after, const Stamps& stamps) {
  const auto between = silence(before, after, stamps);
  return may_be_divided(before, after) && between &&
         (stamps.exact ? *between < stamps.character && !overlap(before, after, stamps) : *between <= kCharacterGap);
}

void append(RecordedFrame& frame, const RecordedFrame& row) {
  for (const std::size_t place : row.damaged) frame.damaged.push_back(frame.bytes.size() + place);
  frame.bytes.insert(frame.bytes.end(), row.bytes.begin(), row.bytes.end());
  frame.times.insert(frame.times.end(), row.times.begin(), row.times.end());
  frame.more_was_lost = row.more_was_lost;
}

template <typename Tell>
void read_all(const LineRecording& recording, Conversation reading, Tell tell) {
  for (std::span<const RecordedFrame> rows = recording.frames; !rows.empty();)
    for (ReadFrame& read : reading.take(rows))
      if (!tell(read)) return;
}

struct Fitting {
  std::size_t fitting = 0;  ///< frames that are right, and a request, an answer to one, or its echo
  std::size_t right = 0;
  std::size_t frames = 0;
};
Fitting fitting(const LineRecording& recording, const RecordedProtocol& protocol, const Stamps& stamps,
                DirectionsTaken taken = DirectionsTaken::AsSaid) {
  Fitting found;
  Conversation reading(protocol, stamps, taken);
  reading.leave_out_texts();
  read_all(recording, std::move(reading), [&](const ReadFrame& each) {
    found.fitting += each.right && (each.echo || each.direction != Direction::Unknown) ? 1U : 0U;
    found.right += each.right ? 1U : 0U;
    ++found.frames;
    return true;
  });
  return found;
}

Direction taken_as(Direction said, DirectionsTaken taken) {
  if (said == Direction::Unknown || taken == DirectionsTaken::AsSaid) return said;
  if (taken == DirectionsTaken::Open) return Direction::Unknown;
  return said == Direction::Request ? Direction::Answer : Direction::Request;
}

}  // namespace

std::span<const RecordedProtocol> recorded_protocols() { return kProtocols; }

bool RecordedProtocol::choose(std::string_view option, std::string_view word) {
  const auto row = std::ranges::find(options, option, &ReaderOption::name);
  if (row == options.end()) return false;
  const auto place = std::ranges::find(row->words, word) - row->words.begin();
  chosen.at(static_cast<std::size_t>(row - options.begin())) = static_cast<std::uint8_t>(place);
  return true;
}

const RecordedProtocol* find_recorded_protocol(std::string_view name) {
  const auto found = std::ranges::find(kProtocols, name, &RecordedProtocol::name);
  return found == kProtocols.end() ? nullptr : &*found;
}

Conversation::Stream& Conversation::stream_of(const RecordedFrame& frame) {
  Stream& stream = streams_[frame.stream];
  if (!stream.reader) stream.reader = protocol_.reader(protocol_.chosen);
  return stream;
}

const Conversation::OpenRequest* Conversation::Stream::request_of(const RecordedFrame& frame) const {
  if (const auto found = open.find(frame.exchange); found != open.end()) return &found->second;
  const std::uint32_t first_unit = frame.exchange - frame.exchange % modbus::kUnitsOfATransaction;
  const auto other_unit = frame.direction == Direction::Answer ? open.lower_bound(first_unit) : open.end();
  const bool same = other_unit != open.end() && other_unit->first < first_unit + modbus::kUnitsOfATransaction;
  return same ? &other_unit->second : nullptr;
}

ReadFrame Conversation::what_reader_says(const Stream& stream, const RecordedFrame& frame, const RecordedFrame* open) const {
  return with_texts_ ? stream.reader->read(frame, open) : stream.reader->judge(frame, open);
}

ReadFrame Conversation::what_it_says(const Stream& stream, const RecordedFrame& frame) const {
  const OpenRequest* open = stream.request_of(frame);
  const bool same = open != nullptr && frame.direction == Direction::Unknown && frame.bytes == open->frame.bytes;
  const auto waited = same && stream.reader->may_be_echoed(frame) ? silence(open->frame, frame, stamps_) : std::nullopt;
  const bool repeats = waited && *waited > stamps_.timeout;
  ReadFrame read = what_reader_says(stream, frame, open == nullptr || repeats ? nullptr : &open->frame);
  if (!repeats) return read;
  read.repeats = open->number;
  read.text += fmt::format("; repeated after {}, or its late echo", format_duration(*waited));
  return read;
}

/// Whether the request that is open comes once more before its answer. If an answer may be the same, only a recording with
/// an echo elsewhere tells. Where no direction is said, a time does: the master repeats its request later than it hears
/// itself.
bool Conversation::is_echo(const Stream& stream, const RecordedFrame& frame) const {
  const OpenRequest* const open = stream.request_of(frame);
  if (open == nullptr || open->echoed || frame.direction == Direction::Request || frame.bytes != open->frame.bytes)
    return false;
  if (frame.stream != 0 || stream.reader->messages_share_frames()) return false;
  if (stream.reader->may_be_echoed(frame) && !hears_itself_) return false;
  if (frame.direction == Direction::Answer || frame.place == open->frame.place) return true;
  const auto waited = silence(open->frame, frame, stamps_);
  return !stamps_.exact && waited && *waited <= stamps_.timeout;
}

/// Whether what is left of a frame is the echo of a request with the answer to it.
bool Conversation::begins_with_echo(const Stream& stream, const RecordedFrame& frame, std::size_t begin,
                                    const RecordedFrame& open) const {
  const Data rest = Data(frame.bytes).subspan(begin), asked = open.bytes;
  const bool heard_again = rest.size() > asked.size() && std::equal(asked.begin(), asked.end(), rest.begin());
  if (!heard_again || frame.stream != 0 || frame.direction == Direction::Request || stream.reader->messages_share_frames())
    return false;
  const bool says_nothing = frame.direction == Direction::Unknown, same_row = frame.place == open.place;
  if (says_nothing && !same_row && silence(open, frame, stamps_).value_or(0) > stamps_.timeout) return false;
  if (says_nothing && stream.reader->may_be_echoed(open) && (same_row || rest.size() != 2 * asked.size())) return false;
  return stream.reader->first_message(rest.subspan(asked.size()), &open) > 0;
}

Conversation::Message Conversation::first_message(const Stream& stream, const RecordedFrame& frame, std::size_t begin,
                                                  const RecordedFrame* open) const {
  if (open != nullptr && begins_with_echo(stream, frame, begin, *open)) return {open->bytes.size(), true};
  return {stream.reader->first_message(Data(frame.bytes).subspan(begin), open), false};
}

ReadFrame Conversation::read(Stream& stream, RecordedFrame frame, bool echo) {
  echo = echo || is_echo(stream, frame);
  const bool inside = stamps_.exact && last_ && overlap(*last_, frame, stamps_);
  ReadFrame read = inside ? ReadFrame{.text = "begins inside the frame before"}
                   : echo ? ReadFrame{.right = true, .text = "the echo of the request", .echo = true}
                          : what_it_says(stream, frame);
  if (!frame.damaged.empty()) {
    read.right = false;
    const bool all = frame.damaged.size() == frame.bytes.size();
    read.text = fmt::format("{} damaged{}{}", all ? "it is" : fmt::format("character {} is", frame.damaged.front() + 1),
                            read.text.empty() ? "" : "; ", read.text);
  }
  const bool begins_in_row = last_ && share_row(*last_, frame, stamps_) && !stream.reader->messages_share_frames();
  if (last_ && !begins_in_row) read.silence = known_silence(*last_, frame, stamps_);
  const OpenRequest* const open = stream.request_of(frame);
  if (echo) {
    stream.open.at(frame.exchange).echoed = true;
    hears_itself_ = true;
  } else if (read.direction == Direction::Answer && open != nullptr) {
    read.other = open->number;
    read.asked_at = open->frame.place;
    read.out_of_turn = open->number != last_request_;
    if (!share_row(open->frame, frame, stamps_)) read.latency = known_silence(open->frame, frame, stamps_);
    stream.open.erase(open->frame.exchange);
  } else if (read.direction == Direction::Request) {
    last_request_ = count_;
    stream.open.erase(frame.exchange);
    if (!read.needs_no_answer) stream.open.emplace(frame.exchange, OpenRequest{.frame = frame, .number = count_});
  }
  ++count_;
  if (!inside || end_of(frame, stamps_) > end_of(*last_, stamps_)) last_ = frame;
  read.frame = std::move(frame);
  return read;
}

std::vector<ReadFrame> Conversation::take_complete(RecordedFrame& frame) { return take_complete(frame, 1); }

std::vector<ReadFrame> Conversation::take_complete(RecordedFrame& frame, std::size_t rows) {
  Stream& stream = stream_of(frame);
  std::vector<ReadFrame> all;
  std::size_t begin = 0, heard = 0;
  // A log has the time when it got the row. An echo in it was on the line while the request was sent.
  const bool is_row = !stamps_.exact && !stamps_.at_end && rows == 1 && frame.times.empty() && frame.at;
  const auto part = [&](std::size_t from, std::size_t to) {
    RecordedFrame cut = part_of(frame, from, to, stamps_);
    if (is_row) *cut.at -= static_cast<Time>(heard) * stamps_.character;
    return cut;
  };
  while (begin < frame.bytes.size()) {
    const OpenRequest* open = stream.request_of(frame);
    const auto [length, echo] = first_message(stream, frame, begin, open != nullptr ? &open->frame : nullptr);
    if (length == 0) break;
    all.push_back(read(stream, part(begin, begin + length), echo));
    begin += length;
    heard += echo ? length : 0;
  }
  if (begin > 0) frame = part(begin, frame.bytes.size());
  return all;
}

bool Conversation::is_several(const Stream& stream, const RecordedFrame& frame) const {
  const OpenRequest* const waiting = stream.request_of(frame);
  const bool said_so = stamps_.exact || !frame.damaged.empty();
  if (said_so || stream.reader->judge(frame, waiting != nullptr ? &waiting->frame : nullptr).right) return false;
  std::optional<RecordedFrame> open = waiting != nullptr ? std::optional(waiting->frame) : std::nullopt;
  for (std::size_t end = 0; end < frame.bytes.size();) {
    const auto [length, echo] = first_message(stream, frame, end, open ? &*open : nullptr);
    const std::size_t begin = std::exchange(end, end + length);
    if (length == 0) return false;
    if (echo) continue;
    const RecordedFrame message = part_of(frame, begin, end, stamps_);
    const ReadFrame read = stream.reader->judge(message, open ? &*open : nullptr);
    if (!read.right) return false;
    open = read.direction == Direction::Request && !read.needs_no_answer ? std::optional(message) : std::nullopt;
  }
  return true;
}

std::vector<ReadFrame> Conversation::add(RecordedFrame frame) { return add(std::move(frame), 1); }

std::vector<ReadFrame> Conversation::add(RecordedFrame frame, std::size_t rows) {
  std::vector<ReadFrame> all;
  Stream& stream = stream_of(frame);
  const bool has_characters = frame.direction == Direction::Unknown && !frame.times.empty();
  const bool may_be_several = !is_echo(stream, frame);
  if (may_be_several && (has_characters || stream.reader->messages_share_frames() || is_several(stream, frame)))
    all = take_complete(frame, rows);
  if (!frame.bytes.empty()) all.push_back(read(stream, std::move(frame), false));
  return all;
}

Conversation::Rest Conversation::rest_after_messages(const Stream& stream, const RecordedFrame& frame) const {
  const OpenRequest* const waiting = stream.request_of(frame);
  Rest rest{.open = waiting != nullptr ? std::optional(waiting->frame) : std::nullopt};
  while (rest.begin < frame.bytes.size()) {
    const auto [length, echo] = first_message(stream, frame, rest.begin, rest.open ? &*rest.open : nullptr);
    if (length == 0) break;
    const std::size_t begin = std::exchange(rest.begin, rest.begin + length);
    if (echo || rest.begin == frame.bytes.size()) continue;
    const Data message = Data(frame.bytes).subspan(begin, length);
    const bool again =
        rest.open && std::ranges::equal(message, rest.open->bytes) && !stream.reader->may_be_echoed(*rest.open);
    if (again) continue;
    rest.open = rest.open ? std::nullopt : std::optional(part_of(frame, begin, rest.begin, stamps_));
  }
  return rest;
}

bool Conversation::announces_more(const Stream& stream, const RecordedFrame& frame, const Rest& rest) const {
  const Data bytes = Data(frame.bytes).subspan(rest.begin);
  const RecordedFrame* const open = rest.open ? &*rest.open : nullptr;
  const bool begins_echo = open != nullptr && frame.direction != Direction::Request && bytes.size() < open->bytes.size() &&
                           std::equal(bytes.begin(), bytes.end(), open->bytes.begin());
  return begins_echo || stream.reader->announces_more(bytes, frame.direction, open);
}

bool Conversation::ends_as_announced(const Stream& stream, const RecordedFrame& frame, const Rest& rest) const {
  if (frame.bytes.size() <= rest.begin + 1 || announces_more(stream, frame, rest)) return false;
  RecordedFrame shorter = frame;
  shorter.bytes.pop_back();
  return announces_more(stream, shorter, rest);
}

Conversation::AnnouncedRows Conversation::announced_rows(const Stream& stream, RecordedFrame whole,
                                                         std::span<const RecordedFrame> rows) const {
  constexpr std::size_t kMostRows = 256;  // the longest frame of Modbus RTU, a byte in each row
  if (stamps_.exact && stream.request_of(whole) == nullptr) return {};
  for (std::size_t count = 1; count <= std::min(rows.size(), kMostRows); ++count) {
    const Rest rest = rest_after_messages(stream, whole);
    if (rest.begin == whole.bytes.size()) return {.count = count};
    const bool alone = count > 1 && stream.reader->judge(rows[count - 1], nullptr).right;
    if (count > 1 && !alone && ends_as_announced(stream, whole, rest)) return {.count = count, .right = false};
    if (count == rows.size() || !announces_more(stream, whole, rest) || !may_be_divided(rows[count - 1], rows[count]) ||
        (stamps_.exact && overlap(rows[count - 1], rows[count], stamps_)))
      return {};
    append(whole, rows[count]);
  }
  return {};
}

std::size_t Conversation::close_rows(const Stream& stream, RecordedFrame whole, std::span<const RecordedFrame> rows) const {
  constexpr std::size_t kMostRows = 9;
  const OpenRequest* const open = stream.request_of(whole);
  for (std::size_t count = 1; count <= std::min(rows.size(), kMostRows); ++count) {
    if (stream.reader->judge(whole, open != nullptr ? &open->frame : nullptr).right) return count;
    if (count == rows.size() || !follows_closely(rows[count - 1], rows[count], stamps_)) return 1;
    append(whole, rows[count]);
  }
  return 1;
}

std::optional<RecordedFrame> Conversation::settled(const Stream& stream, const RecordedFrame& row,
                                                   bool& without_word) const {
  if (row.stream != 0) return {};  // its messages have been told apart already
  const OpenRequest* const open = stream.request_of(row);
  RecordedFrame frame = row;
  for (const Reading& reading : row.doubt->readings) {
    frame.bytes = reading.bytes;
    without_word = reading.without_word;
    if (is_echo(stream, frame) || stream.reader->judge(frame, open != nullptr ? &open->frame : nullptr).right) return frame;
  }
  if (row.bytes.empty()) return {};
  frame.bytes = row.bytes;
  without_word = false;
  return frame;
}

/// Whatever a request before it got for an answer may be in the row, unless that is text. Answers of Modbus TCP name their
/// request.
ReadFrame Conversation::not_read(Stream& stream, RecordedFrame row) {
  ReadFrame read{.text = "not read: " + row.doubt->why, .not_read = true};
  read.may_be_answer = !stream.open.empty() && !row.doubt->is_text;
  if (row.stream == 0 && !row.doubt->is_text) stream.open.clear();
  last_.reset();
  ++count_;
  read.frame = std::move(row);
  return read;
}

std::vector<ReadFrame> Conversation::take(std::span<const RecordedFrame>& rows) {
  RecordedFrame frame = rows.front();
  frame.direction = taken_as(frame.direction, taken_);
  Stream& stream = stream_of(frame);
  const bool may_go_on = rows.size() > 1 && may_be_divided(rows[0], rows[1]) && !stream.reader->messages_share_frames();
  const AnnouncedRows announced = may_go_on ? announced_rows(stream, frame, rows) : AnnouncedRows{};
  std::size_t count = announced.right ? announced.count : 1;
  if (count == 1 && may_go_on && follows_closely(rows[0], rows[1], stamps_)) count = close_rows(stream, frame, rows);
  for (const RecordedFrame& row : rows.subspan(1, count - 1)) append(frame, row);
  rows = rows.subspan(count);
  if (count > 1) frame.doubt.reset();
  std::vector<ReadFrame> all;
  if (const auto doubt = frame.doubt) {
    bool without_word = false;
    auto known = settled(stream, frame, without_word);
    if (!known) return {not_read(stream, std::move(frame))};
    all = add(*std::move(known), count);
    if (without_word) all.back().ignored = doubt->word;
  } else {
    all = add(std::move(frame), count);
  }
  all.back().pieces = count;
  if (count == 1) all.back().wrong_with_rows = announced.count - 1;
  return all;
}

void tell_conversation(const LineRecording& recording, const RecordedProtocol& protocol, const Stamps& stamps,
                       const std::function<bool(ReadFrame&)>& tell) {
  read_all(recording, Conversation(protocol, stamps), tell);
}

std::vector<bool> answered_requests(const LineRecording& recording, const RecordedProtocol& protocol, const Stamps& stamps) {
  std::vector<bool> answered;
  Conversation reading(protocol, stamps);
  reading.leave_out_texts();
  read_all(recording, std::move(reading), [&](const ReadFrame& frame) {
    answered.push_back(false);
    if (frame.other) answered[*frame.other] = true;
    return true;
  });
  return answered;
}

std::vector<ReadFrame> conversation(const LineRecording& recording, const RecordedProtocol& protocol, const Stamps& stamps) {
  std::vector<ReadFrame> all;
  tell_conversation(recording, protocol, stamps, [&](ReadFrame& read) {
    if (read.other) all[*read.other].other = all.size();
    all.push_back(std::move(read));
    return true;
  });
  return all;
}

void settle_directions(LineRecording& recording, const RecordedProtocol& protocol, const Stamps& stamps) {
  const auto has = [&](Direction direction) {
    return std::ranges::find(recording.frames, direction, &RecordedFrame::direction) != recording.frames.end();
  };
  const bool requests = has(Direction::Request), answers = has(Direction::Answer), both = requests && answers;
  if (!recording.is_log || (!requests && !answers)) return;
  const Fitting as_said = fitting(recording, protocol, stamps);
  if (as_said.fitting == as_said.frames) return;
  const DirectionsTaken taken = both ? DirectionsTaken::TheOtherWayRound : DirectionsTaken::Open;
  if (fitting(recording, protocol, stamps, taken).fitting <= as_said.fitting) return;
  for (RecordedFrame& frame : recording.frames) frame.direction = taken_as(frame.direction, taken);
  recording.notes.emplace_back(
      both ? "what the file marks as sent are the answers, and what it marks as received the requests"
           : "the file marks all frames alike: what they say tells requests and answers apart");
}

void ConversationNotes::add(const ReadFrame& frame) {
  const std::string_view kind = frame.direction == Direction::Request  ? "a request"
                                : frame.direction == Direction::Answer ? "an answer"
                                                                       : "a frame";
  if (frame.pieces > 1 && in_pieces_.count++ == 0)
    in_pieces_.first = fmt::format("{}: {} in {} pieces", frame.frame.place, kind, frame.pieces);
  if (frame.wrong_with_rows > 0 && wrong_in_pieces_.count++ == 0)
    wrong_in_pieces_.first =
        fmt::format("{}: with the {} it has the length that it announces", frame.frame.place,
                    frame.wrong_with_rows == 1 ? "row below" : fmt::format("{} rows below", frame.wrong_with_rows));
  if (!frame.ignored.empty() && ignored_.count++ == 0)
    ignored_.first = fmt::format("{}: '{}' beside the bytes", frame.frame.place, frame.ignored);
  if (frame.not_read && !frame.frame.doubt->readings.empty()) not_read_.add(frame.frame);
  if (frame.echo && echoes_.count++ == 0) echoes_.first = fmt::format("{}: the echo of a request", frame.frame.place);
}

std::vector<std::string> ConversationNotes::list() const {
  std::vector<std::string> notes = not_read_.notes();
  const auto add = [&](const Frames& frames, std::string_view why) {
    const std::string more = frames.count > 1 ? fmt::format(", and {} more", frames.count - 1) : "";
    if (frames.count > 0) notes.push_back(fmt::format("{}{}: {}", frames.first, more, why));
  };
  add(ignored_, "not read, as the bytes are a right frame without it");
  add(in_pieces_, "joined, as only the whole is right");
  add(wrong_in_pieces_, "what is wrong is the check sum of the whole");
  add(echoes_, "an adapter for two wires hears what it sends; that is not an answer");
  return notes;
}

const RecordedProtocol* likelier_protocol(const LineRecording& recording, const RecordedProtocol& chosen,
                                          const RightFrames& in_chosen, const Stamps& stamps) {
  constexpr std::size_t kHardlyAny = 10, kHalf = 50, kLongest = 4096;  // longer than a frame of any of them
  if (in_chosen.percent() > kHardlyAny) return nullptr;
  if (std::ranges::any_of(recording.frames, [](const RecordedFrame& frame) { return frame.bytes.size() > kLongest; }))
    return nullptr;
  const auto reader = chosen.reader(chosen.chosen);
  const auto of_chosen =
      std::ranges::count_if(recording.frames, [&](const RecordedFrame& frame) { return reader->has_form(frame.bytes); });
  if (2 * static_cast<std::size_t>(of_chosen) > recording.frames.size()) return nullptr;
  const RecordedProtocol& best = *std::ranges::max_element(kProtocols, {}, [&](const RecordedProtocol& each) {
    const Fitting found = fitting(recording, each, stamps);
    return std::pair(found.fitting, found.right);
  });
  RightFrames in_best;
  tell_conversation(recording, best, stamps, [&](const ReadFrame& frame) { return in_best.add(frame), true; });
  return best.name != chosen.name && in_best.percent() >= kHalf ? &best : nullptr;
}

}  // namespace s7200::tools
