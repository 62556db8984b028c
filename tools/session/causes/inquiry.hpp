// What the questions of `why` share: where it was asked, the request it is about, what the witness has seen, and the answers
// so far. Each question has a file; `last_decision` asks them in their order.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "tools/session/causes/last/last_decision.hpp"
#include "tools/session/causes/line/asked_request.hpp"
#include "tools/session/causes/witness.hpp"

namespace s7200::tools {

/// What keeps characters from the program, after what is said of them, and the instruction that did it, if one has.
struct Keeper {
  std::string text{};
  std::optional<LastDecision> by{};
  Time since = 0;
};

class Inquiry {
 public:
  Inquiry(History& history, std::size_t station, Time host_timeout, StopToken stop_request);

  /// Plays the past that it is about; false after a stop request.
  bool hear_the_witness();

  // --- what was asked ---

  History& history() const { return history_; }
  std::size_t station() const { return station_; }
  StopToken stop_request() const { return stop_request_; }
  serial::Simulation& here() const { return history_.station(station_); }
  const Program& program() const { return here().cpu().program(); }
  const Moment& start() const { return start_; }
  serial::Simulation& here_at_start() const;

  /// The last on a line of the PLC; nothing if there is none in question.
  const std::optional<AskedRequest>& request() const { return request_; }
  bool is_by_others() const { return request_ && request_->plc() != station_; }
  /// All of a request of others has come, and it has got no answer so far.
  bool has_unanswered() const { return is_by_others() && request_->unanswered && request_->end != 0; }
  /// The port that it is about.
  std::uint8_t port() const { return request_ ? request_->port : here().port(); }

  /// Since when frames without an answer count: the scan, which an interrupt routine never outlasts, and the request.
  Time since() const { return since_; }
  /// When the CPU went to STOP, if it is there.
  const std::optional<Time>& stopped() const { return stopped_; }
  const Witness& witness() const { return witness_; }
  /// Frames that the program has left; of a request that got no answer those that ended before it began are none of it.
  std::vector<Witness::Left> frames_left() const;

  // --- the answers ---

  DecisionSearch answers{};

  /// What decided about a frame is where to go back to, unless that is known already.
  void add(Time at, std::string text, const Keeper& keeper);
  void add_first(TraceLine line) { answers.unanswered.insert(answers.unanswered.begin(), std::move(line)); }
  /// What the line has lost or damaged.
  void add_lost(TraceLine line);
  void note_left(const TraceReasons::Cause& cause);

  /// What a program hears that has asked itself is no request.
  std::string left_text(const TraceReasons::Unanswered& frame) const;
  LastDecision decision_of(const TraceReasons::Cause& cause);
  Keeper kept_by(const Moment& moment, const InstructionRecord& by, std::string_view done) const;

  /// What RCV at the port works towards where the simulation stands, and which one it was, to be said after `RCV waits for
  /// `: `the start of a message: an idle line of 5 ms; executed at 50.104800 ms by RCV VB100, 0 in line 9`. Nothing if it is
  /// off.
  Keeper kept_by_rcv(std::uint8_t port);

 private:
  Time beginning() const;
  std::optional<Time> when_stopped() const;
  std::optional<Time> sending_since() const;
  bool goes_back_to_frames() const;
  Moment in_front_of(const InstructionRecord& from, std::uint32_t op, bool in_interrupt);

  History& history_;
  std::size_t station_;
  StopToken stop_request_;
  Moment start_;
  bool in_main_;
  std::optional<AskedRequest> request_;
  Time since_;
  std::optional<Time> stopped_;
  Witness witness_;
};

/// Of a character that came while no RCV received: how the last RCV ended, and what keeps the program from the next.
Keeper what_ended_receiving(Inquiry& inquiry, const TraceRecord& ignored);

// --- the questions; the simulation stands anywhere afterwards ---

/// Which frames has the program left without an answer?
void find_frames_left(Inquiry& inquiry);

/// Which characters did no routine get, and what has kept them from it?
void find_characters_untaken(Inquiry& inquiry);

/// Which characters wait for their routine, or did not find room to wait, because interrupts are disabled? Returns how many
/// have not found it.
std::size_t find_characters_waiting(Inquiry& inquiry);

/// Which XMT was refused that was to answer, and what had the port then?
void find_transmissions_refused(Inquiry& inquiry);

/// Which frames has the program swallowed? Nothing else is known of them.
void find_frames_swallowed(Inquiry& inquiry);

/// Which characters were lost because the queue was full? `known`: so many of them were named.
void find_characters_lost(Inquiry& inquiry, std::size_t known);

/// What has the line lost or damaged? That was before what the program made of the rest.
void find_what_the_line_lost(Inquiry& inquiry);

/// Was another station asked, and who is that? What this one's program made of it is right then.
void find_station_asked(Inquiry& inquiry);

/// What switched the bits on or off that decided about the last frame?
void find_what_switched_contacts(Inquiry& inquiry);

/// What has led to where the program stands?
void find_what_led_here(Inquiry& inquiry);

}  // namespace s7200::tools
