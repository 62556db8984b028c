// Why: what stands beside a record in a trace. Which line of the program did it, and what an interrupt waited for.
//
// It must be told every record, in their order. Only what it has been told it knows.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <unordered_map>

#include "interpreter/program/program.hpp"
#include "interpreter/trace/trace.hpp"

namespace s7200 {

class TraceReasons {
 public:
  /// The program must live as long as this.
  explicit TraceReasons(const Program& program) : program_(program) {}

  /// Appends `  line 82: DISI  // not now` of ATCH, DTCH, ENI, DISI, XMT, RCV and SMB30; `: DISI in line 82 until ENI in
  /// line 90` of an interrupt that waited; nothing of all else.
  void append(fmt::memory_buffer& text, const TraceRecord& record);

  /// Of a ServiceBegin: that interrupts were disabled, or which other routines ran; nothing if it was neither.
  std::string held_up_by(const TraceRecord& begin) const;

  /// For who does not ask about each record: this one has come.
  void note(const TraceRecord& record);

  void forget();

 private:
  struct Service {
    Time end = 0;
    std::uint8_t event = 0, routine = 0;
  };
  static constexpr std::size_t kServices = 32;  ///< more than all queues hold

  const std::string& place_of(std::uint32_t op);
  std::string cause_of(const TraceRecord& begin) const;
  std::string line_of(std::uint32_t op) const;

  const Program& program_;
  std::unordered_map<std::uint32_t, std::string> places_;  ///< by op, as far as they have come
  std::optional<bool> disabled_;                           ///< nothing: not known
  std::optional<std::uint32_t> disabled_by_;               ///< the last DISI
  std::optional<TraceRecord> enabled_;                     ///< the last ENI after that
  std::deque<Service> services_;                           ///< the last, newest last
};

}  // namespace s7200
