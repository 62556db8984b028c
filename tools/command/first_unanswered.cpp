#include "tools/command/first_unanswered.hpp"

#include <fmt/format.h>

#include <utility>

#include "interpreter/base/text.hpp"
#include "tools/host/interruption.hpp"
#include "tools/session/causes/last_decision.hpp"

namespace s7200::tools {
namespace {

std::vector<std::string> reasons_in(serial::Simulation& simulation, Recording recording, Time timeout) {
  constexpr std::size_t kCheckpoints = 1 << 20;  // bytes: a run of hours needs no more memory than a short one
  History history(simulation, {.bound = kCheckpoints, .stop_request = &interruption()});
  if (!history.replay(std::move(recording))) return {};
  const DecisionSearch search = find_last_decision(history, 0, timeout, &interruption());
  if (search.interrupted || search.unanswered.empty()) return {};
  return to_lines(search, Listing(simulation.cpu().program()));
}

}  // namespace

FirstUnanswered::FirstUnanswered(Rig& rig, bool is_one_program) : rig_(rig), begin_(rig.system().snapshot()) {
  if (is_one_program) journal_.emplace(rig.simulation());
}

void FirstUnanswered::listen_to(SimulatedSlave& slave) {
  slave.when_asked([this](const SerialFormat& format, const serial::Request& request) {
    if (!journal_ || unanswered_) return;
    if (++requests_ > kMostRequests) return journal_.reset();
    journal_->note(SendFrame{.format = format, .request = request});
  });
}

void FirstUnanswered::note(const serial::Exchange& exchange) {
  if (journal_ && !unanswered_ && exchange.timed_out && !interrupted()) unanswered_ = journal_->recording();
}

std::vector<std::string> FirstUnanswered::reasons(Time timeout) {
  if (!unanswered_ || interrupted()) return {};
  serial::Simulation& simulation = rig_.simulation();
  rig_.flush_records();
  simulation.plc().unwatch_lines();
  const serial::System::Snapshot end = rig_.system().snapshot();
  rig_.system().restore(begin_);
  std::vector<std::string> reasons = reasons_in(simulation, std::exchange(unanswered_, {}).value(), timeout);
  rig_.system().restore(end);
  return reasons;
}

nlohmann::ordered_json with_why(nlohmann::ordered_json json, const std::vector<std::string>& reasons) {
  if (!reasons.empty()) json["why"] = reasons;
  return json;
}

std::string why_text(const std::vector<std::string>& reasons) {
  if (reasons.empty()) return {};
  std::string text = "why the first request without an answer got none:\n";
  for (const std::string& reason : reasons) text += fmt::format("  {}\n", stl::printable(reason));
  return text;
}

}  // namespace s7200::tools
