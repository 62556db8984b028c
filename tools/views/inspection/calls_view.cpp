#include "tools/views/inspection/calls_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <vector>

#include "interpreter/analysis/flow/calls.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/joined.hpp"

namespace s7200::tools {
namespace {

using nlohmann::ordered_json;

std::string_view name_of(Queue queue) {
  return queue == Queue::Communication ? "communication" : queue == Queue::Io ? "I/O" : "timed";
}

std::string cause_of(std::uint8_t number) {
  const InterruptEvent* event = find_event(number);
  return event ? std::string(event->cause) : "no event of this family";
}

class CallsText {
 public:
  explicit CallsText(const Inspection& inspection)
      : inspection_(inspection), flow_(inspection.facts.flow), calls_(calls_of(*inspection.program, flow_)) {}

  std::string all() {
    if (!inspection_.selection.everything()) return of_selection();
    std::string text = tree(0, 0) + depth_text(0, inspection_.program->model->call_depth);
    text += events() + enabling();
    return text + interrupts() + never() + recursions();
  }

 private:
  std::string name(std::uint32_t routine) const { return routine_in_words(inspection_, flow_.routines[routine]); }

  /// A routine and what it calls. What it calls is shown the first time only.
  std::string tree(std::uint32_t routine, std::size_t depth) {
    const Calls::Node& node = calls_.nodes[routine];
    const bool again = !shown_.insert(routine).second;
    std::string text = std::string(2 * depth, ' ') + name(routine);
    if (again && !node.calls.empty()) text += "  (as above)";
    text += "\n";
    if (again) return text;
    std::set<std::uint32_t> called;
    for (const CallSite& site : node.calls)
      if (called.insert(site.routine).second) text += with_places(tree(site.routine, depth + 1), routine, site.routine);
    return text;
  }

  /// The first line of a tree, with the places where its routine is called.
  std::string with_places(const std::string& tree, std::uint32_t caller, std::uint32_t callee) const {
    std::vector<std::string> places;
    for (const CallSite& site : calls_.nodes[caller].calls)
      if (site.routine == callee) places.push_back(line_text(inspection_, site.op));
    const std::size_t end = tree.find('\n');
    const std::string head = column(tree.substr(0, end), 40);
    return head + wrapped_at(stl::joined(places, [](const std::string& place) { return place; }), 40, head.size()) +
           tree.substr(end);
  }

  std::string depth_text(std::uint32_t routine, std::uint32_t most) const {
    const auto depth = calls_.nodes[routine].depth;
    if (!depth) return "Deepest nesting: unknown, there is recursion\n";
    if (*depth == 0) return {};
    return fmt::format("Deepest nesting: {} of {} calls: {}\n", *depth, most, wrapped_at(deepest_way(routine), 4, 40));
  }

  std::string deepest_way(std::uint32_t routine) const {
    std::string way = routine_text(flow_.routines[routine]);
    while (calls_.nodes[routine].depth.value_or(0) > 0) {
      const auto& calls = calls_.nodes[routine].calls;
      routine = std::ranges::max_element(calls, {}, [&](const CallSite& site) {
                  return calls_.nodes[site.routine].depth.value_or(0);
                })->routine;
      way += " > " + routine_text(flow_.routines[routine]);
    }
    return way;
  }

  std::string events() const {
    if (calls_.events.empty()) return {};
    std::string text = "\nInterrupts, in the order in which the CPU serves events that wait\n";
    for (const EventUse& use : calls_.events) text += event(use);
    return text;
  }

  std::string event(const EventUse& use) const {
    const InterruptEvent* event = find_event(use.number);
    std::string text = fmt::format("event {}: {}", use.number, cause_of(use.number));
    if (event) text += fmt::format(" ({} queue)", name_of(event->queue));
    text += "\n";
    for (const Attachment& attachment : use.attached)
      text +=
          row_text(inspection_,
                   "  attaches " + column(attachment.routine ? routine_text(flow_.routines[*attachment.routine]) : "?", 9),
                   attachment.op);
    for (const std::uint32_t op : use.detached) text += row_text(inspection_, "  detaches          ", op);
    return text;
  }

  std::string enabling() const {
    std::string text;
    for (const std::uint32_t op : calls_.enabling) text += row_text(inspection_, "  enabled           ", op);
    for (const std::uint32_t op : calls_.disabling) text += row_text(inspection_, "  disabled          ", op);
    if (text.empty() && !calls_.events.empty()) return "No instruction enables interrupts: none is served\n";
    return text.empty() ? text : "All interrupts\n" + text;
  }

  /// What interrupt routines call.
  std::string interrupts() {
    std::string text;
    for (std::uint32_t i = 0; i < flow_.routines.size(); ++i)
      if (!calls_.nodes[i].events.empty() && !calls_.nodes[i].calls.empty())
        text += "\n" + tree(i, 0) + depth_text(i, inspection_.program->model->interrupt_call_depth);
    return text;
  }

  std::string never() const {
    std::string text;
    for (std::uint32_t i = 1; i < flow_.routines.size(); ++i)
      if (!calls_.nodes[i].executed()) text += fmt::format("  {}, {}\n", name(i), reason(i));
    return text.empty() ? text : "\nNever executed\n" + text;
  }

  std::string reason(std::uint32_t routine) const {
    const Routine& what = flow_.routines[routine];
    const std::string place = line_text(inspection_, what.first);
    if (what.kind == Routine::Kind::Interrupt) return place + ": no ATCH attaches it";
    if (calls_.nodes[routine].called.empty()) return place + ": no CALL calls it";
    return fmt::format("{}: called only by {}, never executed itself", place,
                       stl::joined(calls_.nodes[routine].called,
                                   [&](const CallSite& site) { return routine_text(flow_.routines[site.routine]); }));
  }

  std::string recursions() const {
    std::string text;
    for (const auto& circle : calls_.recursions) {
      text += "  ";
      for (const std::uint32_t routine : circle) text += routine_text(flow_.routines[routine]) + " > ";
      text += routine_text(flow_.routines[circle.front()]) + "\n";
    }
    return text.empty() ? text : "\nRecursion\n" + text;
  }

  std::string of_selection() {
    std::string text;
    for (std::uint32_t i = 0; i < flow_.routines.size(); ++i) {
      const Routine& routine = flow_.routines[i];
      const bool asked = std::ranges::any_of(inspection_.selection.ops, [&](const Selection::Ops& each) {
        return each.first < routine.end && routine.first < each.end;
      });
      if (!asked) continue;
      shown_.clear();
      text += tree(i, 0);
      for (const CallSite& site : calls_.nodes[i].called) text += row_text(inspection_, "  called by ", site.op);
      for (const EventUse& use : calls_.events)
        for (const Attachment& attachment : use.attached)
          if (attachment.routine == i) text += event(use);
      if (i != 0 && !calls_.nodes[i].executed()) text += fmt::format("  never executed: {}\n", reason(i));
    }
    return text;
  }

  const Inspection& inspection_;
  const ControlFlow& flow_;
  Calls calls_;
  std::set<std::uint32_t> shown_{};
};

ordered_json places_json(const Inspection& inspection, const std::vector<std::uint32_t>& ops) {
  ordered_json all = ordered_json::array();
  for (const std::uint32_t op : ops) all.push_back(place_json(inspection, op));
  return all;
}

ordered_json routine_json(const Inspection& inspection, const Calls& calls, std::uint32_t i) {
  const Routine& routine = inspection.facts.flow.routines[i];
  const stl::Block* block = block_of(*inspection.program, routine);
  ordered_json json{{"routine", routine_text(routine)}, {"name", block ? block->name : ""}};
  json["place"] = place_json(inspection, routine.first);
  json["instructions"] = routine.end - routine.first;
  json["executed"] = calls.nodes[i].executed();
  json["depth"] = calls.nodes[i].depth ? ordered_json(*calls.nodes[i].depth) : ordered_json();
  json["events"] = calls.nodes[i].events;
  json["calls"] = ordered_json::array();
  for (const CallSite& site : calls.nodes[i].calls)
    json["calls"].push_back(
        {{"to", routine_text(inspection.facts.flow.routines[site.routine])}, {"place", place_json(inspection, site.op)}});
  return json;
}

ordered_json event_json(const Inspection& inspection, const EventUse& use) {
  const InterruptEvent* event = find_event(use.number);
  ordered_json json{{"event", use.number}, {"cause", cause_of(use.number)}};
  json["queue"] = event ? name_of(event->queue) : "";
  json["attached"] = ordered_json::array();
  for (const Attachment& each : use.attached) {
    ordered_json attached;
    attached["to"] =
        each.routine ? ordered_json(routine_text(inspection.facts.flow.routines[*each.routine])) : ordered_json();
    attached["place"] = place_json(inspection, each.op);
    json["attached"].push_back(std::move(attached));
  }
  json["detached"] = places_json(inspection, use.detached);
  return json;
}

}  // namespace

std::string calls_text(const Inspection& inspection) { return CallsText(inspection).all(); }

ordered_json calls_json(const Inspection& inspection) {
  const Calls calls = calls_of(*inspection.program, inspection.facts.flow);
  ordered_json json{{"call_depth", inspection.program->model->call_depth}, {"routines", ordered_json::array()}};
  for (std::uint32_t i = 0; i < calls.nodes.size(); ++i) json["routines"].push_back(routine_json(inspection, calls, i));
  json["events"] = ordered_json::array();
  for (const EventUse& use : calls.events) json["events"].push_back(event_json(inspection, use));
  json["enabled"] = places_json(inspection, calls.enabling);
  json["disabled"] = places_json(inspection, calls.disabling);
  json["recursions"] = ordered_json::array();
  for (const auto& circle : calls.recursions) {
    ordered_json names = ordered_json::array();
    for (const std::uint32_t routine : circle) names.push_back(routine_text(inspection.facts.flow.routines[routine]));
    json["recursions"].push_back(std::move(names));
  }
  return json;
}

}  // namespace s7200::tools
