#include "tools/master/session.hpp"

#include <algorithm>
#include <utility>

namespace s7200::tools {

using serial::Verdict;

MasterSession::MasterSession(Slave& slave, const std::vector<MasterAction>& actions, const SessionSettings& settings)
    : slave_(slave), actions_(actions), settings_(settings) {}

serial::Request MasterSession::request_of(const MasterAction& action) const {
  serial::Request request = settings_.master.request(action.request->frame());
  if (const auto turnaround = action.request->turnaround()) request.timeout = std::min(request.timeout, *turnaround);
  request.silence = settings_.silence;
  request.sync = action.request->with_sync();
  return request;
}

serial::Exchange MasterSession::exchange(const MasterAction& action) {
  serial::Request request = request_of(action);
  serial::Exchange all = slave_.exchange(request);
  for (auto next = action.request->next(all.response_bytes(), slave_.now() - all.request_end);
       next && !slave_.stop_requested();) {
    request.frame = std::move(*next);
    if (!action.request->answered()) request.timeout = 0;
    const serial::Exchange step = slave_.exchange(request);
    all.request.insert(all.request.end(), step.request.begin(), step.request.end());
    all.response.insert(all.response.end(), step.response.begin(), step.response.end());
    all.too_long = all.too_long || step.too_long;
    all.early = all.early || step.early;
    all.of_another_master = all.of_another_master || step.of_another_master;
    if (!step.response.empty()) {
      all.response_start = step.response_start;
      all.response_end = step.response_end;
    }
    next = action.request->next(step.response_bytes(), slave_.now() - all.request_end);
  }
  return all;
}

bool MasterSession::settled(const serial::Answer& answer) const {
  if (answer.lasting) return true;
  if (answer.verdict != Verdict::Exception) return answer.verdict == Verdict::Right;
  return settings_.patience.repeats == nullptr || !settings_.patience.repeats(answer.exception);
}

void MasterSession::prepare_to_repeat(const MasterAction& action) {
  if (settings_.patience.pause > 0) slave_.wait(settings_.patience.pause);
  if (settings_.patience.first == nullptr) return;
  serial::Request request = request_of(action);
  request.frame = settings_.patience.first(settings_.use);
  slave_.exchange(request);
  slave_.wait(settings_.pause == kNever ? slave_.pause() : settings_.pause);
}

std::optional<MasterResult> MasterSession::perform(const MasterAction& action) {
  MasterResult result{.action = &action};
  for (;; ++result.attempts) {
    const bool last = result.attempts > settings_.retries;
    try {
      result.exchange = exchange(action);
      if (slave_.stop_requested()) return {};
      result.remark = slave_.remark();
      result.answer = assess(action, result.exchange, settings_.broadcasts_are_silent);
      slave_.wait(settings_.pause == kNever ? slave_.pause() : settings_.pause);
      if (last || settled(result.answer)) break;
      prepare_to_repeat(action);
    } catch (const SlaveUnreachable&) {
      if (last || slave_.stop_requested()) throw;
      slave_.wait(settings_.master.timeout);
    }
    statistics_.add_retry();
  }
  statistics_.add(result.answer.verdict, result.exchange.latency());
  return result;
}

void MasterSession::run_round(const Listener& listener, const std::function<bool()>& over) {
  for (const MasterAction& action : actions_) {
    if (slave_.stop_requested() || over()) return;
    if (action.kind == MasterAction::Kind::Station) continue;
    if (action.kind == MasterAction::Kind::Wait) {
      slave_.wait(action.duration);
      continue;
    }
    if (const auto result = perform(action)) listener.result(*result);
  }
}

void MasterSession::run(const Listener& listener, const std::function<bool()>& over) {
  Time next = slave_.now();
  for (std::uint64_t round = 0; round < settings_.rounds && !slave_.stop_requested() && !over(); ++round) {
    run_round(listener, over);
    listener.end_of_round();
    if (settings_.every == kNever) continue;
    // A round that took longer than its time is followed by the next at once; those missed are not made up for.
    next = std::max(next + settings_.every, slave_.now());
    if (round + 1 < settings_.rounds) slave_.wait(next - slave_.now());
  }
}

}  // namespace s7200::tools
