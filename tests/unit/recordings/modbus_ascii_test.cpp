// Frames of Modbus ASCII in recordings: read as those of Modbus RTU are, with their LRC.
#include <gtest/gtest.h>

#include "serial_sim/line/frame.hpp"
#include "tools/recordings/decoded.hpp"
#include "tools/recordings/playback.hpp"

namespace s7200::tools::modbus_ascii_test {
namespace {

const RecordedProtocol& modbus() { return *find_recorded_protocol("modbus"); }

LineRecording recording_of(const std::string& log) {
  auto recording = read_recording(log, {});
  EXPECT_TRUE(recording) << recording.why() << '\n' << log;
  return recording.value_or(LineRecording{});
}

std::vector<ReadFrame> read(const std::string& log) {
  auto recording = recording_of(log);
  settle_directions(recording, modbus());
  return conversation(recording, modbus());
}

void expect_the_conversation(const std::string& log) {
  const auto frames = read(log);
  ASSERT_EQ(frames.size(), 2U) << log;
  EXPECT_EQ(frames[0].direction, Direction::Request) << log;
  EXPECT_EQ(frames[0].text, "station 1, read holding registers 40011, 2 of them") << log;
  EXPECT_EQ(frames[0].station, 1) << log;
  EXPECT_EQ(frames[1].direction, Direction::Answer) << log;
  EXPECT_EQ(frames[1].text, "2 registers: 16#1234 16#5678") << log;
  EXPECT_EQ(frames[1].other, 0U) << log;
  EXPECT_TRUE(frames[0].right && frames[1].right) << log;
}

TEST(ModbusAscii, FramesAreReadHoweverALogWritesThem) {
  expect_the_conversation(":0103000A0002F0\n:01030412345678E4\n");
  expect_the_conversation("10:00:00.100 TX :0103000A0002F0\\r\\n\n10:00:00.140 RX :01030412345678E4\\r\\n\n");
  expect_the_conversation("10:00:00.100 -> :0103000A0002F0<CR><LF>\n10:00:00.140 <- :01030412345678E4<CR><LF>\n");
  expect_the_conversation(
      "TX 3A 30 31 30 33 30 30 30 41 30 30 30 32 46 30 0D 0A\n"
      "RX 3A 30 31 30 33 30 34 31 32 33 34 35 36 37 38 45 34 0D 0A\n");
  expect_the_conversation(
      "{\"time\":1.0,\"dir\":\"tx\",\"data\":\":0103000A0002F0\\r\\n\"}\n"
      "{\"time\":1.1,\"dir\":\"rx\",\"data\":\":01030412345678E4\\r\\n\"}\n");
  expect_the_conversation("send b':0103000A0002F0\\r\\n'\nrecv b':01030412345678E4\\r\\n'\n");
}

TEST(ModbusAscii, AFrameMayComeInPieces) {
  expect_the_conversation(
      "10:00:00.100 TX 3A 30 31 30 33 30 30 30 41 30 30 30 32 46 30 0D 0A\n"
      "10:00:00.140 RX 3A 30 31 30 33 30 34 31 32\n10:00:00.150 RX 33 34 35 36 37 38 45 34 0D 0A\n");
  expect_the_conversation(
      "3A 30 31 30 33 30 30 30 41 30 30 30 32 46 30 0D 0A 3A 30 31 30 33 30 34 31 32 33 34 35 36 37 38 45 34 0D 0A\n");
}

TEST(ModbusAscii, WhatIsWrongIsNamed) {
  const auto said = [](const std::string& answer) {
    const auto frames = read("TX :0103000A0002F0\nRX " + answer + "\n");
    EXPECT_FALSE(frames.back().right);
    return frames.back().text;
  };
  EXPECT_EQ(said(":01030412345678E5"), "wrong LRC: E5, expected E4");
  EXPECT_EQ(said("3A 30 31 30 33 30 34 31 32 47 34 35 36 37 38 45 34 0D 0A"), "a character of it is not a hex digit");
  EXPECT_EQ(said("3A 30 31 30 33 30 34 31 32 33 34 35 36 37 38 45 0D 0A"), "a hex digit of it is missing");
  EXPECT_EQ(said(":0103021234B4").substr(0, 12), "wrong length") << "the LRC is right";
  EXPECT_EQ(read(":0103000A0002F1\n").front().text, "wrong LRC: F1, expected F0");
}

TEST(ModbusAscii, AnExceptionIsAnAnswer) {
  const auto frames = read("TX :0103000A0002F0\nRX :0183027A\n");
  EXPECT_EQ(frames.back().text, "exception 2: illegal data address");
  EXPECT_EQ(frames.back().other, 0U);
}

TEST(ModbusAscii, NoOtherProtocolIsSuggestedForIt) {
  for (const std::string log : {":0103000A0002F1\n:01030412345678E5\n", ":0103000A0002F0\n:01030412345678E4\n"}) {
    const auto recording = recording_of(log);
    RightFrames right;
    for (const ReadFrame& frame : conversation(recording, modbus())) right.add(frame);
    EXPECT_EQ(likelier_protocol(recording, modbus(), right, {}), nullptr) << log;
  }
}

TEST(ModbusAscii, StationColonOfModbusRtuIsNotAscii) {
  const auto frames = read("TX 3A 03 00 0A 00 02 E0 82\n");
  EXPECT_EQ(frames.front().text, "station 58, read holding registers 40011, 2 of them");
}

TEST(ModbusAscii, AScenarioSendsAndExpectsItsCharacters) {
  const auto frames = read("10:00:00.100 TX :0103000A0002F0\n10:00:00.140 RX :01030412345678E4\n");
  const auto [scenario, notes] = playback(frames, {.character = 1'145'833}, {.name = "ascii"});
  EXPECT_NE(scenario.find("3a 30 31 30 33 30 30 30 41 30 30 30 32 46 30 0d 0a"), std::string::npos) << scenario;
  EXPECT_NE(scenario.find("3a 30 31 30 33 30 34"), std::string::npos) << scenario;
}

}  // namespace
}  // namespace s7200::tools::modbus_ascii_test
