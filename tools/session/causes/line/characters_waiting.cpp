// Which characters of a request wait for their routine, and which were lost because the queue was full?
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "interpreter/model/ports.hpp"
#include "tools/session/causes/inquiry.hpp"
#include "tools/session/causes/last/last_enable.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

/// While the request is being sent characters may wait, and none may be lost.
std::vector<Witness::ForInterrupt> for_interrupts(const Inquiry& inquiry) {
  if (!inquiry.is_by_others() || !inquiry.request()->unanswered) return {};
  auto all = inquiry.witness().for_interrupts_since(inquiry.port(), inquiry.request()->start);
  const bool in_question = inquiry.request()->end != 0 || std::ranges::any_of(all, &Witness::ForInterrupt::lost);
  return in_question ? all : std::vector<Witness::ForInterrupt>{};
}

std::size_t lost_of(const std::vector<Witness::ForInterrupt>& all, Time since) {
  return static_cast<std::size_t>(
      std::ranges::count_if(all, [&](const Witness::ForInterrupt& one) { return one.lost && one.at >= since; }));
}

std::string lost_text(std::size_t characters, std::string_view queue) {
  return fmt::format("{} {} lost because {} was full", characters, characters == 1 ? "was" : "were", queue);
}

/// `; until then a character came every 286.458 us, and INT 123 took 331.2 us, 27 times`: if routines took most of the time
/// from the first character to the first that was lost, each with its mean.
std::string served_text(const Inquiry& inquiry, const std::vector<Witness::ForInterrupt>& all,
                        std::vector<Witness::ForInterrupt>::const_iterator lost) {
  struct Sum {
    Time took = 0;
    int times = 0;
  };
  std::map<std::uint8_t, Sum> routines;
  Time took = 0;
  for (const Witness::Service& one : inquiry.witness().services_since(all.front().at)) {
    if (one.end > lost->at) break;
    took += one.end - one.at;
    routines[one.routine].took += one.end - one.at;
    ++routines[one.routine].times;
  }
  const Time length = lost->at - all.front().at;
  if (took < length / 2 || routines.empty()) return {};
  std::vector<std::string> said;
  for (const auto& [routine, sum] : routines)
    said.push_back(fmt::format("INT {} took {}, {}", routine, format_duration(sum.took / sum.times),
                               sum.times == 1 ? "once" : fmt::format("{} times", sum.times)));
  return fmt::format("; until then a character came every {}, and {}", format_duration(length / (lost - all.begin())),
                     fmt::join(said, ", "));
}

std::size_t waiting_in_the_queue(const State& state, std::uint8_t port) {
  std::size_t waiting = 0;
  for (const InterruptQueue& queue : state.queue)
    waiting += static_cast<std::size_t>(
        std::count_if(queue.entry.begin(), queue.entry.begin() + queue.count,
                      [&](const QueuedInterrupt& one) { return one.event == kPorts[port].received; }));
  return waiting;
}

Keeper what_disabled(Inquiry& inquiry) {
  const EnableSearch search = find_last_enable(inquiry.history(), inquiry.station(), inquiry.stop_request());
  inquiry.answers.interrupted |= search.interrupted;
  if (search.interrupted) return {};
  if (!search.enable) return {.text = "; no ENI was executed " + since_oldest_text(inquiry.history())};
  if (!search.enable->by)
    return {.text = fmt::format("; no ENI was executed since the CPU went to RUN at {}", moment_text(search.enable->at)),
            .since = search.enable->at};
  return inquiry.kept_by(search.enable->moment, *search.enable->by, "disabled");
}

}  // namespace

/// What was lost before they were disabled is not to be blamed on that.
std::size_t find_characters_waiting(Inquiry& inquiry) {
  const std::vector<Witness::ForInterrupt> all = for_interrupts(inquiry);
  const State& state = inquiry.here_at_start().cpu().state();
  const std::size_t waiting = waiting_in_the_queue(state, inquiry.port());
  if (all.empty() || waiting + lost_of(all, 0) == 0 || state.mode != Mode::Run || state.interrupts_enabled) return 0;
  const Keeper keeper = what_disabled(inquiry);
  const std::size_t lost = lost_of(all, keeper.since);
  if (waiting + lost == 0) return 0;
  std::vector<std::string> became;
  if (waiting > 0)
    became.push_back(fmt::format("{} {} in the queue", characters_text(waiting), waiting == 1 ? "waits" : "wait"));
  if (lost > 0) became.push_back(lost_text(lost, waiting > 0 ? "it" : "the interrupt queue"));
  inquiry.add(inquiry.start().time,
              fmt::format("no answer to {} since {}: interrupts are disabled; {}{}", characters_text(all.size()),
                          moment_text(all.front().since), fmt::join(became, ", "), keeper.text),
              keeper);
  return lost;
}

void find_characters_lost(Inquiry& inquiry, std::size_t known) {
  const std::vector<Witness::ForInterrupt> all = for_interrupts(inquiry);
  const std::size_t lost = lost_of(all, 0) - std::min(known, lost_of(all, 0));
  const auto first = std::ranges::find_if(all, &Witness::ForInterrupt::lost);
  if (lost == 0) return;
  inquiry.add_first({first->since, fmt::format("of {} since {}, {}", characters_text(all.size()),
                                               moment_text(all.front().since), lost_text(lost, "the interrupt queue")) +
                                    served_text(inquiry, all, first)});
}

}  // namespace s7200::tools
