#include "interpreter/stl/text/encoding.hpp"

#include <gtest/gtest.h>
#include <iconv.h>

#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/text/code_pages.hpp"

namespace s7200::stl::encoding_test {
namespace {

using namespace std::string_literals;

DecodedText decoded(const std::string& bytes) {
  const auto result = decode(bytes);
  EXPECT_TRUE(result.has_value()) << result.why();
  EXPECT_TRUE(result.why().empty()) << result.why();
  return result.value_or(DecodedText{});
}

std::string refused(const std::string& bytes) { return decode(bytes).why(); }

TEST(Encoding, TakesValidUtf8AsItIsAndDropsTheByteOrderMark) {
  EXPECT_EQ(decoded("NOT // für\n").text, "NOT // für\n");
  EXPECT_EQ(decoded("\xEF\xBB\xBFNOT").text, "NOT");
  EXPECT_EQ(decoded("").encoding, "UTF-8");
}

TEST(Encoding, Utf8CutOffInACharacterIsStillUtf8) {
  const DecodedText result = decoded("NOT // für die Tür \xE2\x80");
  EXPECT_EQ(result.encoding, "UTF-8");
  EXPECT_EQ(result.text, "NOT // für die Tür \uFFFD\uFFFD");
}

TEST(Encoding, ReadsUtf16OfBothByteOrders) {
  EXPECT_EQ(decoded("\xFF\xFEN\0O\0T\0 \0\xFC\0"s).text, "NOT ü");
  EXPECT_EQ(decoded("\xFE\xFF\0N\0O\0T\0 \0\xFC"s).text, "NOT ü");
  EXPECT_EQ(decoded("\xFF\xFEN\0O\0T"s).text, "NO\uFFFD");
  EXPECT_EQ(decoded("\xFF\xFEN\0"s).encoding, "UTF-16");
}

TEST(Encoding, ReadsUtf16WithoutItsMarkWhereEveryOtherByteIs0) {
  EXPECT_EQ(decoded("N\0O\0T\0 \0\xFC\0"s).text, "NOT ü");
  EXPECT_EQ(decoded("\0N\0O\0T\0 \0\xFC"s).text, "NOT ü");
  EXPECT_EQ(decoded("N\0O\0T\0"s).encoding, "UTF-16");
}

TEST(Encoding, RecognisesWindows1252) {
  const DecodedText result = decoded("LD I0.0 // St\xF6rung l\xF6schen, T\xFCr auf\nA I0.1 // gr\xFCn\n");
  EXPECT_EQ(result.encoding, "Windows-1252");
  EXPECT_EQ(result.text, "LD I0.0 // Störung löschen, Tür auf\nA I0.1 // grün\n");
  EXPECT_EQ(decoded("NOT // caf\xE9 \x96 d\xE9j\xE0 \x81").text, "NOT // café – déjà \uFFFD");
}

TEST(Encoding, RecognisesCp437ByItsDrawingsAndItsUmlauts) {
  const DecodedText drawing = decoded("    \xB3 I0.0      Q0.0\n1   \xC3\xC4\xC4\xC4\xB4 \xC3\xC4\xC4\xC4( )\n");
  EXPECT_EQ(drawing.encoding, "CP437");
  EXPECT_EQ(drawing.text, "    │ I0.0      Q0.0\n1   ├───┤ ├───( )\n");
  const DecodedText words = decoded("LD I0.0 // St\x94rung l\x94schen, T\x81r auf\n");
  EXPECT_EQ(words.encoding, "CP437");
  EXPECT_EQ(words.text, "LD I0.0 // Störung löschen, Tür auf\n");
}

/// A text in another encoding, by the converter of the system.
std::string converted(std::string bytes, const char* from, const char* to) {
  const iconv_t converter = iconv_open(to, from);
  std::string text(4 * bytes.size(), '\0');
  char *source = bytes.data(), *target = text.data();
  std::size_t left = bytes.size(), room = text.size();
  EXPECT_NE(iconv(converter, &source, &left, &target, &room), static_cast<std::size_t>(-1)) << from;
  iconv_close(converter);
  text.resize(text.size() - room);
  return text;
}

TEST(Encoding, RecognisesTheCodePagesOfWindowsAndShiftJis) {
  struct Row {
    const char *name, *iconv_name, *text;
  };
  for (const Row& row : {
           Row{"Windows-1250", "WINDOWS-1250", "LD I0.0 // czujnik wysokiego poziomu, załączony\n"},
           Row{"Windows-1250", "WINDOWS-1250", "LD I0.0 // čerpadlo běží, ventil uzavřen, nejvyšší hladina\n"},
           Row{"Windows-1251", "WINDOWS-1251", "LD I0.0 // Насос включён, верхний уровень\n"},
           Row{"Windows-1252", "WINDOWS-1252", "LD I0.0 // Störung, größer als à côté, niño, più\n"},
           Row{"Windows-1253", "WINDOWS-1253", "LD I0.0 // αντλία σε λειτουργία, υψηλή στάθμη\n"},
           Row{"Windows-1254", "WINDOWS-1254", "LD I0.0 // düğme basılı, işlem başladı\n"},
           Row{"Shift-JIS", "CP932", "LD I0.0 // ポンプ運転中、水位が高い\n"},
           Row{"GBK", "GBK", "LD I0.0 // 水泵运行,高水位开关\n"},
       }) {
    const DecodedText result = decoded(converted(row.text, "UTF-8", row.iconv_name));
    EXPECT_EQ(result.encoding, row.name);
    EXPECT_EQ(result.text, row.text);
  }
}

TEST(Encoding, AMicroWinProjectIsRefusedWithWhatToDo) {
  EXPECT_NE(refused("\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1"s + std::string(600, '\0')).find("export each block"),
            std::string::npos);
}

TEST(Encoding, RecognisesGbk) {
  const DecodedText result = decoded("LD I0.0 //\xC6\xF4\xB6\xAF\xB5\xE7\xBB\xFA\n");
  EXPECT_EQ(result.encoding, "GBK");
  EXPECT_EQ(result.text, "LD I0.0 //启动电机\n");
}

TEST(Encoding, DropsTheEndMarkOfADosFile) { EXPECT_EQ(decoded("NOT\r\n\x1A").text, "NOT\r\n"); }

TEST(Encoding, NamesWhatIsNotText) {
  EXPECT_NE(refused("\x89PNG\r\n\x1A\n\0\0"s).find("PNG"), std::string::npos);
  EXPECT_NE(refused("\xFF\xD8\xFF\xE0"s).find("JPEG"), std::string::npos);
  EXPECT_NE(refused("PK\x03\x04"s).find("ZIP"), std::string::npos);
  EXPECT_NE(refused("%PDF-1.4"s).find("PDF"), std::string::npos);
  EXPECT_NE(refused("\x7F"
                    "ELF\x02"s)
                .find("ELF"),
            std::string::npos);
  EXPECT_NE(refused("\xD0\xCF\x11\xE0\xA1"s).find("OLE"), std::string::npos);
  EXPECT_NE(refused("NOT and then\0"s).find("NUL"), std::string::npos);
  EXPECT_NE(refused("N\0O\0\0T"s).find("NUL"), std::string::npos);
  EXPECT_NE(refused("\x01\0\x02\0\x03\0"s).find("NUL"), std::string::npos);
  EXPECT_NE(refused("\xFF\xFE\0\0N\0\0\0"s).find("UTF-32"), std::string::npos);
  EXPECT_NE(refused("\x01\x02\x03\x04").find("control"), std::string::npos);
}

TEST(Encoding, GivesValidUtf8ForAnyBytes) {
  for (int i = 0; i < 65536; ++i) {
    const std::string bytes{'A', static_cast<char>(i >> 8), static_cast<char>(i), 'z'};
    const auto first = decode(bytes);
    if (!first) continue;
    const auto again = decode(first->text);
    ASSERT_TRUE(again.has_value()) << i;
    ASSERT_EQ(again->text, first->text) << i;
  }
}

TEST(Encoding, WritesWhatItReads) {
  const std::string text = "NOT // f\u00FCr\n";
  for (const char* encoding : {"UTF-8", "UTF-16", "Windows-1252", "CP437"}) {
    const auto bytes = encode(text, encoding);
    ASSERT_TRUE(bytes) << encoding << ": " << bytes.why();
    EXPECT_EQ(decoded(*bytes).text, text) << encoding;
  }
}

TEST(Encoding, UnpairedSurrogatesOfUtf16BecomeReplacements) {
  EXPECT_EQ(decoded("\xFF\xFE\x3D\xD8\x00\xDE!\0"s).text, "\U0001F600!");
  EXPECT_EQ(decoded("\xFF\xFE\x3D\xD8!\0"s).text, "\uFFFD!");
  EXPECT_EQ(decoded("\xFF\xFE\x00\xDE!\0"s).text, "\uFFFD!");
  EXPECT_EQ(encode("\U0001F600", "UTF-16"), "\xFF\xFE\x3D\xD8\x00\xDE"s);
}

// The tables are Python's; the system's converter is another source. Shift-JIS has some characters twice.
TEST(Encoding, CodePagesAreThoseOfTheSystemsConverter) {
  std::size_t compared = 0;
  for (const auto& [name, iconv_name] :
       {std::pair{"Windows-1250", "WINDOWS-1250"}, std::pair{"Windows-1251", "WINDOWS-1251"},
        std::pair{"Windows-1252", "WINDOWS-1252"}, std::pair{"Windows-1253", "WINDOWS-1253"},
        std::pair{"Windows-1254", "WINDOWS-1254"}, std::pair{"CP437", "CP437"}, std::pair{"GBK", "GBK"},
        std::pair{"Shift-JIS", "CP932"}}) {
    const CodePage& page = *find_code_page(name);
    for (char32_t c = 0x80; c < 0xFFFD; ++c) {
      const std::string bytes = from_character(c, page);
      if (bytes.empty()) continue;
      EXPECT_EQ(to_utf8(bytes, page), to_utf8(c)) << name;
      EXPECT_EQ(converted(bytes, iconv_name, "UTF-8"), to_utf8(c)) << name << " U+" << std::hex << static_cast<unsigned>(c);
      ++compared;
    }
  }
  EXPECT_GT(compared, 29'000U);
}

TEST(Encoding, ACharacterThatTheEncodingLacksIsNamed) {
  std::string why = encode("NOT // \u4E2D\n", "Windows-1252").why();
  EXPECT_EQ(why, "the character U+4E2D does not exist in Windows-1252");
  EXPECT_EQ(encode("NOT", "EBCDIC").why(), "EBCDIC is not an encoding that can be written");
}

}  // namespace
}  // namespace s7200::stl::encoding_test
