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
      if (count == 0) return inbox_.close(frames_.is_amid() ? "has ended within a message" : "");
      frames_.add({bytes.data(), static_cast<std::size_t>(count)});
      if (const std::string why = hand_over(); !why.empty()) return inbox_.close(why);
    }
  }

  std::string hand_over() {
    std::string why;
    while (const auto content = frames_.next(why)) {
      Json message = Json::parse(*content, nullptr, false);
      if (message.is_discarded()) return fmt::format("'{}' is not JSON", stl::shortened(*content));
      inbox_.put(std::move(message));
    }
    return why;
  }

  int in_;
  Inbox& inbox_;
  FrameReader frames_;
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
