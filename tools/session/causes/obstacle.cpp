#include "tools/session/causes/obstacle.hpp"

#include <fmt/format.h>

#include <utility>

#include "tools/views/machine_text.hpp"

namespace s7200::tools {
namespace {

std::string since_text(const Obstacle& obstacle) {
  if (!obstacle.since) return {};
  return obstacle.since_longer ? fmt::format(" since before {}", moment_text(*obstacle.since))
                               : fmt::format(" since {}", moment_text(*obstacle.since));
}

std::string line_of(const Obstacle& obstacle) {
  if (obstacle.name.empty()) return obstacle.text;
  std::string line = fmt::format("{} is {}{}", obstacle.name, obstacle.value, since_text(obstacle));
  if (!obstacle.wanted.empty()) line += fmt::format(", must be {}", obstacle.wanted);
  if (!obstacle.place.empty()) line += fmt::format(" ({})", obstacle.place);
  return obstacle.text.empty() ? line : fmt::format("{}: {}", line, obstacle.text);
}

void add_lines(const Obstacle& obstacle, std::size_t depth, std::vector<std::string>& lines) {
  lines.push_back(std::string(2 * depth, ' ') + line_of(obstacle));
  for (const Obstacle& each : obstacle.because) add_lines(each, depth + 1, lines);
}

}  // namespace

std::vector<std::string> lines_of(const Obstacle& obstacle) {
  std::vector<std::string> lines;
  add_lines(obstacle, 0, lines);
  return lines;
}

nlohmann::ordered_json to_json(const Obstacle& obstacle) {
  nlohmann::ordered_json json{{"kind", obstacle.kind}};
  for (const auto& [key, value] :
       {std::pair("name", &obstacle.name), std::pair("value", &obstacle.value), std::pair("wanted", &obstacle.wanted),
        std::pair("text", &obstacle.text), std::pair("place", &obstacle.place)})
    if (!value->empty()) json[key] = *value;
  if (obstacle.op) json["op"] = *obstacle.op;
  if (obstacle.since) json[obstacle.since_longer ? "since_before_ns" : "since_ns"] = *obstacle.since;
  for (const Obstacle& each : obstacle.because) json["because"].push_back(to_json(each));
  return json;
}

}  // namespace s7200::tools
