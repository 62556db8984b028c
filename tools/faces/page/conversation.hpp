// A session as pages see it: messages in, messages out (docs/page_protocol.md). It knows no threads, no sockets and no
// files: the same at the other end of a WebSocket and in WebAssembly.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/session/commands/reply.hpp"
#include "tools/session/commands/session.hpp"

namespace s7200::tools::page {

inline constexpr int kProtocol = 1;

/// Who sends messages: a number of the server's choice, which no other client gets.
using Client = std::uint64_t;

/// Where messages go, each in one line.
struct Post {
  std::function<void(Client client, std::string message)> to;
  std::function<void(std::string message)> to_all;
};

struct PageSettings {
  SessionSetup session{};
  std::string program{};  ///< the name of what is shown
  bool live = false;      ///< a run follows the clock
  std::vector<MemoryRange> failed{};  ///< that was not as expected where the session stands, which `why` is about there
  std::string found{};    ///< what a scenario has found where the session stands, in lines; empty if it is none that failed
  /// Ends a run that follows the clock when it becomes true, so that what was asked meanwhile can be carried out; null if
  /// nobody asks.
  const std::atomic<bool>* pause = nullptr;
  /// Carries out what clients have asked for while a run was going on that follows the clock. Returns false if nothing
  /// waited.
  std::function<bool()> carry_out{};
  /// Is told when a run begins and has ended that messages pause.
  std::function<void(bool on)> live_run{};
  /// The clock of the host in ns, for news of a run, which come kNews apart. None: there are none before its end.
  std::function<Time()> clock{};
};

class Conversation final : private Onlooker {
 public:
  static constexpr Time kNews = 100 * kMillisecond;

  /// The history must live as long as this.
  Conversation(History& history, PageSettings settings, Post post);

  /// What a client is told first.
  void greet(Client client) const;

  /// Carries out a message and replies to it. `undone`: its client has asked for a stop before it came to it.
  void handle(Client client, const Json& message, bool undone = false);

  /// A client is gone; a run that it has carried on piece by piece is over.
  void leave(Client client);

  /// Something came that is no message: what is wrong with it.
  void complain(Client client, const std::string& why) const;

  /// What comes up without any command: notes of bridges and masters.
  void say(const std::string& lines);

  /// All clients are told why there will be no more replies.
  void end(const std::string& why);

  /// After `quit`.
  bool is_over() const { return session_.quit_asked; }

 private:
  static constexpr int kDeepest = 8;  ///< runs that were begun while others are paused

  void tell(std::string_view lines) override { say(std::string(lines)); }
  void run_begins(bool of_all) override;
  void run_ended() override;
  void executed(const InstructionRecord& record) override;
  std::optional<bool> carry_out_asked() override;

  struct Seen;
  Seen seen() const;
  Reply carry_out(const std::string& line, bool of_run);
  Reply carry_on(Client client, const std::string& line, bool begins, bool undone);
  void end_run();
  void tell_what_changed(const Seen& before, const std::string& command);
  void tell_all(Json event) const;
  void tell_moved(const std::string& by) const;

  PageSettings settings_;
  Post post_;
  Session session_;
  int runs_ = 0;  ///< that go on; all but the last one are paused
  std::string running_{};  ///< the command of the run that goes on
  std::optional<Client> runner_{};  ///< who carries a run on piece by piece
  bool runner_left_ = false;
  Time news_at_ = 0;
  std::uint32_t executed_ = 0;
};

}  // namespace s7200::tools::page
