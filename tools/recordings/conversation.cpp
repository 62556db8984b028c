#include "tools/recordings/conversation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

#include "serial_sim/westinghouse/block_message.hpp"
#include "serial_sim/westinghouse/hppc_message.hpp"
#include "serial_sim/westinghouse/loader_session.hpp"
#include "tools/recordings/readers.hpp"
#include "tools/recordings/westinghouse.hpp"

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

/// The characters [begin, end) of a frame.
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

/// So that a log may have divided a frame there: programs are told late of what has come, and in pieces. In a capture no
/// frame ends with less than a character of silence.
bool follows_closely(const RecordedFrame& before, const RecordedFrame& after, const Stamps& stamps) {
  const auto between = silence(before, after, stamps);
  return before.direction == after.direction && before.stream == after.stream && between &&
         (stamps.exact ? *between < stamps.character && !overlap(before, after, stamps) : *between <= kCharacterGap);
}

void append(RecordedFrame& frame, const RecordedFrame& row) {
  for (const std::size_t place : row.damaged) frame.damaged.push_back(frame.bytes.size() + place);
  frame.bytes.insert(frame.bytes.end(), row.bytes.begin(), row.bytes.end());
  frame.times.insert(frame.times.end(), row.times.begin(), row.times.end());
  frame.more_was_lost = row.more_was_lost;
}

std::size_t count_right(std::span<const ReadFrame> frames) {
  return static_cast<std::size_t>(std::ranges::count_if(frames, &ReadFrame::right));
}

std::size_t count_fitting(std::span<const ReadFrame> frames) {
  return static_cast<std::size_t>(std::ranges::count_if(
      frames, [](const ReadFrame& each) { return each.right && each.direction != Direction::Unknown; }));
}

/// Frames that are right, and a request or an answer to one.
std::size_t fitting(const LineRecording& recording, const RecordedProtocol& protocol, const Stamps& stamps) {
  return count_fitting(conversation(recording, protocol, stamps));
}

std::size_t percent_right(std::span<const ReadFrame> frames) {
  return frames.empty() ? 0 : 100 * count_right(frames) / frames.size();
}

Direction other_way_round(Direction direction) {
  if (direction == Direction::Unknown) return direction;
  return direction == Direction::Request ? Direction::Answer : Direction::Request;
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
  const auto found = open.find(frame.exchange);
  return found == open.end() ? nullptr : &found->second;
}

ReadFrame Conversation::what_it_says(Stream& stream, const RecordedFrame& frame) const {
  const OpenRequest* open = stream.request_of(frame);
  const bool same = open != nullptr && frame.direction == Direction::Unknown && frame.bytes == open->frame.bytes;
  const auto waited = same && stream.reader->may_be_echoed(frame) ? silence(open->frame, frame, stamps_) : std::nullopt;
  const bool repeats = waited && *waited > stamps_.timeout;
  ReadFrame read = stream.reader->read(frame, open == nullptr || repeats ? nullptr : &open->frame);
  if (!repeats) return read;
  read.repeats = open->number;
  read.text += fmt::format("; repeated after {}, or its late echo", format_duration(*waited));
  return read;
}

ReadFrame Conversation::read(Stream& stream, RecordedFrame frame) {
  const bool inside = stamps_.exact && last_ && overlap(*last_, frame, stamps_);
  ReadFrame read = inside ? ReadFrame{.text = "begins inside the frame before"} : what_it_says(stream, frame);
  if (!frame.damaged.empty()) {
    read.right = false;
    const bool all = frame.damaged.size() == frame.bytes.size();
    read.text = fmt::format("{} damaged{}{}", all ? "it is" : fmt::format("character {} is", frame.damaged.front() + 1),
                            read.text.empty() ? "" : "; ", read.text);
  }
  if (last_) read.silence = known_silence(*last_, frame, stamps_);
  const OpenRequest* open = stream.request_of(frame);
  if (read.direction == Direction::Answer && open != nullptr) {
    read.other = open->number;
    read.latency = known_silence(open->frame, frame, stamps_);
    stream.open.erase(frame.exchange);
  } else if (read.direction == Direction::Request) {
    stream.open.erase(frame.exchange);
    if (!read.needs_no_answer) stream.open.emplace(frame.exchange, OpenRequest{frame, count_});
  }
  ++count_;
  if (!inside || end_of(frame, stamps_) > end_of(*last_, stamps_)) last_ = frame;
  read.frame = std::move(frame);
  return read;
}

std::vector<ReadFrame> Conversation::take_complete(RecordedFrame& frame) {
  Stream& stream = stream_of(frame);
  std::vector<ReadFrame> all;
  std::size_t begin = 0;
  while (begin < frame.bytes.size()) {
    const OpenRequest* open = stream.request_of(frame);
    const Data rest = Data(frame.bytes).subspan(begin);
    const std::size_t length = stream.reader->first_message(rest, open != nullptr ? &open->frame : nullptr);
    if (length == 0) break;
    all.push_back(read(stream, part_of(frame, begin, begin + length, stamps_)));
    begin += length;
  }
  if (begin > 0) frame = part_of(frame, begin, frame.bytes.size(), stamps_);
  return all;
}

bool Conversation::is_several(Stream& stream, const RecordedFrame& frame) const {
  const OpenRequest* const waiting = stream.request_of(frame);
  const bool said_so = stamps_.exact || !frame.damaged.empty();
  std::optional<RecordedFrame> open = waiting != nullptr ? std::optional(waiting->frame) : std::nullopt;
  if (said_so || stream.reader->read(frame, open ? &*open : nullptr).right) return false;
  for (std::size_t begin = 0, length = 0; begin < frame.bytes.size(); begin += length) {
    length = stream.reader->first_message(Data(frame.bytes).subspan(begin), open ? &*open : nullptr);
    if (length == 0) return false;
    const RecordedFrame message = part_of(frame, begin, begin + length, stamps_);
    const ReadFrame read = stream.reader->read(message, open ? &*open : nullptr);
    if (!read.right) return false;
    open = read.direction == Direction::Request && !read.needs_no_answer ? std::optional(message) : std::nullopt;
  }
  return true;
}

std::vector<ReadFrame> Conversation::add(RecordedFrame frame) {
  std::vector<ReadFrame> all;
  Stream& stream = stream_of(frame);
  const bool has_characters = frame.direction == Direction::Unknown && !frame.times.empty();
  if (has_characters || stream.reader->messages_share_frames() || is_several(stream, frame)) all = take_complete(frame);
  if (!frame.bytes.empty()) all.push_back(read(stream, std::move(frame)));
  return all;
}

RecordedFrame Conversation::take_frame(std::span<const RecordedFrame>& rows) {
  RecordedFrame first = rows.front();
  rows = rows.subspan(1);
  Stream& stream = stream_of(first);
  if (stream.reader->messages_share_frames() || rows.empty() || !follows_closely(first, rows.front(), stamps_)) return first;
  const OpenRequest* const open = stream.request_of(first);
  const auto is_right = [&](const RecordedFrame& frame) {
    return stream.reader->read(frame, open != nullptr ? &open->frame : nullptr).right;
  };
  constexpr std::size_t kMostRows = 8;
  RecordedFrame whole = first;
  for (std::size_t count = 0; !is_right(whole); ++count) {
    const RecordedFrame& before = count == 0 ? first : rows[count - 1];
    if (count == std::min(rows.size(), kMostRows) || !follows_closely(before, rows[count], stamps_)) return first;
    append(whole, rows[count]);
    if (is_right(whole)) return rows = rows.subspan(count + 1), whole;
  }
  return first;
}

std::vector<ReadFrame> conversation(const LineRecording& recording, const RecordedProtocol& protocol, const Stamps& stamps) {
  Conversation reading(protocol, stamps);
  std::vector<ReadFrame> all;
  for (std::span<const RecordedFrame> rows = recording.frames; !rows.empty();)
    for (ReadFrame& read : reading.add(reading.take_frame(rows))) {
      if (read.other) all[*read.other].other = all.size();
      all.push_back(std::move(read));
    }
  return all;
}

void settle_directions(LineRecording& recording, const RecordedProtocol& protocol, const Stamps& stamps) {
  const auto has = [&](Direction direction) {
    return std::ranges::find(recording.frames, direction, &RecordedFrame::direction) != recording.frames.end();
  };
  const bool requests = has(Direction::Request), answers = has(Direction::Answer), both = requests && answers;
  if (!recording.is_log || (!requests && !answers)) return;
  const std::size_t as_said = fitting(recording, protocol, stamps);
  if (as_said == recording.frames.size()) return;
  LineRecording otherwise = recording;
  for (RecordedFrame& frame : otherwise.frames)
    frame.direction = both ? other_way_round(frame.direction) : Direction::Unknown;
  if (fitting(otherwise, protocol, stamps) <= as_said) return;
  recording.frames = std::move(otherwise.frames);
  recording.notes.emplace_back(
      both ? "what the file marks as sent are the answers, and what it marks as received the requests"
           : "the file marks all frames alike: what they say tells requests and answers apart");
}

const RecordedProtocol* likelier_protocol(const LineRecording& recording, const RecordedProtocol& chosen,
                                          std::span<const ReadFrame> in_chosen, const Stamps& stamps) {
  constexpr std::size_t kHardlyAny = 10, kHalf = 50;
  if (percent_right(in_chosen) > kHardlyAny) return nullptr;
  const RecordedProtocol& best = *std::ranges::max_element(kProtocols, {}, [&](const RecordedProtocol& each) {
    const auto frames = conversation(recording, each, stamps);
    return std::pair(count_fitting(frames), count_right(frames));
  });
  return best.name != chosen.name && percent_right(conversation(recording, best, stamps)) >= kHalf ? &best : nullptr;
}

}  // namespace s7200::tools
