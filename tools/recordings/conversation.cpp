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

Time begin_of(const RecordedFrame& frame, const Stamps& stamps) {
  const auto characters = static_cast<Time>(frame.times.empty() ? frame.bytes.size() : 1);
  return *frame.at - (stamps.at_end ? characters * stamps.character : 0);
}

Time end_of(const RecordedFrame& frame, const Stamps& stamps) {
  if (!frame.times.empty()) return frame.times.back() + (stamps.at_end ? 0 : stamps.character);
  return *frame.at + (stamps.at_end ? 0 : static_cast<Time>(frame.bytes.size()) * stamps.character);
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

ReadFrame Conversation::what_it_says(Stream& stream, const RecordedFrame& frame) const {
  ReadFrame read = stream.reader->read(frame, stream.open ? &*stream.open : nullptr);
  const bool echoes = read.direction == Direction::Answer && frame.direction == Direction::Unknown && stream.open &&
                      frame.bytes == stream.open->bytes;
  const auto waited = echoes ? silence(*stream.open, frame, stamps_) : std::nullopt;
  if (!waited || *waited <= stamps_.timeout) return read;
  read = stream.reader->read(frame, nullptr);
  read.repeats = stream.number;
  read.text += fmt::format("; repeated after {}, or its late echo", format_duration(*waited));
  return read;
}

ReadFrame Conversation::read(Stream& stream, RecordedFrame frame) {
  ReadFrame read = what_it_says(stream, frame);
  if (!frame.damaged.empty()) {
    read.right = false;
    const bool all = frame.damaged.size() == frame.bytes.size();
    read.text = fmt::format("{} damaged{}{}", all ? "it is" : fmt::format("character {} is", frame.damaged.front() + 1),
                            read.text.empty() ? "" : "; ", read.text);
  }
  if (last_) read.silence = silence(*last_, frame, stamps_);
  if (read.direction == Direction::Answer && stream.open) {
    read.other = stream.number;
    read.latency = silence(*stream.open, frame, stamps_);
    stream.open.reset();
  } else if (read.direction == Direction::Request) {
    stream.open.reset();
    if (!read.needs_no_answer) stream.open = frame;
    stream.number = count_;
  }
  ++count_;
  last_ = frame;
  read.frame = std::move(frame);
  return read;
}

std::vector<ReadFrame> Conversation::take_complete(RecordedFrame& frame) {
  Stream& stream = stream_of(frame);
  std::vector<ReadFrame> all;
  while (!frame.bytes.empty()) {
    const std::size_t length = stream.reader->first_message(frame.bytes, stream.open ? &*stream.open : nullptr);
    if (length == 0) break;
    all.push_back(read(stream, take_first(frame, length, stamps_)));
  }
  return all;
}

std::vector<ReadFrame> Conversation::add(RecordedFrame frame) {
  std::vector<ReadFrame> all;
  Stream& stream = stream_of(frame);
  const bool has_characters = frame.direction == Direction::Unknown && !frame.times.empty();
  if (has_characters || stream.reader->messages_share_frames()) all = take_complete(frame);
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

std::optional<Time> silence(const RecordedFrame& before, const RecordedFrame& after, const Stamps& stamps) {
  if (!before.at || !after.at) return {};
  return std::max<Time>(0, begin_of(after, stamps) - end_of(before, stamps));
}

}  // namespace s7200::tools
