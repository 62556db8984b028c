// Requests of masters on bridges. How long such a master waits is not known: it has given up when nobody has sent anything
// within a time-out, or when somebody asks before. An answer is what a PLC sends with one XMT.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/session/stops/asked_by.hpp"

namespace s7200::tools {

class AskedByBridges final : public AskedBy {
 public:
  using AskedBy::AskedBy;

  void begin(Time now, const std::vector<HeardFrames::Frame>& before) override;
  void note_record(std::size_t station, const TraceRecord& record) override;
  void note_frame(const HeardFrames::Frame& frame) override;
  void look(Time now) override;
  Time next_timeout() const override;
  bool has_patient_one() const override;

 private:
  /// What the bridges of a line are doing.
  enum class Phase : std::uint8_t {
    Silent,         ///< none waits for an answer
    Asked,          ///< what one has sent last is a request, or the first pieces of one, and has no answer yet
    AskingFurther,  ///< the next piece of it is coming in
    Answered,       ///< what one has sent last is somebody else's answer, or the first pieces of it
    AnsweringFurther
  };

  /// What changes that.
  enum class Event : std::uint8_t {
    AnswerBegins,   ///< characters that no master sends, or the end of what a PLC has sent
    PieceBegins,    ///< the first character of a bridge so soon after its last one that it belongs to that
    BridgeBegins,   ///< the same later
    OtherAsks,      ///< a master in the simulation, or a PLC
    TimeOutEnds,    ///< and nobody has sent anything
    RequestEnds,    ///< what a bridge has sent, or a piece of it, like the next two
    AnswerEnds,     ///< to somebody else
    BroadcastEnds,  ///< which has no answer
  };

  struct Talk {
    Phase phase = Phase::Silent;
    std::size_t host = 0;                 ///< whose port has sent the last frame
    std::vector<std::uint8_t> request{};  ///< nothing if it is not known
    std::vector<std::uint8_t> rtu{};      ///< as it was handed over, if it is a Modbus RTU frame
    Time end = 0;                         ///< of the last frame, whatever it was
    Time next_piece_until = 0;            ///< what begins before then belongs to that frame; 0: nothing does
  };

  static Phase after(Phase phase, Event event);
  void happens(std::size_t line, Event event);
  std::optional<Event> begun_by(std::size_t line, std::size_t station, const TraceRecord& record) const;
  Event ended_by(std::size_t line, Time end, Time character) const;
  void note_request(Talk& talk, const std::vector<std::uint8_t>& piece) const;
  void judge(std::size_t line, const std::optional<SentByPlc>& answer) const;
  Asker asker_of(const Talk& talk) const { return {Asker::Kind::Bridge, talk.host}; }
  std::optional<std::size_t> host_that_sent(std::size_t line, Time after) const;
  bool answers(std::size_t line, Time end, Time character) const;

  std::vector<Talk> talks_{};  ///< by line
};

}  // namespace s7200::tools
