// A trace in the Trace Event Format of Chrome, an array of JSON objects, for Perfetto's viewer, chrome://tracing and
// speedscope: interrupt routines as slices, from their events with arrows; characters, errors and all else as instants;
// signals as counters.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "tools/record/signal_trace.hpp"

namespace s7200::tools {

class ChromeTrace final : public SignalTrace {
 public:
  static constexpr std::string_view kFirstLine =
      "[\n{\"ph\":\"M\",\"name\":\"process_name\",\"pid\":1,\"tid\":0,\"args\":{\"name\":\"s7200\"}}";
  explicit ChromeTrace(TraceWanted wanted);

  void record(const TraceRecord& record) override;
  void note(Time at, std::string_view what) override;
  void finish() override;

 private:
  void write(Time at) override;
  void add(Time at, nlohmann::ordered_json event);
  void add_service(const TraceRecord& record);

  std::uint64_t arrows_ = 0;
};

}  // namespace s7200::tools
