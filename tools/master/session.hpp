// A master at work: actions on a slave, round after round.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "tools/master/report.hpp"
#include "tools/master/statistics.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

struct SessionSettings {
  serial::MasterSettings master{};  ///< timeout and gap
  std::uint64_t rounds = 1;
  Time every = kNever;            ///< a round begins; kNever: as soon as the one before is over
  int retries = 0;                ///< after silence, a wrong answer, or a lost connection
  Time pause = kNever;            ///< between an answer and the next request; kNever: Slave::pause()
  std::optional<Time> silence{};  ///< that ends an answer; as the slave has it if not given
  bool broadcasts_are_silent = true;
  Patience patience{};  ///< what is done before a request is repeated
  ProtocolUse use{};    ///< for the protocol's `first`
};

class MasterSession {
 public:
  struct Listener {
    std::function<void(const MasterResult&)> result;
    std::function<void()> end_of_round;
  };

  /// Neither the slave nor the actions are owned.
  MasterSession(Slave& slave, const std::vector<MasterAction>& actions, const SessionSettings& settings);

  /// Performs all rounds, or those until `over` returns true or a stop is asked for. Throws SlaveUnreachable, and
  /// std::invalid_argument for a frame that cannot be sent to this slave.
  void run(const Listener& listener, const std::function<bool()>& over);

  const ExchangeStatistics& statistics() const { return statistics_; }

 private:
  void run_round(const Listener& listener, const std::function<bool()>& over);
  /// Performs an action; nothing after a stop.
  std::optional<MasterResult> perform(const MasterAction& action);
  serial::Request request_of(const MasterAction& action) const;
  /// Exchanges all steps of an action.
  serial::Exchange exchange(const MasterAction& action);
  bool settled(const serial::Answer& answer) const;
  void prepare_to_repeat(const MasterAction& action);

  Slave& slave_;
  const std::vector<MasterAction>& actions_;
  SessionSettings settings_;
  ExchangeStatistics statistics_;
};

}  // namespace s7200::tools
