#include "serial_sim/line/frame_splitter.hpp"

#include <algorithm>

namespace s7200::serial {

void FrameSplitter::edge(Wire wire, Time at, bool mark, int driver) {
  if (wire == Wire::Line) line_.drive(0, at, mark);
  if (driver == Line::kNobody) return;
  std::vector<Speaker>& list = wire == Wire::Line ? speakers_ : driving_;
  if (list.empty() || list.back().driver != driver || wire != Wire::Line) list.push_back({at, driver});
}

/// The sender of a character is the station that spoke last when the character began; a disturbance has no sender.
int FrameSplitter::sender_of(const ReceivedCharacter& character) {
  const auto later = std::ranges::upper_bound(speakers_, character.start, {}, &Speaker::since);
  if (later == speakers_.begin()) return Line::kNobody;
  speakers_.erase(speakers_.begin(), later - 1);
  return speakers_.front().driver;
}

/// Whether another station drives the line during the character. Its edges cannot be seen while the line is at space
/// already.
bool FrameSplitter::another_drives(int sender, const ReceivedCharacter& character) {
  std::erase_if(driving_, [&](const Speaker& each) { return each.since < character.start; });
  return std::ranges::any_of(driving_,
                             [&](const Speaker& each) { return each.driver != sender && each.since < character.end; });
}

void FrameSplitter::settled(Time until, const SerialFormat& port) {
  if (port != uart_.state().format) uart_.configure(port, until);
  while (queue_.next() < until)
    if (const auto received = uart_.handle(queue_.pop()).received) take(*received, port);
  // Speakers that ended before any character still to come are forgotten: on a cut line none may ever come.
  std::erase_if(driving_, [&](const Speaker& each) { return each.since < until - port.character_time(); });
  // A character that began within the silence would be complete by then.
  if (until > open_.end + port.silence() + port.character_time()) close();
}

void FrameSplitter::take(const ReceivedCharacter& character, const SerialFormat& port) {
  const int sender = sender_of(character);
  const bool is_full = open_.characters.size() == kLongestFrame;
  const bool is_of_another = sender != sender_ && !mixed_ && character.start >= open_.end;
  if (is_full || is_of_another || character.start > open_.end + port.silence()) close();
  if (open_.characters.empty()) open_.driver = sender;
  sender_ = sender;
  mixed_ |= another_drives(sender, character);
  open_.characters.push_back(character);
  open_.end = character.start + port.character_time();
}

void FrameSplitter::close() {
  if (open_.characters.empty()) return;
  on_frame_(open_);
  open_.characters.clear();
  mixed_ = false;
}

}  // namespace s7200::serial
