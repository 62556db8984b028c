#include "tools/session/causes/obstacle.hpp"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

std::string since_text(const Obstacle& obstacle) {
  if (!obstacle.since) return {};
  return obstacle.since_longer ? fmt::format(" since before {}", moment_text(*obstacle.since))
                               : fmt::format(" since {}", moment_text(*obstacle.since));
}

std::string with_reference(const Obstacle& obstacle) {
  if (obstacle.as_line == 0) return obstacle.text;
  return fmt::format("{}{}as above, line {} of this answer", obstacle.text, obstacle.text.empty() ? "" : "; ",
                     obstacle.as_line);
}

std::string line_of(const Obstacle& obstacle) {
  if (obstacle.name.empty()) return obstacle.text;
  std::string line = fmt::format("{} is {}{}", obstacle.name, obstacle.value, since_text(obstacle));
  if (!obstacle.wanted.empty()) line += fmt::format(", must be {}", obstacle.wanted);
  if (!obstacle.place.empty()) line += fmt::format(" ({})", obstacle.place);
  const std::string text = with_reference(obstacle);
  return text.empty() ? line : fmt::format("{}: {}", line, text);
}

void add_lines(const Obstacle& obstacle, std::size_t depth, std::vector<std::string>& lines) {
  lines.push_back(std::string(2 * depth, ' ') + line_of(obstacle));
  for (const Obstacle& each : obstacle.because) add_lines(each, depth + 1, lines);
}

void find_lines(const Obstacle& obstacle, std::size_t& line, std::map<std::uint32_t, std::size_t>& lines) {
  ++line;
  if (obstacle.number != 0) lines[obstacle.number] = line;
  for (const Obstacle& each : obstacle.because) find_lines(each, line, lines);
}

void set_lines(Obstacle& obstacle, const std::map<std::uint32_t, std::size_t>& lines) {
  if (obstacle.same_as != 0) obstacle.as_line = lines.at(obstacle.same_as);
  for (Obstacle& each : obstacle.because) set_lines(each, lines);
}

}  // namespace

void number_lines(Obstacle& root) {
  std::size_t line = 0;
  std::map<std::uint32_t, std::size_t> lines;
  find_lines(root, line, lines);
  set_lines(root, lines);
}

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
  if (obstacle.as_line != 0) json["as_line"] = obstacle.as_line;
  if (obstacle.since) json[obstacle.since_longer ? "since_before_ns" : "since_ns"] = *obstacle.since;
  for (const Obstacle& each : obstacle.because) json["because"].push_back(to_json(each));
  return json;
}

}  // namespace s7200::tools
