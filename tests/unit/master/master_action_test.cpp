#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>

#include "serial_sim/modbus/request.hpp"
#include "tools/master/action.hpp"
#include "tools/master/statistics.hpp"

namespace s7200::tools {
namespace {

std::vector<MasterAction> parsed(const std::string& text, const ActionRules& rules = {}) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return parse_actions(words, rules);
}

std::string pdu(const std::string& text, const ActionRules& rules = {}) {
  return serial::to_hex(parsed(text, rules).at(0).pdu);
}

std::string refused(const std::string& text, const ActionRules& rules = {}) {
  try {
    parsed(text, rules);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "taken";
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
  const ActionRules coils{.always_15 = true}, registers{.always_16 = true};
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
  EXPECT_EQ(parsed("loopback")[0].kind, MasterAction::Kind::Loopback);
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
  EXPECT_EQ(serial::to_hex(actions[6].frame), "02 03");
  EXPECT_EQ(serial::to_hex(parsed("raw 010300000001", {.crc = true})[0].frame), "01 03 00 00 00 01 84 0a");
}

TEST(MasterAction, ReadsAreNotBroadcast) {
  const ActionRules all{.station = 0};
  EXPECT_NE(refused("read 40001", all).find("none of them answers a broadcast: function 3 (read holding registers)"),
            std::string::npos);
  for (const char* text :
       {"read 00001", "read 10001", "read 30001", "exception-status", "slave-id", "loopback", "read-file 1:0:1"})
    EXPECT_NE(refused(text, all), "taken") << text;
  for (const char* text : {"write 00001=on", "write 40001=1", "write 00001=on,on", "write 40001=1,2", "write-file 1:0=1"}) {
    EXPECT_EQ(refused(text, all), "taken") << text;
    EXPECT_FALSE(parsed(text, all)[0].answer_expected) << text;
  }
  EXPECT_FALSE(parsed("read 40001", {.station = 0, .beyond_limits = true})[0].answer_expected);
  EXPECT_TRUE(parsed("read 40001")[0].answer_expected);
  EXPECT_FALSE(parsed("diagnostics 4")[0].answer_expected);
}

TEST(MasterAction, InputsAreNotWritten) {
  EXPECT_EQ(refused("write 10001=on"), "write 10001=on: inputs can only be read");
  EXPECT_EQ(refused("write input-registers 0=1"), "write input-registers 0=1: input registers can only be read");
}

TEST(MasterAction, LimitsOfTheSpecificationCanBeExceededOnPurpose) {
  const ActionRules beyond{.beyond_limits = true};
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
  EXPECT_EQ(range_text({modbus::Area::HoldingRegisters, 10}, 1), "holding register 10");
  EXPECT_EQ(range_text({modbus::Area::Coils, 0}, 8), "coils 0…7");
}

TEST(ExchangeStatistics, CountsVerdictsAndMeasuresWhatAnswered) {
  ExchangeStatistics statistics;
  EXPECT_FALSE(statistics.latency());
  for (int i = 1; i <= 200; ++i) statistics.add(modbus::Verdict::Right, i * kMillisecond);
  EXPECT_FALSE(statistics.any_failed());
  statistics.add(modbus::Verdict::Silent, {});
  statistics.add(modbus::Verdict::Exception, kSecond);
  statistics.add_retry();
  EXPECT_TRUE(statistics.any_failed());
  EXPECT_EQ(statistics.sent(), 202U);
  EXPECT_EQ(statistics.count(modbus::Verdict::Silent), 1U);
  const auto latency = statistics.latency();
  ASSERT_TRUE(latency);
  EXPECT_EQ(latency->least, kMillisecond);
  EXPECT_EQ(latency->most, kSecond);
  EXPECT_EQ(latency->mean, (201 * 100 * kMillisecond + kSecond) / 201);
  EXPECT_EQ(latency->p99, 199 * kMillisecond);  // the 199th of 201
  EXPECT_EQ(statistics.text(),
            "202 requests: 200 right, 1 exception, 1 silent, 0 wrong, 1 repeated\n"
            "latency: least 1 ms, mean 104.975 ms, p99 199 ms, most 1 s\n");
}

}  // namespace
}  // namespace s7200::tools
