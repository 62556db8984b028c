// What a step does.
#pragma once

#include <cstddef>
#include <cstdint>

namespace s7200::tools {

class Run;
class TranscriptWriter;

/// What a step needs of the slave.
enum class Needs : std::uint8_t {
  Line,      ///< a line to it, wherever it is
  ToLook,    ///< a program in simulation, to see memory, interrupts, mode or errors; skipped on any other slave
  ToChange,  ///< a program in simulation, to change what is not the line's; on any other slave the scenario is skipped
  Around,    ///< a program or a system in simulation, to change what is around it: faults, power, cables; the same
};

/// Each kind is a file in steps/.
class StepAction {
 public:
  virtual ~StepAction() = default;

  virtual Needs needs() const { return Needs::Line; }

  /// As how many steps it counts.
  virtual std::size_t steps() const { return 1; }

  /// Does it, and adds what was not as expected.
  virtual void act(Run& run) const = 0;

  /// Writes what a replay has to do too. Returns false if that is nothing: expectations are left out.
  virtual bool write(TranscriptWriter&) const { return false; }
};

}  // namespace s7200::tools
