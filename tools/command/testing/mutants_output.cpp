#include "tools/command/testing/mutants_output.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "interpreter/base/text/counted.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/verb/band_options.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/testing/test_output.hpp"
#include "tools/host/console.hpp"
#include "tools/host/host_time.hpp"
#include "tools/host/interruption.hpp"
#include "tools/mutants/mutants_report.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

/// On a terminal, from the second second on.
class MutantsProgress {
 public:
  ~MutantsProgress() {
    if (shown_) fmt::print(stderr, "\r\x1b[K");
  }
  void operator()(std::size_t done, std::size_t all) {
    if (!wanted_ || host_time() < from_) return;
    fmt::print(stderr, "\r{} of {} changes", done, all);
    std::fflush(stderr);
    shown_ = true;
  }

 private:
  const bool wanted_ = is_terminal(Standard::Error);
  const Time from_ = host_time() + 2 * kSecond;
  bool shown_ = false;
};

void print_results(const MutantsResult& result, bool json) {
  if (!json) {
    for (const MutantsOfProgram& each : result.programs) fmt::print("{}", mutants_text(each));
    return;
  }
  auto results = results_of("test");
  results["mutants"] = nlohmann::ordered_json::array();
  for (const MutantsOfProgram& each : result.programs) results["mutants"].push_back(mutants_json(each));
  results["scenarios_left_out"] = result.left_out;
  results["scenarios_failing"] = result.failing;
  results["changes_not_tried"] = result.not_tried;
  results["interrupted"] = result.interrupted;
  fmt::print("{}", lines_of(results));
}

}  // namespace

int run_mutants(Suite& suite, const TestOptions& options) {
  Messages messages;
  Programs programs;
  const auto benches = make_benches(suite.scenarios(), options.suite.target, options.suite, programs, messages);
  print_messages(messages);
  if (!benches) return print_interruption(), interrupted() ? kCheckFailed : kUnusable;
  MutantsResult result;
  {
    MutantsProgress progress;
    result = hunt_mutants(suite.scenarios(), *benches,
                          {.jobs = options.suite.jobs,
                           .stop = options.suite.stop,
                           .progress = [&](std::size_t done, std::size_t all) { progress(done, all); }});
  }
  print_results(result, options.json);
  if (result.left_out > 0)
    print_note(counted(result.left_out, "scenario") + " left out: skipped, or not about one program in simulation");
  if (result.failing > 0) print_error(counted(result.failing, "scenario") + " left out: failing without any change");
  if (result.not_tried > 0) print_note(counted(result.not_tried, "change") + " not tried");
  print_interruption();
  if (result.programs.empty() && !interrupted()) return print_error("no scenario passes on a program"), kUnusable;
  return interrupted() || result.failing > 0 ? kCheckFailed : kFine;
}

}  // namespace s7200::tools
