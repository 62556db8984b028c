// The options of `s7200 send`.
#pragma once

#include "tools/command/options/band_options.hpp"
#include "tools/command/options/frame_options.hpp"
#include "tools/command/options/program_options.hpp"
#include "tools/command/options/report_option.hpp"
#include "tools/command/options/rig_options.hpp"

namespace s7200::tools {

struct SendOptions {
  ProgramOptions program;
  FrameOptions frames;
  bool json = false, timeline = false;
  Time after = kNever;  // kNever: when the first scan has ended and the line is quiet
  Time pause = kNever;  // kNever: serial::default_quiet
  serial::MasterSettings master;
  RigOptions rig;
  BandOptions band;
  ReportOption report;

  void add_to(CLI::App& app);
};

}  // namespace s7200::tools
