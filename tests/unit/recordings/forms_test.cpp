// Recordings in the forms of particular tools: each holds the same conversation, a request and its answer.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <tuple>

#include "serial_sim/line/character.hpp"
#include "tools/recordings/conversation.hpp"
#include "tools/recordings/levels/samplerate.hpp"
#include "tools/recordings/rows/notation.hpp"
#include "tools/recordings/rows/table_rows.hpp"

namespace s7200::tools::forms_test {
namespace {

constexpr Time ms = kMillisecond;

const Bytes kRequest{0x01, 0x03, 0x00, 0x0A, 0x00, 0x02, 0xE4, 0x09};
const Bytes kAnswer{0x01, 0x03, 0x04, 0x12, 0x34, 0x56, 0x78, 0x81, 0x07};

LineRecording recording_of(const std::string& bytes, const ReadingChoices& choices = {}) {
  auto recording = read_recording(bytes, choices);
  EXPECT_TRUE(recording) << recording.why();
  return recording.value_or(LineRecording{});
}

std::string refusal_of(const std::string& bytes, const ReadingChoices& choices = {}) {
  return read_recording(bytes, choices).why();
}

/// The request and its answer, with `latency` between their begins if the recording has times.
void expect_the_conversation(const LineRecording& recording, std::string_view form, std::optional<Time> latency) {
  EXPECT_EQ(recording.form, form);
  const auto frames = conversation(recording, *find_recorded_protocol("modbus"));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].frame.bytes, kRequest);
  EXPECT_EQ(frames[0].direction, Direction::Request);
  EXPECT_EQ(frames[1].frame.bytes, kAnswer);
  EXPECT_EQ(frames[1].direction, Direction::Answer);
  EXPECT_EQ(frames[1].other, 0U);
  const auto between = frames[1].frame.at ? std::optional(*frames[1].frame.at - *frames[0].frame.at) : std::nullopt;
  EXPECT_EQ(between, latency);
}

/// A row for each character, 1.145833 ms after the one before; the answer follows 20 ms after the request.
std::string rows_of(const std::string& head, const std::function<std::string(Time at, std::uint8_t byte)>& row) {
  std::string text = head;
  Time at = ms;
  for (const Bytes& frame : {kRequest, kAnswer}) {
    for (const std::uint8_t byte : frame) text += row(at, byte) + '\n', at += 1'145'833;
    at += 20 * ms;
  }
  return text;
}
constexpr Time kLatency = 8 * 1'145'833 + 20 * ms;

// --- notations ---

Result<const Notation&> notation_of(std::initializer_list<std::string_view> cells) {
  NotationFinder finder;
  std::size_t line = 1;
  for (const std::string_view cell : cells) finder.take(cell, ++line);
  return finder.found();
}

TEST(Notations, AColumnIsInTheNotationThatReadsAllOfItsCells) {
  const auto bytes_in = [](std::initializer_list<std::string_view> cells) {
    const auto notation = notation_of(cells);
    Bytes bytes;
    for (const std::string_view cell : cells) {
      const Bytes some = notation ? *notation->read(cell) : Bytes{};
      bytes.insert(bytes.end(), some.begin(), some.end());
    }
    return bytes;
  };
  EXPECT_EQ(bytes_in({"0x01", "0x10", "0xE4"}), (Bytes{1, 0x10, 0xE4}));
  EXPECT_EQ(bytes_in({"01", "10", "E4"}), (Bytes{1, 0x10, 0xE4}));
  EXPECT_EQ(bytes_in({"1", "10", "228"}), (Bytes{1, 10, 228}));
  EXPECT_EQ(bytes_in({"001", "012", "344"}), (Bytes{1, 10, 228})) << "octal";
  EXPECT_EQ(bytes_in({"00000001", "00001010", "11100100"}), (Bytes{1, 10, 228})) << "no four bytes in hex";
  EXPECT_EQ(bytes_in({"0b00000001", "0b00001010"}), (Bytes{1, 10}));
  EXPECT_EQ(bytes_in({"10 (0x0A)", "18 (0X12)"}), (Bytes{10, 18})) << "each is one byte, not two";
  EXPECT_EQ(bytes_in({"'1' (0x01)", "4 (0x34)", "\\r (0x0D)", "COMMA (0x2C)"}), (Bytes{1, 0x34, 0x0D, 0x2C}));
  EXPECT_EQ(bytes_in({"'1'", "4", "\\r", "COMMA", "' '", "'228'"}), (Bytes{1, '4', 0x0D, ',', ' ', 228}));
  EXPECT_EQ(bytes_in({"[01]", "U", "[", "[FF]"}), (Bytes{1, 'U', '[', 0xFF}));
}

TEST(Notations, WhatIsNotUnderstoodIsNamedInTheNotationThatReadsMost) {
  EXPECT_EQ(notation_of({"1", "3", "0"}).why(), "line 2: '1' may be a number or a character; write the column in hex");
  EXPECT_EQ(notation_of({"0x01", "0x02", "frob"}).why(), "line 4: 'frob' is not bytes in hex");
  EXPECT_EQ(notation_of({"1", "256"}).why(), "line 3: '256' is not bytes in decimal");
}

TEST(Notations, ALiteralHasTheEscapesOfC) {
  EXPECT_EQ(bytes_of_literal(R"(\1\3\0\n\0\2\344\t)"), kRequest);
  EXPECT_EQ(bytes_of_literal(R"(\x01\x03\x04\x124Vx\x81\a)"), kAnswer);
  EXPECT_EQ(bytes_of_literal(R"(\"\\\r\0061)"), (Bytes{'"', '\\', 0x0D, 0x06, '1'})) << "an octal number has three digits";
  for (const char* text : {"\\", "\\q", "\\x", "\\777"}) EXPECT_EQ(bytes_of_literal(text), std::nullopt) << text;
}

TEST(Notations, ALineEndAfterAnOpeningMarkIsARecordedCharacter) {
  TableRows rows("a,\"\n\"\nb,\",\"\nc,\"\r\n\"\r\nd");
  EXPECT_EQ(fields_of(rows.next()->text, ','), (std::vector<std::string>{"a", "\n"}));
  const auto comma = rows.next();
  EXPECT_EQ(comma->number, 3U);
  EXPECT_EQ(fields_of(comma->text, ','), (std::vector<std::string>{"b", ","}));
  EXPECT_EQ(fields_of(rows.next()->text, ','), (std::vector<std::string>{"c", "\r\n"}));
  EXPECT_EQ(rows.next()->text, "d");
  EXPECT_EQ(rows.next(), std::nullopt);
  EXPECT_EQ(fields_of("\"\"\"\";x", ';'), (std::vector<std::string>{"\"", "x"}));
}

TEST(Notations, ASamplerateHasAUnit) {
  EXPECT_EQ(samplerate_of("1 MHz"), 1'000'000U);
  EXPECT_EQ(samplerate_of("500kHz"), 500'000U);
  EXPECT_EQ(samplerate_of("2.4M"), 2'400'000U);
  EXPECT_EQ(samplerate_of("1000000"), 1'000'000U);
  for (const char* text : {"", "0", "MHz", "1 s", "-1", "1e99 Hz", "200 GHz"})
    EXPECT_EQ(samplerate_of(text), std::nullopt) << text;
}

// --- logic analysers ---

TEST(Forms, DsviewHasAColumnForEachDecoder) {
  const auto row = [](const char* cell) {
    return [cell, id = 0](Time at, std::uint8_t byte) mutable {
      return fmt::format("{},{}.00000000000000000000,{}", id++, at, fmt::format(fmt::runtime(cell), byte));
    };
  };
  expect_the_conversation(recording_of(rows_of("Id,Time[ns],0:UART: RX/TX\n", row("{:02X}"))), "DSView", kLatency);
  expect_the_conversation(recording_of(rows_of("Id,Time[ns],0:UART: RX/TX\n", row("[{:02X}]"))), "DSView", kLatency);
  EXPECT_EQ(refusal_of("Id,Time[ns],0:UART: RX\n0,1000000.0,01\n1,2100000.0,frob\n"), "line 3: 'frob' is not bytes in hex");
}

TEST(Forms, DsviewNamesTheDirectionInItsColumnAndTheDamageInItsCells) {
  const LineRecording both = recording_of(
      "Id,Time[ns],0:UART: RX,0:UART: TX\n0,1000000.0,,01\n1,2145833.0,,Stop bit\n2,30145833.0,02,\n3,31345833.0,Frame "
      "error,\n");
  ASSERT_EQ(both.frames.size(), 2U);
  EXPECT_EQ(both.frames[0].direction, Direction::Request);
  EXPECT_EQ(both.frames[0].bytes, Bytes{0x01});
  EXPECT_EQ(both.frames[1].direction, Direction::Answer);
  EXPECT_EQ(both.frames[1].damaged, std::vector<std::size_t>{0});
}

TEST(Forms, SaleaeLogic1WritesACharacterInAnyOfItsNotations) {
  const auto in_ascii = [](std::uint8_t byte) {
    return byte > 32 && byte < 127 ? std::string(1, static_cast<char>(byte)) : fmt::format("'{}'", byte);
  };
  const auto rows = [](auto cell) {
    return rows_of("Time [s],Value,Parity Error,Framing Error\n", [&](Time at, std::uint8_t byte) {
      return fmt::format("{:.9f},{},,", static_cast<double>(at) / kSecond, cell(byte));
    });
  };
  expect_the_conversation(recording_of(rows([](std::uint8_t byte) { return fmt::format("0x{:02X}", byte); })), "CSV",
                          kLatency);
  expect_the_conversation(recording_of(rows([](std::uint8_t byte) { return fmt::format("{}", byte); })), "CSV", kLatency);
  expect_the_conversation(recording_of(rows([](std::uint8_t byte) { return fmt::format("0b{:08b}", byte); })), "CSV",
                          kLatency);
  expect_the_conversation(recording_of(rows(in_ascii)), "CSV", kLatency);
  expect_the_conversation(recording_of(rows_of("Time [s],Analyzer Name,Decoded Protocol Result\n",
                                               [&](Time at, std::uint8_t byte) {
                                                 return fmt::format("{:.9f},Async Serial,{} (0x{:02X})",
                                                                    static_cast<double>(at) / kSecond, in_ascii(byte), byte);
                                               })),
                          "CSV", kLatency);
}

TEST(Forms, ADamagedCharacterOfLogicHasItsErrorBesideItOrInAColumn) {
  const LineRecording one = recording_of(
      "Time [s],Analyzer Name,Decoded Protocol Result\n0.001,Async Serial,0x01\n0.002,Async Serial,0x03 (framing error)\n");
  ASSERT_EQ(one.frames.size(), 1U);
  EXPECT_EQ(one.frames[0].damaged, std::vector<std::size_t>{1});
  const LineRecording two = recording_of(
      "name,type,start_time,duration,\"data\",\"error\"\n\"Async Serial\",\"data\",0.001,0.001,0x01,\n"
      "\"Async Serial\",\"data\",0.0021,0.001,0x03,\"parity\"\n");
  ASSERT_EQ(two.frames.size(), 1U);
  EXPECT_EQ(two.frames[0].damaged, std::vector<std::size_t>{1});
}

TEST(Forms, SaleaeLogic2MayWriteDates) {
  for (const char* const zone : {"Z", "+02:00", ""}) {
    const LineRecording dates = recording_of(
        fmt::format("name,type,start_time,duration,\"data\"\n\"TX\",\"data\",2026-11-27T10:00:00.001000000{0},0.001,0x01\n"
                    "\"RX\",\"data\",2026-11-27T10:00:00.026000000{0},0.001,0x03\n",
                    zone));
    ASSERT_EQ(dates.frames.size(), 2U) << zone;
    EXPECT_EQ(dates.frames[0].direction, Direction::Request);
    EXPECT_EQ(dates.frames[1].at, 25 * ms);
  }
}

TEST(Forms, SaleaeLogic2WritesCharactersAsTheyAre) {
  const LineRecording text = recording_of(
      "name,type,start_time,duration,\"data\"\n\"Async Serial\",\"data\",0.001,0.001,\"O\"\n"
      "\"Async Serial\",\"data\",0.002,0.001,\" \"\n\"Async Serial\",\"data\",0.003,0.001,\",\"\n"
      "\"Async Serial\",\"data\",0.004,0.001,\"\r\"\n\"Async Serial\",\"data\",0.005,0.001,\"\n\"\n"
      "\"Async Serial\",\"data\",0.006,0.001,\"\"\"\"\n");
  ASSERT_EQ(text.frames.size(), 1U);
  EXPECT_EQ(text.frames[0].bytes, (Bytes{'O', ' ', ',', '\r', '\n', '"'}));
}

TEST(Forms, AnnotationsOfSigrokAreDividedBySilencesInSamples) {
  const auto rows = [](const char* cell) {
    return rows_of("", [cell](Time at, std::uint8_t byte) {
      const Time begin = at / kMicrosecond;
      return fmt::format("{}-{} uart-1: {}", begin, begin + 834, fmt::format(fmt::runtime(cell), byte));
    });
  };
  const LineRecording hex = recording_of(rows("{:02X}"));
  expect_the_conversation(hex, "sigrok", {});
  EXPECT_EQ(hex.notes, std::vector<std::string>{"it counts samples: --samplerate, as 1MHz, makes times of them"});
  EXPECT_EQ(hex.frames.size(), 2U);
  expect_the_conversation(recording_of(rows("{:08b}")), "sigrok", {});
  expect_the_conversation(recording_of(rows("{:03o}")), "sigrok", {});
  expect_the_conversation(recording_of(rows("\"{:02X}\"")), "sigrok", {});
  expect_the_conversation(recording_of(rows("{:02X}"), {.samplerate = 1'000'000}), "sigrok",
                          kLatency / kMicrosecond * kMicrosecond);
}

TEST(Forms, AnnotationsWithoutSamplesAreOneRowOfCharacters) {
  const LineRecording all =
      recording_of(rows_of("", [](Time, std::uint8_t byte) { return fmt::format("uart-1: {:02X}", byte); }));
  EXPECT_EQ(all.frames.size(), 1U);
  expect_the_conversation(all, "sigrok", {});
}

TEST(Forms, BitsBesideTheAnnotatedCharactersAreNoCharacters) {
  const LineRecording all = recording_of(rows_of("", [](Time at, std::uint8_t byte) {
    std::string rows = fmt::format("{}-0 uart-1: Start bit\n", at / kMicrosecond);
    for (int bit = 0; bit < 8; ++bit) rows += fmt::format("{}-0 uart-1: {}\n", at / kMicrosecond, byte >> bit & 1);
    rows += fmt::format("{0}-0 uart-1: {1:02X}\n{0}-0 uart-1: {2}\n{0}-0 uart-1: Stop bit", at / kMicrosecond, byte,
                        byte == 0xE4 ? "Parity error" : "Parity bit");
    return rows;
  }));
  ASSERT_EQ(all.frames.size(), 2U);
  EXPECT_EQ(all.frames[0].bytes, kRequest);
  EXPECT_EQ(all.frames[0].damaged, std::vector<std::size_t>{6});
  EXPECT_EQ(all.frames[1].bytes, kAnswer);
}

// --- logs of controllers and programs ---

TEST(Forms, EsphomeLogsBytesInAnyOfItsNotations) {
  const auto log = [](std::string_view request, std::string_view answer) {
    return fmt::format(
        "[10:00:00][C][uart.arduino_esp8266:102]: UART Bus:\n"
        "\x1b[0;36m[10:00:00.000][D][uart_debug:114]: >>> {}\x1b[0m\n"
        "[10:00:00.025][D][uart_debug:176]: <<< {}\n",
        request, answer);
  };
  for (const std::string& text :
       {log("01:03:00:0A:00:02:E4:09", "01:03:04:12:34:56:78:81:07"),
        log("01,03,00,0A,00,02,E4,09", "01 03 04 12 34 56 78 81 07"), log("1,3,0,10,0,2,228,9", "1,3,4,18,52,86,120,129,7"),
        log(R"("\x01\x03\x00\n\x00\x02\xE4\t")", R"("\x01\x03\x04\x124Vx\x81\a")"),
        log("0b00000001 (0x01) 0b00000011 (0x03) 0b00000000 (0x00) 0b00001010 (0x0A) 0b00000000 (0x00) 0b00000010 (0x02) "
            "0b11100100 (0xE4) 0b00001001 (0x09)",
            "0b00000001 (0x01) 0b00000011 (0x03) 0b00000100 (0x04) 0b00010010 (0x12) 0b00110100 (0x34) 0b01010110 (0x56) "
            "0b01111000 (0x78) 0b10000001 (0x81) 0b00000111 (0x07)")}) {
    const LineRecording recording = recording_of(text);
    expect_the_conversation(recording, "ESPHome", 25 * ms);
    EXPECT_EQ(recording.notes, std::vector<std::string>{"line 1: left out: no bytes in it"});
  }
  EXPECT_EQ(refusal_of("[D][uart_debug:114]: >>> 01:03:zz\n"), "line 1: 'zz' is not bytes in hex");
}

TEST(Forms, EsphomesModbusLogsWhatItWritesAndEachByteThatItReceives) {
  std::string log = "[10:00:00.000][V][modbus:199]: Modbus write: 01.03.00.0A.00.02.E4.09 (8)\n";
  int at = 25;
  for (const std::uint8_t byte : kAnswer)
    log += fmt::format("[10:00:00.{:03}][VV][modbus:042]: Modbus received Byte  {} (0X{:X})\n", at++, byte, byte);
  expect_the_conversation(recording_of(log), "ESPHome modbus", 25 * ms);
  EXPECT_EQ(recording_of(log + "[10:00:00.300][VV][modbus:042]: Modbus received Byte  1\n").notes,
            std::vector<std::string>{"line 11: left out: '1' is not understood"});
}

TEST(Forms, EmodbusLogsALengthAndADump) {
  const auto log = [](std::string_view answer) {
    return fmt::format(
        "[D] 1000| ModbusClientRTU.cpp [ 300] handleConnection: Sent packet: @3FFCED70/8:\n"
        "  | 0000: 01 03 00 0A 00 02 E4 09                          |........        |\n"
        "[D] 1025| ModbusClientRTU.cpp [ 320] handleConnection: Data response: @3FFB1234/9:\n{}",
        answer);
  };
  expect_the_conversation(
      recording_of(log("  | 0000: 01 03 04 12 34 56 78 81  07                      |....4Vx..       |\n")), "eModbus",
      25 * ms);
  EXPECT_EQ(recording_of(log("  | 0000: 01 03 04                                         |...             |\n")).notes,
            std::vector<std::string>{"line 3: left out: it says 9 bytes, and 3 are below it"});
}

LineRecording without_last_row(LineRecording recording) {
  recording.frames.pop_back();
  return recording;
}

TEST(Forms, TasmotaSendsAndReceivesInHex) {
  const LineRecording log = recording_of(
      "10:00:00.000 CMD: SerialSend5 0103000A0002E409\n10:00:00.001 MQT: stat/x/RESULT = {\"SerialSend\":\"Done\"}\n"
      "10:00:00.025 MQT: tele/x/RESULT = {\"SerialReceived\":\"010304123456788107\"}\n10:00:01 CMD: SerialSend hello\n");
  ASSERT_EQ(log.frames.size(), 3U);
  EXPECT_TRUE(log.frames[2].doubt);
  expect_the_conversation(without_last_row(log), "Tasmota", 25 * ms);
  EXPECT_EQ(log.notes, (std::vector<std::string>{"line 4: left out: 'SerialSend hello' is not understood",
                                                 "line 2: left out: no bytes in it"}));
}

TEST(Forms, AnObjectOfJsonInEachLineHasItsFieldsByName) {
  expect_the_conversation(
      recording_of("{\"time\":\"2026-11-27T10:00:00.000Z\",\"dir\":\"tx\",\"data\":\"01 03 00 0a 00 02 e4 09\"}\n"
                   "{\"time\":\"2026-11-27T10:00:00.025Z\",\"dir\":\"rx\",\"data\":\"010304123456788107\"}\n"),
      "JSON", 25 * ms);
  expect_the_conversation(recording_of("{\"ts\":1700000000000,\"event\":\"sent\",\"payload\":[1,3,0,10,0,2,228,9]}\n"
                                       "{\"ts\":1700000000025,\"event\":\"received\",\"payload\":{\"type\":\"Buffer\","
                                       "\"data\":[1,3,4,18,52,86,120,129,7]}}\n"),
                          "JSON", 25 * ms);
  const LineRecording both = recording_of(
      "INFO {\"time\":1700000000.5,\"request\":\"0103000a0002e409\",\"response\":\"010304123456788107\",\"len\":9}\n");
  EXPECT_EQ(both.frames.at(1).at, std::nullopt) << "the time is that of the first";
  const LineRecording doubtful = recording_of(
      "{\"dir\":\"tx\",\"data\":\"0103000a0002e409\"}\n{\"dir\":\"rx\",\"data\":\"AQMCEjQ=\"}\n{\"dir\":\n{\"level\":"
      "\"info\"}\n");
  ASSERT_EQ(doubtful.frames.size(), 3U);
  EXPECT_TRUE(doubtful.frames[1].doubt && doubtful.frames[2].doubt);
  EXPECT_EQ(doubtful.notes, (std::vector<std::string>{"line 2: left out: 'data: AQMCEjQ=' is not understood",
                                                      "line 3: left out: '{\"dir\":' is not understood",
                                                      "line 4: left out: no bytes in it"}));
}

TEST(Forms, BytesInBase64AreReadWhereTheirNameOrTheirTextSaysSo) {
  const std::string asked = "AQMACgAC5Ak=", said = "AQMEEjRWeIEH";
  for (const std::string form : {"{{\"time\":{},\"dir\":\"{}\",\"data\":\"{}\"}}\n",
                                 "{{\"timestamp\":{},\"type\":\"{}\",\"payloadBase64\":\"{}\"}}\n",
                                 "{{\"t\":{},\"dir\":\"{}\",\"encoding\":\"base64\",\"frame\":\"{}\"}}\n"}) {
    const auto recording = recording_of(fmt::format(fmt::runtime(form), "1.000", "tx", asked) +
                                        fmt::format(fmt::runtime(form), "1.025", "rx", said));
    expect_the_conversation(recording, "JSON", 25 * ms);
  }
  expect_the_conversation(recording_of("time=1.000 dir=tx data=" + asked + "\ntime=1.025 dir=rx data=\"" + said + "\"\n"),
                          "key=value", 25 * ms);
  expect_the_conversation(recording_of("time=1.000 dir=tx b64=AQMACgAC5Ak\ntime=1.025 dir=rx b64=" + said + "\n"),
                          "key=value", 25 * ms);
}

TEST(Forms, AColumnMayBeInBase64) {
  expect_the_conversation(
      recording_of("time,dir,payload_base64\n10:00:00.000,tx,AQMACgAC5Ak=\n10:00:00.025,rx,AQMEEjRWeIEH\n"), "CSV", 25 * ms);
}

TEST(Forms, ALineOfALogMayStandInAField) {
  for (const std::string name : {"log", "msg", "message"}) {
    const auto row = [&](const std::string& text, const std::string& at) {
      return "{\"" + name + "\":\"" + text + "\\n\",\"stream\":\"stdout\",\"time\":\"2026-11-28T09:15:02." + at + "Z\"}\n";
    };
    expect_the_conversation(recording_of(row("starting", "000") + row("TX: 01 03 00 0a 00 02 e4 09", "100") +
                                         row("RX: 01 03 04 12 34 56 78 81 07", "125")),
                            "JSON", 25 * ms);
  }
}

TEST(Forms, WhatIsNoBase64IsNotReadAsSuch) {
  for (const std::string value : {"/dev/tty", "SensorA1", "readings", "AQM="})
    EXPECT_FALSE(refusal_of("{\"time\":1.0,\"dir\":\"tx\",\"data\":\"" + value + "\"}\n").empty()) << value;
}

TEST(Forms, JsonThatIsNotReadHasItsReason) {
  EXPECT_EQ(refusal_of("{\"time\":1e400,\"dir\":\"tx\",\"data\":\"0b03\"}\n"),
            "no frames found; line 1: left out: its number 1e400 is too large");
  EXPECT_EQ(refusal_of("{\"time\":1,\"data\":\"0b03\",\"x\":" + std::string(100, '[') + std::string(100, ']') + "}\n"),
            "no frames found; line 1: left out: it is JSON of more than 16 maps and lists inside each other");
  EXPECT_EQ(refusal_of("[{\"time\":1,\"value\":1234},\n{\"time\":2,\"value\":5678}]\n"),
            "no frames found; line 1: left out, and 1 more: no bytes in it");
  EXPECT_EQ(refusal_of("{\"time\":1,\"data\":\"0b03\"\n"),
            "no frames found; line 1: left out: '{\"time\":1,\"data\":\"0b03\"' is not understood");
}

TEST(Forms, DeepJsonIsNotUnderstood) {
  std::string deep = "{\"data\":\"0103\"}\n{\"a\":";
  for (int i = 0; i < 100'000; ++i) deep += "{\"a\":";
  EXPECT_TRUE(recording_of(deep).frames.at(1).doubt);
}

TEST(Forms, PairsOfKeysAndValuesHaveTheirFieldsByName) {
  expect_the_conversation(
      recording_of("time=2026-11-27T10:00:00.000Z level=debug msg=\"sent\" len=8 data=0103000a0002e409\n"
                   "time=2026-11-27T10:00:00.025Z level=debug msg=\"received\" len=9 data=\"01 03 04 12 34 56 78 81 07\"\n"),
      "key=value", 25 * ms);
  expect_the_conversation(recording_of("2026-11-27 10:00:00.000 dev=pump tx=01:03:00:0a:00:02:e4:09 n=8\n"
                                       "2026-11-27 10:00:00.025 dev=pump rx=010304123456788107 n=9\n"),
                          "key=value", 25 * ms);
}

TEST(Forms, BytesAsPythonShowsThemAreAFrame) {
  expect_the_conversation(
      recording_of(
          "2026-11-27 10:00:00.000 DEBUG (MainThread) [custom.hub] Sending: b'\\x01\\x03\\x00\\n\\x00\\x02\\xe4\\t'\n"
          "2026-11-27 10:00:00.025 DEBUG (MainThread) [custom.hub] Received: b\"\\x01\\x03\\x04\\x124Vx\\x81\\x07\"\n"),
      "Python", 25 * ms);
  const LineRecording two = recording_of("0.1 TX b'\\x01\\x03'\n0.2 b'a' and b'b'\n0.3 nothing\n");
  EXPECT_EQ(two.notes, (std::vector<std::string>{"line 2: left out: 'b'a' and b'b'' is not understood",
                                                 "line 3: left out: no bytes in it"}));
}

TEST(Forms, StraceShowsWhatAProgramReadsAndWrites) {
  expect_the_conversation(recording_of("[pid  77] 10:00:00.000000 write(3, \"\\1\\3\\0\\n\\0\\2\\344\\t\", 8) = 8\n"
                                       "[pid  77] 10:00:00.025000 read(3, \"\\1\\3\\4\\0224Vx\\201\\7\", 260) = 9\n"),
                          "strace", 25 * ms);
  expect_the_conversation(
      recording_of("77 1700000000.000000 write(5</dev/ttyS0>, \"\\x01\\x03\\x00\\x0a\\x00\\x02\\xe4\\x09\", 8) = 8\n"
                   "77 1700000000.010000 read(5</dev/ttyS0>,  <unfinished ...>\n"
                   "78 1700000000.011000 write(1</dev/pts/3>, \"hello\", 5) = 5\n"
                   "77 1700000000.025000 <... read resumed>\"\\x01\\x03\\x04\\x12\\x34\\x56\\x78\\x81\\x07\", 256) = 9\n"),
      "strace", 25 * ms);
}

TEST(Forms, OfATraceOnlyTheLineIsRead) {
  const LineRecording trace = recording_of(
      "openat(AT_FDCWD, \"/etc/hosts\", O_RDONLY) = 3\nread(3, \"\\177ELF\", 832) = 4\nclose(3) = 0\n"
      "openat(AT_FDCWD, \"/dev/ttyUSB0\", O_RDWR|O_NOCTTY) = 3\nwrite(3, \"\\1\\3\\0\\n\\0\\2\\344\\t\", 8) = 8\n"
      "read(3, 0x7ffc0000, 256) = -1 EAGAIN (Resource temporarily unavailable)\n"
      "read(3, \"\\1\\3\\4\\0224Vx\\201\\7\", 260) = 9\nwrite(1, \"[1]: 4660\\n\", 10) = 10\n");
  expect_the_conversation(trace, "strace", {});
  EXPECT_EQ(refusal_of("write(3, \"\\1\", 1) = 1\nread(5, \"\\1\", 1) = 1\n"),
            "it has calls of the descriptors 3, 5; which of them is the line is not in it: trace with strace -y");
}

TEST(Forms, WhatStraceCutOffIsNamed) {
  EXPECT_EQ(
      recording_of("write(3, \"\\1\\3\", 2) = 2\nread(3, \"\\1\\3\\4\"..., 260) = 9\n").notes,
      std::vector<std::string>{"line 2: left out: strace printed the beginning of its bytes only; trace with -s 1000"});
}

TEST(Forms, WhatIsLeftOutOfATraceIsSafeToPrint) {
  EXPECT_EQ(recording_of("write(3, \"\\1\\\xC5v\", 2) = 2\nread(3, \"\\1\\3\", 260) = 2\n").notes.at(0),
            "line 1: left out: '3, \"\\1\\\uFFFDv\", 2) = 2' is not understood");
}

TEST(Forms, TimesOfStraceMayBeSinceTheLineBefore) {
  const LineRecording relative = recording_of(
      "     0.000000 write(3, \"\\1\\3\\0\\n\\0\\2\\344\\t\", 8) = 8\n     0.020000 ioctl(3, FIONREAD, [9]) = 0\n"
      "     0.005000 read(3, \"\\1\\3\\4\\0224Vx\\201\\7\", 260) = 9\n");
  expect_the_conversation(relative, "strace", 25 * ms);
}

/// A packet of Modbus TCP as tcpdump -X prints it.
std::string printed_packet(std::string_view time, bool to_server, const Bytes& message) {
  Bytes packet{0x45, 0, 0, static_cast<std::uint8_t>(40 + message.size()), 0, 1, 0x40, 0, 64, 6, 0, 0, 127, 0, 0, 1, 127,
               0,    0, 1};
  const Bytes server{0x01, 0xF6}, client{0x9C, 0x40};
  for (const Bytes& part : {to_server ? client : server, to_server ? server : client,
                            Bytes{0, 0, 0, 1, 0, 0, 0, 1, 0x50, 0x18, 2, 0, 0, 0, 0, 0}, message})
    packet.insert(packet.end(), part.begin(), part.end());
  std::string text =
      fmt::format("{} IP 127.0.0.1.40000 > 127.0.0.1.502: Flags [P.], seq 1:13, length {}\n", time, message.size());
  for (std::size_t i = 0; i < packet.size(); ++i) {
    if (i % 16 == 0) text += fmt::format("{}\t0x{:04x}:  ", i == 0 ? "" : "  ....\n", i);
    text += fmt::format("{:02x}{}", packet[i], i % 2 == 1 ? " " : "");
  }
  return text + "  ...\n";
}

TEST(Forms, TcpdumpPrintsPacketsInHex) {
  const std::string request = printed_packet("17:03:45.000000", true, {0, 70, 0, 0, 0, 6, 1, 3, 0, 10, 0, 2}),
                    answer = printed_packet("17:03:45.025000", false, {0, 70, 0, 0, 0, 7, 1, 3, 4, 0x12, 0x34, 0x56, 0x78});
  expect_the_conversation(recording_of(request + answer), "tcpdump", 25 * ms);
  EXPECT_EQ(refusal_of(request + answer.substr(0, answer.rfind('\t'))),
            "line 6: 48 bytes of the packet's 53 are below it; record with tcpdump -w FILE.pcap");
  const std::string first_row = request.substr(0, request.find("\t0x0010"));
  EXPECT_EQ(refusal_of(first_row + request.substr(request.find("\t0x0020"))),
            "line 3: rows before it are missing; record with tcpdump -w FILE.pcap");
}

/// The same packet with the head of Ethernet, in rows as tshark -x prints them.
std::string rows_of_tshark(const std::string& tcpdump) {
  Bytes packet(12, 0x11);
  packet.insert(packet.end(), {0x08, 0x00});
  for (std::size_t at = tcpdump.find("\t0x"); at != std::string::npos; at = tcpdump.find("\t0x", at + 1)) {
    std::string hex = tcpdump.substr(at + 9, std::min(tcpdump.find("  ", at + 10), tcpdump.size()) - at - 9);
    std::erase(hex, ' ');
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
      packet.push_back(static_cast<std::uint8_t>(std::stoul(hex.substr(i, 2), nullptr, 16)));
  }
  std::string text;
  for (std::size_t i = 0; i < packet.size(); ++i) {
    if (i % 16 == 0) text += fmt::format("{}{:04x} ", i == 0 ? "" : "   ................\n", i);
    text += fmt::format(" {:02x}", packet[i]);
  }
  return text + "   ....\n\n";
}

TEST(Forms, TsharkPrintsPacketsInHex) {
  const std::string request = rows_of_tshark(printed_packet("0", true, {0, 70, 0, 0, 0, 6, 1, 3, 0, 10, 0, 2})),
                    answer =
                        rows_of_tshark(printed_packet("0", false, {0, 70, 0, 0, 0, 7, 1, 3, 4, 0x12, 0x34, 0x56, 0x78}));
  const std::string
      first = "    1   0.000000    127.0.0.1 \u2192 127.0.0.1    Modbus/TCP 78    Query: Trans:    70; Unit:   1\n",
      second = "    2   0.025000    127.0.0.1 \u2192 127.0.0.1    Modbus/TCP 79 Response: Trans:    70; Unit:   1\n";
  expect_the_conversation(recording_of(first + "\n" + request + second + "\n" + answer), "tshark", 25 * ms);
  const LineRecording untimed = recording_of(request + answer);
  EXPECT_EQ(untimed.form, "tshark");
  EXPECT_EQ(untimed.notes, std::vector<std::string>{"tshark -x alone prints no times; tshark -P -x does"});
  ASSERT_EQ(untimed.frames.size(), 2U);
  EXPECT_FALSE(untimed.frames[1].at);
  EXPECT_EQ(refusal_of(first + second),
            "it is the list of packets without their bytes; print them with tshark -x, or record with tshark -w FILE.pcap");
  EXPECT_EQ(refusal_of(request.substr(0, request.find("0030  ")) + request.substr(request.find("0040  "))),
            "line 4: rows before it are missing; record with tshark -w FILE.pcap");
}

TEST(Forms, PacketsAsJsonHaveWhatTcpCarries) {
  const auto packet = [](const std::string& at, int from, int to, const std::string& payload) {
    return fmt::format(
        R"({{
    "_index": "packets-2026-11-28", "_score": null,
    "_source": {{
      "layers": {{
        "frame": {{"frame.time_relative": "{}", "frame.number": "1", "frame.protocols": "eth:ethertype:ip:tcp:mbtcp"}},
        "ip": {{"ip.src": "192.168.0.5"}},
        "tcp": {{"tcp.srcport": "{}", "tcp.dstport": "{}", "tcp.len": "12", "tcp.payload": "{}"}},
        "modbus": {{"modbus.func_code": "3", "modbus.data": "00:01"}}
      }}
    }}
  }})",
        at, from, to, payload);
  };
  const auto recording = recording_of("[\n  " + packet("0.000000000", 50312, 502, "00:01:00:00:00:06:01:03:00:0a:00:02") +
                                      ",\n  " + packet("0.010000000", 502, 50312, "") + ",\n  " +
                                      packet("0.025000000", 502, 50312, "00:01:00:00:00:07:01:03:04:12:34:56:78") + "\n]\n");
  expect_the_conversation(recording, "JSON", 25 * ms);
  EXPECT_TRUE(recording.over_tcp);
}

TEST(Forms, AFollowedStreamIsReadAsWiresharkSavesIt) {
  const std::string dump =
      "00000000  00 01 00 00 00 06 01 03  00 0a 00 02               ........ ....\n"
      "    00000000  00 01 00 00 00 07 01 03  04 12 34 56 78            ........ ..4Vx\n";
  expect_the_conversation(recording_of(dump), "followed", {});
  const LineRecording longer =
      recording_of(dump +
                   "0000000C  00 02 00 00 00 06 01 03  00 0a 00 08               ........ ....\n"
                   "    0000000D  00 02 00 00 00 13 01 03  10 00 01 00 02 00 03 00   ........ ........\n"
                   "    0000001D  04 00 05 00 06 00 07 00  08                        ........ .\n");
  ASSERT_EQ(longer.frames.size(), 4U);
  EXPECT_EQ(longer.frames[3].bytes.size(), 21U) << "with the CRC in place of the head";
  EXPECT_EQ(longer.frames[3].place, "line 4");
  expect_the_conversation(
      recording_of("char peer0_0[] = { /* Packet 4 */\n0x00, 0x01, 0x00, 0x00, 0x00, 0x06, 0x01, 0x03, \n"
                   "0x00, 0x0a, 0x00, 0x02 };\n"
                   "char peer1_0[] = { /* Packet 6 */\n0x00, 0x01, 0x00, 0x00, 0x00, 0x07, 0x01, 0x03, \n"
                   "0x04, 0x12, 0x34, 0x56, 0x78 };\n"),
      "followed", {});
  const std::string head =
      "peers:\n  - peer: 0\n    host: 192.168.0.5\n    port: 50312\n  - peer: 1\n    host: 192.168.0.9\n    port: 502\n"
      "packets:\n";
  expect_the_conversation(
      recording_of(head +
                   "  - packet: 4\n    peer: 0\n    index: 0\n    timestamp: 1616595070.000000000\n    data: !!binary |\n"
                   "      AAEAAAAGAQMACgAC\n"
                   "  - packet: 6\n    peer: 1\n    index: 0\n    timestamp: 1616595070.025000000\n    data: !!binary |\n"
                   "      AAEAAAAHAQMEEjRWeA==\n"),
      "followed", 25 * ms);
  EXPECT_EQ(refusal_of(head + "  - packet: 4\n    peer: 0\n    data: !!binary |\n  - packet: 5\n    peer: 1\n"),
            "no frames found; line 9: left out: no bytes in it; line 12: left out: no bytes in it");
  EXPECT_EQ(refusal_of(head + "  - packet: 4\n    peer: 0\n    data: !!binary |\n      A*E\n"),
            "line 9: its bytes are not base64");
}

TEST(Forms, ADumpOfASerialLineIsNoPacketOfTshark) {
  const LineRecording dump = recording_of("0000  01 03 00 00 00 01 84 0a   ........\n");
  EXPECT_NE(dump.form, "tshark");
}

TEST(Forms, PyserialPrintsWhatItSpies) {
  expect_the_conversation(
      recording_of("000000.000 Q-RX reset_input_buffer\n"
                   "000000.000 TX   0000  01 03 00 0A 00 02 E4 09                           ........\n"
                   "000000.025 RX   0000  01 03 04 12 34 56 78 81 07                        ....4Vx..\n"),
      "pyserial", 25 * ms);
  const LineRecording two_rows = recording_of(
      "000000.000 TX   0000  00 01 02 03 04 05 06 07  08 09 0A 0B 0C 0D 0E 0F  ................\n"
      "000000.000 TX   0010  10 11                                             ..\n");
  ASSERT_EQ(two_rows.frames.size(), 1U);
  EXPECT_EQ(two_rows.frames[0].bytes.size(), 18U);
}

TEST(Forms, BytesOfALogMayBeMarkedOrBinary) {
  const Bytes request{1, 3, 0, 10, 0, 2, 0xE4, 9}, answer{1, 3, 4, 0x12, 0x34, 0x56, 0x78, 0x81, 7};
  for (const char* format : {"{:02X}h ", "{:02x}H ", "${:02X} ", "&H{:02X} ", "16#{:02X}, ", "{:08b} ", "2#{:08b} ",
                             "0b{:08b}, ", "{:02X} \u2013 ", "{:02X}\u00A0"}) {
    std::string text;
    for (const auto& [word, bytes] : {std::pair("TX: ", &request), std::pair("RX: ", &answer)}) {
      text += word;
      for (const std::uint8_t byte : *bytes) text += fmt::format(fmt::runtime(format), byte);
      text = text.substr(0, text.find_last_of("0123456789ABCDEFabcdefhH") + 1) + "\n";
    }
    const LineRecording log = recording_of(text);
    ASSERT_EQ(log.frames.size(), 2U) << text;
    EXPECT_EQ(log.frames[0].bytes, request) << text;
    EXPECT_EQ(log.frames[1].bytes, answer) << text;
    EXPECT_EQ(log.frames[1].direction, Direction::Answer) << text;
  }
}

// --- captures that carry a serial line ---

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Bytes little(std::uint64_t value, int bytes) {
  Bytes all;
  for (int i = 0; i < bytes; ++i) all.push_back(static_cast<std::uint8_t>(value >> 8 * i));
  return all;
}

/// A pcap in microseconds with a packet every 25 ms.
std::string capture_of(std::uint32_t link_type, std::initializer_list<Bytes> packets) {
  Bytes file =
      joined({little(0xA1B2C3D4, 4), little(2, 2), little(4, 2), Bytes(8), little(0xFFFF, 4), little(link_type, 4)});
  std::uint64_t at = 0;
  for (const Bytes& packet : packets) {
    file = joined({file, little(1000, 4), little(at, 4), little(packet.size(), 4), little(packet.size(), 4), packet});
    at += 25'000;
  }
  return {file.begin(), file.end()};
}

enum class Usb : std::uint8_t { Linux, LinuxMmapped, UsbPcap };
constexpr std::uint32_t link_type_of(Usb form) { return form == Usb::Linux ? 189 : form == Usb::LinuxMmapped ? 220 : 249; }

/// A packet of a transfer: bulk, or control if there is a setup.
Bytes usb_packet(Usb form, bool in, bool completed, const Bytes& data, std::uint8_t device = 5, const Bytes& setup = {}) {
  const auto type = static_cast<std::uint8_t>(setup.empty() ? 3 : 2), endpoint = static_cast<std::uint8_t>(in ? 0x81 : 0x02);
  if (form == Usb::UsbPcap) {
    const Bytes stage = setup.empty() ? Bytes{} : Bytes{static_cast<std::uint8_t>(completed ? 1 : 0)};
    const Bytes whole = completed ? data : joined({setup, data});
    return joined({little(27 + stage.size(), 2), Bytes(14), Bytes{static_cast<std::uint8_t>(completed)}, little(1, 2),
                   little(device, 2), Bytes{endpoint, type}, little(whole.size(), 4), stage, whole});
  }
  const Bytes head =
      joined({Bytes(8), Bytes{static_cast<std::uint8_t>(completed ? 'C' : 'S'), type, endpoint, device}, little(1, 2),
              Bytes{static_cast<std::uint8_t>(setup.empty() || completed ? '-' : 0),
                    static_cast<std::uint8_t>(data.empty() ? '<' : 0)},
              Bytes(16), little(data.size(), 4), little(data.size(), 4), setup.empty() ? Bytes(8) : setup});
  return joined({head, Bytes(form == Usb::LinuxMmapped ? 16 : 0), data});
}

const Bytes kFtdiStatus{0x01, 0x60};

TEST(OtherNotations, ATableMayHaveAColumnForEachDirectionWithNumbersInItsName) {
  std::string table = "\"Timestamp\";\"CH0(TX)\";\"CH1(RX)\";\"Information\"\n";
  table += rows_of("", [count = std::size_t{0}](Time at, std::uint8_t byte) mutable {
    const bool sent = count++ < kRequest.size();
    std::string time = fmt::format("{:.4f}", static_cast<double>(at) / ms);
    std::ranges::replace(time, '.', ',');
    return fmt::format("\"{} ms\";\"{}\";\"{}\";\"\"", time, sent ? fmt::format("{:02X}", byte) : "",
                       sent ? "" : fmt::format("{:02X}", byte));
  });
  const auto recording = recording_of(table);
  EXPECT_EQ(recording.form, "CSV");
  ASSERT_EQ(recording.frames.size(), 2U);
  EXPECT_EQ(recording.frames[0].bytes, kRequest);
  EXPECT_EQ(recording.frames[1].bytes, kAnswer);
  EXPECT_EQ(recording.frames[1].direction, Direction::Answer);
}

TEST(SerialLinks, ThePacketsOfTheLinkTypesForUsersAreFrames) {
  for (const std::uint32_t link_type : {147U, 150U, 162U})
    expect_the_conversation(recording_of(capture_of(link_type, {kRequest, kAnswer})), "pcap", 25 * ms);
}

TEST(SerialLinks, AnRtacSaysWhatItSentAndReceived) {
  const auto packet = [](std::uint8_t event, const Bytes& data) { return joined({Bytes(8), Bytes{event, 0, 0, 0}, data}); };
  const LineRecording recording =
      recording_of(capture_of(250, {packet(1, kRequest), packet(2, kAnswer), packet(8, {}), packet(5, {}), packet(0, {})}));
  expect_the_conversation(recording, "pcap", 25 * ms);
  EXPECT_EQ(recording.frames[0].direction, Direction::Request);
  EXPECT_EQ(recording.frames[1].direction, Direction::Answer);
  EXPECT_TRUE(recording.frames[1].more_was_lost);
  EXPECT_EQ(recording.notes, (std::vector<std::string>{"packet 3: a parity error; it does not say of which character",
                                                       "packet 4: characters were lost"}));
}

TEST(SerialLinks, AnFtdiAdapterIsKnownByItsDescriptorItsDriverOrItsStatus) {
  const Bytes descriptor{18, 1, 0, 2, 0, 0, 0, 8, 0x03, 0x04, 0x01, 0x60, 0, 6, 1, 2, 3, 1};
  const Bytes get_descriptor{0x80, 6, 0, 1, 0, 0, 18, 0}, set_rate{0x40, 3, 0x38, 0x41, 0, 0, 0, 0};
  for (const Usb form : {Usb::Linux, Usb::LinuxMmapped, Usb::UsbPcap}) {
    const Bytes request = usb_packet(form, false, false, kRequest),
                answer = usb_packet(form, true, true, joined({kFtdiStatus, kAnswer}));
    const std::uint32_t link_type = link_type_of(form);
    const LineRecording by_status = recording_of(capture_of(link_type, {request, answer}));
    expect_the_conversation(by_status, "pcap", 25 * ms);
    EXPECT_EQ(by_status.notes,
              std::vector<std::string>{"USB device 1.5: an FTDI adapter, by the status before all that it sent"});
    EXPECT_TRUE(by_status.is_log) << "adapters deliver late";
    for (const Bytes& first :
         {usb_packet(form, true, true, descriptor, 5, get_descriptor), usb_packet(form, false, false, {}, 5, set_rate)}) {
      const LineRecording known = recording_of(capture_of(link_type, {first, request, answer}));
      expect_the_conversation(known, "pcap", 25 * ms);
      EXPECT_EQ(known.notes, std::vector<std::string>{"USB device 1.5: FTDI"});
    }
  }
}

TEST(SerialLinks, AnFtdiAdapterPutsItsStatusBeforeEachPacketOnTheBus) {
  Bytes data, plain;
  for (int packet = 0; packet < 3; ++packet) {
    data.insert(data.end(), kFtdiStatus.begin(), kFtdiStatus.end());
    for (std::uint8_t i = 0; i < (packet < 2 ? 62 : 9); ++i) data.push_back(i), plain.push_back(i);
  }
  const LineRecording recording = recording_of(
      capture_of(189, {usb_packet(Usb::Linux, true, true, kFtdiStatus), usb_packet(Usb::Linux, true, true, data)}));
  ASSERT_EQ(recording.frames.size(), 1U) << "a packet with the status alone has no characters";
  EXPECT_EQ(recording.frames[0].bytes, plain);
  Bytes damaged{0x01, 0x64, 0x55};
  const LineRecording parity = recording_of(capture_of(189, {usb_packet(Usb::Linux, true, true, damaged)}));
  EXPECT_EQ(parity.frames[0].damaged, std::vector<std::size_t>{0}) << "the line status has the parity error";
}

TEST(SerialLinks, OtherAdaptersMoveTheirDataAsItIs) {
  struct Case {
    const char* kind;
    Bytes setup;
  };
  for (const auto& [kind, setup] :
       {Case{"CP210x", {0x41, 0x1E, 0, 0, 0, 0, 4, 0}}, Case{"CH340", {0x40, 0x9A, 0x12, 0x13, 0x83, 0xD9, 0, 0}},
        Case{"CDC-ACM", {0x21, 0x20, 0, 0, 0, 0, 7, 0}}})
    for (const Usb form : {Usb::LinuxMmapped, Usb::UsbPcap}) {
      const LineRecording recording = recording_of(capture_of(
          link_type_of(form),
          {usb_packet(form, false, false, {}, 5, setup), usb_packet(form, false, false, kRequest),
           usb_packet(form, false, true, {}), usb_packet(form, true, false, {}), usb_packet(form, true, true, kAnswer)}));
      expect_the_conversation(recording, "pcap", 75 * ms);
      EXPECT_EQ(recording.notes, std::vector<std::string>{fmt::format("USB device 1.5: {}", kind)});
    }
  const LineRecording unknown = recording_of(
      capture_of(249, {usb_packet(Usb::UsbPcap, false, false, kRequest), usb_packet(Usb::UsbPcap, true, true, kAnswer)}));
  expect_the_conversation(unknown, "pcap", 25 * ms);
  EXPECT_EQ(unknown.notes,
            std::vector<std::string>{
                "USB device 1.5: the capture does not say which adapter it is; its data are taken as they are"});
}

TEST(SerialLinks, OfSeveralUsbDevicesTheAdapterIsReadOrNobodyGuesses) {
  const Bytes disk_command = joined({Bytes{'U', 'S', 'B', 'C'}, Bytes(27)});
  const Bytes request = usb_packet(Usb::LinuxMmapped, false, false, kRequest),
              answer = usb_packet(Usb::LinuxMmapped, true, true, kAnswer),
              disk = usb_packet(Usb::LinuxMmapped, false, false, disk_command, 9),
              sector = usb_packet(Usb::LinuxMmapped, true, true, Bytes(512), 9);
  expect_the_conversation(recording_of(capture_of(220, {request, answer, disk, sector})), "pcap", 25 * ms);
  EXPECT_EQ(refusal_of(capture_of(220, {request, answer, usb_packet(Usb::LinuxMmapped, false, false, kRequest, 7)})),
            "the USB devices 1.5 and 1.7 have data; keep one: tshark -r FILE -Y 'usb.device_address == 5' -w ONE.pcap");
}

TEST(SerialLinks, APacketThatEndsWithinItsHeadIsCounted) {
  EXPECT_EQ(recording_of(capture_of(250, {joined({Bytes(8), Bytes{1, 0, 0, 0}, kRequest}), Bytes(11)})).notes,
            std::vector<std::string>{"1 of the packets of serial lines end within their heads"});
  for (const std::uint32_t link_type : {189U, 220U, 249U, 250U})
    for (std::size_t length = 0; length < 70; ++length)
      refusal_of(capture_of(link_type, {Bytes(length), Bytes(length, 0xFF)}));
}

// --- levels ---

/// An instant of a channel at which it gets a level.
struct Edge {
  Time at;
  bool level;
};

/// The frames as levels, each bit at its time.
std::vector<Edge> edges_of(std::initializer_list<std::pair<Time, Bytes>> frames, const SerialFormat& format) {
  std::vector<Edge> edges;
  for (const auto& [begin, bytes] : frames)
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      const Time start = begin + static_cast<Time>(i) * format.character_time();
      const unsigned levels = serial::character_levels(format, bytes[i], format.parity_bit(bytes[i]));
      for (int bit = 0; bit <= serial::first_stop_bit(format); ++bit)
        edges.push_back({start + format.bit_times(bit), (levels >> bit & 1U) != 0});
    }
  return edges;
}

struct DumpedChannel {
  std::string name;
  std::vector<Edge> edges;
  bool idle = true;
};

std::string vcd_of(const std::vector<DumpedChannel>& channels, std::string_view scale = "1 ns", Time tick = 1) {
  std::string text = fmt::format("$timescale {} $end\n$scope module top $end\n", scale);
  std::vector<std::tuple<Time, std::size_t, bool>> all;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    text += fmt::format("$var wire 1 {} {} $end\n", static_cast<char>('!' + i), channels[i].name);
    for (const Edge& edge : channels[i].edges) all.emplace_back(edge.at / tick, i, edge.level == channels[i].idle);
  }
  std::ranges::stable_sort(all, {}, [](const auto& each) { return std::get<0>(each); });
  text += "$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n";
  for (std::size_t i = 0; i < channels.size(); ++i)
    text += fmt::format("{}{}\n", channels[i].idle ? '1' : '0', static_cast<char>('!' + i));
  text += "$end\n";
  for (const auto& [at, channel, level] : all)
    text += fmt::format("#{}\n{}{}\n", at, level ? '1' : '0', static_cast<char>('!' + channel));
  return text;
}

constexpr SerialFormat kUsual{};

std::vector<Edge> conversation_edges(const SerialFormat& format) {
  return edges_of({{5 * ms, kRequest}, {100 * ms, kAnswer}}, format);
}

void expect_one_wire(const LineRecording& recording, std::string_view form, const SerialFormat& format) {
  expect_the_conversation(recording, form, 95 * ms);
  EXPECT_EQ(recording.line, format);
  EXPECT_FALSE(recording.is_log) << "the times of the line";
}

TEST(Levels, ALineIsReadAtTheRateAndFormatThatFitItsLevels) {
  for (const std::uint32_t baud : {1200U, 9600U, 19'200U, 57'600U, 115'200U, 187'500U})
    for (const auto& [data_bits, parity] : {std::pair{8, Parity::Even}, {8, Parity::Odd}, {8, Parity::None}}) {
      const SerialFormat format{.baud = baud, .data_bits = static_cast<std::uint8_t>(data_bits), .parity = parity};
      const LineRecording recording = recording_of(vcd_of({{"D0", conversation_edges(format)}}));
      expect_one_wire(recording, "VCD", format);
      EXPECT_EQ(recording.notes,
                std::vector<std::string>{fmt::format("the levels of D0 were read with {}, which fit", format_text(format))});
    }
}

TEST(Levels, SevenBitsWithParityNeedEnoughCharactersToBeKnown) {
  const SerialFormat ascii{.baud = 19'200, .data_bits = 7};
  const std::string text = ":0103000A0002F0\r\n", few = ":01\r\n";
  EXPECT_EQ(recording_of(vcd_of({{"D0", edges_of({{ms, Bytes(text.begin(), text.end())}}, ascii)}})).line, ascii);
  EXPECT_EQ(recording_of(vcd_of({{"D0", edges_of({{ms, Bytes(few.begin(), few.end())}}, ascii)}}),
                         {.line = {.parity = Parity::Even, .data_bits = 7}})
                .line,
            ascii);
}

TEST(Levels, WhatTheUserSaysOfTheLineHolds) {
  const SerialFormat format{.baud = 12'345};
  const std::string vcd = vcd_of({{"D0", conversation_edges(format)}});
  EXPECT_EQ(refusal_of(vcd), "the levels fit no rate that lines have; name it with --baud");
  expect_one_wire(recording_of(vcd, {.line = {.baud = 12'345}}), "VCD", format);
  EXPECT_EQ(refusal_of(vcd_of({{"D0", conversation_edges(kUsual)}}), {.line = {.baud = 7'000, .parity = Parity::Even}}),
            "no channel of it has characters with 7000 baud, 8 data bits, even parity, 1 stop bit");
}

TEST(Levels, ALineThatIdlesAtZeroIsInverted) {
  const LineRecording recording = recording_of(vcd_of({{"A", conversation_edges(kUsual), false}}));
  expect_one_wire(recording, "VCD", kUsual);
  EXPECT_EQ(recording.notes.front(), "channel A idles at 0: it was read inverted");
}

TEST(Levels, AWireThatRepeatsOthersIsLeftOut) {
  const LineRecording pair =
      recording_of(vcd_of({{"A", conversation_edges(kUsual)}, {"B", conversation_edges(kUsual), false}}));
  expect_one_wire(pair, "VCD", kUsual);
  EXPECT_EQ(pair.notes.front(), "channel B was left out: other channels have its characters");
  const LineRecording ours = recording_of(vcd_of({{"rx", edges_of({{5 * ms, kRequest}}, kUsual)},
                                                  {"tx", edges_of({{100 * ms, kAnswer}}, kUsual)},
                                                  {"line", conversation_edges(kUsual)}}));
  EXPECT_EQ(ours.notes.front(), "channel line was left out: other channels have its characters");
  EXPECT_EQ(ours.frames[0].direction, Direction::Answer) << "by the names; settle_directions() knows better";
  EXPECT_TRUE(ours.is_log);
}

TEST(Levels, OfTwoWiresWithoutSuchNamesTheFirstThatSpeaksAsks) {
  const LineRecording two = recording_of(
      vcd_of({{"D0", edges_of({{100 * ms, kAnswer}}, kUsual)}, {"D1", edges_of({{5 * ms, kRequest}}, kUsual)}}));
  expect_the_conversation(two, "VCD", 95 * ms);
}

TEST(Levels, AChannelWithoutCharactersIsNamed) {
  std::vector<Edge> clock;
  for (int i = 0; i < 400; ++i) clock.push_back({i * 331'000, i % 2 != 0});
  const LineRecording recording = recording_of(vcd_of({{"D0", conversation_edges(kUsual)}, {"CLK", clock}, {"quiet", {}}}));
  expect_one_wire(recording, "VCD", kUsual);
  EXPECT_EQ(recording.notes.front(), "channel CLK was left out: it has no characters of that line");
  EXPECT_EQ(refusal_of(vcd_of({{"quiet", {}}})), "no channel of it changes its level");
}

TEST(Levels, ACharacterWithAParityErrorIsDamaged) {
  std::vector<Edge> edges = conversation_edges(kUsual);
  for (Edge& edge : edges)
    if (edge.at == 5 * ms + 2 * kUsual.character_time() + kUsual.bit_times(9)) edge.level = !edge.level;
  const LineRecording recording = recording_of(vcd_of({{"D0", edges}}));
  EXPECT_EQ(recording.frames.at(0).damaged, std::vector<std::size_t>{2});
  EXPECT_EQ(recording.frames.at(0).bytes, kRequest);
}

TEST(Levels, AVcdHasATimescaleVectorsAndUndefinedLevels) {
  expect_the_conversation(recording_of(vcd_of({{"D0", edges_of({{5 * ms, kRequest}, {100 * ms, kAnswer}}, {.baud = 1200})}},
                                              "10us", 10 * kMicrosecond),
                                       {.usual = {.baud = 1200}}),
                          "VCD", 95 * ms);
  std::string vcd = vcd_of({{"D0", conversation_edges(kUsual)}});
  vcd.insert(vcd.find("$upscope"), "$var wire 8 # bus $end\n");
  vcd += "#300000000\nb10101010 #\nx!\n#300000001\nb1 !\n";
  EXPECT_EQ(recording_of(vcd).notes,
            (std::vector<std::string>{
                "channel bus was left out: it has 8 bits",
                "channel D0 has undefined levels at 300 ms: there it keeps the level before",
                "the levels of D0 were read with 9600 baud, 8 data bits, even parity, 1 stop bit, which fit"}));
  EXPECT_EQ(refusal_of("$timescale 3 weeks $end\n$enddefinitions $end\n"), "its $timescale is not one");
  EXPECT_EQ(refusal_of("$timescale 1 ns $end\n$enddefinitions $end\n#5\n#4\n"), "#4 is not a time after the one before it");
  EXPECT_EQ(refusal_of("$timescale 1 s $end\n$enddefinitions $end\n#9000000000000000000\n"),
            "#9000000000000000000 is not a time after the one before it");
}

TEST(Levels, TheBitsOfAVectorAreLinesWhereNoOtherVariableIsOne) {
  const auto asked = edges_of({{5 * ms, kRequest}}, kUsual), said = edges_of({{100 * ms, kAnswer}}, kUsual);
  std::string vcd =
      "$timescale 10 ns $end\r\n$scope module logic $end $var wire 2 ! bus [1:0] $end $upscope $end\r\n"
      "$enddefinitions $end\r\n#0 b11 !\r\n";
  for (const Edge& edge : asked) vcd += fmt::format("#{} b{}{} !\r\n", edge.at / 10, 1, edge.level ? 1 : 0);
  for (const Edge& edge : said) vcd += fmt::format("#{} b{} !\r\n", edge.at / 10, edge.level ? "11" : "1");
  expect_the_conversation(recording_of(vcd), "VCD", 95 * ms);
}

TEST(Levels, AVcdOfASimulatorHasScopesCommentsAndReals) {
  std::string vcd = vcd_of({{"rxd", conversation_edges(kUsual)}}, "1ps", 1);
  vcd.insert(0, "$date\n  today\n$end\n$version 12.0 $end\n$comment\nseveral\nlines\n$end\n");
  vcd.insert(vcd.find("$upscope"),
             "$var real 64 & temp $end\n$scope begin inner $end\n$var reg 8 % data [7:0] $end\n$upscope $end\n");
  const std::string noise = "\nr3.25 &\nb1x %";
  for (std::size_t at = vcd.find("\n#5"); at != std::string::npos; at = vcd.find("\n#5", at + noise.size() + 1))
    vcd.insert(at, noise);
  std::string in_ps;
  for (std::size_t at = 0, end; at < vcd.size(); at = end) {  // vcd_of counts in ns
    end = std::min(vcd.find('\n', at) + 1, vcd.size());
    const std::string line = vcd.substr(at, end - at);
    in_ps += line.front() == '#' && line != "#0\n" ? line.substr(0, line.size() - 1) + "000\n" : line;
  }
  expect_one_wire(recording_of(in_ps), "VCD", kUsual);
}

/// The level of each microsecond.
std::string samples_of(const std::vector<Edge>& edges, Time until) {
  std::string samples;
  bool level = true;
  std::size_t next = 0;
  for (Time at = 0; at < until; at += kMicrosecond) {
    while (next < edges.size() && edges[next].at <= at) level = edges[next++].level;
    samples += level ? '1' : '0';
  }
  return samples;
}

TEST(Levels, ATableOfSamplesSaysItsRateOrNeedsIt) {
  const auto table = [](std::string_view head) {
    std::string text(head);
    for (const char level : samples_of(conversation_edges(kUsual), 120 * ms)) text += fmt::format("{},0\n", level);
    return text;
  };
  const std::string comment = "; CSV generated by libsigrok 0.5.2\n; Channels (2/2): A, GND\n";
  expect_one_wire(recording_of(table(comment + "; Samplerate: 1 MHz\nlogic,logic\n")), "levels", kUsual);
  EXPECT_EQ(refusal_of(table(comment + "logic,logic\n")),
            "it has neither times nor a samplerate: name that with --samplerate, as 1MHz");
  const LineRecording named = recording_of(table(comment + "logic,logic\n"), {.samplerate = 1'000'000});
  expect_one_wire(named, "levels", kUsual);
  EXPECT_NE(named.notes.front().find("of A "), std::string::npos) << named.notes.front();
  EXPECT_EQ(refusal_of(comment + "; Samplerate: 1 MHz\nlogic,logic\n1,1\n0,1\n1,1\n0,2\n"),
            "line 8: '0,2' is not a row of levels");
}

TEST(Levels, SigrokCliPrintsRowsOfBits) {
  const std::string samples = samples_of(conversation_edges(kUsual), 130 * ms);
  std::string rows = "libsigrok 0.5.2\nAcquisition with 2/8 channels at 100 kHz\n";
  std::string line, clock;
  for (std::size_t i = 0; i < samples.size(); i += 10) {  // of a microsecond each
    line += samples[i];
    clock += '0';
    if (line.size() % 9 == 8) line += ' ', clock += ' ';
    if (line.size() < 72 && i + 10 < samples.size()) continue;
    rows += "D0:" + line + "\nD1:" + clock + "\n";
    line.clear(), clock.clear();
  }
  expect_one_wire(recording_of(rows), "bits", kUsual);
  EXPECT_EQ(refusal_of("libsigrok 0.5.2\nAcquisition with 1/8 channels at 1 MHz\nD0:ff 00 ff\n"),
            "'D0:ff 00 ff' is not a row of bits; print them with sigrok-cli -O bits, -O vcd or -O csv");
}

TEST(Levels, ATableOfChangesMayHaveDates) {
  std::string table = "Time,Channel 0\n2026-11-28T09:15:02.000000000+01:00,1\n";
  for (const Edge& edge : conversation_edges(kUsual))
    table += fmt::format("2026-11-28T09:15:02.{:09}+01:00,{}\n", edge.at, edge.level ? 1 : 0);
  expect_one_wire(recording_of(table), "levels", kUsual);
}

TEST(Levels, ATableOfChangesHasTimes) {
  const auto table = [](std::string_view head, double unit) {
    std::string text = fmt::format("{}\n{:.9f}, 1\n", head, -0.001 / unit);
    for (const Edge& edge : conversation_edges(kUsual))
      text += fmt::format("{:.9f}, {}\n", static_cast<double>(edge.at) / kSecond / unit, edge.level ? 1 : 0);
    return text;
  };
  expect_one_wire(recording_of(table("Time [s],Channel 0", 1)), "levels", kUsual);
  expect_one_wire(recording_of(table("; CSV, generated by libsigrok4DSL\n; Sample rate: 1 MHz\nTime(s), 0", 1)), "levels",
                  kUsual);
  expect_one_wire(recording_of(table("Time[ms],TX", 1e-3)), "levels", kUsual);
  const auto with_decimal_commas = [&](std::string_view head) {
    std::string text = table("", 1);
    std::ranges::replace(text, ',', ';');
    std::ranges::replace(text, '.', ',');
    return std::string(head) + text;
  };
  for (const char* const head : {"Zeit [s];Kanal 0", "Zeit;Kanal 0", "Temps [s];Canal 0"})
    expect_one_wire(recording_of(with_decimal_commas(head)), "levels", kUsual);
  EXPECT_EQ(refusal_of("Time [s],Channel 0\n0,1\n0.1,0\n0.2,1\n0.1,0\n"),
            "line 5: '0.1,0' is not at a time after the row above it");
}

TEST(Levels, AZipThatIsNoSessionOfSigrokIsNamed) {
  EXPECT_TRUE(refusal_of("PK\x03\x04 and nothing else").starts_with("the zip cannot be read: ")) << "cut off";
}

// --- text ---

std::vector<std::string> texts_in(const std::string& log) {
  std::vector<std::string> texts;
  for (const ReadFrame& read : conversation(recording_of(log), *find_recorded_protocol("text")))
    texts.push_back((read.direction == Direction::Request  ? "> "
                     : read.direction == Direction::Answer ? "< "
                                                           : "? ") +
                    read.text + (read.right ? "" : " !"));
  return texts;
}

TEST(TextLines, ALineOfAsciiIsAMessage) {
  EXPECT_EQ(texts_in("0.000 TX 4D 45 41 53 3F 0D 0A\n0.050 RX 22 31 22 0D 0A\n"),
            (std::vector<std::string>{R"(> "MEAS?\r\n")", R"(< "\"1\"\r\n")"}));
  EXPECT_EQ(texts_in("0.000 RX 31 0D 0A 32 0D 0A\n"), std::vector<std::string>{R"(< "1\r\n2\r\n")"}) << "sent at once";
  EXPECT_EQ(texts_in("Time [s],Value\n0.001,0x31\n0.002,0x0D\n0.003,0x0A\n0.004,0x32\n0.005,0x0A\n"),
            (std::vector<std::string>{R"(? "1\r\n")", R"(? "2\n")"}));
  EXPECT_EQ(texts_in("0.000 RX 31\n0.002 RX 32 0D\n"), std::vector<std::string>{R"(< "12\r")"}) << "read in pieces";
  EXPECT_EQ(texts_in("0.000 31 0D\n1.000 32 0A\n"), (std::vector<std::string>{R"(? "1\r")", R"(? "2\n")"}))
      << "nothing says who asks";
}

TEST(TextLines, WhatIsNotOfATextIsNamed) {
  EXPECT_EQ(texts_in("0.000 TX 4F 80 0D\n0.100 TX 4F 4B\n"),
            (std::vector<std::string>{R"(> "O\x80\r"; character 2 is not of a text !)", R"(> "OK"; it has no line end !)"}));
}

TEST(TextLines, ARecordingOfTextIsRecognised) {
  const RecordedProtocol& modbus = *find_recorded_protocol("modbus");
  for (const char* log :
       {"0.000 TX 4D 45 41 53 3F 0D 0A\n0.050 RX 31 2E 35 0D 0A\n", "0.000 4D 45 41 53 3F 0D 0A\n0.050 31 2E 35 0D 0A\n"}) {
    const LineRecording recording = recording_of(log);
    const RecordedProtocol* const likelier =
        likelier_protocol(recording, modbus, RightFrames(conversation(recording, modbus)), {});
    ASSERT_NE(likelier, nullptr) << log;
    EXPECT_EQ(likelier->name, "text");
  }
}

// --- bytes in other notations ---

TEST(OtherNotations, TextLogsHaveThemInManyForms) {
  const auto log = [](const char* form, std::string_view before, std::string_view between) {
    std::string text;
    for (const Bytes* const frame : {&kRequest, &kAnswer}) {
      text += before;
      for (const std::uint8_t byte : *frame) text += fmt::format(fmt::runtime(form), byte) + std::string(between);
      text += '\n';
    }
    return text;
  };
  const std::vector<std::string> logs{log("{0} (0x{0:02X})", "", " "),     log("{0}(0x{0:02x})", "", " "),
                                      log("0x{0:02X} ({0})", "", ", "),    log("\\x{0:02X}", "data: ", ""),
                                      log("B#16#{0:02X}", "", " "),        log("[{0:03}]", "", ""),
                                      log("\u201C{0:02X}\u201D", "", " "), log("`{0:02X}`", "", " ")};
  for (const std::string& text : logs) {
    SCOPED_TRACE(text);
    expect_the_conversation(recording_of(text), "text", {});
  }
}

TEST(OtherNotations, ACharacterInEachRowMayBeInDecimalAndHex) {
  std::string text;
  for (const std::uint8_t byte : kRequest) text += fmt::format("TX {0} 0x{0:02X}\n", byte);
  for (const std::uint8_t byte : kAnswer) text += fmt::format("RX {0} 0x{0:02X}\n", byte);
  expect_the_conversation(recording_of(text), "text", {});
}

TEST(OtherNotations, DumpsWithoutCharactersGoOnByTheirOffsets) {
  expect_the_conversation(
      recording_of("00000000  01 03 00 0a 00 02 e4 09\n00000008  01 03 04 12 34 56 78 81\n00000010  07\n"), "dump", {});
}

TEST(OtherNotations, PuttysPacketsHaveADirectionAndATimeInTheHeadingAboveThem) {
  const std::string asked = "  00000000  01 03 00 0a 00 02 e4 09                          ........\n",
                    said = "  00000000  01 03 04 12 34 56 78 81 07                       ....4Vx..\n";
  expect_the_conversation(
      recording_of("=~=~= PuTTY log 2021.03.24 14:11:10 =~=~=\nOutgoing raw data at 2021-03-24 14:11:10\n" + asked +
                   "Incoming raw data at 2021-03-24 14:11:11\n" + said),
      "text", kSecond);
  expect_the_conversation(recording_of("Outgoing packet\n" + asked + "Incoming packet\n" + said), "text", {});
}

TEST(OtherNotations, MillisecondsSince1970AreTimes) {
  for (const char separator : {';', ',', ' ', '\t'})
    expect_the_conversation(
        recording_of(
            fmt::format("1616595070123{0}TX{0}0103000a0002e409\n1616595070160{0}RX{0}010304123456788107\n", separator)),
        "text", 37 * ms);
}

}  // namespace
}  // namespace s7200::tools::forms_test
