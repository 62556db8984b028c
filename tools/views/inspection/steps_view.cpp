#include "tools/views/inspection/steps_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/flow/calls.hpp"
#include "interpreter/analysis/rung_text.hpp"
#include "interpreter/analysis/steps.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/contact_form.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200::tools {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view kNone = "The program has no steps: no LSCR and no SCRT";

class StepsView {
 public:
  explicit StepsView(const Inspection& inspection)
      : inspection_(inspection),
        calls_(calls_of(*inspection.program, inspection.facts.flow)),
        ways_(inspection.facts, {[](std::uint32_t) { return false; }, [](std::uint32_t) { return true; }}),
        rungs_(ways_, [&](std::uint32_t op, std::size_t operand) { return operand_text(op, operand); }) {
    for (Step& step : steps_of(inspection.facts))
      if (is_wanted(step)) steps_.push_back(std::move(step));
  }

  std::string text() const {
    if (steps_.empty()) return std::string(kNone) + "\n";
    return stl::joined(
        steps_, [&](const Step& step) { return of_step(step); }, "\n");
  }

  ordered_json json() const {
    ordered_json all = ordered_json::array();
    for (const Step& step : steps_) all.push_back(json_of(step));
    return all;
  }

 private:
  bool is_wanted(const Step& step) const {
    const Selection& selection = inspection_.selection;
    std::vector<std::uint32_t> ops = step.switched_on;
    if (step.segment) ops.push_back(*step.segment);
    return selection.wants_memory({step.bit}) && selection.wants_ops(ops);
  }

  std::string operand_text(std::uint32_t op, std::size_t operand) const {
    const auto& operands = inspection_.program->statement(op).operands;
    return operand < operands.size() ? stl::printable(stl::to_text(operands[operand])) : "";
  }

  std::vector<std::string> symbols_of(const Bits& bit) const {
    std::vector<std::string> names;
    for (const stl::Symbol& symbol : inspection_.program->source.symbols)
      if (const auto of = bits_of(*inspection_.program, symbol); of && *of == bit)
        names.push_back(stl::printable(symbol.name));
    return names;
  }

  // --- text ---

  std::string of_step(const Step& step) const {
    std::string head = memory_text(step.bit);
    for (const std::string& name : symbols_of(step.bit)) head += fmt::format(" \"{}\"", name);
    head += step.segment ? fmt::format(": {}", place_in_words(inspection_, *step.segment)) : ": it has no segment (LSCR)";
    std::string text = wrapped_at(head, 2) + "\n";
    if (const auto never = step.segment ? never_executed(*step.segment) : std::nullopt) text += row("never runs", *never);
    text += step.switched_on.empty() ? row("switched on", "by nothing that is known")
                                     : with_conditions("switched on", step.switched_on);
    text += of_transitions(step);
    text += with_conditions("switched off", step.switched_off) + with_conditions("written", step.written);
    text += with_conditions("does", step.actions, true);
    if (!step.looked_at.empty()) text += row("looked at", places(step.looked_at));
    return text;
  }

  std::string of_transitions(const Step& step) const {
    if (step.transitions.empty()) return step.segment ? row("leads to", "no other step") : "";
    std::string text;
    for (const std::uint32_t op : step.transitions)
      text += row_with_condition(text.empty() ? "leads to" : "",
                                 fmt::format("{} ({})", memory_text(target_of_transition(inspection_.program->ops[op])),
                                             line_text(inspection_, op)),
                                 op, true);
    return text;
  }

  std::string with_conditions(std::string_view what, const std::vector<std::uint32_t>& ops, bool own = false) const {
    std::string text;
    for (const std::uint32_t op : ops)
      text +=
          row_with_condition(text.empty() ? what : "",
                             fmt::format("{} ({})", instruction_text(inspection_, op), line_text(inspection_, op)), op, own);
    return text;
  }

  /// `own`: it is part of the segment of the step, which has said why it never runs.
  std::string row_with_condition(std::string_view what, const std::string& text, std::uint32_t op, bool own) const {
    const std::string condition = rungs_.of(op, 0);
    std::string all = condition == "always" ? text : fmt::format("{} if {}", text, condition);
    const auto never = own ? std::nullopt : never_executed(op);
    if (never) all += "; but " + *never;
    for (const std::string& unmet : never_met(op)) all += "; but " + unmet;
    return row(what, all);
  }

  std::optional<std::string> never_executed(std::uint32_t op) const {
    const ControlFlow& flow = inspection_.facts.flow;
    return why_never_executed(flow, calls_, flow.nodes[op].routine);
  }

  /// The timers and counters that a condition waits for and whose boxes are all in routines that are never executed.
  std::vector<std::string> never_met(std::uint32_t op) const {
    std::vector<std::string> all;
    for (const NetworkLogic::Contact& contact : ways_.rung_of(op).logic.contacts) {
      if (!contact.statement) continue;
      const Op& look = inspection_.program->ops[ways_.op_of(contact)];
      const auto never =
          contact_form(*look.instruction).kind == ContactForm::Kind::Bit ? never_counts(look[0]) : std::nullopt;
      if (never && std::ranges::find(all, *never) == all.end()) all.push_back(*never);
    }
    return all;
  }

  std::optional<std::string> never_counts(const Operand& contact) const {
    const Bits bit{std::uint64_t{contact.at} * 8 + contact.bit, 1};
    if (contact.pointer || bit.first < image::kTBits * 8u || bit.first >= image::kInputs * 8u) return {};
    std::optional<std::string> why;
    const auto& effects = inspection_.facts.effects;
    for (std::uint32_t op = 0; op < effects.size(); ++op) {
      const bool counts = inspection_.program->ops[op].instruction->hidden == Hidden::Number;
      const bool of_it = std::ranges::any_of(effects[op], [&](const MemoryAccess& access) {
        return access.writes() && !access.by_pointer && access.bits.overlaps(bit);
      });
      if (!counts || !of_it) continue;
      const auto never = never_executed(op);
      if (!never) return {};
      why = fmt::format("{} never counts: {}", memory_text(as_named(bit)), *never);
    }
    return why;
  }

  static std::string row(std::string_view what, const std::string& text) {
    return "  " + column(std::string(what), 14) + wrapped_at(text, 18, 16) + "\n";
  }

  std::string places(const std::vector<std::uint32_t>& ops) const {
    return stl::joined(ops, [&](std::uint32_t op) {
      return fmt::format("{} ({})", instruction_text(inspection_, op), line_text(inspection_, op));
    });
  }

  // --- JSON ---

  ordered_json conditions_json(const std::vector<std::uint32_t>& ops) const {
    ordered_json all = ordered_json::array();
    for (const std::uint32_t op : ops)
      all.push_back({{"condition", rungs_.of(op, 0)}, {"place", place_json(inspection_, op)}});
    return all;
  }

  ordered_json json_of(const Step& step) const {
    ordered_json json{{"step", memory_text(step.bit)}, {"symbols", symbols_of(step.bit)}};
    json["segment"] = step.segment ? place_json(inspection_, *step.segment) : ordered_json();
    const auto never = step.segment ? never_executed(*step.segment) : std::nullopt;
    json["never_runs"] = never ? ordered_json(*never) : ordered_json();
    json["switched_on"] = conditions_json(step.switched_on);
    json["transitions"] = conditions_json(step.transitions);
    for (std::size_t i = 0; i < step.transitions.size(); ++i)
      json["transitions"][i]["to"] = memory_text(target_of_transition(inspection_.program->ops[step.transitions[i]]));
    json["switched_off"] = conditions_json(step.switched_off);
    json["written"] = conditions_json(step.written);
    json["actions"] = conditions_json(step.actions);
    json["looked_at"] = ordered_json::array();
    for (const std::uint32_t op : step.looked_at) json["looked_at"].push_back(place_json(inspection_, op));
    return json;
  }

  const Inspection& inspection_;
  Calls calls_;
  Ways ways_;
  RungText rungs_;
  std::vector<Step> steps_{};
};

}  // namespace

std::string steps_text(const Inspection& inspection) { return StepsView(inspection).text(); }

ordered_json steps_json(const Inspection& inspection) { return StepsView(inspection).json(); }

}  // namespace s7200::tools
