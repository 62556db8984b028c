// A program with each table of execution times that may be the true one, and what came of its exchanges with all of them.
#pragma once

#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "interpreter/base/file_source.hpp"
#include "interpreter/model/times/times_band.hpp"
#include "interpreter/program/checking/checker.hpp"
#include "interpreter/trace/trace.hpp"
#include "serial_sim/peers/requester.hpp"

namespace s7200::tools {

/// The tables around which random ones are drawn: `table`, and the others of the CPU that have a name if it is one of these.
/// Empty: the CPU's own is the first.
std::vector<std::string> names_in_band(const CpuModel& model, const std::string& table);

/// Loads the given tables, as load_times() takes them, and random ones. Nothing, with errors, as in load_times().
std::optional<TimesBand> load_band(const CpuModel& model, const std::string& table, const FileSource& files,
                                   const BandSettings& settings, std::vector<std::string>& errors);

/// Makes the band around a table that has been read already, as `times`.
TimesBand band_around(const CpuModel& model, const std::string& table, TimeTable times, const BandSettings& settings);

/// A program that has no errors, with each of the tables. It is decoded for a table when that is first asked for, from any
/// thread; with one of the first tables it is kept, with the others decoded anew each time, so that a hundred thousand of
/// them need no more memory than a few hundred.
class ProgramBand {
 public:
  ProgramBand(stl::ParseResult parsed, const CpuModel& model, TimesBand tables, const SystemBlock& block);

  std::size_t size() const { return tables_.size(); }
  std::string table_name(std::size_t table) const { return tables_.name(table); }
  TimeTable times(std::size_t table) const { return tables_[table]; }
  const CpuModel& model() const { return model_; }
  std::shared_ptr<const Program> program(std::size_t table) const;

 private:
  std::shared_ptr<Program> decoded(std::size_t table) const;

  stl::ParseResult parsed_;
  const CpuModel& model_;
  TimesBand tables_;
  SystemBlock block_;
  Looks looks_;  // of the program with any of the tables
  static constexpr std::size_t kMostKept = 300;
  mutable std::mutex mutex_;
  mutable std::vector<std::shared_ptr<const Program>> kept_;
};

/// A range of latencies, from the shortest to the longest.
struct LatencyRange {
  Time least = kNever, most = 0;

  void add(Time latency);
  void add(const LatencyRange& other);
  bool any() const { return least <= most; }
};

/// A range as text: `15.8 … 19.6 ms`; empty if there is none.
std::string to_text(const LatencyRange& range);
/// A range as JSON: {"least": …, "most": …}; null if there is none.
nlohmann::ordered_json to_json(const LatencyRange& range);

/// The outcome of one exchange with one table.
struct BandOutcome {
  std::optional<serial::Exchange> exchange{};  ///< nothing: the run did not get so far
  std::string verdict{};                       ///< in a word or two: `answered`, `no answer`
  std::size_t lost = 0;                        ///< events that the CPU's queues had no room for, of characters or others
  std::string stop{};                          ///< why the CPU was in STOP afterwards; empty in RUN
};

/// The outcomes of an exchange with all tables.
class ExchangeBand {
 public:
  void add(const BandOutcome& outcome);

  std::size_t tables() const { return tables_; }
  const LatencyRange& latency() const { return latency_; }

  /// The tables of its ends, if there is one; they are counted as they were added.
  std::size_t shortest() const { return shortest_; }
  std::size_t longest() const { return longest_; }

  struct Count {
    std::string what;
    std::size_t tables;
    std::size_t first;  ///< of these tables
  };
  using Counts = std::vector<Count>;  ///< in the order in which they were found

  const Counts& verdicts() const { return verdicts_; }
  const Counts& stops() const { return stops_; }

  /// The number of tables with this verdict.
  std::size_t count(const std::string& verdict) const;

  /// The outcomes as text: `after 15.8 … 19.6 ms   answered: 200 of 202 tables; no answer: 2 of 202; CPU in STOP: 2 of 202;
  /// characters or events lost: 3 of 202`
  std::string text() const;
  nlohmann::ordered_json json() const;

 private:
  std::size_t tables_ = 0, losing_ = 0, shortest_ = 0, longest_ = 0;
  LatencyRange latency_;
  Counts verdicts_, stops_;
};

/// Hears of the events that a CPU loses.
class LostEvents final : public TraceSink {
 public:
  void record(const TraceRecord& record) override { count_ += record.kind == TraceKind::EventLost; }
  bool wants_scans() const override { return false; }

  /// The number since the last call.
  std::size_t take() { return std::exchange(count_, 0); }

 private:
  std::size_t count_ = 0;
};

}  // namespace s7200::tools
