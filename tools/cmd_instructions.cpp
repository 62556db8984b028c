#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "tools/commands.hpp"
#include "tools/exit_code.hpp"
#include "tools/program_options.hpp"
#include "tools/terminal.hpp"

namespace s7200::tools {
namespace {

struct InstructionsOptions {
  CpuOptions cpu;
  std::vector<std::string> mnemonics;
  bool json = false;
};

std::string time_text(const TimeRow* row) {
  if (!row) return "-";
  return fmt::format("{}{}", in_microseconds(row->base),
                     row->per_unit ? fmt::format(" + {}/{}", in_microseconds(row->per_unit), row->unit) : "");
}

/// The line of the table of times for a plain operand; for bits, V memory stands for the slower areas.
const TimeRow* typical_time(const TimeTable& times, const Instruction& instruction) {
  for (const Area area : {Area::V, Area::Q, Area::I})
    if (const TimeRow* row = times.find(instruction.mnemonic, area)) return row;
  return nullptr;
}

std::string parts_text(const Instruction& instruction) {
  if (instruction.allowed == kAnywhere) return "anywhere";
  std::string text;
  const auto add = [&](Part part, std::string_view name) {
    if (instruction.allowed & part) text.append(text.empty() ? "" : ", ").append(name);
  };
  add(kMain, "main program");
  add(kSubroutine, "subroutines");
  add(kInterrupt, "interrupt routines");
  return text;
}

std::string flags_text(const Instruction& instruction) {
  std::string text;
  for (int bit = 0; bit < 8; ++bit)
    if (instruction.flags & (1 << bit)) text += fmt::format("{}SM1.{}", text.empty() ? "" : " ", bit);
  return text.empty() ? "none" : text;
}

std::string operand_text(const OperandRule& rule, const CpuModel& model) {
  if (rule.kind != OperandKind::Memory) return "a number";
  static constexpr std::string_view kLetter[] = {"", "B", "W", "D"};
  std::vector<std::string> names;
  for (const AreaInfo& area : all_areas()) {
    if (!contains(rule.areas, area.area) || model.size_of(area.area) == 0) continue;
    const bool plain = area.element != 0 || rule.width == Width::Bit;
    names.push_back(plain ? std::string(area.name)
                          : fmt::format("{}{}", area.name, kLetter[static_cast<std::size_t>(rule.width)]));
  }
  if (rule.constant) names.push_back(rule.real ? "real constant" : "constant");
  if (rule.pointer) names.push_back("*VD *AC");
  if (rule.address_of) names.push_back("&address");
  return fmt::format("{}", fmt::join(names, " "));
}

nlohmann::ordered_json to_json(const Instruction& instruction, const CpuModel& model, const TimeTable& times) {
  nlohmann::ordered_json operands = nlohmann::ordered_json::array();
  for (const OperandRule& rule : instruction.rules())
    operands.push_back({{"name", rule.name}, {"written", rule.role != Role::In}, {"takes", operand_text(rule, model)}});
  nlohmann::ordered_json json{{"mnemonic", instruction.mnemonic},
                              {"group", instruction.group},
                              {"syntax", syntax(instruction)},
                              {"meaning", instruction.meaning},
                              {"modelled", instruction.body != nullptr},
                              {"operands", operands},
                              {"needs_power_flow", instruction.needs_power_flow},
                              {"flags", flags_text(instruction)},
                              {"allowed", parts_text(instruction)},
                              {"cpus", to_text(instruction.cpus)}};
  if (const TimeRow* row = typical_time(times, instruction)) {
    json["time_us"] = static_cast<double>(row->base) / kMicrosecond;
    json["per_unit_us"] = static_cast<double>(row->per_unit) / kMicrosecond;
    json["time_marker"] = row->marker;
  }
  return json;
}

void print_one(const Instruction& instruction, const CpuModel& model, const TimeTable& times) {
  fmt::print("{}\n", syntax(instruction));
  if (!instruction.meaning.empty()) fmt::print("  {}\n", instruction.meaning);
  if (!instruction.body) {
    fmt::print("  not modelled yet; the real instruction needs {}\n", to_text(instruction.cpus));
    return;
  }
  for (const OperandRule& rule : instruction.rules())
    fmt::print("  {:<11} {}{}\n", rule.name, operand_text(rule, model), rule.role == Role::In ? "" : "   (written)");
  fmt::print("  power flow  {}\n",
             instruction.needs_power_flow ? "needed: skipped while the top of the logic stack is 0" : "not needed");
  fmt::print("  SM1 flags   {}\n  allowed in  {}\n  available   {}\n", flags_text(instruction), parts_text(instruction),
             to_text(instruction.cpus));
  for (const TimeRow& row : times.rows())
    if (std::find(row.mnemonics.begin(), row.mnemonics.end(), instruction.mnemonic) != row.mnemonics.end())
      fmt::print("  time        {} us {} ({})\n", time_text(&row), row.form, row.marker);
}

void print_table(std::span<const Instruction> instructions, const TimeTable& times) {
  std::string_view group;
  for (const Instruction& instruction : instructions) {
    if (instruction.group != group) {
      group = instruction.group;
      fmt::print("\n{}\n", group);
    }
    if (!instruction.body) {
      fmt::print("  {:<24} needs {}\n", instruction.mnemonic, to_text(instruction.cpus));
      continue;
    }
    fmt::print("  {:<24} {:>14} us  {}\n", syntax(instruction), time_text(typical_time(times, instruction)),
               instruction.meaning);
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
      const std::string_view nearest = nearest_mnemonic(mnemonic);
      print_error(fmt::format("unknown instruction '{}'{}", mnemonic,
                              nearest.empty() ? "" : fmt::format("; is {} meant?", nearest)));
      return kUnusable;
    }
    chosen.push_back(*instruction);
  }
  if (options.json) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const Instruction& instruction : chosen.empty() ? all_instructions() : std::span<const Instruction>(chosen))
      rows.push_back(to_json(instruction, *model, *times));
    fmt::print("{}\n", rows.dump(2));
  } else if (chosen.empty()) {
    fmt::print("Instructions of CPU {}. Times with power flow, operands in V memory; see `s7200 times`.\n", model->name);
    print_table(all_instructions(), *times);
  } else {
    for (const Instruction& instruction : chosen) print_one(instruction, *model, *times);
  }
  return kFine;
}

}  // namespace

void add_instructions(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<InstructionsOptions>();
  CLI::App* verb = app.add_subcommand("instructions", "the instruction table, or single instructions explained");
  verb->add_option("MNEMONIC", options->mnemonics, "instructions to explain; all if none is given");
  options->cpu.add_to(*verb);
  verb->add_flag("--json", options->json, "print as JSON");
  verb->footer("Example: s7200 instructions MOVW 'LDW>='");
  verb->callback([options, &exit_code] { exit_code = run_instructions(*options); });
}

}  // namespace s7200::tools
