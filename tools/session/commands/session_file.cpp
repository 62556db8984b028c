#include "tools/session/commands/session_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/json/json.hpp"
#include "tools/rig/memory_json.hpp"
#include "tools/session/commands/answers/action_json.hpp"
#include "tools/session/commands/answers/recording_json.hpp"
#include "tools/session/past/digest.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kFormat = "s7200 session 5";

/// Of JSON from outside, which may hold what is not UTF-8.
std::string sum_of(const Json& json) { return digest_of(in_one_line(json)); }

constexpr Between<Time> kAnyMoment{0, kNever};

Json json_of(const Moment& moment) {
  return {moment.instructions, moment.actions, moment.settled, moment.stopped, moment.time};
}

Moment moment_from(const Json& json) {
  return {.instructions = number_of<std::uint64_t>(json.at(0)),
          .actions = number_of<std::size_t>(json.at(1)),
          .settled = truth_of(json.at(2)),
          .time = number_of<Time>(json.at(4), kAnyMoment),
          .stopped = truth_of(json.at(3))};
}

RetentiveMemory retentive_from(const Json& json, const CpuModel& model) {
  JsonTaker taker;
  const auto memory = take_kept_memory(taker, json, model);
  if (!taker.fine()) throw std::runtime_error(taker.why());
  return *memory;
}

/// Of the only PLC they are in `json` itself, of several in its `stations`.
template <class Take>
void for_each_station(const Json& json, std::size_t count, Take take) {
  if (!json.contains("stations")) return take(0, json);
  for (std::size_t number = 0; number < count; ++number) take(number, json.at("stations").at(number));
}

Recording recording_from(const Json& json, Models models) {
  Recording recording;
  for_each_station(json, models.size(), [&](std::size_t number, const Json& station) {
    if (station.contains("memory")) recording.memory.push_back(retentive_from(station, *models[number]));
  });
  if (!recording.memory.empty() && recording.memory.size() != models.size())
    throw std::runtime_error("only some PLCs have a memory");
  for (const Json& action : json.at("actions")) {
    const auto station = number_at<std::size_t>(action, "station", kWhole<std::size_t>, 0);
    const bool of_bridge = action.contains("host");  // `station` is its number then
    if (station >= models.size() && !of_bridge) throw std::runtime_error("something was done to a station that it has not");
    recording.moments.push_back(moment_from(action.at("at")));
    recording.stations.push_back(station);
    JsonTaker taker;
    recording.actions.push_back(take_action(taker, action, *models[of_bridge ? 0 : station]));
    if (!taker.fine()) throw std::runtime_error(taker.why());
  }
  recording.end = moment_from(json.at("end"));
  recording.now = moment_from(json.at("now"));
  for (const Moment& moment : {recording.end, recording.now})
    if (moment.actions > recording.actions.size()) throw std::runtime_error("more was done than it has");
  if (recording.now.time > recording.end.time) throw std::runtime_error("it stands after its own end");
  const auto is_late = [&](const Moment& moment) { return moment.time > recording.end.time; };
  if (std::ranges::any_of(recording.moments, is_late)) throw std::runtime_error("something was done after its end");
  return recording;
}

Json json_of(const SessionFile::SavedStop& stop) {
  Json json{{"number", stop.number}, {"station", stop.station}, {stop.access.empty() ? "break" : "watch", stop.on}};
  if (!stop.access.empty()) json["access"] = stop.access;
  if (stop.always) json["always"] = true;
  if (!stop.condition.empty()) json["if"] = stop.condition;
  if (stop.from_hit > 1) json["hits"] = stop.from_hit;
  if (!stop.log.empty()) json["log"] = stop.log;
  return json;
}

SessionFile::SavedStop stop_from(const Json& json, std::size_t stations) {
  SessionFile::SavedStop stop{.number = number_at<int>(json, "number"),
                              .station = number_at<std::size_t>(json, "station"),
                              .on = text_at(json, json.contains("watch") ? "watch" : "break"),
                              .access = json.contains("watch") ? text_at(json, "access") : "",
                              .always = truth_at(json, "always", false),
                              .condition = text_at(json, "if", ""),
                              .from_hit = number_at<std::uint64_t>(json, "hits", kWhole<std::uint64_t>, 1),
                              .log = text_at(json, "log", "")};
  if (stop.station >= stations) throw std::runtime_error("a breakpoint of a station that it has not");
  if (stop.number < 1 || stop.number == std::numeric_limits<int>::max())
    throw std::runtime_error("a breakpoint with a number that it cannot have");
  if (stl::trim(stop.on).empty()) throw std::runtime_error("a breakpoint at nothing");
  return stop;
}

std::vector<SessionOption> options_from(const Json& json) {
  std::vector<SessionOption> options;
  for (const auto& [name, value] : json.items()) options.push_back({name, text_of(value)});
  return options;
}

SessionFile file_from(const Json& json, Models models) {
  SessionFile file{.stations = {}, .options = options_from(json.at("options")), .recording = recording_from(json, models)};
  for_each_station(json, models.size(), [&](std::size_t, const Json& station) {
    file.stations.push_back({.name = text_at(station, "name", ""),
                             .cpu = text_at(station, "cpu"),
                             .program = text_at(station, "program"),
                             .begin = text_at(station, "begin"),
                             .state = text_at(station, "state")});
  });
  for (const Json& stop : json.at("stops")) file.stops.push_back(stop_from(stop, models.size()));
  return file;
}

Json json_of(const SessionFile::Station& station) {
  return {{"cpu", station.cpu}, {"program", station.program}, {"begin", station.begin}};
}

void add_memory(Json& json, const SessionFile& file, std::size_t number) {
  if (file.recording.memory.empty()) return;
  const RetentiveMemory& memory = file.recording.memory[number];
  add_kept_memory(json, memory, *find_cpu(file.stations[number].cpu));
}

/// Why it is not of the PLCs that are here; empty if it is.
std::string why_other_plcs(const Json& json, Models models, std::span<const std::string> names) {
  const bool of_system = !names.empty();
  if (json.contains("stations") != of_system)
    return of_system ? "it is of one program, not of a system" : "it is of a system, not of one program";
  if (of_system && json.at("stations").size() != names.size())
    return fmt::format("it is of a system of {} PLCs, not of {}", json.at("stations").size(), names.size());
  std::string why;
  for_each_station(json, models.size(), [&](std::size_t number, const Json& station) {
    const std::string cpu = text_at(station, "cpu"), name = text_at(station, "name", "");
    if (!why.empty()) return;
    if (of_system && name != names[number])
      why = fmt::format("it is of a system with the PLC '{}', not '{}'", stl::shortened(name), names[number]);
    else if (cpu != models[number]->name)
      why = fmt::format("it is of a CPU {}, not of a CPU {}", cpu, models[number]->name);
  });
  return why;
}

}  // namespace

std::string to_text(const SessionFile& file) {
  const Recording& recording = file.recording;
  const bool one = file.stations.size() == 1 && file.stations.front().name.empty();
  Json json{{"format", kFormat}, {"version", version()}};
  if (one) {
    json.update(json_of(file.stations.front()));
    add_memory(json, file, 0);
  }
  json["options"] = Json::object();
  for (const SessionOption& option : file.options) json["options"][option.name] = option.value;
  for (std::size_t number = 0; number < file.stations.size() && !one; ++number) {
    Json station{{"name", file.stations[number].name}};
    station.update(json_of(file.stations[number]));
    add_memory(station, file, number);
    station["state"] = file.stations[number].state;
    json["stations"].push_back(std::move(station));
  }
  json["actions"] = Json::array();
  for (std::size_t i = 0; i < recording.actions.size(); ++i) {
    Json action = json_of(recording.actions[i]);
    if (!one) action["station"] = recording.stations[i];
    action["at"] = json_of(recording.moments[i]);
    json["actions"].push_back(std::move(action));
  }
  json["end"] = json_of(recording.end);
  json["now"] = json_of(recording.now);
  json["stops"] = Json::array();
  for (const SessionFile::SavedStop& stop : file.stops) json["stops"].push_back(json_of(stop));
  if (one) json["state"] = file.stations.front().state;
  json["sum"] = sum_of(json);
  return json.dump(2) + "\n";
}

Result<SessionFile> session_from_text(std::string_view text, std::span<const CpuModel* const> models,
                                      std::span<const std::string> names) {
  const auto parsed = parse_json(text);
  Json json = parsed.value_or(Json());
  const Json* const format = member(json, "format");
  if (!format || !format->is_string() || !format->get_ref<const std::string&>().starts_with(kAnySessionFormat))
    return Trouble{!text.starts_with(session_beginning()) ? "it is not a saved session"
                   : parsed                               ? "it is damaged"
                                                          : "it is damaged: it is " + parsed.why()};
  if (*format != kFormat)
    return trouble("it is \"{}\", and this s7200 reads \"{}\"", stl::shortened(format->get<std::string>()), kFormat);
  const Json* const written_sum = member(json, "sum");
  const Json sum = written_sum ? *written_sum : Json();
  json.erase("sum");
  if (sum != sum_of(json)) return Trouble{"it is damaged: its check sum is wrong"};
  try {
    if (const std::string by = text_at(json, "version"); by != version())
      return trouble("s7200 {} has written it, and this is s7200 {}: they may run differently", by, version());
    if (std::string why = why_other_plcs(json, models, names); !why.empty()) return Trouble{std::move(why)};
    return file_from(json, models);
  } catch (const Json::exception&) {  // whose texts are of no help to a user
    return Trouble{"it is damaged: something in it is missing, or of another type"};
  } catch (const std::exception& error) {
    return trouble("it is damaged: {}", error.what());
  }
}

}  // namespace s7200::tools
