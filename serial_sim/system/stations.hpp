// The peers as stations: a UART on a line, and who uses it.
#pragma once

#include "serial_sim/line/uart.hpp"
#include "serial_sim/line/wire_tap.hpp"
#include "serial_sim/peers/host_port.hpp"
#include "serial_sim/peers/poller.hpp"
#include "serial_sim/peers/requester.hpp"
#include "serial_sim/peers/responder.hpp"
#include "serial_sim/system/dispatcher.hpp"
#include "serial_sim/system/shared_line.hpp"

namespace s7200::serial {

class RequesterStation final : private EventHandler {
 public:
  /// Plain, so that a snapshot is a copy.
  struct State {
    Uart::State uart;
    Requester::State requester;
    bool operator==(const State&) const = default;
  };

  /// Neither is owned.
  RequesterStation(Dispatcher& events, SharedLine& line);
  RequesterStation(const RequesterStation&) = delete;
  RequesterStation& operator=(const RequesterStation&) = delete;

  Uart& uart() { return uart_; }
  Requester& requester() { return requester_; }
  const Requester& requester() const { return requester_; }

  State state() const { return {uart_.state(), requester_.state()}; }
  void restore(const State& state);

 private:
  void handle(const Event& event) override;

  SharedLine& line_;
  EventQueue& queue_;
  Uart uart_;
  Requester requester_;
};

class PollerStation final : private EventHandler {
 public:
  /// Plain, so that a snapshot is a copy.
  struct State {
    Uart::State uart;
    Requester::State requester;
    Poller::State poller;
    bool operator==(const State&) const = default;
  };

  /// Neither reference is owned.
  PollerStation(Dispatcher& events, SharedLine& line, PollPlan plan, Poller::Wiring wiring);
  PollerStation(const PollerStation&) = delete;
  PollerStation& operator=(const PollerStation&) = delete;

  const Uart& uart() const { return uart_; }
  Poller& poller() { return poller_; }
  const Poller& poller() const { return poller_; }

  State state() const { return {uart_.state(), requester_.state(), poller_.state()}; }
  void restore(const State& state);

 private:
  void handle(const Event& event) override;

  SharedLine& line_;
  EventQueue& queue_;
  Uart uart_;
  EventOwner requester_owner_;
  Requester requester_;
  Poller poller_;
};

class ResponderStation final : private EventHandler {
 public:
  /// Plain, so that a snapshot is a copy.
  struct State {
    Uart::State uart;
    Responder::State responder;
    bool operator==(const State&) const = default;
  };

  /// Neither reference is owned.
  ResponderStation(Dispatcher& events, SharedLine& line, std::unique_ptr<Automaton> automaton);
  ResponderStation(const ResponderStation&) = delete;
  ResponderStation& operator=(const ResponderStation&) = delete;

  Uart& uart() { return uart_; }
  const Uart& uart() const { return uart_; }
  Responder& responder() { return responder_; }
  const Responder& responder() const { return responder_; }

  /// Lets `sink` watch the line at its port from `from` on; null ends that. Not owned. After restore() it sees time go back.
  void set_wire_sink(WireSink* sink, Time from) { tap_.watch(sink, from); }

  /// No driver of the line gets an edge before `until` any more: whoever watches it is told.
  void settle(Time until) { tap_.settle(until, uart_.state().format); }

  State state() const { return {uart_.state(), responder_.state()}; }

  /// `now` is the time of the whole system.
  void restore(const State& state, Time now);

 private:
  void handle(const Event& event) override;

  SharedLine& line_;
  EventQueue& queue_;
  Uart uart_;
  WireTap tap_;
  Responder responder_;
};

class HostStation final : private EventHandler {
 public:
  /// Plain, so that a snapshot is a copy.
  struct State {
    Uart::State uart;
    HostPort::State port;
    bool operator==(const State&) const = default;
  };

  /// Neither is owned. It is plugged into the line when the port is attached.
  HostStation(Dispatcher& events, SharedLine& line);
  HostStation(const HostStation&) = delete;
  HostStation& operator=(const HostStation&) = delete;

  int driver() const { return uart_.driver(); }
  HostPort& port() { return port_; }
  const HostPort& port() const { return port_; }

  State state() const { return {uart_.state(), port_.state()}; }
  void restore(const State& state);

 private:
  void handle(const Event& event) override;

  SharedLine& line_;
  EventQueue& queue_;
  Uart uart_;
  HostPort port_;
};

}  // namespace s7200::serial
