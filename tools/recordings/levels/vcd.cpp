// Value Change Dumps: levels of logic analysers, simulators and our own --capture FILE.vcd. Source: IEEE 1364, clause 18.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/levels/levels.hpp"

namespace s7200::tools {
namespace {

/// The next word, without blanks and line ends; empty at the end.
std::string_view take_word(std::string_view& text) {
  constexpr std::string_view kBlanks = " \t\r\n\f\v";
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  const std::string_view word = text.substr(0, std::min(text.find_first_of(kBlanks), text.size()));
  text.remove_prefix(word.size());
  return word;
}

/// The words of a section up to its `$end`.
std::vector<std::string_view> take_section(std::string_view& text) {
  std::vector<std::string_view> words;
  while (true) {
    const std::string_view word = take_word(text);
    if (word.empty() || word == "$end") return words;
    words.push_back(word);
  }
}

/// A unit of time as a fraction of nanoseconds.
struct Scale {
  std::int64_t times = 1, per = 1;
};
struct VcdUnit {
  std::string_view word;
  Scale scale;
};
constexpr std::array kVcdUnits{VcdUnit{"s", {kSecond, 1}},       VcdUnit{"ms", {kMillisecond, 1}},
                               VcdUnit{"us", {kMicrosecond, 1}}, VcdUnit{"ns", {1, 1}},
                               VcdUnit{"ps", {1, 1000}},         VcdUnit{"fs", {1, 1'000'000}}};

/// A time scale: `1 ns`, `10us`.
std::optional<Scale> scale_of(const std::vector<std::string_view>& words) {
  std::string text;
  for (const std::string_view word : words) text += word;
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  const auto figure = parse_decimal<std::int64_t>(std::string_view(text).substr(0, digits));
  const auto unit = std::ranges::find(kVcdUnits, std::string_view(text).substr(digits), &VcdUnit::word);
  if (!figure || *figure < 1 || *figure > 1000 || unit == kVcdUnits.end()) return {};
  return Scale{*figure * unit->scale.times, unit->scale.per};
}

class VcdReader {
 public:
  explicit VcdReader(std::string_view text) : rest_(text) {}

  Result<Levels> read() {
    while (true) {
      const std::string_view word = take_word(rest_);
      if (word.empty()) return finish();
      if (const auto done = take(word); !done) return done.trouble();
    }
  }

 private:
  Result<> take(std::string_view word) {
    switch (word.front()) {
      case '$':
        return take_section_of(word);
      case '#':
        return take_time(word.substr(1));
      case 'b':
      case 'B':
        set_bits(take_word(rest_), word.substr(1));
        return {};
      case 'r':
      case 'R':
        take_word(rest_);
        return {};
      default:
        set_bits(word.substr(1), word.substr(0, 1));
        return {};
    }
  }

  Result<> take_section_of(std::string_view name) {
    if (name == "$timescale") {
      const auto scale = scale_of(take_section(rest_));
      if (!scale) return Trouble{"its $timescale is not one"};
      scale_ = *scale;
    } else if (name == "$var") {
      add_variable(take_section(rest_));
    } else if (name.starts_with("$dump") || name == "$end") {
      // The values in such a section are like all others.
    } else {
      take_section(rest_);
    }
    return {};
  }

  /// Adds a variable: `wire 1 ! rx`, `wire 2 ! bus [1:0]` with a channel for each bit, the highest first.
  void add_variable(const std::vector<std::string_view>& words) {
    constexpr std::size_t kKind = 0, kWidth = 1, kCode = 2, kName = 3;
    constexpr std::size_t kWidest = 16;
    if (words.size() <= kName) return;
    const auto width = parse_decimal<std::size_t>(words[kWidth]);
    if (!width || *width == 0 || *width > kWidest || words[kKind] == "real") {
      note_left_out(words[kName], words[kWidth]);
      return;
    }
    const auto [code, is_new] = variables_.try_emplace(std::string(words[kCode]));
    if (!is_new) return;
    code->second = {.name = std::string(words[kName]), .first = levels_.channels.size(), .width = *width};
    for (std::size_t bit = *width; bit-- > 0;) {
      levels_.channels.push_back({.name = *width == 1 ? code->second.name : fmt::format("{}[{}]", code->second.name, bit)});
      is_line_.push_back(*width == 1);
    }
  }

  void note_left_out(std::string_view name, std::string_view width) {
    levels_.notes.push_back(
        fmt::format("channel {} was left out: it has {} bits", stl::shortened(name), stl::shortened(width)));
  }

  /// Where a variable of one bit changes, those of several are numbers, not lines.
  Levels finish() {
    levels_.end = now_;
    std::vector<Channel> lines;
    for (std::size_t i = 0; i < levels_.channels.size(); ++i)
      if (is_line_[i] && !levels_.channels[i].edges.empty()) lines.push_back(levels_.channels[i]);
    if (lines.empty()) return std::move(levels_);
    const auto said = static_cast<std::ptrdiff_t>(levels_.notes.size());
    for (const auto& [code, variable] : variables_)
      if (variable.width > 1) note_left_out(variable.name, std::to_string(variable.width));
    std::rotate(levels_.notes.begin(), levels_.notes.begin() + said, levels_.notes.end());
    levels_.channels = std::move(lines);
    return std::move(levels_);
  }

  Result<> take_time(std::string_view digits) {
    __extension__ using Wide = __int128;
    const auto ticks = parse_decimal<std::int64_t>(digits);
    const Wide time = ticks ? Wide{*ticks} * scale_.times / scale_.per : -1;
    if (time < now_ || time >= kFurthestTime)
      return trouble("#{} is not a time after the one before it", stl::shortened(digits));
    now_ = static_cast<Time>(time);
    return {};
  }

  /// Sets the bits of a variable; before the first that are written stand more like it, or 0 before a 1.
  void set_bits(std::string_view code, std::string_view bits) {
    const auto found = variables_.find(code);
    if (found == variables_.end() || bits.empty() || bits.size() > found->second.width) return;
    const std::size_t unwritten = found->second.width - bits.size();
    for (std::size_t i = 0; i < found->second.width; ++i)
      set(found->second.first + i, i >= unwritten ? bits[i - unwritten] : bits.front() == '1' ? '0' : bits.front());
  }

  void set(std::size_t place, char level) {
    Channel& channel = levels_.channels[place];
    if (level == '0' || level == '1')
      channel.set(now_, level == '1');
    else if (now_ > 0 && undefined_.insert(place).second)
      levels_.notes.push_back(fmt::format("channel {} has undefined levels at {}: there it keeps the level before",
                                          stl::shortened(channel.name), format_duration(now_)));
  }

  struct Variable {
    std::string name{};
    std::size_t first = 0, width = 0;  ///< its channels
  };

  std::string_view rest_;
  Levels levels_;
  std::map<std::string, Variable, std::less<>> variables_;  // by their codes
  std::vector<bool> is_line_;                               // a channel is a variable of one bit
  std::set<std::size_t> undefined_;                         // channels of which that was said
  Scale scale_;
  Time now_ = 0;
};

}  // namespace

/// sigrok-cli puts a line `META samplerate: 1000000` before it where it converts a file.
bool looks_like_vcd(std::string_view bytes) {
  std::string_view rest = bytes;
  if (rest.starts_with("META ")) stl::take_line(rest);
  return rest.starts_with('$') && rest.find("$enddefinitions") != std::string_view::npos && is_text(bytes);
}

Result<LineRecording> read_vcd(std::string_view bytes, const ReadingChoices& choices) {
  auto levels = VcdReader(bytes).read();
  if (!levels) return levels.trouble();
  return frames_of(*std::move(levels), choices);
}

}  // namespace s7200::tools
