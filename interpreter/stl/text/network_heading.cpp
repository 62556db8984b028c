#include "interpreter/stl/text/network_heading.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "interpreter/base/text/text.hpp"

namespace s7200::stl::plain {
namespace {

/// What may stand between the word and its number: `Network #1`, `Network No. 1`, `NETWORK_1`; 0 bytes if nothing does.
std::size_t sign_before_number(std::string_view text) {
  constexpr std::array<std::string_view, 10> kSigns{"#", "_", "NO.", "NR.", "NO", "NR", "NUMBER", "N°", "Nº", "№"};
  const std::string capitals = upper_case(text.substr(0, 8));
  const auto sign = std::ranges::find_if(kSigns, [&](std::string_view each) { return capitals.starts_with(each); });
  return sign == kSigns.end() ? 0 : sign->size();
}

/// Whether the word for a network may begin with a byte.
constexpr bool may_begin_word(char c) {
  constexpr ByteSet kLetters{"NRSAnrsa"};
  return kLetters.has(c) || static_cast<unsigned char>(c) >= 0x80;
}

/// Whether its heading may begin with a byte: with a rule, a bracket or the word.
bool may_begin_heading(char c) {
  constexpr ByteSet kSigns{"=-*#~_+[({<"};
  return kSigns.has(c) || may_begin_word(c);
}

/// What stands around a heading: `===`, `[`. A single `=` begins a coil.
struct Frame {
  std::size_t bytes = 0;  ///< in front of the heading
  char bracket = '\0';    ///< that closes it; 0: none
};
Frame frame_before(std::string_view text) {
  constexpr std::string_view kOpening = "[({<", kClosing = "])}>", kRules = "=-*#~_+";
  Frame frame;
  frame.bytes = std::min(text.find_first_not_of("=-*#~_+ \t"), text.size());
  const std::string_view rules = text.substr(0, frame.bytes);
  if (const std::size_t kind = frame.bytes < text.size() ? kOpening.find(text[frame.bytes]) : text.npos; kind != text.npos) {
    frame.bracket = kClosing[kind];
    const std::string opening{kOpening[kind], ' ', '\t'};
    frame.bytes = std::min(text.find_first_not_of(opening, frame.bytes), text.size());
  } else if (std::ranges::count_if(rules, [&](char c) { return kRules.find(c) != kRules.npos; }) == 1 && rules[0] == '=') {
    return {};
  }
  return frame;
}

std::string_view without_rules_at_end(std::string_view text) {
  return text.substr(0, text.find_last_not_of("=-*#~_+])}> \t") + 1);
}

constexpr std::array<std::string_view, 8> kTitleDashes{":", "：", ".", "-", "–", "—", ",", ";"};

/// The title without the dash in front of it.
std::string_view without_dash(std::string_view title) {
  const auto dash = std::ranges::find_if(kTitleDashes, [title](std::string_view each) { return title.starts_with(each); });
  return dash == kTitleDashes.end() ? title : trim(title.substr(dash->size()));
}

bool is_any_of_number(char c) { return c == '.' || c == '-'; }

/// Whether a title may stand without any sign after its number: it begins with a letter or as `24V`, and not as an operand.
bool may_be_title(std::string_view title) {
  const std::string_view first = title.substr(0, title.find_first_of(" \t"));
  const auto is_of_word = [](char c) { return is_letter(c) || static_cast<unsigned char>(c) >= 0x80; };
  return !first.empty() && std::string_view(".,;=+*/<>").find(first.front()) == std::string_view::npos &&
         std::ranges::any_of(first, is_of_word);
}

}  // namespace

std::size_t network_word(std::string_view text) {  // beyond ASCII as they are written
  static constexpr std::string_view kAscii[] = {"NETZWERK", "RESEAU", "SEGMENTO", "NETWERK", "REDE",   "RETE",
                                                "RED",      "RUNG",   "NW",       "NET",     "NETWORK"};
  static constexpr std::string_view kBeyond[] = {"RÉSEAU", "Réseau", "réseau", "СЕТЬ",   "Сеть",        "сеть", "网络",
                                                 "網路",   "網絡",   "程序段", "程式段", "SIEĆ",        "Sieć", "sieć",
                                                 "SÍŤ",    "Síť",    "AĞ",     "Ağ",     "ネットワーク"};
  constexpr auto kMayBegin = [](std::string_view word) { return !word.empty() && may_begin_word(word[0]); };
  static_assert(std::ranges::all_of(kAscii, kMayBegin) && std::ranges::all_of(kBeyond, kMayBegin));
  if (!kMayBegin(text)) return 0;
  const auto letters = static_cast<std::size_t>(std::ranges::find_if_not(text, is_letter) - text.begin());
  const std::string_view written = text.substr(0, letters);
  if (std::ranges::any_of(kAscii, [written](std::string_view word) { return same_in_capitals(written, word); }))
    return letters;
  if (letters == text.size() || static_cast<unsigned char>(text[letters]) < 0x80) return 0;
  const auto* const beyond = std::ranges::find_if(kBeyond, [text](std::string_view each) { return text.starts_with(each); });
  return beyond == std::end(kBeyond) ? 0 : beyond->size();
}

std::optional<NetworkHeading> network_heading(std::string_view line) {
  constexpr std::size_t kMostDigits = 5;
  NetworkHeading heading{.begin = std::min(line.find_first_not_of(" \t"), line.size())};
  std::string_view rest = line.substr(heading.begin);
  if (rest.empty() || !may_begin_heading(rest.front())) return std::nullopt;
  const Frame frame = frame_before(rest);
  rest.remove_prefix(frame.bytes);
  const std::size_t word = network_word(rest);
  if (word == 0) return std::nullopt;
  const std::string_view written = rest.substr(0, word);
  bool own = same_in_capitals(written, "NETWORK") && frame.bytes == 0;
  rest.remove_prefix(word);
  const auto skip_blanks = [&] { rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size())); };
  skip_blanks();
  if (const std::size_t sign = sign_before_number(rest); sign > 0) {
    own = false;
    rest.remove_prefix(sign);
    skip_blanks();
  }
  heading.number = rest.substr(0, std::min(rest.find_first_not_of("0123456789"), rest.size()));
  if (heading.number.empty() || heading.number.size() > kMostDigits) return std::nullopt;
  own = own && heading.number.data() > written.data() + word;  // `NETWORK1` has lost its blank
  rest.remove_prefix(heading.number.size());
  if (frame.bracket != '\0') {  // `[Network 1] Start`, `[Network 1: Start]`
    const std::size_t close = rest.find(frame.bracket);
    if (close == rest.npos) return std::nullopt;
    const std::string_view before = trim(rest.substr(0, close)), after = trim(without_rules_at_end(rest.substr(close + 1)));
    if (!before.empty() && !after.empty()) return std::nullopt;
    heading.end = static_cast<std::size_t>(rest.data() - line.data()) + (before.empty() ? close + 1 : 0);
    heading.title = without_dash(before.empty() ? after : before);
    heading.framed = after.empty();
    return heading;
  }
  heading.end = static_cast<std::size_t>(rest.data() - line.data());
  const bool apart = rest.starts_with('\t') || rest.starts_with("  ");
  if (const std::string_view plain = without_rules_at_end(rest);
      frame.bytes > 0 || rest.ends_with("==") || rest.ends_with("--") || rest.ends_with("##")) {
    own = own && plain.size() == rest.size();
    heading.framed = frame.bytes > 0 && plain.size() < rest.size();
    rest = plain;
  }
  skip_blanks();
  heading.title = trim(rest);
  if (rest.empty() || rest.starts_with("//")) return own ? std::nullopt : std::optional(heading);
  const bool dashed = without_dash(rest).size() < rest.size();
  heading.title = without_dash(rest);
  if (heading.title.empty()) return heading;
  if (is_any_of_number(rest.front()) && rest.size() > 1 && is_digit(rest[1])) return std::nullopt;  // `NETWORK 1.5`
  const std::string_view first = heading.title.substr(0, heading.title.find_first_of(" \t"));
  const bool printed = apart && is_upper(first[0]) && std::ranges::any_of(first, is_lower) && written == "Network";
  if (dashed || rest.starts_with('(') || rest.starts_with('"') || printed) return heading;
  heading.sure = false;
  return may_be_title(heading.title) ? std::optional(heading) : std::nullopt;
}

}  // namespace s7200::stl::plain
