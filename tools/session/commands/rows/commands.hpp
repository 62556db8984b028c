// The functions behind the table of commands, grouped as their files are. Each is told the words behind its name.
#pragma once

#include "tools/session/commands/reply.hpp"
#include "tools/session/commands/session.hpp"

namespace s7200::tools::commands {

// commands_running.cpp
Reply step(Session& session, const Words& words);
Reply over(Session& session, const Words& words);
Reply out(Session& session, const Words& words);
Reply network(Session& session, const Words& words);
Reply interrupt(Session& session, const Words& words);
Reply scan(Session& session, const Words& words);
Reply continue_run(Session& session, const Words& words);
Reply until(Session& session, const Words& words);

// commands_past.cpp
Reply back(Session& session, const Words& words);
Reply back_step(Session& session, const Words& words);
Reply back_over(Session& session, const Words& words);
Reply back_out(Session& session, const Words& words);
Reply back_network(Session& session, const Words& words);
Reply back_interrupt(Session& session, const Words& words);
Reply back_scan(Session& session, const Words& words);
Reply back_continue(Session& session, const Words& words);
Reply back_until(Session& session, const Words& words);
Reply at(Session& session, const Words& words);
Reply fork(Session& session, const Words& words);
Reply past(Session& session, const Words& words);
Reply actions(Session& session, const Words& words);
Reply restart(Session& session, const Words& words);

// commands_causes.cpp
Reply who(Session& session, const Words& words);
Reply back_to_write(Session& session, const Words& words);
Reply effect(Session& session, const Words& words);
Reply why(Session& session, const Words& words);
Reply back_to_decision(Session& session, const Words& words);
Reply history(Session& session, const Words& words);
Reply timeline(Session& session, const Words& words);

// commands_stops.cpp
Reply set_break(Session& session, const Words& words);
Reply watch(Session& session, const Words& words);
Reply delete_stop(Session& session, const Words& words);

// commands_print.cpp
Reply print(Session& session, const Words& words);
Reply expect(Session& session, const Words& words);
Reply display(Session& session, const Words& words);

// commands_looking.cpp
Reply station(Session& session, const Words& words);
Reply list(Session& session, const Words& words);
Reply status(Session& session, const Words& words);
Reply ladder(Session& session, const Words& words);
Reply registers(Session& session, const Words& words);
Reply stack(Session& session, const Words& words);
Reply port(Session& session, const Words& words);
Reply errors(Session& session, const Words& words);
Reply trace(Session& session, const Words& words);
Reply layout(Session& session, const Words& words);
Reply quit(Session& session, const Words& words);

// commands_pages.cpp
Reply listing(Session& session, const Words& words);
Reply values(Session& session, const Words& words);
Reply spans(Session& session, const Words& words);

// commands_plc.cpp
Reply set(Session& session, const Words& words);
Reply input(Session& session, const Words& words);
Reply force(Session& session, const Words& words);
Reply unforce(Session& session, const Words& words);
Reply mode(Session& session, const Words& words);
Reply power(Session& session, const Words& words);
Reply send(Session& session, const Words& words);
Reply fault(Session& session, const Words& words);

// commands_files.cpp
Reply save(Session& session, const Words& words);
Reply load(Session& session, const Words& words);
Reply record(Session& session, const Words& words);

}  // namespace s7200::tools::commands
