#include "tools/session/past/past_words.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

/// Null if the past does not begin with power coming back.
const PowerCycle* power_cycle(const History& history) { return history.here().branch->power.get(); }

std::string power_cycle_text(const PowerCycle& power) {
  return fmt::format("power came back{} ('back' leads to before that)",
                     power.off == 0 ? "" : " after " + format_duration(power.off));
}

}  // namespace

std::string list_text(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

std::string oldest_text(const History& history) {
  const History::Usage usage = history.usage();
  if (usage.forgotten == 0) {
    const PowerCycle* const power = power_cycle(history);
    return power ? "where " + power_cycle_text(*power) : "where this session powered the CPU up";
  }
  return fmt::format("before which what came over the bridge is forgotten: {}, more than {} MB",
                     counted(usage.forgotten, "action"), usage.log_bound >> 20);
}

std::string since_oldest_text(const History& history) {
  const History::Usage usage = history.usage();
  if (usage.forgotten == 0) {
    const PowerCycle* const power = power_cycle(history);
    return power ? "since " + power_cycle_text(*power) : "since power-up";
  }
  return fmt::format("since {}, where the past begins", moment_text(usage.oldest.time));
}

std::string at_oldest_text(const History& history) {
  const bool whole = history.usage().forgotten == 0 && !power_cycle(history);
  return "this is the oldest moment: " + (whole ? "the session begins at power-up" : oldest_text(history));
}

Result<Time> parse_moment(std::string_view text, const History& history) {
  const std::string word = stl::lower_case(text);
  const Time oldest = history.usage().oldest.time, newest = history.newest().time;
  if (word == "start") return oldest;
  if (word == "end") return newest;
  const bool before_now = text.starts_with('-');
  const auto given = parse_duration(text.substr(before_now ? 1 : 0));
  if (!given)
    return trouble("'{}' is not a moment; write for example 15.193ms or -5ms (in {}), start or end", stl::shortened(text),
                   kTimeUnits);
  const Time now = history.now().time, time = before_now ? now - *given : *given;
  if (time < oldest) return trouble("the oldest moment is {}, {}", moment_text(oldest), oldest_text(history));
  if (time > newest) return trouble("nothing has run after {} so far", moment_text(newest));
  return time;
}

bool go_to_parsed(History& history, Time time) {
  const Moment oldest = history.usage().oldest;
  if (time > oldest.time) return history.go_to(time);
  history.go_to(oldest);
  return true;
}

}  // namespace s7200::tools
