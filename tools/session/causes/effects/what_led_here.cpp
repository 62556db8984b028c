// What has led to where the program stands?
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/model/errors.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "tools/session/causes/inquiry.hpp"
#include "tools/session/causes/last/last_attachment.hpp"
#include "tools/session/causes/last/last_power_loss.hpp"
#include "tools/session/causes/writer.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/views/state/machine_text.hpp"

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

/// `the scan took 300 ms and more: NEXT in line 9 was executed 8120 times in it`
std::string watchdog_text(const Inquiry& inquiry, const State& state) {
  std::string text =
      fmt::format("the scan that began at {} took longer than the watchdog allows", moment_text(state.scan_begin));
  const Witness::Most loop = inquiry.witness().most_repeated(), routine = inquiry.witness().most_served();
  if (loop.times > std::max<std::size_t>(1, routine.times))
    return text +
           fmt::format(": {} was executed {} times in it", named_without_comment(loop.what, inquiry.program()), loop.times);
  return routine.times > 1 ? text + fmt::format(": INT {} was called {} times in it", routine.what, routine.times) : text;
}

/// Why a CPU is in STOP; empty if that is not known.
std::string stop_text(const Inquiry& inquiry, const State& state) {
  if (state.fatal_code != 0) {
    const FatalError code{state.fatal_code};
    const std::string where =
        state.fatal_op == kNoRoutine ? "" : fmt::format(", in {}", named_without_comment(state.fatal_op, inquiry.program()));
    return fmt::format("the CPU went to STOP with fatal error {:04X}, {}{}{}", state.fatal_code, meaning_of(code), where,
                       code == FatalError::Watchdog ? "; " + watchdog_text(inquiry, state) : "");
  }
  if (state.stopped_by_master) return "a programming device has switched the CPU to STOP";
  const auto& stop = inquiry.witness().stop_executed();
  if (!stop) return {};
  return fmt::format("the CPU went to STOP by {}{}{}", named_without_comment(stop->op, inquiry.program()),
                     stop->contacts.empty() ? "" : fmt::format(" ({})", stop->contacts),
                     comment_of(inquiry.program().statement(stop->op)));
}

/// What called an interrupt routine, if no contact or jump in it has decided anything.
void find_event_served(Inquiry& inquiry) {
  const State& state = inquiry.here_at_start().cpu().state();
  const std::uint8_t event = state.serving_event, routine = state.serving_routine;
  const Time since = state.serving_since;
  const AttachmentSearch search = find_last_attachment(inquiry.history(), inquiry.station(), event, inquiry.stop_request());
  inquiry.answers.interrupted |= search.interrupted;
  if (!search.attachment) return;
  const auto& [moment, what, by] = *search.attachment;
  std::string text =
      fmt::format("{} attached INT {} to {}, which called it at {}{}", named_without_comment(by.op, inquiry.program()),
                  routine, event_text(event), moment_text(since), comment_of(inquiry.program().statement(by.op)));
  inquiry.answers.decision = LastDecision{moment, std::move(text), by};
}

}  // namespace

void find_what_led_here(Inquiry& inquiry) {
  const serial::Simulation& here = inquiry.here_at_start();
  if (!here.plc().powered()) return find_power_loss(inquiry);
  const std::string stop = inquiry.stopped() ? stop_text(inquiry, here.cpu().state()) : "";
  if (!stop.empty()) inquiry.add(*inquiry.stopped(), stop, {});
  if (inquiry.stopped() && here.cpu().state().stopped_by_master) return;
  if (const auto cause = inquiry.witness().reasons.cause())
    inquiry.answers.decision = inquiry.decision_of(*cause);
  else if (here.cpu().state().in_interrupt)
    find_event_served(inquiry);
}

}  // namespace s7200::tools
