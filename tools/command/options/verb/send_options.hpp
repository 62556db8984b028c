// The options of `s7200 send`.
#pragma once

#include "tools/command/options/frame_options.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/options/plc/rig_options.hpp"
#include "tools/command/options/verb/band_options.hpp"
#include "tools/command/options/verb/report_option.hpp"

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
