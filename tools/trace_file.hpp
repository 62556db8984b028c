// `--trace FILE`: where a trace goes.
#pragma once

#include <fstream>
#include <memory>
#include <string>

#include "interpreter/trace/text_trace.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

class TraceFile {
 public:
  void add_to(CLI::App& app);

  /// Opens the file and hangs a trace on the CPU, if one was asked for. False after a message: an existing file that is not
  /// an earlier trace is not overwritten.
  bool open(Cpu& cpu, const std::shared_ptr<const Program>& program);

  /// Where the trace goes to; null when none was asked for.
  TraceSink* sink() const { return trace_.get(); }

  /// False after a message when not everything could be written.
  bool close();

 private:
  std::string path_;
  bool instructions_ = false;
  std::ofstream file_;
  std::unique_ptr<TextTrace> trace_;
};

}  // namespace s7200::tools
