#include "tools/command/running/unanswered.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <utility>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/ports.hpp"
#include "tools/host/interruption.hpp"
#include "tools/session/causes/line/unanswered_causes.hpp"
#include "tools/views/broadcast.hpp"
#include "tools/views/report.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

constexpr Time kHostPatience = kSecond;  // of a master on a bridge, whose own time-out nobody knows

constexpr std::string_view kNotKnown = "the cause is not known: nothing that the program did in between tells it";

std::string frame_text(const Bytes& frame) {
  constexpr std::size_t kShown = 16;
  if (frame.size() <= kShown) return serial::to_hex(frame);
  return fmt::format("{} …", serial::to_hex(Bytes(frame.begin(), frame.begin() + kShown)));
}

std::string heading(const SameCause& cause) {
  const std::string first = fmt::format("{}, sent at {}", frame_text(cause.first), moment_text(cause.at));
  return cause.requests == 1 ? fmt::format("why {}, got no answer:\n", first)
                             : fmt::format("why {} requests got no answer, the first {}:\n", cause.requests, first);
}

std::string text_of(const SameCause& cause) {
  std::string text = heading(cause);
  for (const std::string& line : cause.why) text += fmt::format("  {}\n", stl::printable(line));
  return cause.why.empty() ? text + fmt::format("  {}\n", kNotKnown) : text;
}

}  // namespace

Unanswered::Unanswered(RecordedRig& rig, const Spot& spot)
    : rig_(rig), seen_(rig, {spot}), station_(spot.plc), begin_(rig.system().snapshot()), journal_(rig.simulation()) {}

void Unanswered::listen_to(SimulatedSlave& slave) {
  slave.when_asked([this](const SerialFormat& format, const serial::Request& request) {
    journal_.note(SendFrame{.format = format, .request = request}, station_);
  });
}

void Unanswered::note(const serial::Exchange& exchange) {
  const Bytes frame = serial::bytes_of(exchange.request);
  if (!exchange.timed_out || interrupted() || is_broadcast(frame)) return;
  if (journal_.is_over() || unanswered_.size() == kMostExplained) return void(++not_explained_);
  recording_ = journal_.recording();
  unanswered_.push_back({frame, exchange.request_start, recording_->end});
}

UnansweredRequests Unanswered::explained(Time timeout) {
  UnansweredRequests all{.causes = {}, .not_explained = not_explained_};
  if (unanswered_.empty() || interrupted()) return all;
  rig_.flush_records();
  for (std::size_t plc = 0; plc < rig_.plan().plcs.size(); ++plc) rig_.plc(plc).unwatch_lines();
  const serial::System::Snapshot end = rig_.system().snapshot();
  rig_.system().restore(begin_);
  {
    History::Settings settings = history_settings(rig_);
    settings.bound = 1 << 20;  // bytes of checkpoints: a run of hours needs no more memory than a short one
    settings.stop_request = interruption();
    History history(seen_.stations(), std::move(settings));
    DifferentCauses causes;
    if (history.replay(std::move(*recording_)))
      for (const Request& request : unanswered_) {
        history.go_to(request.given_up);
        auto why = causes_of_no_answer(history, station_, request.frame, timeout, interruption());
        if (!why) break;
        const std::size_t number = causes.number_of(*why);
        if (number == all.causes.size())
          all.causes.push_back({.first = request.frame, .at = request.at, .why = texts_of(*why)});
        ++all.causes[number].requests;
      }
  }
  rig_.system().restore(end);
  return interrupted() ? UnansweredRequests{} : all;
}

UnansweredOnBridge::UnansweredOnBridge(RecordedRig& rig, const Spot& spot, const RunRecorder& recorder)
    : rig_(rig), spot_(spot), recorder_(recorder), begin_(rig.system().snapshot()) {}

void UnansweredOnBridge::look() {
  const Time sent_until = rig_.simulation().host_port().sent_until();
  if (sent_until != sent_until_) quiet_.reset();
  sent_until_ = sent_until;
  if (!quiet_ && rig_.time() >= sent_until_ + kHostPatience) quiet_ = recorder_.journal().now();
}

Recording UnansweredOnBridge::recording() const {
  Recording recording = recorder_.journal().recording();
  if (recorder_.journal().is_over() || !quiet_) return recording;
  recording.actions.resize(quiet_->actions);
  recording.stations.resize(quiet_->actions);
  recording.moments.resize(quiet_->actions);
  recording.end = recording.now = *quiet_;
  return recording;
}

bool UnansweredOnBridge::only_listens() const {
  const auto has = [&](Effect effect) {
    return std::ranges::any_of(rig_.plc(spot_.plc).cpu().program().ops,
                               [&](const Op& op) { return op.instruction->effect == effect && op[1].at == spot_.port; });
  };
  const auto is_attached = [&](const Op& op) {
    return op.instruction->structure == Structure::Attach && op[1].at == kPorts[spot_.port].received;
  };
  const bool listens = has(Effect::Receives) || std::ranges::any_of(rig_.plc(spot_.plc).cpu().program().ops, is_attached);
  return listens && !has(Effect::Transmits);
}

UnansweredRequests UnansweredOnBridge::explained() const {
  UnansweredRequests all;
  if (sent_until_ == 0 || only_listens()) return all;
  constexpr std::chrono::seconds kLongest{5};  // whoever has ended the run waits
  rig_.flush_records();
  for (std::size_t plc = 0; plc < rig_.plan().plcs.size(); ++plc) rig_.plc(plc).unwatch_lines();
  const serial::System::Snapshot end = rig_.system().snapshot();
  rig_.system().restore(begin_);
  {
    std::atomic<bool> late = false;
    const auto latest = std::chrono::steady_clock::now() + kLongest;
    rig_.system().stop_when(StopToken(late));  // Ctrl-C has ended the run, not this
    History::Settings settings = history_settings(rig_);
    settings.hosts = hosts_of(rig_);
    settings.stop_request = StopToken(late);
    settings.progress = [&] { late = late || std::chrono::steady_clock::now() > latest; };
    History history(recorder_.seen().stations(), std::move(settings));
    if (history.replay(recording())) explain(history, StopToken(late), all);
    rig_.system().stop_when(interruption());
  }
  rig_.system().restore(end);
  return all;
}

void UnansweredOnBridge::explain(History& history, StopToken stop, UnansweredRequests& all) const {
  constexpr Time kTooSoon = 200 * kMillisecond;  // before the end of the run: an answer might have come yet
  const std::vector<SentByHost> frames = history.sent_by_host(0, 0);
  const Time end = history.newest().time;
  DifferentCauses causes;
  std::size_t unanswered = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const SentByHost& frame = frames[i];
    const bool last = i + 1 == frames.size();
    const Time given_up = std::min(last ? end : frames[i + 1].from - 1, frame.to + kHostPatience);
    if (given_up <= frame.to + (last ? kTooSoon : 0) || is_broadcast(frame.bytes)) continue;
    if (!history.go_to(given_up)) return;
    const serial::Plc& plc = history.station(spot_.plc).plc();
    const bool ppi = !plc.cpu().state().port[spot_.port].active && !is_rtu_frame(frame.bytes);
    if (ppi || plc.state().uart.at(spot_.port).send_end > frame.to) continue;
    if (unanswered++ >= Unanswered::kMostExplained) {
      ++all.not_explained;
      continue;
    }
    auto why = causes_of_no_answer(history, spot_.plc, frame.bytes, kHostPatience, stop);
    if (!why) return;
    if (why->empty()) continue;
    const std::size_t number = causes.number_of(*why);
    if (number == all.causes.size()) all.causes.push_back({.first = frame.bytes, .at = frame.from, .why = texts_of(*why)});
    ++all.causes[number].requests;
  }
}

std::string note_on_unknown_causes(const std::string& slave, bool is_simulated) {
  if (is_simulated)
    return fmt::format("why an answer is missing cannot be told: {} has no S7-200, and only their programs are looked into",
                       stl::printable(slave));
  return fmt::format(
      "why an answer is missing cannot be told: {} is outside this simulation; if it is a program behind a bridge, serve it "
      "with 's7200 debug' instead of 's7200 run', and 'why' at its prompt says it",
      stl::printable(slave));
}

nlohmann::ordered_json with_why(nlohmann::ordered_json json, const UnansweredRequests& unanswered) {
  const auto known = std::ranges::find_if(unanswered.causes, [](const SameCause& one) { return !one.why.empty(); });
  if (known != unanswered.causes.end()) json["why"] = known->why;
  for (const SameCause& cause : unanswered.causes)
    json["unanswered"].push_back({{"requests", cause.requests},
                                  {"first", plain_hex(cause.first)},
                                  {"at_us", static_cast<double>(cause.at) / kMicrosecond},
                                  {"why", cause.why}});
  if (!unanswered.causes.empty()) json["not_explained"] = unanswered.not_explained;
  return json;
}

std::string why_text(const UnansweredRequests& unanswered) {
  std::string text;
  for (const SameCause& cause : unanswered.causes) text += text_of(cause);
  if (unanswered.not_explained > 0)
    text += fmt::format("{} more got no answer, for which no cause was looked for\n",
                        counted(unanswered.not_explained, "request"));
  return text;
}

}  // namespace s7200::tools
