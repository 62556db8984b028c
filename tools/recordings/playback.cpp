#include "tools/recordings/playback.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>

#include "interpreter/base/ppi_frame.hpp"
#include "serial_sim/line/frame.hpp"
#include "serial_sim/modbus/functions.hpp"
#include "tools/scenario/reading/text.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"

namespace s7200::tools {
namespace {

/// The reasons why requests and their answers are not in a scenario.
class Omissions {
 public:
  Omissions(const std::vector<ReadFrame>& frames, const Stamps& stamps) : frames_(frames), stamps_(stamps) {
    for (const ReadFrame& frame : frames) {
      if (frame.frame.stream == 0) continue;
      Connection& connection = connections_[frame.frame.stream];
      if (frame.frame.more_was_lost) connection.last_before_loss = &frame;
      if (frame.direction == Direction::Unknown) connection.last_stray = &frame;
    }
  }

  using Named = std::set<const ReadFrame*>;

  /// The reason why a request is left out; empty if it is not. `named` are the frames that are not requests and that a
  /// reason names.
  std::string why(const ReadFrame& request, Named& named) const {
    if (!request.frame.damaged.empty()) return "the request is damaged";
    if (!request.right) return "the request is wrong: " + request.text;
    if (const ReadFrame* rest = rest_of(request)) {
      named.insert(rest);
      return "more characters follow it without a silence: " + serial::to_hex(rest->frame.bytes);
    }
    if (request.frame.stream != 0 && request.station == modbus::kBroadcast)
      return "unit 0 of Modbus TCP is a device; on a serial line it is all stations, and none answers";
    if (request.other) {
      const ReadFrame& answer = frames_[*request.other];
      if (answer.latency > kLongestSpan)
        return fmt::format("its answer ({}) comes more than a day later", answer.frame.place);
      return answer.right ? "" : fmt::format("its answer ({}): {}", answer.frame.place, answer.text);
    }
    if (request.needs_no_answer) return {};
    if (request.repeats) return fmt::format("it may be the late echo of {}", frames_[*request.repeats].frame.place);
    return request.frame.stream == 0 ? why_on_a_line(request, named) : why_over_tcp(request, named);
  }

 private:
  struct Connection {
    const ReadFrame* last_before_loss = nullptr;
    const ReadFrame* last_stray = nullptr;
  };

  static constexpr const char* kLost = "what came after it is missing from the recording";

  static std::string may_be_its_answer(const ReadFrame& stray, Named& named) {
    named.insert(&stray);
    return fmt::format("what follows it ({}) may be its answer: {}", stray.frame.place, stray.text);
  }

  /// The rest of a request's frame that is not a message: the station that was asked heard both as one frame. Null: there is
  /// none.
  const ReadFrame* rest_of(const ReadFrame& request) const {
    const ReadFrame* next = &request + 1;
    const bool same = next != frames_.data() + frames_.size() && next->direction == Direction::Unknown &&
                      next->frame.stream == request.frame.stream && next->frame.place == request.frame.place;
    return same ? next : nullptr;
  }

  std::string why_on_a_line(const ReadFrame& request, Named& named) const {
    if (request.frame.more_was_lost) return kLost;
    const ReadFrame* next = &request + 1;
    if (next == frames_.data() + frames_.size()) return {};
    if (next->repeats) return fmt::format("the same after it ({}) may be its late echo", next->frame.place);
    return next->direction == Direction::Unknown ? may_be_its_answer(*next, named) : "";
  }

  /// There answers come in any order, and late.
  std::string why_over_tcp(const ReadFrame& request, Named& named) const {
    const Connection& connection = connections_.at(request.frame.stream);
    if (connection.last_before_loss >= &request) return kLost;
    if (connection.last_stray != nullptr && connection.last_stray > &request)
      return may_be_its_answer(*connection.last_stray, named);
    const auto listened = silence(request.frame, frames_.back().frame, stamps_);
    if (!listened) return "the recording has no times, so its answer may be missing";
    return *listened < stamps_.timeout ? "the recording ends before the master's time-out" : "";
  }

  const std::vector<ReadFrame>& frames_;
  const Stamps& stamps_;
  std::map<std::uint32_t, Connection> connections_;
};

/// The frames without echoes: the player of a scenario hears none.
std::vector<ReadFrame> without_echoes(std::span<const ReadFrame> frames) {
  std::vector<std::size_t> number;  // of each frame, without those before it that are left out
  std::size_t kept = 0;
  for (const ReadFrame& frame : frames) number.push_back(frame.echo ? kept : kept++);
  std::vector<ReadFrame> without;
  for (const ReadFrame& frame : frames) {
    if (frame.echo) continue;
    ReadFrame& added = without.emplace_back(frame);
    if (added.other) added.other = number[*added.other];
    if (added.repeats) added.repeats = number[*added.repeats];
  }
  return without;
}

/// Whether a request waited for its answer together with others, as on Modbus TCP. `answered`: the last answer to any
/// request before it.
bool waits_with_others(const std::vector<ReadFrame>& frames, std::size_t number, std::size_t answered) {
  const auto at = [&](std::size_t place) { return frames.begin() + static_cast<std::ptrdiff_t>(place); };
  const std::size_t answer = frames[number].other.value_or(number + 1);
  return number < answered ||
         std::any_of(at(number + 1), at(answer), [](const ReadFrame& each) { return each.direction == Direction::Request; });
}

/// The stations that were asked.
std::set<std::uint8_t> stations_asked(const std::vector<ReadFrame>& frames) {
  std::set<std::uint8_t> stations;
  for (const ReadFrame& frame : frames)
    if (frame.direction == Direction::Request && frame.right && frame.station) stations.insert(*frame.station);
  return stations;
}

/// Writes the steps of a scenario, frame after frame.
class Steps {
 public:
  Steps(const std::vector<ReadFrame>& frames, const Stamps& stamps, const PlaybackChoices& choices)
      : frames_(frames), stamps_(stamps), choices_(choices), omissions_(frames, stamps) {}

  void add(std::size_t number) {
    const ReadFrame& frame = frames_[number];
    if (frame.direction == Direction::Unknown && !named_.contains(&frame)) leave_out_stray(frame);
    if (frame.direction != Direction::Request) return;
    const bool with_others = waits_with_others(frames_, number, answered_);
    answered_ = std::max(answered_, frame.other.value_or(0));
    if (choices_.station && frame.station != choices_.station) return;
    if (is_asked_again(number)) return leave_out_poll(frame);
    if (const std::string why = omissions_.why(frame, named_); !why.empty()) return leave_out(frame, why);
    ask(number, with_others);
  }

  Playback finish() {
    if (!strays_.empty())
      note("{}: left out{}: {}", strays_.front()->frame.place,
           strays_.size() == 1 ? "" : fmt::format(", and {} more", strays_.size() - 1), strays_.front()->text);
    if (polls_ > 0)
      note(
          "{}: left out{}: a poll to which there was no answer yet; when there is one hangs on the scan of whoever is asked",
          first_poll_->frame.place, polls_ == 1 ? "" : fmt::format(", and {} more", polls_ - 1));
    if (!untimed_.empty())
      note(
          "{}{}: begins before the frame above it can be over, as logs note what they were told late: no pause, latency or "
          "time-out is written there",
          untimed_.front()->frame.place, untimed_.size() == 1 ? "" : fmt::format(", and {} more", untimed_.size() - 1));
    if (together_ > 0)
      note(
          "{} requests waited for their answers at the same time, which a serial line does not allow: the scenario asks "
          "one after the other, without their latencies",
          together_);
    if (last_ != nullptr) playback_.scenario = head() + steps_;
    return std::move(playback_);
  }

 private:
  static constexpr Time kLongestWait = kSecond;  // of a scenario that does not say more

  template <typename... Args>
  void note(fmt::format_string<Args...> text, Args&&... args) {
    playback_.notes.push_back(fmt::format(text, std::forward<Args>(args)...));
  }

  std::string head() const {
    std::string head = fmt::format("scenarios:\n  - name: {}\n", in_quotes(choices_.name));
    if (!choices_.program.empty()) head += fmt::format("    program: {}\n", in_quotes(choices_.program));
    if (!choices_.cpu.empty()) head += fmt::format("    cpu: {}\n", choices_.cpu);
    if (choices_.port != 0) head += fmt::format("    port: {}\n", choices_.port);
    if (choices_.ppi_station) head += fmt::format("    ppi_station: {}\n", *choices_.ppi_station);
    return head + fmt::format("    tolerance: {}\n    steps:\n", exact(choices_.tolerance));
  }

  void leave_out_stray(const ReadFrame& frame) {
    strays_.push_back(&frame);
    steps_ += fmt::format("      # {}: left out: {}\n", frame.frame.place, frame.text);
  }

  /// Whether a request was put off and the same station is asked again.
  bool is_asked_again(std::size_t number) const {
    const ReadFrame& request = frames_[number];
    if (!request.other || !frames_[*request.other].puts_off) return false;
    return std::any_of(
        frames_.begin() + static_cast<std::ptrdiff_t>(*request.other), frames_.end(),
        [&](const ReadFrame& each) { return each.direction == Direction::Request && each.station == request.station; });
  }

  void leave_out_poll(const ReadFrame& poll) {
    if (polls_++ == 0) first_poll_ = &poll;
    steps_ += fmt::format("      # {}: left out: there was no answer yet\n", poll.frame.place);
  }

  void leave_out(const ReadFrame& request, const std::string& why) {
    note("{}: left out: {}", request.frame.place, why);
    steps_ += fmt::format("      # {}\n", playback_.notes.back());
  }

  void ask(std::size_t number, bool with_others) {
    const ReadFrame& request = frames_[number];
    const ReadFrame* answer = request.other ? &frames_[*request.other] : nullptr;
    steps_ += fmt::format("      - send: {}\n", serial::to_hex(request.frame.bytes));
    together_ += with_others ? 1U : 0U;
    if (!with_others) pause_before(request);
    const bool may_be_missing = !answer && !request.needs_no_answer && number + 1 == frames_.size();
    if (answer)
      expect(*answer, with_others);
    else if (may_be_missing)
      note("{}: nothing is expected of its answer: the recording ends there", request.frame.place);
    else
      expect_silence(number);
    last_ = answer ? answer : &request;
    steps_ += fmt::format("        # {}: {}{}\n", request.frame.place, request.text, answer ? "; " + answer->text : "");
  }

  /// Adds the pause in front of a request, as long as in the recording.
  void pause_before(const ReadFrame& request) {
    const auto gap = last_ ? silence(last_->frame, request.frame, stamps_) : std::nullopt;
    if (!gap || is_untimed(request, *gap)) return;
    const Time pause = std::max<Time>(0, *gap - waited_);
    steps_ += fmt::format("        pause: {}\n", exact(std::min(pause, kLongestSpan)));
    if (pause > kLongestSpan)
      note("{}: the pause before it, {}, is shortened to a day", request.frame.place, format_duration(pause));
  }

  void expect(const ReadFrame& answer, bool with_others) {
    steps_ += fmt::format("        expect: {}\n", serial::to_hex(answer.frame.bytes));
    const auto latency = silence(frames_[*answer.other].frame, answer.frame, stamps_);
    const bool timed = latency && !with_others && !is_untimed(answer, *latency);
    if (timed) steps_ += fmt::format("        latency: {}\n", exact(*latency));
    if (answer.latency > kLongestWait)
      steps_ += fmt::format("        timeout: {}\n", exact(std::min(*answer.latency + kLongestWait, kLongestSpan)));
    waited_ = 0;
  }

  /// Expects silence, unless the next frame came too early to say how long it was silent.
  void expect_silence(std::size_t number) {
    const auto listened = silence_after(number);
    waited_ = 0;
    if (listened && is_untimed(frames_[number + 1], *listened)) return;
    waited_ = std::clamp(listened.value_or(kLongestWait), Time{1}, kLongestWait);
    steps_ += fmt::format("        expect: silence\n        timeout: {}\n", exact(waited_));
  }

  /// A silence shorter than a character is none that a program can have measured.
  bool is_untimed(const ReadFrame& after, Time silence) {
    if (stamps_.exact || silence >= stamps_.character) return false;
    if (untimed_.empty() || untimed_.back() != &after) untimed_.push_back(&after);
    return true;
  }

  /// The silence up to the next frame; in Modbus TCP, where answers to others may come meanwhile, up to the next request.
  std::optional<Time> silence_after(std::size_t number) const {
    const auto after = frames_.begin() + static_cast<std::ptrdiff_t>(number) + 1;
    if (after == frames_.end()) return {};
    if (frames_[number].frame.stream == 0) return silence(frames_[number].frame, after->frame, stamps_);
    const auto next =
        std::find_if(after, frames_.end(), [](const ReadFrame& f) { return f.direction == Direction::Request; });
    return silence(frames_[number].frame, (next == frames_.end() ? frames_.back() : *next).frame, stamps_);
  }

  const std::vector<ReadFrame>& frames_;
  const Stamps& stamps_;
  const PlaybackChoices& choices_;
  const Omissions omissions_;
  Playback playback_;
  std::string steps_;
  const ReadFrame* last_ = nullptr;  // of the exchange before, ...
  Time waited_ = 0;                  // ... and how long the scenario waits after it
  std::size_t answered_ = 0;         // the last answer to any request so far
  std::size_t together_ = 0;
  std::size_t polls_ = 0;  // that were put off
  const ReadFrame* first_poll_ = nullptr;
  std::vector<const ReadFrame*> strays_;
  std::vector<const ReadFrame*> untimed_;  // begin before the frame before can be over
  Omissions::Named named_;                 // in a note already
};

}  // namespace

std::optional<std::uint8_t> ppi_station_asked(const std::vector<ReadFrame>& frames, std::optional<std::uint8_t> only) {
  const auto stations = only ? std::set{*only} : stations_asked(frames);
  const bool may_be_a_program = stations.size() == 1 && *stations.begin() >= 1 && *stations.begin() <= ppi::kLastStation;
  return may_be_a_program ? std::optional(*stations.begin()) : std::nullopt;
}

std::string why_nothing_is_asked(const std::vector<ReadFrame>& frames, const PlaybackChoices& choices) {
  const auto stations = stations_asked(frames);
  if (choices.station && !stations.empty() && !stations.contains(*choices.station))
    return fmt::format("no request to station {} in it; the stations that are asked: {}", *choices.station,
                       fmt::join(stations, ", "));
  const bool any = std::ranges::find(frames, Direction::Request, &ReadFrame::direction) != frames.end();
  return fmt::format("no request in it{}; s7200 decode shows what is", any ? " that can be asked again" : "");
}

std::string how_to_run(const RecordedProtocol& protocol, const PlaybackChoices& choices) {
  if (!choices.program.empty()) return "Run by s7200 test.";
  return fmt::format(
      "Run by s7200 test --target TARGET{}.",
      protocol.of_other_makes ? fmt::format(", such as westinghouse:MODEL with --protocol {}", protocol.name) : "");
}

Playback playback(const std::vector<ReadFrame>& heard, const Stamps& stamps, const PlaybackChoices& choices) {
  const std::vector<ReadFrame> frames = without_echoes(heard);
  Steps steps(frames, stamps, choices);
  for (std::size_t number = 0; number < frames.size(); ++number) steps.add(number);
  return steps.finish();
}

}  // namespace s7200::tools
