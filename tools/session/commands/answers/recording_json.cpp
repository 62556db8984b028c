#include "tools/session/commands/answers/recording_json.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tools/json/hex_bytes.hpp"
#include "tools/json/json_taker.hpp"
#include "tools/rig/memory_json.hpp"
#include "tools/session/commands/answers/action_json.hpp"
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

/// The actions as they are of each station: an address is one of its CPU.
class ActionTaker {
 public:
  ActionTaker(JsonTaker& taker, const Json& actions, Models models) : taker_(taker), actions_(actions), models_(models) {}

  std::size_t count() const { return actions_.size(); }

  /// `station`: of what a host port was told its number.
  const Action& action(std::size_t number, std::size_t station) {
    const bool of_host = actions_[number].contains("host");
    if (!of_host && station >= models_.size()) taker_.fail("something was done to a station that it has not");
    const CpuModel* const model = models_[of_host || station >= models_.size() ? 0 : station];
    const auto known = taken_.find({number, model});
    if (known != taken_.end()) return known->second;
    return taken_.emplace(std::pair(number, model), take_action(taker_, actions_[number], *model)).first->second;
  }

 private:
  JsonTaker& taker_;
  const Json& actions_;
  Models models_;
  std::map<std::pair<std::size_t, const CpuModel*>, Action> taken_{};
};

void take_done(JsonTaker& taker, const Json& json, ActionTaker& actions, Recording& recording) {
  const Json& done = taker.map_at(json, "done");
  const auto count = taker.number_at<std::size_t>(json, "count", {0, std::size_t{1} << 24});
  const Columns columns = take_columns(taker, done, taker.fine() ? count : 0);
  recording.actions.reserve(columns.action.size());  // a day of polling has 86 400: moving them took half the time
  recording.stations.reserve(columns.action.size());
  recording.moments.reserve(columns.action.size());
  std::uint64_t instructions = 0;
  Time time = 0;
  for (std::size_t row = 0; row < columns.action.size() && taker.fine(); ++row) {
    const auto number = static_cast<std::size_t>(columns.action[row]);
    if (number >= actions.count() || columns.after[row] > kNever - time) return taker.fail("something unknown was done");
    instructions += static_cast<std::uint64_t>(columns.instructions[row]);
    time += columns.after[row];
    const auto station = static_cast<std::size_t>(columns.host[row]);
    recording.actions.push_back(actions.action(number, station));
    recording.stations.push_back(station);
    recording.moments.push_back(moment_of(columns.flags[row], instructions, row, time));
  }
}

std::string take_bytes(JsonTaker& taker, const Json& json) {
  const std::string hex = taker.text(json);
  auto bytes = bytes_of_hex(hex);
  if (!bytes) taker.fail("a checkpoint holds something else than hex");
  return bytes.value_or("");
}

void take_memories(JsonTaker& taker, const Json& stations, Models models, Recording& recording) {
  if (stations.size() != models.size()) return taker.fail("only some PLCs have a memory");
  for (std::size_t station = 0; station < models.size() && taker.fine(); ++station)
    if (const auto memory = take_kept_memory(taker, stations[station], *models[station]))
      recording.memory.push_back(*memory);
}

}  // namespace

Json json_of(const Recording& recording, Models models) {
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
  for (std::size_t station = 0; station < recording.memory.size(); ++station) {
    Json memory = Json::object();
    add_kept_memory(memory, recording.memory[station], *models[station]);
    json["stations"].push_back(std::move(memory));
  }
  if (!recording.checkpoints.empty()) json["checkpoints"] = checkpoints_json(recording.checkpoints);
  return json;
}

Json checkpoints_json(const std::vector<std::string>& checkpoints) {
  Json json = Json::array();
  for (const std::string& bytes : checkpoints)
    json.push_back(plain_hex({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}));
  return json;
}

Result<Recording> recording_from(const Json& json, Models models) {
  JsonTaker taker;
  Recording recording;
  ActionTaker actions(taker, taker.list_at(json, "actions"), models);
  take_done(taker, json, actions, recording);
  recording.end = take_moment(taker, taker.member(json, "end"));
  recording.now = take_moment(taker, taker.member(json, "now"));
  if (JsonTaker::has(json, "stations")) take_memories(taker, taker.list_at(json, "stations"), models, recording);
  if (JsonTaker::has(json, "checkpoints"))
    for (const Json& one : taker.list_at(json, "checkpoints")) recording.checkpoints.push_back(take_bytes(taker, one));
  for (const Moment& moment : {recording.end, recording.now})
    if (moment.actions > recording.actions.size()) taker.fail("more was done than it has");
  if (!taker.fine()) return Trouble{taker.why()};
  return recording;
}

}  // namespace s7200::tools
