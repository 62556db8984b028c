// A station that answers, without wires: characters and time in, characters out.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/serial_port.hpp"

namespace s7200::serial {

/// Characters that follow each other back to back.
struct Transmission {
  Bytes bytes;
  Time at = 0;  ///< the first start bit

  bool operator==(const Transmission&) const = default;
};

/// A station without its wires. Its owner gives it characters, edges of its sync signal and the time, takes the answers from
/// it, and asks when it wants to be woken. Its state is a value: a copy goes on as the original would.
class Automaton {
 public:
  virtual ~Automaton() = default;

  virtual std::unique_ptr<Automaton> clone() const = 0;
  virtual bool equals(const Automaton& other) const = 0;

  virtual SerialFormat format() const = 0;

  /// Is told of each character in the middle of its stop bit.
  virtual void hear(const ReceivedCharacter& character) = 0;

  /// The signal beside the data that some lines have.
  virtual void sync(bool /*high*/, Time /*at*/) {}

  /// The station's power has gone off, or has come, at `at`: characters that it heard and an answer that it prepared are
  /// lost. Memory and settings stay.
  void reset(Time at) {
    due_ = kNever;
    answer_.reset();
    abort_ = false;
    restart(at);
  }

  /// Is called when due() has come and no character is coming in.
  virtual void wake(Time /*now*/) {}

  /// Whether the station hears characters while it sends: its line has separate wires for either direction.
  virtual bool full_duplex() const { return false; }

  Time due() const { return due_; }

  /// The answer to send; nothing if there is none. It starts after everything that the station was told.
  std::optional<Transmission> take_answer() { return std::exchange(answer_, std::nullopt); }

  /// Whether what the station is sending is to end with the character on the line.
  bool take_abort() { return std::exchange(abort_, false); }

  bool operator==(const Automaton&) const = default;

 protected:
  /// Resets the state that belongs to a message or a session, as when power has come at `at`.
  virtual void restart(Time at) = 0;

  Automaton() = default;
  Automaton(const Automaton&) = default;
  Automaton& operator=(const Automaton&) = default;

  void wake_at(Time at) { due_ = at; }
  void answer(Bytes bytes, Time at) { answer_ = Transmission{std::move(bytes), at}; }
  void abort() { abort_ = true; }

 private:
  Time due_ = kNever;
  std::optional<Transmission> answer_;
  bool abort_ = false;
};

/// A copy of an automaton, whatever it is.
class AutomatonValue {
 public:
  explicit AutomatonValue(std::unique_ptr<Automaton> automaton) : automaton_(std::move(automaton)) {}
  AutomatonValue(const AutomatonValue& other) : automaton_(other.automaton_->clone()) {}
  AutomatonValue& operator=(const AutomatonValue& other) {
    automaton_ = other.automaton_->clone();
    return *this;
  }
  AutomatonValue(AutomatonValue&&) noexcept = default;
  AutomatonValue& operator=(AutomatonValue&&) noexcept = default;
  ~AutomatonValue() = default;

  bool operator==(const AutomatonValue& other) const { return automaton_->equals(*other.automaton_); }

  Automaton* operator->() const { return automaton_.get(); }
  Automaton& operator*() const { return *automaton_; }

 private:
  std::unique_ptr<Automaton> automaton_;
};

}  // namespace s7200::serial
