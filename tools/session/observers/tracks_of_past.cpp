#include "tools/session/observers/tracks_of_past.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <span>
#include <tuple>
#include <utility>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/ladder/networks.hpp"
#include "interpreter/trace/text/event_lines.hpp"
#include "interpreter/trace/trace_reasons.hpp"
#include "serial_sim/modbus/answer.hpp"
#include "serial_sim/modbus/functions.hpp"
#include "serial_sim/modbus/rtu_stream.hpp"
#include "tools/session/observers/trace_of_past.hpp"
#include "tools/session/past/reader.hpp"
#include "tools/views/program/listing.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools {
namespace {

/// Of each TrackKind.
constexpr std::array<std::string_view, 10> kWords{"characters", "frames",   "interrupts", "queues", "scans",
                                                  "routines",   "networks", "events",     "errors", "value"};
static_assert(static_cast<std::size_t>(TrackKind::Value) + 1 == kWords.size());

/// All tracks of all stations.
class Tracks {
 public:
  explicit Tracks(const TracksWanted& wanted) : wanted_(wanted) {}

  /// What is not in the part is left out; what reaches into it is whole.
  void add(TrackKind kind, std::string name, std::size_t station, TrackSpan span,
           std::optional<SerialFormat> format = {}) {
    if (!is_in_part(span.at, span.end)) return;
    NamedTrack& track = named(kind, std::move(name), station);
    if (format) track.format = format;
    track.track.add(std::move(span));
  }

  void add(AnsweredFrame answered) {
    if (is_in_part(answered.answer_at, answered.answer_end)) longest_.add(std::move(answered));
  }

  LongestAnswers& longest() { return longest_; }

  /// Something may have been under way before the part.
  bool begin_within() const { return wanted_.from > 0; }

  /// By station, kind and name.
  std::vector<NamedTrack> take() {
    std::vector<NamedTrack> sorted;
    for (const auto& [key, place] : places_) sorted.push_back(std::move(all_[place]));
    return sorted;
  }

 private:
  using Key = std::tuple<std::size_t, TrackKind, std::string>;

  bool is_in_part(Time at, Time end) const { return at <= wanted_.to && (end > wanted_.from || at == wanted_.from); }

  NamedTrack& named(TrackKind kind, std::string name, std::size_t station) {
    const auto [place, is_new] = places_.try_emplace({station, kind, name}, all_.size());
    if (is_new) all_.push_back({kind, std::move(name), station, {}, Track(wanted_.from, wanted_.to, wanted_.most)});
    return all_[place->second];
  }

  const TracksWanted& wanted_;
  std::map<Key, std::size_t> places_{};
  std::deque<NamedTrack> all_{};
  LongestAnswers longest_{};
};

/// Characters of a port that follow each other without a pause, in one direction.
class FrameTrack {
 public:
  FrameTrack(Tracks& tracks, std::size_t station, std::uint8_t port)
      : tracks_(tracks), station_(station), port_(port), unsure_(tracks.begin_within()) {}

  void add(const TrackSpan& character, std::uint8_t byte, bool sent, Time silence) {
    if (!bytes_.empty() && (sent != sent_ || character.at - frame_.end > silence)) finish();
    if (bytes_.empty()) frame_ = {.at = character.at};
    sent_ = sent;
    frame_.end = character.end;
    if (frame_.error.empty()) frame_.error = character.error;
    if (bytes_.size() < kMostKept)
      bytes_.push_back(byte);
    else
      ++more_;
  }

  void finish() {
    if (bytes_.empty()) return;
    const bool follows = is_answer(), is_late = !follows && is_answer_to_earlier_request(), answers = follows || is_late;
    std::string said = serial::to_hex(bytes_);
    if (more_ > 0) said += fmt::format(" … and {} more", counted(more_, "byte"));
    const std::string words = is_late ? fmt::format("an answer of station {}", bytes_[0]) : in_words(follows);
    if (!words.empty()) said += ": " + words;
    frame_.text = fmt::format("{} {}", sent_ ? "sent" : "received", said);
    note_answer(std::move(said), answers);
    tracks_.add(TrackKind::Frames, fmt::format("port {} frames", port_), station_, std::exchange(frame_, {}));
    unsure_ = unsure_ && !follows;
    request_ = answers ? Bytes{} : bytes_;
    request_was_sent_ = sent_;
    bytes_.clear();
    more_ = 0;
  }

 private:
  /// Four times what Modbus RTU has at most: what is sent without a pause has no end.
  static constexpr std::size_t kMostKept = 1024;

  /// What a PLC that is a master receives as an answer is no request.
  void note_answer(std::string said, bool answers) {
    if (answers && !sent_) {
      open_.reset();
    } else if (!sent_) {
      open_ = AnsweredFrame{.station = station_, .at = frame_.at, .end = frame_.end, .text = std::move(said)};
    } else if (open_) {
      open_->answer_at = frame_.at;
      open_->answer_end = frame_.end;
      tracks_.add(std::move(*open_));
      open_.reset();
    }
  }

  /// To the frame before it in the other direction, unless that was itself an answer. In a part that may begin between a
  /// request and its answer, a value that is written only answers the same request: else the frame before was the answer.
  bool is_answer() const {
    return request_was_sent_ != sent_ && modbus::crc_ok(bytes_) && modbus::crc_ok(request_) && bytes_[0] == request_[0] &&
           (bytes_[1] & ~modbus::kExceptionFlag) == request_[1] &&
           (!unsure_ || !writes_one(request_) || bytes_ == request_ || bytes_[1] != request_[1]);
  }

  static bool writes_one(const Bytes& frame) {
    const modbus::FunctionRow* const row = modbus::find_function(frame[1]);
    return row && row->shape == modbus::Shape::WriteOne;
  }

  /// A part may begin between a request and its answer: that is as long as an answer of its function, and not as a request.
  bool is_answer_to_earlier_request() const {
    if (!unsure_ || !modbus::crc_ok(bytes_)) return false;
    constexpr std::size_t kException = 5;
    if ((bytes_[1] & modbus::kExceptionFlag) != 0) return bytes_.size() == kException;
    const std::span all(bytes_);
    const bool is_request = modbus::extent_of_request(all) != modbus::Extent::Part &&
                            modbus::extent_of_request(all.first(all.size() - 1)) != modbus::Extent::Whole;
    return !is_request && modbus::length_of_answer(all, all) == all.size();
  }

  /// Nothing of what is not Modbus RTU.
  std::string in_words(bool answers) const {
    if (!modbus::crc_ok(bytes_)) return {};
    if (answers) return modbus::describe(request_, bytes_);
    const modbus::FunctionRow* const row = modbus::find_function(bytes_[1]);
    return row ? fmt::format("station {}: {}", bytes_[0], row->name) : std::string();
  }

  Tracks& tracks_;
  std::size_t station_;
  std::uint8_t port_;
  TrackSpan frame_{};
  Bytes bytes_{};
  std::size_t more_ = 0;  ///< bytes after those
  Bytes request_{};  ///< the frame before, unless it was an answer
  bool sent_ = false, request_was_sent_ = false;
  bool unsure_;  ///< whether the next frame is a request: no answer has followed one yet
  std::optional<AnsweredFrame> open_{};  ///< received last, and nothing has been sent since
};

/// What runs without anything else between: a routine, or a network of it.
class RunningTrack {
 public:
  RunningTrack(Tracks& tracks, TrackKind kind, std::size_t station) : tracks_(tracks), kind_(kind), station_(station) {}

  /// `op` is the first instruction of what `record` belongs to.
  void note(const InstructionRecord& record, std::uint32_t op, const std::string& text, bool acts) {
    if (span_.op && (*span_.op != op || record.at != span_.end)) finish();
    if (!span_.op)
      span_ = {.at = record.at,
               .text = text,
               .value = kind_ == TrackKind::Networks ? std::optional(0.0) : std::nullopt,
               .op = op};
    span_.end = record.end;
    if (acts && span_.value) span_.value = 1;
  }

  void finish() {
    if (span_.op) tracks_.add(kind_, std::string(word_of(kind_)), station_, std::exchange(span_, {}));
  }

 private:
  Tracks& tracks_;
  TrackKind kind_;
  std::size_t station_;
  TrackSpan span_{};
};

/// How many interrupts wait in a queue, from one change to the next; no track if there is never more than one, whose arrow in
/// its own track says the same.
class QueueTrack {
 public:
  QueueTrack(Tracks& tracks, std::size_t station, Queue queue)
      : tracks_(tracks),
        station_(station),
        name_(kNames[static_cast<std::size_t>(queue)]) {}

  void begin(Time at, int waiting) {
    since_ = at;
    waiting_ = waiting;
  }

  /// What has occurred within an instruction is told after it.
  void change(Time at, int by) {
    finish(at);
    since_ = std::max(since_, at);
    waiting_ = std::max(0, waiting_ + by);
  }
  void empty(Time at) { change(at, -waiting_); }

  void finish(Time at) {
    if (at <= since_) return;
    TrackSpan span{.at = since_, .end = at, .text = fmt::format("{}", waiting_)};
    span.value = waiting_;
    first_.push_back(std::move(span));
    is_seen_ |= waiting_ > 1;
    if (!is_seen_) return;
    for (TrackSpan& one : first_) tracks_.add(TrackKind::Queues, name_, station_, std::move(one));
    first_.clear();
  }

 private:
  static constexpr std::array<std::string_view, kQueues> kNames{"port queue", "I/O queue", "timed queue"};

  Tracks& tracks_;
  std::size_t station_;
  std::string name_;
  int waiting_ = 0;
  Time since_ = 0;
  bool is_seen_ = false;
  std::vector<TrackSpan> first_{};  ///< up to the first of several
};

/// The tracks of one station.
class StationTracks {
 public:
  StationTracks(Tracks& tracks, const serial::Simulation& simulation, std::size_t station,
                TraceReasons::Disabled interrupts)
      : tracks_(tracks),
        simulation_(simulation),
        program_(simulation.cpu().program()),
        station_(station),
        networks_(program_),
        listing_(program_),
        event_text_(program_),
        reasons_(program_),
        interrupts_(interrupts),
        routine_track_(tracks, TrackKind::Routines, station),
        network_track_(tracks, TrackKind::Networks, station) {
    for (std::uint32_t op = 0; op < program_.ops.size(); ++op) {
      const bool begins = op == 0 || networks_.routine_of(op) != networks_.routine_of(op - 1);
      routine_begin_.push_back(begins ? op : routine_begin_.back());
    }
    for (std::uint8_t port = 0; port < kPorts.size(); ++port) frames_.emplace_back(tracks, station, port);
    for (std::size_t queue = 0; queue < kQueues; ++queue) queues_.emplace_back(tracks, station, static_cast<Queue>(queue));
  }

  void record(const TraceRecord& record) {
    note_waiting(record);
    switch (record.kind) {
      case TraceKind::ScanBegin:
        begin_scan(record.at, record.count);
        break;
      case TraceKind::ServiceEnd:
        end_service(record);
        break;
      case TraceKind::ServiceBegin:
        waited_ = reasons_.held_up_by(record);
        occurred_ = record.since;
        break;
      case TraceKind::CharacterReceived:
      case TraceKind::CharacterIgnored:
      case TraceKind::CharacterDropped:
        add_character(record, false);
        break;
      case TraceKind::CharacterSent:
        add_character(record, true);
        break;
      case TraceKind::EventLost:
      case TraceKind::EventDropped:
      case TraceKind::RuntimeError:
      case TraceKind::FatalError:
        add_instant(TrackKind::Errors, record);
        break;
      case TraceKind::ModeChange:
        end_scan(record.at, scan_number_ + 1);
        [[fallthrough]];
      case TraceKind::Transmit:
      case TraceKind::Receive:
      case TraceKind::ReceiveEnd:
      case TraceKind::PortControl:
      case TraceKind::Enable:
      case TraceKind::Attach:
      case TraceKind::Detach:
      case TraceKind::NetworkJob:
      case TraceKind::PpiService:
      case TraceKind::PpiAccess:
      case TraceKind::PpiIgnored:
      case TraceKind::PpiNotModelled:
        add_instant(TrackKind::Events, record);
        break;
      case TraceKind::EventOccurred:
      case TraceKind::TransmitEnd:
      case TraceKind::OutputChanged:
      case TraceKind::AnalogChanged:
        break;
    }
    reasons_.note(record);
  }

  /// The part that is looked at begins: the scan that the CPU is in reaches into it.
  void begin_part(Time at, bool with_queues) {
    in_part_ = true;
    with_queues_ = with_queues;
    for (std::size_t queue = 0; queue < kQueues; ++queue)
      queues_[queue].begin(at, simulation_.cpu().state().queue[queue].count);
    reasons_.forget(interrupts_);
    if (simulation_.plc().executes()) begin_scan(simulation_.cpu().state().scan_begin, scan_now());
  }

  void instruction(const InstructionRecord& record, bool with_networks) {
    reasons_.note(record);
    if (!with_networks) return;
    const Op& op = program_.ops[record.op];
    const bool acts = is_box_or_coil(op) && (op.power_mask != 0 ? record.powered : record.top);
    routine_track_.note(record, routine_begin_[record.op], networks_.routine_of(record.op), acts);
    network_track_.note(record, networks_.first_of(record.op), listing_.network_of(record.op), acts);
  }

  void end_part(Time at) {
    finish_scan(at, scan_now() + 1);
    routine_track_.finish();
    network_track_.finish();
    if (with_queues_)
      for (QueueTrack& queue : queues_) queue.finish(at);
    in_part_ = false;
  }

  void finish_frames() {
    for (FrameTrack& frames : frames_) frames.finish();
  }

  const std::optional<LongestScan>& longest_scan() const { return longest_scan_; }

 private:
  void note_waiting(const TraceRecord& record) {
    if (!in_part_ || !with_queues_) return;
    const bool comes = record.kind == TraceKind::EventOccurred;
    if (comes || record.kind == TraceKind::ServiceBegin || record.kind == TraceKind::EventDropped)
      queues_[static_cast<std::size_t>(find_event(record.event)->queue)].change(record.at, comes ? 1 : -1);
    if (record.kind == TraceKind::ModeChange)
      for (QueueTrack& queue : queues_) queue.empty(record.at);
  }

  void begin_scan(Time at, std::uint64_t number) {
    if (!in_part_) return;
    end_scan(at, number);
    scan_number_ = number;
    scan_ = {.at = at, .text = fmt::format("scan {}", number)};
    in_scan_ = true;
  }

  /// Those that were passed over after it are as long as it is.
  void end_scan(Time at, std::uint64_t next) {
    if (in_scan_ && next > scan_number_) {
      const Time length = (at - scan_.at) / static_cast<Time>(next - scan_number_);
      if (!longest_scan_ || length > longest_scan_->end - longest_scan_->at)
        longest_scan_ = {.station = station_, .at = scan_.at, .end = scan_.at + length, .text = scan_.text};
    }
    finish_scan(at, next);
  }

  /// With those that were passed over after it.
  void finish_scan(Time at, std::uint64_t next) {
    if (!std::exchange(in_scan_, false)) return;
    scan_.end = at;
    scan_.count = next - scan_number_;
    tracks_.add(TrackKind::Scans, std::string(word_of(TrackKind::Scans)), station_, std::move(scan_));
  }

  /// The number of the scan that the CPU is in.
  std::uint64_t scan_now() const { return simulation_.cpu().state().scans + 1; }

  void end_service(const TraceRecord& record) {
    TrackSpan span{.at = record.since,
                   .end = record.at,
                   .text = fmt::format("INT {}: {}", record.routine, event_text_.event(record.event)),
                   .occurred = occurred_};
    span.why = std::exchange(waited_, {});
    const std::uint32_t op = program_.interrupt[record.routine];
    if (op != kNoRoutine) span.op = op;
    tracks_.add(TrackKind::Interrupts, fmt::format("INT {}", record.routine), station_, std::move(span));
    occurred_.reset();
  }

  void add_character(const TraceRecord& record, bool sent) {
    const SerialFormat format = simulation_.plc().port_format(record.port);
    const bool dropped = record.kind == TraceKind::CharacterIgnored || record.kind == TraceKind::CharacterDropped;
    const Time at = sent ? record.at - format.character_time() : record.since;
    TrackSpan span{.at = at,
                   .end = at + format.character_time(),  // the PLC has it in the middle of the stop bit
                   .text = fmt::format("{:02x}", record.byte)};
    if (record.parity_error) span.error = "parity error";
    if (record.framing_error) span.error += span.error.empty() ? "framing error" : ", framing error";
    if (dropped) span.why = ignored_because(record);
    const Ignored why{record.code};
    if (!dropped || why == Ignored::NotAttached || why == Ignored::NoRcvWaits)
      frames_[record.port].add(span, record.byte, sent, format.silence());
    tracks_.add(TrackKind::Characters, fmt::format("port {} {}", record.port, sent ? "sent" : "received"), station_,
                std::move(span), format);
  }

  void add_instant(TrackKind kind, const TraceRecord& record) {
    fmt::memory_buffer text;
    event_text_.append_to(text, record);
    TrackSpan span{.at = record.at, .end = record.at, .text = fmt::to_string(text)};
    if (kind == TrackKind::Errors) span.error = span.text;
    span.why = std::string(stl::trim(reasons_.of(record)));
    const bool names_op = record.kind == TraceKind::Transmit || record.kind == TraceKind::Receive ||
                          record.kind == TraceKind::RuntimeError || record.kind == TraceKind::FatalError;
    if (names_op && record.op < program_.ops.size()) span.op = record.op;
    tracks_.add(kind, std::string(word_of(kind)), station_, std::move(span));
  }

  Tracks& tracks_;
  const serial::Simulation& simulation_;
  const Program& program_;
  std::size_t station_;
  Networks networks_;
  std::vector<std::uint32_t> routine_begin_{};  ///< by op, the first one of its routine
  Listing listing_;
  EventText event_text_;
  TraceReasons reasons_;
  TraceReasons::Disabled interrupts_;  ///< where the part begins
  RunningTrack routine_track_, network_track_;
  std::vector<FrameTrack> frames_{};
  std::vector<QueueTrack> queues_{};
  bool in_part_ = false, with_queues_ = false;
  TrackSpan scan_{};
  bool in_scan_ = false;
  std::uint64_t scan_number_ = 0;
  std::optional<LongestScan> longest_scan_{};
  std::string waited_{};
  std::optional<Time> occurred_{};
};

/// A watched address, from one change to the next.
class ValueTrack {
 public:
  ValueTrack(Tracks& tracks, std::size_t station, const MemoryRange& range, const State& state, Time from)
      : tracks_(tracks), station_(station), range_(range), now_(number_at(state, range, 0)), since_(from) {}

  void look(const State& state, Time at) {
    const double value = number_at(state, range_, 0);
    if (value == now_) return;
    finish(at);
    now_ = value;
    since_ = at;
  }

  void finish(Time at) {
    TrackSpan span{.at = since_, .end = at, .text = fmt::format("{}", now_)};
    span.value = now_;
    tracks_.add(TrackKind::Value, range_.name_of(0), station_, std::move(span));
  }

 private:
  Tracks& tracks_;
  std::size_t station_;
  MemoryRange range_;
  double now_;
  Time since_;
};

class TracksReader final : public Reader {
 public:
  TracksReader(History& history, const TracksWanted& wanted, bool with_networks, StopToken stop_request)
      : Reader(stop_request), history_(history), wanted_(wanted), with_networks_(with_networks), tracks_(wanted) {
    for (std::size_t station = 0; station < history.stations(); ++station)
      stations_.emplace_back(tracks_, history.station(station), station,
                             interrupts_disabled(history, station, stop_request));
  }

  bool wants_instructions() const override { return in_part_; }
  bool wants_scans() const override { return in_part_ && with_networks_; }
  void record(const TraceRecord& record) override { stations_[history_.told_of()].record(record); }

  /// What the system changes between two instructions is seen in front of the next one.
  bool before(std::uint32_t op) override {
    if (history_.told_of() == wanted_.watched_at) look(watched_state().time);
    return Reader::before(op);
  }

  void instruction(const InstructionRecord& record) override {
    stations_[history_.told_of()].instruction(record, with_networks_);
    if (history_.told_of() == wanted_.watched_at) look(record.end);
  }

  void begin_part() {
    in_part_ = true;
    for (StationTracks& station : stations_) station.begin_part(wanted_.from, with_networks_);
    for (const MemoryRange& range : wanted_.watched)
      values_.emplace_back(tracks_, wanted_.watched_at, range, watched_state(), wanted_.from);
  }

  void end_part(Time at) {
    in_part_ = false;
    for (StationTracks& station : stations_) station.end_part(at);
    look(at);
    for (ValueTrack& value : values_) value.finish(at);
    values_.clear();
  }

  std::vector<NamedTrack> take() {
    for (StationTracks& station : stations_) station.finish_frames();
    return tracks_.take();
  }

  std::vector<LongestScan> longest_scans() const {
    std::vector<LongestScan> all;
    for (const StationTracks& station : stations_)
      if (station.longest_scan()) all.push_back(*station.longest_scan());
    return all;
  }

  LongestAnswers take_longest() { return std::move(tracks_.longest()); }

 private:
  const State& watched_state() const { return std::as_const(history_).station(wanted_.watched_at).cpu().state(); }

  void look(Time at) {
    for (ValueTrack& value : values_) value.look(watched_state(), at);
  }

  History& history_;
  const TracksWanted& wanted_;
  bool with_networks_;
  bool in_part_ = false;  ///< before and after it only what reaches into it is looked at: characters of a frame
  Tracks tracks_;
  std::deque<StationTracks> stations_{};
  std::deque<ValueTrack> values_{};
};

/// A frame that long may have begun before a part, or end after it.
Time longest_frame(const History& history) {
  Time longest = 0;
  for (std::size_t station = 0; station < history.stations(); ++station) {
    const serial::Simulation& simulation = history.station(station);
    for (std::uint8_t port = 0; port < simulation.cpu().program().model->ports; ++port) {
      const SerialFormat format = simulation.plc().port_format(port);
      longest = std::max(longest, static_cast<Time>(modbus::kLongestRtuFrame) * format.character_time() + format.silence());
    }
  }
  return longest;
}

/// The end of a part by its time: all that was done to the simulation up to then has been done. At the end of the past all
/// that has happened in that instant belongs to it: the CPU may have gone to STOP in no time.
Moment end_at(const History& history, Time time) {
  if (time >= history.newest().time) return history.newest();
  const std::vector<Moment>& done = history.action_moments();
  const auto later = std::ranges::upper_bound(done, time, {}, &Moment::time);
  return {.actions = history.usage().forgotten + static_cast<std::size_t>(later - done.begin()), .time = time};
}

}  // namespace

void LongestAnswers::add(AnsweredFrame answered) {
  ++count_;
  const auto longer = [](const AnsweredFrame& one, const AnsweredFrame& other) { return one.latency() > other.latency(); };
  const auto place = std::upper_bound(all_.begin(), all_.end(), answered, longer);
  if (place == all_.end() && all_.size() == kMost) return;
  all_.insert(place, std::move(answered));
  if (all_.size() > kMost) all_.pop_back();
}

std::string_view word_of(TrackKind kind) { return kWords[static_cast<std::size_t>(kind)]; }

TracksOfPast tracks_of_past(History& history, const TracksWanted& wanted, StopToken stop_request) {
  const Moment now = history.now(), oldest = history.usage().oldest;
  const Time reach = longest_frame(history);
  TracksOfPast past{.to = wanted.to, .with_networks = wanted.to - wanted.from <= kLongestWithNetworks};
  const auto go_to = [&](Time time) {
    if (time <= oldest.time)
      history.go_to(oldest);
    else
      past.interrupted = past.interrupted || !history.go_to(time);
  };
  go_to(wanted.from);
  TracksReader reader(history, wanted, past.with_networks, stop_request);
  go_to(wanted.from - reach);
  const auto play_to = [&](Time time) {
    if (history.now().time > time) return;
    past.interrupted = past.interrupted || !history.play(reader, end_at(history, time));
  };
  play_to(wanted.from);
  reader.begin_part();
  play_to(wanted.to);
  if (past.interrupted) past.to = std::min(wanted.to, history.now().time);
  reader.end_part(past.to);
  play_to(std::min(wanted.to + reach, history.newest().time));
  past.tracks = reader.take();
  past.longest = reader.take_longest();
  past.longest_scans = reader.longest_scans();
  history.go_to(now);
  return past;
}

}  // namespace s7200::tools
