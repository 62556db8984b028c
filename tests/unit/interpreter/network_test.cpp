// NETR and NETW (facts 10.9). The stations that answer are bytes, written from the rules apart from the simulator's code.
#include "interpreter/trace/text/text_trace.hpp"
#include "tests/support/ppi_master.hpp"

namespace s7200::test::network_test {
namespace {

using namespace ppi;

constexpr std::uint8_t kV = 0x84;
constexpr Bytes (*kAccept)() = [] { return Bytes{0xE5}; };

/// A master at station 2 with a table at VB100 for 4 bytes from VB200 of station 3. `does` has power flow once, in the third
/// scan.
std::string master(std::string_view does, std::string_view mode = "2") {
  return "LD SM0.1\nMOVB " + std::string(mode) +
         ", SMB30\nMOVB 3, VB101\nMOVD &VB200, VD102\nMOVB 4, VB106\nLD SM0.0\nINCW VW1000\nLDW= VW1000, 3\n" +
         std::string(does) + "\nMEND\n";
}
constexpr std::string_view kReads = "NETR VB100, 0", kWrites = "NETW VB100, 0";

/// The other stations on the line: `answer` says what they reply to a frame, nothing if they do not.
class Stations {
 public:
  using Answer = std::function<Bytes(const Bytes& frame)>;
  Stations(Plc& plc, Answer answer) : plc_(plc), answer_(std::move(answer)) {}

  void run_until(Time end) {
    while (plc_.cpu.time() < end) {
      plc_.run_until(plc_.cpu.time() + ms);
      auto& sent = plc_.port.sent;
      if (sent.empty() || plc_.cpu.time() < sent.back().at + 2 * kCharacter) continue;
      heard.emplace_back();
      times.push_back(sent.front().at);
      for (const Port::Sent& each : sent) heard.back().push_back(each.byte);
      sent.clear();
      reply(answer_(heard.back()));
    }
  }

  std::vector<Bytes> heard;
  Times times;  ///< when each began
  Time delay = 11 * kBit;
  std::size_t damaged = 0;  ///< the last character of this reply, counted from 1, has wrong parity

 private:
  void reply(const Bytes& bytes) {
    Time start = plc_.cpu.time() + delay;
    for (std::size_t i = 0; i < bytes.size(); ++i, start += kCharacter)
      plc_.received_at({.byte = bytes[i],
                        .parity_error = heard.size() == damaged && i + 1 == bytes.size(),
                        .start = start,
                        .end = start + 10 * kBit + kBit / 2});
  }

  Plc& plc_;
  Answer answer_;
};

/// The PDU of an answer whose only variable has the code FF.
Bytes answer(const Bytes& value, unsigned number = 1, std::uint8_t code = 0xFF) {
  const Bytes data =
      value.empty() ? Bytes{code} : joined({{code, 0x04}, word(static_cast<unsigned>(value.size()) * 8), value});
  return joined({{0x32, 3, 0, 0}, word(number), {0, 2}, word(static_cast<unsigned>(data.size())), {0, 0}, {0x04, 1}, data});
}
Bytes written(unsigned number = 1) { return joined({{0x32, 3, 0, 0}, word(number), {0, 2, 0, 1, 0, 0, 0x05, 1, 0xFF}}); }

bool is_poll(const Bytes& frame) { return frame.front() == 0x10; }

/// Accepts each request, and answers each poll so.
Stations::Answer with(const Bytes& pdu) {
  return [=](const Bytes& frame) { return is_poll(frame) ? sd2(2, 3, 0x08, pdu) : Bytes{0xE5}; };
}

int status(const Plc& plc) { return static_cast<int>(plc.value("VB100")); }

TEST(Network, NetrFetchesBytesOfAnotherStation) {
  Plc plc(master(kReads));
  Stations others(plc, with(answer({1, 2, 3, 4})));
  others.run_until(30 * ms);
  EXPECT_EQ(status(plc), 0x40) << "active";
  others.run_until(300 * ms);
  EXPECT_EQ(status(plc), 0x80) << "done";
  EXPECT_EQ(plc.value("VD107"), 0x01020304);
  EXPECT_EQ(others.heard,
            (std::vector<Bytes>{sd2(3, 2, 0x6C, reading({variable(0x02, 4, kV, 200 * 8, 1)})), sd1(3, 2, 0x5C)}));
  EXPECT_TRUE(plc.records.errors().empty());
}

TEST(Network, NetwSendsBytesToAnotherStation) {
  Plc plc(master(kWrites));
  plc.set("VD107", 0x0A0B0C0D);
  Stations others(plc, with(written()));
  others.run_until(300 * ms);
  EXPECT_EQ(status(plc), 0x80);
  EXPECT_EQ(others.heard.front(),
            sd2(3, 2, 0x6C, writing(variable(0x02, 4, kV, 200 * 8, 1), 0x04, 32, {0x0A, 0x0B, 0x0C, 0x0D})));
}

TEST(Network, APointerMayPointToInputsOutputsAndMemoryBits) {
  for (const auto& [pointer, area] : {std::pair{"&IB1", 0x81}, {"&QB1", 0x82}, {"&MB1", 0x83}}) {
    Plc plc(master(std::string("MOVD ") + pointer + ", VD102\nMOVB 1, VB106\n" + std::string(kReads)));
    Stations others(plc, with(answer({0x5A})));
    others.run_until(300 * ms);
    EXPECT_EQ(others.heard.at(0), sd2(3, 2, 0x6C, reading({variable(0x02, 1, static_cast<std::uint8_t>(area), 8)})));
    EXPECT_EQ(plc.value("VB107"), 0x5A);
  }
}

TEST(Network, AJobIsOfThePortThatTheInstructionNames) {
  std::string program = master("NETR VB100, 1");
  program.replace(program.find("SMB30"), 5, "SMB130");
  Plc plc(program, *find_cpu("226"));
  plc.run_until(30 * ms);
  EXPECT_EQ(status(plc), 0x40) << "active";
  EXPECT_TRUE(plc.port.sent.empty());
  EXPECT_FALSE(plc.port1.sent.empty());
}

TEST(Network, JobsAreDoneOneAfterTheOther) {
  Plc plc(master("MOVB 3, VB121\nMOVD &VB300, VD122\nMOVB 1, VB126\nNETR VB100, 0\nNETR VB120, 0"));
  unsigned number = 0;
  Stations others(plc, [&](const Bytes& frame) {
    if (!is_poll(frame)) return kAccept();
    return sd2(2, 3, 0x08, ++number == 1 ? answer({1, 2, 3, 4}, 1) : answer({9}, 2));
  });
  others.run_until(60 * ms);
  EXPECT_EQ(plc.value("VB120"), 0x40) << "waits";
  others.run_until(600 * ms);
  EXPECT_EQ(others.heard.size(), 4U);
  EXPECT_EQ(others.heard.at(2), sd2(3, 2, 0x6C, request(joined({{0x04, 1}, variable(0x02, 1, kV, 300 * 8, 1)}), {}, 2)));
  EXPECT_EQ(plc.value("VB120"), 0x80);
  EXPECT_EQ(plc.value("VB127"), 9);
}

TEST(Network, ASlowStationIsPolledUntilItAnswers) {
  Plc plc(master(kReads));
  int polls = 0;
  Stations others(plc, [&](const Bytes& frame) {
    return is_poll(frame) && ++polls == 4 ? sd2(2, 3, 0x08, answer({1, 2, 3, 4})) : Bytes{0xE5};
  });
  others.run_until(600 * ms);
  ASSERT_EQ(others.heard.size(), 5U);
  for (std::size_t poll = 1; poll < 5; ++poll) EXPECT_EQ(others.heard[poll], sd1(3, 2, poll % 2 == 1 ? 0x5C : 0x7C));
  EXPECT_EQ(status(plc), 0x80);
}

TEST(Network, AStationThatDoesNotAnswerIsAskedThreeTimes) {
  Plc plc(master(kReads));
  Stations others(plc, [](const Bytes&) { return Bytes{}; });
  others.run_until(1000 * ms);
  ASSERT_EQ(others.heard.size(), 3U);
  EXPECT_EQ(others.heard[0], others.heard[1]);
  EXPECT_EQ(others.heard[0], others.heard[2]);
  const Time frame = static_cast<Time>(others.heard[0].size()) * kCharacter;
  for (std::size_t i : {1U, 2U})
    EXPECT_NEAR(static_cast<double>(others.times[i] - others.times[i - 1] - frame), 150.0 * ms, 1000);
  EXPECT_EQ(status(plc), 0xA1);
}

TEST(Network, ADamagedAnswerIsAReceiveError) {
  Plc plc(master(kReads));
  Stations others(plc, [](const Bytes& frame) {
    if (!is_poll(frame)) return kAccept();
    Bytes damaged = sd2(2, 3, 0x08, answer({1, 2, 3, 4}));
    damaged[damaged.size() - 2] ^= 1;
    return damaged;
  });
  others.run_until(1500 * ms);
  EXPECT_EQ(others.heard.size(), 4U) << "one request, three polls";
  EXPECT_EQ(status(plc), 0xA2);
  EXPECT_EQ(plc.value("VD107"), 0);
}

TEST(Network, AReplyAfterADamagedOneIsHeardThoughItFollowsTheRequestAtOnce) {
  for (const std::size_t reply : {1U, 2U}) {
    Plc plc(master(kReads));
    Stations others(plc, with(answer({1, 2, 3, 4})));
    others.damaged = reply;
    others.run_until(1000 * ms);
    EXPECT_EQ(others.heard.size(), 3U) << "the request or the poll is repeated";
    EXPECT_EQ(status(plc), 0x80);
  }
}

TEST(Network, AStationThatNeverHasItsAnswerIsGivenUp) {
  Plc plc(master(kReads));
  Stations others(plc, [](const Bytes&) { return Bytes{0xE5}; });
  others.run_until(900 * ms);
  EXPECT_EQ(status(plc), 0x40);
  others.run_until(1200 * ms);
  EXPECT_EQ(status(plc), 0xA1);
}

TEST(Network, WhatTheStationRepliesSaysWhyItFailed) {
  const auto ends_with = [](const Bytes& reply) {
    Plc plc(master(kReads));
    Stations others(plc, [&](const Bytes& frame) { return is_poll(frame) ? reply : Bytes{0xE5}; });
    others.run_until(300 * ms);
    return status(plc);
  };
  EXPECT_EQ(ends_with(sd1(2, 3, 0x02)), 0xA7) << "no resource";
  EXPECT_EQ(ends_with(sd1(2, 3, 0x03)), 0xA8) << "no such service";
  EXPECT_EQ(ends_with(sd2(2, 3, 0x08, answer({}, 1, 0x05))), 0xA9) << "no such data";
  EXPECT_EQ(ends_with(sd2(2, 3, 0x08, answer({1, 2, 3, 4}, 7))), 0xA8) << "the answer to another request";
  EXPECT_EQ(ends_with(sd2(2, 3, 0x08, answer({1, 2, 3}))), 0xA8) << "fewer bytes than asked for";
  EXPECT_EQ(ends_with(sd2(2, 3, 0x08, {0x32})), 0xA8);
  EXPECT_EQ(ends_with(sd2(2, 4, 0x08, answer({1, 2, 3, 4}))), 0x40) << "another station: it is waited for the right one";
}

TEST(Network, AJobThatCannotBeginSaysWhy) {
  const auto ends_with = [](std::string_view change, std::string_view mode = "2") {
    Plc plc(master(std::string(change) + "\n" + std::string(kReads), mode));
    Stations others(plc, [](const Bytes&) { return Bytes{}; });
    others.run_until(100 * ms);
    EXPECT_TRUE(others.heard.empty());
    return status(plc);
  };
  EXPECT_EQ(ends_with("NOP 0", "0"), 0xA5) << "PPI slave";
  EXPECT_EQ(ends_with("NOP 0", "9"), 0xA5) << "Freeport";
  EXPECT_EQ(ends_with("MOVB 0, VB106"), 0xA6);
  EXPECT_EQ(ends_with("MOVB 17, VB106"), 0xA6);
  EXPECT_EQ(ends_with("MOVB 127, VB101"), 0xA6);
  EXPECT_EQ(ends_with("MOVB 2, VB101"), 0xA6) << "itself";
  EXPECT_EQ(ends_with("MOVD 16#7F000000, VD102"), 0xA6);
  EXPECT_EQ(ends_with("MOVD &T37, VD102"), 0xA6) << "no T";
}

TEST(Network, ANinthJobIsTooMany) {
  std::string nine;
  for (int i = 0; i < 9; ++i) {
    const int table = 100 + 30 * i;
    nine +=
        fmt::format("MOVB 3, VB{}\nMOVD &VB200, VD{}\nMOVB 1, VB{}\nNETR VB{}, 0\n", table + 1, table + 2, table + 6, table);
  }
  Plc plc(master(nine));
  Stations others(plc, [](const Bytes&) { return Bytes{}; });
  others.run_until(80 * ms);
  EXPECT_EQ(plc.value("VB310"), 0x40) << "the eighth";
  EXPECT_EQ(plc.value("VB340"), 0xA4);
}

TEST(Network, ATableOnTheListIsNotListedAgain) {
  Plc plc(master("NETR VB100, 0\nNETR VB100, 0\nNETW VB100, 0"));
  Stations others(plc, with(answer({1, 2, 3, 4})));
  others.run_until(500 * ms);
  EXPECT_EQ(others.heard.size(), 2U);
  EXPECT_EQ(status(plc), 0x80);
}

TEST(Network, TheTableChangesInTheCommunicationPartOfTheScan) {
  std::string slow = "LD SM0.0\n";
  for (int i = 0; i < 40; ++i) slow += "SQRT VD8, VD12\n";
  std::string program = master(kReads);
  program.insert(program.size() - 5, slow + "MOVB VB100, VB2\n");
  Plc plc(program);
  Stations others(plc, with(answer({1, 2, 3, 4})));
  while (status(plc) != 0x80 && plc.cpu.time() < 2000 * ms) others.run_until(plc.cpu.time() + ms);
  EXPECT_EQ(plc.value("VB2"), 0x40) << "the program that was running has not seen it";
  EXPECT_EQ(plc.value("VD107"), 0x01020304);
}

TEST(Network, WhatIsAskedForStaysWhenTheTableChanges) {
  for (const char* change : {"MOVB 255, VB106", "MOVB 9, VB101", "MOVD 16#7F000000, VD102"}) {
    Plc plc(master("NETR VB100, 0\nLDW= VW1000, 5\n" + std::string(change)));
    Stations others(plc, with(answer({1, 2, 3, 4})));
    others.run_until(300 * ms);
    EXPECT_EQ(status(plc), 0x80) << change;
    EXPECT_EQ(plc.value("VD107"), 0x01020304);
    EXPECT_EQ(plc.value("VD111"), 0);
  }
}

TEST(Network, AnAnswerThatIsComingInIsWaitedFor) {
  Plc plc(master(kReads));
  Stations others(plc, with(answer({1, 2, 3, 4})));
  others.delay = 140 * ms;  // its last character comes after the 150 ms
  others.run_until(1000 * ms);
  EXPECT_EQ(others.heard.size(), 2U) << "nothing is asked again";
  EXPECT_EQ(status(plc), 0x80);
}

TEST(Network, LeavingTheMasterModeEndsTheJobs) {
  Plc plc(master("NETR VB100, 0\nLDW= VW1000, 6\nMOVB 0, SMB30"));
  Stations others(plc, [](const Bytes&) { return Bytes{}; });
  others.run_until(400 * ms);
  EXPECT_EQ(status(plc), 0xA5);
  EXPECT_LE(others.heard.size(), 1U);
}

TEST(Network, JobsGoOnInStop) {
  Plc plc(master("NETR VB100, 0\nLDW= VW1000, 4\nSTOP"));
  Stations others(plc, with(answer({1, 2, 3, 4})));
  others.run_until(300 * ms);
  EXPECT_TRUE(plc.stopped());
  EXPECT_EQ(status(plc), 0x80);
}

TEST(Network, ATableThatReachesBeyondMemoryIsARangeError) {
  Plc plc(master("MOVD &VB4094, AC1\nNETR *AC1, 0"));
  Stations others(plc, [](const Bytes&) { return Bytes{}; });
  others.run_until(100 * ms);
  EXPECT_EQ(plc.records.errors(), Ints{0x91});
}

TEST(Network, TheMasterAnswersOtherMastersAsASlave) {
  Plc plc(master("NOP 0"));
  EXPECT_EQ(Master(plc, 0).say(sd1(2, 0, 0x49)), sd1(0, 2, 0x00));
}

TEST(Network, AMasterThatHearsAnotherOneGoesOnAndTheTraceSaysSo) {
  Plc plc(master(kReads));
  plc.run_until(100 * ms);  // it waits for the answer of station 3
  EXPECT_EQ(Master(plc, 0).say(sd1(4, 0, 0x5C), 150 * ms), sd2(3, 2, 0x6C, reading({variable(0x02, 4, kV, 200 * 8, 1)})))
      << "asked again";
  const auto records = plc.records.of(TraceKind::PpiNotModelled);
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(
      describe(records[0], plc.cpu.program()),
      "PPI station 0 asks station 4: another master; without the token, which is not modelled, its frames and those of "
      "NETR and NETW here may collide");
}

TEST(Network, JobsAreDoneAtTheRateOfThePort) {
  constexpr Time kFastBit = kSecond / 187500;
  Plc plc(at_rate(master(kReads), 187500, cpu224()));
  plc.run_until(20 * ms);
  ASSERT_GT(plc.port.sent.size(), 20U);
  EXPECT_EQ(plc.port.sent[1].at - plc.port.sent[0].at, plc.port.format.character_time());
  EXPECT_LT(plc.port.format.character_time(), 12 * kFastBit);
}

TEST(Network, TheTraceSaysWhatBecameOfAJob) {
  Plc plc(master(kReads));
  Stations others(plc, [](const Bytes&) { return Bytes{}; });
  others.run_until(1000 * ms);
  std::vector<std::string> lines;
  for (const TraceRecord& record : plc.records.of(TraceKind::NetworkJob))
    lines.push_back(describe(record, plc.cpu.program()));
  EXPECT_EQ(lines, (std::vector<std::string>{"NETR with table VB100, station 3: 4 bytes are to be read",
                                             "NETR with table VB100, station 3: error 1, the station does not answer"}));
}

}  // namespace
}  // namespace s7200::test::network_test
