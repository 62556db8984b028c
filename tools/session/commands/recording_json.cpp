#include "tools/session/commands/recording_json.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "interpreter/base/numbers.hpp"
#include "tools/json/json_taker.hpp"
#include "tools/rig/memory_json.hpp"
#include "tools/session/commands/action_json.hpp"
#include "tools/views/report.hpp"

namespace s7200::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t kSettled = 1, kStopped = 2, kNotCounted = 4;  // flags of a moment

using Column = std::vector<std::int64_t>;

/// What was done, a column for each of its parts.
struct Columns {
  Column action, host, after, instructions, flags;
};

struct NamedColumn {
  const char* name;
  Column Columns::*column;
};
constexpr NamedColumn kColumns[] = {{"action", &Columns::action},
                                    {"host", &Columns::host},
                                    {"after_ns", &Columns::after},
                                    {"instructions", &Columns::instructions},
                                    {"flags", &Columns::flags}};

std::int64_t flags_of(const Moment& moment) {
  return (moment.settled ? kSettled : 0) | (moment.stopped ? kStopped : 0) | (moment.is_counted() ? 0 : kNotCounted);
}

/// `instructions`: of the moment before.
Moment moment_of(std::int64_t flags, std::uint64_t instructions, std::size_t actions, Time time) {
  return {.instructions = (flags & kNotCounted) != 0 ? Moment::kNotCounted : instructions,
          .actions = actions,
          .settled = (flags & kSettled) != 0,
          .time = time,
          .stopped = (flags & kStopped) != 0};
}

Json moment_json(const Moment& moment) {
  return {moment.is_counted() ? moment.instructions : 0, moment.actions, moment.time, flags_of(moment)};
}

Moment take_moment(JsonTaker& taker, const Json& json) {
  const auto part = [&](std::size_t number) { return taker.number<std::int64_t>(taker.element(json, number), {0, kNever}); };
  return moment_of(part(3), static_cast<std::uint64_t>(part(0)), static_cast<std::size_t>(part(1)), part(2));
}

Json columns_json(const Recording& recording, const std::vector<std::int64_t>& numbers) {
  Columns columns;
  std::uint64_t instructions = 0;
  Time time = 0;
  for (std::size_t i = 0; i < recording.actions.size(); ++i) {
    const Moment& moment = recording.moments[i];
    const std::uint64_t executed = moment.is_counted() ? moment.instructions : instructions;
    columns.action.push_back(numbers[i]);
    columns.host.push_back(static_cast<std::int64_t>(recording.stations[i]));
    columns.after.push_back(moment.time - time);
    columns.instructions.push_back(static_cast<std::int64_t>(executed - instructions));
    columns.flags.push_back(flags_of(moment));
    instructions = executed;
    time = moment.time;
  }
  Json json = Json::object();
  for (const auto& [name, column] : kColumns)
    if (std::ranges::any_of(columns.*column, [](std::int64_t one) { return one != 0; })) json[name] = columns.*column;
  return json;
}

Columns take_columns(JsonTaker& taker, const Json& json, std::size_t count) {
  Columns columns;
  for (const auto& [name, column] : kColumns) {
    (columns.*column).resize(count);
    if (!JsonTaker::has(json, name)) continue;
    const Json& list = taker.list_at(json, name);
    if (list.size() != count) taker.fail("a column of what was done is not as long as the others");
    for (std::size_t row = 0; row < std::min(count, list.size()); ++row)
      (columns.*column)[row] = taker.number<std::int64_t>(list[row], {0, kNever});
  }
  return columns;
}

void take_done(JsonTaker& taker, const Json& json, const std::vector<Action>& actions, Recording& recording) {
  const Json& done = taker.map_at(json, "done");
  const auto count = taker.number_at<std::size_t>(json, "count", {0, std::size_t{1} << 24});
  const Columns columns = take_columns(taker, done, taker.fine() ? count : 0);
  std::uint64_t instructions = 0;
  Time time = 0;
  for (std::size_t row = 0; row < columns.action.size() && taker.fine(); ++row) {
    const auto number = static_cast<std::size_t>(columns.action[row]);
    if (number >= actions.size() || columns.after[row] > kNever - time) return taker.fail("something unknown was done");
    instructions += static_cast<std::uint64_t>(columns.instructions[row]);
    time += columns.after[row];
    recording.actions.push_back(actions[number]);
    recording.stations.push_back(static_cast<std::size_t>(columns.host[row]));
    recording.moments.push_back(moment_of(columns.flags[row], instructions, row, time));
  }
}

std::string take_bytes(JsonTaker& taker, const Json& json) {
  const std::string hex = taker.text(json);
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size() && taker.fine(); i += 2) {
    const auto high = hex_digit(hex[i]), low = hex_digit(hex[i + 1]);
    if (!high || !low) taker.fail("a checkpoint holds something else than hex");
    bytes += static_cast<char>(high.value_or(0) << 4 | low.value_or(0));
  }
  return bytes;
}

}  // namespace

Json json_of(const Recording& recording, const CpuModel& model) {
  Json json = Json::object(), actions = Json::array();
  std::vector<std::int64_t> numbers;
  std::map<std::string, std::int64_t, std::less<>> known;
  for (const Action& action : recording.actions) {
    Json one = json_of(action);
    const auto [place, is_new] = known.emplace(in_one_line(one), static_cast<std::int64_t>(known.size()));
    if (is_new) actions.push_back(std::move(one));
    numbers.push_back(place->second);
  }
  json["actions"] = std::move(actions);
  json["count"] = numbers.size();
  json["done"] = columns_json(recording, numbers);
  json["end"] = moment_json(recording.end);
  json["now"] = moment_json(recording.now);
  if (!recording.memory.empty()) add_kept_memory(json, recording.memory.front(), model);
  if (!recording.checkpoints.empty()) json["checkpoints"] = checkpoints_json(recording.checkpoints);
  return json;
}

Json checkpoints_json(const std::vector<std::string>& checkpoints) {
  Json json = Json::array();
  for (const std::string& bytes : checkpoints)
    json.push_back(plain_hex({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}));
  return json;
}

std::optional<Recording> recording_from(const Json& json, const CpuModel& model, std::string& why) {
  JsonTaker taker;
  Recording recording;
  std::vector<Action> actions;
  for (const Json& one : taker.list_at(json, "actions")) actions.push_back(take_action(taker, one, model));
  take_done(taker, json, actions, recording);
  recording.end = take_moment(taker, taker.member(json, "end"));
  recording.now = take_moment(taker, taker.member(json, "now"));
  if (const auto memory = take_kept_memory(taker, json, model)) recording.memory.push_back(*memory);
  if (JsonTaker::has(json, "checkpoints"))
    for (const Json& one : taker.list_at(json, "checkpoints")) recording.checkpoints.push_back(take_bytes(taker, one));
  for (const Moment& moment : {recording.end, recording.now})
    if (moment.actions > recording.actions.size()) taker.fail("more was done than it has");
  why = taker.why();
  return taker.fine() ? std::optional(std::move(recording)) : std::nullopt;
}

}  // namespace s7200::tools
