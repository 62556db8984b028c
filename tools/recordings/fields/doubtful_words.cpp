// What words beside bytes say of them: names, numbers, damaged bytes, sentences.
#include <algorithm>
#include <array>
#include <cctype>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/words.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

/// Whether a word beside bytes is IN or OUT, which sentences have as well.
bool is_in_or_out(std::string_view word) { return direction_beside_bytes(word) != Direction::Unknown; }

/// Whether a word beside bytes may be a damaged byte: `1`, `3G`, `??`, `123`
bool may_be_a_damaged_byte(const Word& word) {
  if (word.number == Word::Number::Yes || names_a_direction(word) || is_in_or_out(word.text)) return false;
  const auto is_sign = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '?' || c == '*'; };
  return (word.text.size() <= 2 && std::ranges::any_of(word.text, is_sign) && std::ranges::all_of(word.text, is_sign)) ||
         word.text.find_first_of("?*") != std::string_view::npos ||
         (std::ranges::all_of(word.text, is_hex_digit) && !is_of_a_language(word.text));
}

/// Whether a text ends with a fraction: `12.5`, `0,123`
bool ends_with_fraction(std::string_view text) {
  constexpr std::size_t kMostDigits = 9;
  std::size_t point = text.size();
  while (point > 0 && stl::is_digit(text[point - 1])) --point;
  const std::size_t digits = text.size() - point;
  return digits >= 1 && digits <= kMostDigits && point >= 2 && (text[point - 1] == '.' || text[point - 1] == ',') &&
         stl::is_digit(text[point - 2]);
}

/// Whether a word ends with digits that may be bytes: `:010300C80002`, of Modbus ASCII. A clock, a decimal and `len=09` do
/// not.
bool ends_with_digits(const Word& word) {
  const std::string_view text = word.text.substr(0, word.text.find_last_not_of(',') + 1);  // `slice{0x1,`
  const std::size_t end = text.find_last_not_of("0123456789ABCDEFabcdef");
  if (end == std::string_view::npos || end + 1 == text.size()) return false;
  if ((word.text[end] & 0x80) != 0 && !stl::is_valid_utf8(word.text)) return true;  // of another encoding
  return std::ispunct(static_cast<unsigned char>(word.text[end])) != 0 && !has_clock(word.text) &&
         !ends_with_fraction(word.text) && word.text.find('=') == std::string_view::npos &&
         word.text.find("]:") == std::string_view::npos;
}

/// Whether bytes have capitals and small letters, as no tool writes them: `E4 09 be` before `careful`.
bool has_both_cases(Words run) {
  const auto any = [&](std::string_view letters) {
    return std::ranges::any_of(run, [&](const Word& w) { return w.text.find_first_of(letters) != std::string_view::npos; });
  };
  return any("ABCDEF") && any("abcdef");
}

bool has_mark(const Word& word) {
  if (word.text.size() < 3) return false;
  return is_marked(word.text.substr(std::min(word.text.find_first_not_of("[<({\""), word.text.size())));
}

/// Whether bytes end with a number of several digits after pairs of digits: `01 03 04 12 34 81 07 4660`
bool ends_with_number(Words run) { return run.size() > 2 && run[0].bytes == 1 && run[1].bytes == 1 && run.back().bytes > 1; }

/// A word among the bytes that may be something else; null if there is none. A number before pairs of digits counts lines or
/// seconds; and no tool writes `0x` before only some of its bytes.
const Word* what_is_no_byte(Words run) {
  const auto perhaps = std::ranges::find(run, Word::Number::Perhaps, &Word::number);
  if (perhaps != run.end()) return &*perhaps;
  const auto other_mark =
      std::ranges::find_if(run, [&](const Word& word) { return has_mark(word) != has_mark(run.front()); });
  if (other_mark != run.end()) return &*other_mark;
  const bool before_pairs = run.size() > 1 && run.front().bytes > 1 &&
                            std::ranges::all_of(run.subspan(1), [](const Word& word) { return word.bytes == 1; });
  if (before_pairs) return &run.front();
  return ends_with_number(run) ? &run.back() : nullptr;  // last: all but it may be a frame
}

/// Words before bytes that say what they are: `data 0x0B`, `frame: 0103`
constexpr std::array<std::string_view, 16> kNamesOfBytes{"DATA",    "BYTE",   "BYTES",  "HEX", "FRAME", "PAYLOAD",
                                                         "RAW",     "BUFFER", "PACKET", "PDU", "ADU",   "CHAR",
                                                         "MESSAGE", "MSG",    "CHUNK",  "DUMP"};

/// Words before bytes that say on which line they were: `COM3`, `/dev/ttyUSB0`
constexpr std::array<std::string_view, 6> kNamesOfLines{"COM", "TTY", "/DEV/", "UART", "SERIAL", "RS"};

/// Whether a value is assigned to something that is not called as bytes are: `register 40001 = 1234`
bool is_assigned(Words before, Words run) {
  if (before.empty() || run.size() != 1 || !before.back().text.ends_with('=')) return false;
  const Word& name = before.back().text.size() <= 2 && before.size() > 1 ? before[before.size() - 2] : before.back();
  return !names_bytes(name);
}

/// Words before numbers that are values of something: `Values: 10 20`, `registers = 10, 20`
constexpr std::array<std::string_view, 16> kNamesOfValues{"VALUE",  "VALUES",  "REGISTER", "REGISTERS", "RESULT", "RESULTS",
                                                          "COILS",  "INPUTS",  "WERT",     "WERTE",     "VALOR",  "VALORES",
                                                          "VALEUR", "VALEURS", "VALORI",   "READINGS"};

/// The word that says that numbers after it are values; null if there is none.
const Word* name_of_values(Words before) {
  constexpr std::string_view kAround = "[](){}:=\"'";
  const auto bare = [&](std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(kAround), text.size());
    return stl::upper_case(text.substr(begin, text.find_last_not_of(kAround) + 1 - begin));
  };
  while (!before.empty() && bare(before.back().text).empty()) before = before.first(before.size() - 1);
  if (before.empty() || std::ranges::find(kNamesOfValues, bare(before.back().text)) == kNamesOfValues.end()) return nullptr;
  const auto* const begin = before.front().text.data();
  const std::string_view last = before.back().text, text(begin, static_cast<std::size_t>(last.data() + last.size() - begin));
  const auto is_name = [](const Word& word) { return !names_a_direction(word) && names_bytes(word); };
  return direction_of(text) == Direction::Unknown && std::ranges::none_of(before, is_name) ? &before.back() : nullptr;
}

/// Whether the last word is the name after an arrow: `CPU -> PC`
bool ends_with_name_after_arrow(Words words) {
  constexpr std::string_view kArrow = "-=<>";
  return words.size() > 1 &&
         std::ranges::all_of(words[words.size() - 2].text, [&](char c) { return is_any_of(c, kArrow); }) &&
         std::ranges::any_of(words.back().text, is_letter);
}

/// Whether two or three pairs of digits, fewer than most frames have, stand after words that do not say what they are:
/// `state AB CD`
bool is_short_after_words(Words before, Words run) {
  constexpr std::size_t kMost = 3;
  const auto is_pair = [](const Word& word) { return word.bytes == 1 && word.text.size() == 2; };
  return run.size() > 1 && run.size() <= kMost && std::ranges::all_of(run, is_pair) && !before.empty() &&
         before.back().bytes == 0 && before.back().text.size() > 2 && std::ranges::all_of(before.back().text, is_letter) &&
         std::ranges::none_of(before, names_bytes) && !is_in_or_out(before.back().text);
}

/// Whether as many pairs of digits as a frame has stand before other bytes: `01 03 … -> 01 03 …`
bool may_be_a_frame(Words words, std::size_t from) {
  constexpr std::size_t kFewest = 4;
  std::size_t pairs = 0;
  for (std::size_t i = from; i < words.size() && words[i].bytes == 1; ++i) ++pairs;
  return pairs >= kFewest;
}

/// Whether a word after bytes may be the rest of a damaged byte: `3`, `3G`, `7?`, `123`, but not `ok`.
bool may_be_a_damaged_byte_after(const Word& word) {
  const bool is_short = word.text.size() <= 2 && is_hex_digit(word.text.front());
  return word.text.find_first_of("?*") != std::string_view::npos ||
         (word.bytes == 0 && (is_short || std::ranges::all_of(word.text, is_hex_digit)));
}

/// Whether a word after bytes is a number in another notation: `value 4660`, `= 0x1234, 0x5678`
bool is_a_number(const Word& word, Words run) {
  const std::string_view digits = word.text.substr(0, word.text.find_last_not_of(",;)") + 1);
  return word.bytes == 0 || is_decimal(digits) || (is_marked(digits) && !has_mark(run.front()));
}

/// Whether a word is the number of bytes after it: `8 01 03`, `8B 01 03`
bool counts_bytes(const Word& word, Words after) {
  constexpr std::size_t kMostDigits = 3;
  const std::string_view number = word.text.substr(0, word.text.size() - (word.text.ends_with('B') ? 1 : 0));
  if (after.empty() || number.size() > kMostDigits || !is_decimal(number)) return false;
  const std::size_t bytes = after.back().first_byte + after.back().bytes - after.front().first_byte;
  return static_cast<std::size_t>(decimal_number(number)) == bytes;
}

/// The words of a run that are bytes for sure if any of them are: without those of another form at its end.
Words without_number(Words run) {
  if (ends_with_number(run)) {
    const auto last = std::find_if(run.rbegin(), run.rend(), [](const Word& word) { return word.bytes == 1; }).base();
    return {run.begin(), last};
  }
  return has_both_cases(run) ? run.first(run.size() - 1) : run;
}

bool is_plain_word(const Word& word) {
  return word.bytes == 0 && word.text.size() > 1 && std::ranges::all_of(word.text, is_letter) && !names_a_direction(word);
}

/// Whether words are blocks of STEP 7, not bytes: `DB 10`, `FB 10, DB 11`, `DB10`
bool are_blocks(Words run) {
  constexpr std::array<std::string_view, 3> kBlocks{"DB", "FB", "FC"};  // those that are hex
  const auto has_number = [](std::string_view text) { return is_decimal(text.substr(0, text.find_first_of(",;)"))); };
  const auto is_block = [&](std::string_view text) {
    return std::ranges::any_of(kBlocks, [&](std::string_view block) { return text.starts_with(block); });
  };
  for (std::size_t i = 0; i < run.size(); ++i) {
    const std::string_view text = run[i].text.substr(run[i].text.front() == '(' ? 1 : 0);
    if (!is_block(text)) return false;
    if (text.size() > 2 ? !has_number(text.substr(2)) : ++i == run.size() || !has_number(run[i].text)) return false;
  }
  return !run.empty();
}

/// Whether a word is one of a sentence or of a program: `Wert`, `CALL`, `FUNCTION_BLOCK`, `(siehe`
bool is_of_prose(const Word& word) {
  const auto is_sign = [](char c) {
    return is_letter_of_any_language(c) || std::string_view("_().,;:!?").find(c) != std::string_view::npos;
  };
  return word.bytes == 0 && std::ranges::any_of(word.text, is_letter) && std::ranges::all_of(word.text, is_sign) &&
         !names_a_direction(word);
}

/// Whether a word is the number of something, as modpoll and mbpoll print registers: `[11]:`
bool is_reference(std::string_view word) {
  return word.size() > 3 && word.starts_with('[') && word.ends_with("]:") && is_decimal(word.substr(1, word.size() - 3));
}

/// Whether a word names the answer of a modem, `+CSQ:`, whose numbers are in decimal.
bool names_answer_of_modem(std::string_view word) {
  return word.size() > 2 && word.starts_with('+') && word.ends_with(':') &&
         std::ranges::all_of(word.substr(1, word.size() - 2), is_letter);
}

/// Whether a word is a name with a colon: `temp:`, `D100:`
bool is_name_with_colon(std::string_view word) {
  const auto is_of_name = [](char c) { return is_word_sign(c) || c == '.' || (c & 0x80) != 0; };
  return word.size() > 1 && word.back() == ':' && is_letter_of_any_language(word.front()) &&
         std::ranges::all_of(word.substr(0, word.size() - 1), is_of_name);
}

}  // namespace

bool names_bytes(const Word& word) {
  if (names_a_direction(word)) return true;
  constexpr std::string_view kAround = "[]():>,;=";
  const std::string capitals = stl::upper_case(word.text);
  const std::size_t begin = std::min(capitals.find_first_not_of(kAround), capitals.size());
  const std::string_view name = std::string_view(capitals).substr(begin, capitals.find_last_not_of(kAround) + 1 - begin);
  const auto begins = [&](std::string_view line) { return name.starts_with(line) && stl::is_digit(name.back()); };
  if (std::ranges::any_of(kNamesOfLines, begins)) return true;
  for (std::size_t at = 0; at < name.size(); ++at) {
    const std::size_t first = at;
    while (at < name.size() && is_letter(name[at])) ++at;
    if (std::ranges::find(kNamesOfBytes, name.substr(first, at - first)) != kNamesOfBytes.end()) return true;
  }
  return false;
}

bool names_a_direction(const Word& word) { return direction_of(word.text) != Direction::Unknown; }

bool are_values(Words before, Words run) {
  constexpr std::size_t kShortestFrame = 4;
  const std::size_t bytes = run.back().first_byte + run.back().bytes - run.front().first_byte;
  const bool of_modem = !before.empty() && names_answer_of_modem(before.back().text);
  return bytes < kShortestFrame && (of_modem || name_of_values(before) != nullptr);
}

const Word* what_is_doubtful(Words before, Words run, Words after) {
  if (!before.empty() && !ends_with_name_after_arrow(before) &&
      (may_be_a_damaged_byte(before.back()) || ends_with_digits(before.back())))
    return &before.back();
  const auto other = std::ranges::find_if(before, [](const Word& word) { return word.bytes > 0; });
  if (other != before.end()) {
    const bool after_direction = std::any_of(before.begin(), other, names_a_direction);
    const auto is_number = [](const Word& word) { return word.number == Word::Number::Yes; };
    const auto name = std::find_if_not(before.rbegin(), before.rend(), is_number);
    const bool named = name != before.rend() && (names_a_direction(*name) || is_any_of(name->text.back(), ":>-)]|"));
    if (after_direction || !named || may_be_a_frame(before, static_cast<std::size_t>(other - before.begin())))
      return &*std::find_if(other, before.end(), [](const Word& word) { return word.bytes == 0; });
  }
  if (is_assigned(before, run) || is_short_after_words(before, run)) return &before.back();
  if (const Word* const name = name_of_values(before)) return name;
  if (const Word* const no_byte = what_is_no_byte(run)) return no_byte;
  if (after.empty() || after.front().number == Word::Number::Yes) return nullptr;
  if (has_both_cases(run)) return &run.back();
  const std::string_view next = after.front().text;
  const bool ends_cell = next.front() == '|' && std::ranges::none_of(after, [](const Word& word) { return word.bytes > 0; });
  if (ends_cell) return nullptr;
  const bool is_comment = next.front() == '(' || (next.size() > 2 && std::all_of(next.begin(), next.begin() + 3, is_letter));
  return is_comment && (run.size() > 1 || run.front().bytes > 1) ? nullptr : &after.front();
}

std::vector<Words> possible_runs(Words words) {
  const auto has_bytes = [](const Word& word) { return word.bytes > 0 && word.number != Word::Number::Yes; };
  const auto first = std::ranges::find_if(words, has_bytes);
  const auto last = std::find_if_not(first, words.end(), has_bytes);
  const Words before{words.begin(), first}, run{first, last}, after{last, words.end()};
  for (std::size_t i = 0; i < after.size(); ++i)
    if (may_be_a_frame(after, i)) return {};
  if (run.empty() || !std::ranges::all_of(after, [&](const Word& word) { return is_a_number(word, run); })) return {};
  const bool is_counted = !before.empty() && counts_bytes(before.back(), run);
  if (!is_counted && !before.empty() && (may_be_a_damaged_byte(before.back()) || ends_with_digits(before.back()))) return {};
  if (!after.empty() && after.front().number != Word::Number::Yes && may_be_a_damaged_byte_after(after.front())) return {};
  if (what_is_no_byte(without_number(run)) != nullptr) return {};
  std::vector<Words> runs{run};
  if (const Words surely = without_number(run); !surely.empty() && surely.size() < run.size()) runs.push_back(surely);
  if (run.size() > 1 && counts_bytes(run.front(), run.subspan(1))) runs.push_back(run.subspan(1));
  return runs;
}

std::optional<OtherRun> other_run(Words run, Words after) {
  if (run.size() < 2) return {};
  if (counts_bytes(run.front(), run.subspan(1))) return OtherRun{run.subspan(1), run.front().text};
  const bool begins_comment =
      !after.empty() && is_letter(after.front().text.front()) && std::ranges::all_of(run.back().text, is_letter);
  if (!begins_comment) return {};
  return OtherRun{run.first(run.size() - 1), run.back().text};
}

std::string_view without_bars(std::string_view text) {
  const bool barred = text.size() > 2 && ((text.front() == '|' && text.back() == '|') ||
                                          (text.front() == '>' && text.back() == '<'));  // of od -t x1z
  return barred ? text.substr(1, text.size() - 2) : text;
}

std::string in_single_bytes(std::string_view text) {
  std::string single;
  for (const char c : text)
    if ((c & 0xC0) != 0x80 || single.empty()) single += (c & 0x80) != 0 ? '.' : c;
  return single;
}

bool is_value(Words before, Words run) {
  constexpr std::size_t kLongest = 4, kAddress = 6;  // an address in memory: `alloc 0x7ffdeadbeef0`
  if (before.empty() || run.size() != 1) return false;
  if (run.front().bytes > (is_marked(run.front().text) ? kAddress : kLongest)) return false;
  if (std::ranges::any_of(before, names_bytes)) return false;
  if (is_assigned(before, run)) return true;
  const std::string_view text = run.front().text, name = before.back().text;
  const bool is_number = is_decimal(text) || is_marked(text);
  const bool numbered = before.size() > 1 && name.ends_with(':') && is_decimal(name.substr(0, name.size() - 1)) &&
                        is_plain_word(before[before.size() - 2]);  // `value 0: 4660`
  return is_number && (numbered || is_reference(name) || is_plain_word(before.back()) || is_name_with_colon(name) ||
                       (before.size() > 1 && has_clock(name)));
}

bool is_of_a_sentence(Words before, Words run, Words after) {
  if (are_blocks(run) && std::ranges::none_of(before, names_a_direction))
    return (!before.empty() && is_of_prose(before.back())) || (!after.empty() && is_of_prose(after.front()));
  if (run.size() != 1) return false;
  const std::string_view text = run.front().text;
  const bool is_number = is_decimal(text), is_word = std::ranges::all_of(text, is_letter);
  if (before.empty()) return is_word && !after.empty() && is_plain_word(after.front());
  const std::string capitals = stl::upper_case(before.back().text);
  const bool names_a_station = capitals == "SLAVE" || capitals == "MASTER";
  const bool is_prose = is_number || (is_word && std::ranges::none_of(before, names_a_direction));
  return (is_number && names_a_station) || (is_prose && is_plain_word(before.back()));
}

bool has_pairs(Words words) {
  const auto is_pair = [](const Word& word) { return word.bytes == 1; };
  return std::ranges::adjacent_find(words, [&](const Word& a, const Word& b) { return is_pair(a) && is_pair(b); }) !=
         words.end();
}

std::optional<BytesInLine> cut_off_bytes(Words words) {
  constexpr std::size_t kFewestDigits = 5;
  const auto is_hex = [](const Word& word) { return std::ranges::all_of(word.text, is_hex_digit); };
  const auto first = std::find_if_not(words.rbegin(), words.rend(), is_hex).base();
  const Words digits{first, words.end()};
  if (digits.empty() || digits.front().number == Word::Number::Yes) return {};
  const bool many = digits.size() > 2 || digits.front().text.size() >= kFewestDigits;
  const bool has_digit = std::ranges::any_of(digits.front().text, stl::is_digit);
  const bool named = first == words.begin() || names_a_direction(*std::prev(first)) || digits.size() > 2;
  if (!many || !has_digit || !named) return {};
  return BytesInLine{.begin = digits.front().begin, .not_understood = digits.front().text};
}

std::optional<RunOfBytes> last_run(Words words) {
  const auto has_bytes = [](const Word& word) { return word.bytes > 0; };
  const auto last = std::find_if(words.rbegin(), words.rend(), has_bytes).base();
  if (last == words.begin()) return {};
  const auto first = std::find_if_not(std::reverse_iterator(last), words.rend(), has_bytes).base();
  return RunOfBytes{{words.begin(), first}, {first, last}};
}

}  // namespace s7200::tools
