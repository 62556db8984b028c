// The kinds of steps. To add one: a file in this folder, its function here, and its row in steps.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "interpreter/model/cpu_model.hpp"
#include "tools/scenario/action.hpp"
#include "tools/scenario/reading/value_reader.hpp"
#include "tools/scenario/scenario.hpp"

namespace s7200::tools {

/// What a step is read from.
struct StepSource {
  ValueReader& values;
  const YamlNode& node;      ///< all of it
  const YamlNode& is;        ///< what stands at its key
  const Scenario& scenario;  ///< its head
  const Step& step;          ///< the same as far as it is known: what it is about

  /// What stands beside its key; null if it does not.
  const YamlNode* beside(std::string_view key) const { return node.find(key); }

  /// In a system, the program of the PLC it is about; null if it is about none.
  const Program* program() const { return step.spot ? scenario.plan->plcs[step.spot->plc].program.get() : nullptr; }
  AddressSpace addresses() const { return program() ? AddressSpace(*program()) : scenario.addresses(); }
};

/// Complains about what is wrong; the action is not run then.
using ReadStep = std::shared_ptr<const StepAction>(const StepSource& source);

ReadStep read_send, read_request, read_read, read_write, read_receive, read_wait, read_wait_until, read_set, read_force,
    read_unforce, read_set_mode, read_memory, read_interrupts, read_mode, read_fatal, read_errors, read_fault,
    read_power_cycle, read_event_of_system;

struct StepKind {
  /// Whether, in a system, it is about one PLC and its line.
  enum class Of : std::uint8_t { Plc, Either, System };

  std::string_view key;
  ReadStep* read;
  std::string_view form, meaning;  ///< for the description of the format
  Of of = Of::Plc;
};
std::span<const StepKind> step_kinds();

}  // namespace s7200::tools
