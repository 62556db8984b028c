// What the faults of a line, and cuts of its cable, did to what was sent on it while the past was played.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "serial_sim/system/shared_line.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

class LineFaults final : private serial::FaultWatcher {
 public:
  /// Both must live as long as this.
  LineFaults(History& history, serial::SharedLine& line) : history_(history), line_(line) {}
  ~LineFaults() { end(); }
  LineFaults(const LineFaults&) = delete;
  LineFaults& operator=(const LineFaults&) = delete;

  /// The past is about to be played, and has been: what happens in between counts.
  void begin();
  void end() { line_.faults().set_watcher(nullptr); }

  /// What the system file had planned was done: the cable may be cut now, or whole again.
  void note_cable();

  /// A time, and the characters of the frame that were sent in it.
  struct Span {
    Time from = 0, to = 0;
    std::size_t characters = 0;
    Time character = 0;  ///< how long one takes; 0: they fill that time
  };

  /// Those that struck a frame, `fault flip:character=3 of slave2: 1×, in character 3`: which characters if they are not all
  /// of them, and when it was if it did not wait for a character. `asked`: the request that it is, or answers. An echo
  /// leaves what is sent as it is: it is named if nothing else has struck the frame.
  std::vector<std::string> in(const Span& frame, const Span& asked) const;

  /// `was cut from 700.000000 ms to 3100.000000 ms`, `has been cut since 700.000000 ms`: the cable between two drivers of
  /// the line, then; empty if it was whole.
  std::string cut_between(int driver, int other, Time from, Time to) const;

  /// Whether any of them was at work then, and whether one has made a pause in that time.
  bool at_work(Time at) const;
  bool has_pause(Time from, Time to) const;

 private:
  /// What a fault did.
  struct Happening {
    serial::Fault fault{};
    int driver = serial::Faults::kAnyDriver;
    serial::FaultHappening what{};
  };

  void fault_happens(const serial::Faults::Injected& fault, const serial::FaultHappening& what) override;
  void faults_cleared(Time at) override;
  std::string note_of(const std::vector<const Happening*>& all, const Span& frame) const;
  std::vector<Span> characters_of(const Span& frame) const;
  std::vector<std::uint32_t> struck(const Happening& one, const Span& frame) const;

  History& history_;
  serial::SharedLine& line_;
  std::vector<Happening> happenings_;
  std::vector<serial::Line::Separation> separations_;  // in order of time
};

}  // namespace s7200::tools
