// The messages of a client on their way from the thread that reads them to the one that handles them.
//
// What is going on there ends by the stop request: a run with every message, so that it is handled soon, all else only with
// those that ask for its end. No message is lost and none overtakes another, but one that is cancelled is not handled.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <set>
#include <string>

#include "tools/faces/dap/wire/messages.hpp"

namespace s7200::tools::dap {

class Inbox {
 public:
  static constexpr std::size_t kMostMessages = 1000, kMostBytes = 16 << 20;  // that wait before no more is read

  explicit Inbox(std::atomic<bool>& stop_request) : stop_request_(stop_request) {}

  // For the thread that reads. `bytes`: of its text.
  void put(Json message, std::size_t bytes = 0);
  /// Something came that is no message: what is wrong with it.
  void put_unreadable(const std::string& wrong);
  /// Whether more may be read: what waits is bounded, so that a client that sends without end is held back.
  bool has_room() const;

  /// No more will come. `failure`: what is wrong with the stream; empty if it has ended as it should.
  void close(const std::string& failure = {});

  enum class Next : std::uint8_t { Message, Unreadable, Cancelled, Run, Closed };

  /// For the thread that handles: what to do next. It waits, unless the program `runs`, which goes on when there is nothing
  /// else. Of what is unreadable `message` is the text of what is wrong.
  Next take(bool runs, Json& message);

  std::string failure() const;

 private:
  struct Item {
    Json message;
    bool unreadable = false;
    std::size_t bytes = 0;
  };
  bool is_urgent(const Json& message);
  void add(Item item, bool urgent);

  std::atomic<bool>& stop_request_;
  mutable std::mutex mutex_;
  std::condition_variable come_;
  std::deque<Item> messages_;
  std::size_t bytes_ = 0;             ///< of the messages
  std::set<std::int64_t> cancelled_;  ///< numbers of requests that wait
  bool runs_ = false, closed_ = false;
  std::string failure_;
};

}  // namespace s7200::tools::dap
