// A session that is all in one place, for a page that holds it itself: programs and commands in, messages out. The messages
// are those of docs/page_protocol.md, as over the WebSocket of `s7200 view`.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/program/program.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tools/faces/page/conversation.hpp"
#include "tools/rig/rig.hpp"
#include "tools/session/past/seen_rig.hpp"

namespace s7200::tools::page {

class Engine {
 public:
  /// `send` gets each message, in one line.
  explicit Engine(std::function<void(std::string)> send) : send_(std::move(send)) {}

  /// Carries out a message; its reply and all notifications have been sent when it returns.
  void take(std::string_view message);

  /// The past of the program or system that is open; null if none is.
  History* history() { return history_.get(); }

 private:
  void open(const Json& message);
  void open_program(const Json& wanted, const Json& id);
  void open_system(const Json& wanted, const Json& id);
  Result<> begin(std::shared_ptr<const Program> program, const Json& wanted);
  Result<> begin_system(const Json& wanted);
  void forget();
  Result<> look_at(std::unique_ptr<History> history, std::optional<Recording> recording, PageSettings page);

  std::function<void(std::string)> send_;
  std::unique_ptr<serial::Simulation> simulation_{};  ///< of a program
  std::unique_ptr<Rig> rig_{};                        ///< of a system
  std::unique_ptr<SeenRig> seen_{};                   ///< the same
  std::unique_ptr<History> history_{};
  std::unique_ptr<Conversation> talk_{};  ///< null before a program was opened
};

}  // namespace s7200::tools::page
