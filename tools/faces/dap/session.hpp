// A session of the Debug Adapter Protocol (1.68): messages in, messages out. It knows no streams and no threads.
//
// Each CPU is shown as a thread; its frames are the routines that are open. A line is an instruction, a statement in the
// sense of the protocol is a network. Every step and stop has its brother that goes back in time.
//
// Of the stations of a system it looks at one: the one that has stopped, or that a request names by a thread, a frame, a
// variable or memory. All of them run and stand still together.
//
// Messages may come while the program runs: whoever runs it has run() end by the stop request, hands the messages over, and
// goes on if runs() says so. The program does what it does in one go.
#pragma once

#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/faces/dap/addresses.hpp"
#include "tools/faces/dap/attributes.hpp"
#include "tools/faces/dap/debuggee.hpp"
#include "tools/faces/dap/sources.hpp"
#include "tools/faces/dap/variables.hpp"
#include "tools/session/commands/reply.hpp"
#include "tools/session/commands/session.hpp"
#include "tools/session/stops/stepper.hpp"
#include "tools/views/listing.hpp"

namespace s7200::tools::dap {

/// From the numbers of a station's frames to those of the next one; and of what has variables.
inline constexpr std::int64_t kFramesOfAStation = 1 << 16, kContainersOfAStation = 1 << 23;

struct SessionSettings {
  /// Powers up what a launch asks for; throws Refused.
  std::function<std::shared_ptr<Debuggee>(const Json& arguments)> launch;
  std::shared_ptr<Debuggee> attachable{};           ///< that was there before the session, and stays
  const std::atomic<bool>* stop_request = nullptr;  ///< ends what is going on
  std::chrono::milliseconds patience{500};          ///< after this long progress is reported
};

class Session final : private Onlooker {
 public:
  using Send = std::function<void(const Json& message)>;

  Session(SessionSettings settings, Send send);
  ~Session() override;

  void handle(const Json& message);

  /// A request that was taken back before its turn.
  void refuse(const Json& message, const std::string& why);

  /// Something came that is no message and was skipped: what is wrong with it.
  void complain(const std::string& wrong);

  /// Whether the program is running, and how it goes on: until it stops, or a stop request.
  bool runs() const { return running_.has_value(); }
  void run();

  bool is_over() const { return over_; }

  /// The client has gone without a word.
  void abandon();

 private:
  using Handler = Json (Session::*)(const Json& arguments);
  enum class Needs : std::uint8_t { Nothing, Program, Standstill };
  struct Request {
    std::string_view command;
    Handler handler;  ///< null: the request is a command
    Needs needs = Needs::Program;
  };
  static const std::vector<Request>& requests();
  static std::vector<Request> with_commands(std::vector<Request> table);
  Json dispatch(const Request& request, const Json& arguments);
  std::optional<std::size_t> take_station(Json& arguments) const;

  // Life of the session (session.cpp).
  Json initialize(const Json& arguments);
  Json launch(const Json& arguments);
  Json attach(const Json& arguments);
  Json configuration_done(const Json& arguments);
  Json restart(const Json& arguments);
  Json terminate(const Json& arguments);
  Json disconnect(const Json& arguments);
  Json cancel(const Json& arguments);
  void read_attributes(const Json& arguments, bool stops_on_entry);
  void note_without_effect(const Json& arguments, std::initializer_list<AttributeUse> uses, const std::string& why);
  void take_changed_arguments(const Json& arguments);
  void begin(std::shared_ptr<Debuggee> debuggee);
  void read_frames(const Json& arguments);
  void start();
  void end_debuggee();
  void leave();

  // Where to stop (session_breakpoints.cpp).
  enum class StopKind : std::uint8_t { Line, Function, Data, Instruction, Exception };
  struct Placed {
    StopKind kind{};
    std::string group{};  ///< of lines: the file
    Json wanted{};
    Json answer{};  ///< what was said about it
  };
  Json set_breakpoints(const Json& arguments);
  Json set_function_breakpoints(const Json& arguments);
  Json set_data_breakpoints(const Json& arguments);
  Json set_instruction_breakpoints(const Json& arguments);
  Json set_exception_breakpoints(const Json& arguments);
  Json breakpoint_locations(const Json& arguments);
  Json data_breakpoint_info(const Json& arguments);
  Json exception_info(const Json& arguments);
  using MakeStops = std::function<std::vector<StopPoint>(const Json& wanted, Json& answer)>;
  Json place(StopKind kind, const std::string& group, const Json& wanted, const MakeStops& make);
  void take_away(int number);
  StopKind kind_of(int number) const;
  StopPoint with_conditions(StopPoint stop, const Json& wanted) const;
  StopPoint stop_at(std::uint32_t op) const;
  using StopOfStation = std::function<std::optional<StopPoint>(std::string& why)>;
  std::vector<StopPoint> at_all_stations(const Json& wanted, Json& answer, const StopOfStation& find);
  std::vector<StopPoint> line_stops(const std::string& path, const Json& wanted, Json& answer);
  std::vector<StopPoint> function_stops(const Json& wanted, Json& answer);
  std::vector<StopPoint> data_stops(const Json& wanted);
  std::vector<StopPoint> exception_stops(const Json& wanted) const;
  std::size_t first_on(std::size_t line) const;
  std::vector<StopPoint> at_each_station(StopPoint stop) const;

  // Running (session_steps.cpp).
  struct Run {
    Stepper::Goal goal;
    std::string reason;   ///< of the stop when the goal is met
    Time until = kNever;  ///< of a step of a PLC that executes nothing
  };
  Json go_on(const Json& arguments);
  Json next(const Json& arguments);
  Json step_in(const Json& arguments);
  Json step_out(const Json& arguments);
  Json step_scan(const Json& arguments);
  Json step_interrupt(const Json& arguments);
  Json pause(const Json& arguments);
  Json step_back(const Json& arguments);
  Json reverse_continue(const Json& arguments);
  Json reverse_step_over(const Json& arguments);
  Json reverse_step_out(const Json& arguments);
  Json reverse_step_scan(const Json& arguments);
  Json reverse_step_interrupt(const Json& arguments);
  Json goto_targets(const Json& arguments);
  Json go_to(const Json& arguments);
  Json go_to_moment(const Json& arguments);
  bool by_networks(const Json& arguments) const;
  void run_to(Stepper::Goal goal, const std::string& reason);
  void run_back(Stepper::Goal goal, std::uint64_t count);
  Stop searched_back(const Stepper::Goal& goal, std::uint64_t count);
  bool send_what_is_due();
  void report(const Stop& stop, const std::string& reason);
  void report_failure(const Stop& stop, const std::string& failure);
  void report_error(std::size_t station, const TraceRecord& error);
  void report_stopped(Json body);
  Json body_of(const Stop& stop, const std::string& reason);
  Json body_of_hits(const Stop& stop);
  static std::string exception_of(const Hit& hit);
  Json body_of_hit(const Hit& hit);
  static std::string_view reason_of(StopKind kind);
  Json body_of_fatal_error();
  bool has_gone_back_to(std::uint32_t op);
  std::string text_of(const Hit& hit) const;
  void stopped_at(const std::string& reason, const std::string& description);
  void show_the_past();

  // What there is to see (session_seeing.cpp).
  Json threads(const Json& arguments);
  Json stack_trace(const Json& arguments);
  Json scopes(const Json& arguments);
  Json variables(const Json& arguments);
  Json loaded_sources(const Json& arguments);
  Json source(const Json& arguments);
  Json evaluate(const Json& arguments);
  Json completions(const Json& arguments);
  Json offers_of_command(const std::string& before) const;
  Json disassemble(const Json& arguments);
  Json stack_frame(std::uint32_t number, std::uint32_t op, const std::string& name) const;
  Json evaluated(const std::string& expression, bool hex);
  std::string text_of_bad_pointer(const std::string& name, const MemoryRange& pointer);
  std::string resolved_text(std::uint32_t op) const;

  // Memory (session_memory.cpp).
  Json read_memory(const Json& arguments);
  Json write_memory(const Json& arguments);
  Json set_variable(const Json& arguments);
  Json set_expression(const Json& arguments);
  Json set_level(const Variable& level, const std::string& value);
  Json assign(const std::string& expression, const std::string& value);
  MemoryRange range_for(const std::string& expression) const;
  void write_image(const MemoryPlace& place, std::uint32_t first, const std::vector<std::uint8_t>& bytes);
  void write_levels(const MemoryPlace& place, std::uint32_t first, const std::vector<std::uint8_t>& bytes);
  std::string without_power() const;
  void note_change();
  void act(Action action);
  void note_branch(const History::BranchPtr& before);
  void report_memory_changes();

  // What the protocol has no requests for: commands, and what is like them (session_commands.cpp).
  Json console(const std::string& line);
  std::string said_by(const std::string& command);
  void report_console(bool has_moved);
  static bool is_command(const std::string& line, const Program& program);
  Json run_command(const std::string& request, const Json& arguments);
  Json timeline(const Json& arguments);
  Json stl_status(const Json& arguments);
  Json placed(Json json) const;
  Reply executed(const Words& command);
  void note_changed_stops(const std::set<int>& before);
  std::set<int> stop_numbers() const;

  // Sending.
  void send_event(const std::string& event, Json body);
  void respond(const Json& request, bool success, Json body, const std::string& message = {});
  void print(const std::string& text, const std::string& category = "console", std::optional<std::uint32_t> op = {});
  void print_of(std::size_t station, const std::string& text, const std::string& category, std::optional<std::uint32_t> op);
  void after_response(std::function<void()> action) { later_.push_back(std::move(action)); }
  [[noreturn]] void refuse_interrupted() const;
  void tell(std::string_view lines) override { print(std::string(lines)); }

  std::size_t stations() const { return debuggee_->history().stations(); }
  std::size_t looks_at() const { return session_->focus(); }
  serial::Simulation& simulation() const { return debuggee_->history().station(looks_at()); }
  const serial::MasterSettings& master() const { return session_->master(looks_at()); }
  const Program& program_of(std::size_t station) const { return session_->stations[station].simulation->cpu().program(); }
  const Listing& listing() const { return session_->listing(); }
  const Sources& sources() const { return sources_[looks_at()]; }
  const Cpu& cpu() const { return simulation().cpu(); }
  std::string said_of(std::size_t station) const;  ///< `slave: `; nothing if there is but one PLC
  std::int64_t thread() const { return static_cast<std::int64_t>(looks_at()) + 1; }

  /// While it lives another station is looked at.
  class LookAt {
   public:
    LookAt(Session& session, std::size_t station) : stepper_(session.session_->stepper), before_(stepper_.looks_at()) {
      stepper_.look_at(station);
    }
    ~LookAt() { stepper_.look_at(before_); }
    LookAt(const LookAt&) = delete;
    LookAt& operator=(const LookAt&) = delete;

   private:
    Stepper& stepper_;
    std::size_t before_;
  };
  std::size_t station_with(const std::string& path) const;
  std::string source_path(const Json& arguments) const;
  std::uint32_t client_line(std::uint32_t line) const { return line_base_ == 1 ? line : line - 1; }
  std::uint32_t client_line_in(const Json& arguments, const char* key = "line") const;
  std::uint32_t line_of_client(std::uint32_t line) const { return line_base_ == 1 ? line : line + 1; }
  Json client_place(std::uint32_t op) const;

  SessionSettings settings_;
  Send send_;
  std::int64_t sent_ = 0;
  std::vector<std::function<void()>> later_;

  // What the client can do.
  std::uint32_t line_base_ = 1, column_base_ = 1;
  bool client_shows_progress_ = false, client_takes_memory_events_ = false, client_takes_invalidation_ = false;
  bool client_takes_uris_ = false;

  // What is debugged.
  std::shared_ptr<Debuggee> debuggee_;
  bool attached_ = false;
  std::unique_ptr<tools::Session> session_;
  std::deque<Sources> sources_;  ///< by station
  bool stop_on_entry_ = false, no_debug_ = false, steps_are_networks_ = false;
  std::string folder_;                 ///< where the client's relative paths begin; empty: at the command's
  std::vector<serial::Frame> frames_;  ///< to be sent, as the launch asks for
  std::vector<Time> frames_sent_;      ///< when, on this branch
  Json begun_with_;                    ///< the arguments of launch or attach
  std::uint8_t slave_ = 1;             ///< of requests that name none
  Time send_after_ = 0;

  // Where to stop.
  std::map<int, Placed> placed_;

  // The run under way, and the last stop.
  std::optional<Run> running_;
  bool pause_asked_ = false, over_ = false, terminated_ = false;
  std::map<std::size_t, Json> exceptions_;                                      ///< of the last stop, by station
  std::map<std::int64_t, std::pair<std::size_t, std::uint32_t>> goto_targets_;  ///< station and instruction
  /// An area that the client has read.
  struct ReadArea {
    std::vector<std::uint8_t> bytes{};   ///< as the client knows them
    std::set<std::string> references{};  ///< by which the client has asked for it
  };
  std::map<std::pair<std::size_t, std::uint32_t>, ReadArea> read_;  ///< by station and the beginning of the area
  std::int64_t handling_ = 0;                                       ///< number of the request
};

}  // namespace s7200::tools::dap
