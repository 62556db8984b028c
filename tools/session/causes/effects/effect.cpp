#include "tools/session/causes/effects/effect.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

#include "interpreter/trace/text/statement_text.hpp"
#include "tools/session/causes/effects/changed_place.hpp"
#include "tools/session/causes/effects/effect_tree.hpp"
#include "tools/session/causes/effects/run_differences.hpp"
#include "tools/session/causes/effects/run_record.hpp"
#include "tools/session/causes/writer.hpp"
#include "tools/session/past/actions/access.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kMostLines = 60;   // of the tree
constexpr std::size_t kMostTimings = 5;  // that are named

/// The bits that hold a value of an area: the point of an input, the bit of a timer or counter.
Bits held_bits(const MemoryRange& range) {
  Bits bits = bits_of(range);
  if (range.area == Area::I) bits.first += std::uint64_t{image::kInputs - image::kI} * 8;
  const bool element = range.width != Width::Bit && range.count == 1 && (range.area == Area::T || range.area == Area::C);
  return element ? Bits{std::uint64_t{info(range.area).bits} * 8 + range.number, 1} : bits;
}

/// The memory that is looked at for effects: of an input its image, too.
std::vector<Bits> changed_bits(const MemoryRange& range) {
  std::vector<Bits> all{held_bits(range)};
  if (range.area == Area::I) all.push_back(bits_of(range));
  return all;
}

std::string who_changed(const History& history, const Program& program, const ChangedPlace& change,
                        const MemoryRange& range) {
  if (change.by) return named_in_sentence(change.by->op, program);
  const bool input = range.area == Area::I || range.area == Area::AI;
  if (input && !change.action && !change.planned) return "what is wired to the input";
  return changer_text(history, change.action, change.planned);
}

/// When memory changed again after the change that the run begins with; nothing if it did not.
std::optional<Time> next_change(const RunRecord& run, const Bits& place) {
  std::set<Time> turns;
  for (std::uint64_t bit = place.first; bit < place.end(); ++bit)
    if (const auto found = run.memory.find(bit); found != run.memory.end())
      for (const Turn& turn : found->second) turns.insert(turn.at);
  if (turns.size() < 2) return {};
  return *std::next(turns.begin());
}

/// When the program was first moved by hand: in another run it may stand elsewhere, and that cannot be done again.
std::optional<Time> moved_by_hand(const History& history, const Moment& since) {
  const std::size_t first = history.usage().forgotten;
  for (std::size_t number = since.actions; number < first + history.actions().size(); ++number) {
    const Action* const action = history.action(number);
    if (action && (std::holds_alternative<Jump>(*action) || std::holds_alternative<SetStack>(*action)))
      return history.moment_of_action(number).time;
  }
  return {};
}

std::string value_name(const Program& program, const MemoryRange& range, const std::vector<std::uint8_t>& bytes) {
  const bool bit = bytes.size() == 1 && held_bits(range).count == 1;
  return bit ? fmt::format("{}", bytes[0]) : value_text(program, range, bytes);
}

class EffectInquiry {
 public:
  EffectInquiry(History& history, std::size_t station, const MemoryRange& range, StopToken stop_request)
      : history_(history), station_(station), range_(range), place_(held_bits(range)), stop_request_(stop_request) {}

  EffectSearch search(std::string_view name, Time within) {
    const ChangeSearch found = find_changed_place(history_, station_, place_, stop_request_);
    if (found.interrupted) return {.answer = {}, .interrupted = true};
    if (!found.change) {
      const std::string value = value_name(program(), range_, bytes_at(cpu().state(), place_));
      return {.answer = {},
              .none = fmt::format("{} is {}; nothing has changed it {}", name, value, since_oldest_text(history_))};
    }
    return follow(*found.change, name, within);
  }

 private:
  Cpu& cpu() const { return history_.station(station_).cpu(); }
  const Program& program() const { return cpu().program(); }

  EffectSearch follow(const ChangedPlace& change, std::string_view name, Time within) {
    EffectAnswer answer{.name = std::string(name),
                        .was = value_name(program(), range_, change.was),
                        .became = value_name(program(), range_, change.became),
                        .at = change.at,
                        .by = who_changed(history_, program(), change, range_)};
    Time end = bounded(change, within, answer.ended_by);
    const auto known = run(change, end, {});
    if (!known) return {.answer = {}, .interrupted = true};
    answer.until = next_change(*known, place_);
    Hold hold{changed_bits(range_), change.was, answer.until.value_or(kNever), {}};
    if (answer.until) hold.then = known->value(place_, *answer.until);
    const auto without = run(change, end, std::move(hold));
    if (!without) return {.answer = {}, .interrupted = true};
    if (known->full || without->full) {
      end = std::min(end, std::min(known->full ? known->end : end, without->full ? without->end : end));
      answer.ended_by = "as more has happened than can be compared";
    }
    answer.followed_until = end;
    const RunDifferences differences(*known, *without, end);
    const EffectTree tree(program(), *known, *without, differences, changed_bits(range_));
    answer.effects = tree.effects();
    answer.by_timing = tree.by_timing();
    answer.alike_from = tree.alike_from(change.at);
    return {.answer = std::move(answer)};
  }

  Time bounded(const ChangedPlace& change, Time within, std::string& ended_by) const {
    const Time newest = history_.newest().time;
    Time end = change.at < kNever - within ? change.at + within : kNever;
    ended_by = fmt::format("{} after the change", format_duration(within));
    if (newest <= end) {
      end = newest;
      ended_by = "where what is known ends";
    }
    if (const auto by_hand = moved_by_hand(history_, change.before); by_hand && *by_hand < end) {
      end = *by_hand;
      ended_by = "where the program was moved by hand";
    }
    return end;
  }

  /// From just before the change; nothing after a stop request.
  std::optional<RunRecord> run(const ChangedPlace& change, Time end, std::optional<Hold> hold) {
    const History::Place here = history_.here();
    history_.go_to(change.before);
    const bool without = hold.has_value();
    SeriesRecorder recorder(history_, station_, std::move(hold), stop_request_);
    if (without && range_.area == Area::I) recorder.ignore_edges();
    history_.play_beside(recorder, end + 2 * cpu().state().longest_scan + kMillisecond);
    history_.return_to(here);
    if (recorder.interrupted()) return {};
    return recorder.run();
  }

  History& history_;
  std::size_t station_;
  MemoryRange range_;
  Bits place_;
  StopToken stop_request_;
};

// --- words ---

std::string time_text(const Effect& effect) {
  if (!effect.until) return fmt::format("from {} on", moment_text(effect.from));
  if (*effect.until <= effect.from) return fmt::format("at {}", moment_text(effect.from));
  return fmt::format("from {} to {}", moment_text(effect.from), moment_text(*effect.until));
}

std::string line_of_effect(const Effect& effect) {
  std::string by = effect.place;
  if (!effect.because.empty()) by += fmt::format("{}after {}", by.empty() ? "" : ", ", effect.because);
  return fmt::format("{}, {}{}", effect.text, time_text(effect), by.empty() ? "" : ": " + by);
}

void add_lines(const std::vector<Effect>& effects, std::size_t depth, std::vector<std::string>& lines, std::size_t& more) {
  for (const Effect& effect : effects) {
    if (lines.size() >= kMostLines)
      ++more;
    else
      lines.push_back(std::string(2 * depth, ' ') + line_of_effect(effect));
    add_lines(effect.effects, depth + 1, lines, more);
  }
}

void add_open(const std::vector<Effect>& effects, std::vector<std::string>& names) {
  for (const Effect& effect : effects) {
    if (!effect.until && !effect.name.empty() && std::ranges::find(names, effect.name) == names.end())
      names.push_back(effect.name);
    add_open(effect.effects, names);
  }
}

std::string shortened_list(const std::vector<std::string>& names, std::size_t most) {
  const std::size_t named = std::min(most, names.size());
  const std::string text =
      fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(named), ", "));
  return names.size() > named ? fmt::format("{} and {} more", text, names.size() - named) : text;
}

std::string end_text(const EffectAnswer& answer) {
  const std::string end = fmt::format("{} ({})", moment_text(answer.followed_until), answer.ended_by);
  if (answer.alike_from) return fmt::format("  all is alike again from {} to {}", moment_text(*answer.alike_from), end);
  std::vector<std::string> names;
  add_open(answer.effects, names);
  const std::string which = names.empty() ? answer.name : shortened_list(names, kMostTimings);
  return fmt::format("  at {} the runs still differ: {}", end, which);
}

nlohmann::ordered_json effect_json(const Effect& effect) {
  nlohmann::ordered_json json{{"kind", effect.kind}, {"text", effect.text}, {"from_ns", effect.from}};
  if (effect.until) json["until_ns"] = *effect.until;
  for (const auto& [key, value] :
       {std::pair("name", &effect.name), std::pair("value", &effect.value), std::pair("otherwise", &effect.otherwise),
        std::pair("place", &effect.place), std::pair("because", &effect.because)})
    if (!value->empty()) json[key] = *value;
  if (effect.op) json["op"] = *effect.op;
  for (const Effect& each : effect.effects) json["effects"].push_back(effect_json(each));
  return json;
}

}  // namespace

EffectSearch find_effect(History& history, std::size_t station, const MemoryRange& range, std::string_view name, Time within,
                         StopToken stop_request) {
  return EffectInquiry(history, station, range, stop_request).search(name, within);
}

std::vector<std::string> lines_of(const EffectAnswer& answer) {
  std::vector<std::string> lines{fmt::format("{} was {}, became {}, at {} by {}", answer.name, answer.was, answer.became,
                                             moment_text(answer.at), answer.by)};
  const std::string kept = answer.until ? fmt::format(" until {}, when it changes again", moment_text(*answer.until)) : "";
  const std::string other = fmt::format("the same run in which it stays {}{}", answer.was, kept);
  std::size_t more = 0;
  if (answer.effects.empty())
    lines.push_back(fmt::format("  nothing came of it: all else is as in {}", other));
  else
    lines.push_back(fmt::format("  unlike {}:", other));
  add_lines(answer.effects, 1, lines, more);
  if (more != 0) lines.push_back(fmt::format("  and {} more", more));
  if (!answer.by_timing.empty())
    lines.push_back(
        fmt::format("  only because scans take other times: {}", shortened_list(answer.by_timing, kMostTimings)));
  lines.push_back(end_text(answer));
  return lines;
}

nlohmann::ordered_json to_json(const EffectAnswer& answer) {
  nlohmann::ordered_json json{
      {"name", answer.name}, {"was", answer.was}, {"became", answer.became}, {"at_ns", answer.at}, {"by", answer.by}};
  if (answer.until) json["until_ns"] = *answer.until;
  json["followed_until_ns"] = answer.followed_until;
  json["ended_by"] = answer.ended_by;
  if (answer.alike_from) json["alike_from_ns"] = *answer.alike_from;
  json["effects"] = nlohmann::ordered_json::array();
  for (const Effect& effect : answer.effects) json["effects"].push_back(effect_json(effect));
  json["by_timing"] = answer.by_timing;
  return json;
}

}  // namespace s7200::tools
