#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "interpreter/base/text/text.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/choices.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/views/program/instruction_text.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct InstructionsOptions {
  CpuOptions cpu;
  std::vector<std::string> mnemonics;
  bool json = false, markdown = false;
};

nlohmann::ordered_json to_json(const Instruction& instruction, const TimeTable& times) {
  nlohmann::ordered_json operands = nlohmann::ordered_json::array();
  for (const OperandRule& rule : instruction.rules())
    operands.push_back({{"name", rule.name}, {"written", rule.role != Role::In}, {"takes", operand_text(rule)}});
  nlohmann::ordered_json json{{"mnemonic", instruction.mnemonic},
                              {"group", instruction.group},
                              {"syntax", syntax(instruction)},
                              {"meaning", instruction.meaning},
                              {"modelled", instruction.modelled()},
                              {"operands", operands},
                              {"needs_power_flow", instruction.rung.needs_power_flow},
                              {"flags", flags_text(instruction)},
                              {"allowed", parts_text(instruction)},
                              {"cpus", s7200::to_text(instruction.cpus)},
                              {"example", example(instruction)},
                              {"time_us", nullptr},
                              {"per_unit_us", nullptr},
                              {"time_marker", nullptr}};
  if (const TimeRow* row = typical_time(times, instruction)) {
    json["time_us"] = static_cast<double>(row->base) / kMicrosecond;
    json["per_unit_us"] = static_cast<double>(row->per_unit) / kMicrosecond;
    json["time_marker"] = row->marker;
  }
  return json;
}

void print_table(std::span<const Instruction> instructions, const TimeTable& times) {
  std::string_view group;
  for (const Instruction& instruction : instructions) {
    if (instruction.group != group) {
      group = instruction.group;
      fmt::print("\n{}\n", group);
    }
    if (!instruction.modelled()) {
      fmt::print("  {:<24} needs {}\n", instruction.mnemonic, s7200::to_text(instruction.cpus));
      continue;
    }
    const TimeRow* row = typical_time(times, instruction);
    print_report(
        fmt::format("  {:<24} {:>14} us  {}\n", syntax(instruction), row ? time_text(*row) : "-", instruction.meaning));
  }
}

int run_instructions(const InstructionsOptions& options) {
  const CpuModel* model = options.cpu.model();
  if (!model) return kUnusable;
  const auto times = options.cpu.times(*model);
  if (!times) return kUnusable;
  std::vector<Instruction> chosen;
  for (std::string mnemonic : options.mnemonics) {
    std::transform(mnemonic.begin(), mnemonic.end(), mnemonic.begin(), [](unsigned char c) { return std::toupper(c); });
    const Instruction* instruction = find_instruction(mnemonic);
    if (!instruction) {
      const auto [what, hint] = unknown_mnemonic(mnemonic);
      const std::string shown = stl::shortened(mnemonic);
      print_error((what.empty() ? fmt::format("unknown instruction '{}'", shown) : fmt::format("{} is {}", shown, what)) +
                  (hint.empty() ? "" : "; " + hint));
      return kUnusable;
    }
    chosen.push_back(*instruction);
  }
  if (options.markdown) {
    fmt::print("{}", reference_page());
  } else if (options.json) {
    auto results = results_of("instructions");
    results["cpu"] = model->name;
    auto& rows = results["instructions"] = nlohmann::ordered_json::array();
    for (const Instruction& instruction : chosen.empty() ? all_instructions() : std::span<const Instruction>(chosen))
      rows.push_back(to_json(instruction, *times));
    fmt::print("{}", lines_of(results));
  } else if (chosen.empty()) {
    fmt::print("Instructions of CPU {}. Times with power flow, operands in V memory; see `s7200 times`.\n", model->name);
    print_table(all_instructions(), *times);
  } else {
    for (const Instruction& instruction : chosen) print_report(explain(instruction, *times));
  }
  return kFine;
}

}  // namespace

void add_instructions(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<InstructionsOptions>();
  CLI::App* verb = app.add_subcommand("instructions", "the instruction table, or single instructions explained");
  std::vector<std::string> mnemonics;
  for (const Instruction& instruction : all_instructions()) mnemonics.emplace_back(instruction.mnemonic);
  offer(verb->add_option("MNEMONIC", options->mnemonics, "instructions to explain; all if none is given"), mnemonics);
  options->cpu.add_cpu_and_times_to(*verb, "CPU whose times are shown [214]");
  verb->add_flag("--json", options->json, "print as JSON");
  verb->add_flag("--markdown", options->markdown, "print the reference page")->excludes("--json");
  verb->footer("Example: s7200 instructions MOVW 'LDW>='");
  verb->callback([options, &exit_code] { exit_code = run_instructions(*options); });
}

}  // namespace s7200::tools
