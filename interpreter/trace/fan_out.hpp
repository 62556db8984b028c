// Several sinks on one CPU.
#pragma once

#include <vector>

#include "interpreter/trace/trace.hpp"

namespace s7200 {

/// Passes everything on to each of its sinks, in the order in which they were added. It owns none of them; each must live
/// until it is removed.
class FanOut final : public TraceSink {
 public:
  /// A null pointer is ignored.
  void add(TraceSink* sink);
  void remove(TraceSink* sink);
  bool empty() const { return sinks_.empty(); }

  void record(const TraceRecord& record) override;
  /// Asks every sink that wants instructions; a single no stops the CPU.
  bool before(std::uint32_t op) override;
  void instruction(const InstructionRecord& record) override;
  bool wants_instructions() const override;
  Watch watch() const override;
  TraceSink& watcher() override;
  bool wants_scans() const override;

 private:
  std::vector<TraceSink*> sinks_;
};

}  // namespace s7200
