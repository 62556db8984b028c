#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/ppi_frame.hpp"
#include "interpreter/base/word_bytes.hpp"
#include "interpreter/model/s7_pdu.hpp"
#include "serial_sim/line/frame.hpp"
#include "tools/master/protocol.hpp"
#include "tools/master/statistics.hpp"

namespace s7200::tools::master_action_test {
namespace {

std::vector<MasterAction> parsed(const std::string& text, const ProtocolUse& use = {},
                                 const Protocol& protocol = modbus_protocol()) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return protocol.actions(words, use);
}

std::string frame(const MasterAction& action) { return serial::to_hex(action.request->frame()); }

/// Without station and CRC.
std::string pdu(const std::string& text, const ProtocolUse& use = {}) {
  const std::string hex = frame(parsed(text, use).at(0));
  constexpr std::size_t kByte = 3;
  return hex.substr(kByte, hex.size() - 3 * kByte);
}

std::string refused(const std::string& text, const ProtocolUse& use = {}, const Protocol& protocol = modbus_protocol()) {
  try {
    parsed(text, use, protocol);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "taken";
}

bool answer_expected(const std::string& text, const ProtocolUse& use = {}) {
  return !parsed(text, use).at(0).request->turnaround();
}

TEST(MasterAction, TheAddressSelectsTheFunction) {
  EXPECT_EQ(pdu("read 00017:3"), "01 00 10 00 03");
  EXPECT_EQ(pdu("read 10005"), "02 00 04 00 01");
  EXPECT_EQ(pdu("read 40001:125"), "03 00 00 00 7d");
  EXPECT_EQ(pdu("read 465536"), "03 ff ff 00 01");
  EXPECT_EQ(pdu("read 30001:2"), "04 00 00 00 02");
  EXPECT_EQ(pdu("write 00017=on"), "05 00 10 ff 00");
  EXPECT_EQ(pdu("write 40011=-1"), "06 00 0a ff ff");
  EXPECT_EQ(pdu("write 00017=on,off"), "0f 00 10 00 02 01 01");
  EXPECT_EQ(pdu("write 40011=1,2"), "10 00 0a 00 02 04 00 01 00 02");
}

TEST(MasterAction, AnAreaByNameCountsFromZero) {
  EXPECT_EQ(pdu("read coils 0:8"), "01 00 00 00 08");
  EXPECT_EQ(pdu("read inputs 16#10"), "02 00 10 00 01");
  EXPECT_EQ(pdu("read holding 65535"), "03 ff ff 00 01");
  EXPECT_EQ(pdu("read input-registers 10:2"), "04 00 0a 00 02");
  EXPECT_EQ(pdu("write holding 10=5"), "06 00 0a 00 05");
  EXPECT_EQ(refused("read holding"), "read holding: write it as read holding 0, counted from 0");
  EXPECT_EQ(refused("read holding 65536"), "address of holding registers 65536 is not from 0 to 65535");
}

TEST(MasterAction, OverridesAreForTheirKindOnly) {
  const ProtocolUse coils{.given = {{"--always-15", ""}}}, registers{.given = {{"--always-16", ""}}};
  EXPECT_EQ(pdu("write 00001=on", coils), "0f 00 00 00 01 01 01");
  EXPECT_EQ(pdu("write 40001=5", coils), "06 00 00 00 05");
  EXPECT_EQ(pdu("write 00001=on", registers), "05 00 00 ff 00");
  EXPECT_EQ(pdu("write 40001=5", registers), "10 00 00 00 01 02 00 05");
}

TEST(MasterAction, DiagnosisAndFiles) {
  EXPECT_EQ(pdu("exception-status"), "07");
  EXPECT_EQ(pdu("slave-id"), "11");
  EXPECT_EQ(pdu("loopback 16#1234,5"), "08 00 00 12 34 00 05");
  EXPECT_EQ(pdu("diagnostics 11"), "08 00 0b 00 00");
  EXPECT_EQ(pdu("diagnostics 1 16#FF00"), "08 00 01 ff 00");
  EXPECT_EQ(pdu("read-file 4:1:2 3:9:2"), "14 0e 06 00 04 00 01 00 02 06 00 03 00 09 00 02");
  EXPECT_EQ(pdu("write-file 4:7=16#06AF,2"), "15 0b 06 00 04 00 07 00 02 06 af 00 02");
  EXPECT_EQ(pdu("general-read 1:16#203:3"), "14 07 33 00 01 02 03 00 03");
  EXPECT_EQ(pdu("general-write 1:2=255,16#10"), "15 09 33 00 01 00 02 00 02 ff 10");
  EXPECT_EQ(pdu("function 65 0102"), "41 01 02");
  EXPECT_EQ(pdu("function 65"), "41");
  EXPECT_EQ(refused("general-write 1:2=256"), "'1:2=256': 256 is not a byte");
  EXPECT_EQ(refused("read-file 4:1"), "'4:1' is not a reference; write for example 4:1:2");
}

TEST(MasterAction, SeveralAreDoneInTheirOrder) {
  const auto actions = parsed("read 40001 40005:2 station 9 slave-id wait 250ms raw 01 0203");
  ASSERT_EQ(actions.size(), 7U);
  EXPECT_EQ(actions[0].text, "read 40001");
  EXPECT_EQ(actions[1].text, "read 40005:2");
  EXPECT_EQ(actions[1].station, 1);
  EXPECT_EQ(actions[3].station, 9);
  EXPECT_EQ(actions[4].duration, 250 * kMillisecond);
  EXPECT_EQ(actions[6].text, "raw 0203");
  EXPECT_EQ(frame(actions[6]), "02 03");
  EXPECT_EQ(frame(parsed("raw 010300000001", {.given = {{"--crc", ""}}})[0]), "01 03 00 00 00 01 84 0a");
}

TEST(MasterAction, ReadsAreNotBroadcast) {
  const ProtocolUse all{.station = 0};
  EXPECT_NE(refused("read 40001", all).find("none of them answers a broadcast: function 3 (read holding registers)"),
            std::string::npos);
  for (const char* text :
       {"read 00001", "read 10001", "read 30001", "exception-status", "slave-id", "loopback", "read-file 1:0:1"})
    EXPECT_NE(refused(text, all), "taken") << text;
  for (const char* text : {"write 00001=on", "write 40001=1", "write 00001=on,on", "write 40001=1,2", "write-file 1:0=1"}) {
    EXPECT_EQ(refused(text, all), "taken") << text;
    EXPECT_FALSE(answer_expected(text, all)) << text;
  }
  EXPECT_FALSE(answer_expected("read 40001", {.station = 0, .given = {{"--beyond-limits", ""}}}));
  EXPECT_TRUE(answer_expected("read 40001"));
  EXPECT_FALSE(answer_expected("diagnostics 4"));
}

TEST(MasterAction, InputsAreNotWritten) {
  EXPECT_EQ(refused("write 10001=on"), "write 10001=on: inputs can only be read");
  EXPECT_EQ(refused("write input-registers 0=1"), "write input-registers 0=1: input registers can only be read");
}

TEST(MasterAction, LimitsOfTheSpecificationCanBeExceededOnPurpose) {
  const ProtocolUse beyond{.given = {{"--beyond-limits", ""}}};
  for (const char* text : {"read 40001:126", "read 40001:0", "read 00001:2001", "read 465536:2", "read-file 0:0:1",
                           "read-file 1:9999:2", "function 0", "function 128"}) {
    EXPECT_NE(refused(text).find("; --beyond-limits sends it all the same"), std::string::npos) << text;
    EXPECT_EQ(refused(text, beyond), "taken") << text;
  }
  std::string many = "write 40001=0";
  for (int i = 0; i < 123; ++i) many += ",0";
  EXPECT_NE(refused(many).find("124 registers in one request"), std::string::npos);
  EXPECT_EQ(refused(many, beyond), "taken");
  for (int i = 0; i < 500; ++i) many += ",0";
  EXPECT_NE(refused(many, beyond).find("1024 is the most that can be sent"), std::string::npos);
}

TEST(MasterAction, WhatIsNoActionIsRefused) {
  for (const char* text : {"",
                           "40001",
                           "frob",
                           "read",
                           "write",
                           "write 40001",
                           "write 40001=",
                           "read 40001:",
                           "read 40001:x",
                           "read 40000",
                           "loopback 1 2",
                           "slave-id 1",
                           "diagnostics",
                           "diagnostics x",
                           "diagnostics 65536",
                           "station",
                           "station 248",
                           "station -1",
                           "wait 5",
                           "raw",
                           "raw 0",
                           "raw xy",
                           "function 256",
                           "function 1 0p",
                           "function 1 01p",
                           "write-file 1:1",
                           "write-file 1=1",
                           "general-read 1:1"})
    EXPECT_NE(refused(text), "taken") << text;
}

TEST(MasterAction, RangesAreNamedAsOnTheWire) {
  EXPECT_EQ(parsed("read 40011")[0].request->subject(), "station 1, function 3, holding register 10");
  EXPECT_EQ(parsed("read 00001:8")[0].request->subject(), "station 1, function 1, coils 0…7");
  EXPECT_EQ(parsed("write 40001=1", {.station = 0})[0].request->subject(), "all stations, function 6, holding register 0");
  EXPECT_EQ(parsed("raw 01")[0].request->subject(), "");
}

TEST(MasterAction, LoopbackSendsAnotherWordEachTime) {
  const auto actions = parsed("loopback loopback");
  EXPECT_EQ(frame(actions[0]).substr(0, 17), "01 08 00 00 34 12") << "as NLAM-B58, 4.5, has it";
  EXPECT_EQ(frame(actions[1]).substr(0, 17), "01 08 00 00 34 13");
  EXPECT_EQ(frame(actions[0]).substr(0, 17), "01 08 00 00 34 14");
}

std::string pc_frame(const std::string& text, const ProtocolUse& use = {.station = 2}) {
  return frame(parsed(text, use, freeport_pc_protocol()).at(0));
}

std::string pc_refused(const std::string& text) { return refused(text, {.station = 2}, freeport_pc_protocol()); }

// The commands of fp-02, fp-03 and fp-17 of the reference.
TEST(FreeportPcAction, ReadsAndWritesAreCommandsOf33Characters) {
  EXPECT_EQ(pc_frame("read VB1000:8"),
            "67 05 30 32 30 38 30 30 30 33 45 38 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 37 31 47");
  EXPECT_EQ(pc_frame("write VB1000=16#5A"),
            "67 06 30 32 30 38 30 30 30 33 45 38 30 32 35 41 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 34 47");
  EXPECT_EQ(pc_frame("read QB0"),
            "67 05 30 32 30 31 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 36 47");
  EXPECT_EQ(pc_frame("write vb1000=90"), pc_frame("write VB1000=2#0101_1010"));
}

TEST(FreeportPcAction, SeveralAreDoneInTheirOrder) {
  const auto actions =
      parsed("read VB0:2 MB8 station 3 write QB0=1,-1 wait 5ms raw 67", {.station = 2}, freeport_pc_protocol());
  ASSERT_EQ(actions.size(), 6U);
  EXPECT_EQ(actions[0].request->subject(), "station 2, VB0…1");
  EXPECT_EQ(actions[1].text, "read MB8");
  EXPECT_EQ(actions[1].request->subject(), "station 2, MB8");
  EXPECT_EQ(actions[3].request->subject(), "station 3, QB0…1");
  EXPECT_EQ(actions[5].kind, MasterAction::Kind::Raw);
  EXPECT_EQ(frame(actions[5]), "67");
}

TEST(FreeportPcAction, WhatTheProtocolCannotCarryIsRefused) {
  EXPECT_EQ(pc_refused("read VW0"), "'VW0' is not a byte of I, Q, M or V; write for example VB100");
  EXPECT_EQ(pc_refused("read VB0:9"), "count 9 is not from 1 to 8");
  EXPECT_EQ(pc_refused("read VB0:0"), "count 0 is not from 1 to 8");
  EXPECT_EQ(pc_refused("read VB65530:8"), "read VB65530:8: the bytes run past 65535");
  EXPECT_EQ(pc_refused("write VB0=1,2,3,4,5,6,7,8,9"), "write VB0=1,2,3,4,5,6,7,8,9: 9 bytes; a command writes 8 at most");
  EXPECT_EQ(pc_refused("write VB0=256"), "value 256 is not from -128 to 255");
  EXPECT_EQ(pc_refused("write VB0"), "'VB0': a value is missing; write for example VB100=65");
  EXPECT_EQ(pc_refused("slave-id"), "'slave-id' is not an action; there are read, write, raw, station, wait");
  EXPECT_EQ(pc_refused(""), "nothing to do: give actions, for example read VB100:4");
  for (const char* text : {"read", "read VB0:", "write VB0=", "write VB0=1,", "raw 0", "station 256", "wait 5"})
    EXPECT_NE(pc_refused(text), "taken") << text;
}

TEST(FreeportPcAction, AnAnswerIsJudgedWithTheEndCharacterThatWasAgreed) {
  const auto parse = [](const std::string& hex) { return serial::bytes_of(serial::parse_hex_frame(hex).frame); };
  const Bytes response = parse("67 01 30 31 32 33 34 35 36 37 38 39 41 42 43 44 45 46 30 36 1A");
  const auto judged = [&](const ProtocolUse& use) {
    const auto request = parsed("read VB1000:2", use, freeport_pc_protocol()).at(0).request;
    return request->judge(serial::bytes_of(request->frame()), response);
  };
  EXPECT_EQ(judged({.station = 2}).fault, "end character 16#1A, expected 16#26; --end-character 16#1A would take it");
  const serial::Answer right = judged({.station = 2, .given = {{"--end-character", "26"}}});
  EXPECT_EQ(right.verdict, serial::Verdict::Right);
  EXPECT_EQ(right.values, (std::vector<std::uint16_t>{0x01, 0x23}));
  EXPECT_EQ(judged({.station = 2, .given = {{"--end-character", "16#1A"}}}).verdict, serial::Verdict::Right);
}

/// What a station answers to a PDU, after it has accepted the request; the PDU stands between an answer's delimiters.
serial::Answer judged_ppi(const std::string& action, const Bytes& pdu) {
  const auto request = parsed(action, {.station = 2}, ppi_protocol()).at(0).request;
  const Bytes sent = serial::bytes_of(request->frame());
  Bytes response{ppi::kAccepted};
  if (!pdu.empty()) {
    const Bytes reply = ppi::to_frame({0, 2, ppi::kData, pdu});
    response.insert(response.end(), reply.begin(), reply.end());
  }
  return request->judge(sent, response);
}

TEST(PpiAction, AStationIsPolledForASecondHoweverManyPollsThatTakes) {
  const auto request = parsed("write VB0=1", {.station = 2}, ppi_protocol()).at(0).request;
  const Bytes sent = serial::bytes_of(request->frame()), accepted{ppi::kAccepted};
  for (Time elapsed = 0; elapsed <= kSecond; elapsed += kMillisecond)
    ASSERT_TRUE(request->next(accepted, elapsed)) << elapsed;
  EXPECT_FALSE(request->next(accepted, kSecond + kMillisecond));
  EXPECT_EQ(request->judge(sent, accepted).fault, "accepted, but no answer within 1 s");
}

TEST(PpiAction, ATimerIsWrittenFrom0To32767) {
  EXPECT_EQ(parsed("write T37=32767", {.station = 2}, ppi_protocol()).size(), 1U);
  EXPECT_EQ(parsed("write C5=-5", {.station = 2}, ppi_protocol()).size(), 1U) << "a counter counts down too";
  for (const char* const wrong : {"write T37=40000", "write T37=-1", "write T37=5,32768"})
    EXPECT_THROW(parsed(wrong, {.station = 2}, ppi_protocol()), std::invalid_argument) << wrong;
}

TEST(PpiAction, StationsAreFrom0To126) {
  EXPECT_EQ(parsed("read VB0", {.station = 126}, ppi_protocol()).size(), 1U);
  EXPECT_THROW(parsed("read VB0", {.station = 127}, ppi_protocol()), std::invalid_argument);
}

TEST(PpiAction, AValueIsForcedAsInPublishedRequests) {
  const auto sent = [](const std::string& action) {
    return serial::bytes_of(parsed(action, {.station = 2}, ppi_protocol()).at(0).request->frame());
  };
  EXPECT_EQ(
      sent("force Q0.0=1"),
      ppi::to_frame({2, 0, ppi::kRequestFunction,
                     Bytes{0x32, 7,    0,    0,    0,    1, 0, 0x0C, 0, 0x12, 0, 1, 0x12, 8,    0x12, 0x48, 0x0B, 0, 0, 0, 0,
                           0,    0xFF, 0x09, 0x00, 0x0E, 0, 1, 0x10, 1, 0,    1, 0, 0,    0x82, 0,    0,    0,    1, 0}}));
  EXPECT_EQ(sent("unforce VD228"), ppi::to_frame({2, 0, ppi::kRequestFunction,
                                                  Bytes{0x32, 7,    0,    0,    0, 1, 0, 0x0C, 0,    0x10, 0,    1,    0x12,
                                                        8,    0x12, 0x48, 0x0B, 0, 0, 0, 0,    0,    0xFF, 0x09, 0x00, 0x0C,
                                                        1,    1,    0x10, 6,    0, 1, 0, 1,    0x84, 0,    0x07, 0x20}}));
  for (const char* const wrong : {"force Q0.0", "force VB0=1,2", "force Q0.0=2", "unforce VB0:2", "force AC0=1"})
    EXPECT_THROW(parsed(wrong, {.station = 2}, ppi_protocol()), std::invalid_argument) << wrong;
}

TEST(PpiAction, TheReturnCodeOfAForcedValueIsItsAnswer) {
  const auto answered = [](const Bytes& list) {
    return judged_ppi("force Q0.0=1",
                      s7::pdu(s7::kUserData, 1, s7::parameters_of({.group = 8, .service = 0x0B, .is_answer = true}),
                              s7::data_of_list(list)));
  };
  EXPECT_EQ(answered({0, 1, 0xFF}).verdict, serial::Verdict::Right);
  EXPECT_EQ(answered({0, 1, 0x03}).exception, 0x03);
  EXPECT_EQ(answered({}).fault, "no return code");
}

TEST(PpiAction, AnAcceptanceAloneIsNoStatus) {
  const serial::Answer answer = judged_ppi("status", {});
  EXPECT_EQ(answer.verdict, serial::Verdict::Wrong);
  EXPECT_EQ(answer.fault, "accepted, but no status");
}

TEST(PpiAction, AnAnswerOfUserDataIsOfTheGroupAndServiceThatWereAskedFor) {
  const auto answered = [](const std::string& action, std::uint8_t group, std::uint8_t service, const Bytes& data,
                           std::uint8_t error = 0) {
    Bytes pdu{0x32, 7, 0, 0, 0, 1, 0, 12, 0, low_byte(data.size())};
    const Bytes parameters{0, 1, 0x12, 8, 0x12, group, service, 0, 0, 0, error, 4};
    pdu.insert(pdu.end(), parameters.begin(), parameters.end());
    if (error == 0) pdu[21] = 0;
    pdu.insert(pdu.end(), data.begin(), data.end());
    return judged_ppi(action, pdu);
  };
  const Bytes time{0xFF, 9, 0, 10, 0, 0x20, 0x26, 0x11, 0x22, 0x15, 0x45, 0x30, 0, 1}, none{0x0A, 0, 0, 0};
  const std::string set = "set-clock 2026-11-22T15:45:30",
                    other = "not the answer to this request: another group or service";
  EXPECT_EQ(answered("clock", 0x87, 1, time).verdict, serial::Verdict::Right);
  EXPECT_EQ(answered(set, 0x87, 2, none).verdict, serial::Verdict::Right);
  EXPECT_EQ(answered("clock", 0x84, 1, time).fault, other);
  EXPECT_EQ(answered(set, 0x87, 1, none).fault, other);
  EXPECT_EQ(answered("clock", 0x87, 1, none).fault, "no time in it: 4 bytes of data");
  EXPECT_EQ(answered("clock", 0x87, 1, none, 0x87).exception, 0x8704);
  EXPECT_EQ(judged_ppi("clock", {0x32, 7, 0, 0, 0, 1, 0, 0, 0, 0}).fault, other) << "no parameters";
}

TEST(Protocols, EachHasANameOfItsOwnAndHelp) {
  for (const Protocol* protocol : protocols()) {
    EXPECT_EQ(find_protocol(protocol->name), protocol);
    EXPECT_NE(protocols_help().find(protocol->actions_help), std::string::npos);
    EXPECT_FALSE(protocol->actions_help.empty());
    for (const ProtocolOption& option : protocol->options)
      EXPECT_EQ(option.value.empty(), option.check == nullptr) << option.name;
  }
  EXPECT_EQ(find_protocol("frob"), nullptr);
}

TEST(ExchangeStatistics, CountsVerdictsAndMeasuresWhatAnswered) {
  ExchangeStatistics statistics;
  EXPECT_FALSE(statistics.latency());
  for (int i = 1; i <= 200; ++i) statistics.add(serial::Verdict::Right, i * kMillisecond);
  EXPECT_FALSE(statistics.any_failed());
  statistics.add(serial::Verdict::Silent, {});
  statistics.add(serial::Verdict::Exception, kSecond);
  statistics.add_retry();
  EXPECT_TRUE(statistics.any_failed());
  EXPECT_EQ(statistics.sent(), 202U);
  EXPECT_EQ(statistics.count(serial::Verdict::Silent), 1U);
  const auto latency = statistics.latency();
  ASSERT_TRUE(latency);
  EXPECT_EQ(latency->least, kMillisecond);
  EXPECT_EQ(latency->most, kSecond);
  EXPECT_EQ(latency->mean, (201 * 100 * kMillisecond + kSecond) / 201);
  EXPECT_EQ(latency->p99, 199 * kMillisecond);  // the 199th of 201
  EXPECT_EQ(statistics.text("exception"),
            "202 requests: 200 right, 1 exception, 1 silent, 0 wrong, 1 repeated\n"
            "latency: least 1 ms, mean 104.975 ms, p99 199 ms, most 1 s\n");
}

}  // namespace
}  // namespace s7200::tools::master_action_test
