// Recordings of lines in the forms that tools write.
#include "tools/recordings/recording.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <tuple>

#include "interpreter/base/ppi_frame.hpp"
#include "interpreter/model/s7_pdu.hpp"
#include "serial_sim/modbus/mbap.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/record/pcap_capture.hpp"
#include "serial_sim/westinghouse/messages/hppc_message.hpp"
#include "tools/master/protocol.hpp"
#include "tools/recordings/decoded.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/playback.hpp"

namespace s7200::tools::recording_test {
namespace {

constexpr Time ms = kMillisecond;

LineRecording recording_of(const std::string& bytes, const ReadingChoices& choices = {}) {
  auto recording = read_recording(bytes, choices);
  EXPECT_TRUE(recording) << recording.why();
  return recording.value_or(LineRecording{});
}

std::string refusal_of(const std::string& bytes) { return read_recording(bytes, {}).why(); }

const Bytes kRequest{0x01, 0x03, 0x00, 0x00, 0x00, 0x01, 0x84, 0x0A}, kAnswer{0x01, 0x03, 0x02, 0x12, 0x34, 0xB5, 0x33};

// --- fields ---

TEST(RecordedFields, TimesAreReadInTheFormsOfTools) {
  const auto time = [](std::string_view text) {
    const auto found = leading_time(text);
    return found ? std::optional(found->time) : std::nullopt;
  };
  EXPECT_EQ(time("12:34:56.789 TX"), ((12 * 60 + 34) * 60 + 56) * kSecond + 789 * ms);
  EXPECT_EQ(time("[2026-11-22 00:00:01,5] 01 03"), kSecond + 500 * ms);
  EXPECT_EQ(time("22.11.2026 00:00:01 >"), kSecond);
  EXPECT_EQ(time("3/1/2024 12:00:00.025 [RX] - 01"), 12 * 3600 * kSecond + 25 * ms);
  EXPECT_EQ(time("3/1/2024 1:00:00 PM 01"), 13 * 3600 * kSecond);
  EXPECT_EQ(time("12:00:01 AM 01"), kSecond);
  EXPECT_EQ(time("[0.123456] 01 03"), 123'456 * kMicrosecond);
  EXPECT_EQ(time("12.5 ms 01"), 12'500 * kMicrosecond);
  EXPECT_EQ(time("+7ms 01"), 7 * ms);
  EXPECT_EQ(time("[-0.002] 01 03"), -2 * ms) << "before the trigger";
  EXPECT_EQ(time("Nov 27 00:00:01 plc: 01 03"), kSecond) << "of syslog";
  EXPECT_EQ(time("Fri Nov 27 00:00:01.5 2026 01 03"), kSecond + 500 * ms) << "of ctime";
  EXPECT_EQ(leading_time("Fri Nov 27 00:00:01 2026 01 03")->length, 25U) << "with its year";
  EXPECT_EQ(leading_time("Nov 27 00:00:01 20 03")->length, 16U) << "a byte, not a year";
  EXPECT_EQ(time("1700000000.100000 01 03"), 1'700'000'000 * kSecond + 100 * ms) << "since 1970";
  EXPECT_EQ(time("4000000000.5 01 03"), std::nullopt) << "the difference of two would not fit";
  EXPECT_EQ(time("01 03 00"), std::nullopt) << "bytes";
  EXPECT_EQ(time("TX 01 03"), std::nullopt);
}

TEST(RecordedFields, DirectionsAreReadInTheWordsOfTools) {
  for (const char* word : {"TX:", "sent", "--> ", ">", "Request", "IRP_MJ_WRITE"})
    EXPECT_EQ(direction_of(word), Direction::Request) << word;
  for (const char* word : {"Rx", "received 8", "<-", "< ", "response:", "IRP_MJ_READ"})
    EXPECT_EQ(direction_of(word), Direction::Answer) << word;
  for (const char* word :
       {"Gesendet:", "Anfrage", "envoyé", "Requête", "Enviado", "inviato", "Передача", "发送：", "发→◇", "→"})
    EXPECT_EQ(direction_of(word), Direction::Request) << word;
  for (const char* word :
       {"Empfangen:", "Antwort", "reçu", "Réponse", "Recibido", "ricevuto", "Прием", "接收：", "收←◆", "←"})
    EXPECT_EQ(direction_of(word), Direction::Answer) << word;
  for (const char* word : {"", "COM1", "context", "already"}) EXPECT_EQ(direction_of(word), Direction::Unknown) << word;
}

TEST(RecordedFields, BytesAreReadInTheFormsOfTools) {
  const Bytes bytes{0x01, 0x03, 0xAB};
  for (const char* text : {"01 03 ab", "0x01, 0x03, 0xAB", "[01][03][AB]", "<01><03><AB>", "0103ab", "01-03-AB",
                           "\"01 03 AB\"", "0x1 0x3 0xab"})
    EXPECT_EQ(bytes_of_text(text), bytes) << text;
  for (const char* text : {"", "hello", "1", "123", "0.25", "01 xx 03x"})
    EXPECT_EQ(bytes_of_text(text), std::nullopt) << text;
  const auto found = BytesOfLines().in("COM3 TX (8): 01 03 AB");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->bytes, bytes);
}

// --- forms ---

TEST(Recordings, ATextLogHasAFrameInEachLine) {
  const LineRecording log =
      recording_of("log of COM3\n00:00:10.000 TX: 01 03 00 00 00 01 84 0A\n00:00:10.025 RX: 01 03 02 12 34 B5 33\n");
  ASSERT_EQ(log.frames.size(), 2U);
  EXPECT_EQ(log.frames[0].bytes, kRequest);
  EXPECT_EQ(log.frames[0].direction, Direction::Request);
  EXPECT_EQ(log.frames[0].place, "line 2");
  EXPECT_EQ(log.frames[1].bytes, kAnswer);
  EXPECT_EQ(log.frames[1].direction, Direction::Answer);
  EXPECT_EQ(log.frames[1].at, 25 * ms);
  EXPECT_EQ(log.notes, std::vector<std::string>{"line 1: left out: no bytes in it"});
}

TEST(Recordings, TheLengthBelowADumpWhoseRowsAreAllLeftOutIsOfNoFrame) {
  const std::string full = "00000000  01 03 00 00 00 01 84 0a 01 03 00 00 00 01 84 0a\n";
  for (const std::string& rows :
       {std::string("00000000  01 03 0? 00\n"), full + "00000030  01 03\n", full + "00000010  01 0?\n00000020  01 03\n"})
    EXPECT_TRUE(refusal_of(rows + "00000004\n").starts_with("no frames found")) << rows;
}

TEST(Recordings, WhatALineRepeatsManyTimesIsReadAllTheSame) {
  const std::string blanks(100'000, ' '), dashes(100'000, '-'), digits(100'000, '7');
  for (const std::string& line :
       {blanks + "01 03", "a" + dashes + "> b", "a" + blanks + "-> b", "> 0x01 (" + dashes + ")", "> 0x01" + blanks,
        "1.0" + blanks + "01 03", "Tx:" + digits + "-01", "00000000  " + blanks + "01 03"}) {
    const LineRecording log = recording_of(line + "\n0.5 TX 01 03 00 00 00 01 84 0A\n");
    ASSERT_FALSE(log.frames.empty()) << line.substr(0, 30);
    EXPECT_EQ(log.frames.back().bytes, kRequest) << line.substr(0, 30);
  }
  std::string received = "recv:", again = "recv: 0x1 old_data:";
  for (int i = 0; i < 30'000; ++i) received += " 0x1", again += " 0x1";
  EXPECT_EQ(recording_of(again + "\n" + received + "\n").frames.at(1).bytes.size(), 30'000U);
}

TEST(Recordings, TheMarkThatSomeEditorsPutBeforeATextIsNoPartOfIt) {
  for (const char* const text :
       {"2026-11-22 10:00:00.5 TX 01 03 00 00 00 01 84 0A\n2026-11-22 10:00:01 RX 01 03 02 12 34 B5 33\n",
        "Time;Data\n0.5;01 03 00 00 00 01 84 0A\n1;01 03 02 12 34 B5 33\n"}) {
    const LineRecording recording = recording_of(std::string("\xEF\xBB\xBF") + text);
    ASSERT_EQ(recording.frames.size(), 2U) << text;
    EXPECT_EQ(recording.frames[0].at, 0) << text;
    EXPECT_EQ(recording.frames[1].at, 500 * ms) << text;
    EXPECT_EQ(recording.frames[0].bytes, kRequest) << text;
  }
}

TEST(Recordings, WhatMbpollPrintsHasNoTimesAndSaysItsDirectionsInBrackets) {
  const LineRecording log =
      recording_of("[01][03][00][00][00][01][84][0A]\nWaiting for a confirmation...\n<01><03><02><12><34><B5><33>\n");
  ASSERT_EQ(log.frames.size(), 2U);
  EXPECT_EQ(log.frames[0].direction, Direction::Request);
  EXPECT_EQ(log.frames[1].direction, Direction::Answer);
  EXPECT_EQ(log.frames[1].at, std::nullopt);
}

TEST(Recordings, OnlyWhatMbpollPrintsInBracketsIsAFrame) {
  const LineRecording log = recording_of(
      "Set rtu baudrate=9600\nmbpoll 1.0-0 - FieldTalk(tm) Modbus(R) Master Simulator\n"
      "[01][03][00][00][00][01][84][0A]\nWaiting for a confirmation...\n<01><03><02><12><34><B5><33>\n"
      "[1]: \t4369\n[10]: \t11\n5 frames transmitted, 5 received, 0 errors, 0.0% frame loss\n");
  EXPECT_EQ(log.form, "mbpoll");
  EXPECT_EQ(log.notes, std::vector<std::string>{});
  ASSERT_EQ(log.frames.size(), 2U);
  EXPECT_EQ(log.frames[0].bytes, kRequest);
  EXPECT_EQ(log.frames[0].place, "line 3");
  EXPECT_EQ(log.frames[1].bytes, kAnswer);
  EXPECT_EQ(
      refusal_of("mbpoll 1.0-0\n-- Polling slave 1...\n[1]: \t4369\n"),
      "no frames found; mbpoll prints frames only with its option -v; writes and 32-bit values are not rebuilt from what it "
      "prints without");
}

TEST(Recordings, TheCounterOfModbusPollIsNoData) {
  const LineRecording log = recording_of("Tx:000001-01 03 00 00 00 01 84 0A\nRx:000002-01 03 02 12 34 B5 33\n");
  ASSERT_EQ(log.frames.size(), 2U);
  EXPECT_EQ(log.frames[0].bytes, kRequest);
  EXPECT_EQ(log.frames[0].direction, Direction::Request);
  EXPECT_EQ(log.frames[1].bytes, kAnswer);
  EXPECT_EQ(log.frames[1].direction, Direction::Answer);
}

TEST(Recordings, RowsBelowALineWithItsTimeAreItsFrameAndCharactersBesideTheHexAreNoData) {
  const LineRecording hhd = recording_of(
      "[12:00:00.123] IRP_MJ_WRITE - Request sends 8 bytes\n  01 03 00 00 00 01 84 0A   ........\n"
      "[12:00:00.150] IRP_MJ_READ - 7 bytes\n  01 03 02 12 34 B5 33   ....4.3\n");
  ASSERT_EQ(hhd.frames.size(), 2U);
  EXPECT_EQ(hhd.notes, std::vector<std::string>{});
  EXPECT_EQ(hhd.frames[0].bytes, kRequest);
  EXPECT_EQ(hhd.frames[0].direction, Direction::Request);
  EXPECT_EQ(hhd.frames[1].bytes, kAnswer);
  EXPECT_EQ(hhd.frames[1].direction, Direction::Answer);
  EXPECT_EQ(hhd.frames[1].at, 27 * ms);

  const LineRecording rows = recording_of(
      "2024-03-01 12:00:00.000100: ttyS0 -> ttyS1\n"
      "30 31 32 33 34 35 36 37 38 39 41 42 43 44 45 46 0123456789ABCDEF\n"
      "20 41 20                                         A\n"
      "2024-03-01 12:00:00.025100: ttyS1 -> ttyS0\n30 31 32 33                                      0123\n");
  ASSERT_EQ(rows.frames.size(), 2U);
  EXPECT_EQ(rows.frames[0].bytes.size(), 16U + 3U) << "a full row goes on in the next";
  EXPECT_EQ(rows.frames[0].direction, Direction::Unknown) << "an arrow between two names does not say who is the master";
  EXPECT_EQ(rows.frames[1].bytes, (Bytes{0x30, 0x31, 0x32, 0x33}));
  EXPECT_EQ(rows.frames[1].at, 25 * ms);
  EXPECT_EQ(recording_of("01 02  03 04\n").frames[0].bytes.size(), 4U) << "two blanks alone are no such column";
}

TEST(Recordings, WhatStandsBesideTheBytesOfALineIsNoneOfThem) {
  for (const char* const line :
       {"0.000 TX 01 03 00 00 00 01 84 0A ; read pump 12", "0.000 TX 01 03 00 00 00 01 84 0A // 12",
        "0.000 TX 01 03 00 00 00 01 84 0A # 12", "0.000 TX 01 03 00 00 00 01 84 0A; pump 12",
        "0.000 TX 01 03 00 00 00 01 84 0A crc ok", "0.000 TX 01 03 00 00 00 01 84 0A feed pump",
        "0.000 TX 01 03 00 00 00 01 84 0A (8 bytes)", "0.000 TX 01 03 00 00 00 01 84 0A ; at 10:00:00",
        "0.000 TX 01 03 00 00 00 01 84 0A  |........|", "0.000 TX [8 bytes] 01 03 00 00 00 01 84 0A",
        "0.000 TX len=08 01 03 00 00 00 01 84 0A", "0.000 SEND: 0x1 0x3 0x0 0x0 0x0 0x1 0x84 0xa",
        "Nov 22 10:00:00 TX 01 03 00 00 00 01 84 0A", "0.000 TX 01; 03; 00; 00; 00; 01; 84; 0A",
        "2026-11-22T10:00:00.000Z,TX,010300000001840A", "0,000;TX;01 03 00 00 00 01 84 0A"}) {
    const LineRecording log = recording_of(line);
    ASSERT_EQ(log.frames.size(), 1U) << line;
    EXPECT_EQ(log.frames[0].bytes, kRequest) << line;
    EXPECT_EQ(log.frames[0].direction, Direction::Request) << line;
  }
}

TEST(Recordings, OfALineWhoseBytesAreInDoubtNoPartIsRead) {
  using Case = std::pair<const char*, const char*>;
  for (const auto& [line, what] :
       {Case{"0.030 RX 01 03 04 12 34 FF FB ?? F6", "??"}, Case{"0.030 RX 01 03 04 12 3G FF FB", "3G"},
        Case{"0.030 RX 1 03 02 12 34 B5 33", "1"}, Case{"0.030 RX 01 03 02 12 34 lost B5 33", "lost"},
        Case{"0.030 RX 01 03 02 12 34 B5 33 3", "3"}, Case{"0.030 RX :010300C80002 45", ":010300C80002"},
        Case{"0.030 RX 01 03 02 0x123 34 B5 33", "0x123"}})
    EXPECT_EQ(refusal_of(line),
              fmt::format("no frames found; line 1: left out: cannot tell what '{}' next to its bytes means", what));
}

TEST(Recordings, ALineMayBeVeryLong) {
  std::string pairs;
  for (int i = 0; i < 100'000; ++i) pairs += "01";
  EXPECT_EQ(recording_of("0.000 TX 01 " + pairs + " ; x\n").frames.size(), 1U);
  const RecordedFrame doubtful = recording_of("0.000 TX 01 " + pairs + "; x\n").frames.at(0);
  ASSERT_TRUE(doubtful.doubt);
  EXPECT_EQ(doubtful.doubt->why, "cannot tell what 'x' next to its bytes means");
}

TEST(Recordings, TheOffsetBeforeARowIsNoDataAndAFrameWithADoubtfulRowIsLeftOut) {
  const std::string full = "00 01 02 03 04 05 06 07 08 09 0A 0B 0C 0D 0E 0F\n", next = "10:00:01.000 RX\n0000  01 03\n";
  const LineRecording log = recording_of("10:00:00.000 TX\n0000   " + full + "0010   10 11\n" + next);
  ASSERT_EQ(log.frames.size(), 2U);
  EXPECT_EQ(log.frames[0].bytes.size(), 18U);
  EXPECT_EQ(log.frames[0].bytes.front(), 0U);
  for (const std::string& rows : {full + "10 ?? 12\n", full + "10 ?? 12\n13\n", "10 ?? 12\n" + full}) {
    const LineRecording lost = recording_of("10:00:00.000 TX\n" + rows + next);
    ASSERT_EQ(lost.frames.size(), 2U) << rows;
    EXPECT_EQ(lost.frames[0].bytes, Bytes{}) << rows;
    EXPECT_TRUE(lost.frames[0].doubt) << rows;
    EXPECT_EQ(lost.frames[0].at, 0) << "the place is kept";
    EXPECT_EQ(lost.frames[1].bytes, (Bytes{0x01, 0x03})) << rows;
  }
}

TEST(Recordings, TheLineOfSocatAboveTheBytesHasTheirTimeAndDirection) {
  const LineRecording log = recording_of(
      "> 2026/11/22 10:00:01.000123  length=8 from=8 to=15\n 01 03 00 00 00 01 84 0a\n--\n"
      "< 2026/11/22 10:00:01.030123  length=7 from=8 to=14\n 01 03 02 12 34 b5 33\n--\n");
  ASSERT_EQ(log.frames.size(), 2U);
  EXPECT_EQ(log.frames[0].bytes, kRequest);
  EXPECT_EQ(log.frames[0].direction, Direction::Request);
  EXPECT_EQ(log.frames[1].bytes, kAnswer);
  EXPECT_EQ(log.frames[1].direction, Direction::Answer);
  EXPECT_EQ(log.frames[1].at, 30 * ms);
}

TEST(Recordings, DigitsOfADateOrAClockAtTheEndOfALineAreNoBytes) {
  const LineRecording log = recording_of(
      "Docklight Log File (HEX) - started 22.11.2026 10:00:00\nlog of 2026-11-22\n"
      "22.11.2026 10:00:00.123 [TX] - 01 03 00 00 00 01 84 0A\n22.11.2026 10:00:00.150 [RX] - 01 03 02 12 34 B5 33\n"
      "Docklight Log File - closed (22.11.2026 10:00:05)\n");
  ASSERT_EQ(log.frames.size(), 2U);
  EXPECT_EQ(log.frames[0].bytes, kRequest);
  EXPECT_EQ(log.frames[0].direction, Direction::Request);
  EXPECT_EQ(log.frames[1].at, 27 * ms);
  EXPECT_EQ(log.notes, std::vector<std::string>{"line 1: left out, and 2 more: no bytes in it"});
}

TEST(Recordings, TheOffsetsOfADumpAreNoData) {
  const LineRecording log =
      recording_of("00000000  01 03 00 00 00 01 84 0a                           |........|\n00000008\n");
  ASSERT_EQ(log.frames.size(), 1U);
  EXPECT_EQ(log.frames[0].bytes, kRequest);
  const LineRecording rows = recording_of(
      "00000000  00 01 02 03 04 05 06 07  08 09 0a 0b 0c 0d 0e 0f  |................|\n00000010  10 11  |..|\n00000012\n");
  ASSERT_EQ(rows.frames.size(), 1U);
  EXPECT_EQ(rows.frames[0].bytes.size(), 18U);
  EXPECT_EQ(rows.frames[0].bytes.back(), 0x11);
  EXPECT_EQ(refusal_of("00000040  01 03 00 00 00 01 84 0a\n"),
            "no frames found; line 1: left out: cannot tell what '00000040' next to its bytes means")
      << "what stands above it is missing";
}

TEST(Recordings, LogsOfIntercepttyAndEltimaAndSerialMonitorAreRead) {
  const LineRecording characters = recording_of(
      "> \t0x01 (^A)\n> \t0x03 (^C)\n> \t0x00 (^@)\n> \t0x00 (^@)\n> \t0x00 (^@)\n> \t0x01 (^A)\n> \t0x84\n> \t0x0a (^J)\n"
      "< \t0x01 (^A)\n< \t0x03 (^C)\n< \t0x02 (^B)\n< \t0x12 (^R)\n< \t0x34 (4)\n< \t0xb5\n< \t0x33 (3)\n");
  const LineRecording table = recording_of(
      "#|Time|Function|Direction|Status|Data|Data (chars)|Data length|Req. length|Port|Comments|\n"
      "1|23/11/2026 10:00:00|IRP_MJ_WRITE|DOWN|STATUS_SUCCESS|01 03 00 00 00 01 84 0a|........|8|8|COM1||\n"
      "2|23/11/2026 10:00:00|IRP_MJ_READ|UP|STATUS_SUCCESS|01 03 02 12 34 b5 33|....4.3|7|7|COM1||\n");
  const LineRecording dump = recording_of(
      "[23/11/2026 10:00:00] Written data (COM1)\n"
      "    01 03 00 00 00 01 84 0a                           ......\u201E.\n"
      "[23/11/2026 10:00:00] Read data (COM1)\n"
      "    01 03 02 12 34 b5 33                              ....4\u00B53\n");
  for (const LineRecording* log : {&characters, &table, &dump}) {
    EXPECT_EQ(log->notes, std::vector<std::string>{});
    ASSERT_EQ(log->frames.size(), 2U);
    EXPECT_EQ(log->frames[0].bytes, kRequest);
    EXPECT_EQ(log->frames[1].bytes, kAnswer);
  }
  EXPECT_EQ(characters.frames[1].direction, Direction::Answer);
  EXPECT_EQ(dump.frames[0].direction, Direction::Request);
  EXPECT_EQ(dump.frames[1].direction, Direction::Answer);
}

TEST(Recordings, ALogOfPymodbusHasEachFrameOnce) {
  const LineRecording log = recording_of(
      "2026-11-22 10:00:00,000 DEBUG logging:103 Resetting frame - Current Frame in buffer - \n"
      "2026-11-22 10:00:00,001 DEBUG logging:103 send: 0x1 0x3 0x0 0x0 0x0 0x1 0x84 0xa\n"
      "2026-11-22 10:00:00,020 DEBUG logging:103 recv: 0x1 0x3 0x2 old_data:  addr=None\n"
      "2026-11-22 10:00:00,020 DEBUG logging:103 Processing: 0x1 0x3 0x2\n"
      "2026-11-22 10:00:00,026 DEBUG logging:103 recv: 0x12 0x34 0xb5 0x33 old_data: 0x1 0x3 0x2 addr=None\n"
      "2026-11-22 10:00:00,026 DEBUG logging:103 Processing: 0x1 0x3 0x2 0x12 0x34 0xb5 0x33\n"
      "2026-11-22 10:00:00,026 DEBUG logging:103 Getting Frame - 0x3 0x2 0x12 0x34\n");
  EXPECT_EQ(log.form, "pymodbus");
  EXPECT_EQ(log.notes, std::vector<std::string>{});
  ASSERT_EQ(log.frames.size(), 2U);
  EXPECT_EQ(log.frames[0].bytes, kRequest);
  EXPECT_EQ(log.frames[0].direction, Direction::Request);
  EXPECT_EQ(log.frames[1].bytes, kAnswer) << "two pieces";
  EXPECT_EQ(log.frames[1].direction, Direction::Answer);
  EXPECT_EQ(log.frames[1].at, 19 * ms);
}

TEST(Recordings, ALogOfPymodbus2HasEachFrameOnce) {
  const LineRecording log = recording_of(
      "DEBUG:pymodbus.transaction:Running transaction 1\n"
      "DEBUG:pymodbus.transaction:SEND: 0x1 0x3 0x0 0x0 0x0 0x1 0x84 0xa\n"
      "DEBUG:pymodbus.transaction:RECV: 0x1 0x3 0x2 0x12 0x34 0xb5 0x33\n"
      "DEBUG:pymodbus.framer.rtu_framer:Getting Frame - 0x3 0x2 0x12 0x34\n"
      "DEBUG:pymodbus.factory:Factory Response[ReadHoldingRegistersResponse: 3]\n"
      "DEBUG:pymodbus.framer.rtu_framer:Frame advanced, resetting header!!\n");
  EXPECT_EQ(log.form, "pymodbus");
  ASSERT_EQ(log.frames.size(), 2U);
  EXPECT_EQ(log.frames[0].bytes, kRequest);
  EXPECT_EQ(log.frames[1].bytes, kAnswer);
}

TEST(Recordings, ALogOfPymodbusMayBeAServersAndSayExtraData) {
  const LineRecording log = recording_of(
      "DEBUG:pymodbus.logging:recv: 0x1 0x3 0x0 0x0 0x0 0x1 0x84 0xa extra data: \n"
      "DEBUG:pymodbus.logging:Processing: 0x1 0x3 0x0 0x0 0x0 0x1 0x84 0xa\n"
      "DEBUG:pymodbus.logging:send: 0x1 0x3 0x2 0x12 0x34 0xb5 0x33\n");
  ASSERT_EQ(log.frames.size(), 2U);
  EXPECT_EQ(log.frames[0].bytes, kRequest);
  EXPECT_EQ(log.frames[0].direction, Direction::Unknown) << "what has come first is a request, or a log cut off";
  EXPECT_EQ(log.frames[1].bytes, kAnswer);
  EXPECT_EQ(conversation(log, *find_recorded_protocol("modbus"))[1].direction, Direction::Answer);
}

TEST(Recordings, ALogOfPymodbusSaysWhatAServerHandles) {
  const std::string request = "DEBUG:pymodbus.server:Handling data: 0x1 0x3 0x0 0x0 0x0 0x1 0x84 0xa\n";
  for (const std::string& text : {request + "DEBUG:pymodbus.server:send: [ReadRegisterResponse (1)]- b'0103021234b533'\n",
                                  "DEBUG:pymodbus.logging:recv: 0x1 0x3 0x0 0x0 0x0 0x1 0x84 0xa old_data:  addr=None\n" +
                                      request + "DEBUG:pymodbus.logging:send: 0x1 0x3 0x2 0x12 0x34 0xb5 0x33\n"}) {
    const LineRecording log = recording_of(text);
    EXPECT_EQ(log.form, "pymodbus");
    ASSERT_EQ(log.frames.size(), 2U) << text;
    EXPECT_EQ(log.frames[0].bytes, kRequest);
    EXPECT_EQ(log.frames[1].bytes, kAnswer);
  }
}

constexpr const char* kReadAsTcp = "the frames are messages of Modbus TCP: each is shown as on a serial line, with its CRC";

TEST(Recordings, ModbusTcpInALogIsReadByItsHead) {
  for (const char* text :
       {"Tx:000000-00 07 00 00 00 06 01 03 00 00 00 01\nRx:000001-00 07 00 00 00 05 01 03 02 12 34\n",
        "[00][07][00][00][00][06][01][03][00][00][00][01]\nWaiting for a confirmation...\n"
        "<00><07><00><00><00><05><01><03><02><12><34>\n",
        "Time;Dir;Data\n0.5;TX;00 07 00 00 00 06 01 03 00 00 00 01\n1;RX;00 07 00 00 00 05 01 03 02 12 34\n"}) {
    const LineRecording log = recording_of(text);
    EXPECT_EQ(log.notes, std::vector<std::string>{kReadAsTcp}) << text;
    ASSERT_EQ(log.frames.size(), 2U) << text;
    EXPECT_EQ(log.frames[0].bytes, kRequest) << text;
    EXPECT_EQ(log.frames[0].direction, Direction::Request) << text;
    EXPECT_EQ(log.frames[1].bytes, kAnswer) << text;
    EXPECT_EQ(log.frames[1].exchange, log.frames[0].exchange) << text;
    EXPECT_NE(log.frames[1].stream, 0U) << text;
  }
}

TEST(Recordings, OfALogOfModbusTcpWhatIsNoWholeMessageIsLeftOut) {
  const LineRecording log = recording_of(
      "TX 00 07 00 00 00 06 01 03 00 00 00 01\nRX 00 07 00 00 00 05 01 03 02 12\n"
      "TX 00 08 00 00 00 06 01 03 00 00 00 01 00 09 00 00 00 06 01 03 00 00 00 01\n");
  EXPECT_EQ(log.notes, (std::vector<std::string>{kReadAsTcp, "line 2: left out: it is not a whole message of Modbus TCP"}));
  ASSERT_EQ(log.frames.size(), 4U) << "two messages in one segment";
  EXPECT_TRUE(log.frames[1].doubt) << "the place is kept";
  EXPECT_EQ(log.frames[3].bytes, kRequest);
}

TEST(Recordings, ARequestOnASerialLineThatLooksLikeTheHeadOfModbusTcpIsNone) {
  const LineRecording log = recording_of("TX 01 03 00 00 00 02 C4 0B\n");
  EXPECT_EQ(log.notes, std::vector<std::string>{});
  EXPECT_EQ(log.frames[0].bytes.size(), 8U);
  EXPECT_EQ(log.frames[0].stream, 0U);
}

TEST(Recordings, TimesThatAreNotUnderstoodOrRunBackwardsAreNoted) {
  EXPECT_EQ(recording_of("Mon 12:00 TX 01 03 00 00 00 01 84 0A\n").notes,
            std::vector<std::string>{"line 1: read without a time: cannot read '12:00' as one"});
  EXPECT_EQ(recording_of("10:15:01:103 TX 01 03 00 00 00 01 84 0A\n10:15:01:128 RX 01 03 02 12 34 B5 33\n"
                         "TX at 10:15 01 03 00 00 00 01 84 0A\nRX at 10:15 01 03 02 12 34 B5 33\n")
                .notes,
            std::vector<std::string>{"line 3: read without a time, and 1 more: cannot read '10:15' as one"});
  const LineRecording log = recording_of(
      "10:00:00.000 > 01 03 00 00 00 01 84 0A\n10:00:00.025 < 01 03 02 12 34 B5 33\n"
      "10:00:00.020 > 01 03 00 00 00 01 84 0A\n");
  EXPECT_EQ(log.notes,
            std::vector<std::string>{"line 3: its time is before that of the frame above it; no silence is known there"});
}

TEST(Recordings, BlocksOfStep7AreNoBytes) {
  for (const char* const text : {"FUNCTION_BLOCK FB 10\nTITLE =\nBEGIN\nU E 0.0\n", "DATA_BLOCK DB 10\n STRUCT\n",
                                 "// Station 2\nDATA_BLOCK DB12\nBEGIN\n", "FUNCTION FC 20 : VOID\nL 5\nT MW 10\n"})
    EXPECT_EQ(refusal_of(text),
              "it is a block of STEP 7 for the S7-300 and S7-400, neither a recording nor STL of the S7-200")
        << text;
  for (const char* const text : {"Hallo,\nbitte in DB 10 nachsehen.\n", "Der Wert steht in DB10 und FC 22\n",
                                 "CALL FB 10, DB 11\n", "siehe (DB 10)\n"})
    EXPECT_EQ(refusal_of(text),
              "no frames found; line 1: left out" + std::string(text[0] == 'H' ? ", and 1 more" : "") + ": no bytes in it")
        << text;
  EXPECT_EQ(recording_of("TX DB 10\nRX FB 10\n").frames.at(1).bytes, (Bytes{0xFB, 0x10})) << "beside a direction";
}

TEST(Recordings, CharactersWithTimesOfTheirOwnBecomeFramesBySilence) {
  std::string csv = "Time [s],Value,Parity Error,Framing Error\n";
  double at = 1.0;
  for (const std::uint8_t byte : kRequest) csv += fmt::format("{:.6f},0x{:02X},,\n", at += 0.001146, byte);
  at += 0.016;
  for (const std::uint8_t byte : kAnswer) csv += fmt::format("{:.6f},0x{:02X},,\n", at += 0.001146, byte);
  const LineRecording recording = recording_of(csv);
  ASSERT_EQ(recording.frames.size(), 2U);
  EXPECT_EQ(recording.form, "CSV");
  EXPECT_EQ(recording.frames[0].bytes, kRequest);
  EXPECT_EQ(recording.frames[1].bytes, kAnswer);
}

TEST(Recordings, ACsvHasItsColumnsByName) {
  const LineRecording recording =
      recording_of("No;Time (ms);Direction;Data\n1;0;TX;01 03 00 00 00 01 84 0A\n2;25,5;RX;\"01 03 02 12 34 B5 33\"\n");
  ASSERT_EQ(recording.frames.size(), 2U);
  EXPECT_EQ(recording.frames[1].direction, Direction::Answer);
  EXPECT_EQ(recording.frames[1].at, 25'500 * kMicrosecond) << "the comma of a decimal, in the column's unit";
  EXPECT_EQ(refusal_of("Time,Data\n0,01 03\nnever,01 03\n"), "line 3: 'never' is not a time");
  EXPECT_EQ(refusal_of("Time,Data\n0,zz\n"), "line 2: 'zz' is not bytes in hex");
}

TEST(Recordings, TheUnitOfTheTimesHoldsWhateverTheColumnOfTheBytesIsCalled) {
  for (const char* const bytes : {"Telegramm", "Nachricht", "Zeichen", "Trame", "Datos", "Was kam", "Inhalt"})
    for (const auto& [unit, answered] : {std::pair{"ms", 21'500 * kMicrosecond}, std::pair{"\u00B5s", Time{21'500}},
                                         std::pair{"\xB5s", Time{21'500}}, std::pair{"us", Time{21'500}}}) {
      const LineRecording read =
          recording_of(fmt::format("Zeit ({});Richtung;{}\n0,000;Senden;01 03 00 00 00 01 84 0A\n"
                                   "21,5;Empfangen;01 03 02 12 34 B5 33\n",
                                   unit, bytes));
      ASSERT_EQ(read.frames.size(), 2U) << bytes;
      EXPECT_EQ(read.frames[0].bytes, kRequest);
      EXPECT_EQ(read.frames[0].direction, Direction::Request);
      EXPECT_EQ(read.frames[1].direction, Direction::Answer);
      EXPECT_EQ(read.frames[1].at, answered) << bytes << ' ' << unit;
    }
  const LineRecording characters = recording_of("Zeit in \u00B5s;Byte\n0;01\n1146;03\n");
  EXPECT_EQ(characters.form, "CSV");
  EXPECT_EQ(characters.frames.at(0).times, (std::vector<Time>{0, 1'146 * kMicrosecond}));
}

TEST(Recordings, ACsvHasColumnsThatAreKnownByTheirCells) {
  const LineRecording characters =
      recording_of("Zeit (ms);Kanal;Zeichen;Parit\u00E4t\n0,000;TX;0x01;OK\n1,146;TX;0x03;OK\n40,0;RX;0x01;OK\n");
  ASSERT_EQ(characters.frames.size(), 2U);
  EXPECT_EQ(characters.frames[0].direction, Direction::Request);
  EXPECT_EQ(characters.frames[0].bytes, (Bytes{0x01, 0x03}));
  EXPECT_EQ(characters.frames[1].at, 40 * ms);
  const LineRecording numbered = recording_of(
      "Lfd. Nr.;Datum/Uhrzeit;Port;Sender;Byteanzahl;Telegramm;CRC\n"
      "1;12.03.2009 14:23:00,100;COM3;PC;8;010300000001840A;ok\n"
      "2;12.03.2009 14:23:00,125;COM3;SPS;7;01030212 34B533;ok\n");
  ASSERT_EQ(numbered.frames.size(), 2U);
  EXPECT_EQ(numbered.frames[0].bytes, kRequest);
  EXPECT_EQ(numbered.frames[1].bytes, kAnswer);
  EXPECT_EQ(numbered.frames[1].at, 25 * ms);
  EXPECT_EQ(refusal_of("Zeit (ms);Kanal;Bemerkung\n0,5;TX;gesendet\n3,1;RX;empfangen\n"),
            "no column found for the bytes: name it Hex; line 1: left out, and 2 more: no bytes in it");
}

TEST(Recordings, ACsvWithoutTimesHasItsFramesInTheirOrder) {
  const LineRecording list = recording_of("Dir,Bytes\nTX,01 03 00 00 00 01 84 0A\nRX,01 03 02 12 34 B5 33\n");
  ASSERT_EQ(list.frames.size(), 2U);
  EXPECT_EQ(list.form, "CSV");
  EXPECT_EQ(list.frames[0].bytes, kRequest);
  EXPECT_EQ(list.frames[0].at, std::nullopt);
  EXPECT_EQ(list.frames[1].direction, Direction::Answer);
  EXPECT_EQ(recording_of("log of port 1, all frames\nTX 01 03\n").form, "text") << "no list: no bytes below its columns";
}

TEST(Recordings, ACharacterInDecimalIsOneIfAnyHasOneDigitOrThree) {
  const LineRecording saleae =
      recording_of("Time [s],Value,Parity Error,Framing Error\n0.000,1,,\n0.001,3,,\n0.002,16,,\n0.003,132,,\n");
  ASSERT_EQ(saleae.frames.size(), 1U);
  EXPECT_EQ(saleae.frames[0].bytes, (Bytes{1, 3, 16, 132}));
  EXPECT_EQ(recording_of("Time [s],Value\n0.000,01\n0.001,16\n").frames[0].bytes, (Bytes{0x01, 0x16})) << "pairs are hex";
  EXPECT_EQ(refusal_of("Time [s],Value\n0.000,1\n0.001,256\n"), "line 3: '256' is not bytes in decimal");
}

TEST(Recordings, ALogInUtf16IsReadAsOneInUtf8) {
  const std::string log = "00:00:10.000 TX: 01 03 00 00 00 01 84 0A\r\n";
  std::string little = "\xFF\xFE", big = "\xFE\xFF";
  for (const char c : log) {
    little.append({c, '\0'});
    big.append({'\0', c});
  }
  for (const std::string& file : {little, big}) {
    const LineRecording read = recording_of(file);
    ASSERT_EQ(read.frames.size(), 1U);
    EXPECT_EQ(read.frames[0].bytes, kRequest);
  }
  EXPECT_FALSE(refusal_of("\xFF\xFE\x01").empty());
}

TEST(Recordings, QModMasterSaysTheDirectionBeforeTheTime) {
  const LineRecording log = recording_of(
      "[RTU]>Tx > 10:00:00:500 - 01  03  00  00  00  01  84  0A \n"
      "[RTU]>Rx > 10:00:00:525 - 01  03  02  12  34  B5  33 \n");
  ASSERT_EQ(log.frames.size(), 2U);
  EXPECT_EQ(log.frames[0].bytes, kRequest);
  EXPECT_EQ(log.frames[0].direction, Direction::Request);
  EXPECT_EQ(log.frames[1].direction, Direction::Answer);
  EXPECT_EQ(log.frames[1].at, 25 * ms);
}

/// A block of a pcapng: its type, and its body in whole words.
std::string block(std::uint32_t type, const std::string& body) {
  const auto word = [](std::uint32_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i & 0xFF);
    return bytes;
  };
  const auto length = static_cast<std::uint32_t>(body.size() + 12);
  return word(type) + word(length) + body + word(length);
}

TEST(Recordings, SimplePacketsOfAPcapngHaveNoTimes) {
  const auto words = [](std::initializer_list<std::uint32_t> values) {
    std::string bytes;
    for (const std::uint32_t value : values)
      for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i & 0xFF);
    return bytes;
  };
  std::string file = block(0x0A0D0D0A, words({0x1A2B3C4D, 1, 0xFFFFFFFF, 0xFFFFFFFF})) + block(1, words({147, 0}));
  for (const Bytes& frame : {kRequest, kAnswer}) {
    std::string data(frame.begin(), frame.end());
    data.resize((data.size() + 3) / 4 * 4);
    file += block(3, words({static_cast<std::uint32_t>(frame.size())}) + data);
  }
  const LineRecording read = recording_of(file);
  ASSERT_EQ(read.frames.size(), 2U);
  EXPECT_EQ(read.frames[1].bytes, kAnswer);
  EXPECT_FALSE(read.frames[1].at);
  EXPECT_EQ(read.notes, std::vector<std::string>{"it has simple packets of pcapng, which have no times"});
}

TEST(Recordings, APcapngMayHaveInterfacesOfSeveralLinkTypes) {
  const auto words = [](std::initializer_list<std::uint32_t> values) {
    std::string bytes;
    for (const std::uint32_t value : values)
      for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i & 0xFF);
    return bytes;
  };
  const auto packet = [&](std::uint32_t interface, std::uint32_t microseconds, const Bytes& bytes) {
    std::string data(bytes.begin(), bytes.end());
    const auto length = static_cast<std::uint32_t>(data.size());
    data.resize((data.size() + 3) / 4 * 4);
    return block(6, words({interface, 0, microseconds, length, length}) + data);
  };
  constexpr std::uint32_t kWireless = 105, kSerial = 147;
  const std::string head = block(0x0A0D0D0A, words({0x1A2B3C4D, 1, 0xFFFFFFFF, 0xFFFFFFFF})),
                    wireless = block(1, words({kWireless, 65535})), serial = block(1, words({kSerial, 65535}));
  const LineRecording read =
      recording_of(head + wireless + serial + packet(0, 500, {9}) + packet(1, 1000, kRequest) + packet(1, 26'000, kAnswer));
  ASSERT_EQ(read.frames.size(), 2U);
  EXPECT_EQ(read.frames[0].bytes, kRequest);
  EXPECT_EQ(read.frames[0].place, "packet 2") << "as Wireshark counts them";
  EXPECT_EQ(read.frames[1].at, 25 * ms);
  EXPECT_EQ(read.notes, std::vector<std::string>{"what has link type 105 was left out"});
  EXPECT_EQ(recording_of(head + serial + serial + packet(1, 0, kRequest)).frames.size(), 1U);
  EXPECT_TRUE(refusal_of(head + wireless + packet(0, 0, kRequest)).starts_with("link type 105 is not one of"));
}

TEST(Recordings, ACsvMayHaveAColumnForEachDirection) {
  for (const char* const names : {"Time (ms),Tx,Rx", "time [ms],Request data,Response data"}) {
    const LineRecording read =
        recording_of(fmt::format("{}\n0,01 03 00 00 00 01 84 0A,\n25,,01 03 02 12 34 B5 33\n", names));
    EXPECT_EQ(read.form, "CSV");
    ASSERT_EQ(read.frames.size(), 2U) << names;
    EXPECT_EQ(read.frames[0].bytes, kRequest);
    EXPECT_EQ(read.frames[0].direction, Direction::Request);
    EXPECT_EQ(read.frames[1].bytes, kAnswer);
    EXPECT_EQ(read.frames[1].direction, Direction::Answer);
    EXPECT_EQ(read.frames[1].at, 25 * ms);
  }
  EXPECT_EQ(refusal_of("Time,Tx,Rx\n0,01 03,01 83\n"), "line 2: bytes in both directions; write them in two lines");
  EXPECT_EQ(refusal_of("Time,Tx,Rx\n0,frob,\n"), "line 2: 'frob' is not bytes in hex");
}

std::string printed_by_mbpoll(const std::string& type, const std::string& values) {
  return "mbpoll 1.0-0 - FieldTalk(tm) Modbus(R) Master Simulator\n"
         "Protocol configuration: Modbus RTU\n"
         "Slave configuration...: address = [1]\n"
         "                        start reference = 1, count = 1\n"
         "Data type.............: " +
         type + "\n\n-- Polling slave 1... Ctrl-C to stop)\n" + values;
}

TEST(Recordings, WhatMbpollReadIsMadeOfTheValuesThatItPrints) {
  const std::string holding = "16-bit register, output (holding) register table";
  for (const char* const value : {"[1]: \t0x1234\n", "[1]: \t4660\n"}) {
    const LineRecording read = recording_of(printed_by_mbpoll(holding, value));
    ASSERT_EQ(read.frames.size(), 2U) << value;
    EXPECT_EQ(read.frames[0].bytes, kRequest);
    EXPECT_EQ(read.frames[1].bytes, kAnswer);
    EXPECT_EQ(read.frames[1].direction, Direction::Answer);
    EXPECT_EQ(read.notes.size(), 1U) << "that it printed none";
  }
  EXPECT_EQ(recording_of(printed_by_mbpoll("discrete output (coil)", "[1]: \t1\n")).frames.at(1).bytes,
            modbus::rtu_frame(1, Bytes{1, 1, 1}));
  EXPECT_EQ(recording_of(printed_by_mbpoll(holding, "[1]: \t65535 (-1)\n")).frames.at(1).bytes,
            modbus::rtu_frame(1, Bytes{3, 2, 0xFF, 0xFF}));
  const std::string silent = "Read output (holding) register failed: Connection timed out\n";
  EXPECT_EQ(recording_of(printed_by_mbpoll(holding, silent)).frames.size(), 1U) << "a request without an answer";
  EXPECT_EQ(recording_of(printed_by_mbpoll(holding, "Read output (holding) register failed: Illegal data address\n"))
                .frames.at(1)
                .bytes,
            modbus::rtu_frame(1, Bytes{0x83, 2}));
  EXPECT_TRUE(refusal_of(printed_by_mbpoll(holding, "Read output (holding) register failed: Invalid CRC\n"))
                  .starts_with("no frames found"))
      << "what came instead is not said";
  EXPECT_TRUE(refusal_of(printed_by_mbpoll("32-bit float, output (holding) register table", "[1]: \t1.5\n"))
                  .starts_with("no frames found"));
}

std::string printed_by_mbpoll_of(int reference) {
  std::string printed =
      printed_by_mbpoll("16-bit register, output (holding) register table", fmt::format("[{}]: \t4660\n", reference));
  return printed.replace(printed.find("reference = 1") + 12, 1, std::to_string(reference));
}

TEST(Recordings, ReferencesOfARunOfMbpollThatStartsAtZeroCountFromZero) {
  const LineRecording read = recording_of(printed_by_mbpoll_of(0));
  ASSERT_EQ(read.frames.size(), 2U);
  EXPECT_EQ(read.frames[0].bytes, kRequest) << "the first register";
  EXPECT_EQ(read.frames[1].bytes, kAnswer);
  EXPECT_TRUE(read.notes.at(0).ends_with("; references of a run that starts at 0 count from 0"));
}

TEST(Recordings, EachRunOfMbpollInALogCountsItsReferencesByItself) {
  const LineRecording read = recording_of(printed_by_mbpoll_of(0) + printed_by_mbpoll_of(1) + printed_by_mbpoll_of(3));
  ASSERT_EQ(read.frames.size(), 6U);
  EXPECT_EQ(read.frames[0].bytes, kRequest);
  EXPECT_EQ(read.frames[2].bytes, kRequest) << "1 is the first register, too";
  EXPECT_EQ(read.frames[4].bytes, modbus::rtu_frame(1, Bytes{3, 0, 2, 0, 1}));
  EXPECT_TRUE(
      read.notes.at(0).ends_with("; other references count from 1: if they count from 0, as with mbpoll's option -0, "
                                 "say --mbpoll-0"));
}

TEST(Recordings, ReferencesOfMbpollCountFromZeroIfItIsToldSo) {
  const auto read = read_recording(printed_by_mbpoll_of(3), {.mbpoll_from_zero = true});
  ASSERT_TRUE(read.has_value()) << read.why();
  EXPECT_EQ(read->frames.at(0).bytes, modbus::rtu_frame(1, Bytes{3, 0, 3, 0, 1}));
  EXPECT_EQ(read->notes.at(0), "mbpoll printed values and no frames: these are the frames that reads of them have");
}

std::vector<std::optional<Time>> times_of(const LineRecording& recording) {
  std::vector<std::optional<Time>> times;
  for (const RecordedFrame& frame : recording.frames) times.push_back(frame.at);
  return times;
}

TEST(Recordings, ATimeInACsvIsReadAsAWholeOrNotAtAll) {
  EXPECT_EQ(times_of(recording_of("Time (us);Data\n0;01 03\n12.3 ms;01 03\n")).back(), 12'300 * kMicrosecond)
      << "a unit of its own counts";
  EXPECT_EQ(times_of(recording_of("time,data\n12:00:00.5,01 03\n12:00:01,01 03\n")).back(), 500 * ms);
  EXPECT_EQ(times_of(recording_of("time,data\n1700000000.25,01 03\n1700000000.5,01 03\n")).back(), 250 * ms)
      << "seconds since 1970";
  EXPECT_EQ(refusal_of("Time (ms),Data\n\"25,5\",01 03\n"), "line 2: '25,5' is not a time") << "or thousands";
  EXPECT_EQ(refusal_of("Time;Data\n1.5 x;01 03\n"), "line 2: '1.5 x' is not a time");
  EXPECT_EQ(refusal_of("Time;Data\n1.5 s later;01 03\n"), "line 2: '1.5 s later' is not a time");
  EXPECT_EQ(refusal_of("Time;Data\nnan;01 03\n"), "line 2: 'nan' is not a time");
}

TEST(Recordings, AColumnOfTimesInACsvIsInTheUnitThatItsNameSays) {
  const auto second_time = [](const std::string& name) {
    return times_of(recording_of(name + ";Data\n1000;01 03\n251000;01 03\n")).back();
  };
  for (const char* const name : {"Time [ns]", "Time (ns)", "time_ns", "Start ns"})
    EXPECT_EQ(second_time(name), 250'000) << name;
  for (const char* const name : {"us", "[us]", "t [us]", "t_us", "Time [us]", "Time (\u00B5s)", "time [\u03BCs]"})
    EXPECT_EQ(second_time(name), 250 * ms) << name;
  EXPECT_EQ(second_time("start_ms"), 250 * kSecond);
  for (const char* const name : {"Time", "Time [s]", "Timestamp (sec)", "Time (seconds)"})
    EXPECT_EQ(second_time(name), 250'000 * kSecond) << name;
  EXPECT_EQ(refusal_of("Time [ticks];Data\n1000;01 03\n"),
            "line 1: 'Time [ticks]' names no unit; write [s], [ms], [us] or [ns]");
  EXPECT_EQ(times_of(recording_of("Time (local);Data\n12:00:00.5;01 03\n12:00:01;01 03\n")).back(), 500 * ms)
      << "a time of day needs none";
}

TEST(Recordings, TimesBeforeTheTriggerAreCountedFromTheFirstRow) {
  EXPECT_EQ(times_of(recording_of("Time [s],Value\n-0.002,0103\n-0.5e-3,0103\n0.001,0103\n")),
            (std::vector<std::optional<Time>>{0, 1500 * kMicrosecond, 3 * ms}));
  EXPECT_EQ(times_of(recording_of("-0.002 01 03\n0.001 01 03\n")), (std::vector<std::optional<Time>>{0, 3 * ms}));
}

TEST(Recordings, ACharacterThatTheCsvSaysWasDamagedIsKnownInItsFrame) {
  const LineRecording recording = recording_of(
      "Time [s],Value,Parity Error,Framing Error\n0.000,0x01,,\n0.001,0x03,Error,\n0.002,0x00,0,false\n"
      "0.003,0x00,,Error\n0.500,0x02,none,ok\n");
  ASSERT_EQ(recording.frames.size(), 2U);
  EXPECT_EQ(recording.frames[0].damaged, (std::vector<std::size_t>{1, 3})) << "in whichever column it is said";
  EXPECT_TRUE(recording.frames[1].damaged.empty());
}

TEST(Recordings, AFrameThatTheCsvSaysWasDamagedIsSoAsAWhole) {
  const LineRecording recording = recording_of("Time,Frame Error,Data\n0,CRC,01 03 00 00 00 01 84 0A\n");
  ASSERT_EQ(recording.frames.size(), 1U);
  EXPECT_EQ(recording.frames[0].bytes, kRequest);
  const auto frames = conversation(recording, *find_recorded_protocol("modbus"));
  EXPECT_FALSE(frames[0].right);
  EXPECT_EQ(frames[0].text, "it is damaged; station 1, read holding registers 40001, 1 of them");
}

TEST(Recordings, DatesCountWhereALogHasThem) {
  constexpr Time kHour = 3600 * kSecond;
  const auto hours = [](const char* first, const char* second) {
    return *times_of(recording_of(fmt::format("{} TX 01 03\n{} RX 01 03\n", first, second))).back() / kHour;
  };
  EXPECT_EQ(hours("2026-11-22 23:00:00", "2026-11-23 12:00:00"), 13);
  EXPECT_EQ(hours("2026-12-31T23:00:00", "2027-01-02T01:00:00"), 26);
  EXPECT_EQ(hours("22.11.2026 23:00:00", "23.11.2026 12:00:00"), 13);
  EXPECT_EQ(hours("28.02.26 12:00:00", "01.03.26 12:00:00"), 24);
  EXPECT_EQ(hours("11/22/2026 23:00:00", "11/23/2026 12:00:00"), 13) << "the month first";
  EXPECT_EQ(hours("22/11/2026 23:00:00", "23/11/2026 12:00:00"), 13) << "the day first";
  EXPECT_EQ(hours("03/06/2026 12:00:00", "03/09/2026 12:00:00"), 72) << "either: three days rather than three months";
  EXPECT_EQ(hours("2026-11-22 12:00:00", "2026-11-22 11:00:00"), -1) << "no midnight between them";
  EXPECT_EQ(hours("2026-13-45 23:00:00", "2026-13-46 01:00:00"), 2) << "such dates do not exist; midnight has passed";
  EXPECT_EQ(times_of(recording_of("time;data\n2026-11-22 23:00:00;01 03\n2026-11-23 12:00:00;01 03\n")).back(), 13 * kHour);
}

TEST(Recordings, MidnightPassesOnce) {
  const LineRecording log = recording_of("23:59:59.990 TX 01 03\n00:00:00.010 RX 01 03\n00:00:00.020 TX 01 03\n");
  ASSERT_EQ(log.frames.size(), 3U);
  EXPECT_EQ(log.frames[1].at, 20 * ms);
  EXPECT_EQ(log.frames[2].at, 30 * ms);
}

TEST(Recordings, OurOwnCaptureIsRead) {
  std::ostringstream file;
  serial::PcapWriter writer(file);
  writer.packet(kSecond, kRequest);
  writer.packet(kSecond + 25 * ms + 7, kAnswer);
  const LineRecording recording = recording_of(file.str());
  ASSERT_EQ(recording.frames.size(), 2U);
  EXPECT_EQ(recording.frames[1].bytes, kAnswer);
  EXPECT_EQ(recording.frames[1].at, 25 * ms + 7) << "to the nanosecond";
}

/// An Ethernet frame with a TCP segment, as far as readers look at it.
Bytes segment(bool to_server, std::uint32_t sequence, const Bytes& data, std::uint8_t flags = 0x18,
              std::uint16_t client_port = 50'000) {
  Bytes bytes(12, 0);
  bytes.insert(bytes.end(), {0x08, 0x00});
  const auto total = static_cast<std::uint16_t>(40 + data.size());
  Bytes ip{0x45, 0, static_cast<std::uint8_t>(total >> 8), static_cast<std::uint8_t>(total), 0, 0, 0x40, 0, 64, 6, 0, 0};
  const Bytes client{10, 0, 0, 1}, server{10, 0, 0, 2};
  for (const Bytes& address : {to_server ? client : server, to_server ? server : client})
    ip.insert(ip.end(), address.begin(), address.end());
  Bytes tcp(20, 0);
  store16(&tcp[0], to_server ? client_port : 502);
  store16(&tcp[2], to_server ? 502 : client_port);
  store32(&tcp[4], sequence);
  tcp[12] = 0x50;
  tcp[13] = flags;
  for (const Bytes& part : {ip, tcp, data}) bytes.insert(bytes.end(), part.begin(), part.end());
  return bytes;
}

std::string ethernet_pcap(const std::vector<Bytes>& packets) {
  std::ostringstream file;
  serial::PcapWriter writer(file);
  for (std::size_t i = 0; i < packets.size(); ++i) writer.packet(static_cast<Time>(i) * 10 * ms, packets[i]);
  std::string bytes = file.str();
  bytes[20] = 1;  // the link type: Ethernet
  return bytes;
}

TEST(Recordings, ATimeOfNoAgeIsRefused) {
  const Bytes section{0x0A, 0x0D, 0x0D, 0x0A, 28,   0,    0,    0,    0x4D, 0x3C, 0x2B, 0x1A, 1, 0,
                      0,    0,    0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 28,   0,    0, 0};
  const Bytes in_seconds{1, 0, 0, 0, 32, 0, 0, 0, 147, 0, 0, 0, 0xFF, 0xFF, 0, 0,
                         9, 0, 1, 0, 0,  0, 0, 0, 0,   0, 0, 0, 32,   0,    0, 0};
  const auto read_at = [&](std::uint8_t high) {
    const Bytes packet{6, 0, 0, 0, 36, 0, 0, 0, 0, 0, 0, 0, high, 0, 0,  0, 0, 0,
                       0, 0, 4, 0, 0,  0, 4, 0, 0, 0, 1, 3, 0,    0, 36, 0, 0, 0};
    std::string bytes;
    for (const Bytes* block : {&section, &in_seconds, &packet}) bytes.append(block->begin(), block->end());
    const auto recording = read_recording(bytes, {});
    return recording ? "read" : recording.why();
  };
  EXPECT_EQ(read_at(0), "read");
  EXPECT_EQ(read_at(1), "packet 1: 4294967296 s since 1970 is not a time of a recording");
}

TEST(Recordings, OfEveryConnectionOfACutOffFileTheLastFrameIsMarked) {
  const Bytes request = modbus::to_bytes({.transaction = 7, .unit = 1, .pdu = {3, 0, 0, 0, 1}});
  std::vector<Bytes> packets;
  for (const std::uint16_t port : std::initializer_list<std::uint16_t>{50'000, 50'001, 50'000})
    packets.push_back(segment(true, 100, request, 0x18, port));
  store32(&packets[2][14 + 20 + 4], 100 + static_cast<std::uint32_t>(request.size()));
  packets.push_back(packets[0]);
  std::string bytes = ethernet_pcap(packets);
  bytes.pop_back();
  const LineRecording recording = recording_of(bytes);
  ASSERT_EQ(recording.frames.size(), 3U);
  for (const auto& [frame, last] : {std::pair{0, false}, {1, true}, {2, true}})
    EXPECT_EQ(recording.frames[static_cast<std::size_t>(frame)].more_was_lost, last) << frame;
}

TEST(Recordings, ModbusTcpIsReadAsOnASerialLine) {
  const Bytes request = modbus::to_bytes({.transaction = 7, .unit = 1, .pdu = {3, 0, 0, 0, 1}});
  const Bytes answer = modbus::to_bytes({.transaction = 7, .unit = 1, .pdu = {3, 2, 0x12, 0x34}});
  const Bytes head(request.begin(), request.begin() + 4), rest(request.begin() + 4, request.end());
  const auto sequence = 100 + static_cast<std::uint32_t>(head.size());
  const LineRecording recording =
      recording_of(ethernet_pcap({segment(true, 99, {}, 2), segment(true, 100, head), segment(true, sequence, rest),
                                  segment(true, sequence, rest), segment(false, 500, answer)}));
  ASSERT_EQ(recording.frames.size(), 2U) << "in pieces, and one of them sent again";
  EXPECT_EQ(recording.frames[0].bytes, kRequest);
  EXPECT_EQ(recording.frames[0].direction, Direction::Request);
  EXPECT_EQ(recording.frames[1].bytes, kAnswer);
  EXPECT_EQ(recording.frames[1].direction, Direction::Answer);
  EXPECT_EQ(recording.frames[0].stream, recording.frames[1].stream);
}

/// A capture of that link type with the IP packets of a request and its answer after `head`.
std::string capture_with_head(
    std::uint8_t link_type, const Bytes& head, std::uint16_t port = 502,
    const Bytes& asked = modbus::to_bytes({.transaction = 7, .unit = 1, .pdu = {3, 0, 0, 0, 1}}),
    const Bytes& said = modbus::to_bytes({.transaction = 7, .unit = 1, .pdu = {3, 2, 0x12, 0x34}})) {
  constexpr std::size_t kOfEthernet = 14;
  std::vector<Bytes> packets;
  for (const bool to_server : {true, false}) {
    Bytes packet = segment(to_server, 100, to_server ? asked : said);
    store16(&packet[to_server ? 36 : 34], port);
    packet.erase(packet.begin(), packet.begin() + kOfEthernet);
    packet.insert(packet.begin(), head.begin(), head.end());
    packets.push_back(packet);
  }
  std::string bytes = ethernet_pcap(packets);
  bytes[20] = static_cast<char>(link_type);
  return bytes;
}

TEST(Recordings, ModbusTcpIsFoundBelowTheHeadsOfManyLinks) {
  const Bytes addresses(12, 0);
  const auto ethernet = [&](const Bytes& types) {
    Bytes head = addresses;
    head.insert(head.end(), types.begin(), types.end());
    return head;
  };
  for (const auto& [link_type, head] : std::initializer_list<std::pair<std::uint8_t, Bytes>>{
           {1, ethernet({0x08, 0x00})},
           {1, ethernet({0x81, 0x00, 0, 5, 0x08, 0x00})},
           {1, ethernet({0x88, 0xA8, 0, 5, 0x81, 0x00, 0, 7, 0x08, 0x00})},
           {0, {2, 0, 0, 0}},
           {108, {0, 0, 0, 2}},
           {101, {}},
           {113, {0, 0, 0, 1, 0, 6, 0, 0, 0, 0, 0, 0, 0, 0, 0x08, 0x00}}}) {
    const LineRecording recording = recording_of(capture_with_head(link_type, head));
    ASSERT_EQ(recording.frames.size(), 2U) << int{link_type};
    EXPECT_EQ(recording.frames[0].bytes, kRequest);
    EXPECT_EQ(recording.frames[1].bytes, kAnswer);
    EXPECT_TRUE(recording.over_tcp);
  }
}

TEST(Recordings, ACaptureWithoutTheChosenPortNamesTheOneThatItHas) {
  std::string why = read_recording(capture_with_head(101, {}, 5020), {}).why();
  EXPECT_EQ(why, "no frames found; 2 packets not of TCP port 502 were left out; most have port 5020: --tcp-port 5020");
  EXPECT_EQ(read_recording(capture_with_head(101, {}, 5020), {.tcp_port = 5020}).why(), "");
}

TEST(Recordings, TcpMayCarryModbusRtu) {
  const auto recording = read_recording(capture_with_head(101, {}, 4001, kRequest, kAnswer), {.tcp_port = 4001});
  ASSERT_TRUE(recording) << recording.why();
  ASSERT_EQ(recording->frames.size(), 2U);
  EXPECT_EQ(recording->frames[0].bytes, kRequest);
  EXPECT_EQ(recording->frames[0].direction, Direction::Request);
  EXPECT_EQ(recording->frames[1].bytes, kAnswer);
  EXPECT_EQ(recording->frames[1].direction, Direction::Answer);
  EXPECT_FALSE(recording->over_tcp) << "they are frames of a serial line";
  EXPECT_EQ(recording->notes,
            std::vector<std::string>{"its TCP carries Modbus RTU: the frames have a CRC, and no head of Modbus TCP"});
}

TEST(Recordings, AFrameOfModbusRtuInSeveralSegmentsCostsNoOther) {
  const Bytes begin(kAnswer.begin(), kAnswer.begin() + 3), rest(kAnswer.begin() + 3, kAnswer.end());
  LineRecording recording =
      recording_of(ethernet_pcap({segment(true, 100, kRequest), segment(false, 500, begin), segment(false, 503, rest),
                                  segment(true, 108, kRequest), segment(false, 507, kAnswer)}));
  const auto frames = conversation(recording, *find_recorded_protocol("modbus"), {});
  ASSERT_EQ(frames.size(), 4U);
  for (const std::size_t answer : {1U, 3U}) EXPECT_EQ(frames[answer].frame.bytes, kAnswer) << answer;
  EXPECT_EQ(frames[1].pieces, 2U);
  EXPECT_EQ(recording.notes,
            std::vector<std::string>{"its TCP carries Modbus RTU: the frames have a CRC, and no head of Modbus TCP"});
}

TEST(Recordings, ASegmentThatIsSentAgainWithMoreHasItsNewPartRead) {
  const Bytes request = modbus::to_bytes({.transaction = 7, .unit = 1, .pdu = {3, 0, 0, 0, 1}});
  const Bytes head(request.begin(), request.begin() + 6);
  const LineRecording recording = recording_of(ethernet_pcap(
      {segment(true, 100, head), segment(true, 99, {0}), segment(true, 100, request), segment(true, 100, request)}));
  ASSERT_EQ(recording.frames.size(), 1U);
  EXPECT_EQ(recording.frames[0].bytes, kRequest);
  EXPECT_EQ(recording.notes, std::vector<std::string>{});
}

TEST(Recordings, APacketWithoutItsLengthGoesToItsEnd) {
  Bytes packet = segment(true, 100, modbus::to_bytes({.transaction = 7, .unit = 1, .pdu = {3, 0, 0, 0, 1}}));
  packet[16] = packet[17] = 0;
  const LineRecording recording = recording_of(ethernet_pcap({packet}));
  ASSERT_EQ(recording.frames.size(), 1U);
  EXPECT_EQ(recording.frames[0].bytes, kRequest);
}

TEST(Recordings, WhatIsLeftOutOfACaptureIsCountedByItsReason) {
  const Bytes request = modbus::to_bytes({.transaction = 7, .unit = 1, .pdu = {3, 0, 0, 0, 1}});
  const Bytes good = segment(true, 100, request);
  Bytes cut_off = good, fragment = good, other_port = good;
  cut_off.resize(cut_off.size() - 4);
  fragment[20] = 0x20;  // more of them follow
  store16(&other_port[36], 80);
  const LineRecording recording = recording_of(ethernet_pcap({good, cut_off, fragment, other_port}));
  EXPECT_EQ(recording.frames.size(), 1U);
  EXPECT_EQ(recording.notes, (std::vector<std::string>{"a packet not of TCP port 502 was left out",
                                                       "2 packets of TCP in fragments or cut off were left out"}));
}

constexpr const char* kLostSegment =
    "packet 2: segments before it are missing; reading goes on with the next message that begins a segment";

TEST(Recordings, ALostSegmentCostsTheMessagesInItAndNotTheConnection) {
  const Bytes request = modbus::to_bytes({.transaction = 7, .unit = 1, .pdu = {3, 0, 0, 0, 1}});
  const auto length = static_cast<std::uint32_t>(request.size());
  const LineRecording recording = recording_of(ethernet_pcap(
      {segment(true, 100, request), segment(true, 100 + 2 * length, request), segment(true, 100 + 3 * length, request)}));
  EXPECT_EQ(recording.frames.size(), 3U);
  EXPECT_TRUE(recording.frames[0].more_was_lost);
  EXPECT_FALSE(recording.frames[1].more_was_lost);
  EXPECT_EQ(recording.notes, std::vector<std::string>{kLostSegment});
}

TEST(Recordings, AfterALostSegmentReadingGoesOnWhereMessagesBegin) {
  const Bytes request = modbus::to_bytes({.transaction = 7, .unit = 1, .pdu = {3, 0, 0, 0, 1}});
  const auto length = static_cast<std::uint32_t>(request.size());
  Bytes tail(request.begin() + 5, request.end());
  const auto missing = static_cast<std::uint32_t>(tail.size());
  tail.insert(tail.end(), request.begin(), request.end());
  const LineRecording within = recording_of(ethernet_pcap(
      {segment(true, 100, request), segment(true, 200, tail), segment(true, 200 + missing + length, request)}));
  EXPECT_EQ(within.frames.size(), 3U) << "the rest of a message, and a whole one";
  const Bytes begin(request.begin(), request.begin() + 8), rest(request.begin() + 8, request.end());
  EXPECT_EQ(recording_of(ethernet_pcap({segment(true, 100, request), segment(true, 200, begin), segment(true, 208, rest)}))
                .frames.size(),
            2U)
      << "a message that goes on in the next segment";
  const Bytes noise{0x12, 0x34, 0x56, 0x78, 0x9A, 0xBC, 0xDE};
  const LineRecording broken =
      recording_of(ethernet_pcap({segment(true, 100, request), segment(true, 112, noise), segment(true, 119, request)}));
  EXPECT_EQ(broken.frames.size(), 2U);
  EXPECT_EQ(broken.notes,
            std::vector<std::string>{
                "packet 2: protocol 22136 instead of 0; reading goes on with the next message that begins a segment"});
}

TEST(Recordings, AfterALostSegmentAHeadMayBeDividedBetweenSegments) {
  const Bytes request = modbus::to_bytes({.transaction = 7, .unit = 1, .pdu = {3, 0, 0, 0, 1}});
  for (std::uint32_t cut = 1; cut < 6; ++cut) {
    std::vector<Bytes> packets{segment(true, 100, request)};
    std::uint32_t sequence = 100;
    for (int message = 1; message < 4; ++message) {
      sequence += static_cast<std::uint32_t>(request.size());
      if (message > 1) packets.push_back(segment(true, sequence, {request.begin(), request.begin() + cut}));
      packets.push_back(segment(true, sequence + cut, {request.begin() + cut, request.end()}));
    }
    EXPECT_EQ(recording_of(ethernet_pcap(packets)).frames.size(), 3U) << cut << ": all but the second";
  }
}

TEST(Recordings, WhatIsNoRecordingIsRefused) {
  EXPECT_EQ(refusal_of(""), "the file is empty");
  EXPECT_EQ(refusal_of(" \r\n\n"), "the file is empty");
  EXPECT_EQ(refusal_of("a letter\n"), "no frames found; line 1: left out: no bytes in it");
  EXPECT_EQ(refusal_of(std::string("a\0b", 3)),
            "it is binary, and not a capture that decode knows; for recorded bytes alone, decode what xxd prints of it");
  EXPECT_NE(refusal_of("\xD4\xC3\xB2\xA1 cut off"), "");
  std::string other = ethernet_pcap({});
  other[20] = 105;
  EXPECT_EQ(
      refusal_of(other),
      "link type 105 is not one of 147 to 162 (serial), 250 (RTAC serial), 189, 220 and 249 (USB), Ethernet, Linux cooked, "
      "loopback or raw IP");
}

TEST(Recordings, RandomPacketsAreNeverReadBeyondTheirEnd) {
  std::uint32_t random = 1;
  const auto next = [&random] { return random = random * 1'664'525 + 1'013'904'223; };
  std::vector<Bytes> packets;
  for (int i = 0; i < 3000; ++i) {
    Bytes packet = segment(next() % 2 == 0, 100 + next() % 64, {0, 1, 0, 0, 0, 6, 1, 3, 0, 0, 0, 1});
    for (std::uint32_t changes = next() % 4; changes > 0; --changes)
      packet[(next() >> 8) % packet.size()] = static_cast<std::uint8_t>(next() >> 24);
    packet.resize((next() >> 8) % 8 == 0 ? (next() >> 8) % packet.size() : packet.size());
    packets.push_back(std::move(packet));
  }
  const auto read = read_recording(ethernet_pcap(packets), {});
  EXPECT_EQ(read.has_value(), read.why().empty());
}

// --- conversations ---

std::vector<ReadFrame> read(const LineRecording& recording, std::string_view protocol = "modbus",
                            const Stamps& stamps = {}) {
  return conversation(recording, *find_recorded_protocol(protocol), stamps);
}

TEST(Conversation, AnAnswerIsKnownByItsRequestWhereNoDirectionIsSaid) {
  const LineRecording recording = recording_of("0.000 01 03 00 00 00 01 84 0A\n0.025 01 03 02 12 34 B5 33\n");
  const auto frames = read(recording);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].direction, Direction::Request);
  EXPECT_EQ(frames[0].text, "station 1, read holding registers 40001, 1 of them");
  EXPECT_EQ(frames[0].other, 1U);
  EXPECT_EQ(frames[1].direction, Direction::Answer);
  EXPECT_TRUE(frames[1].right);
  EXPECT_EQ(frames[1].text, "1 register: 16#1234");
}

TEST(Conversation, TheLatencyIsTheSilenceBetweenThem) {
  const LineRecording recording = recording_of("0.000 TX 01 03 00 00 00 01 84 0A\n0.025 RX 01 03 02 12 34 B5 33\n");
  const auto frames = read(recording);
  EXPECT_EQ(silence(frames[0].frame, frames[1].frame, {.character = 1 * ms}), 17 * ms) << "eight characters of the request";
  EXPECT_EQ(silence(frames[0].frame, frames[1].frame, {.character = 1 * ms, .at_end = true}), 18 * ms)
      << "seven of the answer";
}

TEST(Conversation, PpiIsReadFrameByFrame) {
  const LineRecording recording = recording_of(
      "0.000 68 1B 1B 68 02 00 6C 32 01 00 00 00 01 00 0E 00 00 04 01 12 0A 10 02 00 04 00 01 84 00 03 20 8F 16\n0.040 E5\n"
      "0.050 10 02 00 5C 5E 16\n0.060 68 19 19 68 00 02 08 32 03 00 00 00 01 00 02 00 08 00 00 04 01 FF 04 00 20 12 34 56 "
      "78 86 16\n"
      "0.100 68 19 19 68 00\n");
  const auto frames = read(recording, "ppi");
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_EQ(frames[0].text, "0 to 2, function 6C: read VB100:4");
  EXPECT_EQ(frames[1].text, "accepted");
  EXPECT_EQ(frames[2].text, "0 to 2, function 5C: poll");
  EXPECT_EQ(frames[3].text, "2 to 0, function 08: VB100:4 = 16#12 16#34 16#56 16#78");
  EXPECT_EQ(frames[3].other, 2U);
  EXPECT_EQ(frames[4].direction, Direction::Unknown);
}

TEST(Conversation, WhatSeveralMastersOfPpiSayToEachOtherIsNamed) {
  const LineRecording recording = recording_of(
      "0.000 DC 02 01\n0.010 10 03 01 49 4D 16\n0.020 10 01 03 00 04 16\n0.030 10 03 01 5C 60 16\n0.040 10 01 03 02 06 16\n"
      "0.050 10 7F 01 44 C4 16\n0.060 DC 01 02\n");
  const auto frames = read(recording, "ppi");
  ASSERT_EQ(frames.size(), 7U);
  EXPECT_EQ(frames[0].text, "token from station 1 to station 2");
  EXPECT_TRUE(frames[0].needs_no_answer);
  EXPECT_EQ(frames[1].text, "1 to 3, function 49: status?");
  EXPECT_EQ(frames[2].text, "3 to 1, function 00: a slave");
  EXPECT_EQ(frames[2].other, 1U);
  EXPECT_EQ(frames[4].text, "3 to 1, function 02: no resource");
  EXPECT_EQ(frames[5].text, "1 to 127, function 44: a service that is not known");
  EXPECT_TRUE(frames[5].needs_no_answer);
  EXPECT_EQ(frames[6].text, "token from station 2 to station 1");
  for (const ReadFrame& frame : frames) EXPECT_TRUE(frame.right) << frame.text;
}

TEST(Conversation, APpiAnswerThatEndsWithinItsHeadIsWrong) {
  const auto frames = read(recording_of("0.0 TX 68 0d 0d 68 02 00 6c 32 01 00 00 00 01 00 00 00 00 a2 16\n"
                                        "0.1 RX 68 0d 0d 68 00 02 08 32 03 00 00 00 01 00 00 00 00 40 16\n"),
                           "ppi");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_TRUE(frames[0].right);
  EXPECT_FALSE(frames[1].right);
  EXPECT_EQ(frames[1].text, "2 to 0, function 08: an answer without its error code");
}

/// A character in each row, `gap` after the one before; the rows of each string follow those of the one before after
/// `between`.
std::string character_rows(std::initializer_list<const char*> messages, Time gap, Time between) {
  std::string csv = "Time [us],Value\n";
  Time at = 0;
  for (const char* message : messages) {
    const Bytes bytes = bytes_of_text(message).value_or(Bytes{});
    for (const std::uint8_t byte : bytes) csv += fmt::format("{},0x{:02X}\n", (at += gap) / kMicrosecond, byte);
    at += between;
  }
  return csv;
}

std::vector<std::string> texts(const std::vector<ReadFrame>& frames) {
  std::vector<std::string> all;
  for (const ReadFrame& frame : frames)
    all.push_back((frame.direction == Direction::Request  ? "> "
                   : frame.direction == Direction::Answer ? "< "
                                                          : "? ") +
                  frame.text);
  return all;
}

/// Requests of master 0 to station 2, each with what is fetched of its answer.
std::vector<std::string> ppi_texts(const std::vector<std::pair<Bytes, Bytes>>& jobs) {
  LineRecording recording;
  const auto say = [&](const Bytes& bytes) { recording.frames.push_back({.bytes = bytes}); };
  for (const auto& [request, answer] : jobs) {
    say(ppi::to_frame({2, 0, ppi::kRequestFunction, request}));
    say({ppi::kAccepted});
    say(ppi::to_frame({2, 0, ppi::kPollFunction}));
    say(ppi::to_frame({0, 2, ppi::kData, answer}));
  }
  std::vector<std::string> said;
  for (const ReadFrame& frame : read(recording, "ppi")) {
    EXPECT_TRUE(frame.right) << frame.text;
    if (frame.frame.bytes.size() > 6) said.push_back(frame.text.substr(frame.text.find(": ") + 2));
  }
  return said;
}

/// The answer to request 1.
Bytes ppi_answer(const Bytes& parameters, const Bytes& data, std::uint16_t error = 0) {
  Bytes bytes = s7::pdu(s7::kAnswer, 1, parameters, data);
  bytes.insert(bytes.begin() + s7::kRequestHead, {static_cast<std::uint8_t>(error >> 8), static_cast<std::uint8_t>(error)});
  return bytes;
}

TEST(Conversation, AVariableOfPpiHasTheWidthOfItsTypeAndItsAnswerItsValues) {
  const auto wanted = [](std::initializer_list<s7::Variable> variables) {
    Bytes parameters{s7::kRead, static_cast<std::uint8_t>(variables.size())};
    for (const s7::Variable& variable : variables) append(parameters, variable);
    return s7::pdu(s7::kRequest, 1, parameters, {});
  };
  const auto found = [](const Bytes& data) { return ppi_answer({s7::kRead, 1}, data); };
  EXPECT_EQ(ppi_texts({{wanted({{s7::kWord, 3, Area::V, 800}}), found({0xFF, 4, 0, 48, 0, 1, 0, 2, 0xFF, 0xFF})},
                       {wanted({{s7::kByte, 1, Area::V, 800}}), found({0xFF, 4, 0, 8, 0x41})},
                       {wanted({{s7::kDouble, 1, Area::V, 800}}), found({0xFF, 4, 0, 32, 0, 1, 0, 2})},
                       {wanted({{s7::kReal, 1, Area::V, 800}}), found({0xFF, 4, 0, 32, 0x3F, 0xC0, 0, 0})},
                       {wanted({{s7::kBit, 1, Area::M, 255}}), found({0xFF, 3, 0, 1, 1})},
                       {wanted({{0x1F, 1, Area::T, 37}}), found({0xFF, 9, 0, 5, 2, 0, 0, 0x12, 0x34})},
                       {wanted({{s7::kByte, 1, Area::Q, 0}, {s7::kWord, 1, Area::V, 80'000}}),
                        found({0xFF, 4, 0, 8, 7, 0, 5, 0, 0, 0})},
                       {wanted({{0x1D, 1, Area::V, 800}}), ppi_answer({s7::kRead, 1}, {}, 0x8104)}}),
            (std::vector<std::string>{"read VW100:3", "VW100:3 = 16#0001 16#0002 16#FFFF", "read VB100", "VB100 = 16#41",
                                      "read VD100", "VD100 = 16#00010002", "read VD100:real", "VD100:real = 1.5",
                                      "read M31.7", "M31.7 = 1", "read T37", "T37 = 16#1234", "read QB0, VW10000",
                                      "QB0 = 16#07, VW10000: error 16#05: outside the memory of this CPU",
                                      "read V byte 100:1 of type 16#1D", "error 16#8104: function not available"}));
}

TEST(Conversation, WritesModesAndTheClockOfPpiAreInWords) {
  Bytes write{s7::kWrite, 1};
  append(write, s7::Variable{s7::kWord, 2, Area::V, 800});
  const Bytes time{0xFF, 9, 0, 10, 0, 0x20, 0x26, 0x11, 0x22, 0x15, 0x45, 0x30, 0, 1};
  const auto clock = [](std::uint8_t kind, std::uint8_t service, const Bytes& data) {
    Bytes parameters{0, 1, 0x12, 4, 0x11, static_cast<std::uint8_t>(kind | s7::kClockGroup), service, 0};
    if (kind == 0x80) parameters.insert(parameters.end(), {0, 0, 0, 0});
    return s7::pdu(s7::kUserData, 1, parameters, data);
  };
  EXPECT_EQ(
      ppi_texts({{s7::pdu(s7::kRequest, 1, write, {0, 4, 0, 32, 0, 5, 0, 6}), ppi_answer({s7::kWrite, 1}, {0xFF})},
                 {s7::pdu(s7::kRequest, 1, write, {0, 4, 0, 32, 0, 5, 0, 6}), ppi_answer({s7::kWrite, 1}, {0x03})},
                 {s7::pdu(s7::kRequest, 1, {s7::kRun}, {}), ppi_answer({s7::kRun}, {})},
                 {s7::pdu(s7::kRequest, 1, {s7::kStop}, {}), ppi_answer({s7::kStop}, {})},
                 {s7::pdu(s7::kRequest, 1, {s7::kSetup, 0, 0, 1, 0, 1, 3, 0xC0}, {}),
                  ppi_answer({s7::kSetup, 0, 0, 1, 0, 1, 0, 240}, {})},
                 {clock(0x40, s7::kReadClock, {0x0A, 0, 0, 0}), clock(0x80, s7::kReadClock, time)},
                 {clock(0x40, s7::kSetClock, time), clock(0x80, s7::kSetClock, {0x0A, 0, 0, 0})}}),
      (std::vector<std::string>{"write VW100:2 = 16#0005 16#0006", "VW100:2 written", "write VW100:2 = 16#0005 16#0006",
                                "VW100:2: error 16#03: not allowed", "go to RUN", "goes to RUN", "go to STOP",
                                "goes to STOP", "set up: 960 bytes at once", "set up: 240 bytes at once", "read the clock",
                                "clock: 2026-11-22 15:45:30", "set the clock to 2026-11-22 15:45:30", "clock set"}));
}

TEST(Conversation, ForcedValuesAndBlocksOfPpiAreInWords) {
  const auto user_data = [](std::uint8_t group, std::uint8_t service, bool answer, const Bytes& list) {
    return s7::pdu(s7::kUserData, 1, s7::parameters_of({.group = group, .service = service, .is_answer = answer}),
                   s7::data_of_list(list));
  };
  const auto force = [&](std::uint8_t service, bool answer, const Bytes& list) {
    return user_data(8, service, answer, list);
  };
  const auto blocks = [&](std::uint8_t service, bool answer, const std::string& list) {
    return user_data(3, service, answer, Bytes(list.begin(), list.end()));
  };
  const Bytes q0{0x10, 1, 0, 1, 0, 0, 0x82, 0, 0, 0}, mb5{0x10, 2, 0, 1, 0, 0, 0x83, 0, 0, 40};
  const auto list = [](Bytes head, std::initializer_list<Bytes> parts) {
    for (const Bytes& part : parts) head.insert(head.end(), part.begin(), part.end());
    return head;
  };
  Bytes information(78);
  information[40] = 8;
  EXPECT_EQ(
      ppi_texts({{force(0x0B, false, list({0, 2}, {q0, mb5, {1, 0, 9, 0}})), force(0x0B, true, {0, 2, 0xFF, 0x03})},
                 {force(0x0B, false, list({1, 1}, {q0})), force(0x0B, true, {1, 1, 0xFF})},
                 {force(0x0E, false, list({0, 1}, {mb5, {0, 4, 0, 8, 7, 0}})), force(0x0E, true, {0, 1, 0xFF})},
                 {force(0x0B, false, {0, 2}), force(0x0B, true, {})},
                 {blocks(1, false, ""), blocks(1, true,
                                               std::string("08\0\1"
                                                           "0C\0\0"
                                                           "0A\0\1",
                                                           12))},
                 {blocks(2, false, "0A"), blocks(2, true, std::string("\0\1\0\5", 4))},
                 {blocks(3, false, "0A00001A"), user_data(3, 3, true, information)},
                 {blocks(3, false, "x"), user_data(3, 3, true, {})},
                 {s7::pdu(s7::kRequest, 1, {0x1D, 0, 0, 0, 0, 0, 0, 0, 9, '_', '0', '8', '0', '0', '0', '0', '1', 'A'}, {}),
                  ppi_answer({0x1D}, {}, 0xD241)},
                 {s7::pdu(s7::kRequest, 1, {0x1E, 0, 0, 0, 0, 0, 0, 1}, {}), ppi_answer({0x1E, 1}, {0, 1, 0, 0xFB, 7})},
                 {s7::pdu(s7::kRequest, 1, {0x1E, 0, 0, 0, 0, 0, 0, 1}, {}), ppi_answer({0x1E, 0}, {0, 1, 0, 0xFB, 7})},
                 {s7::pdu(s7::kRequest, 1, {0x1F, 0, 0, 0, 0, 0, 0, 1}, {}), ppi_answer({0x1F}, {})}}),
      (std::vector<std::string>{"force Q0.0 = 1, MB5 = 16#09",
                                "done, error 16#03: not allowed",
                                "unforce Q0.0",
                                "done",
                                "set in STOP MB5 = 16#07",
                                "done",
                                "force, incomplete",
                                "user data",
                                "how many blocks?",
                                "blocks: 1 OB, 1 DB",
                                "which DB?",
                                "blocks: 1",
                                "DB1?",
                                "block of 2048 bytes",
                                "block 'x'?",
                                "block",
                                "start the upload of OB1",
                                "error 16#D241: the block is protected",
                                "next part of the block",
                                "part of the block, more follows",
                                "next part of the block",
                                "part of the block",
                                "end the upload",
                                "upload ended"}));
}

TEST(Conversation, TheSameFrameAfterTheMastersTimeoutIsTheRequestRepeated) {
  const char* write = "01 06 00 00 00 01 48 0A";
  const auto after = [&](const char* time, const char* direction = "") {
    return recording_of(fmt::format("0.000 {0} {1}\n{2} {3} {1}\n", *direction != 0 ? "TX" : "", write, time, direction));
  };
  EXPECT_EQ(texts(read(after("0.080"))),
            (std::vector<std::string>{"> station 1, write register 40001 = 16#0001", "< register 40001 written: 16#0001"}));
  const auto frames = read(after("0.250"));
  EXPECT_EQ(texts(frames), (std::vector<std::string>{"> station 1, write register 40001 = 16#0001",
                                                     "> station 1, write register 40001 = 16#0001; repeated after 250 ms, "
                                                     "or its late echo"}));
  EXPECT_EQ(frames[1].repeats, 0U);
  EXPECT_EQ(read(after("0.250", "RX"))[1].direction, Direction::Answer) << "the recording says so";
  EXPECT_EQ(read(after("0.250"), "modbus", {.timeout = 300 * ms})[1].direction, Direction::Answer);
  const auto timeless = read(recording_of(fmt::format("{0}\n{0}\n", write)));
  EXPECT_EQ(timeless[1].direction, Direction::Answer);
}

TEST(Conversation, AnAnswerAfterARepeatedRequestIsTheAnswerToThat) {
  for (const auto& [protocol, request, answer] : {std::tuple{"modbus", "01 06 00 00 00 01 48 0A", "01 06 00 00 00 01 48 0A"},
                                                  std::tuple{"modbus", "01 08 00 00 12 34 ED 7C", "01 08 00 00 12 34 ED 7C"},
                                                  std::tuple{"pc1000-lan", "03 00 01 1F 00 23", "03 00 01 1F 00 23"}}) {
    const auto frames = read(
        recording_of(fmt::format("0.000 {0}\n0.250 {0}\n0.260 {1}\n0.300 {0}\n0.310 {1}\n", request, answer)), protocol);
    ASSERT_EQ(frames.size(), 5U);
    EXPECT_EQ(frames[0].other, std::nullopt) << request;
    EXPECT_EQ(frames[1].repeats, 0U);
    EXPECT_EQ(frames[1].other, 2U);
    EXPECT_EQ(frames[3].other, 4U);
  }
}

TEST(Conversation, ARepeatedReadIsInNoDoubt) {
  const auto frames = read(recording_of("0.000 01 03 00 00 00 01 84 0A\n0.250 01 03 00 00 00 01 84 0A\n"));
  EXPECT_EQ(frames[1].direction, Direction::Request);
  EXPECT_EQ(frames[1].repeats, std::nullopt) << "it is no answer to itself";
}

TEST(Conversation, AScenarioLeavesOutRequestsThatMayHaveBeenAnsweredByTheirEcho) {
  const auto frames =
      read(recording_of("0.000 09 06 00 0A 00 05 68 83\n0.250 09 06 00 0A 00 05 68 83\n"
                        "0.500 01 03 00 00 00 01 84 0A\n0.525 01 03 02 12 34 B5 33\n"));
  const Playback left = playback(frames, {}, {});
  EXPECT_EQ(left.notes, (std::vector<std::string>{"line 1: left out: the same after it (line 2) may be its late echo",
                                                  "line 2: left out: it may be the late echo of line 1"}));
  EXPECT_EQ(left.scenario.find("send: 09"), std::string::npos);
  EXPECT_NE(left.scenario.find("    steps:\n      # line 1: left out: the same after it (line 2) may be its late echo\n"
                               "      # line 2: left out: it may be the late echo of line 1\n      - send: 01 03"),
            std::string::npos)
      << left.scenario;
}

TEST(Conversation, AnAnswerThatACutOffFileHasLostIsNotExpectedToBeSilence) {
  std::ostringstream file;
  serial::PcapWriter writer(file);
  for (Time at = 0; at < 2 * kSecond; at += kSecond) {
    writer.packet(at, kRequest);
    writer.packet(at + 25 * ms, kAnswer);
  }
  const std::string whole = file.str();
  EXPECT_TRUE(playback(read(recording_of(whole)), {}, {}).notes.empty());
  const Playback cut = playback(read(recording_of(whole.substr(0, whole.size() - 1))), {}, {});
  EXPECT_EQ(cut.notes, std::vector<std::string>{"packet 3: left out: what came after it is missing from the recording"});
  EXPECT_EQ(cut.scenario.find("silence"), std::string::npos);
  EXPECT_NE(cut.scenario.find("      # packet 3: left out: what came after it is missing from the recording\n"),
            std::string::npos);
}

/// A request, an answer and their order on Modbus TCP.
struct TcpTalk {
  std::vector<Bytes> packets;
  std::uint32_t asked = 100, answered = 500;
  std::uint16_t client_port = 50'000;

  void ask(std::uint16_t transaction, std::uint8_t address) {
    add(true, {.transaction = transaction, .unit = 1, .pdu = {3, 0, address, 0, 1}}, asked);
  }
  void answer(std::uint16_t transaction, std::uint8_t value) {
    add(false, {.transaction = transaction, .unit = 1, .pdu = {3, 2, 0, value}}, answered);
  }
  void add(bool to_server, const modbus::TcpMessage& message, std::uint32_t& sequence) {
    const Bytes bytes = modbus::to_bytes(message);
    packets.push_back(segment(to_server, sequence, bytes, 0x18, client_port));
    sequence += static_cast<std::uint32_t>(bytes.size());
  }
};

TEST(Conversation, RequestsOfAConnectionWhoseAnswersAreMissingAreNotExpectedToBeSilence) {
  TcpTalk talk;
  for (const std::uint16_t transaction : std::initializer_list<std::uint16_t>{7, 8, 9}) {
    talk.ask(transaction, 10);
    talk.answer(transaction, 11);
  }
  talk.packets.erase(talk.packets.begin() + 3);  // the answer to the second request
  const auto frames = read(recording_of(ethernet_pcap(talk.packets)));
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_EQ(frames[0].other, 1U);
  EXPECT_EQ(frames[2].other, std::nullopt);
  EXPECT_EQ(frames[3].other, 4U) << "the connection goes on";
  const Playback left = playback(frames, {}, {});
  EXPECT_EQ(left.notes, std::vector<std::string>{"packet 3: left out: what came after it is missing from the recording"});
  EXPECT_EQ(left.scenario.find("silence"), std::string::npos);
}

TEST(Conversation, AnswersOfModbusTcpGoToTheRequestsOfTheirTransactions) {
  TcpTalk talk;
  talk.ask(1, 10);
  talk.ask(2, 20);
  talk.answer(2, 22);
  talk.ask(3, 30);
  talk.answer(1, 11);
  talk.answer(3, 33);
  const auto frames = read(recording_of(ethernet_pcap(talk.packets)));
  ASSERT_EQ(frames.size(), 6U);
  EXPECT_EQ(frames[0].other, 4U);
  EXPECT_EQ(frames[1].other, 2U);
  EXPECT_EQ(frames[3].other, 5U);
  EXPECT_EQ(frames[4].text, "1 register: 16#000B");
  EXPECT_EQ(frames[4].latency, 40 * ms);
  const Playback played = playback(frames, {}, {});
  EXPECT_EQ(played.scenario.find("silence"), std::string::npos) << played.scenario;
  EXPECT_EQ(played.scenario.find("latency"), std::string::npos) << "they waited for each other";
  EXPECT_EQ(played.notes,
            std::vector<std::string>{"3 requests waited for their answers at the same time, which a serial line does not "
                                     "allow: the scenario asks one after the other, without their latencies"});
}

TEST(Conversation, ARequestOfModbusTcpIsOnlyExpectedToBeSilentlyIgnoredIfItsAnswerCannotBeMissing) {
  const auto left_out = [](const TcpTalk& talk) {
    return playback(read(recording_of(ethernet_pcap(talk.packets))), {}, {});
  };
  TcpTalk end;
  end.ask(1, 10);
  end.ask(2, 20);
  end.answer(2, 22);
  EXPECT_EQ(left_out(end).notes.front(), "packet 1: left out: the recording ends before the master's time-out");
  EXPECT_EQ(left_out(end).scenario.find("silence"), std::string::npos);
  TcpTalk other_transaction;
  other_transaction.ask(1, 10);
  other_transaction.answer(9, 11);
  EXPECT_EQ(left_out(other_transaction).notes.front(),
            "packet 1: left out: what follows it (packet 2) may be its answer: an answer without its request");
  TcpTalk two;
  two.ask(1, 10);
  two.client_port = 50'001;
  two.ask(1, 20);
  two.client_port = 50'000;
  two.answer(9, 11);
  two.client_port = 50'001;
  two.answer(8, 22);
  EXPECT_EQ(left_out(two).notes,
            (std::vector<std::string>{
                "packet 1: left out: what follows it (packet 3) may be its answer: an answer without its request",
                "packet 2: left out: what follows it (packet 4) may be its answer: an answer without its request"}))
      << "each stray is named once";
  TcpTalk long_enough;
  long_enough.ask(1, 10);
  for (std::uint16_t i = 0; i < 10; ++i) {
    long_enough.ask(static_cast<std::uint16_t>(100 + i), 20);
    long_enough.answer(static_cast<std::uint16_t>(100 + i), 22);
  }
  EXPECT_NE(left_out(long_enough).scenario.find("expect: silence\n        timeout: 10 ms"), std::string::npos)
      << "up to the next request";
}

TEST(Conversation, ARequestOfModbusTcpWithoutAnAnswerKeepsItsGap) {
  const auto played = [](const char* second) {
    return playback(read(recording_of(fmt::format("0.000 TX 00 07 00 00 00 06 01 03 00 00 00 01\n"
                                                  "{} TX 00 08 00 00 00 06 01 03 00 00 00 01\n"
                                                  "0.320 RX 00 08 00 00 00 05 01 03 02 12 34\n",
                                                  second))),
                    {}, {})
        .scenario;
  };
  EXPECT_NE(played("0.300").find("expect: silence\n        timeout: 300 ms\n"), std::string::npos) << played("0.300");
  EXPECT_NE(played("0.300").find("pause: 0 ns\n        expect: 01 03 02 12 34"), std::string::npos) << played("0.300");
  EXPECT_NE(played("0.050").find("timeout: 50 ms\n"), std::string::npos) << played("0.050");
  const Playback timeless = playback(read(recording_of("TX 00 07 00 00 00 06 01 03 00 00 00 01\n"
                                                       "TX 00 08 00 00 00 06 01 03 00 00 00 01\n"
                                                       "RX 00 08 00 00 00 05 01 03 02 12 34\n")),
                                     {}, {});
  EXPECT_EQ(timeless.notes.front(), "line 1: left out: the recording has no times, so its answer may be missing");
}

TEST(Conversation, AWrongRequestToAllIsNotSaidToNeedNoAnswer) {
  EXPECT_FALSE(read(recording_of("TX 00 06 00 00 00 01 49 DC\n"))[0].needs_no_answer);
}

TEST(Conversation, AFrameThatBeginsInsideTheOneBeforeIsLeftOut) {
  const Bytes other{0x02, 0x03, 0x00, 0x00, 0x00, 0x01, 0x84, 0x39};
  const LineRecording recording{.frames = {{.at = 0, .bytes = kRequest, .place = "packet 1"},
                                           {.at = 3 * ms, .bytes = other, .place = "packet 2"},
                                           {.at = 25 * ms, .bytes = kAnswer, .place = "packet 3"},
                                           {.at = 40 * ms, .bytes = other, .place = "packet 4"},
                                           {.at = 43 * ms, .bytes = kRequest, .place = "packet 5"},
                                           {.at = 300 * ms, .bytes = kRequest, .place = "packet 6"},
                                           {.at = 325 * ms, .bytes = kAnswer, .place = "packet 7"}}};
  const Stamps stamps{.character = ms, .exact = true};
  const auto frames = read(recording, "modbus", stamps);
  EXPECT_FALSE(frames[1].right);
  EXPECT_EQ(frames[1].text, "begins inside the frame before");
  EXPECT_EQ(frames[0].other, 2U) << "the answer is the first one's";
  const Playback played = playback(frames, stamps, {});
  EXPECT_EQ(played.notes,
            (std::vector<std::string>{
                "packet 4: left out: what follows it (packet 5) may be its answer: begins inside the frame before",
                "packet 2: left out: begins inside the frame before"}));
  EXPECT_EQ(played.scenario.find("pause: 0 ns"), std::string::npos) << played.scenario;
  EXPECT_EQ(read(recording, "modbus", {.character = ms})[1].direction, Direction::Request) << "a log's times are not exact";
}

TEST(Conversation, OfFramesThatALogHasInsideOthersNoTimesAreWritten) {
  const auto played = [](const char* log) {
    const Stamps stamps{.character = ms};
    return playback(read(recording_of(log), "modbus", stamps), stamps, {});
  };
  const Playback answered = played(
      "0.000 TX 01 03 00 00 00 01 84 0A\n0.003 RX 01 03 02 12 34 B5 33\n"
      "0.005 TX 01 03 00 00 00 01 84 0A\n0.030 RX 01 03 02 12 34 B5 33\n");
  EXPECT_EQ(answered.scenario.find("pause"), std::string::npos) << answered.scenario;
  EXPECT_EQ(answered.scenario.find("latency: 0 ns"), std::string::npos) << answered.scenario;
  EXPECT_NE(answered.scenario.find("latency: 17 ms"), std::string::npos) << answered.scenario;
  EXPECT_EQ(answered.notes,
            std::vector<std::string>{"line 2, and 1 more: begins before the frame above it can be over, as logs note what "
                                     "they were told late: no pause, latency or time-out is written there"});
  const Playback silent = played("0.000 TX 01 03 00 00 00 01 84 0A\n0.003 TX 02 03 00 00 00 01 84 39\n");
  EXPECT_EQ(silent.scenario.find("timeout"), std::string::npos) << silent.scenario;
  EXPECT_EQ(silent.scenario.find("silence"), std::string::npos) << silent.scenario;
}

TEST(Conversation, AUnitOfTheLanNeverRepeatsTheMessageThatAddressesIt) {
  const auto frames =
      read(recording_of("0.000 0A 06 00 00 00 10\n0.500 0A 06 00 00 00 10\n0.510 0A 06 02 00 00 12\n"), "pc1000-lan");
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[1].direction, Direction::Request);
  EXPECT_EQ(frames[1].repeats, std::nullopt) << "the key is somewhere, so it is no echo";
  EXPECT_EQ(frames[2].other, 1U);
}

TEST(Playback, APollWithoutAnAnswerYetIsNotAskedAgain) {
  const auto frames =
      read(recording_of("0.040 TX 68 1b 1b 68 02 00 6c 32 01 00 00 00 01 00 0e 00 00 04 01 12 0a 10 02 00 01 00 "
                        "01 84 00 1f 40 c8 16\n0.080 RX e5\n0.100 TX 10 02 00 5c 5e 16\n0.112 RX e5\n"
                        "0.140 TX 10 02 00 7c 7e 16\n0.160 RX 68 16 16 68 00 02 08 32 03 00 00 00 01 00 02 00 "
                        "05 00 00 04 01 ff 04 00 08 ca 21 16\n"),
           "ppi");
  const Playback played = playback(frames, {}, {});
  EXPECT_EQ(played.scenario.find("10 02 00 5c"), std::string::npos) << played.scenario;
  EXPECT_NE(played.scenario.find("- send: 10 02 00 7c"), std::string::npos) << played.scenario;
  EXPECT_EQ(played.notes,
            std::vector<std::string>{"line 3: left out: a poll to which there was no answer yet; when there is one "
                                     "hangs on the scan of whoever is asked"});
  const auto cut_off = read(recording_of("0.100 TX 10 02 00 5c 5e 16\n0.112 RX e5\n"), "ppi");
  EXPECT_NE(playback(cut_off, {}, {}).scenario.find("expect: e5"), std::string::npos) << "nobody has asked again";
}

TEST(Conversation, AFrameCheckByThePolynomialAloneIsSaidToBeSo) {
  const auto frames =
      read(recording_of("TX 0c 00 20 40 00 0c 02 00 08 02 6f 6b\nTX 0c 00 20 40 00 0c 02 00 08 02 6f 2f\n"), "hppc");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_TRUE(frames[0].text.ends_with("; its frame check is right by the polynomial only")) << frames[0].text;
  EXPECT_FALSE(frames[1].text.ends_with("only")) << frames[1].text;
}

TEST(Conversation, AFrameOfACaptureGoesOnAfterLessThanACharacterOfSilence) {
  const auto divided = [](const char* second, const Stamps& stamps) {
    return read(recording_of(fmt::format("0.000 01 03 00 00\n{} 00 01 84 0A\n", second)), "modbus", stamps);
  };
  const Stamps capture{.character = ms, .exact = true};
  EXPECT_EQ(divided("0.0045", capture).size(), 1U);
  EXPECT_EQ(divided("0.005", capture).size(), 2U) << "a character of silence";
  EXPECT_EQ(divided("0.002", capture).size(), 2U) << "a second station";
}

TEST(Conversation, AReaderReadsEachFrameOnce) {
  const auto frames =
      read(recording_of("0.000 0A 05 00 00 00 0F\n0.250 0A 05 00 00 00 0F\n0.300 05 00 40 00 00 45\n"), "pc1000-lan");
  EXPECT_EQ(frames[1].direction, Direction::Request);
  EXPECT_EQ(frames[2].station, 5U);
}

TEST(Conversation, ABlockWriteWithAWrongDataCheckIsAWrongRequestAndIsNotAskedAgain) {
  const auto frames = read(recording_of("0.000 TX 07 00 40 01 00 48 12 34 46\n0.010 RX 07 00 40 01 00 48\n"
                                        "0.100 TX 07 00 40 01 00 48 12 34 47\n"),
                           "pc1000-lan");
  EXPECT_TRUE(frames[0].right);
  EXPECT_EQ(frames[2].direction, Direction::Request);
  EXPECT_FALSE(frames[2].right);
  EXPECT_EQ(playback(frames, {}, {}).notes,
            std::vector<std::string>{"line 3: left out: the request is wrong: write 2 bytes from word 16#4000 on: 12 34; "
                                     "wrong data check"});
}

TEST(Conversation, OfARequestThatARecordingEndsWithNothingIsExpected) {
  const Playback played = playback(read(recording_of("0.000 TX 01 03 00 00 00 01 84 0A\n0.025 RX 01 03 02 12 34 B5 33\n"
                                                     "0.100 TX 02 03 00 00 00 01 84 39\n")),
                                   {}, {});
  EXPECT_EQ(played.notes, std::vector<std::string>{"line 3: nothing is expected of its answer: the recording ends there"});
  EXPECT_EQ(played.scenario.find("silence"), std::string::npos) << played.scenario;
  const Playback broadcast = playback(read(recording_of("0.000 TX 00 06 00 00 00 01 49 DB\n")), {}, {});
  EXPECT_NE(broadcast.scenario.find("expect: silence"), std::string::npos) << "no one answers that";
  EXPECT_EQ(broadcast.notes, std::vector<std::string>{});
}

TEST(Conversation, AScenarioOfPpiNamesTheStationThatAProgramHasToBe) {
  const auto frames = read(recording_of("10 07 00 49 50 16\n10 00 07 00 07 16\n"), "ppi");
  EXPECT_EQ(ppi_station_asked(frames, {}), 7U);
  EXPECT_EQ(ppi_station_asked(frames, 3), 3U);
  EXPECT_NE(playback(frames, {}, {.program = "a.stl", .ppi_station = 7}).scenario.find("    ppi_station: 7\n"),
            std::string::npos);
  EXPECT_EQ(ppi_station_asked(read(recording_of("10 07 00 49 50 16\n10 08 00 49 51 16\n"), "ppi"), {}), std::nullopt);
}

TEST(Conversation, ARecordingWithoutARequestToAStationNamesThoseThatThereAre) {
  const auto frames = read(recording_of("TX 01 03 00 00 00 01 84 0A\nTX 02 03 00 00 00 01 84 39\n"));
  EXPECT_EQ(why_nothing_is_asked(frames, {.station = 77}),
            "no request to station 77 in it; the stations that are asked: 1, 2");
  EXPECT_EQ(why_nothing_is_asked({}, {.station = 77}), "no request in it; s7200 decode shows what is");
}

TEST(Conversation, AFrameIsCountedOnce) {
  const auto frames = read(recording_of("TX 01 03 00 00 00 01 84 0B\nRX 01 03 02 12 34 B5 33\nRX 01 03 02 12 34 B5 34\n"));
  DecodedSummary summary;
  for (const ReadFrame& frame : frames) summary.add(frame);
  EXPECT_EQ(summary.json()["wrong"].get<int>() + summary.json()["strays"].get<int>() + summary.json()["answered"].get<int>(),
            3)
      << summary.text();
}

TEST(Conversation, AFrameThatIsSentWithoutTheLengthOfARequestIsNone) {
  const auto frames = read(recording_of("TX 01 03 04 12 34 56 78 81 07\n"));
  EXPECT_EQ(texts(frames), std::vector<std::string>{"> no request: it does not have the length of its function"});
  EXPECT_FALSE(frames[0].right);
}

/// What a log says after its directions are settled, and the last note.
std::pair<std::vector<std::string>, std::string> settled(const std::string& log) {
  LineRecording recording = recording_of(log);
  settle_directions(recording, *find_recorded_protocol("modbus"));
  return {texts(read(recording)), recording.notes.empty() ? "" : recording.notes.back()};
}

TEST(Conversation, DirectionsThatAreAllTheSameAreLeftOpenWhereFramesSayOtherwise) {
  const auto [said, note] = settled(
      "0.000 RX 01 03 00 0a 00 02 e4 09\n0.030 RX 01 03 04 12 34 56 78 81 07\n"
      "0.060 RX 01 03 00 0a 00 02 e4 09\n0.090 RX 01 83 02 c0 f1\n");
  EXPECT_EQ(said, (std::vector<std::string>{
                      "> station 1, read holding registers 40011, 2 of them", "< 2 registers: 16#1234 16#5678",
                      "> station 1, read holding registers 40011, 2 of them", "< exception 2: illegal data address"}));
  EXPECT_EQ(note, "the file marks all frames alike: what they say tells requests and answers apart");
  EXPECT_EQ(settled("0.000 TX 01 03 00 0a 00 02 e4 09\n0.030 TX 01 03 00 0a 00 02 e4 09\n").second, "");
}

TEST(Conversation, ASlavesLogIsReadWithTheDirectionsTheOtherWayRound) {
  const auto [said, note] = settled("0.000 RX 01 03 00 0a 00 02 e4 09\n0.030 TX 01 03 04 12 34 56 78 81 07\n");
  EXPECT_EQ(said, (std::vector<std::string>{"> station 1, read holding registers 40011, 2 of them",
                                            "< 2 registers: 16#1234 16#5678"}));
  EXPECT_EQ(note, "what the file marks as sent are the answers, and what it marks as received the requests");
  EXPECT_EQ(settled("0.000 TX 01 03 00 0a 00 02 e4 09\n0.030 RX 01 03 04 12 34 56 78 81 07\n").second, "");
}

TEST(Conversation, AFrameThatALogHasInSeveralRowsIsOne) {
  const Stamps stamps{.character = 1'145'833};
  const auto said = [&](const std::string& rows) {
    return texts(read(recording_of("0.000 TX 01 03 00 0a 00 02 e4 09\n" + rows), "modbus", stamps));
  };
  const std::vector<std::string> one{"> station 1, read holding registers 40011, 2 of them",
                                     "< 2 registers: 16#1234 16#5678"};
  EXPECT_EQ(said("0.030 RX 01 03 04\n0.0335 RX 12 34 56 78 81 07\n"), one);
  EXPECT_EQ(said("0.030 RX 01 03 04\n0.030 RX 12 34 56 78 81 07\n"), one) << "noted at once";
  EXPECT_EQ(said("0.030 RX 01 03 04\n0.034 RX 12 34\n0.036 RX 56 78 81 07\n"), one);
  EXPECT_EQ(said("0.030 RX 01 03 04\n0.240 RX 12 34 56 78 81 07\n"), one) << "it says that more is to come";
  EXPECT_EQ(said("0.030 RX 01 03 04\n0.034 RX 12 34 56 78 81 08\n").size(), 3U) << "a wrong CRC";
  EXPECT_EQ(said("0.030 RX 01 03 04\n0.034 TX 12 34 56 78 81 07\n").size(), 3U) << "of the other";
}

TEST(Conversation, AFrameOfManyMessagesIsReadInOneGo) {
  constexpr std::size_t kPairs = 50'000;
  LineRecording recording{.frames = {{.at = 0}}, .is_log = true};
  Bytes& all = recording.frames[0].bytes;
  for (std::size_t i = 0; i < kPairs; ++i)
    for (const Bytes* message : {&kRequest, &kAnswer}) all.insert(all.end(), message->begin(), message->end());
  const auto frames = read(recording);
  ASSERT_EQ(frames.size(), 2 * kPairs);
  EXPECT_EQ(frames.back().frame.bytes, kAnswer);
  EXPECT_TRUE(frames.back().right);
}

TEST(Conversation, ARecordingThatLooksLikeAnotherProtocolIsSeen) {
  const LineRecording ppi = recording_of("10 02 00 49 4B 16\n10 00 02 00 02 16\n10 02 00 5C 5E 16\nE5\n");
  const LineRecording modbus = recording_of("TX 01 03 00 00 00 01 84 0A\nRX 01 03 02 12 34 B5 33\n");
  const auto likelier = [](const LineRecording& recording, std::string_view chosen) {
    const RecordedProtocol& protocol = *find_recorded_protocol(chosen);
    const RightFrames right(conversation(recording, protocol));
    const RecordedProtocol* other = likelier_protocol(recording, protocol, right, {});
    return other == nullptr ? "" : std::string(other->name);
  };
  EXPECT_EQ(likelier(ppi, "modbus"), "ppi");
  EXPECT_EQ(likelier(ppi, "ppi"), "");
  EXPECT_EQ(likelier(modbus, "ppi"), "modbus");
  EXPECT_EQ(likelier(modbus, "modbus"), "");
  const LineRecording disturbed =
      recording_of("10 02 00 49 4B 16\n10 00 02 00 02 16\n10 02 00 5C 5E 16\n10 02 00 5C 5F 16\n");
  EXPECT_EQ(likelier(disturbed, "modbus"), "ppi") << "three frames of four";
  EXPECT_EQ(likelier(recording_of("11 22 33 44 55\n66 77 88\n"), "modbus"), "") << "nothing that is known";
}

TEST(Conversation, MessagesThatFollowEachOtherCloselyAreToldApartByWhatTheySay) {
  const LineRecording recording = recording_of(character_rows(
      {"01 03 00 00 00 01 84 0A", "01 03 02 12 34 B5 33", "01 06 00 00 00 01 48 0A", "01 06 00 00 00 01 48 0A"}, ms,
      2 * ms));
  EXPECT_EQ(recording.frames.size(), 1U) << "the gap of 5 ms joins them";
  const auto frames = read(recording, "modbus", {.character = ms});
  EXPECT_EQ(texts(frames),
            (std::vector<std::string>{"> station 1, read holding registers 40001, 1 of them", "< 1 register: 16#1234",
                                      "> station 1, write register 40001 = 16#0001", "< register 40001 written: 16#0001"}));
  EXPECT_EQ(frames[1].latency, 2 * ms);
  EXPECT_EQ(frames[2].silence, 2 * ms);
}

TEST(Conversation, ALineOfALogThatIsSeveralRightMessagesIsDivided) {
  const LineRecording log = recording_of("0.000 01 03 00 00 00 01 84 0A 01 03 02 12 34 B5 33\n");
  const auto frames = read(log, "modbus", {.character = ms});
  EXPECT_EQ(texts(frames),
            (std::vector<std::string>{"> station 1, read holding registers 40001, 1 of them", "< 1 register: 16#1234"}));
  EXPECT_EQ(frames[1].frame.place, "line 1");
  EXPECT_EQ(frames[1].latency, std::nullopt) << "the log does not say when the answer began";
  EXPECT_EQ(read(log, "modbus", {.exact = true}).size(), 1U) << "on the line of a capture there was no silence between them";
}

TEST(Conversation, ALineOfALogWithOneWrongMessageInItIsNotDivided) {
  for (const char* const line : {"0.000 01 03 00 00 00 01 84 0A 01 03 02 12 34 B5 34\n", "0.000 01 03 00 00 00 01 84 0B\n",
                                 "0.000 01 03 00 00 00 01 84 0A 01\n"}) {
    const auto frames = read(recording_of(line));
    ASSERT_EQ(frames.size(), 1U) << line;
    EXPECT_FALSE(frames[0].right) << line;
  }
}

TEST(Conversation, WhereTheTimesOfALogOverlapNoSilenceIsKnown) {
  const auto frames =
      read(recording_of("0.000 TX 01 03 00 00 00 01 84 0A\n0.003 RX 01 03 02 12 34 B5 33\n"), "modbus", {.character = ms});
  EXPECT_EQ(frames[1].direction, Direction::Answer);
  EXPECT_EQ(frames[1].latency, std::nullopt);
  EXPECT_EQ(frames[1].silence, std::nullopt);
  EXPECT_EQ(decoded_text(frames, false).find("0 ns"), std::string::npos) << decoded_text(frames, false);
}

TEST(Conversation, AnAnswerThatNoRequestWasHeardOfIsNotTakenForOne) {
  const auto frames = read(recording_of("0.000 01 03 04 00 00 00 00 FA 33\n"));
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].direction, Direction::Unknown);
  EXPECT_EQ(frames[0].text, "an answer without its request");
}

TEST(Conversation, ThePc1000LanIsReadMessageByMessageWithTheUnitThatWasAddressedLast) {
  const auto frames = read(recording_of(character_rows({"0A 05 00 00 00 0F", "0A 05 09 04 02 1E", "05 00 40 03 00 48",
                                                        "05 00 40 03 00 48 34 12 78 56 14", "07 FF 00 01 00 07 CD AB 78",
                                                        "07 FF 00 01 00 07", "03 05 82 11 00 9B", "03 05 82 11 00 9B"},
                                                       ms, ms)),
                           "pc1000-lan", {.character = ms});
  EXPECT_EQ(texts(frames),
            (std::vector<std::string>{"> address unit 16#05", "< keyswitch in stop, fault mode, fault register 16#0204",
                                      "> read 4 bytes from word 16#4000 on", "< 34 12 78 56",
                                      "> write 2 bytes from word 16#00FF on: cd ab", "< done", "> retest", "< done"}));
  for (const ReadFrame& frame : frames) EXPECT_TRUE(frame.right) << frame.text;
  EXPECT_EQ(frames[2].station, 5);
  EXPECT_EQ(frames[3].latency, ms) << "one character";
}

TEST(Conversation, AMessageOfTheLanWithAWrongCheckIsNone) {
  const auto frames = read(
      recording_of("0.000 TX 0A 05 00 00 00 0E\n0.100 TX 0A 05 00 00 00 0F\n0.110 RX 0A 06 01 00 00 11\n"), "pc1000-lan");
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0].text, "not a message: its opcode, length or check is wrong");
  EXPECT_EQ(frames[2].other, 1U);
  EXPECT_FALSE(frames[2].right) << "another unit";
}

TEST(Conversation, WestnetIsReadWithItsCommandsAndErrors) {
  const auto frames = read(
      recording_of("0.000 09 00 00 05 01 0F\n0.010 09 00 00 05 01 0F\n0.020 09 05 00 00 00 0E\n0.030 09 05 00 01 00 0F\n"
                   "0.040 05 00 00 01 00 06\n0.050 FF 12\n"),
      "westnet");
  EXPECT_EQ(texts(frames),
            (std::vector<std::string>{"> address 00.05.01", "< PLC 00.05.01 addressed", "> read session status",
                                      "< session of 00.01.00", "> read 2 bytes from word 16#0000 on",
                                      "< error 16#12: PLC in session with another computer"}));
}

TEST(Conversation, WhatARequestWritesIsShown) {
  const auto text = [](const Bytes& pdu) {
    const Bytes frame = modbus::rtu_frame(1, pdu);
    std::string line = "0.000 TX:";
    for (const std::uint8_t byte : frame) line += fmt::format(" {:02x}", byte);
    return read(recording_of(line + "\n"), "modbus").at(0).text;
  };
  const std::uint16_t words[]{0x1234, 5};
  EXPECT_EQ(text(modbus::write_registers(0, words)), "station 1, write registers 40001, 2 of them: 16#1234 16#0005");
  EXPECT_EQ(text(modbus::write_coils(2, {true, false, true, true, false, true})),
            "station 1, write coils 00003, 6 of them: 1011 01");
  EXPECT_EQ(text(modbus::diagnostics(0, std::span(words).first(1))), "station 1, diagnostics 0, loopback: 16#1234");
  const modbus::Reference file{.file = 4, .record = 1, .count = 2, .data = {}};
  EXPECT_EQ(text(modbus::read_file_record({&file, 1})), "station 1, read file record: file 4, record 1, 2 registers");
  const modbus::Reference written{.file = 4, .record = 7, .count = 1, .data = {0x06, 0xAF}};
  EXPECT_EQ(text(modbus::write_file_record({&written, 1})),
            "station 1, write file record: file 4, record 7, 1 register: 16#06AF");
  const modbus::Reference extended{modbus::kExtendedMemoryReference, 0x10, 4, 2, {0x12, 0x34}};
  EXPECT_EQ(text(modbus::write_file_record({&extended, 1})),
            "station 1, write file record: extended memory 0010:0004, 2 bytes: 12 34");
}

TEST(Conversation, OperandsOfAnHppcAreAddressesAndValues) {
  using namespace westinghouse;
  const auto line = [](std::uint8_t to, std::uint8_t from, HppcOpcode opcode, const Bytes& operands) {
    std::string text;
    for (const std::uint8_t byte : hppc_message(to, from, opcode, operands, FcsTable::Document))
      text += fmt::format(" {:02x}", byte);
    return "0.000" + text + "\n";
  };
  const auto said = [&](HppcOpcode opcode, const Bytes& request, const Bytes& answer) {
    return texts(read(recording_of(line(kIop, kApl, opcode, request) + line(kApl, kIop, opcode, answer)), "hppc"));
  };
  using Texts = std::vector<std::string>;
  EXPECT_EQ(said(HppcOpcode::Read, hppc_read(0x80002, 2), {2, 0x56, 0x04}),
            (Texts{"> read 2 bytes from 16#80002 on", "< 2 bytes: 56 04"}));
  EXPECT_EQ(said(HppcOpcode::Write, hppc_write(0x80002, Bytes{1, 2}), {}),
            (Texts{"> write 2 bytes from 16#80002 on: 01 02", "< done"}));
  EXPECT_EQ(said(HppcOpcode::BitWrite, hppc_bit_write(0xABFFE, 0xF000, 0xFF00), {}),
            (Texts{"> write bits of the word at 16#ABFFE: 16#F000, those of the mask 16#FF00", "< done"}));
  const std::uint32_t byte[]{0xABFFC}, word[]{0xABFFE};
  EXPECT_EQ(said(HppcOpcode::Monitor, hppc_monitor(5, byte, word, {}), {0x02, 0x11, 0x34, 0x12}),
            (Texts{"> monitor network 5, byte at 16#ABFFC, word at 16#ABFFE",
                   "< status 16#02: network not found, 16#ABFFC is 16#11, 16#ABFFE is 16#1234"}));
  EXPECT_EQ(said(HppcOpcode::Parameters, {0}, {0, 0, 8}),
            (Texts{"> parameter table, 0 bytes", "< parameter table at 16#80000"}));
}

TEST(Conversation, OperandsOfAnHppcAreReadInTheLayoutThatIsChosen) {
  using namespace westinghouse;
  const auto said = [&](std::string_view option, std::string_view word, HppcOpcode opcode, const Bytes& operands) {
    RecordedProtocol hppc = *find_recorded_protocol("hppc");
    EXPECT_TRUE(hppc.choose(option, word));
    std::string text = "0.000";
    for (const std::uint8_t byte : hppc_message(kIop, kApl, opcode, operands, FcsTable::Document))
      text += fmt::format(" {:02x}", byte);
    return conversation(recording_of(text + "\n"), hppc, {}).front().text;
  };
  const HppcLayout layout{HppcLayout::ReadRequest::Number, HppcLayout::BitWrite::MaskFirst, 4};
  EXPECT_EQ(said("--read-request", "number", HppcOpcode::Read, hppc_read(0, 2, layout)), "read 2 bytes from 16#00000 on");
  EXPECT_EQ(said("--bit-write", "mask_first", HppcOpcode::BitWrite, hppc_bit_write(0xABFFE, 0xF000, 0xFF00, layout)),
            "write bits of the word at 16#ABFFE: 16#F000, those of the mask 16#FF00");
  const std::uint32_t words[]{0xABFFC, 0xABFFE};
  EXPECT_EQ(said("--monitor-address-bytes", "4", HppcOpcode::Monitor, hppc_monitor(5, {}, words, {}, layout)),
            "monitor network 5, word at 16#ABFFC, word at 16#ABFFE");
}

TEST(Conversation, EveryProtocolIsOneOfTheMasterWithTheSameOptions) {
  std::vector<std::string_view> recorded, asked;
  for (const RecordedProtocol& protocol : recorded_protocols()) recorded.push_back(protocol.name);
  for (const Protocol* protocol : protocols()) asked.push_back(protocol->name);
  EXPECT_EQ(std::erase(recorded, "text"), 1U) << "a master has no questions in it";
  std::ranges::sort(recorded);
  std::ranges::sort(asked);
  EXPECT_EQ(recorded, asked);
  for (const RecordedProtocol& protocol : recorded_protocols())
    for (const ReaderOption& option : protocol.options) {
      const Protocol* const master = find_protocol(protocol.name);
      ASSERT_TRUE(master) << protocol.name;
      const auto same = std::ranges::find(master->options, option.name, &ProtocolOption::name);
      ASSERT_NE(same, master->options.end()) << option.name;
      EXPECT_EQ(same->standard, option.words.front());
      for (const std::string_view word : option.words) EXPECT_EQ(same->check(std::string(word)), "");
    }
}

TEST(Conversation, ALoaderSessionIsReadStepByStep) {
  const auto frames = read(
      recording_of(character_rows({"02", "10 06", "04", "02", "10 06", "16 10 03", "10 06 90 00 90 01 10 04", "10 06 02",
                                   "10 06", "00 00 00 00 00 10 10 06 10 03", "10 06", "02", "10 06", "12 10 03", "10 06"},
                                  ms, 0)),
      "pc500-loader");
  EXPECT_EQ(texts(frames),
            (std::vector<std::string>{"> start of a session", "< acknowledged", "> read memory", "< ready", "> acknowledged",
                                      "< wants arguments", "> bytes 16#9000…9001", "< arguments accepted", "> acknowledged",
                                      "< 00 00 00 00 00 10 06", "> acknowledged", "< ready", "> acknowledged", "< end",
                                      "> session closed"}));
  EXPECT_TRUE(frames.back().needs_no_answer);
  for (const ReadFrame& frame : frames) EXPECT_TRUE(frame.right) << frame.text;
}

TEST(Conversation, OfALoaderWithPlainDleTheFrameEndsDataThatAreMoreThanWasCounted) {
  const std::string parameters = "00 00 00 00 00 ef 00 ef 80 ee 00 ec 00 ed 00 ea 00 28 04 cf ff";
  const auto data = [&](const std::string& end) {
    RecordedProtocol plain = *find_recorded_protocol("pc500-loader");
    EXPECT_TRUE(plain.choose("--dle", "plain"));
    const auto frames = conversation(recording_of("0.020 02\n0.030 10 06\n0.040 18\n0.050 02\n0.060 10 06\n0.070 16 10 03\n"
                                                  "0.080 10 06 10 04\n0.090 10 06 02\n0.100 10 06\n0.110 " +
                                                  parameters + end + "\n"),
                                     plain, {});
    return frames.back();
  };
  EXPECT_TRUE(data(" 10 03").right);
  EXPECT_EQ(data(" 00 00 10 03").text, parameters + " 00 00");
  EXPECT_FALSE(data(" 00 00 10").right);
}

TEST(Conversation, TheLastWordOfALoaderSessionAndTheFirstOfTheNextMayStandInOneFrame) {
  const LineRecording recording = recording_of(
      "0.000 02\n0.010 10 06\n0.020 03\n0.030 02\n0.040 10 06\n0.050 16 10 03\n0.060 10 06 90 00 07 10 04\n0.070 10 06 02\n"
      "0.080 10 06\n0.090 12 10 03\n0.100 10 06 02\n0.110 10 06\n");
  const auto frames = read(recording, "pc500-loader", {.character = ms});
  const std::vector<std::string> end{"< end", "> session closed", "> start of a session", "< acknowledged"};
  const auto said = texts(frames);
  ASSERT_EQ(said.size(), 13U);
  EXPECT_EQ(std::vector(said.end() - 4, said.end()), end);
  EXPECT_EQ(frames[10].frame.at, 100 * ms);
  EXPECT_EQ(frames[11].frame.at, 102 * ms) << "after two characters";
  EXPECT_EQ(frames[11].silence, 0);
  EXPECT_EQ(frames[12].latency, 7 * ms);
  const auto at_end = read(recording, "pc500-loader", {.character = ms, .at_end = true});
  EXPECT_EQ(at_end[10].frame.at, 99 * ms);
  EXPECT_EQ(at_end[11].frame.at, 100 * ms);
}

TEST(Conversation, ALoaderSessionIsFoundAgainAfterWhatDoesNotFit) {
  const std::string session =
      "02\n10 06\n04\n02\n10 06\n16 10 03\n10 06 90 00 90 00 10 04\n10 06 02\n10 06\n00 00 00 00 00 05 10 03\n10 06\n02\n"
      "10 06\n12 10 03\n10 06\n";
  const auto of_next = [&](const std::string& broken) {
    const auto said = texts(read(recording_of(broken + session), "pc500-loader"));
    return std::vector(said.end() - 15, said.end());
  };
  const auto right = texts(read(recording_of(session), "pc500-loader"));
  ASSERT_EQ(right.size(), 15U);
  EXPECT_EQ(right.back(), "> session closed");
  EXPECT_EQ(of_next(session), right);
  std::vector<std::string> lines;
  for (std::istringstream in(session); std::getline(in, lines.emplace_back());) {
  }
  lines.pop_back();
  for (std::size_t place = 0; place < lines.size(); ++place) {
    std::string without, damaged, broken_off, timed;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      without += i == place ? "" : lines[i] + "\n";
      damaged += (i == place ? "55 AA" : lines[i]) + "\n";
      broken_off += i < place ? lines[i] + "\n" : "";
      timed += i < place ? fmt::format("0.{:02}0 {}\n", i, lines[i]) : "";
    }
    for (std::size_t i = 0; i < lines.size(); ++i) timed += fmt::format("1.{:02}0 {}\n", i, lines[i]);
    EXPECT_EQ(of_next(without), right) << "without step " << place + 1;
    EXPECT_EQ(of_next(damaged), right) << "with step " << place + 1 << " damaged";
    const auto all = texts(read(recording_of(timed), "pc500-loader"));
    EXPECT_EQ(std::vector(all.end() - 15, all.end()), right) << "broken off before step " << place + 1;
    const auto timeless = of_next(broken_off);
    EXPECT_TRUE(std::equal(timeless.begin() + 2, timeless.end(), right.begin() + 2, right.end()))
        << "from the opcode on, broken off before step " << place + 1;
  }
}

TEST(Conversation, ALoaderSessionThatIsRefusedOrBrokenOffBeginsAnew) {
  const auto frames = read(recording_of("0.0 02\n0.1 10 06\n0.2 05\n0.3 10 15\n0.4 02\n0.5 02\n0.6 10 06\n0.7 03\n0.8 55\n"),
                           "pc500-loader");
  EXPECT_EQ(texts(frames),
            (std::vector<std::string>{"> start of a session", "< acknowledged", "> opcode 05",
                                      "< error 16#15: refused (NAK)", "> start of a session", "> start of a session",
                                      "< acknowledged", "> write memory", "? does not fit the handshake: expected 02"}));
}

TEST(Conversation, HppcIsReadWithEitherFrameCheck) {
  const auto frames =
      read(recording_of("0.000 0C 00 20 40 00 0C 01 00 09 02 C7 86\n0.010 0B 00 40 00 00 0C 02 22 33 86 C3\n"
                        "0.020 0C 00 20 40 00 0C 02 00 08 02 6F 2F\n0.030 0B 00 40 00 00 10 11 00 00 AE D1\n"
                        "0.040 0C 00 20 40 00 0C 02 00 08 02 6F 6B\n0.050 0C 00 20 40 00 0C 02 00 08 02 6F 6C\n"),
           "hppc");
  EXPECT_EQ(texts(frames), (std::vector<std::string>{"> read 2 bytes from 16#90001 on", "< 2 bytes: 22 33",
                                                     "> read 2 bytes from 16#80002 on", "< error 16#11: invalid operand",
                                                     "> read 2 bytes from 16#80002 on; its frame check is right by the "
                                                     "polynomial only",
                                                     "> wrong frame check"}));
  EXPECT_TRUE(frames[4].right) << "the polynomial's";
  EXPECT_FALSE(frames[5].right);
}

TEST(Conversation, RandomCharactersAreReadInEveryProtocolToTheirEnd) {
  std::uint32_t random = 1;
  const auto next = [&random] { return (random = random * 1'664'525 + 1'013'904'223) >> 16; };
  constexpr std::array<std::uint8_t, 12> kLikely{0x02, 0x10, 0x06, 0x03, 0x04, 0x05, 0x07, 0x09, 0x0A, 0x0F, 0x00, 0xFF};
  for (const RecordedProtocol& protocol : recorded_protocols()) {
    for (int round = 0; round < 300; ++round) {
      LineRecording recording;
      std::size_t characters = 0, read_back = 0;
      for (std::uint32_t count = next() % 6; count > 0; --count) {
        RecordedFrame frame{.at = 0, .direction = static_cast<Direction>(next() % 3)};
        for (std::uint32_t length = 1 + next() % 40; length > 0; --length) {
          frame.bytes.push_back(next() % 4 == 0 ? static_cast<std::uint8_t>(next()) : kLikely[next() % kLikely.size()]);
          frame.times.push_back(0);
        }
        characters += frame.bytes.size();
        recording.frames.push_back(std::move(frame));
      }
      for (const ReadFrame& frame : conversation(recording, protocol)) read_back += frame.frame.bytes.size();
      EXPECT_EQ(read_back, characters) << protocol.name;
    }
  }
}

TEST(Conversation, ADamagedCharacterIsNamedInItsOwnMessage) {
  LineRecording recording = recording_of(character_rows({"01 03 00 00 00 01 84 0A", "01 03 02 12 34 B5 33"}, ms, 0));
  recording.frames[0].damaged = {10};
  const auto frames = read(recording);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_TRUE(frames[0].right);
  EXPECT_FALSE(frames[1].right);
  EXPECT_EQ(frames[1].text, "character 3 is damaged; 1 register: 16#1234");
}

TEST(Conversation, ARequestThatNeedsNoAnswerIsNotCountedAsUnanswered) {
  const auto frames = read(recording_of("0.000 00 06 00 00 00 01 49 DB\n"));
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_TRUE(frames[0].needs_no_answer);
  DecodedSummary summary;
  summary.add(frames[0]);
  EXPECT_EQ(summary.text(), "requests: 1, answered: 0, 1 need no answer; wrong frames: 0, frames of no request: 0\n");
}

TEST(Conversation, AScenarioAsksTheSameWithTheSameGaps) {
  const LineRecording recording =
      recording_of("0.000 TX 01 03 00 00 00 01 84 0A\n0.025 RX 01 03 02 12 34 B5 33\n0.100 TX 02 03 00 00 00 01 84 39\n");
  const Stamps stamps{.character = 1 * ms};
  const auto frames = read(recording, "modbus", stamps);
  EXPECT_EQ(playback(frames, stamps, {.name = "a \"plant\"", .program = "slave.stl", .tolerance = 5 * ms}).scenario,
            "scenarios:\n  - name: \"a \\\"plant\\\"\"\n    program: \"slave.stl\"\n    tolerance: 5 ms\n    steps:\n"
            "      - send: 01 03 00 00 00 01 84 0a\n        expect: 01 03 02 12 34 b5 33\n        latency: 17 ms\n"
            "        # line 1: station 1, read holding registers 40001, 1 of them; 1 register: 16#1234\n"
            "      - send: 02 03 00 00 00 01 84 39\n        pause: 68 ms\n"
            "        # line 3: station 2, read holding registers 40001, 1 of them\n");
  EXPECT_EQ(playback(frames, stamps, {.station = 9}).scenario, "");
}

TEST(Conversation, AScenarioKeepsTheGapsAfterRequestsWithoutAnAnswer) {
  const auto asked = [](const std::string& log) {
    const std::string scenario = playback(read(recording_of(log)), {}, {}).scenario;
    std::string times;
    std::istringstream lines(scenario);
    for (std::string line; std::getline(lines, line);)
      for (const char* key : {"pause: ", "timeout: "})
        if (const auto at = line.find(key); at != std::string::npos) times += line.substr(at) + '\n';
    return times;
  };
  const auto answered = [](double at) {
    return fmt::format("TX 01 03 00 00 00 01 84 0A\n{} RX 01 03 02 12 34 B5 33\n", at);
  };
  EXPECT_EQ(asked("0.0 TX 02 03 00 00 00 01 84 39\n5.0 " + answered(5.1)), "timeout: 1 s\npause: 4 s\n");
  EXPECT_EQ(asked("0.0 TX 02 03 00 00 00 01 84 39\n0.3 " + answered(0.4)), "timeout: 300 ms\npause: 0 ns\n");
  EXPECT_EQ(asked("0.0 TX 00 06 00 00 00 01 49 DB\n3.0 " + answered(3.1)), "timeout: 1 s\npause: 2 s\n") << "a broadcast";
  EXPECT_EQ(
      asked("0.0 " + answered(0.1) + "2.0 TX 01 03 00 00 00 01 84 0A\n2.1 RX 01 03 02 12 34 B5 34\n5.1 " + answered(5.2)),
      "pause: 5 s\n")
      << "one between them is left out";
}

TEST(Conversation, AScenarioWaitsNoLongerThanScenariosCanAndLongEnoughForLateAnswers) {
  const auto frames =
      read(recording_of("0.000 TX 01 03 00 00 00 01 84 0A\n2.500 RX 01 03 02 12 34 B5 33\n"
                        "100000.0 TX 01 03 00 00 00 01 84 0A\n100000.1 RX 01 03 02 12 34 B5 33\n"
                        "100001.0 TX 01 03 00 00 00 01 84 0A\n200000.0 RX 01 03 02 12 34 B5 33\n"));
  const Playback played = playback(frames, {}, {.name = "plant", .program = "slave.stl", .cpu = "224"});
  EXPECT_NE(played.scenario.find("    program: \"slave.stl\"\n    cpu: 224\n"), std::string::npos) << played.scenario;
  EXPECT_NE(played.scenario.find("latency: 2.5 s\n        timeout: 3.5 s\n"), std::string::npos) << played.scenario;
  EXPECT_NE(played.scenario.find("pause: 24 h\n"), std::string::npos) << played.scenario;
  EXPECT_EQ(played.notes, (std::vector<std::string>{"line 3: the pause before it, 99997.5 s, is shortened to a day",
                                                    "line 5: left out: its answer (line 6) comes more than a day later"}));
}

TEST(Conversation, ARecordingOfAFasterLineThanSaidIsSeen) {
  constexpr Time kAt9600 = 1'145'833, kAt187500 = 58'667;
  const auto is_faster = [](const LineRecording& recording, Time character, bool at_end = false) {
    return is_faster_than_said(recording, {.character = character, .at_end = at_end});
  };
  const LineRecording ppi =
      recording_of("0.000 02 01 03 04 05 06 07 08 09 0a\n0.001 e5\n0.0013 10 03 04 5c 63 16\n0.0020 68 01 02 03 04 05\n");
  EXPECT_TRUE(is_faster(ppi, kAt9600));
  EXPECT_TRUE(is_faster(ppi, kAt9600, true));
  EXPECT_FALSE(is_faster(ppi, kAt187500));
  EXPECT_FALSE(is_faster(ppi, 0)) << "nothing is known of its rate";
  const LineRecording modbus = recording_of("0.000 TX 01 03 00 00 00 01 84 0A\n0.025 RX 01 03 02 12 34 B5 33\n");
  EXPECT_FALSE(is_faster(modbus, kAt9600));
  EXPECT_FALSE(is_faster(recording_of("0.1 TX 01 03 00 00 00 01 84 0A\n0.1 RX 01 03 02 12 34 B5 33\n"
                                      "0.2 TX 01 03 00 00 00 01 84 0A\n0.2 RX 01 03 02 12 34 B5 33\n"),
                         kAt9600))
      << "equal stamps say nothing";
  const Bytes frame{0x10, 0x03, 0x04, 0x5C, 0x63, 0x16};
  LineRecording characters{.frames = {{.at = 0, .bytes = frame}}};
  for (Time i = 0; i < 6; ++i) characters.frames[0].times.push_back(i * kAt187500);
  EXPECT_TRUE(is_faster(characters, kAt9600));
  EXPECT_FALSE(is_faster(characters, kAt187500));
  characters.frames[0].times.assign(6, 0);
  EXPECT_FALSE(is_faster(characters, kAt9600)) << "an adapter delivers several at once";
}

TEST(Conversation, AWrongAnswerIsNoneAndNotExpectedByAScenario) {
  const LineRecording recording =
      recording_of("0.000 TX 01 03 00 00 00 01 84 0A\n0.025 RX 01 03 02 12 34 B5 34\n0.100 TX 02 03 00 00 00 01 84 39\n");
  const auto frames = read(recording);
  DecodedSummary summary;
  for (const ReadFrame& frame : frames) summary.add(frame);
  EXPECT_EQ(summary.text(), "requests: 2, answered: 0; wrong frames: 1, frames of no request: 0\n");
  const Playback left = playback(frames, {}, {.name = "plant"});
  EXPECT_EQ(left.scenario.find("b5 34"), std::string::npos);
  EXPECT_NE(left.scenario.find("send: 02 03 00 00 00 01 84 39\n"), std::string::npos);
  EXPECT_EQ(left.notes, (std::vector<std::string>{"line 1: left out: its answer (line 2): wrong CRC",
                                                  "line 3: nothing is expected of its answer: the recording ends there"}));
}

TEST(Conversation, AScenarioLeavesOutWhatNoSlaveAnswersTheSame) {
  LineRecording recording = recording_of("0.000 01 03 00 00 00 01 84 0A\n0.025 01 03 02 12 34 B5 34\n");
  EXPECT_EQ(playback(read(recording), {}, {}).notes,
            std::vector<std::string>{
                "line 1: left out: what follows it (line 2) may be its answer: wrong CRC, or not a whole frame"});
  recording.frames.pop_back();
  recording.frames[0].damaged = {3};
  EXPECT_EQ(playback(read(recording), {}, {}).notes, std::vector<std::string>{"line 1: left out: the request is damaged"});
}

TEST(Conversation, AScenarioLeavesOutARequestAndTheCharactersThatFollowItWithoutASilence) {
  LineRecording recording =
      recording_of("0.000 01 03 00 00 00 01 84 0A FF\n0.025 01 03 02 12 34 B5 33\n0.100 02 03 00 00 00 01 84 39\n");
  for (int i = 0; i < 9; ++i) recording.frames[0].times.push_back(i * ms);
  const Playback played = playback(read(recording), {}, {});
  EXPECT_EQ(played.notes.front(), "line 1: left out: more characters follow it without a silence: ff");
  EXPECT_EQ(played.scenario.find("send: 01 03"), std::string::npos) << played.scenario;
  EXPECT_NE(played.scenario.find("send: 02 03"), std::string::npos);
}

TEST(Conversation, AScenarioLeavesOutADamagedRequestThatIsMarkedAsOne) {
  const LineRecording recording = recording_of("0.000 TX 01 03 00 00 00 01 84 0B\n0.100 TX 02 03 00 00 00 01 84 39\n");
  const Playback played = playback(read(recording), {}, {});
  EXPECT_EQ(played.notes.front(), "line 1: left out: the request is wrong: wrong CRC, or not a whole frame");
  EXPECT_EQ(played.scenario.find("send: 01 03"), std::string::npos) << played.scenario;
}

TEST(Conversation, AScenarioSaysWhichFramesItLeavesOutBecauseTheyAreNoRequests) {
  const LineRecording recording =
      recording_of("0.000 FF 00\n1.000 01 03 00 00 00 01 84 0A\n1.025 01 03 02 12 34 B5 33\n2.000 FF 01\n");
  const Playback played = playback(read(recording), {}, {});
  EXPECT_EQ(played.notes, std::vector<std::string>{"line 1: left out, and 1 more: wrong CRC, or not a whole frame"});
  EXPECT_NE(played.scenario.find("# line 4: left out"), std::string::npos) << played.scenario;
}

}  // namespace
}  // namespace s7200::tools::recording_test
