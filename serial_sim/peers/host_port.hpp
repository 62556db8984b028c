// A peer on the line that speaks for something outside the simulation: bytes in, characters out.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "serial_sim/line/uart.hpp"

namespace s7200::serial {

/// A character that waits to be sent.
struct HostCharacter {
  enum class Fault : std::uint8_t { None, WrongParity, NoStopBit, Break };
  static constexpr int kBreakBits = 20;  ///< of the shortest break: longer than any character

  std::uint8_t byte = 0;
  SerialFormat format{};
  Fault fault = Fault::None;  ///< WrongParity needs a format with parity; a Break has no byte
  std::uint64_t sender = 0;   ///< whose it is, where several share the port
  Time lasts = 0;             ///< of a Break; 0: until HostPort::end_break()

  bool operator==(const HostCharacter&) const = default;
};

/// How long a break lasts at least: both ends of it may come at once.
constexpr Time shortest_break(const SerialFormat& format) { return format.bit_times(HostCharacter::kBreakBits); }
/// How long the line is at mark after a break, so that the next start bit has an edge.
constexpr Time mark_after_break(const SerialFormat& format) { return format.bit_times(1); }

/// A call to the port from outside the simulation, as plain data: it can be repeated.
struct HostCall {
  enum class What : std::uint8_t { Attach, ReceiveAs, Send, Drop, TakeReceived, EndBreak };

  What what{};
  SerialFormat format{};                  ///< Attach, ReceiveAs
  std::vector<HostCharacter> characters;  ///< Send
  std::uint64_t sender = 0;               ///< Drop, EndBreak
  Time lasts = 0;                         ///< EndBreak

  bool operator==(const HostCall&) const = default;
};

/// A journal is told of each call that changes something, before the call acts.
class HostJournal {
 public:
  virtual void host_called(const HostCall& call) = 0;

 protected:
  ~HostJournal() = default;
};

/// Half duplex, as an adapter to RS-485 is: what comes in while it sends is not heard, its own characters neither, unless
/// the line gives an echo. To whoever handles the events: reports of the UART go to on().
class HostPort {
 public:
  /// Plain, so that a snapshot is a copy.
  struct State {
    bool attached = false;
    SerialFormat format{};  ///< of what is received
    std::deque<HostCharacter> to_send;
    std::map<std::uint64_t, std::size_t> waiting;  ///< how many of each sender; none with 0
    std::vector<ReceivedCharacter> received;
    /// The break on the line whose end its sender has not said.
    struct HeldBreak {
      std::uint64_t sender = 0;
      Time since = 0;
      bool operator==(const HeldBreak&) const = default;
    };
    std::optional<HeldBreak> held_break{};
    bool operator==(const State&) const = default;
  };

  /// The UART's receiver is off until attach(). The reference is not owned.
  explicit HostPort(Uart& uart);

  /// Plugs the port into the line, where it listens from `at` on.
  void attach(const SerialFormat& format, Time at);

  /// Sets the format of received characters, from the next one after `at` on.
  void receive_as(const SerialFormat& format, Time at);

  /// Appends to what is sent. Characters follow each other back to back, each in its own format; the first start bit begins
  /// at `at`, which is not in the past, or when the characters before are over.
  void send(std::span<const HostCharacter> characters, Time at);

  /// Whether anything is on its way to the line or on it.
  bool sending() const { return uart_.state().sending; }

  /// Characters that wait for the one on the line.
  std::size_t waiting() const { return state_.to_send.size(); }
  std::size_t waiting(std::uint64_t sender) const;

  /// Drops the waiting characters of `sender`. Returns how many there were.
  std::size_t drop(std::uint64_t sender);

  /// The open break of `sender`, on the line or waiting, has been held for `lasts`: it ends when it has been on the line for
  /// so long, and at least for kBreakBits, but not before `at`. Does nothing if `sender` has none.
  void end_break(std::uint64_t sender, Time lasts, Time at);

  /// The characters received since the last call, with their errors.
  std::vector<ReceivedCharacter> take_received();

  /// The instant when a character that is coming in will be complete; kNever when there is none.
  Time character_due() const { return uart_.character_due(); }

  /// End of the last character that the port has sent, or is sending; 0 if there is none.
  Time sent_until() const { return uart_.state().send_end; }

  bool is_on(const Line& line) const { return &uart_.line() == &line; }
  int driver() const { return uart_.driver(); }

  void on(const Uart::Report& report);

  /// The journal that is told of calls; null: there is none. Not owned.
  void set_journal(HostJournal* journal) { journal_ = journal; }

  /// Repeats a call at `at`; the journal is not told.
  void repeat(const HostCall& call, Time at);

  const State& state() const { return state_; }
  void restore(const State& state) {
    state_ = state;
    if (state_.attached) uart_.plug_in();
  }

 private:
  void send_next(Time at);
  void send_break(const HostCharacter& character, Time at);
  void finish_break(Time end);
  void note(HostCall call) const {
    if (journal_) journal_->host_called(call);
  }

  Uart& uart_;
  State state_;
  HostJournal* journal_ = nullptr;
};

}  // namespace s7200::serial
