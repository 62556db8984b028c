#include "interpreter/stl/text/encoding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/base/text/utf16.hpp"
#include "interpreter/stl/text/code_pages.hpp"

namespace s7200::stl {

namespace {

using namespace std::string_view_literals;

constexpr std::string_view kReplacementText = "\uFFFD";

std::uint8_t byte_at(std::string_view bytes, std::size_t index) {
  return index < bytes.size() ? static_cast<std::uint8_t>(bytes[index]) : std::uint8_t{0};
}

struct FileKind {
  std::string_view beginning;
  const char* what;
};

constexpr std::array kFileKinds{
    FileKind{"\x89PNG"sv, "a PNG picture"},
    FileKind{"\xFF\xD8\xFF"sv, "a JPEG picture"},
    FileKind{"GIF8"sv, "a GIF picture"},
    FileKind{"PK\x03\x04"sv, "a ZIP archive or an office document (.docx, .odt); save its text as plain text"},
    FileKind{"%PDF"sv, "a PDF document; save its text as plain text"},
    FileKind{"{\\rtf"sv, "an RTF document; save its text as plain text"},
    FileKind{"\x7F"
             "ELF"sv,
             "a program (ELF)"},
    FileKind{"MZ\x90"sv, "a program (EXE)"},
    FileKind{"\x1F\x8B"sv, "a gzip archive"},
    FileKind{
        "\xD0\xCF\x11\xE0"sv,
        "an OLE file: if it is a Micro/WIN project (.mwp), open it in Micro/WIN and export each block (File, Export) as "
        ".awl; if it is a document (.doc), save it as plain text"},
};

/// The likely type of a file that is not text; empty for text.
std::string not_text(std::string_view bytes) {
  for (const FileKind& kind : kFileKinds) {
    if (bytes.starts_with(kind.beginning)) return kind.what;
  }
  if (bytes.find('\0') != bytes.npos) return "binary data (it has NUL bytes)";
  static constexpr ByteSet kOfText{"\t\n\r\f\x1A"};
  const auto controls =
      std::count_if(bytes.begin(), bytes.end(), [](char c) { return c >= 0 && c < 0x20 && !kOfText.has(c); });
  if (static_cast<std::size_t>(controls) * 10 > bytes.size()) return "binary data (it is full of control characters)";
  return {};
}

/// The byte order of UTF-16 without its mark: a program is mostly ASCII, so that every other byte is 0, and no character is
/// 0.
std::optional<ByteOrder> order_of_unmarked_utf16(std::string_view bytes) {
  if (bytes.find('\0') == bytes.npos) return {};
  std::array<std::size_t, 2> nulls{};
  for (std::size_t i = 0; i < bytes.size(); ++i) nulls[i % 2] += bytes[i] == '\0';
  if (bytes.size() % 2 != 0 || nulls[0] * nulls[1] != 0 || (nulls[0] + nulls[1]) * 3 < bytes.size()) return {};
  return nulls[0] != 0 ? ByteOrder::Big : nulls[1] != 0 ? std::optional(ByteOrder::Little) : std::nullopt;
}

/// The UTF-8 text with every unreadable byte replaced.
std::string repaired(std::string_view bytes) {
  std::string text;
  while (!bytes.empty()) {
    const Character c = first_character(bytes);
    const bool unreadable = c.code == kReplacement && c.bytes == 1;
    text += unreadable ? kReplacementText : bytes.substr(0, c.bytes);
    bytes.remove_prefix(c.bytes);
  }
  return text;
}

/// The bytes without an incomplete character at the end, which a cut leaves.
std::string_view without_cut_character(std::string_view bytes) {
  for (std::size_t length = 1; length <= std::min<std::size_t>(3, bytes.size()); ++length) {
    const std::uint8_t byte = byte_at(bytes, bytes.size() - length);
    if (byte >= 0xC2 && byte < 0xF5) return bytes.substr(0, bytes.size() - length);
    if (byte < 0x80) break;
  }
  return bytes;
}

/// UTF-8 with a little damage, such as a file cut off inside a character.
bool is_nearly_utf8(std::string_view bytes) {
  std::size_t read = 0;
  std::size_t unreadable = 0;
  for (const Character c : characters(without_cut_character(bytes))) {
    if (c.bytes > 1) ++read;
    if (c.bytes == 1 && c.code == kReplacement) ++unreadable;
  }
  return read > 20 * unreadable;
}

bool is_ascii_letter(std::string_view bytes, std::size_t index) { return index < bytes.size() && is_letter(bytes[index]); }

/// CP437 draws horizontal lines with C4 or CD; no other text has three of them in a row.
bool has_oem_box_drawing(std::string_view bytes) {
  return bytes.find("\xC4\xC4\xC4"sv) != std::string_view::npos || bytes.find("\xCD\xCD\xCD"sv) != std::string_view::npos;
}

/// Read as GBK, most pairs must be common characters (GB 2312 level 1) or punctuation. A pair inside an ASCII word is none.
bool looks_like_gbk(std::string_view bytes) {
  std::size_t common = 0;
  std::size_t other = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::uint8_t lead = byte_at(bytes, i);
    if (lead < 0x80) continue;
    const std::uint8_t trail = byte_at(bytes, ++i);
    const bool inside_word = i >= 2 && is_ascii_letter(bytes, i - 2) && is_ascii_letter(bytes, i + 1);
    const bool everyday = !inside_word && ((lead >= 0xB0 && lead <= 0xD7) || (lead >= 0xA1 && lead <= 0xA3));
    ++(everyday && trail >= 0xA1 && trail <= 0xFE ? common : other);
  }
  return common > 4 * other;
}

/// Read as Shift-JIS, most pairs must be kana or kanji of level 1. Pairs whose second byte is ASCII do not count: in CP437
/// these are German words.
bool looks_like_shift_jis(std::string_view bytes) {
  std::size_t common = 0;
  std::size_t other = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::uint8_t lead = byte_at(bytes, i);
    const bool half_width_kana = lead >= 0xA1 && lead <= 0xDF;
    if (lead < 0x80 || half_width_kana) continue;
    const std::uint8_t trail = byte_at(bytes, ++i);
    const bool everyday = lead >= 0x81 && lead <= 0x97;
    if (everyday && trail >= 0x80 && trail <= 0xFC)
      ++common;
    else if (!everyday || trail < 0x40)
      ++other;
  }
  return common >= 2 && common > 4 * other;
}

/// Letters of Cyrillic and Greek stand beside each other, those of Western Europe one by one between ASCII letters.
bool has_runs_of_letters(std::string_view bytes) {
  std::size_t in_runs = 0;
  std::size_t alone = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (byte_at(bytes, i) < 0xC0) continue;
    const bool beside = byte_at(bytes, i + 1) >= 0xC0 || (i > 0 && byte_at(bytes, i - 1) >= 0xC0);
    ++(beside ? in_runs : alone);
  }
  return in_runs > 4 * alone;
}

std::size_t count_within_words(std::string_view bytes, std::string_view letters) {
  std::size_t count = 0;
  for (std::size_t i = 1; i < bytes.size(); ++i)
    if (letters.find(bytes[i]) != std::string_view::npos && is_ascii_letter(bytes, i - 1)) ++count;
  return count;
}

/// Whether more bytes look like CP437 umlauts in German words than like Windows-1252 letters anywhere in a word.
bool has_cp437_words(std::string_view bytes) {
  std::size_t dos = 0;
  std::size_t windows = 0;
  for (std::size_t i = 1; i < bytes.size(); ++i) {
    const std::uint8_t byte = byte_at(bytes, i);
    const bool within = is_ascii_letter(bytes, i - 1) && is_ascii_letter(bytes, i + 1);
    const bool leading = i + 1 < bytes.size() && is_lower(bytes[i + 1]);
    if (within && (byte == 0x81 || byte == 0x84 || byte == 0x94 || byte == 0xE1)) ++dos;
    if (leading && (byte == 0x8E || byte == 0x99 || byte == 0x9A)) ++dos;
    if ((within || leading) && byte >= 0xC0 && byte != 0xE1) ++windows;
  }
  return dos > windows;
}

constexpr std::string_view kUtf8 = "UTF-8", kUtf16 = "UTF-16", kCp437 = "CP437", kGbk = "GBK", kShiftJis = "Shift-JIS",
                           kWindows1250 = "Windows-1250", kWindows1251 = "Windows-1251", kWindows1252 = "Windows-1252",
                           kWindows1253 = "Windows-1253", kWindows1254 = "Windows-1254";

/// The likely Windows code page, by letters that the other pages do not have, or that are common in only one language.
std::string_view guess_windows(std::string_view bytes) {
  if (has_runs_of_letters(bytes)) {
    const auto count = [&](char letter) { return std::count(bytes.begin(), bytes.end(), letter); };
    const auto cyrillic = count('\xE0') + count('\xEE'), greek = count('\xE1') + count('\xEF');  // а о, α ο
    return greek > cyrillic ? kWindows1253 : kWindows1251;
  }
  if (count_within_words(bytes, "\x9A\x9D\x9E\x9F\xB3\xB9\xBF"sv) > 0) return kWindows1250;  // š ť ž ź ł ą ż
  if (count_within_words(bytes, "\xF0\xFE"sv) > 0) return kWindows1254;                      // ğ ş
  return kWindows1252;
}

std::string_view guess_8_bit(std::string_view bytes) {
  if (has_oem_box_drawing(bytes)) return kCp437;
  if (looks_like_shift_jis(bytes)) return kShiftJis;
  if (looks_like_gbk(bytes)) return kGbk;
  if (has_cp437_words(bytes)) return kCp437;
  return guess_windows(bytes);
}

Result<DecodedText> decoded(std::string text, std::string_view encoding) {
  if (text.find('\0') != std::string::npos) return Trouble{"binary data, or UTF-32 text; save it as UTF-8"};
  return DecodedText{std::move(text), std::string(encoding)};
}

}  // namespace

Result<DecodedText> decode(std::string_view bytes) {
  if (auto text = from_marked_utf16(bytes)) return decoded(std::move(*text), kUtf16);
  if (const auto order = order_of_unmarked_utf16(bytes))
    if (std::string text = utf16_to_utf8(bytes, *order); not_text(text).empty()) return decoded(std::move(text), kUtf16);
  if (std::string why = not_text(bytes); !why.empty()) return Trouble{std::move(why)};
  if (bytes.ends_with('\x1A')) bytes.remove_suffix(1);  // the end mark of a DOS text
  const bool marked = bytes.starts_with("\xEF\xBB\xBF"sv);
  if (marked) bytes.remove_prefix(3);
  if (is_valid_utf8(bytes)) return DecodedText{std::string(bytes), std::string(kUtf8)};
  if (marked || is_nearly_utf8(bytes)) return DecodedText{repaired(bytes), std::string(kUtf8)};
  const std::string_view encoding = guess_8_bit(bytes);
  return decoded(to_utf8(bytes, *find_code_page(encoding)), encoding);
}

Result<std::string> read_decoded(const FileSource& files, const std::string& path) {
  const auto bytes = files.read(path);
  if (!bytes) return bytes.trouble();
  auto text = decode(*bytes);
  if (!text) return text.trouble();
  return std::move(text->text);
}

Result<std::string> encode(std::string_view utf8, std::string_view encoding) {
  if (encoding == kUtf8) return std::string(utf8);
  const CodePage* const page = find_code_page(encoding);
  if (page == nullptr && encoding != kUtf16) return trouble("{} is not an encoding that can be written", encoding);
  std::string bytes = page ? "" : "\xFF\xFE";
  for (const Character c : characters(utf8)) {
    const std::string written = page ? from_character(c.code, *page) : to_utf16(c.code);
    if (written.empty())
      return trouble("the character U+{:04X} does not exist in {}", static_cast<std::uint32_t>(c.code), encoding);
    bytes += written;
  }
  return bytes;
}

}  // namespace s7200::stl
