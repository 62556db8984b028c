// Where the help shows an option. One that most users need has one of these headings as its group: `--help` shows those
// alone. All other options are in `--help-all`.
#pragma once

#include <array>

namespace s7200::tools::help_group {

inline constexpr const char* kProgram = "Program";
inline constexpr const char* kRun = "Run";
inline constexpr const char* kCommands = "Commands";
inline constexpr const char* kRequests = "Requests";
inline constexpr const char* kLine = "Line";
inline constexpr const char* kBridge = "Bridge: joins the line to masters outside, in real time; one of";
inline constexpr const char* kMemory = "Memory, inputs and outputs";
inline constexpr const char* kResults = "Results";

/// The group that CLI11 gives to an option: of those that `--help` does not show.
inline constexpr const char* kMore = "Options";

/// The group of options that no help shows.
inline constexpr const char* kNone = "";

/// In the order of the help.
inline constexpr std::array kAll{kProgram, kRun, kCommands, kRequests, kLine, kBridge, kMemory, kResults};

}  // namespace s7200::tools::help_group
