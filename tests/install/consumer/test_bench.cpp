// A plant's own test bench: runs a scenario on a program, and talks to the program behind a pty as any master would.
#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <future>
#include <string>
#include <thread>

#include "interpreter/analysis/warnings/check.hpp"
#include "tools/bridge/live_run.hpp"
#include "tools/bridge/pty_bridge.hpp"
#include "tools/host/files/files.hpp"
#include "tools/scenario/reading/reader.hpp"
#include "tools/scenario/runner.hpp"

namespace {

using namespace s7200;

constexpr const char* kScenario =
    "steps:\n"
    "  - {write: holding 10, value: 16#1234, expect: echo}\n"
    "  - {read: holding 10, expect: [16#1234], latency: ..20ms}\n";

bool scenario_passes(const std::shared_ptr<const Program>& program) {
  const tools::ScenarioFile file = tools::read_scenarios(kScenario, "bench.yaml");
  if (file.scenarios.size() != 1 || !file.diagnostics.empty()) return false;
  const tools::ScenarioResult result = tools::run_scenario(file.scenarios[0], {.program = program});
  for (const tools::Finding& finding : result.findings)
    std::fprintf(stderr, "%s: expected %s, found %s\n", finding.what.c_str(), finding.expected.c_str(),
                 finding.found.c_str());
  return result.outcome == tools::ScenarioResult::Outcome::Passed;
}

/// Reads holding register 0 over and over until an answer comes: the program's first scan takes a while.
bool answers_at(const std::string& link) {
  constexpr unsigned char kRequest[] = {1, 3, 0, 0, 0, 1, 0x84, 0x0A};
  const int port = open(link.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK);
  termios settings{};
  if (port < 0 || tcgetattr(port, &settings) != 0) return false;
  cfmakeraw(&settings);
  cfsetspeed(&settings, B9600);
  tcsetattr(port, TCSANOW, &settings);
  std::string answer;
  for (int tries = 0; tries < 100 && answer.size() < 7; ++tries) {
    if (write(port, kRequest, sizeof kRequest) != sizeof kRequest) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    char bytes[64];
    const ssize_t count = read(port, bytes, sizeof bytes);
    if (count > 0) answer.append(bytes, static_cast<std::size_t>(count));
  }
  close(port);
  return answer.size() >= 7 && answer.substr(0, 3) == std::string("\x01\x03\x02", 3);
}

bool serves_behind_a_pty(const std::shared_ptr<const Program>& program) {
  const std::string link = std::filesystem::absolute("bench.pty").string();
  std::atomic<bool> enough = false;
  std::promise<void> serving;
  tools::LiveRunOptions options;
  options.stop = StopToken(enough);
  options.messages.serving = [&](const std::string&) { serving.set_value(); };
  serial::Simulation simulation(program);
  simulation.power_up();
  const auto bridge = tools::make_pty_bridge(link, {});
  tools::LiveRun live(simulation, options, bridge.get());
  if (const auto done = live.start(); !done) return std::fprintf(stderr, "%s\n", done.why().c_str()), false;
  std::thread run([&] { live.run_until(kNever); });
  const bool served = serving.get_future().wait_for(std::chrono::minutes(1)) == std::future_status::ready;
  const bool answered = served && answers_at(link);
  enough = true;
  run.join();
  if (!live.failure().empty()) std::fprintf(stderr, "%s\n", live.failure().c_str());
  return answered;
}

}  // namespace

int main() {
  const auto bytes = tools::read_file(STL_PROGRAMS "/modbus_slave.stl");
  if (!bytes) return std::fprintf(stderr, "%s\n", bytes.why().c_str()), 2;
  const CheckResult checked = check_text(*bytes, "modbus_slave.stl", cpu214(), default_times(cpu214()));
  if (!checked.program) return 2;
  const bool passed = scenario_passes(checked.program), served = serves_behind_a_pty(checked.program);
  std::printf("scenario %s, pty %s\n", passed ? "passed" : "failed", served ? "answered" : "silent");
  return passed && served ? 0 : 1;
}
