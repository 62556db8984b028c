// What sigrok-cli prints by itself, and with -O bits: the levels of each channel, a digit a sample, a group of rows after
// the other.
//
//   libsigrok 0.5.2
//   Acquisition with 2/8 channels at 1 MHz
//   D0:11111111 11110000 …
//   D1:00000000 …
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/levels/levels.hpp"
#include "tools/recordings/levels/samplerate.hpp"
#include "tools/recordings/rows/lines.hpp"

namespace s7200::tools {
namespace {

constexpr std::string_view kAcquisition = "Acquisition with ", kAtRate = " channels at ";

/// The line about the acquisition; empty if there is none near the beginning.
std::string_view head_line(std::string_view text) {
  constexpr std::size_t kMostLines = 5;
  std::size_t number = 0;
  for (const std::string_view line : Lines(text)) {
    if (line.starts_with(kAcquisition)) return line;
    if (++number == kMostLines) break;
  }
  return {};
}

std::optional<std::uint64_t> samplerate_in(std::string_view head) {
  const std::size_t at = head.find(kAtRate);
  return at == std::string_view::npos ? std::nullopt : samplerate_of(head.substr(at + kAtRate.size()));
}

/// A row of a channel: `D0:11110000 1`
struct BitsRow {
  std::string_view channel{}, bits{};
};
std::optional<BitsRow> bits_row(std::string_view line) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos || colon == 0) return {};
  const BitsRow row{line.substr(0, colon), stl::trim(line.substr(colon + 1))};
  const bool are_bits = !row.bits.empty() && row.bits.find_first_not_of("01 ") == std::string_view::npos;
  return are_bits ? std::optional(row) : std::nullopt;
}

}  // namespace

bool looks_like_sigrok_bits(std::string_view bytes) {
  const std::string_view head = is_text(bytes) ? head_line(bytes) : "";
  return !head.empty() && head.find(kAtRate) != std::string_view::npos;
}

Result<LineRecording> read_sigrok_bits(std::string_view bytes, const ReadingChoices& choices) {
  const auto samplerate = choices.samplerate != 0 ? std::optional(choices.samplerate) : samplerate_in(head_line(bytes));
  if (!samplerate) return Trouble{"its rate is not understood: name it with --samplerate, as 1MHz"};
  struct Samples {
    std::size_t channel = 0;
    std::uint64_t count = 0;
  };
  std::map<std::string, Samples, std::less<>> channels;
  Levels levels;
  bool after_head = false;
  for (const std::string_view line : Lines(bytes, choices.stop)) {
    const bool was_after_head = std::exchange(after_head, after_head || line.starts_with(kAcquisition));
    if (!was_after_head || stl::trim(line).empty()) continue;
    const auto row = bits_row(line);
    if (!row)
      return trouble("'{}' is not a row of bits; print them with sigrok-cli -O bits, -O vcd or -O csv",
                     stl::shortened(stl::trim(line)));
    auto& [channel, count] = channels.try_emplace(std::string(row->channel), Samples{levels.channels.size()}).first->second;
    if (channel == levels.channels.size()) levels.channels.push_back({.name = std::string(row->channel)});
    for (const char bit : row->bits) {
      if (bit == ' ') continue;
      const Time at = std::llround(static_cast<long double>(count++) * kSecond / static_cast<long double>(*samplerate));
      levels.channels[channel].set(at, bit == '1');
      levels.end = std::max(levels.end, at);
    }
  }
  return frames_of(std::move(levels), choices);
}

}  // namespace s7200::tools
