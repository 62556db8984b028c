#include "tools/command/options/verb/import_capture_options.hpp"

#include <fmt/format.h>

#include "tools/command/options/number_option.hpp"
#include "tools/command/options/plc/program_options.hpp"

namespace s7200::tools {

void ImportCaptureOptions::add_to(CLI::App& verb) {
  recording.add_to(verb);
  verb.add_option("--program", program, "that is to be tested; without it the scenario is for test --target")
      ->type_name("FILE");
  add_cpu_option(verb, cpu, "CPU that --program is to run on [214]");
  verb.get_option("--cpu")->needs("--program");
  add_whole_number(
      verb, "--port", [this](std::uint64_t port) { choices.port = static_cast<std::uint8_t>(port); }, {0, 1},
      "port of that CPU, that the recorded line is to be at", "0")
      ->needs("--program");
  add_whole_number(
      verb, "--station", [this](std::uint64_t station) { choices.station = static_cast<std::uint8_t>(station); }, {0, 255},
      "only what this station was asked");
  add_duration(verb, "--tolerance", choices.tolerance, "by which latencies may differ; 5ms without it");
  verb.add_option("-o,--output", output, "file to write; standard output if not given")->type_name("FILE");
  verb.add_flag("--force", force, "overwrite an existing file");
  verb.add_flag("--json", json, "print what was written as JSON, with the scenario if no file is written");
}

}  // namespace s7200::tools
