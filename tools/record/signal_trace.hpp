// Traces of signals: the values of memory, interrupt routines and the levels at ports over time, as a Value Change Dump
// (IEEE 1364, clause 18) for waveform viewers, and as CSV.
//
// Memory is looked at after each instruction and whatever else is recorded, so a change has the instant at which an
// instruction has made it, to its end; what the system changes between two instructions is seen after the next one. Levels
// are known later than what the CPU does: until then its changes wait.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/model/ports.hpp"
#include "tools/record/trace_formats.hpp"

namespace s7200::tools {

class SignalTrace : public TraceWriter {
 public:
  void record(const TraceRecord& record) override;
  void instruction(const InstructionRecord& record) override { look(record.end); }
  void note(Time /*at*/, std::string_view /*what*/) override {}
  void level(std::uint8_t port, PortLevel level, Time at, bool mark) override;
  void settled(std::uint8_t port, Time until) override;
  void finish() override { write_until(kNever); }
  bool wants_instructions() const override { return of_memory_; }
  bool wants_scans() const override { return of_memory_; }

 protected:
  /// A signal and its value; nothing as long as the PLC has had no power.
  struct Shown {
    Signal signal;
    std::optional<std::uint32_t> bits{};
    bool changed = false;  ///< since it was written last
  };

  explicit SignalTrace(TraceWanted wanted);

  /// Some have changed: they are as they are from `at` on.
  virtual void write(Time at) = 0;

  void put(Time at, std::string_view line) { wanted_.take(at, line); }
  const std::vector<Shown>& shown() const { return shown_; }
  const TraceWanted& wanted() const { return wanted_; }
  /// Until when the levels are known; 0 if none is shown.
  Time levels_until() const;
  /// The value as a number: words and double words with a sign.
  double number_of(const Shown& one) const;

 private:
  struct Change {
    Time at = 0;
    std::size_t signal = 0;
    std::uint32_t bits = 0;
  };

  void look(Time at);
  void change(Time at, std::size_t signal, std::uint32_t bits) { waiting_.push_back({at, signal, bits}); }
  void write_until(Time end);

  TraceWanted wanted_;
  std::vector<Shown> shown_{};
  std::vector<std::optional<std::uint32_t>> known_{};  ///< by signal: as the CPU left it last
  std::vector<Change> waiting_{};                      ///< to be written, in no order
  std::array<Time, kPorts.size()> settled_{};          ///< kNever for a port whose levels are not shown
  bool of_memory_ = false;
  bool of_levels_ = false;
  Time at_ = 0;
};

class VcdTrace final : public SignalTrace {
 public:
  static constexpr std::string_view kFirstLine = "$comment s7200: signals of a PLC $end\n";
  explicit VcdTrace(TraceWanted wanted);

  /// Says how long the last levels lasted as well.
  void finish() override;

 private:
  void write(Time at) override;

  Time told_ = -1;  ///< the instant that was written last
};

/// A row for each instant at which one of them changes, with the values of all: `12.345678,1,-5`, time in ms.
class CsvTrace final : public SignalTrace {
 public:
  static constexpr std::string_view kFirstLine = "time_ms";
  explicit CsvTrace(TraceWanted wanted);

 private:
  void write(Time at) override;
};

}  // namespace s7200::tools
