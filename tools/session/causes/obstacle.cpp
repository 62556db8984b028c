#include "tools/session/causes/obstacle.hpp"

#include <fmt/format.h>

#include <deque>
#include <map>
#include <tuple>
#include <utility>

#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

std::string since_text(const Obstacle& obstacle) {
  if (!obstacle.since) return {};
  return obstacle.since_longer ? fmt::format(" since before {}", moment_text(*obstacle.since))
                               : fmt::format(" since {}", moment_text(*obstacle.since));
}

/// `more`: what is said after its own text; empty: nothing.
std::string with_more(const Obstacle& obstacle, const std::string& more) {
  return obstacle.text + (more.empty() || obstacle.text.empty() ? "" : "; ") + more;
}

std::string reference_text(std::size_t line, std::size_t own_line) {
  return fmt::format("as {}, line {} of this answer", line < own_line ? "above" : "below", line);
}

std::string line_of(const Obstacle& obstacle, const std::string& more) {
  if (obstacle.name.empty()) return with_more(obstacle, more);
  const bool known = !obstacle.value.empty();
  std::string line = obstacle.name;
  if (known) line += fmt::format(" is {}{}", obstacle.value, since_text(obstacle));
  if (!obstacle.wanted.empty()) line += fmt::format("{} must be {}", known ? "," : "", obstacle.wanted);
  if (!obstacle.place.empty()) line += fmt::format(" ({})", obstacle.place);
  const std::string text = with_more(obstacle, more);
  return text.empty() ? line : fmt::format("{}: {}", line, text);
}

void add_lines(const Obstacle& obstacle, std::size_t depth, std::vector<std::string>& lines) {
  const std::string more = obstacle.as_line == 0 ? "" : reference_text(obstacle.as_line, lines.size() + 1);
  lines.push_back(std::string(2 * depth, ' ') + line_of(obstacle, more));
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

constexpr std::size_t kMostLines = 38;

/// Chooses what is nearest to the root. A node with a name is shown with all that is below it, to the next nodes with names,
/// or with nothing. What is to become of the same memory is shown at the node that is nearest to the root.
class FewLines {
 public:
  FewLines(const Obstacle& root, const FurtherQuestion& question) : root_(root), question_(question) {
    find_told(root);
    choose();
    number(root);
    add(root, 0);
  }

  std::vector<std::string> lines() && { return std::move(lines_); }

 private:
  void find_told(const Obstacle& node) {
    if (node.number != 0) told_[node.number] = &node;
    for (const Obstacle& each : node.because) find_told(each);
  }

  /// The node that has what is because of this one.
  const Obstacle& told(const Obstacle& node) const { return node.same_as == 0 ? node : *told_.at(node.same_as); }

  static std::size_t lines_below(const Obstacle& node) {
    std::size_t lines = node.because.size();
    for (const Obstacle& each : node.because)
      if (each.name.empty()) lines += lines_below(each);
    return lines;
  }

  void queue_names(const Obstacle& node, std::deque<const Obstacle*>& queue) const {
    for (const Obstacle& each : node.because)
      if (each.name.empty())
        queue_names(each, queue);
      else
        queue.push_back(&each);
  }

  void choose() {
    std::size_t used = 1;
    for (std::deque<const Obstacle*> queue{&root_}; !queue.empty(); queue.pop_front()) {
      const Obstacle& node = *queue.front();
      const Obstacle& content = told(node);
      if (content.because.empty() || shown_for(node)) continue;
      const std::size_t below = lines_below(content);
      if (&node != &root_ && used + below > kMostLines) continue;
      used += below;
      shown_[subject_of(node)] = &node;
      queue_names(content, queue);
    }
  }

  /// What a node is about: memory and what it is to be; of one without memory, itself.
  using Subject = std::tuple<std::uint64_t, std::uint64_t, std::string, const Obstacle*>;
  static Subject subject_of(const Obstacle& node) {
    return {node.bits.first, node.bits.count, node.wanted, node.bits.count == 0 ? &node : nullptr};
  }

  /// The node below which it stands what is because of this one; null if it is shown nowhere.
  const Obstacle* shown_for(const Obstacle& node) const {
    const auto found = shown_.find(subject_of(node));
    return found == shown_.end() ? nullptr : found->second;
  }

  bool shows(const Obstacle& node) const {
    return (node.name.empty() && &node != &root_) || shown_for(node) == &node;
  }

  void number(const Obstacle& node) {
    line_[&node] = ++numbered_;
    if (shows(node))
      for (const Obstacle& each : told(node).because) number(each);
  }

  std::string more_text(const Obstacle& node) const {
    if (shows(node) || told(node).because.empty()) return {};
    if (const Obstacle* const shown = shown_for(node)) return reference_text(line_.at(shown), line_.at(&node));
    return "… more: " + (node.bits.count == 0 ? question_(root_, true) : question_(node, false));
  }

  void add(const Obstacle& node, std::size_t depth) {
    lines_.push_back(std::string(2 * depth, ' ') + line_of(node, more_text(node)));
    if (shows(node))
      for (const Obstacle& each : told(node).because) add(each, depth + 1);
  }

  const Obstacle& root_;
  const FurtherQuestion& question_;
  std::map<std::uint32_t, const Obstacle*> told_{};
  std::map<Subject, const Obstacle*> shown_{};  // the node below which it stands
  std::map<const Obstacle*, std::size_t> line_{};
  std::size_t numbered_ = 0;
  std::vector<std::string> lines_{};
};

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

std::vector<std::string> few_lines_of(const Obstacle& obstacle, const FurtherQuestion& question) {
  std::vector<std::string> all = lines_of(obstacle);
  return all.size() <= kMostLines ? all : FewLines(obstacle, question).lines();
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
