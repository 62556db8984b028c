// What the rungs of a program have kept from being executed, or left without power flow, while a part of the past was
// played.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "interpreter/analysis/flow/flow.hpp"
#include "interpreter/trace/trace_reasons.hpp"
#include "tools/session/past/reader.hpp"

namespace s7200::tools {

class RungReader final : public Reader {
 public:
  /// The program must live as long as this.
  RungReader(const Program& program, std::size_t station, StopToken stop_request)
      : Reader(station, stop_request), reasons(program), program_(program), flow_(control_flow(program)) {}

  void record(const TraceRecord& record) override { reasons.note(record); }
  void instruction(const InstructionRecord& record) override;

  /// `had no power flow at 9.5 ms (LD I0.0: I0.0=0)`, or that it was not executed lately and what has kept it from that:
  /// a jump over it, an end in front of it, a FOR without a pass, a CALL of its routine that was not made.
  std::string what_kept(std::uint32_t op) const { return what_kept(op, 0); }

  TraceReasons reasons;

 private:
  struct Passed {
    Time at = 0;
    std::string contacts{};
  };

  using Way = std::pair<const std::uint32_t, Passed>;

  static std::string at_text(const Passed& passed);
  std::string what_kept(std::uint32_t op, std::size_t calls) const;
  const Way* last_way_past(std::uint32_t op) const;
  std::string text_of(const Way& way) const;
  std::string what_calls(std::uint32_t head, std::size_t calls) const;
  bool leads_past(std::uint32_t by, std::uint32_t op) const;
  std::string loop_without_pass(std::uint32_t op) const;

  const Program& program_;
  ControlFlow flow_;
  std::map<std::uint32_t, Passed> without_power_{};  // by op, the last time
  std::map<std::uint32_t, Passed> taken_{};          // by op of a jump or an end, the last time
  std::set<std::uint32_t> entered_{};                // ops of FOR and CALL that had power
};

}  // namespace s7200::tools
