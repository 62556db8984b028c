// What the rows of a log are together: frames in pieces, echoes, numbers that are no bytes, transactions of Modbus TCP.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "serial_sim/line/frame.hpp"
#include "serial_sim/modbus/crc.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tools/recordings/decoded.hpp"
#include "tools/recordings/playback.hpp"

namespace s7200::tools::rows_test {
namespace {

const std::string kAsked = "station 1, read holding registers 40011, 2 of them", kSaid = "2 registers: 16#1234 16#5678";

LineRecording recording_of(const std::string& bytes) {
  auto recording = read_recording(bytes, {});
  EXPECT_TRUE(recording) << recording.why() << '\n' << bytes;
  return recording.value_or(LineRecording{});
}

std::string refusal_of(const std::string& bytes) { return read_recording(bytes, {}).why(); }

std::vector<ReadFrame> read(const std::string& bytes, const Stamps& stamps = {.character = 1'145'833},
                            std::string_view protocol = "modbus") {
  return conversation(recording_of(bytes), *find_recorded_protocol(protocol), stamps);
}

std::vector<std::string> texts(const std::vector<ReadFrame>& frames) {
  std::vector<std::string> said;
  for (const ReadFrame& frame : frames) said.push_back(frame.text);
  return said;
}

std::vector<std::string> notes(const std::vector<ReadFrame>& frames) {
  ConversationNotes notes;
  for (const ReadFrame& frame : frames) notes.add(frame);
  return notes.list();
}

std::string summary(const std::vector<ReadFrame>& frames) {
  DecodedSummary summary;
  for (const ReadFrame& frame : frames) summary.add(frame);
  return summary.text();
}

// --- frames in pieces ---

/// The bytes in hex, cut after the bytes whose bit is set in `cuts`.
std::vector<std::string> cut_at(const Bytes& bytes, unsigned cuts) {
  std::vector<std::string> pieces{""};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    pieces.back() += fmt::format("{}{:02x}", pieces.back().empty() ? "" : " ", bytes[i]);
    if ((cuts >> i & 1U) != 0 && i + 1 < bytes.size()) pieces.emplace_back();
  }
  return pieces;
}

TEST(RowsOfALog, AnAnswerMayBeCutAnywhere) {
  const Bytes values = modbus::rtu_frame(11, Bytes{3, 4, 0x0B, 0xB8, 0xFF, 0xFE});
  const Bytes exception = modbus::rtu_frame(11, Bytes{0x83, 2});
  const Bytes counts = modbus::rtu_frame(1, Bytes{3, 4, 0x02, 0x11, 0x10, 0x03});  // pieces seem to count their bytes
  for (const Bytes& answer : {values, exception, counts})
    for (unsigned cuts = 0; cuts < 1U << (answer.size() - 1); ++cuts)
      for (const bool timed : {true, false}) {
        const Bytes request = modbus::rtu_frame(answer[0], Bytes{3, 0, 99, 0, 2});
        const auto pieces = cut_at(answer, cuts);
        std::string log = fmt::format("{}TX {}\n", timed ? "10:00:00.000 " : "", serial::to_hex(request));
        for (std::size_t i = 0; i < pieces.size(); ++i)
          log += fmt::format("{}RX {}\n", timed ? fmt::format("10:00:00.{:03} ", 20 + 9 * i) : "", pieces[i]);
        const auto frames = read(log);
        ASSERT_EQ(frames.size(), 2U) << log;
        EXPECT_EQ(frames[1].frame.bytes, answer) << log;
        EXPECT_TRUE(frames[1].right) << log;
        EXPECT_EQ(frames[1].pieces, pieces.size()) << log;
      }
}

TEST(RowsOfALog, ALongAnswerMayHaveARowForEachByte) {
  Bytes pdu{3, 0xFA};
  for (std::uint8_t i = 0; i < 0xFA; ++i) pdu.push_back(i);
  const Bytes answer = modbus::rtu_frame(5, pdu);
  std::string log = "TX " + serial::to_hex(modbus::rtu_frame(5, Bytes{3, 0, 0, 0, 125})) + "\n";
  for (const std::uint8_t byte : answer) log += fmt::format("RX {:02X}\n", byte);
  const auto frames = read(log);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].pieces, answer.size());
  EXPECT_TRUE(frames[1].right);
}

TEST(RowsOfALog, RowsWithoutTimeAndDirectionGoOnWithTheFrameAboveThem) {
  Bytes pdu{3, 40};
  for (std::uint8_t i = 0; i < 40; ++i) pdu.push_back(static_cast<std::uint8_t>(0xC0 + i));
  const std::string hex = serial::to_hex(modbus::rtu_frame(5, pdu));
  const std::string request = serial::to_hex(modbus::rtu_frame(5, Bytes{3, 0, 0, 0, 20}));
  for (const std::string indent : {"", "                 ", "\t"})
    for (const std::size_t width : {15U, 48U, 72U}) {  // of three characters each
      std::string log = "14:11:10.000 TX: " + request + "\n14:11:10.040 RX: " + hex.substr(0, width);
      for (std::size_t at = width; at < hex.size(); at += width) log += '\n' + indent + hex.substr(at, width);
      const auto frames = read(log + "\n14:11:11.000 TX: " + request + "\n");
      ASSERT_EQ(frames.size(), 3U) << log;
      EXPECT_TRUE(frames[1].right) << log;
      EXPECT_EQ(frames[1].frame.place, "line 2");
      EXPECT_EQ(frames[2].direction, Direction::Request);
    }
}

TEST(RowsOfALog, ARowOfWordsBetweenRequestAndAnswerIsNamedAndTheExchangeIsAnswered) {
  for (const std::string words : {"$GPGGA,12,34", "$GPRMC,123519,A,1,2,3,4", "!AIVDM,1,1"}) {
    const auto frames = read("10:00:00.000 [MODBUS] Send: 01 03 00 0a 00 02 e4 09\n10:00:00.100 [GPS] Recv: " + words +
                             "\n10:00:00.130 [MODBUS] Receive: 01 03 04 12 34 56 78 81 07\n");
    ASSERT_EQ(frames.size(), 3U) << words;
    EXPECT_EQ(frames[1].text, "not read: '" + words + "' is not understood");
    EXPECT_FALSE(frames[1].may_be_answer);
    EXPECT_EQ(frames[2].text, kSaid);
    EXPECT_EQ(frames[2].other, 0U);
  }
}

TEST(RowsOfALog, ValuesWithNamesAreNotBytes) {
  for (const std::string line :
       {"2021-03-24 14:11:10 register 40001 = 1234", "address = 40001, value = 1234", "counter = 12345678", "D100 = 0042",
        "D100: 0042", "sensor.temp 2024-01-01T10:00:00 21", "10:00:02 error code 0x86", "10:00:00 temperature: 21",
        "time=10:00:00 level=info temp=21 data=42", "crc = 34BF", "10:00:00 GPS,12,34"})
    EXPECT_EQ(refusal_of(line + '\n'), "no frames found; line 1: left out: no bytes in it") << line;
}

TEST(RowsOfALog, ATableOfValuesHasNoBytes) {
  for (const std::string table :
       {"time,temp,pressure\n10:00:00,21,35\n10:00:01,22,36\n", "Time;Level\n10:00:00;21\n10:00:01;22\n"})
    EXPECT_TRUE(refusal_of(table).starts_with("no column found for the bytes: name it Hex")) << table;
}

TEST(RowsOfALog, BytesWithNamesAreBytes) {
  for (const std::string line : {"data = 0103", "10:00:00 tx: 01", "COM3: 21", "10:00:00 rx_data = 0x86", "frame: 12",
                                 "/dev/ttyUSB0: 12", "hex 0x86"})
    EXPECT_EQ(recording_of(line + '\n').frames.size(), 1U) << line;
}

TEST(RowsOfALog, ARequestAndItsAnswerInOneRowHaveNoLatency) {
  const auto frames = read("10:00:00.040 01 03 00 0a 00 02 e4 09 01 03 04 12 34 56 78 81 07\n");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].other, 0U);
  EXPECT_EQ(frames[1].latency, std::nullopt);
  EXPECT_EQ(frames[1].silence, std::nullopt);
}

TEST(RowsOfALog, TimesWithAPlusSignCountFromTheRowAbove) {
  for (const char* const form : {"+{}", "[+{}]", "+{} s"}) {
    std::string log;
    for (const char* const row : {"0.000 TX 01 03 00 0a 00 02 e4 09", "0.037 RX 01 03 04 12 34 56 78 81 07",
                                  "0.963 TX 01 03 00 0a 00 02 e4 09", "0.040 RX 01 03 04 12 34 56 78 81 07"}) {
      const std::string_view text = row;
      log += fmt::format(fmt::runtime(form), text.substr(0, 5)) + std::string(text.substr(5)) + '\n';
    }
    const auto recording = recording_of(log);
    ASSERT_EQ(recording.frames.size(), 4U) << log;
    EXPECT_EQ(recording.frames[2].at, kSecond) << log;
    EXPECT_EQ(recording.frames[3].at, 1'040 * kMillisecond) << log;
    EXPECT_EQ(recording.notes, std::vector<std::string>{"its times have a plus sign: each counts from the row above"});
  }
}

TEST(RowsOfALog, AMinusAmongTimesWithAPlusSignIsARowBeforeTheOneAbove) {
  const auto recording = recording_of(
      "+0.000 TX 01 03 00 0a 00 02 e4 09\n+0.037 RX 01 03 04 12 34 56 78 81 07\n"
      "-0.005 TX 01 03 00 0a 00 02 e4 09\n+0.040 RX 01 03 04 12 34 56 78 81 07\n");
  ASSERT_EQ(recording.frames.size(), 4U);
  EXPECT_EQ(recording.frames[3].at, 72 * kMillisecond);
  EXPECT_EQ(recording.notes.back(), "line 3: its time is before that of the frame above it; no silence is known there");
  const auto triggered = recording_of("-0.005 TX 01 03 00 0a 00 02 e4 09\n+0.040 RX 01 03 04 12 34 56 78 81 07\n");
  EXPECT_EQ(triggered.frames.at(1).at, 45 * kMillisecond) << "times around a trigger";
  EXPECT_TRUE(triggered.notes.empty());
}

TEST(RowsOfALog, TimesHaveManyNotations) {
  for (const auto& [asked, said] : std::initializer_list<std::pair<std::string, std::string>>{
           {"24 Mar 14:11:10.000 - ", "24 Mar 14:11:10.040 - "},
           {"24 Mar 2021 14:11:10.000: ", "24 Mar 2021 14:11:10.040: "},
           {"24-Mar-21 14:11:10.000 ", "24-Mar-21 14:11:10.040 "},
           {"[24/Mar/2021:14:11:10.000] ", "[24/Mar/2021:14:11:10.040] "},
           {"\"14:11:10,000\";", "\"14:11:10,040\";"},
           {"\"14:11:10.000\", ", "\"14:11:10.040\", "},
           {"00:12.345 ", "00:12.385 "},
           {"[59:59,980] ", "[60:00,020] "},
           {"2021-03-24T14:11:10.000Z ", "2021-03-24T14:11:10.040Z "},
           {"2021-03-24T14:11:10.000+01:00 ", "2021-03-24T14:11:10.040+01:00 "},
           {"1616595070.000 ", "1616595070.040 "}}) {
    const auto frames = read(asked + "TX 01 03 00 0a 00 02 e4 09\n" + said + "RX 01 03 04 12 34 56 78 81 07\n");
    ASSERT_EQ(frames.size(), 2U) << asked;
    EXPECT_EQ(frames[1].text, kSaid) << asked;
    ASSERT_TRUE(frames[1].frame.at) << asked;
    EXPECT_EQ(*frames[1].frame.at, 40 * kMillisecond) << asked;
  }
}

TEST(RowsOfALog, ATimeMayHaveWordsBeforeIt) {
  for (const auto& [asked, said] : std::initializer_list<std::pair<std::string, std::string>>{
           {"[COM1] 09:15:02.000 >> ", "[COM1] 09:15:02.040 << "},
           {"DEBUG 2026-11-28 09:15:02,000 TX: ", "DEBUG 2026-11-28 09:15:02,040 RX: "},
           {"TX 09:15:02.000 ", "RX 09:15:02.040 "},
           {"info: serial tx [09:15:02.000] ", "info: serial rx [09:15:02.040] "},
           {"000001: Bytes written, 2026-11-28 09:15:02.0000000 +0.0000000 (1. Device: Port (COM3))\n   ",
            "000002: Bytes read, 2026-11-28 09:15:02.0400000 +0.0400000\n   "}}) {
    const auto frames = read(asked + "01 03 00 0a 00 02 e4 09\n" + said + "01 03 04 12 34 56 78 81 07\n");
    ASSERT_EQ(frames.size(), 2U) << asked;
    EXPECT_EQ(frames[0].direction, Direction::Request) << asked;
    EXPECT_EQ(frames[1].text, kSaid) << asked;
    ASSERT_TRUE(frames[1].frame.at) << asked;
    EXPECT_EQ(*frames[1].frame.at, 40 * kMillisecond) << asked;
  }
}

TEST(RowsOfALog, ALoggerMayWriteItsTimeInALineAboveEachRow) {
  const auto frames = read(
      "28.11.2026 09:15:02.000 net.ModbusRTUTransport writeMessage\nSent: 01 03 00 0a 00 02 e4 09\n"
      "28.11.2026 09:15:02.040 net.ModbusRTUTransport readResponse\nResponse: 01 03 04 12 34 56 78 81 07\n");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].text, kSaid);
  EXPECT_EQ(frames[1].frame.at, 40 * kMillisecond);
}

TEST(RowsOfALog, CellsWithCommasLoseNoByte) {
  for (const std::string head : {"0,09:15:02.000,TX,", "0,09:15:02.000,\u53D1\u9001,", "1;09:15:02,000;\u00C9mission;",
                                 "09:15:02.000|TX|", "7,TX,"}) {
    const auto frames = read(head + "01 03 00 0a 00 02 e4 09\n");
    ASSERT_EQ(frames.size(), 1U) << head;
    EXPECT_EQ(frames[0].text, kAsked) << head;
    EXPECT_EQ(frames[0].direction, Direction::Request) << head;
  }
}

TEST(RowsOfALog, ANumberInBracketsMayCountTheBytesBeforeIt) {
  for (const auto& [asked, said] : std::initializer_list<std::pair<std::string, std::string>>{
           {"(09:15:02.000) (COM3) (<<) 01h 03h 00h 0Ah 00h 02h E4h 09h (8)",
            "(09:15:02.040) (COM3) (>>) 01h 10h 00h 0Ah 00h 02h 61h CAh (8)"},
           {"TX 01 10 00 0A 00 02 04 12 34 56 78 08 E4 (13)", "RX 01 10 00 0A 00 02 61 CA (8)"}}) {
    const auto frames = read(asked + '\n' + said + '\n');
    ASSERT_EQ(frames.size(), 2U) << asked;
    EXPECT_EQ(frames[0].frame.bytes.size(), asked.ends_with("(13)") ? 13U : 8U) << asked;
    EXPECT_EQ(frames[1].frame.bytes.size(), 8U) << said;
  }
}

TEST(RowsOfALog, BytesMayBeTheTextsOfAList) {
  for (const std::string form : {"'0x{}'", "\"0x{}\"", "'{}'", "\"{}\""}) {
    std::string log;
    for (const std::string_view row : {"TX: 01 03 00 0a 00 02 e4 09", "RX: 01 03 04 12 34 56 78 81 07"}) {
      std::string list;
      for (std::size_t at = 4; at < row.size(); at += 3)
        list += (list.empty() ? "" : ", ") + fmt::format(fmt::runtime(form), row.substr(at, 2));
      log += fmt::format("{}[{}]\n", row.substr(0, 4), list);
    }
    EXPECT_EQ(texts(read(log)), (std::vector<std::string>{kAsked, kSaid})) << log;
  }
}

TEST(RowsOfALog, TheRateInASentenceIsNoByte) {
  EXPECT_EQ(refusal_of("voici la trace de mon automate (9600 bauds) :\n"),
            "no frames found; line 1: left out: no bytes in it");
}

TEST(RowsOfALog, MicrosecondsThatSocatPadsToNineDigitsAreMicroseconds) {
  const std::string asked = "  length=8 from=0 to=7\n 01 03 00 0a 00 02 e4 09\n",
                    said = "  length=9 from=0 to=8\n 01 03 04 12 34 56 78 81 07\n";
  const auto padded = recording_of("> 2025/12/30 14:58:36.000834907" + asked + "< 2025/12/30 14:58:37.000012001" + said);
  ASSERT_EQ(padded.frames.size(), 2U);
  EXPECT_EQ(padded.frames[1].at, 177'094 * kMicrosecond);
  const auto exact = recording_of("> 2025/12/30 14:58:36.500834907" + asked + "< 2025/12/30 14:58:36.600012001" + said);
  EXPECT_EQ(exact.frames.at(1).at, 99'177'094) << "nanoseconds";
}

TEST(ModbusTcpInALog, AnAnswerThatIsNotToTheRequestAboveItNamesItsOwn) {
  const auto frames = read(
      "10:00:00.000 TX 00 05 00 00 00 06 01 03 00 0A 00 01\n10:00:00.002 TX 00 06 00 00 00 06 01 03 00 14 00 01\n"
      "10:00:00.020 RX 00 06 00 00 00 05 01 03 02 00 20\n10:00:00.030 RX 00 05 00 00 00 05 01 03 02 00 10\n");
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames[2].other, 1U);
  EXPECT_EQ(frames[3].other, 0U);
  EXPECT_NE(decoded_text(frames[3], false, false).find("16#0010; the answer to line 1"), std::string::npos);
  EXPECT_EQ(decoded_text(frames[2], false, false).find("the answer to"), std::string::npos);
  EXPECT_EQ(decoded_json(frames[2], false)["request"], "line 2");
  EXPECT_EQ(decoded_json(frames[3], false)["request"], "line 1");
  EXPECT_TRUE(decoded_json(frames[0], false)["request"].is_null());
  EXPECT_EQ(decoded_json(frames[0], true)["unanswered"], true);
}

TEST(RowsOfALog, AnAnswerInSeveralRowsIsOneWhateverLiesBetweenThem) {
  for (const char* const log :
       {"10:00:00.000 TX 01 03 00 0a 00 02 e4 09\n10:00:00.030 RX 01 03 04\n10:00:00.046 RX 12 34 56 78 81 07\n",
        "10:00:00.000 01 03 00 0a 00 02 e4 09\n10:00:00.030 01 03 04 12\n10:00:00.046 34 56 78 81 07\n",
        "TX 01 03 00 0a 00 02 e4 09\nRX 01\nRX 03 04 12 34 56\nRX 78\nRX 81 07\n",
        "01 03 00 0a 00 02 e4 09\n01 03 04 12 34 56 78 81\n07\n"}) {
    const auto frames = read(log);
    EXPECT_EQ(texts(frames), (std::vector{kAsked, kSaid})) << log;
    ASSERT_EQ(notes(frames).size(), 1U) << log;
    EXPECT_TRUE(notes(frames)[0].starts_with("line 2: an answer in ")) << notes(frames)[0];
  }
}

TEST(RowsOfALog, ARequestInSeveralRowsIsOne) {
  const auto frames = read("0.000 RX 01 03 00 0a\n0.016 RX 00 02 e4 09\n0.050 TX 01 03 04 12 34 56 78 81 07\n");
  const auto turned = read("0.000 TX 01 03 00 0a\n0.016 TX 00 02 e4 09\n0.050 RX 01 03 04 12 34 56 78 81 07\n");
  EXPECT_EQ(texts(turned), (std::vector{kAsked, kSaid}));
  EXPECT_EQ(notes(turned), std::vector<std::string>{"line 1: a request in 2 pieces: joined, as only the whole is right"});
  EXPECT_EQ(frames.size(), 3U) << "directions are not settled here";
}

TEST(RowsOfALog, PiecesThatAreTheEndOfOneMessageAndTheBeginOfTheNextAreToldApart) {
  const auto frames = read("01 03 00 0a 00 02 e4 09 01 03\n04 12 34 56 78 81 07 01 03 00 0a\n00 02 e4 09\n");
  EXPECT_EQ(texts(frames), (std::vector{kAsked, kSaid, kAsked}));
}

TEST(RowsOfALog, RowsAreJoinedOnlyIfTheWholeIsRight) {
  const std::string asked = "0.000 TX 01 03 00 0a 00 02 e4 09\n";
  for (const char* const rows :
       {"0.030 RX 01 03 04\n0.046 RX 12 34 56 78 81 08\n", "0.030 RX 01 03 04\n0.046 TX 12 34 56 78 81 07\n",
        "0.030 RX 01 03 02\n0.046 RX 12 34 56 78 81 07\n", "0.030 RX 01 03 04\n0.046 RX 12 34\n"}) {
    const auto frames = read(asked + rows);
    EXPECT_EQ(frames.size(), 3U) << rows;
    const bool of_its_length = std::string_view(rows).ends_with("81 08\n");
    EXPECT_EQ(notes(frames).size(), of_its_length ? 1U : 0U) << rows;
  }
}

TEST(RowsOfALog, APieceSaysThatTheWholeHasAWrongCrc) {
  const std::string asked = "TX 01 03 00 0a 00 02 e4 09\n", again = asked + "RX 01 03 04 12 34 56 78 81 07\n";
  const auto two = read(asked + "RX 01 03 04\nRX 12 34 56 78 81 08\n" + again);
  EXPECT_EQ(notes(two), std::vector<std::string>{"line 2: with the row below it has the length that it announces: "
                                                 "what is wrong is the check sum of the whole"});
  const auto three = read(asked + "RX 01 03 04\nRX 12 34 56\nRX 78 81 08\n" + again);
  ASSERT_EQ(notes(three).size(), 1U);
  EXPECT_TRUE(notes(three)[0].starts_with("line 2: with the 2 rows below it has")) << notes(three)[0];
  const auto cut_off = read(asked + "RX 01 03 04\n" + again);
  EXPECT_EQ(notes(cut_off), std::vector<std::string>{}) << "the request repeated is no rest of an answer";
}

TEST(RowsOfALog, AnAnswerOfPpiInSeveralRowsIsOne) {
  const auto frames = read("0.000 TX 10 02 00 49 4B 16\n0.030 RX 10 00 02\n0.046 RX 00 02 16\n", {}, "ppi");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].other, 0U);
}

TEST(RowsOfALog, AScenarioOfAnAnswerInPiecesExpectsTheWhole) {
  const Playback played =
      playback(read("0.000 TX 01 03 00 0a 00 02 e4 09\n0.030 RX 01 03 04\n0.046 RX 12 34 56 78 81 07\n"), {}, {});
  EXPECT_NE(played.scenario.find("expect: 01 03 04 12 34 56 78 81 07"), std::string::npos) << played.scenario;
}

// --- echoes ---

TEST(RowsOfALog, AnEchoInTheRowOfTheAnswerIsNamedAndIsNoAnswer) {
  const std::string request = "01 03 00 0a 00 02 e4 09", answer = "01 03 04 12 34 56 78 81 07";
  for (const auto& [sent, received] : {std::pair{"TX ", "RX "}, {"", ""}}) {
    std::string log;
    for (const int second : {0, 1})
      log += fmt::format("10:00:0{0}.000 {1}{3}\n10:00:0{0}.040 {2}{3} {4}\n", second, sent, received, request, answer);
    const auto frames = read(log);
    EXPECT_EQ(texts(frames), (std::vector<std::string>{kAsked, "the echo of the request", kSaid, kAsked,
                                                       "the echo of the request", kSaid}));
    EXPECT_EQ(
        summary(frames),
        "requests: 2, answered: 2 after 30.833 ms to 30.833 ms; wrong frames: 0, frames of no request: 0, echoes: 2\n");
    EXPECT_EQ(notes(frames), std::vector<std::string>{"line 2: the echo of a request, and 1 more: an adapter for two wires "
                                                      "hears what it sends; that is not an answer"});
    const Playback played = playback(frames, {}, {});
    EXPECT_EQ(played.notes, std::vector<std::string>{});
    EXPECT_NE(played.scenario.find("expect: " + answer), std::string::npos) << played.scenario;
  }
}

TEST(RowsOfALog, AnEchoMayHaveARowOfItsOwnOrShareItWithTheBeginOfTheAnswer) {
  for (const char* const rows : {"0.010 RX 01 03 00 0a 00 02 e4 09\n0.040 RX 01 03 04 12 34 56 78 81 07\n",
                                 "0.010 RX 01 03 00 0a 00 02 e4 09 01 03\n0.040 RX 04 12 34 56 78 81 07\n",
                                 "0.010 RX 01 03 00 0a\n0.020 RX 00 02 e4 09 01 03 04 12 34 56 78 81 07\n"}) {
    const auto frames = read(std::string("0.000 TX 01 03 00 0a 00 02 e4 09\n") + rows);
    EXPECT_EQ(texts(frames), (std::vector<std::string>{kAsked, "the echo of the request", kSaid})) << rows;
  }
}

TEST(RowsOfALog, TheEchoOfAWriteIsKnownWhereARecordingHasEchoes) {
  const std::string echoed =
      "0.000 TX 01 03 00 0a 00 02 e4 09\n0.010 RX 01 03 00 0a 00 02 e4 09\n"
      "0.040 RX 01 03 04 12 34 56 78 81 07\n";
  const std::string write = "1.000 TX 01 06 00 00 00 01 48 0A\n1.010 RX 01 06 00 00 00 01 48 0A\n";
  const auto kinds = [](const std::string& log) {
    std::string of_each;
    for (const ReadFrame& frame : read(log))
      of_each += frame.echo                              ? 'e'
                 : frame.direction == Direction::Request ? '>'
                 : frame.direction == Direction::Answer  ? '<'
                                                         : '?';
    return of_each;
  };
  EXPECT_EQ(kinds(write), "><") << "an answer is the same";
  EXPECT_EQ(kinds(echoed + write), ">e<>e");
  EXPECT_EQ(kinds(echoed + write + "1.040 RX 01 06 00 00 00 01 48 0A\n"), ">e<>e<");
}

TEST(RowsOfALog, ARequestThatTheMasterSendsOnceMoreIsNoEcho) {
  const auto frames = read(
      "0.000 TX 01 03 00 0a 00 02 e4 09\n0.500 TX 01 03 00 0a 00 02 e4 09\n"
      "0.540 RX 01 03 04 12 34 56 78 81 07\n");
  EXPECT_EQ(texts(frames), (std::vector{kAsked, kAsked, kSaid}));
  const auto unmarked = read("0.000 01 03 00 0a 00 02 e4 09\n0.500 01 03 00 0a 00 02 e4 09 01 03 04 12 34 56 78 81 07\n");
  EXPECT_EQ(texts(unmarked), (std::vector{kAsked, kAsked, kSaid})) << "later than its time-out";
}

TEST(ModbusTcpInALog, AMessageInSeveralRowsIsOne) {
  for (const char* const log : {"10:00:00.000 TX 00 01 00 00 00 06 01 03 00 0a 00 02\n10:00:00.030 RX 00 01 00 00 00 07 01\n"
                                "10:00:00.031 RX 03 04 12 34 56 78\n",
                                "00 01 00 00 00 06 01 03 00 0a 00 02\n00 01 00 00\n00 07 01 03 04 12\n34 56 78\n",
                                "TX 00 01 00 00 00 06 01 03\nTX 00 0a 00 02\nRX 00 01 00 00 00 07 01 03 04 12 34 56 78\n"}) {
    EXPECT_EQ(texts(read(log)), (std::vector{kAsked, kSaid})) << log;
    const auto notes = recording_of(log).notes;
    ASSERT_EQ(notes.size(), 2U) << log;
    EXPECT_NE(notes[1].find(": a message of Modbus TCP in "), std::string::npos) << notes[1];
    EXPECT_TRUE(notes[1].ends_with(" rows: joined, as only the whole is one")) << notes[1];
  }
}

TEST(ModbusTcpInALog, AMessageThatHasACrcByChanceIsOneWhereTheOthersAre) {
  const Bytes message{0x65, 0x5A, 0, 0, 0, 6, 1, 3, 0, 10, 0, 2};
  const auto hex = [](const Bytes& bytes) { return serial::to_hex(bytes); };
  Bytes chance = message;
  for (unsigned transaction = 0; !modbus::crc_ok(chance) && transaction <= 0xFFFF; ++transaction)
    store16(chance.data(), static_cast<std::uint16_t>(transaction));
  ASSERT_TRUE(modbus::crc_ok(chance));
  EXPECT_EQ(texts(read("TX " + hex(message) + "\nTX " + hex(chance) + "\n")), (std::vector{kAsked, kAsked}));
  EXPECT_EQ(texts(read("TX 01 01 00 00 00 02 bd cb\n")), std::vector<std::string>{"station 1, read coils 00001, 2 of them"});
}

TEST(ModbusTcpInALog, ARowOfTheOtherDirectionOrTheNextMessageCompletesNone) {
  const std::string request = "00 01 00 00 00 06 01 03 00 0a 00 02", part = "00 01 00 00 00 07 01 03 04 12 34 56";
  for (const std::string& log :
       {"TX " + request + "\nRX " + part + "\nTX " + request + "\n", request + "\n" + part + "\n" + request + "\n"}) {
    EXPECT_EQ(texts(read(log)),
              (std::vector<std::string>{kAsked, "not read: it is not a whole message of Modbus TCP", kAsked}))
        << log;
    EXPECT_EQ(recording_of(log).notes.back(), "line 2: left out: it is not a whole message of Modbus TCP") << log;
  }
}

// --- other columns and other languages ---

TEST(ColumnsOfALog, CharactersBehindABarAreNoBytes) {
  for (const char* const log :
       {"10:00:00.000  length=8\n0000  01 03 00 0a 00 02 e4 09                          |........|\n"
        "10:00:00.030  length=9\n0000  01 03 04 12 34 56 78 81 07                       |....4Vx..|\n",
        "10:00:00.000 | TX | 01 03 00 0a 00 02 e4 09 | ..~~\n10:00:00.030 | RX | 01 03 04 12 34 56 78 81 07 | ..4Vx.\n"})
    EXPECT_EQ(texts(read(log)), (std::vector{kAsked, kSaid})) << log;
  EXPECT_EQ(recording_of("TX 01 03 00 0a 00 02 e4 09 | AB CD\nRX 01 03 04 12 34 56 78 81 07\n").notes,
            std::vector<std::string>{"line 1: left out: cannot tell what '|' next to its bytes means"});
}

TEST(ColumnsOfALog, DirectionAndTimeMayStandInCellsAfterTheBytes) {
  const auto recording =
      recording_of("01 03 00 0a 00 02 e4 09 | TX | 10:00:00.000\n01 03 04 12 34 56 78 81 07 | RX | 10:00:00.030\n");
  ASSERT_EQ(recording.frames.size(), 2U);
  EXPECT_EQ(recording.frames[0].direction, Direction::Request);
  EXPECT_EQ(recording.frames[1].direction, Direction::Answer);
  EXPECT_EQ(recording.frames[1].at, 30 * kMillisecond);
}

TEST(ColumnsOfALog, BytesRightAfterASignOfAnotherScriptAreWhole) {
  for (const char* const log :
       {"[10:00:00.000]发→◇01 03 00 0a 00 02 e4 09 \n[10:00:00.030]收←◆01 03 04 12 34 56 78 81 07 \n",
        "10:00:00.000 发送：01 03 00 0a 00 02 e4 09\n10:00:00.030 接收：01 03 04 12 34 56 78 81 07\n"}) {
    EXPECT_EQ(texts(read(log)), (std::vector{kAsked, kSaid})) << log;
    EXPECT_EQ(recording_of(log).frames[0].direction, Direction::Request) << log;
  }
  EXPECT_TRUE(refusal_of("Motor m\u00FCde\n").starts_with("no frames found")) << "the end of a word is no byte";
}

TEST(ColumnsOfALog, ListsOfJsonMayHaveTheirBracketsAnywhere) {
  const std::string asked = R"("dir":"tx","data":"01 03 00 0a 00 02 e4 09")",
                    said = R"("dir":"rx","data":[1,3,4,18,52,86,120,129,7])";
  for (const std::string& log :
       {R"([{"t":0.5,)" + asked + "},\n{\"t\":0.53," + said + "}]\n",
        "[ { \"t\":0.5," + asked + "} , {\"t\":0.53," + said + "} ]",
        "[\n  {\n    \"time_ms\": 0,\n    " + asked + "\n  },\n  {\n    \"time_ms\": 30,\n    " + said + "\n  }\n]\n",
        R"({"log":[{"t":0.5,)" + asked + R"(},{"t":0.53,)" + said + "}]}"}) {
    EXPECT_EQ(texts(read(log)), (std::vector{kAsked, kSaid})) << log;
    const auto recording = recording_of(log);
    EXPECT_EQ(recording.notes, std::vector<std::string>{}) << log;
    EXPECT_EQ(recording.frames.back().at, 30 * kMillisecond) << log;
  }
}

TEST(ColumnsOfALog, ARowOfAFrameThatIsNotUnderstoodIsNamedInEachForm) {
  EXPECT_EQ(recording_of("[01][03][00][0A][00][02][E4][09]\nWaiting for a confirmation...\n<01><03><0\n").notes,
            std::vector<std::string>{"line 3: left out: '<01><03><0' is not understood"});
  EXPECT_EQ(recording_of("DEBUG send: 0x1 0x3 0x0 0xa 0x0 0x2 0xe4 0x9\nDEBUG recv: 0x1 0x\n"
                         "DEBUG Processing: 0x1 0x3\n")
                .notes,
            std::vector<std::string>{"line 2: left out: '0x1 0x' is not understood"});
}

TEST(ColumnsOfALog, AnObjectOfJsonWithoutItsEndIsNamedAndHidesNothingBelowIt) {
  const std::string request = R"({"tx":"01 03 00 0a 00 02 e4 09"})", answer = R"({"rx":"01 03 04 12 34 56 78 81 07"})";
  const std::string log = "{\"tx\":\"01 03\n{\"tx\": 1,\n" + request + "\n" + answer + "\n";
  EXPECT_EQ(texts(read(log)), (std::vector<std::string>{R"(not read: '{"tx":"01 03' is not understood)",
                                                        R"(not read: '{"tx": 1,' is not understood)", kAsked, kSaid}));
  EXPECT_EQ(recording_of(log).notes, (std::vector<std::string>{R"(line 1: left out: '{"tx":"01 03' is not understood)",
                                                               R"(line 2: left out: '{"tx": 1,' is not understood)"}));
}

// --- rows that are not read ---

const std::string kRequestRow = "10:00:00.000 TX 01 03 00 0a 00 02 e4 09\n";
const std::string kAnswerRow = "10:00:00.030 RX 01 03 04 12 34 56 78 81 07";

TEST(RowsThatAreNotRead, AWordAfterTheBytesIsACommentOnlyIfTheyAreARightFrame) {
  for (const char* const comment :
       {" ok", " OK!", " = 4660 22136", " value 4660 22136", " value: 4660", " value 18", " 4660", " -> 2 values",
        " be careful", " crc ok", " = 0x1234 0x5678", " => 4660, 22136"}) {
    const auto frames = read(kRequestRow + kAnswerRow + comment + "\n");
    EXPECT_EQ(texts(frames), (std::vector{kAsked, kSaid})) << comment;
    EXPECT_EQ(frames[1].frame.bytes.size(), 9U) << comment;
  }
  EXPECT_EQ(notes(read(kRequestRow + kAnswerRow + " ok\n")),
            std::vector<std::string>{"line 2: 'ok' beside the bytes: not read, as the bytes are a right frame without it"});
  for (const char* const row :
       {"RX 01 03 04 12 34 56 78 81 08 ok", "RX 01 03 04 12 34 56 78 81 07 3", "RX 01 03 04 12 34 56 7? 81 07",
        "RX 01 03 04 12 34 5G 78 81 07", "RX 01 03 04 12 34 56 78 lost 81 07", "RX 0103041234567",
        "RX #2 01 03 04 12 34 56 78 81 07"}) {
    const auto frames = read(kRequestRow + "10:00:00.030 " + row + "\n");
    ASSERT_EQ(frames.size(), 2U) << row;
    EXPECT_TRUE(frames[1].not_read) << row;
    EXPECT_EQ(frames[1].frame.bytes, Bytes{}) << row;
    EXPECT_EQ(frames[0].other, std::nullopt) << row;
  }
}

TEST(RowsThatAreNotRead, TheExchangeThatOneMayBelongToIsNotImported) {
  const std::string damaged = "10:00:00.030 RX 01 03 04 12 34 5G 78 81 07\n",
                    later = "10:00:01.000 TX 01 03 00 0a 00 02 e4 09\n";
  const auto frames = read(kRequestRow + damaged + later + "10:00:01.030 RX 01 03 04 12 34 56 78 81 07\n");
  EXPECT_EQ(
      summary(frames),
      "requests: 2, answered: 1 after 20.833 ms to 20.833 ms; wrong frames: 0, frames of no request: 0, rows not read: "
      "1 (1 may be the answer to a request)\n");
  const auto [scenario, said] = playback(frames, {.character = 1'145'833}, {});
  EXPECT_EQ(said, std::vector<std::string>{
                      "line 1: left out: what follows it (line 2) may be its answer: not read: cannot tell what "
                      "'5G' next to its bytes means"});
  EXPECT_EQ(scenario.find("silence"), std::string::npos) << scenario;
  EXPECT_NE(scenario.find("# line 1: left out"), std::string::npos) << scenario;
  EXPECT_NE(scenario.find("# line 3: station 1"), std::string::npos) << scenario;
}

TEST(RowsThatAreNotRead, TheAnswerBelowOneBelongsToNoRequestAboveIt) {
  const auto frames = read(kRequestRow + "10:00:00.020 01 03 00 0a ?? 02 e4 09\n" + kAnswerRow + "\n");
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[2].text, "an answer without its request");
  EXPECT_TRUE(playback(frames, {}, {}).scenario.empty());
}

TEST(RowsThatAreNotRead, EachFormKeepsThePlaceOfARowThatIsNotUnderstood) {
  const std::string json = R"({"t":0.5,"tx":"01 03 00 0a 00 02 e4 09"})",
                    damaged = R"({"t":0.53,"dir":"rx","data":"0103041234567"})";
  for (const std::string& log :
       {json + "\n" + damaged + "\n", "t=0.5 n=8 tx=0103000a0002e409\nt=0.53 dir=rx data=0103041234567\n" + std::string(),
        std::string("[01][03][00][0A][00][02][E4][09]\nWaiting for a confirmation...\n<01><03><0\n"),
        std::string("send b'\\x01\\x03\\x00\\x0a\\x00\\x02\\xe4\\x09'\nrecv b'\\x01\\q'\n"),
        std::string("write(3, \"\\1\\3\\0\\n\\0\\2\\344\\t\", 8) = 8\nread(3, \"\\1\\3\"..., 99) = 9\n")}) {
    const auto frames = read(log);
    ASSERT_EQ(frames.size(), 2U) << log;
    EXPECT_TRUE(frames[1].not_read && frames[1].may_be_answer) << log;
    EXPECT_EQ(playback(frames, {}, {}).scenario, "") << log;
  }
}

TEST(RowsThatAreNotRead, AnUnansweredRequestOfModbusTcpBeforeOneIsNotImportedAsSuch) {
  const std::string asked = "0.0 TX 00 01 00 00 00 06 01 03 00 0a 00 02\n",
                    next = "9.0 TX 00 02 00 00 00 06 01 03 00 0a 00 02\n",
                    said = "9.1 RX 00 02 00 00 00 07 01 03 04 12 34 56 78\n";
  const auto frames = read(asked + "0.1 RX 00 01 00 00 00 07 01 03 04 12 5? 56 78\n" + next + said, {});
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(playback(frames, {}, {}).notes,
            std::vector<std::string>{
                "line 1: left out: what follows it (line 2) may be its answer: not read: cannot tell what '5?' next to its "
                "bytes means"});
  EXPECT_EQ(texts(read(asked + "0.1 RX 00 01 00 00 00 07 01 03 04 12 34 56 78 ok\n", {})), (std::vector{kAsked, kSaid}));
}

TEST(RowsThatAreNotRead, WhatHasComeAsATextAmongBytesIsNoSilence) {
  const auto frames = read(kRequestRow + "10:00:00.030 RX: 12.5\n");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].text, "not read: '12.5' is not understood");
  for (const char* const remark : {"RX: timeout", "RX: no answer after 500 ms", "RX 8 bytes", "RX len=8"})
    EXPECT_EQ(read(kRequestRow + "10:00:00.030 " + remark + "\n").size(), 1U) << remark;
}

TEST(RowsThatAreNotRead, WhatIsSaidOfOneIsSafeToPrint) {
  const auto frames = read(kRequestRow + "10:00:00.030 RX 01 03 \x1b[31m 04\n10:00:00.040 RX 01 \xff 03\n");
  EXPECT_EQ(texts(frames),
            (std::vector<std::string>{kAsked, "not read: cannot tell what '\uFFFD[31m' next to its bytes means",
                                      "not read: cannot tell what '\uFFFD' next to its bytes means"}));
}

TEST(RowsThatAreNotRead, WordsOfASentenceAreNoBytes) {
  for (const char* const line :
       {"10:00:00 warte ab", "10:00:00 de facto offline", "10:00:00 BAD FACE", "10:00:00 slave 2 timeout, retry 1"})
    EXPECT_EQ(refusal_of(line), "no frames found; line 1: left out: no bytes in it") << line;
}

TEST(RowsOfCharacters, AreFramesOnlyIfEachRowHasOneWithItsTime) {
  const auto frames_of = [](const std::string& last) {
    std::string log;
    for (int i = 0; i < 100; ++i) log += fmt::format("{}.{:03} TX 0{}\n", i / 10, i % 10, i % 10);
    return recording_of(log + last).frames.size();
  };
  EXPECT_EQ(frames_of(""), 10U);
  EXPECT_EQ(frames_of("99.0 TX 01 03\n"), 101U) << "a row of two";
  EXPECT_EQ(frames_of("TX 01\n"), 101U) << "a row without its time";
}

// --- dumps ---

TEST(RowsOfADump, RowsBelowAHeadingAreOneFrameHoweverLongTheyAre) {
  for (const char* const log :
       {"10:00:00.000 TX 8 bytes\n0000: 01 03 00 0a 00 02 e4 09  |........|\n10:00:00.030 RX 9 bytes\n"
        "0000: 01 03 04 12 34 56 78 81  |...4Vx..|\n0008: 07  |.|\n",
        "10:00:00.000 TX\n  0000  01 03 00 0a 00 02 e4 09\n10:00:00.030 RX\n  0000  01 03 04 12 34 56 78 81\n  0008  07\n",
        "10:00:00.000 TX\n0x0000: 01 03 00 0a\n0x0004: 00 02 e4 09\n10:00:00.030 RX\n0x0000: 01 03 04 12\n0x0004: 34 56 78 "
        "81\n"
        "0x0008: 07\n",
        "10:00:00.000 TX\n0000 01 03 00 0a 00 02 e4 09\n10:00:00.030 RX\n0000 01 03 04 12 34 56 78 81\n0008 07\n",
        "10:00:00.000 TX\n01 03 00 0a 00 02 e4 09\n10:00:00.030 RX\n01 03 04 12\n34 56 78 81\n07\n"}) {
    const auto frames = read(log);
    EXPECT_EQ(texts(frames), (std::vector{kAsked, kSaid})) << log;
    EXPECT_EQ(recording_of(log).notes, std::vector<std::string>{}) << log;
  }
}

TEST(RowsOfADump, OffsetsMayCountInDecimal) {
  std::string rows = "10:00:00.000 RX\n";
  for (int row = 0; row < 3; ++row) rows += fmt::format("{:04}: 00 01 02 03 04 05 06 07 08 09\n", 10 * row);
  const auto frames = recording_of(rows).frames;
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].bytes.size(), 30U);
}

TEST(RowsOfADump, AnOffsetThatIsNotRightIsNoByteAndTheFrameIsNotRead) {
  const auto frames = recording_of(kRequestRow + "10:00:00.030 RX\n  0000  01 03 04 12 34 56 78 81\n  0010  07\n").frames;
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_TRUE(frames[1].doubt);
  EXPECT_EQ(frames[1].bytes, Bytes{});
}

TEST(RowsOfADump, AnOffsetOfZeroBeginsAPacketWithoutAHeading) {
  const std::string asked = "0000   01 03 00 0a 00 02 e4 09                           ........\n";
  const std::string said = "0000   01 03 04 12 34 56 78 81 07                        ...4Vx...\n";
  for (const std::string& between : {std::string(), std::string("\n")}) {
    const auto frames = read(asked + between + said + between + asked + between + said);
    EXPECT_EQ(texts(frames), (std::vector{kAsked, kSaid, kAsked, kSaid})) << between;
  }
  const std::string full = "0000   00 01 02 03 04 05 06 07 08 09 0a 0b 0c 0d 0e 0f   ................\n";
  const auto frames = recording_of(full + "0010   10 11   ..\n\n" + full + "\n" + full).frames;
  ASSERT_EQ(frames.size(), 3U) << "a full row does not go on in another packet";
  EXPECT_EQ(frames[0].bytes.size(), 18U);
  EXPECT_EQ(frames[1].bytes.size(), 16U);
}

// --- lists of numbers ---

TEST(NumbersInALog, AreBytesInDecimalOrHexIfTheyAreARightFrame) {
  for (const char* const log :
       {">>> send [1, 3, 0, 10, 0, 2, 228, 9]\n>>> recv [1, 3, 4, 18, 52, 86, 120, 129, 7]\n",
        "TX [1,3,0,10,0,2,228,9]\nRX [1,3,4,18,52,86,120,129,7]\n",
        "10:00:00.000 -> TX: 1 3 0 A 0 2 E4 9\n10:00:00.067 -> RX: 1 3 4 12 34 56 78 81 7\n",
        "TX 1 3 0 10 0 2 228 9\nRX 1 3 4 18 52 86 120 129 7\n", "1 3 0 a 0 2 e4 9\n1 3 4 12 34 56 78 81 7\n",
        "[D] tx: {0x01, 0x03, 0x00, 0x0A, 0x00, 0x02, 0xE4, 0x09}\n"
        "[D] rx: {0x01, 0x03, 0x04, 0x12, 0x34, 0x56, 0x78, 0x81, 0x07}\n",
        "byte tx[] = {0x1, 0x3, 0x0, 0xA, 0x0, 0x2, 0xE4, 0x9};\nbyte rx[] = {0x1,0x3,0x4,0x12,0x34,0x56,0x78,0x81,0x7};\n",
        "send (1, 3, 0, 10, 0, 2, 228, 9)\nrecv (1, 3, 4, 18, 52, 86, 120, 129, 7)\n"}) {
    const auto frames = read(log);
    EXPECT_EQ(texts(frames), (std::vector{kAsked, kSaid})) << log;
    EXPECT_EQ(notes(frames), std::vector<std::string>{}) << log;
  }
}

TEST(NumbersInALog, ARightFrameIsNoMessageOfModbusTcpThoughItLooksLikeOne) {
  for (const char* const log : {"send [1, 3, 0, 0, 0, 2, 196, 11]\n", "TX: 1 3 0 0 0 2 C4 B\n",
                                "TX (8): 0x01 0x03 0x00 0x00 0x00 0x02 0xC4 0x0B @ 1234 ms\n"})
    EXPECT_EQ(texts(read(log)), std::vector<std::string>{"station 1, read holding registers 40001, 2 of them"}) << log;
  EXPECT_EQ(texts(read("TX [0, 1, 0, 0, 0, 6, 1, 3, 0, 10, 0, 2]\n")), std::vector{kAsked}) << "that is one";
}

TEST(NumbersInALog, ThatAreNoRightFrameAreNoBytes) {
  for (const char* const row : {"TX [1, 3, 0, 10, 0, 2, 228, 8]", "TX: 1 3 0 A 0 2 E4 8", "RX values 100 200 30 4"}) {
    const auto frames = read(std::string(row) + "\nTX 01 03 00 0a 00 02 e4 09\n");
    ASSERT_EQ(frames.size(), 2U) << row;
    EXPECT_TRUE(frames[0].not_read) << row;
    EXPECT_EQ(frames[1].text, kAsked);
  }
}

TEST(NumbersInALog, EachCellOfARowIsAByte) {
  const auto frames = read("0.000,TX,01,03,00,0A,00,02,E4,09,\n0.067,RX,01,03,04,12,34,56,78,81,07\n");
  EXPECT_EQ(texts(frames), (std::vector{kAsked, kSaid}));
  EXPECT_EQ(texts(read("TX:01,03,00,0a,00,02,e4,09\nRx:0x01,0x03,0x04,0x12,0x34,0x56,0x78,0x81,0x07\n")),
            (std::vector{kAsked, kSaid}));
}

// --- characters ---

const std::vector<std::string> kWeighed{R"("?W\r\n")", R"("+0012.40 kg\r\n")", "ENQ", "NAK", R"("AB 12\r\n")"};

TEST(CharactersInALog, NamesEscapesAndFieldsAreTheCharactersThemselves) {
  for (const char* const log :
       {"[10:00:00.000] -> ?W<CR><LF>\n[10:00:00.050] <- +0012.\n[10:00:00.158] <- 40 kg<CR><LF>\n[10:00:01.000] -> <ENQ>\n"
        "[10:00:01.040] <- <nak>\n[10:00:02.000] -> AB 12<0D><0A>\n",
        "10:00:00.000 COM1 TX: \"?W\\r\\n\"\n10:00:00.050 COM1 RX: \"+0012.40 kg\\r\\n\"\n10:00:01.000 COM1 TX: \"\\x05\"\n"
        "10:00:01.040 COM1 RX: \"\\x15\"\n10:00:02.000 COM1 TX: \"AB 12\\r\\n\"\n",
        "1 10:00:00.000 > ?W\\r\\n\n2 10:00:00.050 < +0012.40 kg\\r\\n\n3 10:00:01.000 > \\x05\n4 10:00:01.040 < \\x15\n"
        "5 10:00:02.000 > AB 12\\r\\n\n",
        "{\"t\":0.0,\"dir\":\"tx\",\"data\":\"?W\\r\\n\"}\n{\"t\":0.05,\"dir\":\"rx\",\"data\":\"+0012.\"}\n"
        "{\"t\":0.16,\"dir\":\"rx\",\"data\":\"40 kg\\r\\n\"}\n{\"t\":1.0,\"dir\":\"tx\",\"data\":\"\\u0005\"}\n"
        "{\"t\":1.04,\"dir\":\"rx\",\"data\":\"\\u0015\"}\n{\"t\":2.0,\"dir\":\"tx\",\"data\":\"AB 12\\r\\n\"}\n",
        "t=0.0 dir=tx data=\"?W\\r\\n\"\nt=0.05 dir=rx data=\"+0012.40 kg\\r\\n\"\nt=1.0 dir=tx data=\"\\x05\"\n"
        "t=1.04 dir=rx data=\"\\x15\"\nt=2.0 dir=tx data=\"AB 12\\r\\n\"\n"}) {
    const auto frames = read(log, {.character = 1'145'833}, "text");
    EXPECT_EQ(texts(frames), kWeighed) << log;
    EXPECT_EQ(frames.front().direction, Direction::Request) << log;
    EXPECT_EQ(frames.front().frame.at, 0) << log;
  }
}

TEST(CharactersInALog, ALogInHexWithRemarksStaysOne) {
  const auto frames = read(kRequestRow + "10:00:00.010 TX done<CR>\n" + kAnswerRow + "\n");
  EXPECT_EQ(texts(frames), (std::vector{kAsked, kSaid}));
}

TEST(CharactersInALog, AnEscapeThatIsNotKnownIsNotRead) {
  const auto frames = read("0.0 TX: \"?W\\r\"\n0.1 RX: \"1\\q\\r\"\n", {}, "text");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_TRUE(frames[1].not_read);
}

TEST(TextInALog, TextsBetweenStxAndEtxAndSignalsAreMessages) {
  const auto frames = read(
      "0.0 TX 05\n0.1 RX 06\n0.2 TX 02 3f 57 03\n0.3 RX 02 2b 31 32 2e 35 03 33\n0.4 TX 02 41 17 0d\n0.5 RX 15\n0.6 TX 04\n"
      "0.7 TX 02 41 03 31 32 33\n0.8 RX 02 80 03\n",
      {.character = 1'145'833}, "text");
  EXPECT_EQ(texts(frames),
            (std::vector<std::string>{"ENQ", "ACK", R"(STX "?W" ETX)", R"(STX "+12.5" ETX, check 33)", R"(STX "A" ETB)",
                                      "NAK", "EOT", R"("\x02A\x03123"; character 1 is not of a text)",
                                      R"("\x02\x80\x03"; character 2 is not of a text)"}));
  EXPECT_EQ(summary(frames).substr(0, 26), "requests: 5, answered: 3 a");
}

TEST(TextInALog, ABlockOrALineInSeveralRowsIsOneWhateverLiesBetweenThem) {
  EXPECT_EQ(texts(read("0.0 TX 02 3f\n0.5 TX 57\n0.9 TX 03\n1.0 RX 2b 31\n1.2 RX 32 0d 0a\n", {}, "text")),
            (std::vector<std::string>{R"(STX "?W" ETX)", R"("+12\r\n")"}));
}

TEST(ColumnsOfALog, ANumberBeforeTheTimeCountsTheRows) {
  for (const char* const log :
       {"1 10:00:00.000 Write 01 03 00 0a 00 02 e4 09\n2 10:00:00.030 Read 01 03 04 12 34 56 78 81 07\n",
        "17; 10:00:00.000; TX; 01 03 00 0a 00 02 e4 09\n18; 10:00:00.030; RX; 01 03 04 12 34 56 78 81 07\n",
        "Nr. Zeit Daten\n1 31.000 01 03 00 0a 00 02 e4 09\n2 31.030 01 03 04 12 34 56 78 81 07\n",
        "001: 2026-11-27 10:00:00.000 > 01 03 00 0a 00 02 e4 09\n002: 2026-11-27 10:00:00.030 < 01 03 04 12 34 56 78 81 "
        "07\n"}) {
    const auto frames = read(log);
    EXPECT_EQ(texts(frames), (std::vector{kAsked, kSaid})) << log;
    EXPECT_EQ(frames[1].frame.at, 30 * kMillisecond) << log;
  }
}

// --- PPI ---

TEST(PpiInALog, AStationAnswersARequestForItsStatusWithItsStateOnly) {
  const std::string asked = "0.0 10 02 00 49 4b 16\n";
  const auto answered = [&](const std::string& answer) { return read(asked + "0.1 " + answer + "\n", {}, "ppi"); };
  const auto state = answered("10 00 02 00 02 16"), accepted = answered("e5");
  EXPECT_TRUE(state[1].right) << state[1].text;
  EXPECT_EQ(accepted[1].text, "accepted: a station answers a request for its status with its state");
  EXPECT_EQ(accepted[1].direction, Direction::Answer);
  EXPECT_FALSE(accepted[1].right || accepted[1].puts_off);
  EXPECT_EQ(summary(accepted), "requests: 1, answered: 0; wrong frames: 1, frames of no request: 0\n");
  EXPECT_EQ(playback(accepted, {}, {}).scenario, "");
  EXPECT_EQ(answered("10 00 03 00 03 16")[1].text, "3 to 0, function 00: answer of station 3, not 2");
}

TEST(PpiInALog, AShortAcknowledgementAnswersARequestWithDataAndPutsOffAPoll) {
  const auto frames = read(
      "0.0 68 1b 1b 68 02 00 6c 32 01 00 00 00 00 00 0e 00 00 04 01 12 0a 10 02 00 01 00 01 84 00 03 20 8b 16\n0.1 e5\n"
      "0.2 10 02 00 5c 5e 16\n0.3 e5\n",
      {}, "ppi");
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_TRUE(frames[1].right && !frames[1].puts_off);
  EXPECT_TRUE(frames[3].right && frames[3].puts_off);
}

// --- Modbus TCP ---

TEST(ModbusTcpInALog, UnitZeroIsAnAddressLikeAnyOther) {
  const auto frames = read(
      "10:00:00.000 TX 00 01 00 00 00 06 00 03 00 0a 00 01\n"
      "10:00:00.020 RX 00 01 00 00 00 05 00 03 02 12 34\n",
      {});
  EXPECT_EQ(texts(frames),
            (std::vector<std::string>{"station 0, read holding registers 40011, 1 of them", "1 register: 16#1234"}));
  EXPECT_FALSE(frames[0].needs_no_answer);
  EXPECT_EQ(
      playback(frames, {}, {}).notes,
      std::vector<std::string>{"line 1: left out: unit 0 of Modbus TCP is a device; on a serial line it is all stations, "
                               "and none answers"});
  EXPECT_EQ(read("TX 00 06 00 00 00 01 49 DB\n")[0].text, "all stations, write register 40001 = 16#0001") << "on a line";
}

TEST(ModbusTcpInALog, AnAnswerBelongsToItsTransactionWhateverUnitItNames) {
  const auto frames = read(
      "0.000 TX 00 01 00 00 00 06 01 03 00 0a 00 01\n0.001 TX 00 02 00 00 00 06 02 03 00 0a 00 01\n"
      "0.020 RX 00 02 00 00 00 05 FF 03 02 00 02\n0.021 RX 00 01 00 00 00 05 01 03 02 00 01\n",
      {});
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames[2].other, 1U);
  EXPECT_EQ(frames[2].text, "answer of station 255, not 2");
  EXPECT_EQ(frames[3].other, 0U);
}

// --- numbers that are no bytes ---

TEST(NumbersInALog, AByteInDecimalWithItsHexBesideItIsOneByte) {
  for (const char* const log : {"[10:00:00.025][V][modbus:042]: Modbus received Byte  18 (0X12)\n"
                                "[10:00:00.026][V][modbus:042]: Modbus received Byte  52 (0X34)\n",
                                "0.025 RX 0x12 (18)\n0.026 RX 0x34 (52)\n", "0.025 18 [0x12]\n0.026 52 [0x34]\n"}) {
    const LineRecording recording = recording_of(log);
    ASSERT_EQ(recording.frames.size(), 1U) << log;
    EXPECT_EQ(recording.frames[0].bytes, (Bytes{0x12, 0x34})) << log;
    EXPECT_EQ(recording.frames[0].times.size(), 2U) << "one a row";
  }
  EXPECT_EQ(recording_of("0.025 received Byte  1 (0X1)\n").frames[0].bytes, (Bytes{0x01})) << "one digit";
  EXPECT_EQ(refusal_of("0.025 RX 18 (0x45)\n"),
            "no frames found; line 1: left out: cannot tell what '(0x45)' next to its bytes means");
}

TEST(NumbersInALog, NumbersThatWordsNameAreNoBytes) {
  for (const char* const line :
       {"length 12", "port 5020", "connected to plc7:5020", "tcp://plc.local:80", "Polling slave 10", "10:00:00.000 len: 08",
        "127.0.0.1:5020", "baud 9600", "waiting for 50", "read 12 bytes", "sent (12 bytes)"})
    EXPECT_TRUE(refusal_of(line).starts_with("no frames found")) << line;
  for (const char* const line :
       {"0.0 TX length 08 01 03 00 0a 00 02 e4 09", "0.0 TX 08 bytes 01 03 00 0a 00 02 e4 09",
        "0.0 plc7:5020 TX 01 03 00 0a 00 02 e4 09", "0.0 TX 01 03 00 0a 00 02 e4 09 (08 bytes)",
        "0.0 127.0.0.1:5020 > 01 03 00 0a 00 02 e4 09", "0.0 TX (08 bytes): 01 03 00 0a 00 02 e4 09",
        "0.0 TX slave 1 01 03 00 0a 00 02 e4 09", "0.0 station: 1 TX 01 03 00 0a 00 02 e4 09",
        "0.0 COM3:01 03 00 0a 00 02 e4 09", "0.0 [::1]:5020 01 03 00 0a 00 02 e4 09"}) {
    const LineRecording recording = recording_of(line);
    ASSERT_EQ(recording.frames.size(), 1U) << line;
    EXPECT_EQ(recording.frames[0].bytes, (Bytes{0x01, 0x03, 0x00, 0x0A, 0x00, 0x02, 0xE4, 0x09})) << line;
  }
}

TEST(NumbersInALog, ANumberThatMayBeAByteOrNotIsNamed) {
  using Case = std::pair<const char*, const char*>;
  for (const auto& [line, what] :
       {Case{"1700000000 01 03 00 0a 00 02 e4 09", "1700000000"}, Case{"000123 01 03 00 0a", "000123"},
        Case{"length 12 01 03 00 0a 00 02 e4 09", "12"}, Case{"packet 12 01 03 00 0a 00 02 e4 09", "12"},
        Case{"0000 01 03 00 0a", "0000"}, Case{"0x01 03 00 0a", "03"}})
    EXPECT_EQ(refusal_of(line),
              fmt::format("no frames found; line 1: left out: cannot tell what '{}' next to its bytes means", what));
  EXPECT_EQ(recording_of("01,03,00,0a,00,02,e4,09\n").frames[0].bytes.size(), 8U) << "no time";
}

TEST(NumbersInALog, ARecordingOfACanBusIsNamed) {
  for (const std::string log :
       {"(1616595070.123456) can0 601#0B03006300020000\n", "  can0  601   [8]  0B 03 00 63 00 02 00 00\n",
        "date Wed Mar 24 14:11:10 2021\nbase hex  timestamps absolute\n"
        "   0.012345 1  601             Rx   d 8 0B 03 00 63 00 02 00 00\n"})
    EXPECT_EQ(refusal_of(log), "it is a recording of a CAN bus, not of a serial line") << log;
}

TEST(NumbersInALog, XmlIsNamed) {
  const std::string refusal = "it is XML; write a line for each frame, with its time, its direction and its bytes in hex";
  EXPECT_EQ(refusal_of("<?xml version=\"1.0\"?>\n<log/>\n"), refusal);
  EXPECT_EQ(refusal_of("<log>\n <frame time=\"09:15:02.123\" dir=\"TX\">01 03</frame>\n</log>\n"), refusal);
  EXPECT_EQ(recording_of("<01><03>\n").frames.size(), 1U) << "characters that were received";
}

TEST(NumbersInALog, ANameAfterAnArrowIsNoDamagedByte) {
  const auto frames =
      read("10:00:00.100 PC -> CPU 01 03 00 0a 00 02 e4 09\n10:00:00.140 CPU -> PC  01 03 04 12 34 56 78 81 07\n");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].frame.bytes.size(), 9U);
  EXPECT_FALSE(frames[1].not_read);
  EXPECT_EQ(read("10:00:00.100 M -> S 01\n").front().frame.bytes, Bytes{0x01});
}

TEST(NumbersInALog, WiresharksListOfPacketsIsNamed) {
  EXPECT_EQ(refusal_of("\"No.\",\"Time\",\"Source\",\"Destination\",\"Protocol\",\"Length\",\"Info\"\n"
                       "\"1\",\"0.0\",\"192.168.0.5\",\"192.168.0.9\",\"Modbus/TCP\",\"66\",\"Query: Trans: 1\"\n"),
            "it is Wireshark's list of packets without their bytes; save the capture itself, with File, Save As");
}

TEST(NumbersInALog, AProgramInStlIsNoRecording) {
  const std::string refusal = "it is a program in STL, not a recording; s7200 check reads it, s7200 run runs it";
  EXPECT_EQ(refusal_of("NETWORK 1\nLD SM0.0\n= M0.0\nMEND\n"), refusal);
  EXPECT_EQ(refusal_of("ORGANIZATION_BLOCK MAIN:OB1\nNetwork 10 // one\nLD SM0.1\nMOVB 16#09, SMB30\nED\nCALL 10\n"),
            refusal);
  EXPECT_EQ(recording_of("ED\n0A 0B\n").frames.size(), 2U) << "bytes, though mnemonics are spelt the same";
}

// --- what wrong frames are ---

TEST(WrongFrames, AFrameOfAnotherKindIsNamed) {
  const auto said = [](const std::string& log) { return texts(read(log)).back(); };
  EXPECT_EQ(said("TX 01 03 00 0a 00 02\n"), "a request without its CRC");
  EXPECT_EQ(said("TX 01 03 00 0a 00 02 e4 09\nRX 01 03 04 12 34 56 78\n"), "an answer without its CRC");
  EXPECT_EQ(said("TX 01 03 00 0a 00 02 09 e4\n"), "its CRC has the high byte first: Modbus RTU sends the low byte first");
  EXPECT_EQ(said("TX 01 03 00 0a 00 02 e4 09\nRX 10 00 02 00 02 16\n"), "a frame of PPI, not of Modbus RTU");
  EXPECT_EQ(said("TX 01 03 00 0a 00 02 e4 09\nTX 00 01 00 00 00 06 01 03 00 0a 00 02\n"),
            "a message of Modbus TCP, not of Modbus RTU: it has a head and no CRC");
  EXPECT_EQ(said("TX 01 03 00 0a 00 02 e4 08\n"), "wrong CRC, or not a whole frame");
}

}  // namespace
}  // namespace s7200::tools::rows_test
