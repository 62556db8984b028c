// What is between a client and a session: what the client can do, what is debugged, and how each hears of the other.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/faces/dap/requests/sources.hpp"
#include "tools/faces/dap/session.hpp"
#include "tools/session/commands/session.hpp"

namespace s7200::tools::dap {

/// From the numbers of a station's frames to those of the next one; and of what has variables.
inline constexpr std::int64_t kFramesOfAStation = 1 << 16, kContainersOfAStation = 1 << 23;

enum class StopKind : std::uint8_t { Line, Function, Data, Instruction, Exception };

/// A breakpoint that the client has set.
struct Placed {
  StopKind kind{};
  std::string group{};  ///< of lines: the file
  Json wanted{};
  Json answer{};  ///< what was said about it
};

/// A run under way.
struct RunUnderWay {
  Stepper::Goal goal;
  std::string reason;   ///< of the stop when the goal is met
  Time until = kNever;  ///< of a step of a PLC that executes nothing
};

/// An area of memory that the client has read.
struct ReadArea {
  std::vector<std::uint8_t> bytes{};   ///< as the client knows them
  std::set<std::string> references{};  ///< by which the client has asked for it
};

/// What the client can do.
struct ClientTraits {
  std::uint32_t line_base = 1, column_base = 1;
  bool shows_progress = false, takes_memory_events = false, takes_invalidation = false, takes_uris = false;
};

/// What the launch or the attach asks for.
struct Begun {
  Json with{};  ///< its arguments
  bool attached = false, stop_on_entry = false, no_debug = false, steps_are_networks = false;
  std::string folder{};                 ///< where the client's relative paths begin; empty: at the command's
  std::vector<serial::Frame> frames{};  ///< to be sent
  std::uint8_t slave = 1;               ///< of requests that name none
  Time send_after = 0;
};

struct Conversation final : Onlooker {
  Conversation(SessionSettings its_settings, Session::Send its_send)
      : settings(std::move(its_settings)), send(std::move(its_send)) {}

  // Telling the client.
  void send_event(const std::string& event, Json body);
  void respond(const Json& request, bool success, Json body, const std::string& message = {});
  void print(const std::string& text, const std::string& category = "console", std::optional<std::uint32_t> op = {});
  void print_of(std::size_t station, const std::string& text, const std::string& category, std::optional<std::uint32_t> op);
  void after_response(std::function<void()> action) { later.push_back(std::move(action)); }
  void tell(std::string_view lines) override { print(std::string(lines)); }

  // What is looked at.
  bool runs() const { return running.has_value(); }
  std::size_t stations() const { return debuggee->history().stations(); }
  std::size_t looks_at() const { return session->focus(); }
  std::int64_t thread() const { return static_cast<std::int64_t>(looks_at()) + 1; }
  serial::Simulation& simulation() const { return session->simulation(); }
  const Cpu& cpu() const { return session->cpu(); }
  const Program& program_of(std::size_t station) const { return session->stations[station].simulation->cpu().program(); }
  const Listing& listing() const { return session->listing(); }
  const Sources& sources() const { return sources_of[looks_at()]; }
  const serial::MasterSettings& master() const { return session->master(looks_at()); }
  std::string said_of(std::size_t station) const { return session->said_of(station); }

  // Places as the client names them.
  std::size_t station_with(const std::string& path) const;
  std::string source_path(const Json& arguments) const;
  std::uint32_t client_line(std::uint32_t line) const { return client.line_base == 1 ? line : line - 1; }
  std::uint32_t client_line_in(const Json& arguments, const char* key = "line") const;
  std::uint32_t line_of_client(std::uint32_t line) const { return client.line_base == 1 ? line : line + 1; }
  Json client_place(std::uint32_t op) const;

  SessionSettings settings;
  Session::Send send;
  std::int64_t sent = 0, handling = 0;  ///< numbers: of the last message, and of the request
  std::vector<std::function<void()>> later{};

  ClientTraits client{};
  // What is debugged.
  std::shared_ptr<Debuggee> debuggee{};
  std::unique_ptr<tools::Session> session{};
  std::deque<Sources> sources_of{};  ///< by station
  Begun begun{};
  std::vector<Time> frames_sent{};  ///< when, on this branch

  // The run under way, where it stops, and the last stop.
  std::map<int, Placed> placed{};
  std::optional<RunUnderWay> running{};
  bool pause_asked = false, over = false, terminated = false;
  std::map<std::size_t, Json> exceptions{};                                      ///< by station
  std::map<std::int64_t, std::pair<std::size_t, std::uint32_t>> goto_targets{};  ///< station and instruction
  std::map<std::pair<std::size_t, std::uint32_t>, ReadArea> read{};              ///< by station and the area's beginning
};

/// While it lives another station is looked at.
class LookAt {
 public:
  LookAt(Conversation& talk, std::size_t station) : stepper_(talk.session->stepper), before_(stepper_.looks_at()) {
    stepper_.look_at(station);
  }
  ~LookAt() { stepper_.look_at(before_); }
  LookAt(const LookAt&) = delete;
  LookAt& operator=(const LookAt&) = delete;

 private:
  Stepper& stepper_;
  std::size_t before_;
};

}  // namespace s7200::tools::dap
