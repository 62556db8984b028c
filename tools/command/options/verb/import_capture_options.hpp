// The options of `s7200 import-capture`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tools/command/options/verb/recording_options.hpp"
#include "tools/recordings/playback.hpp"
#include "tools/scenario/scenario.hpp"

namespace s7200::tools {

struct ImportCaptureOptions {
  RecordingOptions recording;
  PlaybackChoices choices{.tolerance = 5 * kMillisecond};
  std::string program, output, cpu = Scenario{}.cpu;
  bool force = false, json = false;

  bool to_file() const { return !output.empty() && output != "-"; }

  /// The verb's callback has to keep them.
  void add_to(CLI::App& verb);
};

}  // namespace s7200::tools
