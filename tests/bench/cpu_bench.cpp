// What the interpreter costs: instructions a second of the host, for our slave program and for each family of instructions.
#include <benchmark/benchmark.h>

#include <stdexcept>

#include "interpreter/analysis/warnings/check.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/peers/quiet_time.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tests/support/source_path.hpp"
#include "tools/host/files/files.hpp"
#include "tools/measuring/mixed_program.hpp"

namespace s7200 {
namespace {

std::shared_ptr<const Program> load(std::string_view text, const CpuModel& model = cpu214()) {
  CheckResult result = check_text(text, "bench.stl", model, default_times(model));
  if (!result.program) throw std::logic_error(stl::render(result.diagnostics.front(), result.source, false));
  return result.program;
}

const std::shared_ptr<const Program>& slave() {
  static const auto kSlave = [] {
    const auto text = tools::read_file(test::source_path("stl_programs/modbus_slave.stl"));
    if (!text) throw std::runtime_error(text.why());
    return load(*text);
  }();
  return kSlave;
}

void count_instructions(benchmark::State& bench, const serial::Simulation& simulation, std::uint64_t before) {
  bench.SetItemsProcessed(static_cast<std::int64_t>(simulation.cpu().state().instructions - before));
}

void first_scan(benchmark::State& bench) {
  serial::Simulation simulation(slave());
  simulation.cpu().pause_at_scan_end(true);
  std::int64_t instructions = 0;
  for (auto _ : bench) {
    simulation.power_up();
    simulation.run_until(10 * kSecond);
    instructions += static_cast<std::int64_t>(simulation.cpu().state().instructions);
  }
  bench.SetItemsProcessed(instructions);
}
BENCHMARK(first_scan);

void idle_scans(benchmark::State& bench) {
  serial::Simulation simulation(slave());
  simulation.cpu().use_steady_scans(SteadyScansUse::Off);
  simulation.power_up();
  simulation.run_until(kSecond);
  const std::uint64_t before = simulation.cpu().state().instructions;
  for (auto _ : bench) simulation.run_until(simulation.time() + 100 * kMillisecond);
  count_instructions(bench, simulation, before);
}
BENCHMARK(idle_scans);

/// Ten registers again and again; items are instructions.
void serving(benchmark::State& bench) {
  const serial::Frame request = serial::to_frame(modbus::rtu_frame(1, modbus::read_holding_registers(0, 10)));
  serial::Simulation simulation(slave());
  simulation.power_up();
  simulation.run_until_ready(serial::default_quiet({}), 60 * kSecond);
  const SerialFormat format = simulation.cpu().state().port[0].format;
  simulation.configure_master(format);
  const std::uint64_t before = simulation.cpu().state().instructions;
  for (auto _ : bench) {
    simulation.master().start({.frame = request}, simulation.time());
    if (simulation.finish_exchange().timed_out) {
      bench.SkipWithError("no answer");
      break;
    }
    simulation.run_until(simulation.time() + serial::default_quiet(format));
  }
  count_instructions(bench, simulation, before);
}
BENCHMARK(serving);

/// A main program that has one statement 400 times.
void statement(benchmark::State& bench, const char* text) {
  std::string program = "LD SM0.0\nMOVD &VB100, VD0\nMOVW 1, VW4\n";
  for (int i = 0; i < 400; ++i) program.append(text).append("\n");
  serial::Simulation simulation(load(program.append("MEND\n")));
  simulation.cpu().use_steady_scans(SteadyScansUse::Off);
  simulation.power_up();
  const std::uint64_t before = simulation.cpu().state().instructions;
  for (auto _ : bench) simulation.run_until(simulation.time() + 100 * kMillisecond);
  count_instructions(bench, simulation, before);
}
BENCHMARK_CAPTURE(statement, contact, "A M0.0");
BENCHMARK_CAPTURE(statement, coil, "= M0.1");
BENCHMARK_CAPTURE(statement, set_bits, "S M1.0, 8");
BENCHMARK_CAPTURE(statement, compare_words, "AW>= VW4, 0");
BENCHMARK_CAPTURE(statement, move_word, "MOVW VW4, VW6");
BENCHMARK_CAPTURE(statement, move_through_pointer, "MOVW *VD0, VW6");
BENCHMARK_CAPTURE(statement, move_without_power_flow, "AN SM0.0\nMOVW VW4, VW6");
BENCHMARK_CAPTURE(statement, move_block, "BMB VB100, VB200, 50");
BENCHMARK_CAPTURE(statement, add, "+I VW4, VW8");
BENCHMARK_CAPTURE(statement, divide, "DIV VW4, VD12");
BENCHMARK_CAPTURE(statement, combine_words, "XORW VW4, VW8");
BENCHMARK_CAPTURE(statement, shift, "SLW VW8, 3");

/// A program of so many instructions, scan after scan, in an input image that changes now and then.
void mixed(benchmark::State& bench) {
  serial::Simulation simulation(load(tools::mixed_program(static_cast<std::uint32_t>(bench.range(0))), *find_cpu("226XM")));
  simulation.cpu().use_steady_scans(SteadyScansUse::Off);
  simulation.power_up();
  const std::uint64_t before = simulation.cpu().state().instructions;
  std::uint8_t inputs = 0;
  for (auto _ : bench) {
    simulation.cpu().set_input(0, ++inputs, simulation.time());
    simulation.run_until(simulation.time() + 100 * kMillisecond);
  }
  count_instructions(bench, simulation, before);
}
BENCHMARK(mixed)->Arg(340)->Arg(1900)->Arg(4000);

}  // namespace
}  // namespace s7200
