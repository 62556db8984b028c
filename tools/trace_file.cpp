#include "tools/trace_file.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>

#include "interpreter/cpu/cpu.hpp"
#include "tools/terminal.hpp"

namespace s7200::tools {
namespace {

/// An empty file may be overwritten too.
bool is_earlier_trace(const std::string& path) {
  std::ifstream in(path);
  std::string first(TextTrace::kFirstLine.size() + 1, '\0');
  in.read(first.data(), static_cast<std::streamsize>(first.size()));  // no more: it may be a device without end
  return in.gcount() == 0 || first == std::string(TextTrace::kFirstLine).append("\n");
}

}  // namespace

void TraceFile::add_to(CLI::App& app) {
  auto* trace =
      app.add_option("--trace", path_, "write interrupts, characters, attachments and errors to FILE; - is standard output")
          ->type_name("FILE");
  app.add_flag("--trace-instructions", instructions_, "trace every instruction too, with its operand values")->needs(trace);
}

bool TraceFile::open(Cpu& cpu, const std::shared_ptr<const Program>& program) {
  if (path_.empty()) return true;
  std::ostream* out = &std::cout;
  if (path_ != "-") {
    if (std::filesystem::exists(path_) && !is_earlier_trace(path_)) {
      print_error(fmt::format("{} exists and is no trace; it is left alone", path_));
      return false;
    }
    file_.open(path_, std::ios::trunc);
    if (!file_) {
      print_error(fmt::format("cannot write {}: {}", path_, std::strerror(errno)));
      return false;
    }
    out = &file_;
  }
  trace_ = std::make_unique<TextTrace>(*out, program, instructions_);
  cpu.set_sink(trace_.get());
  return true;
}

bool TraceFile::close() {
  if (!file_.is_open()) return true;
  file_.close();
  if (file_) return true;
  print_error(fmt::format("cannot write all of {}: {}", path_, std::strerror(errno)));
  return false;
}

}  // namespace s7200::tools
