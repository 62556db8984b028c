#include "tools/scenario/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <exception>
#include <future>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "tools/scenario/reporting/bytes_diff.hpp"
#include "tools/scenario/steps/expected/reception.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

constexpr const char* kIndented = "    ";

bool same_answer(const serial::Exchange& a, const serial::Exchange& b) {
  return a.response_bytes() == b.response_bytes() && a.parity_error() == b.parity_error() &&
         a.framing_error() == b.framing_error();
}

bool same_time(const serial::Exchange& a, const serial::Exchange& b, Time tolerance) {
  const auto one = a.latency(), other = b.latency();
  return !one || !other || std::abs(*one - *other) <= tolerance;
}

std::string came_text(const serial::Exchange& exchange) {
  const Bytes response = exchange.response_bytes();
  const Bytes request = serial::bytes_of(exchange.request);
  if (response.empty()) return request.empty() ? "nothing" : "no answer";
  const std::string says = answer_text(request, response);
  const Time latency = *exchange.latency();
  const std::string when =
      latency >= 0 ? "after " + format_duration(latency, 6) : format_duration(-latency, 6) + " before it was waited for";
  return says.empty() ? when : fmt::format("{} {}", says, when);
}

/// Side by side, from the request on.
std::string exchange_text(const Scenario& scenario, const Seen& one, const Seen& other, const std::string& one_name,
                          const std::string& other_name, bool colour) {
  const std::size_t width = std::max({one_name.size(), other_name.size(), std::size_t{9}});
  const Step& step = scenario.steps[one.step];
  const std::string place =
      step.position.line ? fmt::format(", {}:{}", stl::printable(scenario.source->name), step.position.line) : "";
  const std::string turn = step.loop.empty() ? "" : fmt::format(" (with {})", stl::printable(step.loop));
  const auto before = std::count_if(scenario.steps.begin(), scenario.steps.begin() + static_cast<std::ptrdiff_t>(one.step),
                                    [](const Step& s) { return reception_of(s) != nullptr; });
  const std::size_t number = static_cast<std::size_t>(before) + one.turn + 1;
  std::string text = fmt::format("{}exchange {}{}{}\n", kIndented, number, place, turn);
  const bool asked = !one.exchange.request.empty();
  text += fmt::format("{}{:<{}} {}\n", kIndented, "request", width,
                      asked ? serial::to_hex(one.exchange.request) : "none: a transmission that no one asked for");
  if (!same_answer(one.exchange, other.exchange))
    text += bytes_diff(pattern_of(one.exchange.response_bytes()), pattern_of(other.exchange.response_bytes()), kIndented,
                       colour, one_name, other_name);
  text += fmt::format("{}{:<{}} {}\n", kIndented, one_name, width, came_text(one.exchange));
  text += fmt::format("{}{:<{}} {}\n", kIndented, other_name, width, came_text(other.exchange));
  return text;
}

/// Where both sides differ first.
class FirstDifference {
 public:
  FirstDifference(const Scenario& scenario, const Side& one, const Side& other, const Comparison& comparison)
      : scenario_(scenario), one_(one), other_(other), comparison_(comparison) {}

  /// What both were asked in the same step.
  void add(const Seen& one, const Seen& other) {
    if (answer_differs_) return;
    if (!same_answer(one.exchange, other.exchange)) {
      answer_differs_ = true;
      show("the first different answer", one, other);
    } else if (comparison_.timing && !time_differs_ && !same_time(one.exchange, other.exchange, comparison_.tolerance)) {
      time_differs_ = true;
      show("the first different time", one, other);
    }
  }

  std::string text() const { return text_; }

 private:
  void show(std::string_view heading, const Seen& one, const Seen& other) {
    text_ += fmt::format("{}{}\n", kIndented, heading);
    text_ += exchange_text(scenario_, one, other, one_.name, other_.name, comparison_.colour);
  }

  const Scenario& scenario_;
  const Side &one_, &other_;
  const Comparison& comparison_;
  bool answer_differs_ = false, time_differs_ = false;
  std::string text_;
};

/// The exchanges of the other side on their way to this one.
class ExchangeQueue {
 public:
  explicit ExchangeQueue(std::size_t most) : most_(most) {}

  /// Waits for room.
  void put(const Seen& seen) {
    std::unique_lock lock(mutex_);
    moved_.wait(lock, [&] { return seen_.size() < most_ || closed_; });
    if (!closed_) seen_.push_back(seen);
    moved_.notify_all();
  }

  /// No more will come.
  void end(std::exception_ptr failed = nullptr) {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    failed_ = std::move(failed);
    moved_.notify_all();
  }

  /// The one that belongs to this one, with all before it out of the way; nothing if there is none. Throws what the other
  /// side threw.
  std::optional<Seen> take(const Seen& like) {
    std::unique_lock lock(mutex_);
    const auto behind = [&] { return !seen_.empty() && place(seen_.front()) < place(like); };
    const auto known = [&] {
      while (behind()) seen_.pop_front();
      moved_.notify_all();
      return !seen_.empty() || ended_;
    };
    moved_.wait(lock, known);
    if (failed_) std::rethrow_exception(failed_);
    if (seen_.empty() || place(seen_.front()) != place(like)) return {};
    std::optional<Seen> taken(std::move(seen_.front()));
    seen_.pop_front();
    moved_.notify_all();
    return taken;
  }

  /// Whoever puts more need not wait: nobody takes them.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    moved_.notify_all();
  }

 private:
  static std::pair<std::size_t, std::size_t> place(const Seen& seen) { return {seen.step, seen.turn}; }

  const std::size_t most_;
  std::mutex mutex_;
  std::condition_variable moved_;
  std::deque<Seen> seen_;
  bool ended_ = false, closed_ = false;
  std::exception_ptr failed_;
};

constexpr std::size_t kMostAhead = 256;

/// What kept a side from being asked.
std::string trouble_text(const Scenario& scenario, const ScenarioResult& result, const std::string& name) {
  std::size_t count = 0;
  std::string text;
  for (const Finding& finding : result.findings) {
    if (!finding.of_run || ++count > 1) continue;
    const std::uint32_t line = position_of(scenario, finding).line;
    text = fmt::format("{}{} could not be asked{}: {}\n", kIndented, name,
                       line ? fmt::format(", {}:{}", stl::printable(scenario.source->name), line) : "",
                       stl::printable(finding_line(scenario, finding)));
  }
  if (count > 1) text += fmt::format("{}and {} more\n", kIndented, count - 1);
  return text;
}

}  // namespace

Compared compare(const Scenario& scenario, const Side& one, const Side& other, const Comparison& comparison) {
  Compared compared{.scenario = &scenario};
  FirstDifference first(scenario, one, other, comparison);
  ExchangeQueue queue(comparison.one_after_other ? std::numeric_limits<std::size_t>::max() : kMostAhead);
  auto running = std::async(std::launch::async, [&] {
    try {
      ScenarioResult result = other.run([&](const Seen& seen) { queue.put(seen); });
      queue.end();
      return result;
    } catch (...) {
      queue.end(std::current_exception());
      throw;
    }
  });
  struct Closing {
    ExchangeQueue& queue;
    ~Closing() { queue.close(); }
  };
  ScenarioResult of_one;
  {
    const Closing closing{queue};
    if (comparison.one_after_other) running.wait();
    of_one = one.run([&](const Seen& seen) {
      ++compared.exchanges;
      if (const auto pair = queue.take(seen)) first.add(seen, *pair);
    });
  }
  const ScenarioResult of_other = running.get();
  for (const ScenarioResult* each : {&std::as_const(of_one), &of_other})
    if (each->outcome == ScenarioResult::Outcome::Skipped) compared.skipped = each->reason;
  if (!compared.skipped.empty()) return compared;
  compared.difference.text =
      first.text() + trouble_text(scenario, of_one, one.name) + trouble_text(scenario, of_other, other.name);
  compared.difference.found = !compared.difference.text.empty();
  return compared;
}

}  // namespace s7200::tools
