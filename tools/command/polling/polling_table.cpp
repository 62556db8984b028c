#include "tools/command/polling/polling_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/host/console.hpp"
#include "tools/host/host_time.hpp"

namespace s7200::tools {
namespace {

constexpr Time kRedraw = 50 * kMillisecond;

}  // namespace

PollingTable::PollingTable(std::string title, bool in_place, bool colour)
    : title_(std::move(title)), in_place_(in_place), colour_(colour) {}

std::string PollingTable::marked(const std::string& line, bool changed) const {
  if (!changed) return "  " + line;
  return colour_ ? fmt::format("* \x1b[1m{}\x1b[0m", line) : "* " + line;
}

void PollingTable::add(const MasterResult& result, Time at) {
  if (in_place_) {
    now_.push_back({heading(result), lines(result)});
  } else {
    now_.push_back({{}, {short_text(result)}});
    const std::vector<std::string>& shown = now_[place_].lines;
    const bool changed = place_ < before_.size() && before_[place_].lines != shown;
    const auto latency = result.exchange.latency();
    fmt::print("{:12.6f} s  {:>12}  {}\n", static_cast<double>(at) / kSecond, latency ? format_duration(*latency) : "-",
               marked(fmt::format("{}: {}", result.action->text, shown[0]), changed));
  }
  ++place_;
}

void PollingTable::end_round(const std::string& footer) {
  if (in_place_) {
    to_draw_ = table(footer);
    if (host_time() - drawn_at_ >= kRedraw) draw();
  } else {
    std::fflush(stdout);
  }
  before_ = std::exchange(now_, {});
  place_ = 0;
}

void PollingTable::finish() {
  if (!to_draw_.empty()) draw();
}

std::string PollingTable::table(const std::string& footer) const {
  std::string text = title_ + "\n";
  for (std::size_t place = 0; place < now_.size(); ++place) {
    text += now_[place].heading + "\n";
    for (std::size_t line = 0; line < now_[place].lines.size(); ++line) {
      const bool known = place < before_.size() && line < before_[place].lines.size();
      text += marked(now_[place].lines[line], known && before_[place].lines[line] != now_[place].lines[line]) + "\n";
    }
  }
  return text + footer;
}

void PollingTable::draw() {
  const auto height = static_cast<std::size_t>(std::ranges::count(to_draw_, '\n'));
  const std::size_t rows = terminal_size().rows;
  const bool fits = drawn_ < rows && height < rows;  // else the lines above cannot be reached any more
  // ECMA-48: cursor up, erase to the end of the screen; lines that are too long are cut instead of wrapped.
  if (fits && drawn_ > 0) fmt::print("\x1b[{}A", drawn_);
  fmt::print("\x1b[?7l\r\x1b[J{}\x1b[?7h", std::exchange(to_draw_, {}));
  std::fflush(stdout);
  drawn_ = height;
  drawn_at_ = host_time();
}

}  // namespace s7200::tools
