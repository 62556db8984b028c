#include "interpreter/analysis/flow/calls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace s7200 {
namespace {

bool is_detach(const Op& op) {
  return op.instruction->structure != Structure::Attach && op.instruction->operand[0].kind == OperandKind::Event;
}

class Builder {
 public:
  Builder(const Program& program, const ControlFlow& flow) : program_(program), flow_(flow) {
    result_.nodes.resize(flow.routines.size());
  }

  Calls all() {
    for (const CallSite& site : flow_.calls) {
      const std::uint32_t caller = flow_.nodes[site.op].routine;
      result_.nodes[caller].calls.push_back(site);
      result_.nodes[site.routine].called.push_back({site.op, caller});
    }
    find_events();
    find_enabling();
    reach(0, &Calls::Node::by_main);
    for (std::uint32_t i = 0; i < result_.nodes.size(); ++i)
      if (!result_.nodes[i].events.empty()) reach(i, &Calls::Node::by_interrupt);
    for (std::uint32_t i = 0; i < result_.nodes.size(); ++i) measure(i);
    return std::move(result_);
  }

 private:
  void find_events() {
    std::map<std::uint8_t, EventUse> events;
    for (const Attachment& attachment : flow_.attachments) {
      if (!attachment.event) continue;
      EventUse& use = events[*attachment.event];
      use.attached.push_back(attachment);
      if (!attachment.routine) continue;
      auto& of_routine = result_.nodes[*attachment.routine].events;
      if (std::ranges::find(of_routine, *attachment.event) == of_routine.end()) of_routine.push_back(*attachment.event);
    }
    for (std::uint32_t op = 0; op < program_.ops.size(); ++op)
      if (is_detach(program_.ops[op]) && !program_.ops[op][0].unread())
        events[static_cast<std::uint8_t>(program_.ops[op][0].at)].detached.push_back(op);
    for (auto& [number, use] : events) {
      use.number = number;
      result_.events.push_back(std::move(use));
    }
    std::ranges::sort(result_.events, {}, [&](const EventUse& use) {
      const InterruptEvent* event = find_event(use.number);
      return event ? std::tuple(event->queue, event->order(program_.model->self), use.number)
                   : std::tuple(Queue::Timed, std::uint8_t{255}, use.number);
    });
  }

  void find_enabling() {
    for (std::uint32_t op = 0; op < program_.ops.size(); ++op) {
      if (program_.ops[op].instruction->effect == Effect::EnablesInterrupts) result_.enabling.push_back(op);
      if (program_.ops[op].instruction->mnemonic == "DISI") result_.disabling.push_back(op);
    }
  }

  void reach(std::uint32_t routine, bool Calls::Node::*by) {
    Calls::Node& node = result_.nodes[routine];
    if (std::exchange(node.*by, true)) return;
    for (const CallSite& site : node.calls) reach(site.routine, by);
  }

  /// Finds the depth of a routine and of all that it calls, and the circles.
  std::optional<std::uint32_t> measure(std::uint32_t routine) {
    const auto again = std::ranges::find(way_, routine);
    if (again != way_.end()) {
      add_circle({again, way_.end()});
      return {};
    }
    if (measured_.contains(routine)) return result_.nodes[routine].depth;
    way_.push_back(routine);
    std::optional<std::uint32_t> depth = 0;
    for (const CallSite& site : result_.nodes[routine].calls) {
      const auto below = measure(site.routine);
      depth = depth && below ? std::optional(std::max(*depth, *below + 1)) : std::nullopt;
    }
    way_.pop_back();
    measured_.emplace(routine, true);
    return result_.nodes[routine].depth = depth;
  }

  void add_circle(std::vector<std::uint32_t> circle) {
    std::rotate(circle.begin(), std::ranges::min_element(circle), circle.end());
    if (std::ranges::find(result_.recursions, circle) == result_.recursions.end()) result_.recursions.push_back(circle);
  }

  const Program& program_;
  const ControlFlow& flow_;
  std::vector<std::uint32_t> way_{};
  std::map<std::uint32_t, bool> measured_{};
  Calls result_{};
};

}  // namespace

Calls calls_of(const Program& program, const ControlFlow& flow) { return Builder(program, flow).all(); }

std::optional<std::string> why_never_executed(const ControlFlow& flow, const Calls& calls, std::uint32_t routine) {
  const Calls::Node& node = calls.nodes[routine];
  if (node.executed()) return {};
  const auto name = [&](std::uint32_t number) {
    const Routine& named = flow.routines[number];
    return fmt::format("{} {}", named.kind == Routine::Kind::Interrupt ? "INT" : "SBR", named.number);
  };
  if (flow.routines[routine].kind == Routine::Kind::Interrupt) return name(routine) + " is attached to no event";
  if (node.called.empty()) return name(routine) + " is never called";
  std::uint32_t root = routine;
  for (std::size_t level = 0; level < calls.nodes.size() && !calls.nodes[root].called.empty(); ++level)
    root = calls.nodes[root].called.front().routine;
  const auto why =
      root == routine || !calls.nodes[root].called.empty() ? std::nullopt : why_never_executed(flow, calls, root);
  return fmt::format("{} is called only by what is never executed{}", name(routine), why ? ": " + *why : "");
}

std::vector<std::uint32_t> last_way_to(const ControlFlow& flow, std::uint32_t op) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> last_call;  // by routine; of one that calls itself, empty
  const auto lead_to = [&](const auto& self, std::uint32_t routine) -> const std::vector<std::uint32_t>& {
    const auto [known, is_new] = last_call.try_emplace(routine);
    if (!is_new) return known->second;
    for (const CallSite& call : flow.calls) {
      if (call.routine != routine) continue;
      std::vector<std::uint32_t> way = self(self, flow.nodes[call.op].routine);
      way.push_back(call.op);
      if (way > last_call[routine]) last_call[routine] = std::move(way);
    }
    return last_call[routine];
  };
  std::vector<std::uint32_t> last = lead_to(lead_to, flow.nodes[op].routine);
  last.push_back(op);
  return last;
}

}  // namespace s7200
