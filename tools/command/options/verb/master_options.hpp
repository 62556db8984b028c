// The options of `s7200 master`.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/command/options/plc/other_plc_options.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/options/plc/rig_options.hpp"
#include "tools/command/options/verb/band_options.hpp"
#include "tools/command/options/verb/report_option.hpp"
#include "tools/command/polling/master_output.hpp"
#include "tools/slave/slave_target.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace s7200::tools {

struct MasterOptions {
  std::string target;
  std::vector<std::string> words;
  const Protocol* protocol = protocols().front();
  bool verbose = false, json = false, continuous = false;
  Time every = kNever;      ///< kNever: no polling
  std::uint64_t count = 0;  ///< rounds; 0: one, or until Ctrl-C
  Time pause = kNever;      ///< kNever: Slave::pause
  Time after = kNever;      ///< kNever: when the program is ready
  Time silence = kNever;    ///< kNever: as the slave has it
  serial::MasterSettings master;
  OtherPlcOptions other;
  ProgramOptions program;
  RigOptions rig;
  BandOptions band;
  ReportOption report;

  void add_to(CLI::App& app);

  /// Throws std::invalid_argument if options were given that such a target or the protocol has no use for, or without end.
  void refuse_what_does_not_fit(SlaveTarget::Kind kind) const;

  /// Throws std::invalid_argument if an action is wrong. `over_tcp`: stations are units of Modbus TCP.
  std::vector<MasterAction> actions(bool over_tcp) const;

  /// Of those actions, what is probably meant otherwise; empty if all is well.
  std::string doubt(const std::vector<MasterAction>& actions, bool over_tcp) const;

  /// How the protocol is used, until an action says otherwise.
  ProtocolUse use(bool over_tcp) const;

  /// Not actions, but the menu on a terminal. Throws std::invalid_argument if it does not go with what else was given.
  bool wants_menu() const;

  SessionSettings session(bool broadcasts_are_silent) const;
  MasterOutputSettings output() const;

  bool polls() const { return every != kNever; }
  bool open_ended() const { return count == 0 && (polls() || continuous); }

 private:
  void add_protocol_options(CLI::App& app);
  void refuse_what_a_peer_does_not_take(SlaveTarget::Kind kind) const;
  void refuse_file_as_action() const;
  std::uint64_t rounds() const;

  std::optional<std::uint8_t> station_;
  std::optional<int> retries_;
  Time before_retry_ = kNever;  // as the protocol has it
  CLI::Option *timeout_ = nullptr, *plc_ = nullptr;
  std::map<std::string, std::string, std::less<>> given_;  // options of protocols, by name

  std::vector<CLI::Option*> for_programs_, for_lines_, for_rtu_;  // that other targets have no use for
};

}  // namespace s7200::tools
