// What commands have in common that run something, go elsewhere, or do something to the PLC.
#pragma once

#include <cstdint>
#include <string>

#include "tools/session/commands/reply.hpp"
#include "tools/session/commands/session.hpp"

namespace s7200::tools {

struct RunTo {
  static constexpr Time kUsualLimit = 10 * kSecond;

  Stepper::Goal goal;
  Time limit = kUsualLimit;  ///< from now on
  bool stop_at_answer = false;
  Session::Show show = Session::Show::None;
  bool of_all = false;       ///< of all stations, and not of the one that it looks at
  bool to_scan_end = false;  ///< after the limit it goes on to the end of the scan
};

/// Runs, and says why it has stopped and where.
Reply go(Session& session, const RunTo& run);
Reply go_back(Session& session, const Stepper::Goal& goal, std::uint64_t count, bool stop_at_answer = false);

/// To a moment of this branch, and says where that is.
void go_to(Session& session, const Moment& moment);

/// Where `back` leads to from now on.
void remember(Session& session, History::Place place);
inline void remember(Session& session) { remember(session, session.history.here()); }

/// Does something to a station, or on its line. In the past a new branch begins, which is said.
void act(Session& session, Action action, std::size_t station);
inline void act(Session& session, Action action) { act(session, std::move(action), session.focus()); }

/// After it was begun.
void note_new_branch(Session& session);

/// Where it stands, and what is displayed.
void show_place(Session& session);

/// It has come elsewhere: what ran before says nothing of what comes. Says where, and whether that is in the past.
Reply arrive(Session& session);

/// `412.345678 ms  scan 7  INT 123 …`, without the line that it stands in front of.
std::string place_line(const Session& session, std::size_t station);

/// `slave1: 01 03 00 00 00 02 c4 0b, pump: 04 …`: of all masters, each named by the first PLC on its line.
std::string requests_under_way(const Session& session);

/// What a stop request has ended.
Reply interrupted(const Session& session);

/// What is wrong with a command that needs the CPU; empty as long as it has power.
std::string without_power(const Session& session, std::string_view command);
/// The same of a command that shows what was.
void say_without_power(Session& session);

}  // namespace s7200::tools
