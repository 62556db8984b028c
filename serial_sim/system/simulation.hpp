// A PLC with what drives its inputs, a Modbus master and a port for the host on one line: everything wired, one clock.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>

#include "interpreter/base/event_queue.hpp"
#include "interpreter/cpu/cpu.hpp"
#include "serial_sim/faults/faults.hpp"
#include "serial_sim/field/field.hpp"
#include "serial_sim/line/line.hpp"
#include "serial_sim/line/uart.hpp"
#include "serial_sim/line/wire_tap.hpp"
#include "serial_sim/peers/host_port.hpp"
#include "serial_sim/peers/requester.hpp"

namespace s7200::serial {

/// Why run_until() came back.
enum class Halt : std::uint8_t {
  Time,     ///< the end was reached
  Paused,   ///< a trace sink stopped the CPU, or a scan ended and a pause was asked for
  Stopped,  ///< the CPU is in STOP
  Request,  ///< whoever may, has asked for it: stop_when()
};

class Simulation {
 public:
  explicit Simulation(std::shared_ptr<const Program> program, FieldScript field = {});

  /// All that runs ends early once `request` is true; it is looked at every 100 ms. Not owned; null: nothing ends it.
  void stop_when(const std::atomic<bool>* request) { stop_request_ = request; }

  /// Powers the CPU up into RUN, at time 0, with what its memory has kept.
  void power_up(const RetentiveMemory* memory = nullptr);

  /// Runs the CPU and handles what is due, until the CPU's clock has reached `end`. A CPU that goes to STOP ends the run.
  Halt run_until(Time end);

  /// From now on the master's format is what `of` makes of the port's, and changes with it at once, but not within an
  /// exchange: what the program sends unasked is heard as well as its answers.
  void let_master_follow(std::function<SerialFormat(const SerialFormat& port)> of);

  /// Runs on, in STOP too, until a started exchange of the master, or its listening, is over. The master is busy still if a
  /// stop was asked for.
  const Exchange& finish_exchange();

  /// Whether the line has had no character on it for `quiet` up to now.
  bool line_quiet_for(Time quiet) const;

  /// End of the last character that anybody sent or heard.
  Time last_activity() const { return last_activity_; }

  /// Runs until the first scan has ended and the line has been quiet since then for `quiet`, which is asked only after that
  /// scan: it is there that programs set the rate of their port. False if that has not come by `limit`, the CPU stopped,
  /// or a stop was asked for.
  bool run_until_ready(const std::function<Time()>& quiet, Time limit);
  bool run_until_ready(Time quiet, Time limit) {
    return run_until_ready([quiet] { return quiet; }, limit);
  }

  /// The quiet time a master leaves by default: more than the time-outs of programs that look for 3.5 characters of
  /// silence with a timer of whole milliseconds: 7 characters + 10 ms.
  static Time default_quiet(const SerialFormat& format) { return 2 * format.silence() + 10 * kMillisecond; }

  /// From now on. Several may be at work at once.
  void inject(const Fault& fault) { faults_.inject(fault, time()); }
  void clear_faults() { faults_.clear(time()); }
  const Faults& faults() const { return faults_; }

  Cpu& cpu() { return cpu_; }
  const Cpu& cpu() const { return cpu_; }
  Master& master() { return master_; }
  const Master& master() const { return master_; }
  Uart& master_uart() { return master_uart_; }
  HostPort& host_port() { return host_port_; }
  const HostPort& host_port() const { return host_port_; }
  Time time() const { return cpu_.time(); }

  /// What the program has set its port to; the default format until it has switched it to Freeport mode.
  SerialFormat port_format() const {
    const auto& port = cpu_.state().port[0];
    return port.active ? port.format : SerialFormat{};
  }

  /// Lets `sink` watch the line from now on; null ends that. Not owned. After restore() it sees time go back.
  void set_wire_sink(WireSink* sink) { tap_.watch(sink, cpu_.time()); }

  struct Snapshot {
    State cpu;
    EventQueue queue;
    Line line;
    Uart::State plc_uart, master_uart, host_uart;
    Master::State master;
    HostPort::State host_port;
    Time last_activity = 0;
    Field::State field;
    Faults::State faults;
    bool operator==(const Snapshot&) const = default;
  };
  Snapshot snapshot() const;
  void restore(const Snapshot& snapshot);

 private:
  /// The PLC's UART, as the CPU sees it: whoever follows its format is told.
  class Port final : public SerialPort {
   public:
    explicit Port(Simulation& simulation) : simulation_(simulation) {}
    void configure(const SerialFormat& format) override;
    void enable_receiver(bool enabled, Time at) override { simulation_.plc_uart_.enable_receiver(enabled, at); }
    void send(std::uint8_t byte, Time at) override { simulation_.plc_uart_.send(byte, at); }
    void send_break(int bit_times, Time at) override { simulation_.plc_uart_.send_break(bit_times, at); }

   private:
    Simulation& simulation_;
  };

  bool stop_requested() const { return stop_request_ && *stop_request_; }
  Time next_look() const;
  void handle_due_events();
  void dispatch(const Event& event);
  void note_activity(const Uart::Report& report);

  EventQueue queue_;
  Line line_;
  Uart plc_uart_;
  Uart master_uart_;
  Uart host_uart_;
  Master master_;
  HostPort host_port_;
  std::function<SerialFormat(const SerialFormat& port)> master_format_{};  ///< of the port's; none: its own
  Port port_{*this};
  Cpu cpu_;
  Field field_;
  Faults faults_;
  WireTap tap_;
  Time last_activity_ = 0;
  const std::atomic<bool>* stop_request_ = nullptr;
};

}  // namespace s7200::serial
