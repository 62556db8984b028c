#include "tools/session/stops/heard_frames.hpp"

#include <algorithm>
#include <utility>

namespace s7200::tools {

HeardFrames::HeardFrames(const History& history) : on_frame([](const Frame&) {}), history_(history) {
  for (std::size_t station = 0; station < history.stations(); ++station) {
    first_ear_.push_back(ears_.size());
    const serial::Plc& plc = history.station(station).plc();
    for (std::uint8_t port = 0; port < plc.cpu().program().model->ports; ++port)
      ears_.push_back({.station = station, .port = port, .plc = &plc, .line = &plc.line(port)});
  }
}

void HeardFrames::begin() {
  for (std::size_t station = 0; station < history_.stations(); ++station) {
    const serial::Plc::State state = history_.station(station).plc().state();
    for (Ear& ear : ears_)
      if (ear.station == station) begin(ear, state);
  }
}

void HeardFrames::begin(Ear& ear, const serial::Plc::State& state) const {
  const SerialFormat format = ear.plc->port_format(ear.port);
  const Time last = ear.line->last_activity();
  const bool is_over = history_.station(ear.station).time() - last >= format.silence();
  // another station hears the end of its last character a little later than it has sent it, never so much later
  const Time own_end = state.uart.at(ear.port).send_end + format.character_time() / 2;
  ear.silence_noted = is_over ? last : 0;
  ear.came_in = last > own_end;
  ear.coming_in = is_over || !ear.came_in ? std::vector<std::uint8_t>() : heard_last(ear);
  ear.last_heard = ear.came_in ? std::optional(last) : std::nullopt;
}

const std::vector<std::uint8_t>& HeardFrames::heard_last(const Ear& ear) const {
  return history_.requests().heard(ear.station, ear.port).bytes;
}

void HeardFrames::note(std::size_t station, const TraceRecord& record) {
  const bool heard = is_heard(record), sent = record.kind == TraceKind::CharacterSent;
  const bool over = record.kind == TraceKind::TransmitEnd;
  if (!heard && !sent && !over) return;
  Ear& ear = ears_[first_ear_[station] + record.port];
  if (heard) ear.coming_in.push_back(record.byte);
  if (heard) ear.last_heard = record.at;
  if (heard || sent) ear.came_in = heard;
  if (over) ear.last_heard.reset();
}

void HeardFrames::look(std::size_t station, Time now) {
  for (Ear& ear : ears_)
    if (ear.station == station || !ear.plc->executes()) note_silence(ear, now);
}

void HeardFrames::note_silence(Ear& ear, Time now) const {
  const Time last = ear.line->last_activity();
  if (last == ear.silence_noted || now - last < silence(ear)) return;
  ear.silence_noted = last;
  std::vector<std::uint8_t> bytes = std::exchange(ear.coming_in, {});
  if (ear.came_in) on_frame({ear.station, ear.port, std::move(bytes), last});
}

Time HeardFrames::next_end() const {
  Time next = kNever;
  for (const Ear& ear : ears_)
    if (const Time last = ear.line->last_activity(); last != ear.silence_noted) next = std::min(next, last + silence(ear));
  return next;
}

std::vector<HeardFrames::Frame> HeardFrames::frames_before() const {
  std::vector<Frame> frames;
  for (const Ear& ear : ears_)
    if (ear.came_in && ear.silence_noted != 0) frames.push_back({ear.station, ear.port, heard_last(ear), ear.silence_noted});
  return frames;
}

}  // namespace s7200::tools
