// Frames of a recording as requests and answers of a protocol.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/recordings/left_out.hpp"
#include "tools/recordings/rows/stamps.hpp"

namespace s7200::tools {

/// A frame and what it says.
struct ReadFrame {
  RecordedFrame frame{};
  Direction direction = Direction::Unknown;  ///< Unknown: neither a request nor an answer to one
  bool right = false;
  std::string text{};                     ///< what it says, or what is wrong with it
  std::optional<std::uint8_t> station{};  ///< of a request: who is asked
  bool needs_no_answer = false;           ///< of a request: to all stations, a token, or the last word of a session
  bool puts_off = false;                  ///< of an answer: there is none yet, and the master is to ask again
  bool not_read = false;                  ///< a row of which it is not known what its bytes are
  bool may_be_answer = false;             ///< of such a row: a request waits for its answer there
  std::string ignored{};                  ///< a word beside its bytes that was not read
  bool echo = false;                      ///< the request once more, as an adapter for two wires hears itself
  std::size_t pieces = 1;                 ///< rows or packets of the recording that it was put together from
  std::size_t wrong_with_rows = 0;        ///< so many rows below give it the length that it announces, not its check sum
  std::optional<std::size_t> other{};     ///< of an answer its request, of a request its answer: number in the conversation
  std::string asked_at{};                 ///< of an answer: the place of its request
  bool out_of_turn = false;               ///< of an answer: another request stands between it and its own
  std::optional<std::size_t> repeats{};   ///< number of the request that this one repeats, or is the late echo of
  std::optional<Time> silence{};          ///< before it, as known_silence() has it
  std::optional<Time> latency{};          ///< of an answer: the same between its request and it
};

/// Reads the frames of one line, or of one connection, in turn.
class FrameReader {
 public:
  virtual ~FrameReader() = default;

  /// The direction, whether it is right, and what it says. `open`: the request that still waits for an answer; null if none
  /// does.
  virtual ReadFrame read(const RecordedFrame& frame, const RecordedFrame* open) = 0;

  /// Reads a frame, perhaps without its text, for callers that only count.
  virtual ReadFrame judge(const RecordedFrame& frame, const RecordedFrame* open) { return read(frame, open); }

  /// Whether a frame has a form that only this protocol has, right or not.
  virtual bool has_form(std::span<const std::uint8_t> bytes) const {
    static_cast<void>(bytes);
    return false;
  }

  /// Whether a slave may answer a frame with the same bytes.
  virtual bool may_be_echoed(const RecordedFrame& frame) const = 0;

  /// The length in bytes of the first message, by its own contents; 0 if it is not all there, or does not tell its length.
  virtual std::size_t first_message(std::span<const std::uint8_t> bytes, const RecordedFrame* open) const = 0;

  /// Whether the bytes begin a message, by what it says of itself, and do not end it.
  virtual bool announces_more(std::span<const std::uint8_t> bytes, Direction direction, const RecordedFrame* open) const {
    static_cast<void>(bytes), static_cast<void>(direction), static_cast<void>(open);
    return false;
  }

  /// Whether a station sends one message after the other without a silence between them, so that a frame may be several.
  virtual bool messages_share_frames() const { return false; }
};

/// An option for something that a protocol's document leaves open of its frames; it has the name that it has for `master`.
struct ReaderOption {
  std::string_view name, value, meaning;    ///< `--dle`, `FORM`, and for the help
  std::span<const std::string_view> words;  ///< it takes one of them; without it the first one holds
};

constexpr std::size_t kMostReaderOptions = 3;

/// The chosen word of each option of a protocol, in the order of its row.
using ChosenWords = std::array<std::uint8_t, kMostReaderOptions>;

/// A protocol in which recordings are read.
struct RecordedProtocol {
  std::string_view name;  ///< as for `master --protocol`
  std::unique_ptr<FrameReader> (*reader)(const ChosenWords& chosen);
  std::span<const ReaderOption> options{};
  bool of_the_cpu = false;      ///< the CPU answers by itself, as its PPI station, whatever its program
  bool of_other_makes = false;  ///< no program of ours answers, but PLCs of another make do
  ChosenWords chosen{};

  /// Chooses a word of an option. Returns false if the protocol has no such option. `word` is one of its words.
  bool choose(std::string_view option, std::string_view word);
};
std::span<const RecordedProtocol> recorded_protocols();
const RecordedProtocol* find_recorded_protocol(std::string_view name);

/// How the directions in a recording are understood.
enum class DirectionsTaken : std::uint8_t { AsSaid, TheOtherWayRound, Open };

/// Frame after frame; an answer goes to the last request that has none, of Modbus TCP to that of its transaction.
class Conversation {
 public:
  Conversation(const RecordedProtocol& protocol, const Stamps& stamps, DirectionsTaken taken = DirectionsTaken::AsSaid)
      : protocol_(protocol), stamps_(stamps), taken_(taken) {}

  /// Lets frames come without their texts from now on.
  void leave_out_texts() { with_texts_ = false; }

  /// Reads a frame. A frame that was put together from characters, and whose direction is not known, may be several messages
  /// that followed each other closely, and so may every frame of some protocols. Any other frame, except in a capture,
  /// becomes several messages only if each of them is right: programs print in one line what has come to them together.
  std::vector<ReadFrame> add(RecordedFrame frame);

  /// The messages that characters begin with, as far as they are all there; they are taken off the frame.
  std::vector<ReadFrame> take_complete(RecordedFrame& frame);

  /// Reads the first of the rows, which a log may have divided. Later rows belong to it as long as it says that more of it
  /// is to come, if the whole is right, or if they follow closely and only together they are right.
  /// `rows` is left with the rest.
  std::vector<ReadFrame> take(std::span<const RecordedFrame>& rows);

 private:
  struct OpenRequest {
    RecordedFrame frame;
    std::size_t number;  ///< in the conversation
    bool echoed = false;
  };

  struct Stream {
    std::unique_ptr<FrameReader> reader;
    std::map<std::uint32_t, OpenRequest> open{};  ///< by their RecordedFrame::exchange

    /// An answer of Modbus TCP belongs to its transaction, whichever unit it names.
    const OpenRequest* request_of(const RecordedFrame& frame) const;
  };

  /// The first message of what is left of a frame.
  struct Message {
    std::size_t length = 0;  ///< 0: it is not all there, or does not say
    bool echo = false;
  };

  /// The rest of a frame after its whole messages, and the request that is open there.
  struct Rest {
    std::size_t begin = 0;
    std::optional<RecordedFrame> open{};
  };

  Stream& stream_of(const RecordedFrame& frame);
  /// `rows`: of the recording, that the frame is put together from.
  std::vector<ReadFrame> add(RecordedFrame frame, std::size_t rows);
  std::vector<ReadFrame> take_complete(RecordedFrame& frame, std::size_t rows);
  Message first_message(const Stream& stream, const RecordedFrame& frame, std::size_t begin,
                        const RecordedFrame* open) const;
  bool begins_with_echo(const Stream& stream, const RecordedFrame& frame, std::size_t begin,
                        const RecordedFrame& open) const;
  bool is_echo(const Stream& stream, const RecordedFrame& frame) const;
  bool is_several(const Stream& stream, const RecordedFrame& frame) const;
  Rest rest_after_messages(const Stream& stream, const RecordedFrame& frame) const;
  bool announces_more(const Stream& stream, const RecordedFrame& frame, const Rest& rest) const;
  /// Whether a frame ends just where the beginning of its last message says, though that message is not right.
  bool ends_as_announced(const Stream& stream, const RecordedFrame& frame, const Rest& rest) const;
  /// The number of rows that are one frame, the first of which is `whole`: by their contents, and because they follow
  /// closely.
  struct AnnouncedRows {
    std::size_t count = 1;
    bool right = true;  ///< false: they have the length that the first of them announces, and a wrong check sum
  };
  AnnouncedRows announced_rows(const Stream& stream, RecordedFrame whole, std::span<const RecordedFrame> rows) const;
  std::size_t close_rows(const Stream& stream, RecordedFrame whole, std::span<const RecordedFrame> rows) const;
  ReadFrame read(Stream& stream, RecordedFrame frame, bool echo);
  /// The row with its bytes if they are not in doubt, or if one reading of the row is a right frame.
  std::optional<RecordedFrame> settled(const Stream& stream, const RecordedFrame& row, bool& without_word) const;
  ReadFrame not_read(Stream& stream, RecordedFrame row);
  /// Reads the frame as an answer to the open request, or as a request.
  ReadFrame what_it_says(const Stream& stream, const RecordedFrame& frame) const;
  ReadFrame what_reader_says(const Stream& stream, const RecordedFrame& frame, const RecordedFrame* open) const;

  const RecordedProtocol& protocol_;
  Stamps stamps_;
  DirectionsTaken taken_;
  bool with_texts_ = true;
  std::map<std::uint32_t, Stream> streams_;  // by connection
  bool hears_itself_ = false;                // the recorder hears itself: an echo is not an answer
  std::optional<RecordedFrame> last_;
  std::size_t last_request_ = 0;  // its number in the conversation
  std::size_t count_ = 0;
};

/// The share of frames that are right.
class RightFrames {
 public:
  RightFrames() = default;
  explicit RightFrames(std::span<const ReadFrame> frames) {
    for (const ReadFrame& frame : frames) add(frame);
  }
  void add(const ReadFrame& frame) {
    right_ += frame.right ? 1U : 0U;
    ++all_;
  }
  std::size_t percent() const { return all_ == 0 ? 0 : 100 * right_ / all_; }

 private:
  std::size_t right_ = 0, all_ = 0;
};

/// The notes on frames that came in pieces, and on echoes.
class ConversationNotes {
 public:
  void add(const ReadFrame& frame);
  std::vector<std::string> list() const;

 private:
  struct Frames {
    std::string first{};  ///< `line 2: an answer in 2 pieces`
    std::size_t count = 0;
  };
  Frames in_pieces_{}, wrong_in_pieces_{}, echoes_{}, ignored_{};
  NamedRows not_read_{};
};

/// Another protocol in which most frames of a recording can be read, and at least half of them, if hardly any can be read in
/// `chosen`; null if there is none, or if most frames have the form of `chosen`.
const RecordedProtocol* likelier_protocol(const LineRecording& recording, const RecordedProtocol& chosen,
                                          const RightFrames& in_chosen, const Stamps& stamps);

/// Tells the frames of a whole recording, one after the other, as long as `tell` returns true. An answer has the number of
/// its request; requests are told without that of their answer.
void tell_conversation(const LineRecording& recording, const RecordedProtocol& protocol, const Stamps& stamps,
                       const std::function<bool(ReadFrame&)>& tell);

/// For each frame of a recording, by its number, whether it is a request that got an answer.
std::vector<bool> answered_requests(const LineRecording& recording, const RecordedProtocol& protocol, const Stamps& stamps);

/// A whole recording, each request with its answer.
std::vector<ReadFrame> conversation(const LineRecording& recording, const RecordedProtocol& protocol,
                                    const Stamps& stamps = {});

/// A log says what a program has sent and received, and that may have been the slave, or one that only listened. Where more
/// frames fit that way, directions are taken the other way round, or left open if they are all the same; then a note says
/// so.
void settle_directions(LineRecording& recording, const RecordedProtocol& protocol, const Stamps& stamps = {});

}  // namespace s7200::tools
