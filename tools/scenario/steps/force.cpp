// force, unforce: points and memory that hold a value.
#include "interpreter/cpu/units/forcing.hpp"
#include "tools/scenario/reading/memory_values.hpp"
#include "tools/scenario/run.hpp"
#include "tools/scenario/steps/steps.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"

namespace s7200::tools {
namespace {

/// A programming device does not reach a PLC without power. False after a finding.
bool reaches_it(Run& run, const std::string& what) {
  if (run.plant()->has_power()) return true;
  run.add({.what = what, .expected = "a PLC with power", .found = "it has none: nothing was done", .of_run = true});
  return false;
}

struct ForceStep final : StepAction {
  std::vector<Assignment> assignments{};

  Needs needs() const override { return Needs::ToChange; }

  void act(Run& run) const override {
    if (!reaches_it(run, "force")) return;
    for (const Assignment& assignment : assignments) {
      run.plant()->note(Force{{assignment}});
      if (run.plant()->cpu().force(assignment.place, assignment.value)) continue;
      run.add({.what = "force",
               .expected = "room for " + assignment.place.name_of(0),
               .found = "as many values are forced already as the CPU can",
               .of_run = true});
    }
  }

  bool write(TranscriptWriter& writer) const override {
    writer.step("force: " + assignments_text(assignments));
    return true;
  }
};

struct UnforceStep final : StepAction {
  std::vector<MemoryRange> places{};  ///< none: all that is forced

  Needs needs() const override { return Needs::ToChange; }

  void act(Run& run) const override {
    if (!reaches_it(run, "unforce")) return;
    std::vector<MemoryRange> released = places;
    if (released.empty())
      for (const Assignment& forced : forcing::listed(run.plant()->cpu().state().forcing)) released.push_back(forced.place);
    run.plant()->act(Unforce{released});
  }

  bool write(TranscriptWriter& writer) const override {
    writer.step("unforce: " + unforce_text(places));
    return true;
  }
};

std::optional<MemoryRange> read_place_of(ValueReader& values, const YamlNode& node, const AddressSpace& space) {
  const auto written = values.text(node);
  if (!written) return {};
  auto place = parse_range(*written, space);
  if (!place) values.wrong(node, place.why());
  return place.if_any();
}

}  // namespace

std::shared_ptr<const StepAction> read_force(const StepSource& source) {
  auto step = std::make_shared<ForceStep>();
  if (source.is.is_map() && source.is.keys.empty())
    source.values.wrong(source.is, "nothing to force", "write for example {VW20: 16#1234, I0.3: 1}");
  step->assignments = read_assignments(source.values, source.is, source.addresses());
  for (const Assignment& assignment : step->assignments)
    if (!forcing::possible(assignment.place))
      source.values.wrong(source.is, fmt::format("{} cannot be forced", assignment.place.name_of(0)),
                          "points of I and Q can, and bytes, words and double words of V and M, and words of AI and AQ");
  return step;
}

std::shared_ptr<const StepAction> read_unforce(const StepSource& source) {
  auto step = std::make_shared<UnforceStep>();
  const YamlNode& is = source.is;
  const bool all = is.is_scalar() && stl::lower_case(source.values.text(is).value_or("")) == "all";
  if (!all && (!is.is_list() || is.items.empty()))
    source.values.wrong(is, "what is released is a list", "write for example [VW20, I0.3], or all");
  if (!is.is_list()) return step;
  for (const YamlNode& item : is.items)
    if (const auto place = read_place_of(source.values, item, source.addresses())) step->places.push_back(*place);
  return step;
}

}  // namespace s7200::tools
