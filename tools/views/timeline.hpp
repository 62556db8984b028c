// `--timeline`: what the CPU did during an exchange, put together from its trace records.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "interpreter/program/program.hpp"
#include "interpreter/trace/program_path.hpp"
#include "interpreter/trace/trace.hpp"
#include "interpreter/trace/trace_reasons.hpp"
#include "serial_sim/peers/requester.hpp"

namespace s7200::tools {

/// An event in the timeline, or several of the same kind in a row.
struct TimelineRow {
  enum class Kind : std::uint8_t {
    Received,
    Ignored,
    Lost,
    Event,
    Transmit,
    Sent,
    Other,
    LeftOut,
    Dropped,
    Way,
    Unanswered
  };

  static constexpr std::size_t kMostCharacters = 4096;

  Time at = 0;  ///< of the first
  Kind kind{};
  std::uint8_t port = 0;                        ///< of characters and XMT
  std::vector<ReceivedCharacter> characters{};  ///< Received, Ignored, Dropped, Lost, Sent; the first kMostCharacters
  std::size_t more_characters = 0;              ///< that are only counted
  std::uint8_t event = 0;                       ///< Received, Lost, Event
  std::uint8_t routine = 0;                     ///< that was attached to it
  std::string text{};                           ///< Transmit, Other, LeftOut, Way, Unanswered: in words
  std::string place{};                          ///< Transmit: which part of the program did it

  /// Interrupts served, by the interrupt routine.
  std::size_t served = 0;
  Time shortest = kNever, longest = 0, in_all = 0, longest_wait = 0;
  std::string why{};  ///< of the longest wait: DISI, or other routines; of Ignored and Unanswered; Transmit: its line
};

struct TimelineReport {
  /// The first kMostRows / 2 and the last; between them one of Kind::LeftOut if there were more.
  static constexpr std::size_t kMostRows = 1000;
  std::vector<TimelineRow> rows{};

  // These figures are of all rows, also of those that are left out.
  std::size_t scans = 0;  ///< from beginning to end
  Time shortest_scan = kNever, longest_scan = 0;
  std::size_t served = 0;  ///< interrupts
  Time in_all = 0, longest_wait = 0;
};

/// Looks on between begin() and end(); passes everything on to the next sink, if there is one. However long that is, it
/// keeps no more than it shows.
class Timeline final : public TraceSink {
 public:
  /// What the timeline looks at. The way of the main program, and the reason why a frame gets no answer, can be seen only
  /// from every instruction, which takes time.
  enum class Looks : std::uint8_t { AtRecords, AtInstructions };

  Timeline(std::shared_ptr<const Program> program, TraceSink* next, Looks looks = Looks::AtRecords);
  ~Timeline() override;

  void begin();
  /// Begins in the middle of a run, without the events before; interrupts were disabled as in `interrupts`.
  void begin_amid(const TraceReasons::Disabled& interrupts);
  void end() { looking_ = false; }

  /// Notes what is done to the PLC from outside, in words.
  void note(Time at, const std::string& what);

  /// The report since begin().
  TimelineReport report() const;

  void record(const TraceRecord& record) override;
  bool before(std::uint32_t op) override { return !next_wants_instructions() || next_->before(op); }
  void instruction(const InstructionRecord& record) override;
  bool wants_instructions() const override {
    return (looking_ && looks_ == Looks::AtInstructions) || next_wants_instructions();
  }
  Watch watch() const override { return next_wants_instructions() ? next_->watch() : Watch::Flow; }

 private:
  class Reader;

  std::string place_text(const TraceRecord& record);
  bool next_wants_instructions() const { return next_ && next_->wants_instructions(); }

  std::shared_ptr<const Program> program_;
  TraceSink* next_;
  Looks looks_;
  std::unique_ptr<Reader> reader_;
  TraceReasons reasons_;
  ProgramPath path_;
  bool looking_ = false;
};

/// An aligned table; times count from the start of the request.
std::string to_text(const TimelineReport& report, const serial::Exchange& exchange, bool colour);
nlohmann::ordered_json to_json(const TimelineReport& report, const serial::Exchange& exchange);

/// The timeline of one of several stations; the only station has no name.
struct StationTimeline {
  std::string station{};
  TimelineReport report{};
};

/// All stations in one table, in the order of time, with the name of the station beside each row.
std::string to_text(const std::vector<StationTimeline>& stations, const serial::Exchange& exchange, bool colour);
nlohmann::ordered_json to_json(const std::vector<StationTimeline>& stations, const serial::Exchange& exchange);

}  // namespace s7200::tools
