// What a line has made of a request and of its answer, and which characters a program did not get: what whoever has asked,
// and the PLC, have heard is compared with what was sent, and what is known to have disturbed it is named.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/trace/text/trace_lines.hpp"
#include "interpreter/trace/trace.hpp"
#include "tools/session/causes/line/asked_request.hpp"
#include "tools/session/causes/line/line_faults.hpp"
#include "tools/session/causes/line/line_traffic.hpp"

namespace s7200::tools {

/// It must be told the records of all stations, in their order.
class LineAccount final {
 public:
  /// Of the line that a port of the station is on. The history must live as long as this.
  LineAccount(History& history, std::size_t station, std::uint8_t port);

  /// The past is about to be played, and has been: faults that happen in between count.
  void begin();
  void end();

  void note(std::size_t station, const TraceRecord& record);

  /// Something is about to be done from outside, or was done.
  void note_action() {
    traffic_.note_hosts();
    faults_.note_cable();
  }

  /// What the system file had planned was done.
  void note_planned() { faults_.note_cable(); }

  /// Characters of a frame that no routine got, all for the same reason, and that the PLC has sent nothing after.
  struct Untaken {
    TraceRecord first{};
    std::size_t characters = 0;
    Time end = 0;  ///< of the last
  };
  const std::vector<Untaken>& untaken() const { return untaken_; }

  /// What has become of a request, and of what was sent for it, if the line is to blame: nothing as long as the request or
  /// an answer is under way.
  std::vector<TraceLine> lost(const AskedRequest& request) const;

  /// `the cable between scada and slave2 has been cut since 4000.000000 ms`: between who asked and a PLC of the line, while
  /// the request was sent; empty if it was whole.
  std::string cut_to(const AskedRequest& request, std::size_t station) const {
    return cut_between(request, station, request.start, request.end);
  }

 private:
  using Heard = std::vector<ReceivedCharacter>;

  serial::Simulation& here() const { return history_.station(station_); }
  const Freeport& freeport() const { return here().cpu().state().port[port_]; }
  Sent answer_to(const AskedRequest& request, const Heard& heard) const;
  bool is_request_too(const AskedRequest& request, const Sent& sent) const;
  Heard heard_of_answer(const AskedRequest& request) const;
  std::optional<TraceLine> lost_answer(const AskedRequest& request, Heard heard, const Sent& answer) const;
  std::optional<TraceLine> answer_going_on(const AskedRequest& request) const;
  std::optional<TraceLine> answer_not_begun(const AskedRequest& request) const;
  std::optional<TraceLine> break_instead(const AskedRequest& request) const;
  std::optional<TraceLine> without_pause(const AskedRequest& request) const;
  std::optional<TraceLine> lost_request(const AskedRequest& request) const;
  std::optional<TraceLine> made_by_others(const AskedRequest& request, const Heard& heard) const;
  std::optional<TraceLine> lost_by_itself(const AskedRequest& request, const Heard& heard) const;
  std::string frames_text(const AskedRequest& request, const Heard& heard) const;
  std::string sent_text(const Sent& sent) const;
  std::vector<std::string> faults_in(const AskedRequest& request, const Sent& frame) const;
  std::string cut_between(const AskedRequest& request, std::size_t station, Time from, Time to) const;
  std::string other_format(const AskedRequest& request) const;
  std::string reasons(const AskedRequest& request, const Sent& answer) const;
  void note_untaken(const TraceRecord& record);
  std::vector<std::string> others_in(const AskedRequest& request, const Sent& frame) const;

  History& history_;
  std::size_t station_, line_;
  std::uint8_t port_;
  LineTraffic traffic_;
  LineFaults faults_;
  std::vector<Untaken> untaken_;
};

}  // namespace s7200::tools
