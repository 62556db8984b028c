#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "serial_sim/faults/fault.hpp"
#include "serial_sim/line/frame.hpp"
#include "serial_sim/line/frame_splitter.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/westinghouse/hppc_plc.hpp"
#include "serial_sim/westinghouse/lan_plc.hpp"
#include "serial_sim/westinghouse/loader_plc.hpp"
#include "serial_sim/westinghouse/modbus_plc.hpp"
#include "serial_sim/westinghouse/westnet_plc.hpp"
#include "tests/unit/serial_sim/westinghouse_bench.hpp"

namespace s7200::westinghouse::westinghouse_modbus_test {
namespace {

const std::string kReference = "../shared/reference/westinghouse_vectors.txt";

TEST(WestinghouseModbus, EveryExchangeOfTheReferenceHolds) {
  const std::string text = text_of(kReference);
  if (text.empty()) GTEST_SKIP() << "there is no " << kReference;
  EXPECT_EQ(play_file(text, "modbus"), 21);
}

TEST(WestinghouseModbus, OurOwnExchangesHold) {
  EXPECT_GT(play_file(text_of("tests/exchanges/westinghouse.txt"), "modbus"), 0);
}

/// A request of slave 1 with its CRC, and what it is answered without address and CRC: `03 02 12 34`.
std::string asked(Bench& bench, const std::string& pdu, std::uint8_t station = 1) {
  Bytes bytes = serial::bytes_of(serial::parse_hex_frame(pdu).frame);
  bytes = modbus::rtu_frame(station, bytes);
  const std::string answer = bench.ask(serial::to_hex(bytes));
  return answer.empty() ? "" : answer.substr(3, answer.size() - 9);
}

std::string asked(const std::string& settings, const std::string& pdu) {
  Bench bench("modbus", settings);
  return asked(bench, pdu);
}

// Which functions a model has: all others are exception 01.
TEST(WestinghouseModbus, EachModelHasTheFunctionsOfItsRow) {
  const std::map<std::string, std::vector<int>> rows{{"pc503", {1, 2, 3, 5, 6, 8, 15, 16}},
                                                     {"pc1200", {1, 2, 3, 4, 5, 6, 7, 8, 15, 16, 17, 20, 21}},
                                                     {"pc1250", {1, 2, 3, 4, 5, 6, 7, 8, 15, 16, 17, 20, 21}},
                                                     {"pc2000", {1, 2, 3, 4, 5, 6, 8, 16}},
                                                     {"ncmz", {1, 2, 3, 4, 5, 6, 7, 8, 16}},
                                                     {"hppc", {1, 2, 3, 4, 5, 6, 8, 15, 16}}};
  for (const auto& [model, functions] : rows) {
    Bench bench("modbus", "plc=" + model);
    for (int function = 1; function < 128; ++function) {
      const bool there = std::ranges::find(functions, function) != functions.end();
      const std::string illegal = fmt::format("{:02x} 01", function | 0x80);
      const std::string found = asked(bench, fmt::format("{:02x} 00 00 00 01", function));
      EXPECT_EQ(found != illegal, there) << model << ", function " << function << ": " << found;
    }
  }
}

TEST(WestinghouseModbus, M1Function7FollowsSection422UnlessSection41IsAskedFor) {
  EXPECT_EQ(asked("plc=ncmz", "07"), "07 00");
  EXPECT_EQ(asked("plc=hppc", "07"), "87 01");
  EXPECT_EQ(asked("plc=ncmz function_7=section41", "07"), "87 01");
  EXPECT_EQ(asked("plc=hppc function_7=section41", "07"), "07 00");
  EXPECT_EQ(asked("plc=pc1200 function_7=section41", "07"), "07 00");
}

TEST(WestinghouseModbus, M2TheLineIs9600Baud8N1AndAFrameEndsWith3Point5CharactersOfSilence) {
  Bench bench("modbus");
  EXPECT_EQ(bench.plc().format(), (SerialFormat{9600, 8, Parity::None, 1}));
  const auto latency = [](Bench& one) {
    asked(one, "07");
    return *one.master().requester().exchange().latency();
  };
  const SerialFormat line = bench.plc().format();
  EXPECT_NEAR(static_cast<double>(latency(bench)), static_cast<double>(line.silence()), 1000);
  Bench patient("modbus", "silence=100");
  EXPECT_NEAR(static_cast<double>(latency(patient)), static_cast<double>(10 * line.character_time()), 1000);
  Bench fast("modbus", "baud=19200 parity=even");
  EXPECT_EQ(fast.plc().format(), (SerialFormat{19200, 8, Parity::Even, 1}));
  EXPECT_EQ(asked(fast, "07"), "07 00");
}

TEST(WestinghouseModbus, M3OnlyFunctions5And6And16AreCarriedOutForAll) {
  Bench bench("modbus");
  for (const char* const pdu : {"05 00 00 ff 00", "06 00 01 00 02", "10 00 02 00 01 02 00 03", "0f 00 08 00 01 01 01",
                                "15 09 33 00 00 00 0a 00 02 11 22", "03 00 00 00 01", "63"})
    EXPECT_EQ(asked(bench, pdu, 0), "");
  EXPECT_EQ(bench.fault_of("CR1=1 HR2=2,3 CR9=0 HR6=0"), "");
  Bench writes("modbus", "broadcasts=writes");
  asked(writes, "0f 00 08 00 01 01 01", 0);
  asked(writes, "15 09 33 00 00 00 0a 00 02 11 22", 0);
  EXPECT_EQ(writes.fault_of("CR9=1 HR6=2211"), "");
}

TEST(WestinghouseModbus, M4NcmzHasTheRegistersOfTheOthersUnlessItsPresetReachesAllMemory) {
  EXPECT_EQ(asked("plc=ncmz", "06 08 00 00 01"), "86 02");
  Bench bench("modbus", "plc=ncmz ncmz_preset=memory");
  EXPECT_EQ(asked(bench, "06 12 34 00 01"), "06 12 34 00 01");
  EXPECT_EQ(bench.fault_of("W[1234]=1"), "");
  EXPECT_EQ(asked("plc=pc1200 ncmz_preset=memory", "06 08 00 00 01"), "86 02");
}

TEST(WestinghouseModbus, M5Function7ShowsCoils1017To1024WithTheFirstInBit0) {
  EXPECT_EQ(asked("CR1017=1,0,0,0,0,0,0,1", "07"), "07 81");
  EXPECT_EQ(asked("status_coil=1 CR1=0,1", "07"), "07 02");
}

TEST(WestinghouseModbus, M6ALoopbackOfAnotherLengthIsNotAnswered) {
  EXPECT_EQ(asked("", "08 00 01 12 34"), "08 00 01 12 34");
  EXPECT_EQ(asked("", "08 00 04 00 00"), "08 00 04 00 00");
  EXPECT_EQ(asked("", "08 00 00"), "");
  EXPECT_EQ(asked("", "08 00 00 12 34 56"), "");
  EXPECT_EQ(asked("loopback_length=refused", "08 00 00"), "88 03");
}

TEST(WestinghouseModbus, M7QuantitiesGoUpTo125And2000And1968) {
  const std::string enough = "coils=4000 inputs=4000";
  EXPECT_EQ(asked("", "03 00 00 00 7d").substr(0, 5), "03 fa");
  EXPECT_EQ(asked("", "03 00 00 00 7e"), "83 03");
  EXPECT_EQ(asked("", "04 00 00 00 00"), "84 03");
  EXPECT_EQ(asked(enough, "01 00 00 07 d0").substr(0, 5), "01 fa");
  EXPECT_EQ(asked(enough, "01 00 00 07 d1"), "81 03");
  EXPECT_EQ(asked(enough, "02 00 00 07 d1"), "82 03");
  EXPECT_EQ(asked("most_read_bits=8", "01 00 00 00 09"), "81 03");
  const auto coils = [](int count) {
    std::string pdu = fmt::format("0f 00 00 {:02x} {:02x} {:02x}", count / 256, count % 256, (count + 7) / 8);
    for (int i = 0; i < (count + 7) / 8; ++i) pdu += " ff";
    return pdu;
  };
  EXPECT_EQ(asked(enough, coils(1968)), "0f 00 00 07 b0");
  EXPECT_EQ(asked(enough, coils(1969)), "8f 03");
  const auto registers = [](int count) {
    std::string pdu = fmt::format("10 00 00 00 {:02x} {:02x}", count, 2 * count);
    for (int i = 0; i < count; ++i) pdu += " 12 34";
    return pdu;
  };
  EXPECT_EQ(asked("", registers(125)), "10 00 00 00 7d");
  EXPECT_EQ(asked("", registers(126)), "90 03");
}

TEST(WestinghouseModbus, M8TheFunctionIsCheckedBeforeTheQuantityAndThatBeforeTheAddress) {
  EXPECT_EQ(asked("", "03 ff ff 00 7e"), "83 03");
  EXPECT_EQ(asked("checks=address_first", "03 ff ff 00 7e"), "83 02");
  EXPECT_EQ(asked("", "05 ff ff 12 34"), "85 03");
  EXPECT_EQ(asked("", "10 00 00 00 01 04 00 01"), "90 03");
  EXPECT_EQ(asked("", "05 04 00 ff 00"), "85 02");
  EXPECT_EQ(asked("exception=06", "03 00 00 00 01"), "83 06");
  EXPECT_EQ(asked("exception=06", "08 00 00 12 34"), "88 06");
  EXPECT_EQ(asked("exception=04", "03 ff ff 00 01"), "83 02");
  EXPECT_EQ(asked("exception=04", "63"), "e3 01");
}

TEST(WestinghouseModbus, M9AddressesCountFromZero) {
  EXPECT_EQ(asked("HR1=1234", "03 00 00 00 01"), "03 02 12 34");
  EXPECT_EQ(asked("HR1=1234 first_address=1", "03 00 01 00 01"), "03 02 12 34");
  EXPECT_EQ(asked("first_address=1", "03 00 00 00 01"), "83 02");
}

TEST(WestinghouseModbus, M10TheTablesHave1024And1024And256And2048Entries) {
  const std::vector<std::pair<std::string, std::string>> last_and_next{{"01 03 ff 00 01", "01 04 00 00 01"},
                                                                       {"02 03 ff 00 01", "02 04 00 00 01"},
                                                                       {"04 00 ff 00 01", "04 01 00 00 01"},
                                                                       {"03 07 ff 00 01", "03 08 00 00 01"}};
  for (const auto& [last, next] : last_and_next) {
    EXPECT_EQ(asked("", last).substr(0, 2), last.substr(0, 2));
    EXPECT_EQ(asked("", next).substr(3), "02");
  }
  EXPECT_EQ(asked("input_registers=257", "04 01 00 00 01"), "04 02 00 00");
}

TEST(WestinghouseModbus, M11HoldingRegister1IsWord0OfTheMemory) {
  EXPECT_EQ(asked("W[0000]=1234", "03 00 00 00 01"), "03 02 12 34");
  EXPECT_EQ(asked("holding_word=0100 W[0100]=1234", "03 00 00 00 01"), "03 02 12 34");
  const std::string at_the_end = "holding_word=fffe W[ffff]=1234";
  EXPECT_EQ(asked(at_the_end, "03 00 01 00 01"), "03 02 12 34");
  for (const char* const beyond : {"03 00 01 00 02", "06 00 02 12 34", "10 00 01 00 02 04 00 01 00 02"})
    EXPECT_EQ(asked(at_the_end, beyond).substr(3), "02") << beyond;
}

TEST(WestinghouseModbus, M12TheSlaveIdHasEightBytesWithoutPadding) {
  const std::string settings = "slv_id=12 run=00 mode=02 version=03 err=0405 mode_chg=0607";
  EXPECT_EQ(asked(settings, "11"), "11 08 12 00 02 03 04 05 06 07");
  EXPECT_EQ(asked(settings + " slave_id_order=low_first", "11"), "11 08 12 00 02 03 05 04 07 06");
  EXPECT_EQ(asked(settings + " slave_id_layout=aligned", "11"), "11 09 12 00 02 03 00 04 05 06 07");
}

TEST(WestinghouseModbus, M13Function20AnswersInTheFormOfModbus) {
  EXPECT_EQ(asked("W[0000]=1234", "14 07 33 00 00 00 00 00 02"), "14 04 03 33 34 12");
  EXPECT_EQ(asked("W[0000]=1234 read_answer=plain", "14 07 33 00 00 00 00 00 02"), "14 02 34 12");
  EXPECT_EQ(asked("", "15 09 33 00 00 00 00 00 02 01 02"), "15 09 33 00 00 00 00 00 02 01 02");
}

TEST(WestinghouseModbus, M14SegmentsAre16BytesApartAndBytesAreLowFirst) {
  EXPECT_EQ(asked("W[0008]=1234", "14 07 33 00 01 00 00 00 02"), "14 04 03 33 34 12");
  EXPECT_EQ(asked("W[0080]=1234 segment_bytes=256", "14 07 33 00 01 00 00 00 02"), "14 04 03 33 34 12");
  EXPECT_EQ(asked("W[0000]=1234 memory_order=high_first", "14 07 33 00 00 00 00 00 02"), "14 04 03 33 12 34");
  EXPECT_EQ(asked("W[FFFF]=1234", "14 07 33 10 00 ff ff 00 01"), "14 03 02 33 12");
  EXPECT_EQ(asked("", "14 07 33 10 00 ff ff 00 02"), "94 02");
}

TEST(WestinghouseModbus, M15UpTo244BytesAreReadOrWrittenAtOnce) {
  EXPECT_EQ(asked("", "14 07 33 00 00 00 00 00 f4").substr(0, 5), "14 f6");
  EXPECT_EQ(asked("", "14 07 33 00 00 00 00 00 f5"), "94 03");
  EXPECT_EQ(asked("", "14 07 33 00 00 00 00 00 00"), "94 03");
  EXPECT_EQ(asked("", "14 08 33 00 00 00 00 00 01"), "94 03");
  EXPECT_EQ(asked("", "15 09 33 00 00 00 00 00 01 01 02"), "95 03");
  EXPECT_EQ(asked("", "14 07 06 00 00 00 00 00 01"), "94 02");
  EXPECT_EQ(asked("most_bytes=2", "14 07 33 00 00 00 00 00 03"), "94 03");
}

TEST(WestinghouseModbus, WhatIsMalformedIsNotAnswered) {
  Bench bench("modbus");
  for (const char* const pdu :
       {"03 00 00 00", "03 00 00 00 01 00", "07 00", "11 00", "05 00 00 ff", "10 00 00 00", "14 07 33"})
    EXPECT_EQ(asked(bench, pdu), "") << pdu;
  EXPECT_EQ(bench.ask("01"), "");
  EXPECT_EQ(bench.ask("01 07 41"), "");
  EXPECT_EQ(asked(bench, "07"), "07 00");
}

TEST(WestinghouseModbus, WhatSaysAnotherLengthThanItHasIsAnsweredWithException3) {
  Bench bench("modbus", "HR1=1234");
  for (const char* const rest :
       {"0f 00 00 00 01 01 01 00", "0f 00 00 00 01 01", "10 00 00 00 01 02 00 01 00", "10 00 00 00 01 02 00",
        "14 07 06 00 00 00 00 00 01 00", "15 08 06 00 00 00 00 00 01 01 00"})
    EXPECT_EQ(asked(bench, rest).substr(3), "03") << rest;
  EXPECT_EQ(bench.fault_of("HR1=1234"), "");
}

TEST(WestinghouseModbus, AfterPowerHasBeenOffItHasItsMemory) {
  Bench bench("modbus", "slave=11 HR1=1234");
  bench.lose_power();
  EXPECT_EQ(asked(bench, "03 00 00 00 01", 17), "03 02 12 34");
}

/// The marks behind the fields of a header's settings, `///< [M7]`, by the fields' names.
std::map<std::string, std::set<std::string>> marks_of_fields(const std::string& header) {
  std::map<std::string, std::set<std::string>> marks;
  std::istringstream lines(text_of("serial_sim/westinghouse/" + header));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t end = line.find(';'), comment = line.find("///<");
    if (end == std::string::npos || (comment != std::string::npos && comment < end)) continue;
    std::set<std::string> found;
    static const std::regex kMark(R"(\[([A-Z]\d+)\])"), kName(R"((\w+)(?: = [^,;{]+|\{[^;]*\})?(?=[,;]))");
    for (std::sregex_iterator at(line.begin(), line.end(), kMark), none; at != none; ++at) found.insert((*at)[1]);
    const std::string declared = line.substr(0, end + 1);
    for (std::sregex_iterator at(declared.begin(), declared.end(), kName), none; at != none; ++at)
      marks[(*at)[1]].insert(found.begin(), found.end());
  }
  return marks;
}

/// How many rows have a field of their name; it has their mark.
template <class Plc>
int rows_with_their_marks(std::initializer_list<const char*> headers) {
  std::map<std::string, std::set<std::string>> marks;
  for (const char* const header : headers) marks.merge(marks_of_fields(header));
  int count = 0;
  for (const Setting<Plc>& row : Plc::settings()) {
    const auto field = marks.find(std::string(row.form.name));
    if (field == marks.end()) continue;
    ++count;
    std::set<std::string> expected;
    if (!row.form.choice.empty()) expected.emplace(row.form.choice);
    EXPECT_EQ(field->second, expected) << row.form.name;
  }
  return count;
}

TEST(WestinghouseSetting, AFieldHasTheMarkOfItsRow) {
  EXPECT_EQ(rows_with_their_marks<ModbusPlc>({"modbus_plc.hpp"}), 31);
  EXPECT_EQ(rows_with_their_marks<LanPlc>({"lan_plc.hpp", "pc1000.hpp"}), 16);
  EXPECT_EQ(rows_with_their_marks<WestnetPlc>({"westnet_plc.hpp", "pc1000.hpp"}), 25);
  EXPECT_EQ(rows_with_their_marks<LoaderPlc>({"loader_plc.hpp"}), 8);
  EXPECT_EQ(rows_with_their_marks<HppcPlc>({"hppc_plc.hpp", "messages/hppc_message.hpp"}), 13);
}

TEST(WestinghouseModbus, AnotherAddressIsNotAnswered) {
  Bench bench("modbus", "slave=11");
  EXPECT_EQ(asked(bench, "07", 1), "");
  EXPECT_EQ(asked(bench, "07", 17), "07 00");
  Bench last("modbus", "slave=ff");
  EXPECT_EQ(asked(last, "07", 255), "07 00");
}

TEST(WestinghouseModbus, AGapOf3Point5CharactersInARequestEndsIt) {
  Bench bench("modbus");
  bench.master().requester().start(
      {.frame = serial::parse_hex_frame("01 07 41 e2").frame, .timeout = 60 * kMillisecond, .gap = 4 * kMillisecond},
      bench.system().time());
  EXPECT_TRUE(bench.system().finish_exchange(bench.master()).response.empty());
  EXPECT_EQ(asked(bench, "07"), "07 00");
}

TEST(WestinghouseModbus, AFrameBeyondAnyLengthIsNotAnswered) {
  Bench bench("modbus");
  std::string frame;
  for (int i = 0; i < 400; ++i) frame += "01 ";
  EXPECT_EQ(bench.ask(frame), "");
  EXPECT_EQ(asked(bench, "07"), "07 00");
}

TEST(WestinghouseModbus, FaultsOfTheLineAreMet) {
  Bench bench("modbus");
  bench.line().faults().inject(serial::parse_fault("flip:character=3,bit=5,exchange=1").fault, bench.system().time());
  EXPECT_EQ(asked(bench, "03 00 00 00 01"), "");
  EXPECT_EQ(asked(bench, "03 00 00 00 01"), "03 02 00 00");
  bench.line().faults().inject(serial::parse_fault("flip:of=answer,character=2,bit=0,exchange=1").fault,
                               bench.system().time());
  EXPECT_NE(asked(bench, "03 00 00 00 01"), "03 02 00 00");
}

TEST(WestinghouseModbus, WhoWatchesItsPortHearsBothDirectionsAndAgainAfterASnapshot) {
  Bench bench("modbus", "HR1=1234");
  std::vector<std::string> heard;
  const auto end_of = [&bench](const serial::WireFrame& frame) {
    return frame.driver == bench.station().uart().driver() ? "tx" : "rx";
  };
  serial::FrameSplitter frames([&](const serial::WireFrame& frame) {
    Bytes bytes;
    for (const ReceivedCharacter& character : frame.characters) bytes.push_back(character.byte);
    heard.push_back(fmt::format("{} {}", end_of(frame), serial::to_hex(bytes)));
  });
  bench.station().set_wire_sink(&frames, bench.system().time());
  const auto before = bench.system().snapshot();
  const std::vector<std::string> exchange{"rx 01 03 00 00 00 01 84 0a", "tx 01 03 02 12 34 b5 33"};
  bench.ask("01 03 00 00 00 01 84 0A");
  bench.wait(20 * kMillisecond);
  EXPECT_EQ(heard, exchange);
  bench.system().restore(before);
  heard.clear();
  serial::FrameSplitter again([&](const serial::WireFrame& frame) { heard.emplace_back(end_of(frame)); });
  bench.station().set_wire_sink(&again, bench.system().time());
  bench.ask("01 03 00 00 00 01 84 0A");
  bench.wait(20 * kMillisecond);
  EXPECT_EQ(heard, (std::vector<std::string>{"rx", "tx"}));
  bench.station().set_wire_sink(nullptr, bench.system().time());
  bench.ask("01 03 00 00 00 01 84 0A");
  EXPECT_EQ(heard.size(), 2U) << "no one watches any more";
}

TEST(WestinghouseModbus, ASnapshotGoesOnAsItWouldHave) {
  Bench bench("modbus");
  const Bytes request = modbus::rtu_frame(1, modbus::write_register(5, 0x1234));
  bench.master().requester().start({.frame = serial::to_frame(request)}, bench.system().time());
  bench.system().run_until(bench.system().time() + 6 * kMillisecond);
  const auto snapshot = bench.system().snapshot();
  const auto answer = bench.system().finish_exchange(bench.master()).response_bytes();
  const auto end = bench.system().snapshot();
  EXPECT_EQ(answer, request);
  bench.system().restore(snapshot);
  EXPECT_NE(bench.fault_of("HR6=1234"), "");
  EXPECT_EQ(bench.system().finish_exchange(bench.master()).response_bytes(), answer);
  EXPECT_EQ(bench.system().snapshot(), end);
}

TEST(WestinghouseSetting, WhatIsNotASettingIsNamedWithThoseThereAre) {
  Bench bench("modbus");
  std::string why = bench.plc().set("frob=1").why();
  EXPECT_TRUE(why.starts_with("'frob=1' is not a setting of this PLC; there are slave, plc,")) << why;
  EXPECT_TRUE(why.ends_with("W[ADDRESS]")) << why;
  for (const char* const text : {"HR1=", "HR1", "HR1=zz", "HR1=12,", "W[12]="}) {
    why = bench.plc().set(text).why();
    EXPECT_TRUE(why.starts_with(fmt::format("'{}': cells take hexadecimal values with commas between", text))) << why;
  }
  for (const auto& [text, said] :
       std::map<std::string, std::string>{{"slave=00", "slave: '00' is not a hexadecimal number from 01 to FF"},
                                          {"slave=1g", "slave: '1g' is not a hexadecimal number from 01 to FF"},
                                          {"baud=49", "baud: '49' is not a decimal number from 50 to 1000000"},
                                          {"checks=none", "checks: 'none' is not one of quantity_first, address_first"},
                                          {"HR0=1", "HR: numbers are from 1 to 65535"},
                                          {"CR1=2", "CR: 2 is more than 1"},
                                          {"W[FFFF]=1,2", "W: addresses are from 0 to FFFF"}}) {
    EXPECT_EQ(bench.plc().set(text).why(), said);
  }
}

TEST(WestinghouseSetting, CellsThatASmallerMemoryNoLongerHasAreNotReached) {
  const auto plc = make_plc(*find_plc("modbus"), "pc1200").value();
  for (const char* const text : {"HR100=1,2", "CR9=1", "holding_registers=100", "coils=9"})
    ASSERT_EQ(plc->set(text).why(), "");
  EXPECT_EQ(plc->still_reaches("HR100=1,2").why(),
            "HR101 is not there: holding_registers=100; set holding_registers=101 or more before it");
  EXPECT_EQ(plc->still_reaches("HR99=1,2").why(), "");
  EXPECT_EQ(plc->still_reaches("CR9=1").why(), "");
  EXPECT_EQ(plc->still_reaches("coils=9").why(), "") << "a setting";
}

TEST(WestinghouseSetting, AModelThatDoesNotSpeakTheProtocolIsNamedWithThoseThatDo) {
  EXPECT_EQ(make_plc(*find_plc("modbus"), "pc1100").why(),
            "'pc1100' is not a PLC that speaks modbus here; there are pc503, pc1200, pc1250, pc2000, ncmz, hppc");
  EXPECT_TRUE(make_plc(*find_plc("modbus"), "ncmz"));
}

}  // namespace
}  // namespace s7200::westinghouse::westinghouse_modbus_test
