#include "tools/master/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "interpreter/base/text/counted.hpp"

namespace s7200::tools {
namespace {

using serial::Verdict;

constexpr std::array kVerdicts{Verdict::Right, Verdict::Exception, Verdict::Silent, Verdict::Wrong};

}  // namespace

const char* verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::Right:
      return "right";
    case Verdict::Exception:
      return "exception";
    case Verdict::Silent:
      return "silent";
    case Verdict::Wrong:
      return "wrong";
  }
  return "";
}

void ExchangeStatistics::add(Verdict verdict, std::optional<Time> latency) {
  ++counts_[static_cast<std::size_t>(verdict)];
  if (!latency) return;
  least_ = std::min(least_, *latency);
  most_ = std::max(most_, *latency);
  sum_ += *latency;
  if (last_.size() < kKept)
    last_.push_back(*latency);
  else
    last_[timed_ % kKept] = *latency;
  ++timed_;
}

std::uint64_t ExchangeStatistics::sent() const {
  return std::accumulate(std::begin(counts_), std::end(counts_), std::uint64_t{0});
}

std::optional<ExchangeStatistics::Latency> ExchangeStatistics::latency() const {
  if (timed_ == 0) return {};
  std::vector<Time> sorted = last_;
  const auto p99 = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() * 99 + 99) / 100 - 1);
  std::nth_element(sorted.begin(), p99, sorted.end());
  return Latency{least_, sum_ / static_cast<Time>(timed_), *p99, most_};
}

std::string ExchangeStatistics::text(std::string_view refusal) const {
  std::string text = counted(sent(), "request") + ": ";
  for (const Verdict verdict : kVerdicts)
    text += fmt::format("{} {}, ", count(verdict), verdict == Verdict::Exception ? refusal : verdict_name(verdict));
  text += fmt::format("{} repeated\n", retries_);
  if (const auto time = latency())
    text += fmt::format("latency: least {}, mean {}, p99 {}, most {}\n", format_duration(time->least),
                        format_duration(time->mean), format_duration(time->p99), format_duration(time->most));
  return text;
}

nlohmann::ordered_json ExchangeStatistics::json() const {
  nlohmann::ordered_json json{{"requests", sent()}};
  for (const Verdict verdict : kVerdicts) json[verdict_name(verdict)] = count(verdict);
  json["repeated"] = retries_;
  json["latency_us"] = nullptr;
  if (const auto time = latency()) {
    const auto us = [](Time t) { return static_cast<double>(t) / kMicrosecond; };
    json["latency_us"] = {
        {"least", us(time->least)}, {"mean", us(time->mean)}, {"p99", us(time->p99)}, {"most", us(time->most)}};
  }
  return json;
}

}  // namespace s7200::tools
