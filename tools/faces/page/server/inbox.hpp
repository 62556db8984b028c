// The messages of all clients of a page on their way from the thread that reads them to the one that has the session.
//
// A run that follows the clock is paused by each message, so that it is carried out soon; nothing else ends early, but by a
// client that asks for it. No message is lost and none of a client overtakes another.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include "tools/faces/page/conversation.hpp"

namespace s7200::tools::page {

struct Incoming {
  enum class Kind : std::uint8_t { Joined, Message, Unreadable, Left, Ended };

  Kind kind{};
  Client client = 0;
  Json message{};         ///< of Unreadable what is wrong, as a text
  bool undone = false;    ///< its client has asked for a stop after it
  std::size_t bytes = 0;  ///< of the message as it came
};

class Inbox {
 public:
  static constexpr std::size_t kMostWaiting = 1000, kMostBytes = 16 << 20;  ///< of messages of a client

  /// `stop` ends what goes on, `pause` a run that follows the clock.
  Inbox(std::atomic<bool>& stop, std::atomic<bool>& pause) : stop_(stop), pause_(pause) {}

  // For the thread that reads.
  void join(Client client);
  void leave(Client client);
  /// Returns why the client has to go; empty if it may stay.
  std::string put(Client client, const std::string& text);
  /// Nothing more is to be done: the program ends.
  void end();

  // For the thread that has the session.
  /// Waits for the next one. After end() it is Ended, whatever waits.
  Incoming take();
  /// Nothing if none waits.
  std::optional<Incoming> take_waiting();
  /// Whether a run goes on that messages pause.
  void run_is_live(bool on);

 private:
  void add(Incoming incoming);
  Incoming first();
  void stop_for(Client client);
  std::string why_full(Client client, std::size_t more) const;

  std::atomic<bool>& stop_;
  std::atomic<bool>& pause_;
  std::mutex mutex_{};
  std::condition_variable come_{};
  std::deque<Incoming> waiting_{};
  bool live_ = false, ended_ = false;
};

}  // namespace s7200::tools::page
