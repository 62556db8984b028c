// A session of the Debug Adapter Protocol without a process, for tests: requests in, responses and events out.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "interpreter/analysis/warnings/check.hpp"
#include "tools/faces/dap/session.hpp"

namespace s7200::tools::dap {

/// A PLC alone.
class BareDebuggee final : public Debuggee {
 public:
  explicit BareDebuggee(std::shared_ptr<const Program> program)
      : program_(std::move(program)), simulation_(std::make_unique<serial::Simulation>(program_)) {
    simulation_->power_up();
    history_ = std::make_unique<History>(*simulation_, History::Settings{});
  }

  serial::Simulation& simulation() { return *simulation_; }
  std::string source() const override { return program_->source.name; }
  History& history() override { return *history_; }
  SessionSetup setup() override {
    return {.take_failure = [this] { return std::exchange(failure_text, {}); }};
  }
  void when_saying(std::function<void(const std::string&)>) override {}
  std::vector<std::string> finish() override {
    ++finished;
    return {};
  }

  int finished = 0;
  std::string failure_text;

 private:
  std::shared_ptr<const Program> program_;
  std::unique_ptr<serial::Simulation> simulation_;
  std::unique_ptr<History> history_;
};

class Editor {
 public:
  explicit Editor(std::shared_ptr<const Program> program)
      : debuggee(std::make_shared<BareDebuggee>(std::move(program))),
        session({.launch = [this](const Json&) { return debuggee; },
                 .attachable = debuggee,
                 .stop_request = StopToken(stop),
                 .patience = std::chrono::milliseconds(0)},
                [this](const Json& message) { messages.push_back(message); }) {}
  explicit Editor(std::string_view text) : Editor(check_text(text, "test.stl", cpu214(), default_times(cpu214())).program) {}

  /// The response, whatever it is. What a request starts runs until it stops.
  Json ask(const std::string& command, Json arguments = Json::object()) {
    const std::size_t first = messages.size();
    session.handle({{"seq", ++sent_}, {"type", "request"}, {"command", command}, {"arguments", std::move(arguments)}});
    Json response;
    for (std::size_t i = first; i < messages.size(); ++i)
      if (messages[i]["type"] == "response") response = messages[i];
    if (session.runs()) session.run();
    EXPECT_EQ(response.value("request_seq", 0), sent_);
    return response;
  }

  /// The body of a good response.
  Json operator()(const std::string& command, Json arguments = Json::object()) {
    const Json response = ask(command, std::move(arguments));
    EXPECT_TRUE(response["success"]) << response.dump(1);
    return response.value("body", Json::object());
  }
  std::string error_of(const std::string& command, Json arguments = Json::object()) {
    const Json response = ask(command, std::move(arguments));
    EXPECT_FALSE(response["success"]) << response.dump(1);
    return response.value("message", "");
  }

  /// Up to the first stop: at the entry, unless `launch` says something else.
  void begin(Json launch = {{"stopOnEntry", true}}) {
    (*this)("initialize", {{"adapterID", "s7200"}, {"supportsProgressReporting", true}, {"supportsMemoryEvent", true}});
    (*this)("launch", std::move(launch));
    (*this)("configurationDone");
  }

  /// The last event of a kind; null without one.
  Json last(const std::string& event) const {
    for (auto i = messages.rbegin(); i != messages.rend(); ++i)
      if ((*i)["type"] == "event" && (*i)["event"] == event) return i->value("body", Json::object());
    return {};
  }
  std::string stopped() const {
    const Json body = last("stopped");
    return body.is_null() ? "not at all" : body["reason"].get<std::string>();
  }
  Json frame(std::size_t number = 0) { return (*this)("stackTrace", {{"threadId", 1}})["stackFrames"][number]; }
  int line() { return frame()["line"]; }
  std::string value(const std::string& expression) { return (*this)("evaluate", {{"expression", expression}})["result"]; }
  /// All that was printed.
  std::string printed() const {
    std::string text;
    for (const Json& message : messages)
      if (message.value("event", "") == "output") text += message["body"]["output"].get<std::string>();
    return text;
  }
  Json lines(std::initializer_list<int> lines) {
    Json breakpoints = Json::array();
    for (const int line : lines) breakpoints.push_back({{"line", line}});
    return (*this)("setBreakpoints", {{"source", {{"path", "test.stl"}}}, {"breakpoints", breakpoints}})["breakpoints"];
  }
  Json breakpoint(Json wanted) {
    return (*this)("setBreakpoints", {{"source", {{"path", "test.stl"}}},
                                      {"breakpoints", Json::array({std::move(wanted)})}})["breakpoints"][0];
  }
  const State& state() const { return debuggee->simulation().cpu().state(); }

  std::atomic<bool> stop = false;
  std::vector<Json> messages;
  std::shared_ptr<BareDebuggee> debuggee;
  Session session;

 private:
  int sent_ = 0;
};

/// Two subroutines and a timed interrupt every 5 ms; VW10 counts scans, VW30 interrupts.
inline constexpr std::string_view kNested =
    "NETWORK 1\n"                                 // 1
    "LD      SM0.1\n"                             // 2
    "CALL    1\n"                                 // 3
    "NETWORK 2\n"                                 // 4
    "LD      SM0.0\n"                             // 5
    "INCW    VW10            // one more scan\n"  // 6
    "MEND\n"                                      // 7
    "SBR     1\n"                                 // 8
    "LD      SM0.0\n"                             // 9
    "MOVB    5, SMB34\n"                          // 10
    "ATCH    0, 10\n"                             // 11
    "ENI\n"                                       // 12
    "MOVD    &VB20, VD100\n"                      // 13
    "CALL    2\n"                                 // 14
    "RET\n"                                       // 15
    "SBR     2\n"                                 // 16
    "LD      SM0.0\n"                             // 17
    "MOVB    7, *VD100\n"                         // 18
    "RET\n"                                       // 19
    "INT     0\n"                                 // 20
    "LD      SM0.0\n"                             // 21
    "INCW    VW30\n"                              // 22
    "RETI\n";                                     // 23

}  // namespace s7200::tools::dap
