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

/// The common part of the stations that are not PLCs.
class PeerStation : protected EventHandler {
 public:
  PeerStation(const PeerStation&) = delete;
  PeerStation& operator=(const PeerStation&) = delete;

  Uart& uart() { return uart_; }
  const Uart& uart() const { return uart_; }

 protected:
  /// Neither reference is owned. If the station is not plugged in, the owner of the UART plugs it in.
  PeerStation(Dispatcher& events, SharedLine& line, bool plugged_in = true);
  ~PeerStation() = default;

  /// Passes an event to the UART.
  Uart::Report hear(const Event& event);

  SharedLine& line_;
  EventQueue& queue_;
  Uart uart_;
};

class RequesterStation final : public PeerStation {
 public:
  /// Plain, so that a snapshot is a copy.
  struct State {
    Uart::State uart;
    Requester::State requester;
    bool operator==(const State&) const = default;
  };

  RequesterStation(Dispatcher& events, SharedLine& line);

  Requester& requester() { return requester_; }
  const Requester& requester() const { return requester_; }

  State state() const { return {uart_.state(), requester_.state()}; }
  void restore(const State& state);

 private:
  void handle(const Event& event) override;

  Requester requester_;
};

class PollerStation final : public PeerStation {
 public:
  /// Plain, so that a snapshot is a copy.
  struct State {
    Uart::State uart;
    Requester::State requester;
    Poller::State poller;
    bool powered = true;
    bool operator==(const State&) const = default;
  };

  PollerStation(Dispatcher& events, SharedLine& line, PollPlan plan, Poller::Wiring wiring);

  Poller& poller() { return poller_; }
  const Poller& poller() const { return poller_; }

  /// The station falls silent at `at`, even in the middle of a character.
  void power_off(Time at);
  /// The station has power again, and sends its first request at `first`.
  void power_on(Time at, Time first);
  bool powered() const { return powered_; }

  State state() const { return {uart_.state(), requester_.state(), poller_.state(), powered_}; }
  void restore(const State& state);

 private:
  void handle(const Event& event) override;

  EventOwner requester_owner_;
  Requester requester_;
  Poller poller_;
  bool powered_ = true;
};

class ResponderStation final : public PeerStation, private FrameSender {
 public:
  /// Plain, so that a snapshot is a copy.
  struct State {
    Uart::State uart;
    Responder::State responder;
    bool powered = true;
    bool operator==(const State&) const = default;
  };

  ResponderStation(Dispatcher& events, SharedLine& line, std::unique_ptr<Automaton> automaton);

  Responder& responder() { return responder_; }
  const Responder& responder() const { return responder_; }

  /// The station falls silent at `at`, even in the middle of a character; it comes back with its memory and settings.
  void power_off(Time at);
  void power_on(Time at);
  bool powered() const { return powered_; }

  /// Lets `sink` watch the line at its port from `from` on; null ends that. Not owned. After restore() it sees time go back.
  void set_wire_sink(WireSink* sink, Time from) { tap_.watch(sink, from); }

  /// Tells those who watch the line that no driver gets another edge before `until`.
  void settle(Time until) { tap_.settle(until, uart_.state().format); }

  State state() const { return {uart_.state(), responder_.state(), powered_}; }

  /// Restores the station; `now` is the time of the whole system.
  void restore(const State& state, Time now);

 private:
  void handle(const Event& event) override;

  std::optional<std::size_t> characters_left() const override;

  WireTap tap_;
  Responder responder_;
  bool powered_ = true;
};

/// The host's station. It is plugged into the line when its port is attached.
class HostStation final : public PeerStation {
 public:
  /// Plain, so that a snapshot is a copy.
  struct State {
    Uart::State uart;
    HostPort::State port;
    bool operator==(const State&) const = default;
  };

  HostStation(Dispatcher& events, SharedLine& line);

  HostPort& port() { return port_; }
  const HostPort& port() const { return port_; }

  State state() const { return {uart_.state(), port_.state()}; }
  void restore(const State& state);

 private:
  void handle(const Event& event) override { port_.on(hear(event)); }

  HostPort port_;
};

}  // namespace s7200::serial
