#include "tools/dap/serve.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <thread>

#include "interpreter/base/text.hpp"
#include "tools/dap/framing.hpp"
#include "tools/dap/inbox.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools::dap {
namespace {

constexpr int kLookAgain = 100;  // ms, for an interruption, which ends a run

/// Reads in a thread of its own: a run is to be ended from outside.
class Reader {
 public:
  Reader(int in, Inbox& inbox) : in_(in), inbox_(inbox), thread_([this] { read_all(); }) {}
  ~Reader() {
    done_ = true;
    thread_.join();
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

 private:
  void read_all() {
    std::array<char, 65'536> bytes;
    while (!done_) {
      if (interrupted()) return inbox_.close();
      pollfd readable{in_, POLLIN, 0};
      if (poll(&readable, 1, kLookAgain) <= 0) continue;
      const ssize_t count = read(in_, bytes.data(), bytes.size());
      if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
      if (count < 0) return inbox_.close(fmt::format("cannot be read: {}", std::strerror(errno)));
      if (count == 0) return inbox_.close(frames_.is_amid() ? "has ended within a message" : wrong_so_far_);
      frames_.add({bytes.data(), static_cast<std::size_t>(count)});
      hand_over();
    }
  }

  /// What cannot be framed cannot be answered: the client is told, and the next message is looked for.
  void hand_over() {
    for (;;) {
      std::string why;
      const auto content = frames_.next(why);
      if (!content && why.empty()) return;
      std::string not_json;
      auto parsed = content ? parse_json(*content, not_json) : std::nullopt;
      if (content && !parsed) {
        why = fmt::format("'{}' is {}", stl::shortened(*content), not_json);
        frames_.reject(*content);
      } else if (content && !parsed->is_object()) {
        why = fmt::format("'{}' is not a JSON object", stl::shortened(*content));
      }
      if (why.empty()) {
        any_message_ = true;
        wrong_so_far_.clear();
        inbox_.put(std::move(*parsed));
      } else {
        if (!any_message_ && wrong_so_far_.empty()) wrong_so_far_ = why;
        inbox_.put_unreadable(why);
      }
    }
  }

  int in_;
  Inbox& inbox_;
  FrameReader frames_;
  bool any_message_ = false;
  std::string wrong_so_far_;  ///< with a stream on which no message has come yet
  std::atomic<bool> done_ = false;
  std::thread thread_;  // the last one: it uses all else
};

}  // namespace

std::string serve(int in, const Write& write, const SessionSettings& settings, std::atomic<bool>& stop_request) {
  Inbox inbox(stop_request);
  bool lost = false;
  Session session(settings, [&](const Json& message) {
    lost = lost || !write(framed(message.dump(-1, ' ', false, Json::error_handler_t::replace)));
  });
  const Reader reader(in, inbox);
  while (!session.is_over() && !lost) {
    Json message;
    switch (inbox.take(session.runs(), message)) {
      case Inbox::Next::Message:
        session.handle(message);
        break;
      case Inbox::Next::Unreadable:
        session.complain(message.get<std::string>());
        break;
      case Inbox::Next::Cancelled:
        session.refuse(message, "cancelled");
        break;
      case Inbox::Next::Run:
        session.run();
        break;
      case Inbox::Next::Closed:
        session.abandon();
        break;
    }
  }
  if (!session.is_over()) session.abandon();
  return inbox.failure();
}

}  // namespace s7200::tools::dap
