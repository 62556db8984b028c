// Tables of levels: what sigrok-cli -O csv, PulseView, DSView and Saleae Logic write of their channels. Each row has the
// levels, 0 or 1, after a time or of a sample.
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/levels/levels.hpp"
#include "tools/recordings/levels/samplerate.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/rows/table_rows.hpp"

namespace s7200::tools {
namespace {

/// sigrok-cli writes `META samplerate: 1000000` where it converts a file.
bool is_comment(std::string_view line) {
  return line.starts_with(';') || line.starts_with('#') || line.starts_with("META ");
}

char separator_of_levels(std::string_view line) {
  const std::size_t at = line.find_first_of(",;\t");
  return at == std::string_view::npos ? ',' : line[at];
}

/// The information in comments and in the names of columns.
struct Head {
  std::vector<std::string> names{};  ///< of the columns
  bool has_time = false;             ///< the first column is one
  Time unit = kSecond;
  char separator = ',';
  std::uint64_t samplerate = 0;
  std::size_t lines = 0;  ///< before the first row

  std::size_t first_channel() const { return has_time ? 1 : 0; }
};

bool is_level(std::string_view cell) { return cell == "0" || cell == "1"; }

/// The text after `name`, in any case, and a colon; `; Samplerate: 1 MHz`.
std::optional<std::string_view> said_in(std::string_view comment, std::string_view name) {
  const std::size_t at = stl::lower_case(comment).find(name);
  const std::size_t colon = at == std::string_view::npos ? at : comment.find(':', at);
  return colon == std::string_view::npos ? std::nullopt : std::optional(stl::trim(comment.substr(colon + 1)));
}

/// Takes the sample rate and the channels' names from a comment.
void take_comment(std::string_view comment, Head& head) {
  for (const std::string_view name : {"samplerate", "sample rate"})
    if (const auto said = said_in(comment, name)) head.samplerate = samplerate_of(*said).value_or(head.samplerate);
  if (const auto said = said_in(comment, "channels (")) {
    head.names.clear();
    for (const std::string& name : fields_of(*said, ',')) head.names.emplace_back(stl::trim(name));
  }
}

/// Takes the names of the columns: `Time [s],Channel 0`. The channels of sigrok are all called `logic` there, and have their
/// names in a comment.
bool take_names(std::string_view line, Head& head) {
  head.separator = separator_of_levels(line);
  auto names = fields_of(line, head.separator);
  for (std::string& name : names) name = stl::trim(name);
  if (std::ranges::all_of(names, is_level)) return false;
  const auto unit = unit_of(names.front());
  head.has_time = unit.has_value() || is_name_of_time(names.front());
  head.unit = unit.value_or(kSecond);
  const std::size_t channels = names.size() - head.first_channel();
  if (head.names.size() == channels && channels > 0 && names.back() == "logic")
    head.names.insert(head.names.begin(), head.first_channel(), names.front());
  else
    head.names = std::move(names);
  return true;
}

std::optional<Head> head_of(std::string_view bytes) {
  Head head;
  for (const std::string_view line : Lines(bytes)) {
    if (!is_comment(line) && !stl::trim(line).empty()) {
      if (take_names(line, head)) ++head.lines;
      return head;
    }
    take_comment(line, head);
    ++head.lines;
  }
  return {};
}

/// A row whose cells after the time are levels, or X where Logic has none.
bool is_row(const std::vector<std::string>& fields, const Head& head) {
  if (fields.size() != head.names.size() || fields.size() <= head.first_channel()) return false;
  return std::all_of(fields.begin() + static_cast<std::ptrdiff_t>(head.first_channel()), fields.end(),
                     [](std::string_view field) { return is_level(stl::trim(field)) || stl::trim(field) == "X"; });
}

class LevelsTableReader {
 public:
  LevelsTableReader(Head head, std::uint64_t samplerate) : head_(std::move(head)), samplerate_(samplerate) {
    for (std::size_t i = head_.first_channel(); i < head_.names.size(); ++i)
      levels_.channels.push_back({.name = head_.names[i]});
  }

  /// Takes a row. Trouble if it is not a row of the table.
  Result<> take(std::string_view line) {
    const auto fields = fields_of(line, head_.separator);
    const auto at = time_of(fields.front());
    if (!is_row(fields, head_) || !at)
      return trouble("'{}' is not {}", stl::shortened(stl::trim(line)),
                     at ? "a row of levels" : "at a time after the row above it");
    now_ = *at;
    ++sample_;
    for (std::size_t i = 0; i < levels_.channels.size(); ++i) {
      const std::string_view level = stl::trim(fields[head_.first_channel() + i]);
      if (is_level(level)) levels_.channels[i].set(now_, level == "1");
    }
    return {};
  }

  Levels finish() {
    levels_.end = now_;
    return std::move(levels_);
  }

 private:
  /// A comma is that of a decimal only where none divides the columns.
  std::optional<long double> figure_in(std::string_view cell) const {
    std::string figure(stl::trim(cell));
    if (head_.separator != ',') std::ranges::replace(figure, ',', '.');
    return parse_decimal<long double>(figure);
  }

  std::optional<Time> time_of(std::string_view cell) {
    const auto figure = head_.has_time ? figure_in(cell) : std::nullopt;
    const auto clock = head_.has_time && !figure ? time_in_cell(stl::trim(cell)) : std::nullopt;
    if (head_.has_time && !figure && !clock) return {};
    long double time = figure  ? *figure * static_cast<long double>(head_.unit)
                       : clock ? static_cast<long double>(days_.since_first_midnight(*clock))
                               : static_cast<long double>(sample_) / static_cast<long double>(samplerate_) * kSecond;
    if (!begin_) begin_ = time;  // a trigger may make it negative
    time -= *begin_;
    if (!(time >= static_cast<long double>(now_) && time < static_cast<long double>(kFurthestTime))) return {};
    return static_cast<Time>(time);
  }

  Head head_;
  std::uint64_t samplerate_, sample_ = 0;
  DayCounter days_;
  std::optional<long double> begin_;
  Time now_ = 0;
  Levels levels_;
};

}  // namespace

bool looks_like_levels_table(std::string_view bytes) {
  constexpr std::size_t kRows = 3;
  const std::string_view beginning = beginning_of(bytes);
  const auto head = head_of(beginning);
  if (!head || !is_text(bytes) || (!head->has_time && head->samplerate == 0 && head->names.empty())) return false;
  std::size_t line = 0, rows = 0;
  for (const std::string_view text : Lines(beginning)) {
    if (line++ < head->lines) continue;
    if (!is_row(fields_of(text, head->separator), *head)) return false;
    if (++rows == kRows) return true;
  }
  return false;
}

Result<LineRecording> read_levels_table(std::string_view bytes, const ReadingChoices& choices) {
  const Head head = *head_of(bytes);
  const std::uint64_t samplerate = choices.samplerate != 0 ? choices.samplerate : head.samplerate;
  if (!head.has_time && samplerate == 0)
    return Trouble{"it has neither times nor a samplerate: name that with --samplerate, as 1MHz"};
  LevelsTableReader reader(head, samplerate);
  std::size_t line = 0;
  for (const std::string_view text : Lines(bytes, choices.stop)) {
    if (line++ < head.lines || stl::trim(text).empty()) continue;
    if (const auto done = reader.take(text); !done) return trouble("line {}: {}", line, done.why());
  }
  return frames_of(reader.finish(), choices);
}

}  // namespace s7200::tools
