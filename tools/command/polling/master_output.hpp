// What `s7200 master` shows of a session: each result, a table, failures only, or JSON as it comes.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/command/polling/polling_table.hpp"
#include "tools/master/session.hpp"

namespace s7200::tools {

struct MasterOutputSettings {
  bool json = false;
  bool verbose = false;     ///< requests and answers in hex
  bool continuous = false;  ///< failures only, and on a terminal the progress
  Time every = kNever;      ///< polling: a table
  std::uint64_t rounds = 1;
  std::string_view refusal = "exception";  ///< what the protocol calls one
};

class MasterOutput {
 public:
  /// `slave`: its name, for the title.
  MasterOutput(const MasterOutputSettings& settings, const std::string& slave);

  /// What belongs before the first result and after the last, where the JSON of results stands between them.
  void begin() const;
  void end(const ExchangeStatistics& statistics, const std::string& error, const nlohmann::ordered_json& plant);

  void show(const MasterResult& result);
  void end_round(const ExchangeStatistics& statistics);

 private:
  bool polls() const { return settings_.every != kNever; }
  void show_failure(const MasterResult& result);
  void show_progress(const ExchangeStatistics& statistics);
  void clear_progress();

  MasterOutputSettings settings_;
  std::string slave_;
  PollingTable table_;
  int failures_shown_ = 0;
  Time progress_at_ = 0;  // of the host; 0 when no progress is on the terminal
  bool first_ = true;
};

}  // namespace s7200::tools
