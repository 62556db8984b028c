#include "tools/command/reading/line_listener.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/host/interruption.hpp"
#include "tools/slave/host_slave.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kLongestFrame = 4096;

std::unique_ptr<HostLink> link_to(const SlaveTarget& target, const SerialFormat& format) {
  if (target.kind == SlaveTarget::Kind::Tcp) return std::make_unique<TcpLink>(target.host, target.port, interruption());
  return std::make_unique<SerialLink>(target.path, format, interruption());
}

}  // namespace

LineListener::LineListener(const SlaveTarget& target, const SerialFormat& format, Time gap)
    : link_(link_to(target, format)),
      character_(link_->character_time()),
      gap_(gap != 0 ? gap : std::max(RtuSlave::kSilence, format.silence())) {
  link_->open();
}

void LineListener::take(RecordedFrame& frame) {
  std::vector<HostLink::Character> characters;
  link_->read(characters);
  if (characters.empty()) return;
  last_ = host_time();
  const auto count = static_cast<Time>(characters.size());
  if (!first_) first_ = last_ - count * character_;
  for (Time i = 0; i < count; ++i) {
    const HostLink::Character& character = characters[static_cast<std::size_t>(i)];
    const Time start = last_ - *first_ - (count - i) * character_;
    if (character.error) frame.damaged.push_back(frame.bytes.size());
    frame.bytes.push_back(character.byte);
    frame.times.push_back(frame.times.empty() ? std::max<Time>(start, 0) : std::max(start, frame.times.back()));
  }
  frame.at = frame.times.front();
  frame.place = fmt::format("after {:.3f} ms", static_cast<double>(*frame.at) / kMillisecond);
}

void LineListener::listen(Time duration, Conversation& conversation, const std::function<void(ReadFrame)>& tell) {
  const Time now = host_time(), end = duration < kNever - now ? now + duration : kNever;
  RecordedFrame frame;
  const auto tell_all = [&](std::vector<ReadFrame> frames) {
    for (ReadFrame& read : frames) tell(std::move(read));
  };
  const auto complete = [&] {
    if (!frame.bytes.empty()) tell_all(conversation.add(std::exchange(frame, {})));
  };
  while (!interrupted() && host_time() < end) {
    if (link_->wait_for_input(frame.bytes.empty() ? end : std::min(end, last_ + gap_))) {
      take(frame);
      tell_all(conversation.take_complete(frame));
      if (frame.bytes.size() >= kLongestFrame) complete();
    } else if (host_time() >= last_ + gap_) {
      complete();
    }
  }
  complete();
}

}  // namespace s7200::tools
