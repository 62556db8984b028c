// faulted_frames [--program FILE] [--seed S] [--frames N]: a Modbus slave on a line with faults.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <exception>

#include "tests/faults/faulted_frames.hpp"
#include "tests/support/source_path.hpp"

int main(int argc, char** argv) {
  CLI::App app{"Sends frames with random faults to a Modbus slave and judges its answers by what reached its receiver"};
  std::string program = s7200::test::source_path("stl_programs/modbus_slave.stl");
  std::uint64_t seed = 1, frames = 1'000'000;
  app.add_option("--program", program, "STL file or document: a slave with station address 1")->capture_default_str();
  app.add_option("--seed", seed, "of the first block of frames; each further one adds 1")->capture_default_str();
  app.add_option("--frames", frames, "to send")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  try {
    const auto start = std::chrono::steady_clock::now();
    const auto result = s7200::faults::run_faulted_frames(s7200::faults::load_program(program), seed, frames);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    fmt::print("{}{:9.1f} s\n", to_text(result.counts), elapsed.count());
    for (const std::string& wrong : result.wrong) fmt::print("\n{}", wrong);
    return result.counts.wrong == 0 && result.counts.unanswered == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
