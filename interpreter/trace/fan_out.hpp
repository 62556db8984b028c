// Several sinks on one CPU.
#pragma once

#include <vector>

#include "interpreter/trace/trace.hpp"

namespace s7200 {

/// Hands everything on to each of its sinks, in the order they were added. None is owned; each outlives its time here.
class FanOut final : public TraceSink {
 public:
  /// A null pointer is no sink.
  void add(TraceSink* sink);
  void remove(TraceSink* sink);
  bool empty() const { return sinks_.empty(); }

  void record(const TraceRecord& record) override;
  /// Every sink that wants instructions is asked; one that says no is enough to stop.
  bool before(std::uint32_t op) override;
  void instruction(const InstructionRecord& record) override;
  bool wants_instructions() const override;

 private:
  std::vector<TraceSink*> sinks_;
};

}  // namespace s7200
