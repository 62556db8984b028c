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

class Plc final : private EventHandler {
 public:
  /// Plain, so that a snapshot is a copy.
  struct State {
    s7200::State cpu;
    std::array<Uart::State, kPorts.size()> uart;
    Field::State field;
    bool operator==(const State&) const = default;
  };

  /// `lines`: one for each port of the program's CPU, by number. They are not owned.
  Plc(Dispatcher& events, std::span<SharedLine* const> lines, std::shared_ptr<const Program> program, FieldScript field);
  Plc(const Plc&) = delete;
  Plc& operator=(const Plc&) = delete;

  /// Powers the CPU up into RUN, at time 0, with what its memory has kept, and starts the field's script.
  void power_up(const RetentiveMemory* memory = nullptr);

  Cpu& cpu() { return cpu_; }
  const Cpu& cpu() const { return cpu_; }

  /// What the program has set a port to; the default format until it has switched it to Freeport mode.
  SerialFormat port_format(std::uint8_t port = 0) const;

  /// `follower` is told, at once, each time the program sets a port; an empty function ends that.
  void when_configured(std::function<void(const SerialFormat& format)> follower, std::uint8_t port = 0) {
    ports_.at(port)->follower = std::move(follower);
  }

  /// Lets `sink` watch the line at a port from now on; null ends that. Not owned. After restore() it sees time go back.
  void set_wire_sink(WireSink* sink, std::uint8_t port = 0) { ports_.at(port)->tap.watch(sink, cpu_.time()); }

  /// No driver of the lines gets an edge before `until` any more: whoever watches them is told.
  void settle(Time until);

  State state() const;

  /// Queue and lines are restored by their owners, the lines before; `now` is the time of the whole system.
  void restore(const State& state, Time now);

 private:
  /// A UART as the CPU sees it: whoever follows its format is told.
  struct Port final : SerialPort, private Uart::Bystander {
    Port(Dispatcher& events, SharedLine& shared_line, Plc& plc, std::uint8_t number);

    void configure(const SerialFormat& format) override;
    void enable_receiver(bool enabled, Time at) override { uart.enable_receiver(enabled, at); }
    void send(std::uint8_t byte, Time at) override { uart.send(byte, at); }
    void send_break(int bit_times, Time at) override { uart.send_break(bit_times, at); }

    bool looks() const override { return of.cpu_.traced(); }
    void missed(const ReceivedCharacter& character) override { of.cpu_.character_missed(character, number); }

    Plc& of;
    std::uint8_t number;
    SharedLine& line;
    EventOwner owner;
    Uart uart;
    WireTap tap;
    std::function<void(const SerialFormat&)> follower{};
  };

  std::vector<std::unique_ptr<Port>> ports_on(std::span<SharedLine* const> lines, Dispatcher& events);
  Ports devices() const;

  void handle(const Event& event) override;
  void hear(std::uint8_t port, const Event& event);

  std::vector<std::unique_ptr<Port>> ports_;
  Cpu cpu_;
  Field field_;
};

}  // namespace s7200::serial
