// A PLC as a station: its CPU, a UART for each of the CPU's ports, and what drives its inputs.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "interpreter/cpu/cpu.hpp"
#include "interpreter/model/ports.hpp"
#include "serial_sim/field/field.hpp"
#include "serial_sim/line/uart.hpp"
#include "serial_sim/line/wire_tap.hpp"
#include "serial_sim/system/dispatcher.hpp"
#include "serial_sim/system/shared_line.hpp"

namespace s7200::serial {

/// An action of a CPU on a port at an instant, as plain data.
struct PortAction {
  enum class What : std::uint8_t { Configure, EnableReceiver, Send, SendBreak };
  What what{};
  Time at = 0;
  SerialFormat format{};  ///< Configure
  int value = 0;          ///< EnableReceiver: whether; Send: the byte; SendBreak: bit times
  bool operator==(const PortAction&) const = default;
};

/// An output point, as plain data.
struct OutputPoint {
  std::uint32_t byte = 0;
  std::uint8_t bit = 0;
  bool operator==(const OutputPoint&) const = default;
};

/// An edge at an output that something is wired to.
struct OutputEdge {
  std::size_t wire = 0;  ///< in the order in which they were wired
  bool on = false;
  Time at = 0;
  bool operator==(const OutputEdge&) const = default;
};

class Plc final : private EventHandler, private OutputListener {
 public:
  /// Plain, so that a snapshot is a copy.
  struct State {
    s7200::State cpu;
    std::array<Uart::State, kPorts.size()> uart;
    std::array<std::vector<PortAction>, kPorts.size()> actions;  ///< that are still to come
    std::vector<OutputEdge> output_edges{};                      ///< that are still to come, like the actions
    Field::State field;
    bool powered = true;
    std::uint64_t executed_before = 0;  ///< instructions, before power came back last
    std::array<std::uint64_t, kPorts.size()> framing_errors{};
    bool operator==(const State&) const = default;
  };

  /// `lines` has a line for each port of the program's CPU, by number. They are not owned.
  Plc(Dispatcher& events, std::span<SharedLine* const> lines, std::shared_ptr<const Program> program, FieldScript field);
  Plc(const Plc&) = delete;
  Plc& operator=(const Plc&) = delete;

  /// Power comes at `at`: the CPU goes into RUN with the retentive memory, and the field's script starts. In the system's
  /// time `at` is now, or nothing has run yet.
  void power_up(const RetentiveMemory* memory = nullptr, Time at = 0);

  /// Power goes off at `at`, and comes back: the CPU keeps what a real one keeps, and begins anew in RUN, or stays in STOP
  /// if its mode switch is in TERM.
  void power_off(Time at);
  void power_on(Time at);
  bool powered() const { return powered_; }

  /// Whether it executes a program: with power, and in RUN.
  bool executes() const { return powered_ && cpu_.state().mode == Mode::Run; }

  /// Instructions since the beginning, however often power came back in between.
  std::uint64_t executed() const { return executed_before_ + cpu_.state().instructions; }

  /// Who handles the events of the CPU, its ports and its field.
  const EventHandler& handler() const { return *this; }

  Cpu& cpu() { return cpu_; }
  const Cpu& cpu() const { return cpu_; }

  /// Calls `end`, at its instant, each time the output goes on or off; without power it is off. All outputs are off when the
  /// CPU is powered up. Wiring, not state; to be called before anything runs.
  void wire_output(Dispatcher& events, const OutputPoint& output, std::function<void(bool on, Time at)> end);

  /// The format that the program has set a port to; that of PPI until the program has switched it to Freeport mode.
  SerialFormat port_format(std::uint8_t port = 0) const;

  /// The format of a port's UART at the last event that was handled, however far the CPU has run ahead of it.
  const SerialFormat& line_format(std::uint8_t port = 0) const { return ports_.at(port)->uart.state().format; }

  /// Characters that a port has received with a stop bit at space level, breaks among them.
  std::uint64_t framing_errors(std::uint8_t port = 0) const { return ports_.at(port)->framing_errors; }

  /// The line that a port is on.
  SharedLine& line(std::uint8_t port = 0) { return ports_.at(port)->line; }
  const SharedLine& line(std::uint8_t port = 0) const { return ports_.at(port)->line; }

  /// The number of the port's driver on the line.
  int driver(std::uint8_t port = 0) const { return ports_.at(port)->uart.driver(); }

  /// Calls `follower`, at once, each time the program sets a port; an empty function ends that.
  void when_configured(std::function<void(const SerialFormat& format, Time at)> follower, std::uint8_t port = 0) {
    ports_.at(port)->follower = std::move(follower);
  }

  /// Lets `sink` watch the line at a port from now on; null ends that. Not owned. After restore() it sees time go back.
  void set_wire_sink(WireSink* sink, std::uint8_t port = 0);

  /// Ends the watching of the lines.
  void unwatch_lines();

  /// The time until which the CPU may run if nothing happens to the system before `horizon`: until then it hears nothing
  /// from others.
  Time may_run_until(Time horizon) const;

  /// Tells those who watch the lines that no driver gets another edge before `until`.
  void settle(Time until);

  State state() const;

  /// Queue and lines are restored by their owners, the lines before; `now` is the time of the whole system.
  void restore(const State& state, Time now);

 private:
  /// A UART as the CPU sees it. What the CPU does to it is an event at its instant: CPUs may run ahead of each other, and a
  /// line is never told of anything that lies before what it knows already.
  struct Port final : SerialPort, private Uart::Bystander, private FrameSender {
    Port(Plc& of, std::uint8_t number, SharedLine& shared_line, Dispatcher& events);

    void configure(const SerialFormat& format, Time at) override;
    void enable_receiver(bool enabled, Time at) override;
    void send(std::uint8_t byte, Time at) override;
    void send_break(int bit_times, Time at) override;

    bool looks() const override { return plc.cpu_.traced(); }
    std::optional<std::size_t> characters_left() const override;
    void missed(const ReceivedCharacter& character) override { plc.cpu_.character_missed(character, number, plc.powered_); }

    void act(const PortAction& action);
    void act_until(Time now);

    /// The shortest character that a station can send, at the fastest clock that a fault can give it: the CPU cannot hear a
    /// whole character sooner.
    Time shortest_character() const;

    Plc& plc;
    std::uint8_t number;
    SharedLine& line;
    EventOwner actor, owner;  ///< of actions, of the UART
    Uart uart;
    WireTap tap;
    std::vector<PortAction> actions{};  ///< in order of time
    std::uint64_t framing_errors = 0;
    std::function<void(const SerialFormat&, Time)> follower{};

   private:
    void perform(const PortAction& action);
    mutable SerialFormat known_format_{};
    mutable Time shortest_ = 0;
  };

  std::vector<std::unique_ptr<Port>> ports_on(std::span<SharedLine* const> lines, Dispatcher& events);
  Ports devices() const;

  void handle(const Event& event) override;
  void outputs_changed(std::uint32_t byte, std::uint8_t points, std::uint8_t changed, Time at) override;
  void carry_output_edges(Time until);
  void hear(std::uint8_t port, const Event& event);

  EventQueue& queue_;  // of the CPU, its field and what it does to its ports
  EventOwner owner_, field_owner_, outputs_owner_{};
  Time handled_ = -1;  // the instant whose event the CPU is being told of; -1 before the first one
  std::vector<std::unique_ptr<Port>> ports_;
  struct OutputWire {
    OutputPoint output;
    std::function<void(bool on, Time at)> end;
  };
  std::vector<OutputWire> output_wires_{};
  std::vector<OutputEdge> output_edges_{};  // still to come, in order of time
  Cpu cpu_;
  Field field_;
  bool powered_ = true;
  std::uint64_t executed_before_ = 0;
};

}  // namespace s7200::serial
