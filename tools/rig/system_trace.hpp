// `--trace` of a system: what all its CPUs do, and what happens to them in the field, in one file, with the name of the
// station or line beside each line.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interpreter/trace/text_trace.hpp"
#include "serial_sim/system/system.hpp"
#include "tools/host/record_file.hpp"
#include "tools/rig/system_plan.hpp"

namespace s7200::tools {

/// claim(), open(), put() when the first line is written, close(). Each returns false and sets `why` if the file cannot be
/// written. CPUs run ahead of each other: lines wait until no other one can come before them.
class SystemTrace final {
 public:
  /// None is owned.
  SystemTrace(const SystemPlan& plan, const serial::System& system, const std::vector<serial::Plc*>& plcs,
              TraceDetail detail);
  ~SystemTrace();

  bool claim(WrittenFiles& files, const std::string& path, std::string& why);
  bool open(std::string& why);
  bool put(std::string& why) { return file_.put(why); }
  bool close(std::string& why);

  /// What watches a CPU. The file is open.
  TraceSink& station(std::size_t plc);

  /// What happens to the system at `at`. Who runs the same time again tells it again; it is written once.
  void tell(const EventPlan& event, Time at);

 private:
  struct Line {
    Time at;
    std::string text;
  };
  class Station;

  void add(std::string_view name, Time at, std::string_view text);
  void write_until(Time end);

  const SystemPlan& plan_;
  const serial::System& system_;
  const std::vector<serial::Plc*>& plcs_;
  TraceDetail detail_;
  std::size_t width_ = 0;  // of the column of names
  RecordFile file_;
  std::ostream* out_ = nullptr;
  std::vector<std::unique_ptr<Station>> stations_;    // by PLC
  std::set<std::pair<Time, const EventPlan*>> told_;  // by their places in the plan: two of one instant may read the same
  std::vector<Line> waiting_;
};

}  // namespace s7200::tools
