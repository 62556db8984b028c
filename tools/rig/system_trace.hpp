// `--trace` of a system: what all its CPUs do, in one file, with the name of the station beside each line.
#pragma once

#include <list>
#include <string>
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
  /// Neither is owned.
  SystemTrace(const SystemPlan& plan, const serial::System& system, TraceDetail detail);

  bool claim(WrittenFiles& files, const std::string& path, std::string& why);
  bool open(std::string& why);
  bool put(std::string& why) { return file_.put(why); }
  bool close(std::string& why);

  /// What watches a CPU. The file is open.
  TraceSink& station(std::size_t plc) { return *traces_[plc]; }

 private:
  struct Line {
    Time at;
    std::string text;
  };

  void add(std::size_t plc, Time at, std::string_view text);
  void write_until(Time end);

  const SystemPlan& plan_;
  const serial::System& system_;
  TraceDetail detail_;
  std::size_t width_ = 0;  // of the column of names
  RecordFile file_;
  std::ostream* out_ = nullptr;
  std::vector<std::unique_ptr<TextTrace>> traces_;  // by PLC
  std::vector<Line> waiting_;
};

}  // namespace s7200::tools
