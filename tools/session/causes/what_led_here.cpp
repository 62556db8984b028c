// What has led to where the program stands?
#include <fmt/format.h>

#include "tools/session/causes/inquiry.hpp"
#include "tools/session/causes/last_power_loss.hpp"
#include "tools/session/causes/writer.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools {
namespace {

/// What its program did before is of no interest then.
void find_power_loss(Inquiry& inquiry) {
  const History& history = inquiry.history();
  const PowerLossSearch search = find_last_power_loss(inquiry.history(), inquiry.station(), inquiry.stop_request());
  inquiry.answers.interrupted |= search.interrupted;
  const std::string name = history.name_of(inquiry.station());
  if (!search.loss) {
    inquiry.add(inquiry.start().time, fmt::format("{} has been without power {}", name, since_oldest_text(history)), {});
    return;
  }
  const auto& [at, action, planned] = *search.loss;
  inquiry.add(
      at,
      fmt::format("{} has been without power since {}: {}", name, moment_text(at), changer_text(history, action, planned)),
      {});
}

}  // namespace

void find_what_led_here(Inquiry& inquiry) {
  const serial::Simulation& here = inquiry.here_at_start();
  if (!here.plc().powered()) return find_power_loss(inquiry);
  if (inquiry.stopped() && here.cpu().state().stopped_by_master)
    inquiry.add(*inquiry.stopped(), "a programming device has switched the CPU to STOP", {});
  else if (const auto cause = inquiry.witness().reasons.cause())
    inquiry.answers.decision = inquiry.decision_of(*cause);
}

}  // namespace s7200::tools
