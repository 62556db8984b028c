// Recordings as people have them: nothing in them is taken for a byte that is none, and none is lost.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "serial_sim/modbus/crc.hpp"
#include "tests/unit/recordings/conversation.hpp"

namespace s7200::tools::as_found_test {
namespace {

const std::string kRequest = "11 03 00 6B 00 03 76 87", kAnswer = "11 03 06 AE 41 56 52 43 40 49 AD";
const std::vector<std::string> kBoth{"station 17, read holding registers 40108, 3 of them",
                                     "3 registers: 16#AE41 16#5652 16#4340"};

std::string refusal_of(const std::string& bytes) { return read_recording(bytes, {}).why(); }

/// The bytes of all frames, in hex.
std::string bytes_of(const std::string& bytes) {
  std::string text;
  for (const RecordedFrame& frame : test::recording_of(bytes).frames)
    for (const std::uint8_t byte : frame.bytes) text += fmt::format("{}{:02X}", text.empty() ? "" : " ", byte);
  return text;
}

std::vector<std::optional<Time>> times_of(const std::string& bytes) {
  std::vector<std::optional<Time>> times;
  for (const RecordedFrame& frame : test::recording_of(bytes).frames) times.push_back(frame.at);
  return times;
}

const std::vector<std::optional<Time>> kTimes{0, 25 * kMillisecond};

std::string without_blanks(std::string text) {
  std::erase(text, ' ');
  return text;
}

bool has_note(const LineRecording& recording, std::string_view words) {
  return std::ranges::any_of(recording.notes,
                             [words](const std::string& note) { return note.find(words) != std::string::npos; });
}

/// Rows for each character of the conversation.
template <typename Row>
std::string rows_of_characters(Row row) {
  std::string rows;
  int sample = 1000;
  for (const std::string& frame : {kRequest, kAnswer}) {
    for (std::size_t at = 0; at < frame.size(); at += 3, sample += 1146) rows += row(sample, frame.substr(at, 2));
    sample += 15'000;
  }
  return rows;
}

// --- annotations of PulseView ---

TEST(AsFound, PulseViewWritesItsRowsOrItsClassesBeforeTheCharacters) {
  const auto with = [](std::string_view bits, std::string_view data) {
    return rows_of_characters([=](int at, const std::string& hex) {
      return fmt::format("{}-{} UART: RX {}: Start bit\n{}-{} UART: RX {}: 1\n{}-{} UART: {}: {}\n", at, at + 104, bits,
                         at + 104, at + 208, bits, at + 104, at + 937, data, hex);
    });
  };
  for (const std::string& rows : {with("start bits", "RX data"), with("bits", "RX")}) {
    ReadingChoices choices;
    choices.samplerate = 1'000'000;
    const auto recording = read_recording(rows, choices);
    ASSERT_TRUE(recording) << recording.why();
    ASSERT_EQ(recording->frames.size(), 2U);
    EXPECT_EQ(recording->frames[1].at, 24'168 * kMicrosecond);
    EXPECT_EQ(bytes_of(rows), kRequest + " " + kAnswer);
  }
}

TEST(AsFound, RowsOfPulseViewThatFollowEachOtherAreInTheOrderOfTheirSamples) {
  EXPECT_EQ(bytes_of("0-90 UART: RX: 01\n200-290 UART: RX: 03\n100-190 UART: TX: 02\n"), "01 02 03");
}

TEST(AsFound, NumbersInFrontOfARowAreNotAlwaysSamples) {
  EXPECT_EQ(bytes_of("100-200 TX: " + kRequest + "\n300-400 RX: " + kAnswer + "\n"), kRequest + " " + kAnswer);
  EXPECT_EQ(refusal_of("100-200 Modbus: Slave ID: 17\n"),
            "it is what sigrok's decoder Modbus says, without the characters; print them with sigrok-cli -A uart");
}

TEST(AsFound, ASamplerateThatIsNotUsedIsNamed) {
  ReadingChoices choices;
  choices.samplerate = 1'000'000;
  const auto recording = read_recording("10:00:00.000 TX " + kRequest + "\n", choices);
  ASSERT_TRUE(recording);
  EXPECT_TRUE(has_note(*recording, "--samplerate is not used"));
}

// --- texts of Python ---

TEST(AsFound, PythonShowsBytesWithoutTheirLetter) {
  EXPECT_EQ(bytes_of(R"(10:00:00.000 write '\x05\x06\x00\x10\x124\x84\xfc')"
                     "\n"),
            "05 06 00 10 12 34 84 FC");
  EXPECT_EQ(bytes_of(R"(10:00:00.000 write "\x05'4")"
                     "\n"),
            "05 27 34");
}

TEST(AsFound, HexInBracketsBehindAText) {
  const std::string asks = "MinimalModbus debug mode. Writing to instrument (expecting 11 bytes back): ",
                    hears = "MinimalModbus debug mode. Response from instrument: ",
                    end = " (11 bytes), roundtrip time: 25.0 ms. Timeout setting: 50.0 ms.\n";
  const std::string answer = hears + "'\\x11\\x03\\x06\u00AEAVRC@I\\xad' (" + kAnswer + ")" + end;
  EXPECT_EQ(test::texts(asks + R"('\x11\x03\x00k\x00\x03v\x87' ()" + kRequest + ")\n" + answer), kBoth);
  EXPECT_EQ(bytes_of(answer), kAnswer) << "an answer alone is no table with names for its columns";
}

TEST(AsFound, BytesThatStandOnceMoreInBracketsAreOneFrame) {
  EXPECT_EQ(bytes_of("10:00:00.000 TX " + kRequest + " (" + kRequest + ")\n"), kRequest);
}

// --- values that are no bytes ---

TEST(AsFound, FieldsOfAPacketAreNotItsBytes) {
  EXPECT_EQ(refusal_of(R"({"timestamp":"1709632800000","layers":{"tcp":{"tcp_tcp_seq_raw":"1000"}}})"),
            "no frames found; line 1: left out: no bytes in it");
  const std::string request = R"("tcp_tcp_srcport":"40000","tcp_tcp_dstport":"502","tcp_tcp_payload":"000100000006)";
  EXPECT_EQ(test::texts(R"({"timestamp":"1","layers":{"frame":{"frame_frame_time_relative":"0.0"},"tcp":{)" + request +
                        R"(1103006b0003"}}})"
                        "\n"),
            std::vector{kBoth.front()});
  EXPECT_EQ(test::texts(R"([{"_source":{"layers":{"tcp":{"tcp.srcport_raw":["9c40",34],"tcp.dstport_raw":["01f6",36],)"
                        R"("tcp.payload_raw":["0001000000061103006b0003",54,12,0,26]}}}}])"),
            std::vector{kBoth.front()});
}

TEST(AsFound, TasmotasDriverForModbusHasValues) {
  const std::string advice = "it has what Tasmota's driver for Modbus sent and read, as values and not as frames";
  EXPECT_NE(refusal_of("10:00:00.000 CMD: ModbusSend {\"deviceaddress\":17}\n").find(advice), std::string::npos);
  EXPECT_NE(refusal_of("10:00:00.223 RSL: RESULT = {\"ModbusReceived\":{\"DeviceAddress\":1,\"FunctionCode\":3,"
                       "\"StartAddress\":10,\"Length\":9,\"Count\":2,\"Values\":[10,20]}}\n")
                .find(advice),
            std::string::npos);
  EXPECT_EQ(refusal_of("{\"received\":{\"start_address\":10,\"values\":[10,20]}}\n"),
            "no frames found; line 1: left out: no bytes in it");
}

TEST(AsFound, TasmotaSaysAtItsLevelDebugWhatItSends) {
  const std::string debug = "10:00:00.000 CMD: Grp 0, Cmd 'SERIALSEND', Idx 5, Len 16, Pld -99, Data '" +
                            without_blanks(kRequest) + "'\n",
                    answer = "10:00:00.025 RSL: RESULT = {\"SerialReceived\":\"" + without_blanks(kAnswer) + "\"}\n";
  EXPECT_EQ(test::texts(debug + answer), kBoth);
  EXPECT_EQ(test::texts("10:00:00.000 CMD: SerialSend5 " + without_blanks(kRequest) + "\n" + debug + answer), kBoth)
      << "the same command";
}

TEST(AsFound, NumbersThatAreNoBytes) {
  EXPECT_EQ(refusal_of("[11]: 4660\n[12]: 22136\n"), "no frames found; line 1: left out, and 1 more: no bytes in it");
  EXPECT_EQ(refusal_of("AT+CSQ\nOK\n+CSQ: 18,99\n"), "no frames found; line 1: left out, and 2 more: no bytes in it");
  EXPECT_EQ(refusal_of("10:00:00 alloc 0x7ffdeadbeef0 size 0x10\n"), "no frames found; line 1: left out: no bytes in it");
  for (const char* const table :
       {"time;VW20;VW22\n10:00:00,000;4660;22136\n10:00:01,000;4661;22137\n",
        "time;VD20\n10:00:00,000;12345678\n10:00:01,000;12345679\n", "time;T1;T2\n10:00:00,000;12;34\n10:00:01,000;13;35\n"})
    EXPECT_NE(refusal_of(table).find("no column found for the bytes: name it Hex"), std::string::npos) << table;
}

TEST(AsFound, ModpollPrintsAsMbpollDoes) {
  const std::string poll =
      "modpoll 3.10 - FieldTalk(tm) Modbus(R) Master Simulator\n"
      "Slave configuration...: address = 17, start reference = 108, count = 3\n"
      "Data type.............: 16-bit register, output (holding) register table\n\n"
      "-- Polling slave... (Ctrl-C to stop)\n[108]: 44609\n[109]: 22098\n[110]: 17216\n";
  EXPECT_EQ(test::texts(poll), kBoth);
}

TEST(AsFound, ATimeJoinedToItsBytes) {
  EXPECT_EQ(test::texts("Tx:000000-10:00:00.000-" + kRequest + "\nRx:000001-10:00:00.025-" + kAnswer + "\n"), kBoth);
  EXPECT_EQ(times_of("Tx:000000-10:00:00.000-" + kRequest + "\nRx:000001-10:00:00.025-" + kAnswer + "\n"), kTimes);
  EXPECT_EQ(test::texts("10:00:00.000-" + kRequest + "\n"), std::vector{kBoth.front()});
}

TEST(AsFound, BinaryWithAGapInTheMiddle) {
  EXPECT_EQ(bytes_of("Time [s],Value,Parity Error,Framing Error\n0.001,0b0001 0001,,\n0.002,0b0000 0011,,\n"), "11 03");
}

// --- forms ---

TEST(AsFound, TsharkFollowsAStream) {
  EXPECT_EQ(test::texts("\n===================================================================\nFollow: tcp,hex\n"
                        "Filter: tcp.stream eq 0\nNode 0: 10.0.0.1:40000\nNode 1: 10.0.0.2:502\n"
                        "00000000  00 01 00 00 00 06 11 03  00 6b 00 03              ........ .k..\n"
                        "\t00000000  00 01 00 00 00 09 11 03  06 ae 41 56 52 43 40     ........ ..AVRC@\n"
                        "0000000C  00 02 00 00 00 06 11 03  00 6b 00 03              ........ .k..\n"
                        "\t0000000F  00 02 00 00 00 09 11 03  06 ae 41 56 52 43 40     ........ ..AVRC@\n"
                        "===================================================================\n"),
            (std::vector{kBoth[0], kBoth[1], kBoth[0], kBoth[1]}));
}

TEST(AsFound, Base64InALog) {
  for (const char* const mark : {"b64:", "base64:", "base64 ", "b64="})
    EXPECT_EQ(bytes_of(fmt::format("10:00:00.000 TX {}EQMAawADdoc=\n", mark)), kRequest) << mark;
  EXPECT_EQ(refusal_of("10:00:00.000 TX base64 encoding\n"), "no frames found; line 1: left out: no bytes in it");
}

TEST(AsFound, CellsWithoutNames) {
  for (const auto& [request, answer] :
       {std::pair("10:00:00.000,Out," + kRequest, "10:00:00.025,In," + kAnswer),
        std::pair("10:00:00.000;W;8;" + kRequest + ";ok", "10:00:00.025;R;11;" + kAnswer + ";ok"),
        std::pair("TX;" + kRequest + ";10:00:00,000", "RX;" + kAnswer + ";10:00:00,025"),
        std::pair("TX\t" + kRequest + "\t0.000", "RX\t" + kAnswer + "\t0.025")}) {
    const std::string log = request + "\n" + answer + "\n";
    EXPECT_EQ(test::texts(log), kBoth) << log;
    EXPECT_EQ(times_of(log), kTimes) << log;
    EXPECT_EQ(test::recording_of(log).frames[1].direction, Direction::Answer) << log;
  }
}

TEST(AsFound, DsviewWritesWhereCharactersEnd) {
  EXPECT_EQ(bytes_of("Id,Start[ns],End[ns],0:UART: RX/TX\n0,1000000.00,2145833.33,11\n1,2145833.33,3291666.66,03\n"),
            "11 03");
}

TEST(AsFound, EsphomeReceivesWholeFrames) {
  EXPECT_EQ(test::texts("[10:00:00.000][V][modbus:199]: Modbus write: 11.03.00.6B.00.03.76.87 (8)\n"
                        "[10:00:00.025][V][modbus:042]: Modbus received frame: 11.03.06.AE.41.56.52.43.40.49.AD (11)\n"),
            kBoth);
}

// --- times ---

TEST(AsFound, TimesWithANameOrWithoutOne) {
  for (const auto& [first, second] :
       {std::pair("T+0000.000", "T+0000.025"), std::pair("[T+0.000]", "[T+0.025]"), std::pair("T+0.000s", "T+0.025s"),
        std::pair("T+0ms", "T+25ms"), std::pair("\u0394t=0.000", "\u0394t=0.025"), std::pair("dt=0ms", "dt=25ms"),
        std::pair("1709632800000000", "1709632800025000")}) {
    const std::string log = fmt::format("{} TX {}\n{} RX {}\n", first, kRequest, second, kAnswer);
    EXPECT_EQ(times_of(log), kTimes) << log;
    EXPECT_EQ(test::texts(log), kBoth) << log;
  }
  EXPECT_EQ(times_of("{\"uptime_ms\":0,\"dir\":\"TX\",\"data\":\"" + kRequest +
                     "\"}\n{\"uptime_ms\":25,\"dir\":\"RX\",\"data\":\"" + kAnswer + "\"}\n"),
            kTimes);
}

TEST(AsFound, DifferencesCountFromTheRowAbove) {
  const std::string table = "delta_ms,dir,data\n0,TX," + kRequest + "\n25,RX," + kAnswer + "\n75,TX," + kRequest + "\n";
  EXPECT_EQ(times_of(table), (std::vector<std::optional<Time>>{0, 25 * kMillisecond, 100 * kMillisecond}));
  EXPECT_TRUE(has_note(test::recording_of(table), "each counts from the row above"));
  const std::string log =
      "\u0394t=0.000 TX " + kRequest + "\n\u0394t=0.025 RX " + kAnswer + "\n\u0394t=0.075 TX " + kRequest;
  EXPECT_EQ(times_of(log + "\n").back(), 100 * kMillisecond);
}

// --- what a recording says of its line ---

TEST(AsFound, ARateInWords) {
  const std::string rows = "10:00:00.000 TX " + kRequest + "\n10:00:00.025 RX " + kAnswer + "\n";
  const auto line_of = [](const std::string& text) {
    const LineRecording recording = test::recording_of(text);
    return recording.line ? format_text(*recording.line) : "";
  };
  EXPECT_EQ(line_of("# COM3 19200 8N1\n" + rows), "19200 baud, 8 data bits, no parity, 1 stop bit");
  EXPECT_EQ(line_of("Port opened: /dev/ttyUSB0 baud=115200 parity=N timeout=1000ms\n" + rows),
            "115200 baud, 8 data bits, no parity, 1 stop bit");
  EXPECT_EQ(line_of("Baud rate: 187500\n" + rows), "187500 baud, 8 data bits, even parity, 1 stop bit");
  EXPECT_EQ(line_of("[COM3 19200,8,O,2]\n" + rows), "19200 baud, 8 data bits, odd parity, 2 stop bits");
  EXPECT_EQ(line_of("Opening /dev/ttyUSB0 at 38400 bauds (N, 8, 1)\n" + rows),
            "38400 baud, 8 data bits, no parity, 1 stop bit");
  EXPECT_EQ(line_of("{\"time\":0.0,\"baudrate\":19200,\"dir\":\"tx\",\"data\":\"" + kRequest + "\"}\n"),
            "19200 baud, 8 data bits, even parity, 1 stop bit");
  EXPECT_EQ(line_of("0.0 ioctl(3, TCSETS2, {c_iflag=IGNPAR, c_cflag=B19200|CS8|CREAD|PARENB, c_lflag=0}) = 0\n"
                    "0.1 write(3, \"\\x11\\x03\\x00\\x6b\\x00\\x03\\x76\\x87\", 8) = 8\n"),
            "19200 baud, 8 data bits, even parity, 1 stop bit");
  EXPECT_EQ(line_of(rows), "");
  EXPECT_TRUE(has_note(test::recording_of("# COM3 19200 8N1\n" + rows),
                       "line 1: it says 19200 baud, 8 data bits, no parity, 1 stop bit: silences are those of such a line"));
}

TEST(AsFound, WhatTheUserSaysOfTheLineCounts) {
  const std::string log = "# COM3 19200 8N1\n10:00:00.000 TX " + kRequest + "\n";
  ReadingChoices choices;
  choices.line.baud = 9600;
  const auto recording = read_recording(log, choices);
  ASSERT_TRUE(recording && recording->line);
  EXPECT_EQ(recording->line->baud, 9600U);
  EXPECT_TRUE(has_note(*recording, "line 1: it says 19200 baud"));
  EXPECT_TRUE(has_note(test::recording_of("baud=9600\nbaud=19200\n10:00:00.000 TX " + kRequest + "\n"),
                       "it says one rate, and other lines another"));
}

TEST(AsFound, ATimeOutInWords) {
  const std::string row = "10:00:00.000 05 06 00 10 12 34 84 FC\n";
  EXPECT_EQ(test::recording_of("timeout 500 ms, baud 9600\n" + row).timeout, 500 * kMillisecond);
  EXPECT_EQ(test::recording_of("timeout=1.5s\n" + row).timeout, 1500 * kMillisecond);
  EXPECT_FALSE(test::recording_of("10:00:00 ERROR timeout after 50 ms\n" + row).timeout);
}

// --- functions that only recordings have ---

std::string in_hex_with_crc(Bytes frame) {
  modbus::add_crc(frame);
  std::string text;
  for (const std::uint8_t byte : frame) text += fmt::format("{:02X} ", byte);
  return text;
}

TEST(AsFound, FunctionsBeyondOursInWords) {
  const auto exchange = [](const Bytes& request, const Bytes& answer) {
    return test::texts("TX " + in_hex_with_crc(request) + "\nRX " + in_hex_with_crc(answer) + "\n");
  };
  EXPECT_EQ(exchange({0x11, 0x16, 0x00, 0x04, 0x00, 0xF2, 0x00, 0x25}, {0x11, 0x16, 0x00, 0x04, 0x00, 0xF2, 0x00, 0x25}),
            (std::vector<std::string>{"station 17, mask write register 40005: AND 16#00F2, OR 16#0025",
                                      "masked register 40005: AND 16#00F2, OR 16#0025"}));
  EXPECT_EQ(exchange({0x11, 0x17, 0x00, 0x03, 0x00, 0x02, 0x00, 0x0E, 0x00, 0x01, 0x02, 0x00, 0xFF},
                     {0x11, 0x17, 0x04, 0x00, 0xFE, 0x0A, 0xCD}),
            (std::vector<std::string>{"station 17, write registers 40015, 1 of them: 16#00FF; then read holding registers "
                                      "40004, 2 of them",
                                      "2 registers: 16#00FE 16#0ACD"}));
  EXPECT_EQ(exchange({0x11, 0x2B, 0x0E, 0x01, 0x00},
                     {0x11, 0x2B, 0x0E, 0x01, 0x01, 0x00, 0x00, 0x01, 0x00, 0x03, 0x41, 0x42, 0x43}),
            (std::vector<std::string>{"station 17, read device identification, the basic ones, from object 0 on",
                                      "device identification: vendor 'ABC'"}));
}

}  // namespace
}  // namespace s7200::tools::as_found_test
