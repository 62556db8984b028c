// Saved sessions of the debugger: any JSON, with the check sum that it needs to get any further.
//
// Promises: it is read, or refused with a reason. What is read is run, if that is for a short time, and can be written and
// read again.
#include <cstdint>
#include <nlohmann/json.hpp>

#include "interpreter/analysis/warnings/check.hpp"
#include "tests/fuzz/promise.hpp"
#include "tools/json/json.hpp"
#include "tools/session/commands/session_file.hpp"
#include "tools/session/past/digest.hpp"
#include "tools/session/past/history.hpp"
#include "tools/views/results_json.hpp"

namespace {

using namespace s7200;
using namespace s7200::tools;

std::optional<SessionFile> read(const std::string& text) {
  const CpuModel* const models[] = {&cpu214()};
  const auto file = session_from_text(text, models, {});
  must(file.has_value() == file.why().empty(), "refused without a reason, or read with one", file.why());
  return file.if_any();
}

void run(const Recording& recording) {
  constexpr Time kMost = 50 * kMillisecond;
  static const auto kProgram =
      check_text("LD SM0.0\nINCW VW0\nMEND\n", "counts.stl", cpu214(), default_times(cpu214())).program;
  serial::Simulation simulation(kProgram);
  simulation.power_up();
  History history(simulation, {});
  if (recording.end.time <= kMost && history.has_hosts_of(recording)) history.replay(recording);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto json = parse_json({reinterpret_cast<const char*>(data), size}).value_or(nlohmann::ordered_json());
  if (!json.is_object()) return 0;
  json.erase("sum");
  json["version"] = version();
  json["sum"] = digest_of(std::string_view(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)));
  const auto file = read(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  if (!file) return 0;
  run(file->recording);
  const auto again = read(to_text(*file));
  must(again && to_text(*again) == to_text(*file), "what is written is not what was read", to_text(*file));
  return 0;
}
