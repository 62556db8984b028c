// Traces of signals: the values of memory and interrupt routines over time, as a Value Change Dump (IEEE 1364, clause 18)
// for waveform viewers, and as CSV.
//
// Memory is looked at after each instruction and whatever else is recorded, so a change has the instant at which an
// instruction has made it, to its end; what the system changes between two instructions is seen after the next one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/record/trace_formats.hpp"

namespace s7200::tools {

class SignalTrace : public TraceWriter {
 public:
  void record(const TraceRecord& record) override;
  void instruction(const InstructionRecord& record) override { look(record.end); }
  void note(Time /*at*/, std::string_view /*what*/) override {}
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
  /// The value as a number: words and double words with a sign.
  double number_of(const Shown& one) const;

 private:
  void look(Time at);

  TraceWanted wanted_;
  std::vector<Shown> shown_{};
  bool of_memory_ = false;
  Time at_ = 0;
};

class VcdTrace final : public SignalTrace {
 public:
  static constexpr std::string_view kFirstLine = "$comment s7200: signals of a PLC $end\n";
  explicit VcdTrace(TraceWanted wanted);

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
