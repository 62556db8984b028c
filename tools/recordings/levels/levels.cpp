#include "tools/recordings/levels/levels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

#include "interpreter/base/event_queue.hpp"
#include "interpreter/base/text/text.hpp"
#include "serial_sim/line/line.hpp"
#include "serial_sim/line/uart.hpp"
#include "tools/recordings/fields/fields.hpp"

namespace s7200::tools {
namespace {

using Characters = std::vector<ReceivedCharacter>;

/// Rates that lines have, of PLCs, PROFIBUS-like adapters and other devices.
constexpr std::array<std::uint32_t, 26> kRates{
    300,    600,    1'200,  2'400,   4'800,   9'600,   14'400,  19'200,  28'800,  31'250,  38'400,  45'450,    56'000,
    57'600, 76'800, 93'750, 115'200, 125'000, 187'500, 230'400, 250'000, 460'800, 500'000, 921'600, 1'000'000, 1'500'000};

/// A channel as a line: an edge at each change between mark, the idle level, and space.
struct Wire {
  std::string name{};
  bool inverted = false;  ///< it idles at 0
  bool begins_at_space = false;
  std::vector<Time> edges{};
};

/// A line is idle longer than it is anything else at a time.
Wire wire_of(const Channel& channel, Time end) {
  bool level = channel.first.value_or(true), idle = level;
  Time since = channel.since, longest = -1;
  for (std::size_t i = 0; i <= channel.edges.size(); ++i, level = !level) {
    const Time until = i < channel.edges.size() ? channel.edges[i] : end;
    if (until - since > longest) longest = until - since, idle = level;
    since = until;
  }
  return {.name = stl::printable(stl::shortened(channel.name)),
          .inverted = !idle,
          .begins_at_space = channel.first != idle,
          .edges = channel.edges};
}

/// Whether the wire is a clock: its level changes at equal distances all the time.
bool is_clock(const Wire& wire) {
  constexpr std::size_t kFewestEdges = 32;
  if (wire.edges.size() < kFewestEdges) return false;
  Time shortest = kNever, longest = 0;
  for (std::size_t i = 1; i < wire.edges.size(); ++i) {
    shortest = std::min(shortest, wire.edges[i] - wire.edges[i - 1]);
    longest = std::max(longest, wire.edges[i] - wire.edges[i - 1]);
  }
  return longest < 2 * shortest;
}

bool is_damaged(const ReceivedCharacter& character) { return character.parity_error || character.framing_error; }

std::size_t damaged(const Characters& characters) {
  return static_cast<std::size_t>(std::ranges::count_if(characters, is_damaged));
}

/// The characters that the receiver finds in the first `most` edges.
Characters characters_on(const Wire& wire, const SerialFormat& format, std::size_t most) {
  serial::Line line;
  EventQueue queue;
  serial::Uart uart(line, queue, EventOwner{}, 0);
  uart.configure(format, 0);
  Characters characters;
  const auto receive_until = [&](Time until) {
    while (queue.next() < until)
      if (const auto received = uart.handle(queue.pop()).received) characters.push_back(*received);
  };
  bool mark = !wire.begins_at_space;
  if (!mark) line.drive(0, 0, false);
  for (std::size_t i = 0; i < std::min(most, wire.edges.size()); ++i) {
    receive_until(wire.edges[i]);
    line.drive(0, wire.edges[i], mark = !mark);
  }
  receive_until(kNever);
  return characters;
}

constexpr std::size_t kMeasuredEdges = 20'000;  // enough to know the format by

/// How well the distances between edges fit whole bits.
struct Fit {
  std::uint32_t baud = 0;
  double off = 1;  ///< bits, on average
};
std::optional<Fit> fit_of(const Wire& wire, std::uint32_t baud) {
  constexpr double kLongest = SerialFormat::kMostBits + 0.3, kMostOff = 0.3, kMostOffOnAverage = 0.1, kFewestRight = 0.95;
  std::size_t measured = 0, right = 0;
  double off = 0;
  for (std::size_t i = 1; i < std::min(kMeasuredEdges, wire.edges.size()); ++i) {
    const double bits = static_cast<double>(wire.edges[i] - wire.edges[i - 1]) * baud / static_cast<double>(kSecond);
    if (bits > kLongest) continue;  // the line was idle
    ++measured;
    const double each = std::abs(bits - std::max(1.0, std::round(bits)));
    right += each <= kMostOff;
    off += each;
  }
  const auto all = static_cast<double>(measured);
  if (measured == 0 || static_cast<double>(right) < kFewestRight * all || off > kMostOffOnAverage * all) return {};
  return Fit{.baud = baud, .off = off / all};
}

/// The lowest rate that fits, or one close to it that fits better: twice a rate fits, too.
std::optional<std::uint32_t> rate_of(const Wire& wire) {
  constexpr double kClose = 1.15;
  std::optional<Fit> best;
  std::uint32_t lowest = 0;
  for (const std::uint32_t baud : kRates) {
    const auto fit = fit_of(wire, baud);
    if (!fit) continue;
    if (lowest == 0) lowest = baud;
    if (baud < kClose * lowest && (!best || fit->off < best->off)) best = fit;
  }
  return best ? std::optional(best->baud) : std::nullopt;
}

/// Formats to try, the likelier first: the protocol's, then those that show more errors if they are wrong.
std::vector<SerialFormat> formats_at(std::uint32_t baud, const ReadingChoices& choices) {
  constexpr std::array kFormats{
      SerialFormat{.data_bits = 8, .parity = Parity::Even}, SerialFormat{.data_bits = 8, .parity = Parity::Odd},
      SerialFormat{.data_bits = 7, .parity = Parity::Even}, SerialFormat{.data_bits = 7, .parity = Parity::Odd},
      SerialFormat{.data_bits = 8, .parity = Parity::None}};
  std::vector<SerialFormat> formats;
  const auto add = [&](SerialFormat format) {
    format = choices.line.over(format);
    format.baud = baud;
    if (std::ranges::find(formats, format) == formats.end()) formats.push_back(format);
  };
  add(choices.usual);
  for (const SerialFormat& format : kFormats) add(format);
  return formats;
}

/// The first with the fewest damaged characters. Few characters with 8 bits may look like some with 7 bits and parity.
SerialFormat format_of(const Wire& wire, std::uint32_t baud, const ReadingChoices& choices) {
  constexpr std::size_t kEnoughForParity = 16;
  const auto formats = formats_at(baud, choices);
  SerialFormat best = formats.front();
  std::size_t fewest = characters_on(wire, best, kMeasuredEdges).size() + 1;
  for (const SerialFormat& format : formats) {
    const Characters characters = characters_on(wire, format, kMeasuredEdges);
    const bool in_doubt = format.data_bits < choices.usual.data_bits && characters.size() < kEnoughForParity;
    if (damaged(characters) < fewest && !in_doubt) best = format, fewest = damaged(characters);
  }
  return best;
}

struct ReadWire {
  Wire wire{};
  Characters characters{};
  bool repeats = false;  ///< others have all of its characters
};

/// A character that another wire has at the same time.
bool is_on(const ReadWire& other, const ReceivedCharacter& character, Time within) {
  const auto first = std::ranges::lower_bound(other.characters, character.start - within, {}, &ReceivedCharacter::start);
  return first != other.characters.end() && first->start <= character.start + within && first->byte == character.byte;
}

/// The wires with the most characters first, of equal ones the last: `line` beside `rx` and `tx`, B beside A.
void find_repetitions(std::vector<ReadWire>& wires, Time within) {
  std::vector<std::size_t> order(wires.size());
  std::iota(order.rbegin(), order.rend(), 0U);
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return wires[i].characters.size(); });
  for (const std::size_t i : order)
    wires[i].repeats = std::ranges::all_of(wires[i].characters, [&](const ReceivedCharacter& character) {
      return std::ranges::any_of(wires, [&](const ReadWire& other) {
        return &other != &wires[i] && !other.repeats && is_on(other, character, within);
      });
    });
}

std::string names_of(const std::vector<ReadWire>& wires) {
  std::vector<std::string> names;
  for (const ReadWire& each : wires) names.push_back(each.wire.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The directions by the names of two wires, else the wire that speaks first asks; settle_directions() corrects what is
/// wrong.
std::vector<Direction> directions_of(const std::vector<ReadWire>& wires) {
  if (wires.size() != 2) return std::vector<Direction>(wires.size(), Direction::Unknown);
  const Direction first = direction_of(wires[0].wire.name), second = direction_of(wires[1].wire.name);
  if (first != second && first != Direction::Unknown && second != Direction::Unknown) return {first, second};
  if (wires[0].characters.front().start <= wires[1].characters.front().start) return {Direction::Request, Direction::Answer};
  return {Direction::Answer, Direction::Request};
}

/// Times count from `origin`; the place is the time in the file.
LineRecording frames_on(const ReadWire& wire, Direction direction, Time origin, const ReadingChoices& choices,
                        const SerialFormat& format) {
  LineRecording recording;
  for (const ReceivedCharacter& character : wire.characters) {
    RecordedFrame row{.at = character.start - origin,
                      .direction = direction,
                      .bytes = {character.byte},
                      .place = fmt::format("{} at {}", wire.wire.name, format_duration(character.start))};
    if (is_damaged(character)) row.damaged = {0};
    recording.frames.push_back(std::move(row));
  }
  ReadingChoices joining = choices;
  if (joining.gap == 0) joining.gap = std::max(kCharacterGap, format.silence() + format.character_time());
  join_characters(recording, joining);
  return recording;
}

/// The rate and the format that fit the wire; nothing if no rate does.
std::optional<SerialFormat> fitting_format(const Wire& wire, const ReadingChoices& choices) {
  const auto baud = choices.line.baud ? choices.line.baud : rate_of(wire);
  return baud ? std::optional(format_of(wire, *baud, choices)) : std::nullopt;
}

/// The format of the wire with the most right characters.
std::optional<SerialFormat> format_of_line(const std::vector<Wire>& wires, const ReadingChoices& choices) {
  std::optional<SerialFormat> best;
  std::size_t most = 0;
  for (const Wire& wire : wires) {
    const auto format = is_clock(wire) ? std::nullopt : fitting_format(wire, choices);
    if (!format) continue;
    const Characters characters = characters_on(wire, *format, kMeasuredEdges);
    const std::size_t right = characters.size() - damaged(characters);
    if (right > most) best = format, most = right;
  }
  return best;
}

/// How well the user's rate fits the levels, as the end of a sentence.
std::string how_it_fits(const Wire& wire, const SerialFormat& format, const ReadingChoices& choices) {
  if (!choices.line.baud || fit_of(wire, format.baud)) return ", which fit";
  const auto other = rate_of(wire);
  return other ? fmt::format("; {} baud fit better", *other) : "";
}

}  // namespace

Result<LineRecording> frames_of(Levels levels, const ReadingChoices& choices) {
  std::vector<Wire> wires;
  for (const Channel& channel : levels.channels)
    if (!channel.edges.empty()) wires.push_back(wire_of(channel, levels.end));
  if (wires.empty()) return Trouble{"no channel of it changes its level"};
  const auto format = format_of_line(wires, choices);
  if (!format)
    return Trouble{choices.line.baud ? fmt::format("no channel of it has characters at {} baud", *choices.line.baud)
                                     : "the levels fit no rate that lines have; name it with --baud"};
  LineRecording recording{.notes = std::move(levels.notes)};
  std::vector<ReadWire> read;
  for (Wire& wire : wires) {
    Characters characters = characters_on(wire, *format, wire.edges.size());
    const bool speaks = 2 * damaged(characters) <= characters.size() && !characters.empty() && !is_clock(wire);
    if (speaks)
      read.push_back({.wire = std::move(wire), .characters = std::move(characters)});
    else
      recording.notes.push_back(fmt::format("channel {} was left out: it has no characters of that line", wire.name));
  }
  if (read.empty()) return trouble("no channel of it has characters with {}", format_text(*format));
  find_repetitions(read, format->bit_times(1));
  for (const ReadWire& each : read)
    if (each.repeats)
      recording.notes.push_back(fmt::format("channel {} was left out: other channels have its characters", each.wire.name));
  std::erase_if(read, &ReadWire::repeats);
  for (const ReadWire& each : read)
    if (each.wire.inverted)
      recording.notes.push_back(fmt::format("channel {} idles at 0: it was read inverted", each.wire.name));
  recording.notes.push_back(fmt::format("the levels of {} were read with {}{}", names_of(read), format_text(*format),
                                        how_it_fits(read.front().wire, *format, choices)));
  const std::vector<Direction> directions = directions_of(read);
  Time origin = kNever;
  for (const ReadWire& each : read) origin = std::min(origin, each.characters.front().start);
  for (std::size_t i = 0; i < read.size(); ++i)
    std::ranges::move(frames_on(read[i], directions[i], origin, choices, *format).frames,
                      std::back_inserter(recording.frames));
  std::ranges::stable_sort(recording.frames, {}, &RecordedFrame::at);
  recording.line = *format;
  recording.is_log = read.size() > 1;  // wires of their own do not collide, and one may be the slave's
  return recording;
}

}  // namespace s7200::tools
