#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/inspecting/inspected_program.hpp"
#include "tools/command/inspecting/memory_picture.hpp"
#include "tools/command/inspecting/why_request.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/options/plc/stand_in_options.hpp"
#include "tools/command/options/plc/tables_by_cpu.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/session/causes/why_not.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct WhyOptions {
  CpuOptions cpu;
  std::vector<std::string> words, set;
  std::string memory;
  bool json = false;
};

std::string further_question(const WhyRequest& question, const Obstacle& node, bool is_root) {
  if (is_root) return fmt::format("s7200 why … {}{} all", stl::printable(question.about), question.not_so ? " not" : "");
  return fmt::format("s7200 why … {}", memory_text(as_named(node.bits)));
}

void add_nodes(const Obstacle& obstacle, std::size_t depth, nlohmann::ordered_json& nodes) {
  nlohmann::ordered_json node = to_json(obstacle);
  node.erase("because");
  node.erase("op");
  nlohmann::ordered_json all{{"depth", depth}};
  all.update(node);
  nodes.push_back(std::move(all));
  for (const Obstacle& each : obstacle.because) add_nodes(each, depth + 1, nodes);
}

int run_why(const WhyOptions& options) {
  const WhyRequest question = why_request(options.words);
  if (question.about.empty())
    return print_error("an address is missing after PROGRAM, for example: s7200 why pump.awl Q0.0"), kUnusable;
  int exit_code = kFine;
  auto programs = read_programs(question.paths, exit_code);
  if (exit_code != kFine || !options.cpu.model()) return kUnusable;
  if (programs.size() != 1) return print_error("why takes one program, with its symbol tables and data blocks"), kUnusable;
  TablesByCpu tables(options.cpu);
  const auto program = known_program(options.cpu, programs.front(), tables, exit_code);
  if (!program || exit_code != kFine) return exit_code;
  const auto wish = parse_wish(question.about, *program);
  if (!wish) return print_error(wish.why()), kUnusable;
  const auto simulation = pictured(program, options.memory, options.set);
  if (!simulation) return kUnusable;
  const Cpu& cpu = simulation->cpu();
  const auto holds = holds_now(*wish, cpu);
  if (!holds) return print_error(fmt::format("{}: {}", stl::printable(question.about), holds.why())), kUnusable;
  const bool nothing_to_say = question.not_so && *holds;
  const Obstacle answer = question.not_so ? why_not(cpu, *wish) : what_keeps(cpu, *wish);
  const auto further = [&](const Obstacle& node, bool is_root) { return further_question(question, node, is_root); };
  if (!options.json) {
    if (nothing_to_say)
      fmt::print("{} holds now\n", stl::printable(wish->text));
    else
      fmt::print("{}\n", fmt::join(question.all ? lines_of(answer) : few_lines_of(answer, further), "\n"));
    return kFine;
  }
  auto results = results_of("why");
  results["file"] = programs.front().path;
  results["cpu"] = program->model->name;
  results["about"] = stl::printable(wish->text);
  results["not"] = question.not_so;
  results["holds"] = *holds;
  results["answer"] = nlohmann::ordered_json::array();
  if (!nothing_to_say) add_nodes(answer, 0, results["answer"]);
  fmt::print("{}", lines_of(results));
  return kFine;
}

}  // namespace

void add_why(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<WhyOptions>();
  CLI::App* verb = app.add_subcommand("why", "which contacts hold an output, from a picture of memory");
  verb->add_option("PROGRAM", options->words,
                   "an STL file with its symbol table and data block, then an address or a condition, not and all; not asks "
                   "what keeps it from being so, all is for long answers")
      ->required();
  verb->add_option("--memory", options->memory, "what the CPU has kept, as 'run --memory' writes it [a first scan]")
      ->type_name("FILE.json")
      ->group(help_group::kMemory);
  verb->add_option("--set", options->set, "an input or memory besides: I0.0=1, VW10=5")
      ->type_name("ADDRESS=VALUE")
      ->group(help_group::kMemory);
  options->cpu.add_cpu_and_times_to(*verb, fmt::format("CPU that it is to run on {}", kCpuFound));
  add_repair_option(*verb, options->cpu.repairs);
  add_no_stand_ins_option(*verb, options->cpu.no_stand_ins);
  verb->add_flag("--json", options->json, "print the results as JSON")->group(help_group::kResults);
  verb->footer(
      "In a run 's7200 debug' answers the same with times: why, why not, until.\n"
      "Topics: models, programs, times\n"
      "Example: s7200 why stl_programs/modbus_slave.stl Q0.0 not");
  verb->callback([options, &exit_code] { exit_code = run_why(*options); });
}

}  // namespace s7200::tools
