// The files written of a CPU while it runs: a trace of its interrupts, the changes of its outputs.
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <string>

#include "interpreter/base/result.hpp"
#include "interpreter/trace/fan_out.hpp"
#include "tools/host/files/record_file.hpp"

namespace s7200::tools {

/// claim(), open(), put() when the first lines are written, close(). Each brings trouble if a file cannot be
/// written.
class TraceFiles {
 public:
  using Make = std::function<std::unique_ptr<TraceSink>(std::ostream&)>;

  /// Claims `path` for what `make` makes; an empty path is none. `kind` without its beginning is not recognised later.
  Result<> claim(WrittenFiles& files, std::string_view option, const std::string& path, FileKind kind, Make make);
  /// The records are told what the CPU does by `sinks`.
  Result<> open(FanOut& sinks);
  Result<> put();

  /// Writes the records so far to their files.
  void flush();

  /// Adds how far they have grown.
  void add_sizes(std::vector<RecordSize>& sizes) const;

  /// Closes all of them; adds to `problems` what could not be written.
  void close(std::vector<std::string>& problems);

 private:
  struct Record {
    RecordFile file;
    Make make;
    std::unique_ptr<TraceSink> sink;
  };
  std::list<Record> records_;  // sinks hold on to the files' streams
};

}  // namespace s7200::tools
