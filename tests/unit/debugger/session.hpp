// A session of the debugger, for tests: commands in, text out.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <sstream>
#include <utility>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/base/bytes.hpp"
#include "interpreter/base/stop_token.hpp"
#include "tools/faces/console/prompt.hpp"
#include "tools/faces/files/host_files.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {

/// Two subroutines and a timed interrupt every 5 ms; VW10 counts scans, VW30 interrupts.
inline constexpr std::string_view kNested =
    "LD      SM0.1\n"                             // 1
    "CALL    1\n"                                 // 2
    "LD      SM0.0\n"                             // 3
    "INCW    VW10            // one more scan\n"  // 4
    "MEND\n"                                      // 5
    "\n"                                          // 6
    "// The first\n"                              // 7
    "SBR     1\n"                                 // 8
    "LD      SM0.0\n"                             // 9
    "MOVB    5, SMB34\n"                          // 10
    "ATCH    0, 10\n"                             // 11
    "ENI\n"                                       // 12
    "CALL    2\n"                                 // 13
    "RET\n"                                       // 14
    "SBR     2\n"                                 // 15
    "LD      SM0.0\n"                             // 16
    "MOVW    7, VW20\n"                           // 17
    "RET\n"                                       // 18
    "INT     0\n"                                 // 19
    "LD      SM0.0\n"                             // 20
    "INCW    VW30\n"                              // 21
    "RETI\n";                                     // 22

/// Sends each character back. I0.0 is an interrupt as well.
inline constexpr std::string_view kEcho =
    "LD      SM0.1\n"
    "MOVB    16#09, SMB30\n"
    "ATCH    1, 8\n"
    "ATCH    2, 0\n"
    "ENI\n"
    "MEND\n"
    "INT     1\n"  // 7
    "LD      SM0.0\n"
    "MOVB    SMB2, VB1\n"
    "MOVB    1, VB0\n"
    "XMT     VB0, 0\n"
    "RETI\n"
    "INT     2\n"  // 13
    "LD      SM0.0\n"
    "INCW    VW40\n"
    "RETI\n";

inline std::shared_ptr<const Program> program_of(std::string_view text) {
  return check_text(text, "test.stl", cpu214(), default_times(cpu214())).program;
}

/// The files of this computer, for `save`, `load` and completion.
inline const HostFiles& files_of_commands() {
  static const HostFiles files;
  return files;
}

/// A debugger of a plant: commands in, text out. The plant is a base, as it has to be there before the debugger and after
/// it.
template <class Plant>
struct Talk : Plant {
  using Plant::Plant;

  /// What good commands print.
  std::string operator()(std::string_view commands) {
    out.str("");
    const auto error = debugger->execute(commands);
    EXPECT_FALSE(error.has_value()) << commands << ": " << *error;
    return out.str();
  }
  std::string error_of(std::string_view commands) { return debugger->execute(commands).value_or("no error"); }

  std::ostringstream out;
  std::unique_ptr<Prompt> debugger;
};

struct OnePlc {
  explicit OnePlc(std::shared_ptr<const Program> program) : simulation(std::move(program)) { simulation.power_up(); }

  const State& state() const { return simulation.cpu().state(); }
  std::uint32_t line() const { return simulation.cpu().program().statement(state().pc).position.line; }
  std::uint16_t vw(std::uint32_t number) const { return load16(&state().image[image::kV + number]); }

  serial::Simulation simulation;
};

struct AtPrompt : Talk<OnePlc> {
  explicit AtPrompt(std::shared_ptr<const Program> program, StopToken stop_request = {}) : Talk(std::move(program)) {
    debugger =
        std::make_unique<Prompt>(std::vector{&simulation}, out,
                                 PromptSettings{.session = {.stop_request = stop_request,
                                                            .interruption = [] { return std::string(interruption_text()); },
                                                            .files = &files_of_commands()}});
  }
  explicit AtPrompt(std::string_view text) : AtPrompt(program_of(text)) {}
};

inline testing::AssertionResult has(const std::string& text, std::string_view part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << part << "' is not in:\n" << text;
}

}  // namespace s7200::tools
