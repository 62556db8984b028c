// What a PLC did in a part of its run, series by series, so that two runs of it can be compared: each bit of its memory,
// each jump, call and segment, characters, interrupts and errors; and of each what had been looked at before.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "interpreter/analysis/effects/bits.hpp"
#include "interpreter/base/stop_token.hpp"
#include "interpreter/model/area.hpp"
#include "interpreter/model/contact_form.hpp"
#include "tools/session/past/reader.hpp"

namespace s7200::tools {

/// Where a bit is looked at: between two scans, in front of an instruction that reads it, behind one that writes it.
using Point = std::uint32_t;
inline constexpr Point kBetweenScans = 0;
inline Point in_front_of(std::uint32_t op) { return 2 * op + 1; }
inline Point behind(std::uint32_t op) { return 2 * op + 2; }
inline std::uint32_t op_at(Point point) { return (point - 1) / 2; }

/// What a series is of: a bit of the image by its number, at a point; the power flow of an instruction that decides where
/// the program goes on; or a kind of record with what it says.
using SeriesKey = std::uint64_t;
inline constexpr unsigned kBitsOfPlace = 20;  // of the key of memory: the bit; above it the point
static_assert(image::kSize * 8 < 1U << kBitsOfPlace);
inline constexpr SeriesKey kFirstDecision = SeriesKey{1} << 40;
inline constexpr SeriesKey kFirstRecord = SeriesKey{1} << 41;
inline bool is_memory(SeriesKey key) { return key < kFirstDecision; }
inline bool is_decision(SeriesKey key) { return key >= kFirstDecision && key < kFirstRecord; }
inline SeriesKey memory_key(std::uint64_t bit, Point point) { return SeriesKey{point} << kBitsOfPlace | bit; }
inline std::uint64_t bit_of(SeriesKey key) { return key & ((SeriesKey{1} << kBitsOfPlace) - 1); }
inline Point point_of(SeriesKey key) { return static_cast<Point>(key >> kBitsOfPlace); }
inline SeriesKey decision_key(std::uint32_t op) { return kFirstDecision + op; }
/// Of a record with its port or event, and its byte, routine or code.
SeriesKey record_key(TraceKind kind, std::uint8_t where, std::uint16_t what);

/// Memory that an instruction, or the system, has looked at.
struct Look {
  std::optional<std::uint32_t> op{};
  Bits bits{};
};

/// Something that changed, with what led to it.
struct Happening {
  Time at = 0;
  std::optional<std::uint32_t> op{};      ///< nothing: the system did it
  Bits place{0, 0};                       ///< of memory, as the instruction names it
  TraceKind kind{};                       ///< of a record
  std::uint8_t where = 0;                 ///< of a record: its port or event
  std::uint16_t what = 0;                 ///< of a record: its byte, routine or code
  std::optional<std::uint8_t> serving{};  ///< the event whose interrupt routine ran
  std::vector<Look> looks{};              ///< the contacts of its rung, and its own operands
};

struct Turn {
  Time at = 0;
  std::size_t happening = 0;
  bool value = true;  ///< that the bit, or the power flow, has from then on
  Time seen = 0;      ///< of a bit: when the program came to the point
};

/// While an instruction was passed again and again, with power flow or without.
struct Passes {
  Time first = 0, last = 0;
};

struct RunRecord {
  std::vector<std::uint8_t> image;  ///< at its beginning
  std::vector<Happening> happenings{};
  std::unordered_map<SeriesKey, std::vector<Turn>> series{};      ///< that can be compared
  std::unordered_map<std::uint64_t, std::vector<Turn>> memory{};  ///< by bit: each time that it turned
  std::vector<std::vector<Bits>> places{};                        ///< by point: what is looked at there
  std::vector<std::vector<Passes>> passes{};                      ///< by op
  Time longest_scan = 0;
  Time end = 0;       ///< how far it has come
  bool full = false;  ///< it ended early, as there was too much to keep

  /// The bytes of a place as they were after that instant; of one bit 0 or 1.
  std::vector<std::uint8_t> value(const Bits& place, Time at) const;
  /// The same as it was found at a point until then.
  std::vector<std::uint8_t> value(const Bits& place, Point point, Time at) const;

  bool is_looked_at(const Bits& place, Point point) const;
  /// Whether the program passed an instruction then, give or take `about`.
  bool passes_about(std::uint32_t op, Time at, Time about) const;
};

/// Memory that keeps a value, whatever the program and the system write there, until an instant at which it gets another.
struct Hold {
  std::vector<Bits> places{};         ///< of an input its point, then its image
  std::vector<std::uint8_t> value{};  ///< as bytes_at() gives it
  Time until = kNever;
  std::vector<std::uint8_t> then{};  ///< what the first of them gets at `until`
};

class PointSamples;
class MemoryOfLevels;

class SeriesRecorder final : public Reader {
 public:
  static constexpr std::size_t kMostHappenings = 300'000;

  /// The history stands at the beginning of the part. A PLC whose memory is held is changed by this.
  SeriesRecorder(History& history, std::size_t station, std::optional<Hold> hold, StopToken stop_request);
  ~SeriesRecorder() override;

  bool before(std::uint32_t op) override;
  void record(const TraceRecord& record) override;
  void instruction(const InstructionRecord& record) override;

  /// Of an input whose edges start interrupts or are counted: nothing of that comes of a change that is held.
  void ignore_edges();

  const RunRecord& run() const { return run_; }
  bool interrupted() const { return interrupted_; }

 private:
  struct Contact {
    std::uint32_t op = 0;
    std::vector<Bits> reads{};
  };
  struct Rung {
    std::vector<Contact> contacts{};
    bool ended = false;  ///< by a coil or box: the next LD begins another one
  };
  struct Edges {
    Attachments attached{};
    std::array<HighSpeedCounter, kCounters.size()> counter{};
    std::array<std::uint8_t, 24> values{};
  };

  std::size_t level() const;
  bool is_stop(std::uint32_t op) const;
  std::vector<Bits> reads_of(std::uint32_t op);
  const std::vector<Bits>& writes_of(std::uint32_t op);
  const std::vector<Bits>& direct_reads_of(std::uint32_t op);
  void note_pass(std::uint32_t op);
  void keep_held();
  void put(const Bits& place, const std::vector<std::uint8_t>& value);
  void heed_edges_again();
  void note_changes(std::optional<std::uint32_t> op, Time at);
  void note_written(const InstructionRecord& record, const std::vector<Bits>& places);
  void note_decision(const InstructionRecord& record);
  void note_store(std::uint32_t op);
  std::optional<std::uint32_t> stored_by(const Bits& place) const;
  std::vector<Look> looks_of(std::uint32_t op);
  std::vector<Look> looks_of_system(const Bits& place) const;
  Happening happening_of(std::optional<std::uint32_t> op, Time at) const;
  void add(SeriesKey key, Time at, Happening happening);
  std::vector<Bits> places_of(const std::vector<std::uint64_t>& changed, const std::vector<Bits>& written) const;

  Cpu& cpu_;
  std::optional<Hold> hold_;
  std::optional<Edges> edges_{};
  RunRecord run_;
  std::vector<std::uint8_t> seen_;                  // the image so far
  std::array<Rung, 2 * (kMostCalls + 1)> rungs_{};  // by level
  std::unique_ptr<PointSamples> samples_;
  std::unique_ptr<MemoryOfLevels> levels_;
  std::vector<std::optional<std::vector<Bits>>> reads_{}, writes_{};  // by op, of those without pointers and counts
  std::vector<std::optional<std::vector<Bits>>> direct_reads_{};      // by op
  std::vector<std::uint64_t> passed_in_{};                            // by op: the number of the scan
  std::vector<std::optional<bool>> decided_{};                        // by op
  std::map<std::uint32_t, std::vector<Look>> timers_{};               // by number: what their last execution looked at
  std::array<std::vector<Look>, kPorts.size()> messages_{};           // what the last XMT looked at

  /// What the system stores after an RCV, NETR or NETW.
  struct Store {
    Time at = 0;
    std::vector<Bits> places{};
    std::vector<Look> looks{};
  };
  std::map<std::uint32_t, Store> stores_{};  // by op, of their last execution
  std::size_t level_ = 0;
  bool known_only_now_ = false;
  std::vector<Bits> read_now_{}, written_now_{};  // of the instruction under way, if they are known only before it
  Time scan_ = 0;
  std::uint64_t scans_ = 1;
  bool interrupted_ = false;
};

}  // namespace s7200::tools
