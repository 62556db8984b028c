#include "serial_sim/modbus/line_turns.hpp"

#include <algorithm>
#include <utility>

#include "serial_sim/modbus/request.hpp"

namespace s7200::modbus {

void LineTurns::ask(Client client, Request request) { waiting_[client].push_back(std::move(request)); }

std::vector<std::uint64_t> LineTurns::forget(Client client) {
  std::vector<std::uint64_t> tags;
  if (const auto waiting = waiting_.extract(client))
    for (const Request& request : waiting.mapped()) tags.push_back(request.tag);
  if (open(client) != 0) {
    tags.push_back(current_.request.tag);
    current_forgotten_ = true;
  }
  return tags;
}

std::size_t LineTurns::open(Client client) const {
  const auto found = waiting_.find(client);
  return (found == waiting_.end() ? 0 : found->second.size()) + (on_line(client) && !current_forgotten_ ? 1 : 0);
}

std::size_t LineTurns::waiting(Client client) const {
  std::size_t bytes = 0;
  if (const auto found = waiting_.find(client); found != waiting_.end())
    for (const Request& request : found->second) bytes += request.frame.size();
  return bytes;
}

std::size_t LineTurns::stop_waiting(Client client) {
  std::size_t given_up = 0;
  if (const auto found = waiting_.find(client); found != waiting_.end()) {
    given_up = std::erase_if(found->second, [](const Request& request) { return request.wants_answer; });
    if (found->second.empty()) waiting_.erase(found);
  }
  if (!on_line(client) || !current_.request.wants_answer) return given_up;
  return given_up + (std::exchange(current_forgotten_, true) ? 0 : 1);
}

void LineTurns::received(const ReceivedCharacter& character, const SerialFormat& format) {
  if (phase_ == Phase::Idle || !current_.request.wants_answer) return;
  phase_ = Phase::Receiving;
  damaged_ = damaged_ || character.parity_error || character.framing_error;
  too_long_ = answer_.size() == kLongestRtuFrame;
  if (!too_long_) answer_.push_back(character.byte);
  answer_end_ = character.start + format.character_time();
}

Bytes LineTurns::turn(const Line& line) {
  due_ = kNever;
  look(line);
  return phase_ == Phase::Idle ? next_frame(line) : Bytes{};
}

/// Looks at what has become of the request on the line.
void LineTurns::look(const Line& line) {
  if (phase_ == Phase::Sending && !line.sending) {
    phase_ = Phase::Waiting;
    asked_ = line.quiet_since;
  }
  if (too_long_) end(Result::Damaged);
  if (line.receiving) return;
  if (phase_ == Phase::Waiting) {
    const Time patience = current_forgotten_ ? std::min(timeout_, kLateAnswer) : timeout_;
    const Time over = asked_ + (current_.request.wants_answer ? patience : std::min(timeout_, kTurnaround));
    if (line.now >= over) {
      unanswered_until_ = line.now;
      return end(current_.request.wants_answer ? Result::Silent : Result::Sent);
    }
    due_ = over;
  } else if (phase_ == Phase::Receiving) {
    const Time over = answer_end_ + line.format.silence();
    if (line.now >= over) return end(damaged_ ? Result::Damaged : Result::Answered);
    due_ = over;
  }
}

Bytes LineTurns::next_frame(const Line& line) {
  if (waiting_.empty()) {
    wants_line_since_.reset();
    return {};
  }
  if (!wants_line_since_) wants_line_since_ = line.now;
  const Time quiet = std::max(line.quiet_since, unanswered_until_) + line.quiet_time;
  const Time too_late = *wants_line_since_ + std::max(timeout_, line.quiet_time + 1);
  const bool may_send = !line.sending && !line.receiving && line.now >= quiet;
  if (!may_send && line.now < too_late) {
    due_ = std::min(std::max(quiet, line.now + 1), too_late);
    return {};
  }
  auto turn = waiting_.upper_bound(last_served_);
  if (turn == waiting_.end()) turn = waiting_.begin();
  last_served_ = turn->first;
  current_ = {turn->first, std::move(turn->second.front())};
  turn->second.pop_front();
  if (turn->second.empty()) waiting_.erase(turn);
  wants_line_since_.reset();
  current_forgotten_ = damaged_ = too_long_ = false;
  answer_.clear();
  phase_ = Phase::Sending;
  if (may_send) return current_.request.frame;
  end(Result::Blocked);
  due_ = line.now + 1;
  return {};
}

void LineTurns::end(Result result) {
  phase_ = Phase::Idle;
  too_long_ = false;
  if (!current_forgotten_) outcomes_.push_back({current_.client, current_.request.tag, result, std::exchange(answer_, {})});
}

std::vector<LineTurns::Outcome> LineTurns::take_outcomes() { return std::exchange(outcomes_, {}); }

}  // namespace s7200::modbus
