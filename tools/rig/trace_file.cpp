#include "tools/rig/trace_file.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <ostream>

namespace s7200::tools {

void TraceFile::add_to(CLI::App& app) {
  auto* trace =
      app.add_option("--trace", path_, "write interrupts, characters, attachments and errors to FILE; - is standard output")
          ->type_name("FILE");
  app.add_flag("--trace-instructions", instructions_, "trace every instruction too, with its operand values")->needs(trace);
}

bool TraceFile::claim(WrittenFiles& files) {
  return path_.empty() || file_.claim(files, "--trace", path_, {"a trace", fmt::format("{}\n", TextTrace::kFirstLine)});
}

bool TraceFile::open(const std::shared_ptr<const Program>& program) {
  if (path_.empty()) return true;
  std::ostream* out = file_.open();
  if (out) trace_ = std::make_unique<TextTrace>(*out, program, instructions_);
  return out != nullptr;
}

}  // namespace s7200::tools
