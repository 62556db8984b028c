// Runs a program with trials. Its ports have characters with their times, as the UARTs of a line without faults and with a
// single master give and take them, and no levels.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "interpreter/base/event_queue.hpp"
#include "interpreter/cpu/cpu.hpp"
#include "tools/trials/contacts_seen.hpp"
#include "tools/trials/trial.hpp"

namespace s7200::tools {

/// What a program has done to the outside.
struct Done {
  struct Output {
    Time at = 0;
    std::uint32_t byte = 0;
    std::uint8_t points = 0;  ///< of the byte from then on
  };
  struct Sent {
    Time at = 0;  ///< its start bit
    std::uint8_t byte = 0;
    std::uint32_t op = 0;  ///< the XMT; kNoRoutine in PPI mode
  };
  std::vector<Output> outputs;
  std::vector<Sent> sent;
  bool interrupted = false;  ///< it has sent something before a frame for it was over
};

class TrialBench final : private TraceSink {
 public:
  /// `port`: the one that frames come to.
  TrialBench(std::shared_ptr<const Program> program, std::uint8_t port);
  TrialBench(const TrialBench&) = delete;
  TrialBench& operator=(const TrialBench&) = delete;

  /// Power comes at time 0, and with it the first scan.
  void power_up();
  /// When power came last: at 0, or back after a failure.
  Time powered_up_at() const { return powered_up_at_; }

  /// Runs until then, or until the CPU is in STOP.
  void run_until(Time end);

  /// Does it at `at`, or now if that is past, and returns when it is over. A frame has the format that the port has when it
  /// begins; once the program has set the port otherwise, it hears no more of it. Inputs keep their levels over a power
  /// failure, and the clock of the bench goes on.
  Time apply(const Stimulus& stimulus, Time at);

  void poke(std::uint32_t place, const std::vector<std::uint8_t>& bytes) { cpu_.poke(place, bytes); }

  /// A whole trial, each stimulus `wait` after the one before was over. Returns when each was begun.
  std::vector<Time> apply(const Trial& trial);

  bool stopped() const { return cpu_.state().mode == Mode::Stop; }
  Time time() const { return cpu_.time(); }
  const Cpu& cpu() const { return cpu_; }
  const std::shared_ptr<const Program>& shared_program() const { return program_; }
  const Done& done() const { return done_; }
  const SerialFormat& format() const { return port_[number_].state.format; }

  /// Whether characters are watched and new contacts counted; without, it is about three times as fast.
  void watch_contacts(bool on) { watching_ = on; }
  ContactsSeen& contacts() { return contacts_; }
  const ContactsSeen& contacts() const { return contacts_; }

  /// Watches bits of the image from now on: which op has written them last.
  void watch_writes(std::uint32_t place, std::uint8_t mask, const std::vector<std::uint32_t>& writers);
  std::optional<std::uint32_t> last_writer() const { return last_writer_; }

  /// Called at the end of each scan; false ends the run there. Empty: scans that are alike may be passed over.
  void at_scan_end(std::function<bool(const Cpu&)> look) { look_ = std::move(look); }

  struct PortState {
    SerialFormat format{};
    Time listens_since = 0;
    bool listens = true, sends = false;
    Time sent_until = 0;  ///< end of the last character
  };
  struct Snapshot {
    State cpu;
    EventQueue queue;
    std::array<PortState, kPorts.size()> port;
    Done done;
    Time powered_up_at = 0;
  };
  Snapshot snapshot() const;
  void restore(const Snapshot& snapshot);

 private:
  class Port final : public SerialPort {
   public:
    void configure(const SerialFormat& format, Time at) override;
    void enable_receiver(bool enabled, Time at) override;
    void send(std::uint8_t byte, Time at) override;
    void send_break(int bit_times, Time at) override;

    TrialBench* bench = nullptr;
    std::uint8_t number = 0;
    PortState state{};
  };

  void record(const TraceRecord& record) override;
  void instruction(const InstructionRecord& record) override;
  bool wants_instructions() const override { return watching_ || watched_mask_ != 0; }
  Watch watch() const override { return Watch::Flow; }
  bool wants_scans() const override { return false; }

  std::uint8_t port_of(const Stimulus& stimulus) const;
  bool hears(std::uint8_t port, Time start, const SerialFormat& format) const;
  bool reach(Time at);
  Time give(const Stimulus& frame);
  Time give_break(const Stimulus& stimulus);
  Time cycle_power();
  void handle_due();

  EventQueue queue_;
  std::array<Port, kPorts.size()> port_{};
  std::shared_ptr<const Program> program_;
  Cpu cpu_;
  std::uint8_t number_;
  Done done_;
  ContactsSeen contacts_;
  bool watching_ = false;
  std::uint32_t transmit_op_ = kNoRoutine;
  std::function<bool(const Cpu&)> look_{};
  bool ended_ = false;  // by at_scan_end()
  Time powered_up_at_ = 0;
  std::uint32_t watched_place_ = 0;
  std::uint8_t watched_mask_ = 0, watched_value_ = 0;
  std::vector<bool> writers_{};  // by op
  std::optional<std::uint32_t> last_writer_{};
};

}  // namespace s7200::tools
