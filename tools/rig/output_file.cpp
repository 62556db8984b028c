#include "tools/rig/output_file.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <ostream>

namespace s7200::tools {

void OutputFile::add_to(CLI::App& app) {
  app.add_option("--output", path_, "write each change of an output (Q, AQ) to FILE, as CSV; - is standard output")
      ->type_name("FILE");
}

bool OutputFile::claim(WrittenFiles& files) {
  return path_.empty() ||
         file_.claim(files, "--output", path_, {"a record of outputs", fmt::format("{}\n", OutputRecord::kFirstLine)});
}

bool OutputFile::open() {
  if (path_.empty()) return true;
  std::ostream* out = file_.open();
  if (out) record_ = std::make_unique<OutputRecord>(*out);
  return out != nullptr;
}

}  // namespace s7200::tools
