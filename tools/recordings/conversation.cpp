#include "tools/recordings/conversation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "tools/recordings/readers.hpp"
#include "tools/recordings/westinghouse.hpp"

namespace s7200::tools {
namespace {

constexpr std::array kProtocols{
    RecordedProtocol{"modbus", modbus_reader},
    RecordedProtocol{"ppi", ppi_reader},
    RecordedProtocol{"freeport-pc", freeport_pc_reader},
    RecordedProtocol{"pc1000-lan", pc1000_lan_reader},
    RecordedProtocol{"westnet", westnet_reader},
    RecordedProtocol{"pc500-loader", pc500_loader_reader, pc500_loader_plain_dle_reader},
    RecordedProtocol{"hppc", hppc_reader},
};

/// The first characters of a frame, which is left with the others.
RecordedFrame take_first(RecordedFrame& frame, std::size_t count, const Stamps& stamps) {
  const auto at = static_cast<std::ptrdiff_t>(count);
  RecordedFrame first = frame;
  first.more_was_lost = frame.more_was_lost && count == frame.bytes.size();
  first.bytes.resize(count);
  std::erase_if(first.damaged, [&](std::size_t place) { return place >= count; });
  frame.bytes.erase(frame.bytes.begin(), frame.bytes.begin() + at);
  std::erase_if(frame.damaged, [&](std::size_t place) { return place < count; });
  for (std::size_t& place : frame.damaged) place -= count;
  if (!frame.times.empty()) {
    first.times.resize(count);
    frame.times.erase(frame.times.begin(), frame.times.begin() + at);
    frame.at = frame.times.empty() ? std::nullopt : std::optional(frame.times.front());
  } else if (frame.at && stamps.at_end) {
    *first.at -= static_cast<Time>(frame.bytes.size()) * stamps.character;
  } else if (frame.at) {
    *frame.at += static_cast<Time>(count) * stamps.character;
  }
  return first;
}

}  // namespace

std::span<const RecordedProtocol> recorded_protocols() { return kProtocols; }

const RecordedProtocol* find_recorded_protocol(std::string_view name) {
  const auto found = std::ranges::find(kProtocols, name, &RecordedProtocol::name);
  return found == kProtocols.end() ? nullptr : &*found;
}

Conversation::Stream& Conversation::stream_of(const RecordedFrame& frame) {
  Stream& stream = streams_[frame.stream];
  if (!stream.reader) stream.reader = protocol_.reader();
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
  while (!frame.bytes.empty()) {
    const OpenRequest* open = stream.request_of(frame);
    const std::size_t length = stream.reader->first_message(frame.bytes, open != nullptr ? &open->frame : nullptr);
    if (length == 0) break;
    all.push_back(read(stream, take_first(frame, length, stamps_)));
  }
  return all;
}

bool Conversation::is_several(Stream& stream, RecordedFrame frame) const {
  const OpenRequest* const waiting = stream.request_of(frame);
  const bool said_so = stamps_.exact || !frame.damaged.empty();
  std::optional<RecordedFrame> open = waiting != nullptr ? std::optional(waiting->frame) : std::nullopt;
  if (said_so || stream.reader->read(frame, open ? &*open : nullptr).right) return false;
  while (!frame.bytes.empty()) {
    const std::size_t length = stream.reader->first_message(frame.bytes, open ? &*open : nullptr);
    if (length == 0) return false;
    const RecordedFrame message = take_first(frame, length, stamps_);
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

std::vector<ReadFrame> conversation(const LineRecording& recording, const RecordedProtocol& protocol, const Stamps& stamps) {
  Conversation reading(protocol, stamps);
  std::vector<ReadFrame> all;
  for (const RecordedFrame& frame : recording.frames)
    for (ReadFrame& read : reading.add(frame)) {
      if (read.other) all[*read.other].other = all.size();
      all.push_back(std::move(read));
    }
  return all;
}

const RecordedProtocol* likelier_protocol(const LineRecording& recording, const RecordedProtocol& chosen,
                                          const Stamps& stamps) {
  const auto percent_right = [&](const RecordedProtocol& protocol) {
    const auto frames = conversation(recording, protocol, stamps);
    const auto right = static_cast<std::size_t>(std::ranges::count_if(frames, &ReadFrame::right));
    return frames.empty() ? 0 : 100 * right / frames.size();
  };
  constexpr std::size_t kHardlyAny = 10, kMost = 80;
  if (percent_right(chosen) > kHardlyAny) return nullptr;
  const auto found = std::ranges::find_if(
      kProtocols, [&](const RecordedProtocol& each) { return each.name != chosen.name && percent_right(each) >= kMost; });
  return found == kProtocols.end() ? nullptr : &*found;
}

}  // namespace s7200::tools
