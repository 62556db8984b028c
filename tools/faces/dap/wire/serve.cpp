#include "tools/faces/dap/wire/serve.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <thread>

#include "interpreter/base/text/text.hpp"
#include "tools/faces/dap/wire/admission.hpp"
#include "tools/faces/dap/wire/framing.hpp"
#include "tools/faces/dap/wire/inbox.hpp"
#include "tools/host/net/server_rules.hpp"

namespace s7200::tools::dap {
namespace {

constexpr std::chrono::milliseconds kLookAgain{100};  // for an interruption, which ends a run

using Clock = std::chrono::steady_clock;

/// Reads in a thread of its own: a run is to be ended from outside.
class Reader {
 public:
  Reader(InputStream& in, Inbox& inbox, const Admission& admission, bool may_be_anyone, StopToken end)
      : in_(in), inbox_(inbox), admission_(admission), may_be_anyone_(may_be_anyone), end_(end), thread_([this] {
          read_all();
        }) {}
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
      if (end_.stop_requested()) return inbox_.close();
      if (may_be_anyone_ && is_too_silent()) return inbox_.close(fmt::format("said nothing for {} s", kMostSilence.count()));
      if (!inbox_.has_room()) {
        std::this_thread::sleep_for(kLookAgain);
        heard_ = Clock::now();
        continue;
      }
      const InputStream::Reading reading = in_.read(bytes, kLookAgain);
      if (reading.came == InputStream::Came::Nothing) continue;
      if (reading.came == InputStream::Came::Failure) return inbox_.close(fmt::format("cannot be read: {}", reading.why));
      if (reading.came == InputStream::Came::End)
        return inbox_.close(frames_.is_amid() ? "has ended within a message" : wrong_so_far_);
      heard_ = Clock::now();
      const std::string_view come(bytes.data(), reading.count);
      if (may_be_anyone_ && !any_message_ && !is_our_protocol(come)) return;
      frames_.add(come);
      if (!hand_over()) return;
    }
  }

  /// Before it is let in, and within a message. An editor that stands at a breakpoint may be silent for hours.
  bool is_too_silent() const { return (!admission_.is_open() || frames_.is_amid()) && Clock::now() - heard_ > kMostSilence; }

  /// False after it was closed.
  bool is_our_protocol(std::string_view come) {
    constexpr std::size_t kEnough = 64;
    if (first_bytes_.size() >= kEnough) return true;
    first_bytes_ += come.substr(0, kEnough - first_bytes_.size());
    const std::string why = why_not_our_protocol(first_bytes_);
    if (!why.empty()) inbox_.close("was disconnected: " + why);
    return why.empty();
  }

  /// What cannot be framed cannot be answered: the client is told, and the next message is looked for. False after it was
  /// closed: no one is looked for in what a stranger sends.
  bool hand_over() {
    for (;;) {
      const auto content = frames_.next();
      if (!content && content.why().empty()) return true;
      std::string why = content.why();
      auto parsed = content ? parse_json(*content) : std::nullopt;
      if (content && !parsed) {
        why = fmt::format("'{}' is {}", stl::shortened(*content), parsed.why());
        frames_.reject(*content);
      } else if (content && !parsed->is_object()) {
        why = fmt::format("'{}' is not a JSON object", stl::shortened(*content));
      }
      if (why.empty()) {
        any_message_ = true;
        wrong_so_far_.clear();
        inbox_.put(std::move(*parsed), content->size());
      } else if (!admission_.is_open()) {
        inbox_.close("was disconnected: " + why);
        return false;
      } else {
        if (!any_message_ && wrong_so_far_.empty()) wrong_so_far_ = why;
        inbox_.put_unreadable(why);
      }
    }
  }

  InputStream& in_;
  Inbox& inbox_;
  const Admission& admission_;
  bool may_be_anyone_;  ///< it has come over a port
  Clock::time_point heard_ = Clock::now();
  std::string first_bytes_;
  StopToken end_;
  FrameReader frames_;
  bool any_message_ = false;
  std::string wrong_so_far_;  ///< with a stream on which no message has come yet
  std::atomic<bool> done_ = false;
  std::thread thread_;  // the last one: it uses all else
};

}  // namespace

std::string serve(InputStream& in, const Write& write, const SessionSettings& settings, std::atomic<bool>& stop_request,
                  StopToken end, const std::string& token) {
  Inbox inbox(stop_request);
  Admission admission(token);
  std::string turned_away;
  bool lost = false;
  Session session(settings, [&](const Json& message) {
    lost = lost || !write(framed(message.dump(-1, ' ', false, Json::error_handler_t::replace)));
  });
  const Reader reader(in, inbox, admission, !token.empty(), end);
  while (!session.is_over() && !lost && turned_away.empty()) {
    Json message;
    switch (inbox.take(session.runs(), message)) {
      case Inbox::Next::Message:
        turned_away = admission.judge(message);
        if (turned_away.empty())
          session.handle(message);
        else
          session.refuse(message, turned_away);
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
  return turned_away.empty() ? inbox.failure() : "was disconnected: " + turned_away;
}

}  // namespace s7200::tools::dap
