// Value Change Dumps: levels of logic analysers, simulators and our own --capture FILE.vcd. Source: IEEE 1364, clause 18.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"
#include "tools/recordings/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/levels.hpp"

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

  std::optional<Levels> read(std::string& why) {
    while (true) {
      const std::string_view word = take_word(rest_);
      if (word.empty()) return levels_.end = now_, std::move(levels_);
      if (!take(word, why)) return {};
    }
  }

 private:
  bool take(std::string_view word, std::string& why) {
    switch (word.front()) {
      case '$':
        return take_section_of(word, why);
      case '#':
        return take_time(word.substr(1), why);
      case 'b':
      case 'B':
        set(take_word(rest_), word.back(), word.size() == 2);
        return true;
      case 'r':
      case 'R':
        take_word(rest_);
        return true;
      default:
        set(word.substr(1), word.front(), true);
        return true;
    }
  }

  bool take_section_of(std::string_view name, std::string& why) {
    if (name == "$timescale") {
      const auto scale = scale_of(take_section(rest_));
      if (!scale) return why = "its $timescale is not one", false;
      scale_ = *scale;
    } else if (name == "$var") {
      add_variable(take_section(rest_));
    } else if (name.starts_with("$dump") || name == "$end") {
      // The values in such a section are like all others.
    } else {
      take_section(rest_);
    }
    return true;
  }

  /// Adds a variable: `wire 1 ! rx`
  void add_variable(const std::vector<std::string_view>& words) {
    constexpr std::size_t kWidth = 1, kCode = 2, kName = 3;
    if (words.size() <= kName) return;
    if (words[kWidth] != "1") {
      levels_.notes.push_back(fmt::format("channel {} was left out: it has {} bits", stl::shortened(words[kName]),
                                          stl::shortened(words[kWidth])));
      return;
    }
    const auto [code, is_new] = channels_.try_emplace(std::string(words[kCode]), levels_.channels.size());
    if (is_new) levels_.channels.push_back({.name = std::string(words[kName])});
  }

  bool take_time(std::string_view digits, std::string& why) {
    __extension__ using Wide = __int128;
    const auto ticks = parse_decimal<std::int64_t>(digits);
    const Wide time = ticks ? Wide{*ticks} * scale_.times / scale_.per : -1;
    if (time < now_ || time >= kFurthestTime) {
      why = fmt::format("#{} is not a time after the one before it", stl::shortened(digits));
      return false;
    }
    now_ = static_cast<Time>(time);
    return true;
  }

  void set(std::string_view code, char level, bool is_one_bit) {
    const auto found = channels_.find(code);
    if (found == channels_.end() || !is_one_bit) return;
    Channel& channel = levels_.channels[found->second];
    if (level == '0' || level == '1')
      channel.set(now_, level == '1');
    else if (now_ > 0 && undefined_.insert(found->second).second)
      levels_.notes.push_back(fmt::format("channel {} has undefined levels at {}: there it keeps the level before",
                                          stl::shortened(channel.name), format_duration(now_)));
  }

  std::string_view rest_;
  Levels levels_;
  std::map<std::string, std::size_t, std::less<>> channels_;  // by their codes
  std::set<std::size_t> undefined_;                           // channels of which that was said
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

std::optional<LineRecording> read_vcd(std::string_view bytes, const ReadingChoices& choices, std::string& why) {
  auto levels = VcdReader(bytes).read(why);
  return levels ? frames_of(std::move(*levels), choices, why) : std::nullopt;
}

}  // namespace s7200::tools
