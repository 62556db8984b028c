// A program from standard input, checked, run and asked over its port: prints the check, each answer, and every instruction.
// Whatever the system, compiler or processor, the bytes printed must be the same.
#include <fmt/format.h>
#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#endif

#include <cstdio>
#include <iostream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/program/loading/cpu_choice.hpp"
#include "interpreter/trace/text/text_trace.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/peers/quiet_time.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tools/views/program/check_report.hpp"
#include "tools/views/results_json.hpp"

namespace s7200 {
namespace {

/// How long a program may take to listen, and how much of its start is traced.
constexpr Time kLongestWait = 60 * kSecond, kTracedAtStart = 300 * kMillisecond;

std::string hex(const Bytes& bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format(" {:02X}", byte);
  return text;
}

class TracedRun {
 public:
  explicit TracedRun(std::shared_ptr<const Program> program)
      : simulation_(program), trace_(lines_, program, TraceDetail::Instructions) {
    simulation_.cpu().set_sink(&trace_);
    simulation_.power_up();
    simulation_.run_until(kTracedAtStart);
    simulation_.cpu().set_sink(nullptr);
    simulation_.run_until_ready([this] { return quiet(); }, kLongestWait);
    simulation_.configure_master(simulation_.freeport().format);
  }

  std::string ask(const Bytes& pdu) {
    simulation_.cpu().set_sink(&trace_);
    simulation_.master().start({.frame = serial::to_frame(modbus::rtu_frame(1, pdu))}, simulation_.time());
    const Bytes answer = simulation_.finish_exchange().response_bytes();
    simulation_.cpu().set_sink(nullptr);
    simulation_.run_until(simulation_.time() + quiet());
    return fmt::format("{} ns:{}\n", simulation_.time(), hex(answer));
  }

  std::string trace() const { return lines_.str(); }

 private:
  Time quiet() const { return serial::default_quiet(simulation_.freeport().format); }

  serial::Simulation simulation_;
  std::ostringstream lines_;
  TextTrace trace_;
};

int converse(const std::string& bytes) {
  const auto text = read_source(bytes, "program.stl");
  if (!text) return std::fprintf(stderr, "%s\n", text.why().c_str()), 1;
  const CpuModel* const named = cpu_in_head(text->parsed.source);
  const CpuModel& model = named ? *named : first_cpu_for(text->parsed);
  const CheckResult result = check(text->parsed, model, default_times(model));
  std::cout << tools::lines_of(tools::check_json("program.stl", *text, result, model, {}));
  if (!result.program) return 1;
  TracedRun run(result.program);
  const std::uint16_t values[] = {0x1234, 0xFFFF};
  for (const Bytes& pdu :
       {modbus::read_holding_registers(0, 10), modbus::write_registers(3, values), modbus::read_holding_registers(3, 2),
        modbus::write_coil(2, true), modbus::read_holding_registers(9'999, 1)})
    std::cout << run.ask(pdu);
  std::cout << run.trace();
  return 0;
}

}  // namespace
}  // namespace s7200

int main() {
#ifdef _WIN32
  for (std::FILE* const stream : {stdin, stdout}) _setmode(_fileno(stream), _O_BINARY);  // otherwise line ends would change
#endif
  const std::string bytes{std::istreambuf_iterator(std::cin), {}};
  return s7200::converse(bytes);
}
