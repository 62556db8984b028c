#include <gtest/gtest.h>

#include <set>
#include <sstream>
#include <stdexcept>

#include "serial_sim/line/frame.hpp"
#include "tools/master/protocol.hpp"

namespace s7200::tools::westinghouse_master_test {
namespace {

std::vector<MasterAction> parsed(const Protocol& protocol, const std::string& text,
                                 const ProtocolUse& use = {.station = 5}) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return protocol.actions(words, use);
}

std::string frame(const Protocol& protocol, const std::string& text) {
  return serial::to_hex(parsed(protocol, text).at(0).request->frame());
}

Bytes bytes(const std::string& hex) { return serial::bytes_of(serial::parse_hex_frame(hex).frame); }

TEST(WestinghouseMaster, M16AModbusMasterWaitsASecondForAnAnswer) {
  EXPECT_EQ(modbus_protocol().patience.timeout, kSecond);
  EXPECT_EQ(modbus_protocol().patience.retries, 0);
}

TEST(WestinghouseMaster, L10TheLanIsAskedThreeTimesFor500MillisecondsEach) {
  EXPECT_EQ(pc1000_lan_protocol().patience.timeout, 500 * kMillisecond);
  EXPECT_EQ(pc1000_lan_protocol().patience.retries, 2);
}

TEST(WestinghouseMaster, S4ALoaderSessionIsRepeatedTwiceAfter500MillisecondsAndAfterANak) {
  const Patience& patience = pc500_loader_protocol().patience;
  EXPECT_EQ(patience.timeout, 500 * kMillisecond);
  EXPECT_EQ(patience.retries, 2);
  EXPECT_EQ(patience.pause, 500 * kMillisecond);
  EXPECT_TRUE(patience.repeats(0x15));
}

TEST(WestinghouseMaster, H9AnHppcIsResynchronisedAfterSilenceAndALinkErrorAndAskedAgainTwice) {
  const Patience& patience = hppc_protocol().patience;
  EXPECT_EQ(patience.timeout, kSecond);
  EXPECT_EQ(patience.retries, 2);
  EXPECT_EQ(patience.pause, 500 * kMillisecond);
  EXPECT_EQ(serial::to_hex(patience.first({})), "0c 00 20 40 00 0c 00 00 00 00 2b e8");
  EXPECT_TRUE(patience.repeats(0x01));
  EXPECT_FALSE(patience.repeats(0x10));
}

/// The marks in `text`, as in `[L7]`.
void take_marks(std::string_view text, std::set<std::string>& marks) {
  for (std::size_t open = text.find('['); open != text.npos; open = text.find('[', open + 1))
    marks.emplace(text.substr(open + 1, text.find(']', open) - open - 1));
}

TEST(WestinghouseMaster, EachChoiceOfTheReferenceIsASettingOfAPlcOrAnOptionOfTheMaster) {
  std::set<std::string> marks;
  for (const westinghouse::PlcRow& row : westinghouse::plcs())
    for (const std::string& line : row.settings()) take_marks(line, marks);
  for (const Protocol* protocol : protocols()) take_marks(protocol->choices, marks);
  constexpr std::pair<char, int> kOfReference[]{{'M', 16}, {'L', 10}, {'W', 7}, {'S', 5}, {'H', 10}};
  for (const auto& [letter, last] : kOfReference)
    for (int number = 1; number <= last; ++number) {
      const std::string mark = letter + std::to_string(number);
      EXPECT_TRUE(marks.contains(mark)) << mark;
    }
}

std::string hppc_frame(const std::string& text, std::string_view option, const std::string& word) {
  const ProtocolUse use{.station = 5, .given = {{std::string(option), word}}};
  return serial::to_hex(parsed(hppc_protocol(), text, use).at(0).request->frame());
}

/// Without length, addresses, opcode and frame check.
std::string hppc_operands(const std::string& text, std::string_view option, const std::string& word) {
  const std::string hex = hppc_frame(text, option, word);
  constexpr std::size_t kHead = 18, kCheck = 6;
  return hex.substr(kHead, hex.size() - kHead - kCheck);
}

TEST(WestinghouseMaster, H4AReadWithoutAnAddressIsFromZeroOn) {
  EXPECT_EQ(hppc_operands("read 0:2", "--read-request", "number"), "02");
  EXPECT_EQ(hppc_operands("resync", "--read-request", "number"), "00");
  EXPECT_EQ(serial::to_hex(hppc_protocol().patience.first({.given = {{"--read-request", "number"}}})),
            hppc_frame("resync", "--read-request", "number"));
  for (const char* const words : {"read 16#80000:2", "read-register 1"})
    EXPECT_THROW(hppc_frame(words, "--read-request", "number"), std::invalid_argument) << words;
  EXPECT_EQ(hppc_operands("read 16#80000:2", "--read-request", "address_and_number"), "00 00 08 02");
}

TEST(WestinghouseMaster, H5ABitWriteMayHaveTheMaskBeforeThePattern) {
  EXPECT_EQ(hppc_operands("bits 16#ABFFE=16#F000/16#FF01", "--bit-write", "mask_first"), "fe bf 0a 01 ff 00 f0");
  EXPECT_EQ(hppc_operands("bits 16#ABFFE=16#F000/16#FF01", "--bit-write", "pattern_first"), "fe bf 0a 00 f0 01 ff");
}

TEST(WestinghouseMaster, H6AMonitorMayHaveAddressesOfFourBytes) {
  EXPECT_EQ(hppc_operands("monitor 5 w:16#ABFFE", "--monitor-address-bytes", "4"), "05 00 00 00 01 00 fe bf 0a 00");
  EXPECT_EQ(hppc_operands("monitor 5 w:16#ABFFE", "--monitor-address-bytes", "3"), "05 00 00 00 01 00 fe bf 0a");
}

TEST(WestinghouseMaster, ActionsOfTheLanAreSixByteMessages) {
  const Protocol& lan = pc1000_lan_protocol();
  EXPECT_EQ(frame(lan, "unit 5"), "0a 05 00 00 00 0f");
  EXPECT_EQ(frame(lan, "unit"), "0a 05 00 00 00 0f");
  EXPECT_EQ(frame(lan, "read 16#1234:2"), "05 34 12 03 00 4e");
  EXPECT_EQ(frame(lan, "write 16#4000=16#1234"), "07 00 40 01 00 48 34 12 46");
  EXPECT_EQ(frame(lan, "set 16#0100.15"), "03 00 01 1f 00 23");
  EXPECT_EQ(frame(lan, "reset 16#0100.15"), "03 00 01 0f 00 13");
  EXPECT_EQ(frame(lan, "retest"), "03 05 82 11 00 9b");
  EXPECT_EQ(frame(lan, "erase"), "0f 01 00 00 00 10 c5 3a a3 5c ee 2a e2 ae 2a ee ae e2 c5 3a a3 5c");
  EXPECT_TRUE(parsed(lan, "unit 5")[0].request->with_sync());
  EXPECT_FALSE(parsed(lan, "unit 5", {.station = 5, .given = {{"--no-sync", ""}}})[0].request->with_sync());
}

TEST(WestinghouseMaster, OnTheLanAStationThatIsNotTheAddressedUnitIsRefused) {
  const Protocol& lan = pc1000_lan_protocol();
  const auto refused = [&](const std::string& words) {
    try {
      parsed(lan, words);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused("unit 5 station 6 read 0"), "read 0: station 6 is not addressed, unit 5 is; put 'unit 6' before it");
  EXPECT_EQ(refused("station 6 erase"), "erase: station 6 is not addressed; put 'unit 6' before it");
  for (const char* const words : {"unit 5 station 5 read 0", "unit 5 station 6 unit read 0", "station 6 unit 7 read 0",
                                  "read 0", "station 6 raw 0503"})
    EXPECT_EQ(refused(words), "") << words;
}

TEST(WestinghouseMaster, ActionsOfWestnetAreCommandsOfTheHighway) {
  const Protocol& westnet = westnet_protocol();
  EXPECT_EQ(frame(westnet, "address 17"), "09 00 00 11 00 1a");
  EXPECT_EQ(frame(westnet, "address 17.1"), "09 00 00 11 01 1b");
  EXPECT_EQ(frame(westnet, "remote"), "09 01 00 00 00 0a");
  EXPECT_EQ(frame(westnet, "status"), "09 02 00 00 00 0b");
  EXPECT_EQ(frame(westnet, "open"), "09 03 00 00 00 0c");
  EXPECT_EQ(frame(westnet, "close"), "09 04 00 00 00 0d");
  EXPECT_EQ(frame(westnet, "session"), "09 05 00 00 00 0e");
  EXPECT_EQ(frame(westnet, "local"), "09 06 00 00 00 0f");
  EXPECT_FALSE(parsed(westnet, "read 0")[0].request->with_sync());
}

TEST(WestinghouseMaster, ALoaderSessionIsSentStepByStep) {
  const auto request = parsed(pc500_loader_protocol(), "write QB0=16#7F,16")[0].request;
  EXPECT_EQ(serial::to_hex(request->frame()), "02");
  const auto next = [&](const std::string& answer) {
    const auto step = request->next(bytes(answer), 0);
    return step ? serial::to_hex(*step) : "none";
  };
  EXPECT_EQ(next("10 06"), "03");
  EXPECT_EQ(next("02"), "10 06");
  EXPECT_EQ(next("16 10 03"), "10 06 ef 80 7f 10 10 10 04");
  EXPECT_EQ(next("10 06 02"), "10 06");
  EXPECT_TRUE(request->answered());
  EXPECT_EQ(next("12 10 03"), "10 06");
  EXPECT_FALSE(request->answered());
  request->frame();
  EXPECT_EQ(next("10 15"), "none");
}

TEST(WestinghouseMaster, ABlockThatIsShorterThanItsHeaderIsWrong) {
  const auto judged = [](const std::string& length) {
    const auto request = parsed(pc500_loader_protocol(), "block 1")[0].request;
    const Bytes response =
        bytes("10 06 02 16 10 03 10 06 02 00 40 00 70 70 01 01 00 00 00 00 " + length + " 10 03 02 12 10 03");
    return request->judge({}, response);
  };
  EXPECT_EQ(judged("00 07").fault, "");
  EXPECT_EQ(judged("00 00").fault, "a block of 0 words: its header alone has 5");
}

TEST(WestinghouseMaster, RegistersOfAnHppcAreWhereItsParameterTableSays) {
  const auto request = parsed(hppc_protocol(), "read-register 2")[0].request;
  EXPECT_EQ(serial::to_hex(request->frame()), "09 00 20 40 00 0d 34 bc a1");
  const std::string table =
      "3f 00 40 00 00 0d 00 00 08 8a 00 56 04 08 00 6a 06 08 00 80 08 08 00 02 0c 08 00 02 0c 08 00 40 00 00 00 00 00 10 01 "
      "82 0c 08 "
      "00 03 00 00 00 85 0c 08 00 03 00 00 00 fe bf 0a 00 00 08 6d eb";
  const auto read = request->next(bytes(table), 0);
  ASSERT_TRUE(read);
  EXPECT_EQ(serial::to_hex(*read).substr(0, 29), "0c 00 20 40 00 0c fc bf 0a 02");
  EXPECT_FALSE(request->next(bytes(table), 0));
  const auto beyond = parsed(hppc_protocol(), "read-register 2049")[0].request;
  const serial::Answer answer = beyond->judge(serial::bytes_of(beyond->frame()), bytes(table));
  EXPECT_EQ(answer.fault, "by the parameter table there are 2048 holding registers");
  EXPECT_TRUE(answer.lasting) << "it is not asked again";
}

TEST(WestinghouseMaster, AModbusSlaveOfThisMakeMayBeAnyStationUpTo255) {
  EXPECT_EQ(modbus_protocol().actions({"read", "40001"}, {.station = 255, .of_another_make = true})[0].station, 255);
  EXPECT_THROW(modbus_protocol().actions({"read", "40001"}, {.station = 255}), std::invalid_argument);
}

TEST(WestinghouseMaster, ActionsOfAnHppcAreItsOpcodes) {
  const Protocol& hppc = hppc_protocol();
  EXPECT_EQ(frame(hppc, "read 16#80002:2"), "0c 00 20 40 00 0c 02 00 08 02 6f 2f");
  EXPECT_EQ(frame(hppc, "write 16#ABFFC=16#E8,3"), "0e 00 20 40 00 0b fc bf 0a 02 e8 03 c7 bf");
  EXPECT_EQ(frame(hppc, "bits 16#ABFFA=16#8001/16#800F"), "0f 00 20 40 00 0a fa bf 0a 01 80 0f 80 c8 cd");
  EXPECT_EQ(frame(hppc, "monitor w:16#ABFFE d:16#ABFFA"), "14 00 20 40 00 09 00 00 00 00 01 01 fe bf 0a fa bf 0a 23 fc");
  EXPECT_EQ(frame(hppc, "parameters 0"), "09 00 20 40 00 0d 00 ca 76");
  EXPECT_EQ(frame(hppc, "parameters 255"), "09 00 20 40 00 0d ff d4 86");
  EXPECT_EQ(frame(hppc, "resync"), "0c 00 20 40 00 0c 00 00 00 00 2b e8");
}

}  // namespace
}  // namespace s7200::tools::westinghouse_master_test
