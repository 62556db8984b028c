// lockstep [--cpu 224] [--seed S] [--instructions N]: interpreter against reference model over random programs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>

#include "tests/reference_model/lockstep.hpp"

int main(int argc, char** argv) {
  CLI::App app{
      "Runs random programs on the interpreter and on the reference model and compares them after each instruction"};
  std::uint64_t seed = 1, instructions = 10'000'000;
  std::string cpu = "214";
  app.add_option("--cpu", cpu, "214 or 224")->capture_default_str()->check(CLI::IsMember({"214", "224"}));
  app.add_option("--seed", seed, "of the first program; each further one adds 1")->capture_default_str();
  app.add_option("--instructions", instructions, "to compare")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  const auto start = std::chrono::steady_clock::now();
  const auto result = s7200::reference::run_lockstep(seed, instructions, cpu);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  if (result.difference) {
    fmt::print("{}", *result.difference);
    return 1;
  }
  fmt::print("{} instructions of {} programs compared in {:.1f} s: no difference\n", result.instructions, result.programs,
             elapsed.count());
  for (const auto& [what, times] : result.met) fmt::print("{:>10}  {}\n", times, what);
}
