// Who looks on while a command goes on: a face, which shows at once what comes up, and may be asked for something meanwhile.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "interpreter/trace/trace.hpp"

namespace s7200::tools {

/// Why a part of a text stands out.
enum class Emphasis : std::uint8_t {
  Trouble,  ///< errors, and what is forced
  Warning,  ///< trouble in a trace
  Place     ///< where it stands, and why it has stopped
};

class Onlooker {
 public:
  virtual ~Onlooker() = default;

  /// Lines to be shown at once: traces, messages, answers, and whatever the command had said before them.
  virtual void tell(std::string_view lines) = 0;

  /// How such a part of a text is written where this face shows it.
  virtual std::string emphasized(std::string text, Emphasis) const { return text; }

  /// A run begins, and it has ended: `continue`, of all stations, or a step of the one that is looked at.
  virtual void run_begins(bool /*of_all*/) {}
  virtual void run_ended() {}

  /// The station that is looked at has executed an instruction.
  virtual void executed(const InstructionRecord& /*record*/) {}

  /// A run was ended from outside. Carries out what was asked for meanwhile: whether the run is to go on then; nothing if
  /// nothing was asked for.
  virtual std::optional<bool> carry_out_asked() { return {}; }

  /// Whether what is displayed is in view anyhow.
  virtual bool shows_memory() const { return false; }

  /// Switches a steady view on or off. Returns why that cannot be.
  virtual std::optional<std::string> show_layout(bool /*on*/) { return "layout needs a terminal"; }
};

}  // namespace s7200::tools
