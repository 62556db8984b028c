// Frames of a recording as requests and answers of a protocol.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/recordings/recording.hpp"

namespace s7200::tools {

/// A frame, read.
struct ReadFrame {
  RecordedFrame frame{};
  Direction direction = Direction::Unknown;  ///< Unknown: neither a request nor an answer to one
  bool right = false;
  std::string text{};                     ///< what it says, or what is wrong with it
  std::optional<std::uint8_t> station{};  ///< of a request: who is asked
  bool needs_no_answer = false;           ///< of a request: to all stations, a token, or the last word of a session
  std::optional<std::size_t> other{};     ///< of an answer its request, of a request its answer: number in the conversation
  std::optional<std::size_t> repeats{};   ///< number of the request that this one repeats, or is the late echo of
  std::optional<Time> silence{};          ///< before it; nothing if the recording has no times
  std::optional<Time> latency{};          ///< of an answer: the silence between its request and it
};

/// Reads the frames of one line, or of one connection, in turn.
class FrameReader {
 public:
  virtual ~FrameReader() = default;

  /// The direction, whether it is right, and what it says. `open`: the request that still waits for an answer; null if none
  /// does.
  virtual ReadFrame read(const RecordedFrame& frame, const RecordedFrame* open) = 0;

  /// How many of the bytes are the first message, by what it says of itself; 0 if it is not all there, or does not say.
  virtual std::size_t first_message(std::span<const std::uint8_t> bytes, const RecordedFrame* open) const = 0;

  /// Whether a station sends one message after the other without a silence between them, so that a frame may be several.
  virtual bool messages_share_frames() const { return false; }
};

/// A protocol that recordings are read in.
struct RecordedProtocol {
  std::string_view name;  ///< as for `master --protocol`
  std::unique_ptr<FrameReader> (*reader)();
  /// If a byte 10 in data of the PLC is not doubled, as `master --dle plain` has it; null: the protocol leaves no such
  /// choice.
  std::unique_ptr<FrameReader> (*plain_dle_reader)() = nullptr;
};
std::span<const RecordedProtocol> recorded_protocols();
const RecordedProtocol* find_recorded_protocol(std::string_view name);

/// How long a master waits for an answer, at least, where nobody says so. Few slaves are slower.
inline constexpr Time kMasterTimeout = 100 * kMillisecond;

/// What a recording leaves open about its times.
struct Stamps {
  Time character = 0;   ///< how long one takes on the line; 0 on TCP
  bool at_end = false;  ///< a frame's time is that of its end; otherwise of its begin
  /// The same frame as the request, of unknown direction and after a longer silence, is the request repeated; else its echo.
  Time timeout = kMasterTimeout;
};

/// Frame after frame; an answer goes to the last request of its connection that has none.
class Conversation {
 public:
  Conversation(const RecordedProtocol& protocol, const Stamps& stamps) : protocol_(protocol), stamps_(stamps) {}

  /// What a frame says. One that was put together from characters, and whose direction is not known, may be several messages
  /// that followed each other closely, and so may every frame of some protocols.
  std::vector<ReadFrame> add(RecordedFrame frame);

  /// The messages that characters begin with, as far as they are all there; they are taken off the frame.
  std::vector<ReadFrame> take_complete(RecordedFrame& frame);

 private:
  struct Stream {
    std::unique_ptr<FrameReader> reader;
    std::optional<RecordedFrame> open{};  ///< a request
    std::size_t number = 0;               ///< of it
  };

  Stream& stream_of(const RecordedFrame& frame);
  ReadFrame read(Stream& stream, RecordedFrame frame);
  /// As an answer to the request that is open, or as a request.
  ReadFrame what_it_says(Stream& stream, const RecordedFrame& frame) const;

  const RecordedProtocol& protocol_;
  Stamps stamps_;
  std::map<std::uint32_t, Stream> streams_;  // by connection
  std::optional<RecordedFrame> last_;
  std::size_t count_ = 0;
};

/// A whole recording, each request with its answer.
std::vector<ReadFrame> conversation(const LineRecording& recording, const RecordedProtocol& protocol,
                                    const Stamps& stamps = {});

/// How long nothing was on the line, from the end of one frame to the begin of another, 0 at least; between a request and
/// its answer the latency. Nothing if the recording has no times.
std::optional<Time> silence(const RecordedFrame& before, const RecordedFrame& after, const Stamps& stamps);

}  // namespace s7200::tools
