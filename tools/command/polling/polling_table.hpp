// What `s7200 master --every` shows: on a terminal a table that is drawn again each round, otherwise a line a result.
#pragma once

#include <string>
#include <vector>

#include "tools/master/report.hpp"

namespace s7200::tools {

/// Shows results round after round: in place on a terminal, else a line for each. What has changed since the round before
/// is marked with `*`, in bold where colour is wanted.
class PollingTable {
 public:
  PollingTable(std::string title, bool in_place, bool colour);

  /// A result of the round at hand, and how much time has passed since the first.
  void add(const MasterResult& result, Time at);

  /// The round is complete; `footer` are lines below the table. A terminal sees 20 rounds a second at most, but always the
  /// last: finish() shows it.
  void end_round(const std::string& footer);
  void finish();

 private:
  struct Shown {
    std::string heading;
    std::vector<std::string> lines;
  };

  std::string table(const std::string& footer) const;
  void draw();
  std::string marked(const std::string& line, bool changed) const;

  std::string title_;
  bool in_place_, colour_;
  std::size_t place_ = 0;            // of the next result in the round
  std::vector<Shown> before_, now_;  // by place
  std::string to_draw_;
  std::size_t drawn_ = 0;  // lines on the terminal
  Time drawn_at_ = 0;      // of the host
};

}  // namespace s7200::tools
