// Recordings of lines in the forms that tools write.
#include "tools/recordings/recording.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "serial_sim/modbus/mbap.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/record/pcap_capture.hpp"
#include "tools/recordings/decoded.hpp"
#include "tools/recordings/fields.hpp"

namespace s7200::tools {
namespace {

constexpr Time ms = kMillisecond;

LineRecording recording_of(const std::string& bytes, const ReadingChoices& choices = {}) {
  std::string why;
  auto recording = read_recording(bytes, choices, why);
  EXPECT_TRUE(recording) << why;
  return recording.value_or(LineRecording{});
}

std::string refusal_of(const std::string& bytes) {
  std::string why;
  EXPECT_FALSE(read_recording(bytes, {}, why));
  return why;
}

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
  EXPECT_EQ(time("[0.123456] 01 03"), 123'456 * kMicrosecond);
  EXPECT_EQ(time("12.5 ms 01"), 12'500 * kMicrosecond);
  EXPECT_EQ(time("+7ms 01"), 7 * ms);
  EXPECT_EQ(time("01 03 00"), std::nullopt) << "bytes";
  EXPECT_EQ(time("TX 01 03"), std::nullopt);
}

TEST(RecordedFields, DirectionsAreReadInTheWordsOfTools) {
  for (const char* word : {"TX:", "sent", "--> ", ">", "Request", "IRP_MJ_WRITE"})
    EXPECT_EQ(direction_of(word), Direction::Request) << word;
  for (const char* word : {"Rx", "received 8", "<-", "< ", "response:", "IRP_MJ_READ"})
    EXPECT_EQ(direction_of(word), Direction::Answer) << word;
  for (const char* word : {"", "COM1", "context", "already"}) EXPECT_EQ(direction_of(word), Direction::Unknown) << word;
}

TEST(RecordedFields, BytesAreReadInTheFormsOfTools) {
  const Bytes bytes{0x01, 0x03, 0xAB};
  for (const char* text :
       {"01 03 ab", "0x01, 0x03, 0xAB", "[01][03][AB]", "<01><03><AB>", "0103ab", "01-03-AB", "\"01 03 AB\""})
    EXPECT_EQ(bytes_of_text(text), bytes) << text;
  for (const char* text : {"", "hello", "1", "123", "0.25", "01 xx 03x"})
    EXPECT_EQ(bytes_of_text(text), std::nullopt) << text;
  const auto found = trailing_bytes("COM3 TX (8): 01 03 AB");
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
  EXPECT_EQ(log.notes, std::vector<std::string>{"a line without bytes was left out"});
}

TEST(Recordings, WhatMbpollPrintsHasNoTimesAndSaysItsDirectionsInBrackets) {
  const LineRecording log =
      recording_of("[01][03][00][00][00][01][84][0A]\nWaiting for a confirmation...\n<01><03><02><12><34><B5><33>\n");
  ASSERT_EQ(log.frames.size(), 2U);
  EXPECT_EQ(log.frames[0].direction, Direction::Request);
  EXPECT_EQ(log.frames[1].direction, Direction::Answer);
  EXPECT_EQ(log.frames[1].at, std::nullopt);
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
  EXPECT_EQ(refusal_of("Time,Data\n0,01 03\nnever,01 03\n"), "line 3: 'never' is not a time");
  EXPECT_EQ(refusal_of("Time,Data\n0,zz\n"), "line 2: 'zz' is not bytes in hex");
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
Bytes segment(bool to_server, std::uint32_t sequence, const Bytes& data, std::uint8_t flags = 0x18) {
  Bytes bytes(12, 0);
  bytes.insert(bytes.end(), {0x08, 0x00});
  const auto total = static_cast<std::uint16_t>(40 + data.size());
  Bytes ip{0x45, 0, static_cast<std::uint8_t>(total >> 8), static_cast<std::uint8_t>(total), 0, 0, 0x40, 0, 64, 6, 0, 0};
  const Bytes client{10, 0, 0, 1}, server{10, 0, 0, 2};
  for (const Bytes& address : {to_server ? client : server, to_server ? server : client})
    ip.insert(ip.end(), address.begin(), address.end());
  Bytes tcp(20, 0);
  store16(&tcp[0], to_server ? 50'000 : 502);
  store16(&tcp[2], to_server ? 502 : 50'000);
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

TEST(Recordings, AConnectionWithSegmentsMissingIsLeftOutFromThereOn) {
  const Bytes request = modbus::to_bytes({.transaction = 7, .unit = 1, .pdu = {3, 0, 0, 0, 1}});
  const auto length = static_cast<std::uint32_t>(request.size());
  const LineRecording recording =
      recording_of(ethernet_pcap({segment(true, 100, request), segment(true, 100 + 2 * length, request)}));
  EXPECT_EQ(recording.frames.size(), 1U);
  EXPECT_EQ(recording.notes,
            std::vector<std::string>{"packet 2: the rest of this connection was left out: segments before it are missing"});
}

TEST(Recordings, WhatIsNoRecordingIsRefused) {
  EXPECT_EQ(refusal_of(""), "no frame in it");
  EXPECT_EQ(refusal_of("a letter\n"), "no frame in it; a line without bytes was left out");
  EXPECT_EQ(refusal_of(std::string("a\0b", 3)), "neither a pcap file nor text");
  EXPECT_NE(refusal_of("\xD4\xC3\xB2\xA1 cut off"), "");
  std::string other = ethernet_pcap({});
  other[20] = 105;
  EXPECT_EQ(refusal_of(other), "link type 105 is not one of 147 (serial), Ethernet, Linux cooked or raw IP");
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
  std::string why;
  read_recording(ethernet_pcap(packets), {}, why);
}

// --- conversations ---

std::vector<ReadFrame> read(const LineRecording& recording, std::string_view protocol = "modbus") {
  return conversation(recording, *find_recorded_protocol(protocol));
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
  EXPECT_EQ(silence(frames[0], frames[1], {.character = 1 * ms}), 17 * ms) << "eight characters of the request";
  EXPECT_EQ(silence(frames[0], frames[1], {.character = 1 * ms, .at_end = true}), 18 * ms) << "seven of the answer";
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
  EXPECT_EQ(frames[3].text, "2 to 0, function 08: read");
  EXPECT_EQ(frames[3].other, 2U);
  EXPECT_EQ(frames[4].direction, Direction::Unknown);
}

TEST(Conversation, AScenarioAsksTheSameWithTheSameGaps) {
  const LineRecording recording =
      recording_of("0.000 TX 01 03 00 00 00 01 84 0A\n0.025 RX 01 03 02 12 34 B5 33\n0.100 TX 02 03 00 00 00 01 84 39\n");
  const auto frames = read(recording);
  const Stamps stamps{.character = 1 * ms};
  EXPECT_EQ(scenario_text(frames, stamps, {.name = "a \"plant\"", .program = "slave.stl", .tolerance = 5 * ms}),
            "scenarios:\n  - name: \"a \\\"plant\\\"\"\n    program: \"slave.stl\"\n    tolerance: 5 ms\n    steps:\n"
            "      - send: 01 03 00 00 00 01 84 0a\n        expect: 01 03 02 12 34 b5 33\n        latency: 17 ms\n"
            "        # line 1: station 1, read holding registers 40001, 1 of them; 1 register: 16#1234\n"
            "      - send: 02 03 00 00 00 01 84 39\n        pause: 68 ms\n        expect: silence\n        timeout: 1 s\n"
            "        # line 3: station 2, read holding registers 40001, 1 of them\n");
  EXPECT_EQ(scenario_text(frames, stamps, {.station = 9}), "");
}

}  // namespace
}  // namespace s7200::tools
