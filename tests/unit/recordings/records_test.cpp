// Records in YAML, AT commands, characters in rows of tables without names, marks of bytes, and values that are no bytes.
#include "tests/unit/recordings/conversation.hpp"

namespace s7200::tools::records_test {
namespace {

using namespace test;

const Bytes kRequest{0x01, 0x03, 0x00, 0x00, 0x00, 0x02, 0xC4, 0x0B};
const Bytes kAnswer{0x01, 0x03, 0x04, 0x00, 0x0A, 0x00, 0x14, 0xDA, 0x3E};

TEST(YamlRecords, AMapForEachFrameIsReadInBlockAndFlowStyle) {
  for (const char* text : {
           "- dir: tx\n  data: \"01 03 00 00 00 02 C4 0B\"\n- dir: rx\n  data: \"01 03 04 00 0A 00 14 DA 3E\"\n",
           "- {dir: tx, data: \"01 03 00 00 00 02 C4 0B\"}\n- {dir: rx, data: \"01 03 04 00 0A 00 14 DA 3E\"}\n",
           "port: /dev/ttyUSB0\nflows:\n- request:\n    data: 010300000002C40B\n  response:\n    data: 010304000A0014DA3E\n",
           "- dir: tx # asked\n  data:\n    - 0x01\n    - 0x03\n    - 0\n    - 0\n    - 0\n    - 2\n    - 0xC4\n    - 0x0B\n"
           "- dir: rx\n  data: [1, 3, 4, 0, 10, 0, 20, 218, 62]\n",
           "- dir: tx\n  data: [01, 03, 00, 00,\n         00, 02, C4, 0B]\n- dir: rx\n  data: [01, 03, 04, 00, 0A, 00, 14, "
           "DA, 3E]\n",
           "- dir: tx\n  data: !!binary AQMAAAACxAs=\n- dir: rx\n  data: !!binary |\n    AQMEAAoA\n    FNo+\n",
           "- tx: \"01 03 00 00 00 02 C4 0B\"\n- rx: \"01 03 04 00 0A 00 14 DA 3E\"\n",
           "---\ndir: tx\ndata: 010300000002C40B\n---\ndir: rx\ndata: 010304000A0014DA3E\n",
           "frames:\n  - {dir: request, frame: {station: 1, data: 010300000002C40B}}\n"
           "  - {dir: response, frame: {station: 1, data: 010304000A0014DA3E}}\n",
       })
    EXPECT_EQ(texts(text), kConversation) << text;
}

TEST(YamlRecords, TimesAreThoseOfTheRecords) {
  for (const char* text : {"- {dir: tx, t: 0.0, data: 010300000002C40B}\n- {dir: rx, t: 0.05, data: 010304000A0014DA3E}\n",
                           "- timestamp: 2026-11-27T10:00:00.000Z\n  direction: request\n  bytes: 010300000002C40B\n"
                           "- timestamp: 2026-11-27T10:00:00.050Z\n  direction: response\n  bytes: 010304000A0014DA3E\n"}) {
    const LineRecording recording = recording_of(text);
    ASSERT_EQ(recording.frames.size(), 2U) << text;
    EXPECT_EQ(recording.frames[1].at, 50 * kMillisecond) << text;
    EXPECT_TRUE(recording.notes.empty()) << recording.notes[0];
  }
}

TEST(YamlRecords, ARecordWithoutReadableBytesIsNamed) {
  const LineRecording recording = recording_of(
      "- {dir: tx, data: 010300000002C40B}\n- {dir: rx, data: [1, 300]}\n- {dir: rx, data: 010304000A0014DA3E}\n");
  ASSERT_EQ(recording.frames.size(), 3U);
  EXPECT_TRUE(recording.frames[1].bytes.empty());
  ASSERT_TRUE(recording.frames[1].doubt);
  EXPECT_EQ(recording.frames[1].place, "line 2");
}

TEST(AtCommands, TheirParametersAreTheBytes) {
  for (const char* text : {
           "AT+SEND=01 03 00 00 00 02 C4 0B\nAT+RECV=01 03 04 00 0A 00 14 DA 3E\n",
           "AT+SEND=8,010300000002C40B\nOK\n+RECV=9,010304000A0014DA3E\n",
           "10:00:00.000 AT+SEND=1,8,010300000002C40B\n10:00:00.100 +RCV=1,9,010304000A0014DA3E,-40,9\n",
           "10:00:00.000 > AT+SEND=0103 0000 0002 C40B\n10:00:00.100 < +RECV: 0103 0400 0A00 14DA 3E\n",
           "AT+CIPSEND=8\n> 010300000002C40B\nSEND OK\n+IPD,9:010304000A0014DA3E\n",
           "AT+UARTTX=01,03,00,00,00,02,C4,0B\n+UARTRX=01,03,04,00,0A,00,14,DA,3E\n",
           "at+txh=\"010300000002C40B\"\n+EVT:RX,\"010304000A0014DA3E\"\n",
       })
    EXPECT_EQ(texts(text), kConversation) << text;
  EXPECT_FALSE(read_recording("AT+CONF=01020304,05060708\nOK\n", {}));  // which of them?
}

TEST(TablesOfCharacters, NeedNoNamesInAnyOrder) {
  using Row = std::string (*)(Time at, bool sent, int byte);
  const auto table = [](Row row) {
    std::string text;
    Time at = 0;
    for (const auto& [frame, sent] : {std::pair(kRequest, true), std::pair(kAnswer, false)}) {
      for (const std::uint8_t byte : frame) text += row(std::exchange(at, at + kMillisecond), sent, byte) + "\n";
      at += 50 * kMillisecond;
    }
    return text;
  };
  static const auto seconds = [](Time at) { return std::to_string(static_cast<double>(at) / kSecond); };
  static const auto hex = [](int byte) {
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    return std::string{kDigits[static_cast<std::size_t>(byte) / 16], kDigits[static_cast<std::size_t>(byte) % 16]};
  };
  static const auto way = [](bool sent) { return std::string(sent ? "TX" : "RX"); };
  const Row rows[] = {
      [](Time at, bool sent, int byte) { return seconds(at) + "," + way(sent) + "," + std::to_string(byte); },
      [](Time at, bool sent, int byte) { return way(sent) + ";" + seconds(at) + ";" + hex(byte); },
      [](Time at, bool sent, int byte) { return hex(byte) + "," + seconds(at) + "," + way(sent); },
      [](Time at, bool sent, int byte) { return seconds(at) + ",\t" + (sent ? ">" : "<") + ",\t" + hex(byte); },
      [](Time at, bool sent, int byte) { return seconds(at) + ", " + way(sent) + ", " + hex(byte) + "h"; },
      [](Time at, bool sent, int byte) { return way(sent) + "," + seconds(at) + " s,H'" + hex(byte) + "'"; }};
  for (const Row row : rows) {
    const LineRecording recording = recording_of(table(row));
    ASSERT_EQ(recording.frames.size(), 2U) << table(row);
    EXPECT_EQ(recording.frames[0].bytes, kRequest) << table(row);
    EXPECT_EQ(recording.frames[1].bytes, kAnswer) << table(row);
    EXPECT_EQ(recording.frames[1].at, 58 * kMillisecond) << table(row);
  }
}

TEST(MarksOfBytes, ThoseOfAssemblersAndOfHardwareLanguagesAreRead) {
  for (const auto& [before, after] : {std::pair("H'", "'"), std::pair("h'", "'"), std::pair("H'", ""), std::pair("X'", "'"),
                                      std::pair("8'h", ""), std::pair("H#", ""), std::pair("&h", ""), std::pair("0x", "U")})
    for (const std::string between : {" ", ","}) {
      const auto row = [&, first = std::string(before), last = std::string(after)](std::vector<std::string> bytes) {
        std::string text;
        for (const std::string& byte : bytes) text += (text.empty() ? "" : between) + first + byte + last;
        return text;
      };
      EXPECT_EQ(texts("TX " + row({"01", "03", "00", "00", "00", "02", "C4", "0B"}) + "\nRX " +
                      row({"01", "03", "04", "00", "0A", "00", "14", "DA", "3E"}) + "\n"),
                kConversation)
          << before << between;
    }
  EXPECT_EQ(texts("TX 01h 03h 00h 00h 00h 02h 0C4h 0Bh\nRX 01h 03h 04h 00h 0Ah 00h 14h 0DAh 3Eh\n"), kConversation);
}

TEST(NamedValues, AreNoBytes) {
  const std::string frames = "TX 01 03 00 00 00 02 C4 0B\nRX 01 03 04 00 0A 00 14 DA 3E\n";
  for (const char* line : {"Values: 10 20", "registers = 10, 20", "holding registers: [10, 20]", "Werte: 10 20",
                           "Result: 10 20", "Decoded: slave 1, registers [10, 20]"}) {
    EXPECT_EQ(texts(frames + line + "\n"), kConversation) << line;
    EXPECT_EQ(texts(line + ("\n" + frames)), kConversation) << line;
  }
  EXPECT_EQ(texts("Result: 01 03 00 00 00 02 C4 0B\nResult: 01 03 04 00 0A 00 14 DA 3E\n"), kConversation);  // by its CRC
  const LineRecording more = recording_of(frames + "Register values 10 20 30 40 50\n");
  ASSERT_EQ(more.frames.size(), 3U);
  EXPECT_TRUE(more.frames[2].doubt);
}

TEST(BytesAfterAnEqualsSign, AreAllOfThem) {
  for (const char* text :
       {"data=01 03 00 00 00 02 C4 0B\ndata=01 03 04 00 0A 00 14 DA 3E\n",
        "dir=tx data=01 03 00 00 00 02 C4 0B\ndir=rx data=01 03 04 00 0A 00 14 DA 3E\n",
        "t=0.0 dir=tx data=01 03 00 00 00 02 C4 0B len=8\nt=0.05 dir=rx data=01 03 04 00 0A 00 14 DA 3E len=9\n",
        "TX len=08 01 03 00 00 00 02 C4 0B\nRX len=09 01 03 04 00 0A 00 14 DA 3E\n"})
    EXPECT_EQ(texts(text), kConversation) << text;
}

TEST(ListsOfNumbers, MayHaveDashesBetweenThem) {
  EXPECT_EQ(texts("modbus_rtu: -> 1-3-0-0-0-2-196-11\nmodbus_rtu: <- 1-3-4-0-10-0-20-218-62\n"), kConversation);
}

TEST(TablesOfExchanges, AColumnOfStationsIsNoAnswer) {
  EXPECT_EQ(texts("Nr;Timestamp;Slave;Raw request;Raw response\n1;27.11.2026 10:00:00;1;01 03 00 00 00 02 C4 0B;"
                  "01 03 04 00 0A 00 14 DA 3E\n"),
            kConversation);
  EXPECT_EQ(texts("TX {0x01,0x03,0x00,0x00,0x00,0x02,0xC4,0x0B}; // read\nRX "
                  "{0x01,0x03,0x04,0x00,0x0A,0x00,0x14,0xDA,0x3E}; // 10 20\n"),
            kConversation);
}

TEST(OtherProducts, TheirProgramsAreNamedWhereNoFrameIs) {
  EXPECT_EQ(read_recording("LOGO! Soft Comfort V8.3\nQ1 -- M1\n", {}).why().substr(0, 34),
            "it is about LOGO!, not the S7-200;");
  EXPECT_EQ(read_recording("<Document>\n<SW.Blocks.FC ID=\"0\"></SW.Blocks.FC>\n</Document>\n", {}).why().substr(0, 29),
            "it is a block of TIA Portal f");
  EXPECT_EQ(texts("LOGO! as master\nTX 01 03 00 00 00 02 C4 0B\nRX 01 03 04 00 0A 00 14 DA 3E\n"), kConversation);
}

TEST(ModbusTcp, ARequestOfRtuWithAWrongCrcIsNone) {
  for (const char* text : {"TX 01 03 00 00 00 02 C4 0C\n", "01 01 00 00 00 02 BD CC\n", "TX 05 06 00 00 00 02 12 34\n"}) {
    const LineRecording recording = recording_of(text);
    ASSERT_EQ(recording.frames.size(), 1U);
    EXPECT_FALSE(recording.over_tcp) << text;
    EXPECT_EQ(texts(text), std::vector<std::string>{"wrong CRC, or not a whole frame"}) << text;
  }
  EXPECT_EQ(texts("01 03 00 00 00 02 0B C4\n"),
            std::vector<std::string>{"its CRC has the high byte first: Modbus RTU sends the low byte first"});
  EXPECT_TRUE(recording_of("TX 01 03 00 00 00 02 01 07\nTX 01 04 00 00 00 06 01 03 00 00 00 02\n").over_tcp);
}

}  // namespace
}  // namespace s7200::tools::records_test
