#include "tools/command/running/unanswered.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/host/interruption.hpp"
#include "tools/session/causes/line/unanswered_causes.hpp"
#include "tools/views/broadcast.hpp"
#include "tools/views/report.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

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
          all.causes.push_back({.first = request.frame, .at = request.at, .why = std::move(*why)});
        ++all.causes[number].requests;
      }
  }
  rig_.system().restore(end);
  return interrupted() ? UnansweredRequests{} : all;
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
