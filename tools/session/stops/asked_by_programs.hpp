// Requests of programs, which PlcRequests knows. How long a program waits only it knows: it has given up when nobody has
// sent anything within a time-out, or when somebody asks before. What it hears is its answer up to a silence of 3.5
// characters; on a line with a bridge, which may get it in pieces, up to one of kNextPiece unless it is right before.
#pragma once

#include <string>
#include <vector>

#include "tools/session/stops/asked_by.hpp"

namespace s7200::tools {

class AskedByPrograms final : public AskedBy {
 public:
  using AskedBy::AskedBy;

  void begin(Time now, const std::vector<HeardFrames::Frame>& before) override;
  void note_record(std::size_t station, const TraceRecord& record) override;
  void look(Time now) override;
  Time next_timeout() const override;
  bool has_patient_one() const override;

 private:
  bool waits(std::size_t line) const;
  Time timeout_at(std::size_t line) const;
  void give_up(std::size_t line);
  bool hears(std::size_t line) const;
  Time end_of_answer(std::size_t line) const;
  std::string wrong_at(std::size_t line) const;
  void judge(std::size_t line);

  std::vector<Time> given_up_{};  ///< by line, the end of the last request that is known to be unanswered
  std::vector<Time> judged_{};    ///< by line, the end of the last request whose answer was judged
};

}  // namespace s7200::tools
