// What `sigrok-cli -A uart` prints: `uart-1: 01`, with --protocol-decoder-samplenum `1104-1938 uart-1: 01`, in any of the
// decoder's formats; and what PulseView exports: `1104-1938 UART: RX data: 01`. Without classes, `uart-1: rx-data: 01`, it
// does not say whether a character was RX or TX; it counts samples, not time.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/left_out.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/rows/notation.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

struct Annotation {
  std::size_t number = 0;               ///< of its line
  std::optional<std::int64_t> begin{};  ///< sample
  std::string_view text{};
  Direction direction = Direction::Unknown;  ///< by its class
  bool is_of_bits = false;                   ///< its class is one of parts of a character
};

constexpr std::size_t kMostDigits = 18;

/// The head of an annotation: `1104-1938 uart-1: `, `1104-1938 UART: ` of PulseView
struct AnnotationHead {
  std::string_view first{}, decoder{};
  std::size_t length = 0;
  bool of_pulseview = false;
};
std::optional<AnnotationHead> annotation_head(std::string_view line) {
  Scan scan(line);
  AnnotationHead head{.first = scan.take_digits(kMostDigits)};
  const bool has_samples =
      !head.first.empty() && scan.take("-") != '\0' && !scan.take_digits(kMostDigits).empty() && scan.take(" ") != '\0';
  if (!head.first.empty() && !has_samples) return {};
  head.decoder = scan.take_while(is_word_sign);
  head.of_pulseview = has_samples && scan.next() == ':';
  const bool has_number = !head.of_pulseview && scan.take("-") != '\0' && !scan.take_digits(kMostDigits).empty();
  if (head.decoder.empty() || (!head.of_pulseview && !has_number) || !scan.take_word(": ")) return {};
  head.length = scan.at();
  return head;
}

bool is_of_characters(const AnnotationHead& head) {
  return head.decoder == "uart" || (head.of_pulseview && stl::upper_case(head.decoder) == "UART");
}

/// Takes the class off the text: `rx-data: 01`, `tx-start: Start bit`.
void take_class(Annotation& annotation) {
  Scan scan(annotation.text);
  const bool rx = scan.take_word("rx-"), tx = !rx && scan.take_word("tx-");
  const std::string_view name = scan.take_while([](char c) { return stl::is_letter(c) || c == '-'; });
  if ((!rx && !tx) || name.empty() || !scan.take_word(": ")) return;
  annotation.direction = rx ? Direction::Answer : Direction::Request;
  annotation.is_of_bits = name != "data" && name != "warning" && name != "warnings" && name != "break";
  annotation.text.remove_prefix(scan.at());
}

/// Takes PulseView's class or row off the text: `RX data: 01`, `RX: 01`, `RX start bits: Start bit`, `TX warnings: Frame
/// error`. Without it, `01`, the text has none.
void take_class_of_pulseview(Annotation& annotation) {
  const std::size_t end = annotation.text.find(": ");
  if (end == std::string_view::npos) return;
  const std::string_view name = annotation.text.substr(0, end), kind = stl::trim(name.substr(std::min<std::size_t>(2, end)));
  annotation.direction = direction_of(name.substr(0, 2));
  const bool has_direction = annotation.direction != Direction::Unknown;
  annotation.is_of_bits =
      !(has_direction && kind.empty()) && !name.ends_with("data") && !name.ends_with("warnings") && !name.ends_with("break");
  annotation.text.remove_prefix(end + 2);
}

/// The annotation in a line; nothing if it is not one of the decoder `uart`.
std::optional<Annotation> annotation_of(std::string_view line) {
  const auto head = annotation_head(line);
  if (!head || !is_of_characters(*head)) return {};
  const std::string_view written = line.substr(head->length);
  Annotation annotation{.text = written == " " ? written : stl::trim(written)};  // a blank may be a character
  if (!head->first.empty()) annotation.begin = decimal_number(head->first);
  head->of_pulseview ? take_class_of_pulseview(annotation) : take_class(annotation);
  if (annotation.text.size() > 2 && annotation.text.starts_with('"') && annotation.text.ends_with('"'))
    annotation.text = annotation.text.substr(1, annotation.text.size() - 2);  // sigrok-cli -l 3
  return annotation;
}

/// Annotations of the same character or of its bits.
bool is_of_the_frame(std::string_view text) { return text == "Start bit" || text == "Stop bit" || text == "Parity bit"; }
bool is_damage(std::string_view text) {
  return text == "Parity error" || text == "Frame error" || text == "Break condition" || text == "Break";
}
bool is_bit(std::string_view text) { return text == "0" || text == "1"; }

struct Character {
  Annotation annotation;
  bool damaged = false;
};

/// Whether all classes of annotations were printed: then each bit of a character has its own, `0` or `1` after a start bit.
bool has_bits(std::string_view bytes) {
  std::size_t start_bits = 0, bits = 0;
  for (const std::string_view line : Lines(beginning_of(bytes)))
    if (const auto annotation = annotation_of(line)) {
      start_bits += annotation->text == "Start bit";
      bits += is_bit(annotation->text);
    }
  constexpr std::size_t kFewestBits = 5;
  return start_bits > 0 && bits >= kFewestBits * (start_bits - 1);
}

class Frames {
 public:
  explicit Frames(const ReadingChoices& choices) : choices_(choices) {}

  /// The shortest distance between the begins of two characters is the time of one.
  void measure(const std::vector<Character>& characters) {
    for (std::size_t i = 1; i < characters.size(); ++i) {
      const auto before = characters[i - 1].annotation.begin, begin = characters[i].annotation.begin;
      if (before && begin && *begin > *before) pitch_ = std::min(pitch_, *begin - *before);
    }
  }

  void add(const Character& character, const Bytes& bytes) {
    const auto begin = character.annotation.begin;
    const Direction direction = character.annotation.direction;
    RecordedFrame row{.direction = direction, .bytes = bytes, .place = fmt::format("line {}", character.annotation.number)};
    if (character.damaged) row.damaged = {0};
    if (begin && choices_.samplerate != 0) row.at = time_of(*begin);
    const bool ends = (begin && last_ && *begin - *last_ > kSilence * pitch_) || direction != direction_;
    direction_ = direction;
    last_ = begin;
    if (choices_.samplerate == 0 && !ends && !recording.frames.empty()) {
      RecordedFrame& frame = recording.frames.back();
      if (character.damaged) frame.damaged.push_back(frame.bytes.size());
      frame.bytes.insert(frame.bytes.end(), bytes.begin(), bytes.end());
    } else {
      recording.frames.push_back(std::move(row));
    }
  }

  void finish() {
    count_from_first(recording);
    if (choices_.samplerate != 0) join_characters(recording, choices_);
    if (!recording.frames.empty() && !recording.frames.front().at)
      recording.notes.emplace_back(
          last_ ? "it counts samples: --samplerate, as 1MHz, makes times of them"
                : "it has no times; sigrok-cli writes the numbers of samples with --protocol-decoder-samplenum");
  }

  LineRecording recording;

 private:
  static constexpr std::int64_t kSilence = 4;  // characters between the begins of two: 3 between them

  std::optional<Time> time_of(std::int64_t sample) const {
    const long double seconds = static_cast<long double>(sample) / static_cast<long double>(choices_.samplerate);
    if (!(seconds < kFurthestTime / kSecond)) return {};
    return std::llround(seconds * kSecond);
  }

  const ReadingChoices& choices_;
  std::int64_t pitch_ = std::numeric_limits<std::int64_t>::max() / kSilence;
  std::optional<std::int64_t> last_;
  Direction direction_ = Direction::Unknown;
};

/// The decoder that annotations are of that are none of characters; empty if there are characters, or no annotations.
std::string_view other_decoder(std::string_view bytes) {
  constexpr std::array<std::string_view, 6> kDecoders{"modbus", "midi", "lin", "can", "spi", "i2c"};
  std::string_view other;
  for (const std::string_view line : Lines(beginning_of(bytes))) {
    const auto head = annotation_head(line);
    if (head && is_of_characters(*head)) return "";
    const auto is_of_sigrok = [&] {  // `100-200 TX: 01` may be of any log
      return std::ranges::find(kDecoders, stl::lower_case(head->decoder)) != kDecoders.end();
    };
    const bool is_known = head && ((!head->first.empty() && !head->of_pulseview) || is_of_sigrok());
    if (is_known && other.empty()) other = head->decoder;
  }
  return other;
}

}  // namespace

bool looks_like_sigrok_annotations(std::string_view bytes) {
  return is_text(bytes) && (std::ranges::any_of(Lines(beginning_of(bytes)),
                                                [](std::string_view line) { return annotation_of(line).has_value(); }) ||
                            !other_decoder(bytes).empty());
}

Result<LineRecording> read_sigrok_annotations(std::string_view bytes, const ReadingChoices& choices) {
  if (const std::string_view other = other_decoder(bytes); !other.empty())
    return trouble("it is what sigrok's decoder {} says, without the characters; print them with sigrok-cli -A uart", other);
  const bool bits = has_bits(bytes);
  std::vector<Character> characters;
  LeftOut left_out;
  NotationFinder finder;
  std::size_t number = 0;
  for (const std::string_view line : Lines(bytes, choices.stop)) {
    ++number;
    auto annotation = annotation_of(line);
    if (!annotation) {
      if (!stl::trim(line).empty()) left_out.without_bytes(number);
    } else if (is_damage(annotation->text)) {
      if (!characters.empty()) characters.back().damaged = true;
    } else if (!annotation->is_of_bits && !is_of_the_frame(annotation->text) && !(bits && is_bit(annotation->text))) {
      annotation->number = number;
      finder.take(annotation->text, number);
      characters.push_back({.annotation = *annotation});
    }
  }
  const auto notation = finder.found();
  if (!notation) return notation.trouble();
  const auto begin_of = [](const Character& character) { return character.annotation.begin; };
  if (std::ranges::all_of(characters, [&](const Character& each) { return begin_of(each).has_value(); }))
    std::ranges::stable_sort(characters, {}, begin_of);  // PulseView writes row after row
  Frames frames(choices);
  frames.measure(characters);
  for (const Character& character : characters) frames.add(character, *notation->read(character.annotation.text));
  const auto is_sent = [](const RecordedFrame& frame) { return frame.direction == Direction::Request; };
  if (std::ranges::none_of(frames.recording.frames, is_sent))  // of one wire, whoever speaks on it
    for (RecordedFrame& frame : frames.recording.frames) frame.direction = Direction::Unknown;
  frames.finish();
  left_out.tell(frames.recording);
  return std::move(frames.recording);
}

}  // namespace s7200::tools
