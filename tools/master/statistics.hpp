// How many exchanges went how, and how long the answers took.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/time.hpp"
#include "serial_sim/peers/answer.hpp"

namespace s7200::tools {

class ExchangeStatistics {
 public:
  /// Counts the final verdict on a request, and the latency of its answer, right or not.
  void add(serial::Verdict verdict, std::optional<Time> latency);
  void add_retry() { ++retries_; }

  std::uint64_t sent() const;
  std::uint64_t count(serial::Verdict verdict) const { return counts_[static_cast<std::size_t>(verdict)]; }

  /// Whether any request was not answered right.
  bool any_failed() const { return sent() != count(serial::Verdict::Right); }

  /// The latency of answers, exceptions among them; nothing before the first. The percentile is that of the last kKept.
  struct Latency {
    Time least = 0, mean = 0, p99 = 0, most = 0;
  };
  std::optional<Latency> latency() const;

  /// Two lines. `refusal`: what the protocol calls one.
  std::string text(std::string_view refusal) const;
  nlohmann::ordered_json json() const;

 private:
  static constexpr std::size_t kKept = 100'000;

  std::uint64_t counts_[4] = {};
  std::uint64_t retries_ = 0, timed_ = 0;
  Time least_ = kNever, most_ = 0, sum_ = 0;
  std::vector<Time> last_;
};

/// The verdict's name: `right`, `exception`, `silent`, `wrong`
const char* verdict_name(serial::Verdict verdict);

}  // namespace s7200::tools
