#include "tools/measuring/band.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/analysis/effects/looks.hpp"
#include "interpreter/model/times/named_times.hpp"
#include "interpreter/program/loading/load_times.hpp"

namespace s7200::tools {

std::vector<std::string> names_in_band(const CpuModel& model, const std::string& table) {
  std::vector<std::string> names;
  for (const NamedTimes* named : times_of(model)) names.emplace_back(named->name);
  if (table.empty()) return names;
  const auto asked_for = std::ranges::find(names, table);
  if (asked_for == names.end()) return {table};
  std::rotate(names.begin(), asked_for, std::next(asked_for));
  return names;
}

std::optional<TimesBand> load_band(const CpuModel& model, const std::string& table, const FileSource& files,
                                   const BandSettings& settings, std::vector<std::string>& errors) {
  auto times = load_times(model, table, files, errors);
  if (!times) return {};
  return band_around(model, table, std::move(*times), settings);
}

TimesBand band_around(const CpuModel& model, const std::string& table, TimeTable times, const BandSettings& settings) {
  std::vector<TimesBand::Named> tables;
  for (const std::string& name : names_in_band(model, table))
    tables.push_back({name, name == table ? std::move(times) : times_named(model, name)});
  return TimesBand(std::move(tables), settings);
}

ProgramBand::ProgramBand(stl::ParseResult parsed, const CpuModel& model, TimesBand tables, const SystemBlock& block)
    : parsed_(std::move(parsed)),
      model_(model),
      tables_(std::move(tables)),
      block_(block),
      looks_(looks_of(*decoded(0))),
      kept_(std::min(tables_.size(), kMostKept)) {}

std::shared_ptr<Program> ProgramBand::decoded(std::size_t table) const {
  return decode_program(parsed_, model_, tables_[table]).program;
}

std::shared_ptr<const Program> ProgramBand::program(std::size_t table) const {
  if (table < kept_.size()) {
    const std::lock_guard lock(mutex_);
    if (kept_[table]) return kept_[table];
  }
  const auto program = decoded(table);
  program->looks = looks_;
  program->system_block = block_;
  if (table >= kept_.size()) return program;
  const std::lock_guard lock(mutex_);
  return kept_[table] = program;
}

void LatencyRange::add(Time latency) { add({latency, latency}); }

void LatencyRange::add(const LatencyRange& other) {
  least = std::min(least, other.least);
  most = std::max(most, other.most);
}

std::string to_text(const LatencyRange& range) {
  if (!range.any()) return "";
  const auto ms = [](Time time) { return static_cast<double>(time) / kMillisecond; };
  return fmt::format("{:.1f} … {:.1f} ms", ms(range.least), ms(range.most));
}

nlohmann::ordered_json to_json(const LatencyRange& range) {
  if (!range.any()) return nullptr;
  const auto us = [](Time time) { return static_cast<double>(time) / kMicrosecond; };
  return {{"least", us(range.least)}, {"most", us(range.most)}};
}

namespace {

void count(ExchangeBand::Counts& counts, const std::string& what, std::size_t table) {
  const auto known = std::ranges::find(counts, what, &ExchangeBand::Count::what);
  if (known == counts.end())
    counts.push_back({what, 1, table});
  else
    ++known->tables;
}

nlohmann::ordered_json to_json(const ExchangeBand::Counts& counts, const char* key) {
  auto json = nlohmann::ordered_json::array();
  for (const ExchangeBand::Count& count : counts) json.push_back({{key, count.what}, {"tables", count.tables}});
  return json;
}

}  // namespace

void ExchangeBand::add(const BandOutcome& outcome) {
  const std::size_t table = tables_++;
  losing_ += outcome.lost > 0;
  tools::count(verdicts_, outcome.verdict, table);
  if (!outcome.stop.empty()) tools::count(stops_, outcome.stop, table);
  if (!outcome.exchange) return;
  const auto latency = outcome.exchange->latency();
  if (!latency) return;
  if (*latency < latency_.least) shortest_ = table;
  if (*latency > latency_.most) longest_ = table;
  latency_.add(*latency);
}

std::size_t ExchangeBand::count(const std::string& verdict) const {
  const auto known = std::ranges::find(verdicts_, verdict, &Count::what);
  return known == verdicts_.end() ? 0 : known->tables;
}

std::string ExchangeBand::text() const {
  std::string text = latency_.any() ? fmt::format("after {}   ", to_text(latency_)) : "";
  for (std::size_t i = 0; i < verdicts_.size(); ++i)
    text += fmt::format("{}{}: {} of {}{}", i == 0 ? "" : "; ", verdicts_[i].what, verdicts_[i].tables, tables_,
                        i == 0 ? " tables" : "");
  for (const Count& stop : stops_) text += fmt::format("; {}: {} of {}", stop.what, stop.tables, tables_);
  if (losing_ > 0) text += fmt::format("; characters or events lost: {} of {}", losing_, tables_);
  return text;
}

nlohmann::ordered_json ExchangeBand::json() const {
  return {{"tables", tables_},
          {"verdicts", to_json(verdicts_, "verdict")},
          {"stops", to_json(stops_, "why")},
          {"losing", losing_},
          {"latency_us", to_json(latency_)}};
}

}  // namespace s7200::tools
