// `--trace` of a system: what all its CPUs do, and what happens to them in the field, in one file, with the name of the
// station or line beside each line.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "serial_sim/system/system.hpp"
#include "tools/host/files/record_file.hpp"
#include "tools/plan/system_plan.hpp"
#include "tools/record/trace_formats.hpp"

namespace s7200::tools {

/// claim(), open(), put() when the first line is written, close(). Each brings trouble if the file cannot be
/// written. CPUs run ahead of each other: lines wait until no other one can come before them.
class SystemTrace final {
 public:
  /// The plan and the system are not owned.
  SystemTrace(const SystemPlan& plan, const serial::System& system, TraceDetail detail);
  ~SystemTrace();

  Result<> claim(WrittenFiles& files, const std::string& path);
  Result<> open();
  Result<> put() { return file_.put(); }
  Result<> close();

  /// Writes the lines before which no other line can come any more.
  void flush();

  /// How far the file has grown; nothing for a pipe or device.
  std::optional<RecordSize> size() const { return file_.size(); }

  /// The sink that watches a CPU. The file is open.
  TraceSink& station(std::size_t plc);

  /// Notes a text about a PLC.
  void note(std::size_t plc, Time at, std::string_view what);

  /// Tells what happens to the system at `at`, in words.
  void tell(const EventPlan& event, Time at, std::string_view what);

 private:
  struct Line {
    Time at;
    std::string text;
  };
  void add(std::string_view name, Time at, std::string_view text);
  void write_until(Time end);

  const SystemPlan& plan_;
  const serial::System& system_;
  TraceDetail detail_;
  const TraceFormat* format_ = nullptr;  // of the file that is claimed
  std::size_t width_ = 0;                // of the column of names
  RecordFile file_;
  std::ostream* out_ = nullptr;
  std::vector<std::unique_ptr<TraceWriter>> stations_;  // by PLC
  std::vector<Line> waiting_;
};

}  // namespace s7200::tools
