#include "tools/trace_file.hpp"

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

bool TraceFile::open(const std::shared_ptr<const Program>& program) {
  if (path_.empty()) return true;
  std::ostream* out = file_.open(path_, fmt::format("{}\n", TextTrace::kFirstLine), "trace");
  if (out) trace_ = std::make_unique<TextTrace>(*out, program, instructions_);
  if (out) out->flush();  // so that no other record takes the same file for an empty one
  return out != nullptr;
}

}  // namespace s7200::tools
