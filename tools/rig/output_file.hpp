// `--output FILE`: where the changes of the outputs go.
#pragma once

#include <memory>
#include <string>

#include "interpreter/trace/output_record.hpp"
#include "tools/host/record_file.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

class OutputFile {
 public:
  void add_to(CLI::App& app);

  /// False after a message, like the others: a record was asked for and cannot be written there.
  bool claim(WrittenFiles& files);
  bool open();
  bool put() { return file_.put(); }

  /// What is to watch the CPU; null when no record was asked for.
  TraceSink* sink() const { return record_.get(); }

  /// False after a message when not everything could be written.
  bool close() { return file_.close(); }

  bool to_standard_output() const { return path_ == "-"; }

 private:
  std::string path_;
  RecordFile file_;
  std::unique_ptr<OutputRecord> record_;
};

}  // namespace s7200::tools
