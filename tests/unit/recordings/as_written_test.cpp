// Logs, tables and dumps as programs and people write them, each read or refused with what to do.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

#include "serial_sim/modbus/crc.hpp"
#include "tools/recordings/conversation.hpp"
#include "tools/recordings/decoded.hpp"

namespace s7200::tools::as_written_test {
namespace {

const std::string kAsked = "station 1, read holding registers 40011, 2 of them", kSaid = "2 registers: 16#1234 16#5678";
const std::string kRequest = "01 03 00 0A 00 02 E4 09", kAnswer = "01 03 04 12 34 56 78 81 07";
constexpr Stamps kStamps{.character = 1'145'833};

LineRecording recording_of(const std::string& bytes) {
  auto recording = read_recording(bytes, {});
  EXPECT_TRUE(recording) << recording.why() << '\n' << bytes;
  return recording.value_or(LineRecording{});
}

std::string refusal_of(const std::string& bytes) { return read_recording(bytes, {}).why(); }

std::vector<ReadFrame> read(const std::string& bytes) {
  return conversation(recording_of(bytes), *find_recorded_protocol("modbus"), kStamps);
}

std::vector<std::string> texts(const std::string& bytes) {
  std::vector<std::string> said;
  for (const ReadFrame& frame : read(bytes)) said.push_back(frame.text);
  return said;
}

const std::vector<std::string> kConversation{kAsked, kSaid};

std::vector<Direction> directions(const std::string& bytes) {
  std::vector<Direction> all;
  for (const RecordedFrame& frame : recording_of(bytes).frames) all.push_back(frame.direction);
  return all;
}

const std::vector<Direction> kBoth{Direction::Request, Direction::Answer};

/// A text in UTF-16 without its mark.
std::string in_utf16(const std::string& text, bool big_endian) {
  std::string bytes;
  for (const char c : text) bytes += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
  return bytes;
}

// --- encodings ---

TEST(AsWritten, LogsOfChineseAndJapaneseProgramsKeepTheirFirstByte) {
  for (const auto& [sent, received] : {std::pair("\xB7\xA2\xCB\xCD\xA3\xBA", "\xBD\xD3\xCA\xD5\xA3\xBA"),     // GBK
                                       std::pair("\xB7\xA2\xA1\xFA\xA1\xF3", "\xCA\xD5\xA1\xFB\xA1\xF4"),     // SSCOM
                                       std::pair("\x91\x97\x90\x4D\x81\x46", "\x8E\xF3\x90\x4D\x81\x46")}) {  // Shift-JIS
    const std::string log = std::string("[10:00:00.100]") + sent + kRequest + "\n[10:00:00.140]" + received + kAnswer + "\n";
    EXPECT_EQ(texts(log), kConversation) << log;
  }
}

TEST(AsWritten, ALogInAnyEightBitEncodingHasItsDirections) {
  EXPECT_EQ(directions("R\xE9"
                       "ponse: " +
                       kAnswer + "\nRequ\xEAte: " + kRequest + "\n"),
            (std::vector{Direction::Answer, Direction::Request}));
}

TEST(AsWritten, AByteInAWordOfAnUnknownEncodingIsNotDroppedInSilence) {
  EXPECT_EQ(refusal_of("10:00:00.100 TX \xFF" + kRequest + "\n"),
            "no frames found; line 1: left out: cannot tell what '\uFFFD01' next to its bytes means");
}

TEST(AsWritten, Utf16WithoutItsMarkIsRead) {
  for (const bool big_endian : {false, true})
    EXPECT_EQ(texts(in_utf16("10:00:00.100 TX " + kRequest + "\r\n10:00:00.140 RX " + kAnswer + "\r\n", big_endian)),
              kConversation);
}

TEST(AsWritten, RecordedBytesAloneGetAnAdvice) {
  EXPECT_EQ(refusal_of(std::string("\x01\x03\0\x0A\0\x02\xE4\x09", 8)),
            "it is binary, and not a capture that decode knows; for recorded bytes alone, decode what xxd prints of it");
}

// --- other programs' output ---

TEST(AsWritten, WhatAnotherDecoderOfSigrokSaysIsNotRead) {
  const std::string advice = ", without the characters; print them with sigrok-cli -A uart";
  EXPECT_EQ(refusal_of("modbus-1: Slave ID: 17\nmodbus-1: Function 3: Read Holding Registers\n"),
            "it is what sigrok's decoder modbus says" + advice);
  EXPECT_EQ(refusal_of("100-200 lin-1: Sync\n200-300 lin-1: ID: 17\n"), "it is what sigrok's decoder lin says" + advice);
  EXPECT_EQ(texts("modbus-1: Slave ID: 1\nuart-1: 01\nuart-1: 03\nuart-1: 00\nuart-1: 0A\nuart-1: 00\nuart-1: 02\n"
                  "uart-1: E4\nuart-1: 09\n"),
            std::vector{kAsked})
      << "both decoders were printed";
}

TEST(AsWritten, SigrokNamesTheClassesOfItsAnnotations) {
  std::string rows = "0-10 uart-1: tx-start: Start bit\n";
  int sample = 0;
  const auto add = [&](const char* name, const std::string& hex) {
    for (std::size_t at = 0; at < hex.size(); at += 3, sample += 100)
      rows += fmt::format("{}-{} uart-1: {}: {}\n", sample, sample + 90, name, hex.substr(at, 2));
    sample += 2000;
  };
  add("tx-data", kRequest);
  add("rx-data", kAnswer);
  rows += "9000-9010 uart-1: rx-stop: Stop bit\n";
  EXPECT_EQ(texts(rows), kConversation);
  EXPECT_EQ(directions(rows), kBoth);
  EXPECT_EQ(directions("0-90 uart-1: rx-data: 01\n100-190 uart-1: rx-data: 03\n"), std::vector{Direction::Unknown})
      << "one wire";
}

TEST(AsWritten, FieldsOfPacketsWithoutTheirBytesAreNotRead) {
  EXPECT_EQ(refusal_of("Frame 1: 66 bytes on wire (528 bits), 66 bytes captured (528 bits)\n"
                       "    Frame Number: 1\n    Frame Length: 66 bytes (528 bits)\nEthernet II, Src: 00:00:00_00:00:00\n"),
            "it is the list of packets without their bytes; print them with tshark -x, or record with tshark -w FILE.pcap");
}

TEST(AsWritten, WiresharksPlainTextWithBytesIsRead) {
  const std::string rows =
      "0000  aa aa aa aa aa aa bb bb bb bb bb bb 08 00 45 00   ..............E.\n"
      "0010  00 34 00 01 00 00 40 06 00 00 0a 00 00 01 0a 00   .4....@.........\n"
      "0020  00 02 9c 40 01 f6 00 00 00 64 00 00 01 f4 50 18   ...@.....d....P.\n"
      "0030  03 e8 00 00 00 00 00 09 00 00 00 06 01 03 00 0a   ................\n"
      "0040  00 02                                             ..\n";
  const std::string names = "No.     Time           Source                Destination           Protocol Length Info\n",
                    line = "      1 0.250000       10.0.0.1              10.0.0.2              Modbus/TCP 66     Query\n";
  EXPECT_EQ(texts(names + line + "\n" + rows + "\n"), std::vector{kAsked});
  EXPECT_EQ(refusal_of(names + line),
            "it is Wireshark's list of packets without their bytes; save the capture itself, with File, Save As");
}

TEST(AsWritten, DurationsOfPortmonAreNoTimes) {
  const LineRecording log =
      recording_of("0\t0.00000559\tapp.exe\tIRP_MJ_WRITE\tSerial0\tSUCCESS\tLength 8: " + kRequest +
                   " \t\n1\t0.00000698\tapp.exe\tIRP_MJ_READ\tSerial0\tSUCCESS\tLength 9: " + kAnswer + " \t\n");
  ASSERT_EQ(log.frames.size(), 2U);
  EXPECT_FALSE(log.frames[0].at || log.frames[1].at);
  EXPECT_EQ(log.notes,
            std::vector<std::string>{"no times are known: Portmon wrote how long each call took; its option Clock "
                                     "Time shows when it was"});
}

// --- dumps ---

TEST(AsWritten, DumpsOfAFileAreRead) {
  const std::string xxd =
      "00000000: 0103 000a 0002 e409 0103 0412 3456 7881  ........xV4.....\n"
      "00000010: 07                                       .\n";
  for (const std::string& dump :
       {xxd, xxd.substr(0, xxd.rfind("0000")) + "00000010: 07\n",
        std::string("000000 01 03 00 0a 00 02 e4 09 01 03 04 12 34 56 78 81  >............4Vx.<\n"
                    "000010 07                                               >.<\n000011\n"),
        std::string("0000000 01 03 00 0a 00 02 e4 09 01 03 04 12 34 56 78 81\n0000020 07\n0000021\n"),  // octal
        std::string("0000000 01 03 00 0a 00 02 e4 09 01 03 04 12 34 56 78 81\n0000016 07\n0000017\n"),  // decimal
        std::string("0000000 001401 005000 001000 004744 001401 011004 053064 100570\n0000020 000007\n0000021\n"),
        std::string("0000000 0301 0a00 0200 09e4 0301 1204 5634 8178\n0000010 0007                                   \n"
                    "0000011\n"),  // hexdump
        std::string("00000000  01 03 00 0a 00 02 e4 09  01 03 04 12 34 56 78 81  |............4Vx.|\n"
                    "00000010  07                                                |.|\n00000011\n")})
    EXPECT_EQ(texts(dump), kConversation) << dump;
}

TEST(AsWritten, AStarInADumpStandsForRowsLikeTheLast) {
  const LineRecording dump = recording_of("0000000 00 00 00 00\n*\n0000014 01 02\n0000016\n");  // of od
  ASSERT_EQ(dump.frames.size(), 1U);
  EXPECT_EQ(dump.frames[0].bytes.size(), 14U);
  EXPECT_EQ(dump.frames[0].bytes.back(), 2U);
  EXPECT_EQ(recording_of("0000000 0000 0000\n*\n0000014 0201\n0000016\n").frames.at(0).bytes.size(), 22U) << "hexdump";
}

TEST(AsWritten, ADumpWithAHoleIsNone) { EXPECT_NE(refusal_of("0000000 01 03 00 0a 00 02 e4 09\n0000030 01 03\n"), ""); }

TEST(AsWritten, RowsOfOdBelowADirectionAreOneFrame) {
  const std::string log = "TX\n0000000 01 03 00 0a 00 02 e4 09\n0000010\nRX\n0000000 01 03 04 12 34 56 78 81 07\n0000011\n";
  EXPECT_EQ(texts(log), kConversation);
  EXPECT_EQ(directions(log), kBoth);
  EXPECT_EQ(texts("TX\n00000000: 0103 000a 0002 e409  ........\nRX\n00000000: 0103 0412 3456 7881 07  ....4Vx..\n"),
            kConversation);
}

// --- tables ---

TEST(AsWritten, ATableMayHaveAColumnForEachByte) {
  EXPECT_EQ(texts("Nr;Zeit;Richtung;B0;B1;B2;B3;B4;B5;B6;B7;B8\n1;10:00:00,100;TX;1;3;0;10;0;2;228;9;\n"
                  "2;10:00:00,140;RX;1;3;4;18;52;86;120;129;7\n"),
            kConversation);
  EXPECT_EQ(texts("Time,Dir,Byte 1,Byte 2,Byte 3,Byte 4,Byte 5,Byte 6,Byte 7,Byte 8\n0.1,TX,01,03,00,0A,00,02,E4,09\n"),
            std::vector{kAsked});
}

TEST(AsWritten, ACellMayHaveDecimalNumbers) {
  const std::string names = "Time;Dir;Bytes\n";
  EXPECT_EQ(texts(names + "10:00:00,100;TX;1 3 0 10 0 2 228 9\n10:00:00,140;RX;1 3 4 18 52 86 120 129 7\n"), kConversation);
  EXPECT_EQ(texts(names + "10:00:00,100;TX;1 3 0 A 0 2 E4 9\n"), std::vector{kAsked});
}

TEST(AsWritten, NumbersThatMayBeDecimalOrHexAreWhatMakesAFrame) {
  Bytes asked{1, 3, 0, 0x10, 0, 1};
  while (asked.size() < 8) {  // an address whose frame has only digits below A
    asked.resize(6);
    ++asked[5];
    modbus::add_crc(asked);
    const auto has_letter = [](std::uint8_t byte) { return byte % 16 > 9 || byte / 16 > 9; };
    if (std::any_of(asked.begin(), asked.end(), has_letter)) asked.resize(6);
  }
  std::string cell;
  for (const std::uint8_t byte : asked) cell += fmt::format("{:X} ", byte);
  const auto frames = read("Time;Dir;Bytes\n0.1;TX;" + cell + "\n");
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].frame.bytes, asked) << cell;
  EXPECT_TRUE(frames[0].right);
}

TEST(AsWritten, RowsOfATableWithoutBytesAreLeftOutOnce) {
  const LineRecording table =
      recording_of("Time\tDirection\tData\n10:00:00.100\tTX\t" + kRequest + "\n10:00:00.120\tTX\t\n" +
                   "10:00:00.130\tRX\t\n10:00:00.140\tRX\t" + kAnswer + "\n");
  EXPECT_EQ(table.frames.size(), 2U);
  EXPECT_EQ(table.notes, std::vector<std::string>{"line 3: left out, and 1 more: no bytes in it"});
}

// --- directions ---

TEST(AsWritten, InAndOutBesideTheBytesAreDirections) {
  for (const auto& [out, in] : {std::pair("OUT", "IN"), std::pair("Out ", "In  "), std::pair("out:", "in:")})
    EXPECT_EQ(directions(fmt::format("10:00:00.100 {} {}\n10:00:00.140 {} {}\n", out, kRequest, in, kAnswer)), kBoth) << in;
}

TEST(AsWritten, AnArrowBetweenNamesIsNoDirectionUnlessTheyAreMasterAndSlave) {
  for (const auto& [there, back] :
       {std::pair("M->S", "S->M"), std::pair("master --> slave", "slave --> master"), std::pair("S<-M", "M<-S")}) {
    const std::string log = fmt::format("0.100 {} {}\n0.140 {} {}\n", there, kRequest, back, kAnswer);
    EXPECT_EQ(directions(log), kBoth) << log;
    LineRecording recording = recording_of(log);
    settle_directions(recording, *find_recorded_protocol("modbus"), kStamps);
    EXPECT_EQ(recording.notes, std::vector<std::string>{}) << log;
  }
  EXPECT_EQ(directions("0.100 pc->plc " + kRequest + "\n0.140 plc->pc " + kAnswer + "\n"),
            (std::vector{Direction::Unknown, Direction::Unknown}));
}

// --- times ---

TEST(AsWritten, TimesAreReadAsTheyAreWritten) {
  for (const auto& [first, second] :
       {std::pair("08h15m01s100", "08h15m01s140"), std::pair("2024-03-05_08-15-01.100", "2024-03-05_08-15-01.140"),
        std::pair("@1100ms", "@1140ms"), std::pair("T=1100ms", "T=1140ms"), std::pair("time: 1.100 s", "time: 1.140 s"),
        std::pair("20240305T081501.100Z", "20240305T081501.140Z"), std::pair("20240305_081501.100", "20240305_081501.140"),
        std::pair("[+00:00:01.100]", "[+00:00:01.140]"), std::pair("Tx @08:15:01.100:", "Rx @08:15:01.140:"),
        std::pair("05.03.2024;08:15:01;100;TX;", "05.03.2024;08:15:01;140;RX;"),
        std::pair("2024-03-05T08:15:01.100+01:00", "2024-03-05T08:15:01.140+01:00"),
        std::pair("modbus: 2024/03/05 08:15:01.100 modbus: pdu", "modbus: 2024/03/05 08:15:01.140 modbus: pdu")}) {
    const auto frames = read(fmt::format("{} {}\n{} {}\n", first, kRequest, second, kAnswer));
    ASSERT_EQ(frames.size(), 2U) << first;
    EXPECT_EQ(frames[1].text, kSaid) << first;
    ASSERT_TRUE(frames[1].frame.at && frames[0].frame.at) << first;
    EXPECT_EQ(*frames[1].frame.at - *frames[0].frame.at, 40 * kMillisecond) << first;
  }
}

TEST(AsWritten, TheLineProtocolOfInfluxHasItsTimeAtTheEnd) {
  const auto frames = read(
      "modbus,dir=tx data=\"0103000A0002E409\" 1709626501100000000\n"
      "modbus,dir=rx data=\"010304123456788107\" 1709626501140000000\n");
  ASSERT_EQ(frames.size(), 2U);
  ASSERT_TRUE(frames[1].frame.at);
  EXPECT_EQ(*frames[1].frame.at, 40 * kMillisecond);
}

TEST(AsWritten, AWordLikeATimeThatIsNoneIsNotedOnce) {
  EXPECT_EQ(recording_of("08h15 TX " + kRequest + "\n08h15 RX " + kAnswer + "\n").notes,
            std::vector<std::string>{"line 1: read without a time, and 1 more: cannot read '08h15' as one"});
  EXPECT_EQ(recording_of("{\"time\":\"noon\",\"tx\":\"" + kRequest + "\"}\n{\"time\":\"noon\",\"rx\":\"" + kAnswer + "\"}\n")
                .notes,
            std::vector<std::string>{"line 1: cannot read 'noon' as its time, and 1 more like it"});
}

// --- JSON ---

TEST(AsWritten, NamesOfDirectionsHaveBase64AndEscapes) {
  EXPECT_EQ(texts("{\"time\":1.1,\"tx\":\"AQMACgAC5Ak=\"}\n{\"time\":1.14,\"rx\":\"AQMEEjRWeIEH\"}\n"), kConversation);
  EXPECT_EQ(texts(R"({"msg":"tx","frame":"\\x01\\x03\\x00\\x0a\\x00\\x02\\xe4\\x09"})"
                  "\n"
                  R"({"msg":"rx","frame":"\\x01\\x03\\x04\\x12\\x34\\x56\\x78\\x81\\x07"})"
                  "\n"),
            kConversation);
}

// --- bytes that other languages and tools write ---

std::string log(const std::string& request, const std::string& answer) {
  return "10:00:00.100 TX " + request + "\n10:00:00.140 RX " + answer + "\n";
}

/// The bytes of a frame in a notation: `before`, the digits as `form` has them, `between`.
std::string written(const std::string& hex, fmt::format_string<int> form, const std::string& between) {
  std::string text;
  for (std::size_t i = 0; i < hex.size(); i += 3)
    text += (i == 0 ? "" : between) + fmt::format(form, std::stoi(hex.substr(i, 2), nullptr, 16));
  return text;
}

TEST(AsWritten, TheFirstByteOfAListInALanguageIsOne) {
  const auto in_go = [](const std::string& hex) { return "[]byte{" + written(hex, "0x{:x}", ", ") + "}"; };
  EXPECT_EQ(texts(log(in_go(kRequest), in_go(kAnswer))), kConversation);
  const auto in_slice = [](const std::string& hex) { return "slice{" + written(hex, "0x{:02x}", ", ") + "}"; };
  EXPECT_EQ(texts(log(in_slice(kRequest), in_slice(kAnswer))), kConversation);
}

TEST(AsWritten, NotationsOfLanguagesAreRead) {
  for (const auto& between : {":", "_", ".", "/", "|"})
    EXPECT_EQ(texts(log(written(kRequest, "{:02X}", between), written(kAnswer, "{:02X}", between))), kConversation)
        << between;
  EXPECT_EQ(texts(log(written(kRequest, "x{:02X}", " "), written(kAnswer, "x{:02X}", " "))), kConversation);
  EXPECT_EQ(texts(log(written(kRequest, "%{:02X}", ""), written(kAnswer, "%{:02X}", ""))), kConversation);
  EXPECT_EQ(texts(log(written(kRequest, "\\u{:04X}", ""), written(kAnswer, "\\u{:04X}", ""))), kConversation);
  EXPECT_EQ(texts(log('"' + written(kRequest, "\\{:03o}", "") + '"', '"' + written(kAnswer, "\\{:03o}", "") + '"')),
            kConversation);
  EXPECT_EQ(texts(log("{length = 8, bytes = 0x0103000a0002e409}", "{length = 9, bytes = 0x010304123456788107}")),
            kConversation);
}

TEST(AsWritten, CharactersOfJsonAreBytesUpToFF) {
  EXPECT_EQ(texts(R"({"t":1.1,"dir":"tx","data":"\u0001\u0003\u0000\n\u0000\u0002\u00e4\t"})"
                  "\n"
                  R"({"t":1.14,"dir":"rx","data":"\u0001\u0003\u0004\u00124Vx\u0081\u0007"})"
                  "\n"),
            kConversation);
  EXPECT_NE(refusal_of(R"({"t":1.1,"dir":"tx","data":"\u0001\u0003\ufffd\u0007"})"
                       "\n"),
            "");
}

TEST(AsWritten, PartsOfAFrameInFieldsOrColumnsOfTheirOwnAreOneFrame) {
  EXPECT_EQ(
      texts(
          "10:00:00.100 TX addr=01 fc=03 data=000A0002 crc=E409\n10:00:00.140 RX addr=01 fc=03 data=0412345678 crc=8107\n"),
      kConversation);
  EXPECT_EQ(texts("Time,Dir,Addr,Func,Data,CRC\n10:00:00.100,TX,01,03,00 0A 00 02,E4 09\n10:00:00.140,RX,01,03,04 12 34 56 "
                  "78,81 07\n"),
            kConversation);
  EXPECT_EQ(texts(log("01 03 00 0A 00 02 CRC: E4 09", "01 03 04 12 34 56 78 CRC: 81 07")), kConversation);
  EXPECT_EQ(texts(log(kRequest + " CRC: E4 09", kAnswer + " CRC: 81 07")), kConversation) << "once more";
}

TEST(AsWritten, ARowOfATableMayHaveTheRequestAndItsAnswer) {
  EXPECT_EQ(texts("Time,Request,Response\n10:00:00.100," + kRequest + "," + kAnswer + "\n"), kConversation);
}

TEST(AsWritten, ARowWithTwoFramesIsNotOneOfThem) {
  for (const ReadFrame& frame : read(kRequest + "  ->  " + kAnswer + "\n10:00:00 TX " + kRequest + "\n"))
    EXPECT_NE(frame.text, "an answer without its request");
  EXPECT_NE(refusal_of(kRequest + "  ->  " + kAnswer + "\n").find("'->'"), std::string::npos);
}

TEST(AsWritten, NumbersAndNamesBesideFramesAreNoBytes) {
  EXPECT_EQ(texts(log(kRequest, kAnswer) + "uuid 123e4567-e89b-12d3-a456-426614174000\nValue 0: 4660\n"), kConversation);
  const auto recording = recording_of(log(kRequest, kAnswer) + "10:00:00.200 state AB CD\n");
  ASSERT_EQ(recording.frames.size(), 3U);
  EXPECT_TRUE(recording.frames[2].doubt);
  EXPECT_EQ(texts(log("8B " + kRequest, "9B " + kAnswer)), kConversation);
  EXPECT_EQ(texts("#1 TX " + kRequest + "\n#2 RX " + kAnswer + "\n# a comment\n"), kConversation);
}

TEST(AsWritten, WhatASpreadsheetHasKeptAsTextIsReadAndWhatItHasRoundedIsNot) {
  EXPECT_EQ(texts("Time;Dir;Data\n10:00:00.100;TX;'0103000A0002E409\n10:00:00.140;RX;=\"010304123456788107\"\n"),
            kConversation);
  EXPECT_NE(refusal_of("Time;Dir;Data\n10:00:00.100;TX;1,03E+11\n").find("as text"), std::string::npos);
}

TEST(AsWritten, DumpsOfEspIdfAndArraysOfWiresharkHaveTheirFrames) {
  EXPECT_EQ(texts("I (1100) MB_TX: 0x3ffb1234   01 03 00 0a 00 02 e4 09                           |........|\n"
                  "I (1140) MB_RX: 0x3ffb1234   01 03 04 12 34 56 78 81 07                        |....4Vx..|\n"),
            kConversation);
  EXPECT_EQ(
      texts("/* Packet 1 */\nstatic const unsigned char peer0_0[] = { /* Packet 1 */\n0x00, 0x01, 0x00, 0x00, 0x00, 0x06, "
            "0x01, 0x03, \n0x00, 0x0a, 0x00, 0x02 };\nchar peer1_0[] = { /* Packet 2 */\n0x00, 0x01, 0x00, 0x00, 0x00, "
            "0x07, 0x01, 0x03, \n0x04, 0x12, 0x34, 0x56, 0x78 };\n"),
      kConversation);
  EXPECT_EQ(refusal_of("\x1F\x8B\x08" + std::string(3, '\0')), "it is compressed with gzip: gunzip it first");
}

// --- what frames are called ---

TEST(AsWritten, ACutAnswerIsNoRequestAndARepeatedRequestNoAnswer) {
  EXPECT_EQ(texts("0.100 TX " + kRequest + "\n0.140 RX 01 03 04 12 34 56\n").at(1),
            "an answer that is cut off: 6 of 9 bytes");
  EXPECT_EQ(texts("0.100 TX 01 03 00 0A 00 02\n1.100 TX 01 03 00 0A 00 02\n"),
            (std::vector<std::string>{"a request without its CRC", "a request without its CRC"}));
}

TEST(AsWritten, AnEchoInTheRowOfItsAnswerTakesNoTimeAfterTheRequest) {
  const auto glued = read("10:00:00.000 > " + kRequest + "\n10:00:00.031 < " + kRequest + " " + kAnswer + "\n");
  ASSERT_EQ(glued.size(), 3U);
  EXPECT_TRUE(glued[1].echo);
  const auto plain = read("10:00:00.000 > " + kRequest + "\n10:00:00.031 < " + kAnswer + "\n");
  EXPECT_EQ(glued[2].latency, plain.at(1).latency);
  EXPECT_TRUE(glued[2].latency);
  const auto in_pieces =
      read("10:00:00.000 > " + kRequest + "\n10:00:00.010 < 01 03 00\n10:00:00.013 < 0A 00 02 E4 09 01 03 04 " +
           "12\n10:00:00.040 < 34 56 78 81 07\n");
  ASSERT_EQ(in_pieces.size(), 3U);
  EXPECT_EQ(in_pieces[2].latency, 10 * kMillisecond) << "the echo took its time since the first row";
}

}  // namespace
}  // namespace s7200::tools::as_written_test
