// A session of the Debug Adapter Protocol (1.68): messages in, messages out. It knows no streams and no threads.
//
// Each CPU is shown as a thread; its frames are the routines that are open. A line is an instruction, a statement in the
// sense of the protocol is a network. Every step and stop has its brother that goes back in time.
//
// Of the stations of a system it looks at one: the one that has stopped, or that a request names by a thread, a frame, a
// variable or memory. All of them run and stand still together.
//
// Messages may come while the program runs: whoever runs it has run() end by the stop request, hands the messages over, and
// goes on if runs() says so. The program does what it does in one go.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "interpreter/base/stop_token.hpp"
#include "tools/faces/dap/attributes.hpp"
#include "tools/faces/dap/debuggee.hpp"
#include "tools/faces/dap/wire/messages.hpp"

namespace s7200::tools::dap {

struct Conversation;

struct SessionSettings {
  /// Powers up what a launch asks for; throws Refused.
  std::function<std::shared_ptr<Debuggee>(const Json& arguments)> launch;
  std::shared_ptr<Debuggee> attachable{};   ///< that was there before the session, and stays
  StopToken stop_request{};                 ///< ends what is going on
  std::chrono::milliseconds patience{500};  ///< after this long progress is reported
};

class Session {
 public:
  using Send = std::function<void(const Json& message)>;

  Session(SessionSettings settings, Send send);
  ~Session();

  void handle(const Json& message);

  /// A request that was taken back before its turn.
  void refuse(const Json& message, const std::string& why);

  /// Something came that is no message and was skipped: what is wrong with it.
  void complain(const std::string& wrong);

  /// Whether the program is running, and how it goes on: until it stops, or a stop request.
  bool runs() const;
  void run();

  bool is_over() const;

  /// The client has gone without a word.
  void abandon();

 private:
  std::unique_ptr<Conversation> talk_;
};

}  // namespace s7200::tools::dap
