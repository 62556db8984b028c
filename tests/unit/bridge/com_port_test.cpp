// A client of a serial port over TCP, byte by byte.
#include "tools/bridge/com_port.hpp"

#include <gtest/gtest.h>

#include "serial_sim/line/frame.hpp"

namespace s7200::tools::com_port_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Client {
  SerialFormat plc{9600, 8, Parity::Even, 1};
  Bytes sent;
  int breaks = 0, ended = 0, purges = 0;
  ComPort port{{.format = [this] { return plc; },
                .character = [this](std::uint8_t byte) { sent.push_back(byte); },
                .begin_break = [this] { ++breaks; },
                .end_break = [this] { ++ended; },
                .purge = [this] { ++purges; }}};

  std::string take(const Bytes& bytes) { return serial::to_hex(port.take(bytes)); }
  /// Of a command, without what frames it.
  std::string ask(const Bytes& command) {
    Bytes bytes{0xFF, 0xFA, 0x2C};
    bytes.insert(bytes.end(), command.begin(), command.end());
    bytes.insert(bytes.end(), {0xFF, 0xF0});
    const Bytes answer = port.take(bytes);
    if (answer.size() < 5) return "nothing";
    return serial::to_hex(std::span(answer).subspan(3, answer.size() - 5));
  }
};

TEST(ComPort, DataPassesAndAByte255IsDoubled) {
  Client client;
  EXPECT_EQ(client.take({0x01, 0xFF, 0xFF, 0x03}), "");
  EXPECT_EQ(serial::to_hex(client.sent), "01 ff 03");
  const std::vector<ReceivedCharacter> heard{{.byte = 0xFF}, {.byte = 0x04}};
  EXPECT_EQ(serial::to_hex(client.port.received(heard)), "ff ff 04");
}

TEST(ComPort, OptionsAreAgreedOnOnceAndOthersRefused) {
  Client client;
  EXPECT_EQ(client.take({0xFF, 0xFB, 0x2C}), "ff fd 2c") << "WILL, DO";
  EXPECT_EQ(client.take({0xFF, 0xFB, 0x2C}), "") << "no endless loop";
  EXPECT_EQ(client.take({0xFF, 0xFD, 0x00}), "ff fb 00") << "DO, WILL";
  EXPECT_EQ(client.take({0xFF, 0xFD, 0x01}), "ff fc 01") << "no echo";
  EXPECT_EQ(client.take({0xFF, 0xFE, 0x00}), "ff fc 00");
}

TEST(ComPort, SettingsHoldForTheClientsCharactersAndAreAnswered) {
  Client client;
  EXPECT_EQ(client.ask({1, 0, 0, 0, 0}), "65 00 00 25 80") << "asked: that of the PLC";
  EXPECT_EQ(client.ask({1, 0, 0, 0x4B, 0}), "65 00 00 4b 00");
  EXPECT_EQ(client.ask({2, 7}), "66 07");
  EXPECT_EQ(client.ask({3, 2}), "67 02");
  EXPECT_EQ(client.ask({4, 2}), "68 02");
  EXPECT_EQ(client.port.format(), (SerialFormat{19200, 7, Parity::Odd, 2}));
}

TEST(ComPort, WhatAPortOfAnS7200CannotDoStaysAsItIs) {
  Client client;
  EXPECT_EQ(client.ask({1, 0, 0, 0, 5}), "65 00 00 25 80");
  EXPECT_EQ(client.ask({1, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}), "65 00 00 25 80") << "a doubled 255 is one";
  EXPECT_EQ(client.ask({2, 5}), "66 08");
  EXPECT_EQ(client.ask({3, 4}), "67 03") << "mark parity";
  EXPECT_EQ(client.ask({4, 3}), "68 01") << "1.5 stop bits";
}

TEST(ComPort, ABreakIsHeldFromOnToOff) {
  Client client;
  EXPECT_EQ(client.ask({5, 6}), "69 06");
  EXPECT_EQ(client.ended, 0) << "there was none";
  EXPECT_EQ(client.ask({5, 5}), "69 05");
  EXPECT_EQ(client.ask({5, 5}), "69 05");
  EXPECT_EQ(client.ask({5, 4}), "69 05") << "asked";
  EXPECT_EQ(client.breaks, 1);
  EXPECT_EQ(client.ended, 0);
  EXPECT_EQ(client.ask({5, 6}), "69 06");
  EXPECT_EQ(client.ask({5, 6}), "69 06");
  EXPECT_EQ(client.ended, 1);
  EXPECT_EQ(client.ask({5, 5}), "69 05");
  EXPECT_EQ(client.breaks, 2);
}

TEST(ComPort, DtrRtsAndFlowControlAreRemembered) {
  Client client;
  EXPECT_EQ(client.ask({5, 8}), "69 08");
  EXPECT_EQ(client.ask({5, 7}), "69 08");
  EXPECT_EQ(client.ask({5, 12}), "69 0c");
  EXPECT_EQ(client.ask({5, 0}), "69 01") << "no flow control";
  EXPECT_EQ(client.ask({5, 3}), "69 03");
  EXPECT_EQ(client.ask({5, 13}), "69 0e");
}

TEST(ComPort, ErrorsOfTheLineAreToldIfTheClientWantsThem) {
  Client client;
  const std::vector<ReceivedCharacter> heard{{.byte = 0x41, .parity_error = true}};
  EXPECT_EQ(serial::to_hex(client.port.received(heard)), "41");
  EXPECT_EQ(client.ask({10, 0x04}), "6e 04");
  EXPECT_EQ(serial::to_hex(client.port.received(heard)), "ff fa 2c 6a 04 ff f0 41");
}

TEST(ComPort, PurgeTakesBackWhatIsNotOnTheLineYet) {
  Client client;
  EXPECT_EQ(client.ask({12, 1}), "70 01");
  EXPECT_EQ(client.purges, 0) << "what has come from the line is the client's";
  EXPECT_EQ(client.ask({12, 3}), "70 03");
  EXPECT_EQ(client.purges, 1);
}

TEST(ComPort, CommandsMayComeInPiecesAndAmongData) {
  Client client;
  std::string answers;
  for (const std::uint8_t byte : Bytes{0x10, 0xFF, 0xFA, 0x2C, 0x02, 0x07, 0xFF, 0xF0, 0x11}) answers += client.take({byte});
  EXPECT_EQ(answers, "ff fa 2c 66 07 ff f0");
  EXPECT_EQ(serial::to_hex(client.sent), "10 11");
}

TEST(ComPort, AnEndlessCommandIsRefused) {
  Client client;
  client.take({0xFF, 0xFA});
  client.take(Bytes(1000, 0x2C));
  EXPECT_NE(client.port.error().find("not RFC 2217"), std::string::npos);
}

}  // namespace
}  // namespace s7200::tools::com_port_test
