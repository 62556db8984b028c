#include "tools/output_file.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <ostream>

namespace s7200::tools {

void OutputFile::add_to(CLI::App& app) {
  app.add_option("--output", path_, "write each change of an output (Q, AQ) to FILE, as CSV; - is standard output")
      ->type_name("FILE");
}

bool OutputFile::open() {
  if (path_.empty()) return true;
  std::ostream* out = file_.open(path_, fmt::format("{}\n", OutputRecord::kFirstLine), "record of outputs");
  if (out) record_ = std::make_unique<OutputRecord>(*out);
  if (out) out->flush();  // so that no other record takes the same file for an empty one
  return out != nullptr;
}

}  // namespace s7200::tools
