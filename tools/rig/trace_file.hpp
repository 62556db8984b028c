// `--trace FILE`: where a trace goes.
#pragma once

#include <memory>
#include <string>

#include "interpreter/trace/text_trace.hpp"
#include "tools/host/record_file.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

class TraceFile {
 public:
  void add_to(CLI::App& app);

  /// False after a message, like the others: a trace was asked for and cannot be written there.
  bool claim(WrittenFiles& files);
  bool open(const std::shared_ptr<const Program>& program);
  bool put() { return file_.put(); }

  /// What is to watch the CPU; null when no trace was asked for.
  TraceSink* sink() const { return trace_.get(); }

  /// False after a message when not everything could be written.
  bool close() { return file_.close(); }

  bool to_standard_output() const { return path_ == "-"; }

 private:
  std::string path_;
  bool instructions_ = false;
  RecordFile file_;
  std::unique_ptr<TextTrace> trace_;
};

}  // namespace s7200::tools
