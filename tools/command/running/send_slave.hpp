// Who answers what is sent.
#pragma once

#include <memory>

#include "tools/command/reports/run_recorder.hpp"
#include "tools/command/running/send_band.hpp"
#include "tools/command/running/unanswered.hpp"
#include "tools/rig/rig.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

/// The program, or the line of a system without an S7-200; and whether the first frame can be sent: if not, after messages.
/// `unanswered` and `recorder`, which may be null, listen to the program.
std::unique_ptr<SlaveInSimulation> slave_to_send_to(const SendOptions& options, Rig& rig, bool& ready,
                                                    Unanswered* unanswered, RunRecorder* recorder);

}  // namespace s7200::tools
