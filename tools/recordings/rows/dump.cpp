// Dumps of a file with bytes: xxd, hexdump with and without -C, od with any radix of its offsets.
#include "tools/recordings/rows/dump.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

constexpr std::array<std::size_t, 3> kBases{16, 8, 10};
constexpr std::size_t kOctal = 1, kDigitsOfOctal = 7;  // od has offsets of seven digits in octal, hexdump the same in hex

std::optional<std::size_t> number_in_base(std::string_view digits, std::size_t base) {
  std::size_t number = 0;
  for (const char digit : digits) {
    if (value_of_digit(digit) >= base) return {};
    number = number * base + value_of_digit(digit);
  }
  return number;
}

bool is_octal_group(std::size_t digits) { return digits == 3 || digits == 6; }
bool is_word_group(std::size_t digits) { return digits == 4 || digits == 6; }

/// Appends the bytes of a group. Returns false if its digits are none.
bool append_group(Bytes& bytes, std::string_view digits, bool low_byte_first) {
  const auto number = number_in_base(digits, is_octal_group(digits.size()) ? 8 : 16);
  if (!number || *number > (is_word_group(digits.size()) ? 0xFFFFU : 0xFFU)) return false;
  const auto low = static_cast<std::uint8_t>(*number), high = static_cast<std::uint8_t>(*number >> 8);
  if (!is_word_group(digits.size())) return bytes.push_back(low), true;
  bytes.push_back(low_byte_first ? low : high);
  bytes.push_back(low_byte_first ? high : low);
  return true;
}

/// The offset in that base, if a program writes it so.
std::optional<std::size_t> offset_in_base(std::string_view digits, std::size_t base) {
  return base == kBases[kOctal] && digits.size() != kDigitsOfOctal ? std::nullopt : number_in_base(digits, base);
}

constexpr std::size_t kDigitsOfHexdump = 4;  // of a group

/// Puts rows together whose offsets go on, from 0 on.
class DumpFrames {
 public:
  /// Takes a line. Returns false if it does not belong there.
  bool take(std::string_view line, std::size_t number) {
    if (stl::trim(line).empty()) return true;
    if (stl::trim(line) == "*") return repeats_ = !last_.empty();
    auto row = dump_row(line);
    if (!row) return false;
    ++rows_;
    is_sure_ = is_sure_ || rows_ > 1 || row->bytes.empty() || !is_hex_digit(stl::trim_end(line).back());
    if (row->bytes.empty()) return close(row->offset);
    if (is_offset_of(row->offset, 0) && (frames.empty() || !repeats_)) begin(number);
    if (frames.empty() || !goes_on(row->offset, row->digits_of_group)) return false;
    Bytes& bytes = frames.back().bytes;
    bytes.insert(bytes.end(), row->bytes.begin(), row->bytes.end());
    last_ = std::move(row->bytes);
    digits_ = row->digits_of_group;
    return true;
  }

  /// Whether it can be nothing but a dump: more than a row of digits alone.
  bool is_sure() const { return is_sure_ && !frames.empty(); }

  std::vector<RecordedFrame> frames{};

 private:
  void begin(std::size_t number) {
    frames.push_back({.place = fmt::format("line {}", number)});
    bases_ = {true, true, true};
  }

  /// Whether the offset is the number of bytes above it, in a base in which all before it were; after a line with a star,
  /// which stands for rows as the last one, it is the number with those.
  bool goes_on(std::string_view offset, std::size_t digits_of_group) {
    constexpr std::size_t kMost = std::size_t{1} << 24;
    Bytes& bytes = frames.back().bytes;
    for (std::size_t i = 0; i < kBases.size(); ++i) {
      const auto number = offset_in_base(offset, kBases[i]);
      const bool fits =
          number && (repeats_ ? *number > bytes.size() && *number < kMost && (*number - bytes.size()) % last_.size() == 0
                              : *number == bytes.size());
      bases_[i] = bases_[i] && fits;
    }
    const auto first = static_cast<std::size_t>(std::ranges::find(bases_, true) - bases_.begin());
    if (first == bases_.size()) return false;
    const std::size_t base = bases_[kOctal] && digits_of_group != kDigitsOfHexdump ? kOctal : first;
    const std::size_t number = *offset_in_base(offset, kBases[base]);
    while (bytes.size() < number) bytes.insert(bytes.end(), last_.begin(), last_.end());
    repeats_ = false;
    return true;
  }

  /// The last offset is the length: a word of which only the first byte was there has one byte more.
  bool close(std::string_view offset) {
    if (frames.empty()) return false;
    if (repeats_) return goes_on(offset, digits_);
    Bytes& bytes = frames.back().bytes;
    const bool has_half = !bytes.empty() && is_offset_of(offset, bytes.size() - 1);
    if (has_half) bytes.pop_back();
    return has_half || is_offset_of(offset, bytes.size());
  }

  Bytes last_{};
  std::array<bool, kBases.size()> bases_{};
  std::size_t rows_ = 0, digits_ = 0;
  bool repeats_ = false, is_sure_ = false;
};

}  // namespace

std::optional<DumpRow> dump_row(std::string_view line) {
  constexpr std::size_t kFewestDigits = 4, kMostDigits = 16, kHalfRow = 8;
  line = stl::trim_end(line);
  Scan scan(line);
  scan.skip(kAllBlanks);
  DumpRow row{.offset = scan.take_hex(kMostDigits)};
  if (row.offset.size() < kFewestDigits) return {};
  const bool colon = scan.take(":") != '\0';
  if (scan.at_end() && !colon) return row;
  std::size_t gap = scan.skip(" \t");
  if (gap == 0) return {};
  std::size_t between = 0;
  for (std::size_t groups = 0; !scan.at_end(); ++groups) {
    const std::size_t begin = scan.at();
    const std::string_view digits = scan.take_hex(kMostDigits);
    const bool ends = scan.at_end() || is_any_of(scan.next(), " \t");
    if (groups == 0) row.digits_of_group = digits.size();
    if (groups == 1) between = gap;
    const bool in_line = groups < 2 || gap == between || (row.digits_of_group == 2 && groups == kHalfRow && gap == 2);
    const bool is_half = colon && row.digits_of_group == 4 && digits.size() == 2;
    if (!ends || !in_line || (digits.size() != row.digits_of_group && !is_half) ||
        !append_group(row.bytes, digits, !colon)) {
      scan.go_back_to(begin);
      break;
    }
    gap = scan.skip(" \t");
  }
  const std::size_t digits = row.digits_of_group;
  const std::string_view characters = line.substr(std::min(scan.at(), line.size()));
  constexpr std::size_t kBars = 2;
  const bool fits = characters.empty() || characters.size() <= row.bytes.size() + kBars;
  return fits && !row.bytes.empty() && (digits == 2 || digits == 3 || is_word_group(digits)) ? std::optional(std::move(row))
                                                                                             : std::nullopt;
}

bool is_offset_of(std::string_view digits, std::size_t number) {
  return std::ranges::any_of(kBases, [&](std::size_t base) { return offset_in_base(digits, base) == number; });
}

bool looks_like_dump(std::string_view bytes) {
  if (!is_text(bytes)) return false;
  const std::string_view beginning = beginning_of(bytes);
  DumpFrames dump;
  std::size_t number = 0;
  for (const std::string_view line : Lines(beginning)) {
    const bool may_be_cut =
        line.data() + line.size() == beginning.data() + beginning.size() && beginning.size() < bytes.size();
    if (!may_be_cut && !dump.take(line, ++number)) return false;
  }
  return dump.is_sure();
}

Result<LineRecording> read_dump(std::string_view bytes, const ReadingChoices& choices) {
  DumpFrames dump;
  std::size_t number = 0;
  for (const std::string_view line : Lines(bytes, choices.stop))
    if (!dump.take(line, ++number)) return trouble("line {}: it does not go on from the row of the dump above it", number);
  return LineRecording{.frames = std::move(dump.frames)};
}

}  // namespace s7200::tools
