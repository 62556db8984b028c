// What came of the actions of `s7200 master`, as text, as a live table, and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "serial_sim/peers/requester.hpp"
#include "serial_sim/modbus/answer.hpp"
#include "tools/master/action.hpp"

namespace s7200::tools {

/// An action that sends something, done.
struct MasterResult {
  const MasterAction* action = nullptr;
  serial::Exchange exchange{};
  modbus::Answer answer{};
  std::string remark{};  ///< Slave::remark
  int attempts = 1;
};

/// Checks an answer with all that is known of how it came: errors in its characters, and answers to broadcasts, which only
/// count as wrong where `broadcasts_are_silent`.
modbus::Answer assess(const MasterAction& action, const serial::Exchange& exchange, bool broadcasts_are_silent);

/// `16#04D2 16#FFFB`, `exception 2: illegal data address`, `no answer`: all in one line.
std::string short_text(const MasterResult& result, const ValueFormat& format);

/// What was asked, and how long the answer took: `read 40011:2   station 1, function 3, holding registers 10…11   12.3 ms`.
std::string heading(const MasterResult& result);

/// What came of it: a line for each value, with its address in both notations; or what is wrong.
std::vector<std::string> lines(const MasterResult& result, const ValueFormat& format);

/// Request and answer in hex.
std::string frames_text(const MasterResult& result);

nlohmann::ordered_json to_json(const MasterResult& result, const ValueFormat& format);

/// Shows results round after round: in place on a terminal, else a line for each. What has changed since the round before
/// is marked with `*`, in bold where colour is wanted.
class PollingTable {
 public:
  PollingTable(std::string title, const ValueFormat& format, bool in_place, bool colour);

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
  ValueFormat format_;
  bool in_place_, colour_;
  std::size_t place_ = 0;            // of the next result in the round
  std::vector<Shown> before_, now_;  // by place
  std::string to_draw_;
  std::size_t drawn_ = 0;  // lines on the terminal
  Time drawn_at_ = 0;      // of the host
};

}  // namespace s7200::tools
