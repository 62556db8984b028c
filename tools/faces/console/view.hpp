// What is kept in view of a session: where it stands, the instructions around with power flow and operands, and memory.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/session/commands/session.hpp"
#include "tools/session/observers/last_executions.hpp"

namespace s7200::tools {

class View {
 public:
  /// Up to `rows` lines. While a run goes on the instructions are those around the place where it began, as they were
  /// executed last.
  std::vector<std::string> lines(Session& session, std::size_t rows) const;

  /// What is in view now stays there until the run has ended.
  void run_begins(Session& session);
  void run_ended() { live_.reset(); }
  bool is_live() const { return live_.has_value(); }
  void note(const Session& session, const InstructionRecord& record);

 private:
  struct Shown {
    std::uint32_t first = 0, end = 0;
    LastExecutions last{};
  };
  static Shown around(Session& session);

  std::optional<Shown> live_{};
};

}  // namespace s7200::tools
