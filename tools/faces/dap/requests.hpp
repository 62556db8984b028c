// The requests, a table for each file of them, and what these files have for each other.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/faces/dap/wire/conversation.hpp"
#include "tools/session/commands/reply.hpp"

namespace s7200::tools::dap {

enum class Needs : std::uint8_t { Nothing, Program, Standstill };

struct Request {
  std::string_view command;
  Json (*handler)(Conversation& talk, const Json& arguments);  ///< null: the request is a command of the session
  Needs needs = Needs::Program;
};

std::vector<Request> life_requests();
std::vector<Request> breakpoints_requests();
std::vector<Request> steps_requests();
std::vector<Request> seeing_requests();
std::vector<Request> memory_requests();
std::vector<Request> commands_requests();

// life.cpp
void start(Conversation& talk);
/// The program that a launch began ends; one that was attached to stays as it stands.
void end_debuggee(Conversation& talk);
void leave(Conversation& talk);

// breakpoints.cpp
/// Those that a command has set are known to the client by what they are called, as functions are.
StopKind kind_of(const Conversation& talk, int number);

// steps.cpp
/// From the end of the request on it runs.
void run_to(Conversation& talk, Stepper::Goal goal, const std::string& reason);
/// Until it stops, or a stop request.
void run_on(Conversation& talk);
void stopped_at(Conversation& talk, const std::string& reason, const std::string& description);

// seeing.cpp
/// What a pointer that points nowhere has and, while the program stands still, who wrote it.
std::string text_of_bad_pointer(Conversation& talk, const std::string& name, const MemoryRange& pointer);

// memory.cpp
/// Does something to the PLC that is looked at. In the past it begins a new branch, and says so.
void act(Conversation& talk, Action action);
/// What the client shows of memory may be another one now.
void note_change(Conversation& talk);
/// On a branch that has begun, frames that were sent later than where it begins are still to be sent.
void note_branch(Conversation& talk, const History::BranchPtr& before);
/// Of what the client has read: the bytes from the first to the last that is different now.
void report_memory_changes(Conversation& talk);
/// What is wrong with a request that needs the CPU; empty as long as it has power.
std::string without_power(Conversation& talk);

// commands.cpp
/// Executes a command of the session; throws Refused if it is wrong. The client does not know yet that it has moved.
Reply executed(Conversation& talk, const Words& command);
Json run_command(Conversation& talk, const std::string& request, const Json& arguments);
/// A name that is a command's is that command; what is cut short may be an expression.
bool is_command(const std::string& line, const Program& program);
/// Commands, which `;` separates. Where they have moved the session, the client is told that it has stopped there.
Json console(Conversation& talk, const std::string& line);
[[noreturn]] void refuse_interrupted();

}  // namespace s7200::tools::dap
