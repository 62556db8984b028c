// Several stations in one time: PLCs on one line answer, hear, collide, and leave each other alone.
#include "serial_sim/system/system.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "serial_sim/peers/quiet_time.hpp"
#include "tests/support/slave_bench.hpp"

namespace s7200::serial::system_test {
namespace {

using test::changed;
using test::CountingSink;

constexpr const char* kStops = "LD SM0.1\nSTOP\nMEND\n";

std::shared_ptr<const Program> slave(int station) {
  const std::string set = "MOVB    " + std::to_string(station) + ", VB4095";
  return test::compile(changed(test::slave_text(), "MOVB    1, VB4095", set));
}

/// Its scan takes longer, so that it is out of step with the others.
std::shared_ptr<const Program> slower_slave(int station) {
  const std::string more = "LD SM0.0\nINCW VW4000\nMOVW VW4000, VW4002\n\nMEND";
  return test::compile(
      changed(changed(test::slave_text(), "MOVB    1, VB4095", "MOVB    " + std::to_string(station) + ", VB4095"), "\nMEND",
              "\n" + more));
}

Frame request(std::uint8_t station, const Bytes& pdu) { return to_frame(modbus::rtu_frame(station, pdu)); }

void set_register(Plc& plc, std::uint16_t number, std::uint16_t value) {
  const Bytes bytes{static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value & 0xFF)};
  plc.cpu().poke(image::kV + 2U * number, bytes);
}
std::uint16_t register_of(const Plc& plc, std::uint16_t number) {
  return load16(&plc.cpu().state().image[image::kV + 2U * number]);
}

/// PLCs and a master on one line; a master may ask from kReady on.
struct Plant {
  static constexpr Time kReady = kSecond;

  explicit Plant(const std::vector<std::shared_ptr<const Program>>& programs) {
    for (const auto& program : programs) plcs.push_back(&system.add_plc(line, program));
    master = &system.add_requester(line);
    system.power_up();
  }
  void start() {
    system.run_until(kReady);
    master->uart().configure(plcs[0]->port_format(), 0);
  }

  const Exchange& send(const Frame& frame) {
    master->requester().start({.frame = frame}, system.time());
    return system.finish_exchange(*master);
  }
  /// The answer without its CRC, `-` for none; then quiet.
  std::string ask(std::uint8_t station, const Bytes& pdu) {
    Bytes answer = send(request(station, pdu)).response_bytes();
    run_for(default_quiet(plcs[0]->port_format()));
    if (answer.empty()) return "-";
    EXPECT_TRUE(modbus::crc_ok(answer)) << to_hex(answer);
    answer.resize(answer.size() - 2);
    return to_hex(answer);
  }
  void run_for(Time time) { system.run_until(system.time() + time); }

  System system;
  SharedLine& line = system.add_line();
  std::vector<Plc*> plcs;
  RequesterStation* master = nullptr;
};

TEST(System, TwoPlcsOnOneLineAnswerAMasterEachInTurn) {
  Plant plant({slave(1), slave(2)});
  std::vector<CountingSink> sinks(2);
  for (std::size_t i = 0; i < 2; ++i) plant.plcs[i]->cpu().set_sink(&sinks[i]);
  plant.start();
  set_register(*plant.plcs[0], 10, 0x1111);
  set_register(*plant.plcs[1], 10, 0x2222);
  for (std::uint64_t round = 1; round <= 3; ++round) {
    EXPECT_EQ(plant.ask(1, modbus::read_holding_registers(10, 1)), "01 03 02 11 11");
    EXPECT_EQ(plant.ask(2, modbus::read_holding_registers(10, 1)), "02 03 02 22 22");
    EXPECT_EQ(plant.ask(3, modbus::read_holding_registers(10, 1)), "-");
    for (const CountingSink& sink : sinks) EXPECT_EQ(sink.of(TraceKind::Transmit), round) << "only who is asked answers";
  }
}

TEST(System, EachPlcHearsEveryCharacterOfTheOthers) {
  Plant plant({slave(1), slave(2)});
  std::vector<CountingSink> sinks(2);
  plant.start();
  for (std::size_t i = 0; i < 2; ++i) plant.plcs[i]->cpu().set_sink(&sinks[i]);
  const auto heard = [&](std::size_t i) {
    return sinks[i].of(TraceKind::CharacterReceived) + sinks[i].of(TraceKind::CharacterIgnored);
  };
  ASSERT_EQ(plant.ask(1, modbus::read_holding_registers(0, 2)), "01 03 04 00 00 00 00");
  EXPECT_EQ(heard(0), 8U) << "the request";
  EXPECT_EQ(heard(1), 8U + 9U) << "the request and the other's answer";
  ASSERT_EQ(plant.ask(2, modbus::read_holding_registers(0, 2)), "02 03 04 00 00 00 00");
  EXPECT_EQ(heard(0), 8U + 8U + 9U);
  EXPECT_EQ(heard(1), 8U + 9U + 8U);
  EXPECT_EQ(sinks[1].of(TraceKind::CharacterSent), 9U);
}

TEST(System, ABroadcastIsTakenByAllAndAnsweredByNone) {
  Plant plant({slave(1), slave(2)});
  plant.start();
  EXPECT_EQ(plant.ask(0, modbus::write_register(7, 0xABCD)), "-");
  for (const Plc* plc : plant.plcs) EXPECT_EQ(register_of(*plc, 7), 0xABCD);
}

/// Requests at fixed times to each of two PLCs, the second out of step with the first, in steps of `slice`.
struct Conversation {
  static constexpr Time kEvery = 150 * kMillisecond;
  static constexpr std::size_t kRequests = 6;

  void run_to(Time end, Time slice = kNever) {
    while (plant.system.time() < end)
      plant.system.run_until(slice < end - plant.system.time() ? plant.system.time() + slice : end);
  }
  static Time begin_of(std::size_t number) { return Plant::kReady + static_cast<Time>(number) * kEvery; }
  void ask_next(Time slice = kNever) {
    run_to(begin_of(asked), slice);
    plant.master->uart().configure(plant.plcs[0]->port_format(), 0);
    const auto station = static_cast<std::uint8_t>(1 + asked % 2);
    const auto value = static_cast<std::uint16_t>(0x1111 * asked);
    const Bytes pdu = asked < 3 ? modbus::write_register(3, value) : modbus::read_holding_registers(3, 5);
    plant.master->requester().start({.frame = request(station, pdu)}, plant.system.time());
    ++asked;
  }
  void go_on(Time slice = kNever) {
    while (asked < kRequests) ask_next(slice);
    run_to(begin_of(asked), slice);
  }

  Plant plant{{slave(1), slower_slave(2)}};
  std::size_t asked = 0;
};

System::Snapshot end_of(Conversation& conversation, Time slice = kNever) {
  conversation.go_on(slice);
  return conversation.plant.system.snapshot();
}

TEST(System, TheSameRunTwiceIsTheSameInSlicesAndTracedToo) {
  Conversation first, second, traced;
  std::vector<CountingSink> sinks(2, CountingSink(true));
  for (std::size_t i = 0; i < 2; ++i) traced.plant.plcs[i]->cpu().set_sink(&sinks[i]);
  const System::Snapshot end = end_of(first);
  EXPECT_TRUE(end == end_of(second));
  EXPECT_TRUE(end == end_of(traced));
  for (const CountingSink& sink : sinks) EXPECT_EQ(sink.of(TraceKind::Transmit), 3U);
  for (const Time slice : {331 * kMicrosecond, 41 * kMicrosecond}) {
    Conversation sliced;
    EXPECT_TRUE(end == end_of(sliced, slice)) << slice;
  }
}

TEST(System, TheSameRunIsTheSameOnALineWithFaults) {
  const auto end = [](Time slice) {
    Conversation conversation;
    for (const char* const fault :
         {"noise:ber=0.002", "extra:probability=0.5,of=both", "collision:every=2", "baud:error=1%"})
      conversation.plant.line.faults().inject(parse_fault(fault).fault, 0);
    return end_of(conversation, slice);
  };
  EXPECT_TRUE(end(kNever) == end(83 * kMicrosecond));
}

TEST(System, ASnapshotGoesOnAsTheOriginal) {
  Conversation whole;
  whole.go_on();
  const System::Snapshot end = whole.plant.system.snapshot();
  // In a request, in the work on it, and in an answer of the second PLC.
  for (const Time into : {3 * kMillisecond, 15 * kMillisecond, 21 * kMillisecond}) {
    Conversation first, other;
    first.ask_next();
    first.ask_next();
    first.run_to(Conversation::begin_of(1) + into);
    const System::Snapshot middle = first.plant.system.snapshot();
    first.run_to(Conversation::begin_of(2) - kMillisecond);
    first.plant.system.restore(middle);
    EXPECT_TRUE(first.plant.system.snapshot() == middle);
    other.plant.system.restore(middle);
    other.asked = first.asked;
    first.go_on();
    other.go_on();
    EXPECT_TRUE(end == first.plant.system.snapshot()) << "back to where it was, " << into;
    EXPECT_TRUE(end == other.plant.system.snapshot()) << "in another system, " << into;
  }
}

TEST(System, OnePlcInASystemIsASimulationToTheNanosecond) {
  System system;
  SharedLine& line = system.add_line();
  Plc& plc = system.add_plc(line, slave(1));
  RequesterStation& master = system.add_requester(line);
  system.power_up();
  Simulation simulation(slave(1));
  simulation.power_up();

  system.run_until(kSecond);
  simulation.run_until(kSecond);
  master.uart().configure(plc.port_format(), 0);
  simulation.configure_master(simulation.port_format());
  for (int i = 0; i < 3; ++i) {
    const Frame frame = request(1, modbus::read_holding_registers(0, 20));
    master.requester().start({.frame = frame}, system.time());
    simulation.master().start({.frame = frame}, simulation.time());
    EXPECT_EQ(system.finish_exchange(master), simulation.finish_exchange());
    EXPECT_FALSE(simulation.master().exchange().response.empty());
    EXPECT_TRUE(plc.cpu().state() == simulation.cpu().state());
  }
}

TEST(System, APlcRunsBesideOthersAsItDoesAlone) {
  Plant plant({slave(1), slower_slave(2), test::compile(kStops), slower_slave(3)});
  plant.start();
  Simulation alone(slave(1));
  alone.power_up();
  alone.run_until(Plant::kReady);
  alone.configure_master(alone.port_format());
  for (int i = 1; i <= 4; ++i) {
    const Time at = Plant::kReady + i * 200 * kMillisecond;
    plant.system.run_until(at - kMillisecond);
    alone.run_until(at - kMillisecond);
    const Request asks{.frame = request(static_cast<std::uint8_t>(i == 3 ? 9 : 1), modbus::read_holding_registers(0, 20)),
                       .timeout = 100 * kMillisecond};
    plant.master->requester().start(asks, at);
    alone.master().start(asks, at);
    plant.system.run_until(at + 150 * kMillisecond);
    alone.run_until(at + 150 * kMillisecond);
    EXPECT_EQ(plant.master->requester().exchange(), alone.master().exchange());
    EXPECT_EQ(alone.master().exchange().timed_out, i == 3);
    EXPECT_TRUE(plant.plcs[0]->cpu().state() == alone.cpu().state()) << "after request " << i;
  }
}

TEST(System, TwoThatAnswerAtOnceCollideOnTheWire) {
  Plant plant({slave(1), slower_slave(1)});
  plant.start();
  set_register(*plant.plcs[0], 0, 0x5A5A);
  set_register(*plant.plcs[1], 0, 0xA5A5);
  const Exchange garbage = plant.send(request(1, modbus::read_holding_registers(0, 1)));
  EXPECT_FALSE(garbage.response.empty());
  EXPECT_FALSE(modbus::crc_ok(garbage.response_bytes()));
  EXPECT_TRUE(garbage.parity_error() || garbage.framing_error());
  plant.run_for(100 * kMillisecond);
  for (const Plc* plc : plant.plcs) EXPECT_EQ(plc->cpu().state().mode, Mode::Run);

  const Bytes station{2};
  plant.plcs[1]->cpu().poke(image::kV + 4095, station);
  EXPECT_EQ(plant.ask(1, modbus::read_holding_registers(0, 1)), "01 03 02 5a 5a");
  EXPECT_EQ(plant.ask(2, modbus::read_holding_registers(0, 1)), "02 03 02 a5 a5");
}

/// Asks station 1 for two registers after 2 s, and keeps what it hears from VB200 on.
constexpr const char* kAsks = R"(
LD SM0.1
MOVB 16#49, SMB30
MOVB 8, VB100
MOVD 16#01030000, VD101
MOVD 16#0002C40B, VD105
MOVD &VB200, VD300
ATCH 0, 8
ENI
LD SM0.0
TON T37, 20
LD T37
EU
XMT VB100, 0
MEND
INT 0
LD SM0.0
MOVB SMB2, *VD300
INCD VD300
RETI
)";

TEST(System, APlcThatAsksGetsItsAnswerAndIsHeardAsAnyMasterIs) {
  CountingSink asks;
  Plant plant({test::compile(kAsks), slave(1)});
  plant.plcs[0]->cpu().set_sink(&asks);
  plant.start();
  set_register(*plant.plcs[1], 0, 0x1234);
  set_register(*plant.plcs[1], 1, 0x5678);
  plant.system.run_until(3 * kSecond);
  const auto& image = plant.plcs[0]->cpu().state().image;
  EXPECT_EQ(to_hex(std::span(&image[image::kV + 200], 7)), "01 03 04 12 34 56 78");
  ASSERT_EQ(asks.of(TraceKind::Transmit), 1U);

  Simulation alone(slave(1));
  alone.power_up();
  alone.run_until(Plant::kReady);
  alone.configure_master(alone.port_format());
  const Bytes values{0x12, 0x34, 0x56, 0x78};
  alone.cpu().poke(image::kV, values);
  alone.master().start({.frame = request(1, modbus::read_holding_registers(0, 2))}, asks.last_of(TraceKind::Transmit).at);
  alone.run_until(3 * kSecond);
  EXPECT_TRUE(plant.plcs[1]->cpu().state() == alone.cpu().state());
}

/// Changes the rate of its port twice a scan, and keeps what it makes of what it hears from VB200 on.
constexpr const char* kChangesItsRate = R"(
LD SM0.1
MOVD &VB200, VD300
ATCH 0, 8
ENI
LD SM0.0
MOVB 16#49, SMB30
MOVW 1, VW0
MOVW 2, VW0
MOVW 3, VW0
MOVB 16#45, SMB30
MEND
INT 0
LD SM0.0
MOVB SMB2, *VD300
INCD VD300
RETI
)";

TEST(System, WhatOthersSendIsKnownWheneverAProgramSetsItsPort) {
  for (const std::size_t asker : {0U, 1U}) {
    std::vector<std::shared_ptr<const Program>> programs(2, test::compile(kChangesItsRate));
    programs[asker] = test::compile(kAsks);
    CountingSink asks;
    Plant plant(programs);
    plant.plcs[asker]->cpu().set_sink(&asks);
    plant.system.run_until(3 * kSecond);
    ASSERT_EQ(asks.of(TraceKind::Transmit), 1U);

    Simulation alone(programs[1 - asker]);
    alone.power_up();
    alone.run_until(Plant::kReady);
    alone.configure_master(plant.plcs[asker]->port_format());
    alone.master().start({.frame = request(1, modbus::read_holding_registers(0, 2))}, asks.last_of(TraceKind::Transmit).at);
    alone.run_until(3 * kSecond);
    EXPECT_NE(load32(&alone.cpu().state().image[image::kV + 200]), 0U);
    EXPECT_TRUE(plant.plcs[1 - asker]->cpu().state() == alone.cpu().state());
  }
}

TEST(System, APlcInStopLeavesTheOthersAlone) {
  Plant plant({test::compile(kStops), slave(2)});
  EXPECT_EQ(plant.system.run_until(Plant::kReady), Halt::Time);
  EXPECT_EQ(plant.plcs[0]->cpu().state().mode, Mode::Stop);
  plant.master->uart().configure(plant.plcs[1]->port_format(), 0);
  EXPECT_EQ(plant.ask(2, modbus::read_holding_registers(0, 1)), "02 03 02 00 00");
}

/// Stops its CPU once at an instant.
class PauseAt final : public TraceSink {
 public:
  PauseAt(const Cpu& cpu, Time at) : cpu_(cpu), at_(at) {}
  bool before(std::uint32_t) override {
    if (cpu_.time() < at_) return true;
    at_ = kNever;
    return false;
  }
  bool wants_instructions() const override { return true; }

 private:
  const Cpu& cpu_;
  Time at_;
};

TEST(System, AnyPausedCpuPausesTheSystemWhichGoesOnAsIfItHadNot) {
  Conversation plain, paused;
  PauseAt pause(paused.plant.plcs[1]->cpu(), kSecond / 2);
  paused.plant.plcs[1]->cpu().set_sink(&pause);
  EXPECT_EQ(paused.plant.system.run_until(kSecond), Halt::Paused);
  EXPECT_GE(paused.plant.system.time(), kSecond / 2 - kMillisecond);
  EXPECT_LT(paused.plant.system.time(), kSecond / 2 + kMillisecond);
  paused.go_on();
  plain.go_on();
  EXPECT_TRUE(plain.plant.system.snapshot() == paused.plant.system.snapshot());
}

TEST(System, InStepEachEndOfAScanPausesHoweverManyCpusReachItAtOnce) {
  for (const std::size_t watched : {0U, 1U}) {
    Plant plant({slave(1), slave(2)});
    plant.start();
    plant.system.run_in_step(true);
    Cpu& cpu = plant.plcs[watched]->cpu();
    cpu.pause_at_scan_end(true);
    for (int pause = 0; pause < 20; ++pause) {
      const auto before = cpu.state().scans;
      ASSERT_EQ(plant.system.run_until(plant.system.time() + kSecond), Halt::Paused);
      ASSERT_EQ(cpu.state().scans, before + 1) << watched << " " << pause;
    }
  }
}

TEST(System, ACpuThatWasPausedWhenItsPowerWentOffDoesNotHoldTheOthers) {
  Plant plant({slave(1), slave(2)});
  plant.start();
  plant.plcs[0]->cpu().pause_at_scan_end(true);
  ASSERT_EQ(plant.system.run_until(plant.system.time() + kSecond), Halt::Paused);
  ASSERT_TRUE(plant.system.paused());
  plant.system.power_off(*plant.plcs[0]);
  EXPECT_FALSE(plant.system.paused());
  EXPECT_EQ(plant.ask(2, modbus::read_holding_registers(10, 1)), "02 03 02 00 00");
}

TEST(System, ARunWithoutEndComesBackWhenItIsAskedTo) {
  Plant plant({slave(1), slave(2)});
  const std::atomic<bool> request = true;
  plant.system.stop_when(StopToken(request));
  EXPECT_EQ(plant.system.run_until(kNever), Halt::Request);
}

TEST(System, LinesDoNotHearOneAnother) {
  System system;
  std::vector<RequesterStation*> masters;
  std::vector<Plc*> plcs;
  for (int i = 0; i < 2; ++i) {
    SharedLine& line = system.add_line();
    plcs.push_back(&system.add_plc(line, slave(1)));
    masters.push_back(&system.add_requester(line));
  }
  system.power_up();
  system.run_until(kSecond);
  const Request ask{.frame = request(1, modbus::read_holding_registers(0, 1))};
  for (RequesterStation* master : masters) {
    master->uart().configure(plcs[0]->port_format(), 0);
    master->requester().start(ask, system.time());
  }
  const Exchange first = system.finish_exchange(*masters[0]), second = system.finish_exchange(*masters[1]);
  EXPECT_EQ(to_hex(first.response_bytes()), to_hex(modbus::rtu_frame(1, Bytes{3, 2, 0, 0})));
  EXPECT_EQ(first, second) << "at the same time";
  EXPECT_TRUE(plcs[0]->cpu().state() == plcs[1]->cpu().state());

  CountingSink sink;
  plcs[1]->cpu().set_sink(&sink);
  system.run_until(system.time() + 50 * kMillisecond);
  masters[0]->requester().start(ask, system.time());
  EXPECT_FALSE(system.finish_exchange(*masters[0]).response.empty());
  EXPECT_EQ(sink.of(TraceKind::CharacterReceived) + sink.of(TraceKind::CharacterIgnored), 0U);
}

TEST(System, AFaultOfAnswersMeetsThoseOfEveryPlc) {
  Plant plant({slave(1), slave(2)});
  plant.start();
  const auto wrong = [&](std::uint8_t station) {
    const Exchange exchange = plant.send(request(station, modbus::read_holding_registers(0, 1)));
    plant.run_for(50 * kMillisecond);
    return exchange.parity_error();
  };
  plant.line.faults().inject(parse_fault("parity:character=3,of=answer,every=2").fault, plant.system.time());
  EXPECT_FALSE(wrong(1));
  EXPECT_TRUE(wrong(2));
  EXPECT_FALSE(wrong(2));
  EXPECT_TRUE(wrong(1));
  EXPECT_EQ(plant.line.faults().state().injected[0].count, 2U);
}

/// Keeps the edges that a PLC drives.
struct Driven final : WireSink {
  void edge(Wire wire, Time at, bool, int) override {
    if (wire == Wire::Tx) edges.push_back(at);
  }
  void settled(Time, const SerialFormat&) override {}
  void finish() override {}
  std::vector<Time> edges;
};

TEST(System, EachPlcCanBeWatchedAtItsPort) {
  Plant plant({slave(1), slave(2)});
  std::vector<Driven> sinks(2);
  plant.start();
  for (std::size_t i = 0; i < 2; ++i) plant.plcs[i]->set_wire_sink(&sinks[i]);
  const Time answered = plant.send(request(2, modbus::read_holding_registers(0, 1))).response_start;
  plant.run_for(50 * kMillisecond);
  EXPECT_TRUE(sinks[0].edges.empty());
  ASSERT_FALSE(sinks[1].edges.empty());
  EXPECT_EQ(sinks[1].edges.front(), answered);
}

TEST(System, ASegmentHoldsThirtyTwoStations) {
  std::vector<std::shared_ptr<const Program>> programs;
  for (int station = 1; station < Line::kDrivers; ++station) programs.push_back(slave(station));
  Plant plant(programs);
  plant.system.run_until(100 * kMillisecond);
  plant.master->uart().configure(plant.plcs[0]->port_format(), 0);
  for (std::size_t i = 0; i < plant.plcs.size(); ++i) set_register(*plant.plcs[i], 0, static_cast<std::uint16_t>(i + 1));
  EXPECT_EQ(plant.ask(31, modbus::read_holding_registers(0, 1)), "1f 03 02 00 1f");
  EXPECT_EQ(plant.ask(0, modbus::write_register(1, 77)), "-");
  for (const Plc* plc : plant.plcs) EXPECT_EQ(register_of(*plc, 1), 77);
}

TEST(Dispatcher, OneInstantGoesByRankAndThenInTheOrderOfAdding) {
  struct Log final : EventHandler {
    explicit Log(std::vector<EventOwner>& of) : handled(of) {}
    void handle(const Event& event) override { handled.push_back(event.owner); }
    std::vector<EventOwner>& handled;
  };
  Dispatcher events;
  EventQueue& queue = events.shared_queue();
  std::vector<EventOwner> handled, expected;
  Log one(handled), other(handled);
  constexpr Rank kScrambled[] = {Rank::Peer, Rank::Cpu, Rank::Line, Rank::Port, Rank::Field, Rank::Uart};
  std::array<std::vector<EventOwner>, kRanks> added;
  for (Log* log : {&one, &other})
    for (const Rank rank : kScrambled) {
      const EventOwner owner = events.add(rank, *log);
      EXPECT_EQ(Dispatcher::rank_of(owner), rank);
      added[static_cast<std::size_t>(rank)].push_back(owner);
      queue.schedule(5, owner, 0);
    }
  for (const auto& of_rank : added) expected.insert(expected.end(), of_rank.begin(), of_rank.end());
  for (auto next = events.due(); next.at != kNever; next = events.due()) events.handle(next);
  EXPECT_EQ(handled, expected);
}

// --- RCV, and a second port ---

std::shared_ptr<const Program> program_for(const CpuModel& model, std::string_view text) {
  const CheckResult result = check_text(text, "test.stl", model, default_times(model));
  EXPECT_TRUE(result.program) << (result.diagnostics.empty() ? "" : result.diagnostics[0].message);
  return result.program;
}

/// Sends 3A, then a break, then 3A 01 02 0D, one after the other.
constexpr std::string_view kSendsABreak =
    "LD SM0.1\nMOVB 16#09, SMB30\nMOVB 1, VB10\nMOVB 16#3A, VB11\nMOVB 0, VB20\nMOVB 4, VB30\nMOVD 16#3A01020D, VD31\n"
    "ATCH 0, 9\nENI\nXMT VB10, 0\nMEND\n"
    "INT 0\nLD SM0.0\nINCB VB0\nLDB= VB0, 1\nXMT VB20, 0\nLDB= VB0, 2\nXMT VB30, 0\nRETI\n";

// Break, then start character; to the end character.
TEST(System, RcvHearsTheBreakThatAnotherPlcSends) {
  System system;
  SharedLine& line = system.add_line();
  Plc& receiver = system.add_plc(
      line,
      program_for(cpu224(),
                  "LD SM0.1\nMOVB 16#09, SMB30\nMOVB 16#E2, SMB87\nMOVB 16#3A, SMB88\nMOVB 16#0D, SMB89\nMOVB 20, SMB94\n"
                  "RCV VB100, 0\nMEND\n"));
  system.add_plc(line, program_for(cpu226(), kSendsABreak));
  system.power_up();
  system.run_until(50 * kMillisecond);
  const auto& image = receiver.cpu().state().image;
  EXPECT_EQ(to_hex(Bytes(image.begin() + image::kV + 100, image.begin() + image::kV + 105)), "04 3a 01 02 0d");
  EXPECT_EQ(image[kPorts[0].message], 0x20);
}

// Port 1 of the CPU 226 sends what a CPU 224 sends on port 0; nothing of it is on the line of port 0.
// Every scan, unless the job before is still active; the data of the other station are read back.
TEST(System, APlcReadsFromAndWritesToAnotherOverTheNetwork) {
  System system;
  SharedLine& line = system.add_line();
  Plc& master = system.add_plc(
      line,
      program_for(cpu224(),
                  "LD SM0.1\nMOVB 2, SMB30\nMOVB 7, VB101\nMOVB 7, VB121\nMOVD &VB500, VD102\nMOVD &VB500, VD122\n"
                  "MOVB 2, VB106\nMOVB 2, VB126\nLDN V100.6\nAN V120.6\nINCW VW107\nNETW VB100, 0\nNETR VB120, 0\nMEND\n"));
  Plc& other = system.add_plc(line, program_for(cpu224(), "LD SM0.1\nSPA 7, 0\nMEND\n"));
  system.power_up();
  system.run_until(kSecond);
  const std::uint16_t written = load16(&other.cpu().state().image[image::kV + 500]);
  EXPECT_GT(written, 5);
  EXPECT_NEAR(load16(&master.cpu().state().image[image::kV + 127]), written, 1);
  EXPECT_EQ(master.cpu().state().image[image::kV + 100] & 0x2F, 0) << "no error";

  const System::Snapshot middle = system.snapshot();
  system.run_until(1200 * kMillisecond);
  const System::Snapshot end = system.snapshot();
  system.restore(middle);
  system.run_until(1200 * kMillisecond);
  EXPECT_EQ(system.snapshot(), end);

  system.power_off(other);
  const std::uint8_t& status = master.cpu().state().image[image::kV + 100];
  while (status != 0xA1 && system.time() < 4 * kSecond) system.run_until(system.time() + 10 * kMillisecond);
  EXPECT_EQ(status, 0xA1) << "the station does not answer";
}

TEST(System, TheSecondPortHasALineOfItsOwn) {
  const std::string on_port_0 = "LD SM0.1\nMOVB 16#09, SMB30\nMOVB 2, VB10\nMOVW 16#4142, VW11\nXMT VB10, 0\nMEND\n";
  const std::string on_port_1 = changed(changed(on_port_0, "SMB30", "SMB130"), "VB10, 0", "VB10, 1");
  const std::string receives = "LD SM0.1\nMOVB 16#09, SMB30\nMOVB 16#90, SMB87\nMOVB 2, SMB94\nRCV VB100, 0\nMEND\n";
  System system;
  SharedLine &line0 = system.add_line(), &line1 = system.add_line();
  Plc& on_line0 = system.add_plc(line0, program_for(cpu224(), receives));
  Plc& on_line1 = system.add_plc(line1, program_for(cpu224(), receives));
  SharedLine* const lines[] = {&line0, &line1};
  Plc& sender = system.add_plc(lines, program_for(cpu226(), on_port_1));
  system.power_up();
  system.run_until(10 * kMillisecond);
  const System::Snapshot middle = system.snapshot();
  system.run_until(30 * kMillisecond);
  EXPECT_EQ(register_of(on_line1, 50), 0x0241);
  EXPECT_EQ(register_of(on_line0, 50), 0x0000);
  EXPECT_EQ(sender.port_format(1).baud, 9600U);
  const System::Snapshot end = system.snapshot();
  system.restore(middle);
  system.run_until(30 * kMillisecond);
  EXPECT_EQ(system.snapshot(), end);
}

TEST(System, ASimulationMayPutItsMasterOnPort1) {
  Simulation simulation(program_for(cpu226(),
                                    "LD SM0.1\nMOVB 16#49, SMB130\nMOVB 16#90, SMB187\nMOVB 2, SMB194\n"
                                    "ATCH 0, 24\nENI\nRCV VB100, 1\nMEND\nINT 0\nXMT VB100, 1\nRETI\n"),
                        {}, 1);
  simulation.power_up();
  simulation.run_until(20 * kMillisecond);
  EXPECT_EQ(simulation.port_format().parity, Parity::Even);
  simulation.configure_master(simulation.port_format());
  simulation.master().start({.frame = to_frame(Bytes{0x41, 0x42})}, simulation.time());
  EXPECT_EQ(to_hex(simulation.finish_exchange().response_bytes()), "41 42");
}

TEST(System, AMasterThatFollowsAPortInPpiModeHasItsRateAtOnce) {
  auto program = std::make_shared<Program>(*program_for(cpu224(), "LD SM0.0\nMEND\n"));
  program->system_block.ppi_rates = {187500, 187500};
  Simulation simulation(program);
  simulation.power_up();
  simulation.run_until(20 * kMillisecond);
  simulation.let_master_follow([](const SerialFormat& port) { return port; });
  EXPECT_EQ(simulation.master_uart().state().format, (SerialFormat{187500, 8, Parity::Even, 1}));
}

// --- what is done at an instant ---

TEST(System, WhatIsScheduledIsDoneWhenAllClocksHaveComeToIt) {
  Plant plant({slave(1), slower_slave(2)});
  std::vector<Time> done;
  for (const Time at : {Time{0}, 3 * kMillisecond, 3 * kMillisecond, 50 * kMillisecond})
    plant.system.schedule(at, [&] {
      done.push_back(plant.system.time());
      for (const Plc* plc : plant.plcs) EXPECT_GE(plc->cpu().time(), done.size() > 1 ? 3 * kMillisecond : 0);
    });
  plant.system.run_until(3 * kMillisecond);
  EXPECT_EQ(done.size(), 3U) << "those of the instant that was reached, too";
  plant.system.run_until(kSecond);
  ASSERT_EQ(done.size(), 4U);
  EXPECT_LT(done[3], 51 * kMillisecond);
}

TEST(System, ASnapshotKnowsWhatOfTheScheduleIsDone) {
  Plant plant({slave(1), slave(2)});
  int off = 0;
  plant.system.schedule(20 * kMillisecond, [&] {
    ++off;
    plant.system.power_off(*plant.plcs[1]);
  });
  plant.system.run_until(10 * kMillisecond);
  const System::Snapshot before = plant.system.snapshot();
  plant.system.run_until(30 * kMillisecond);
  const System::Snapshot after = plant.system.snapshot();
  EXPECT_FALSE(plant.plcs[1]->powered());
  plant.system.restore(before);
  EXPECT_TRUE(plant.plcs[1]->powered());
  plant.system.run_until(30 * kMillisecond);
  EXPECT_EQ(off, 2);
  EXPECT_TRUE(plant.system.snapshot() == after);
  plant.system.restore(after);
  plant.system.run_until(40 * kMillisecond);
  EXPECT_EQ(off, 2);
}

/// Its CPU is in the middle of an instruction nearly always.
TEST(System, PowerGoesOffAtItsInstantWithinACharacterAndWithinAnInstruction) {
  for (const std::size_t plcs : {1U, 2U})
    for (Time within = 1; within < 30 * kMicrosecond; within += 1301) {
      std::vector<std::shared_ptr<const Program>> programs{slave(1)};
      if (plcs == 2) programs.push_back(slower_slave(2));
      Plant plant(programs);
      Driven sink;
      plant.start();
      plant.plcs[0]->set_wire_sink(&sink);
      plant.master->requester().start({.frame = request(1, modbus::read_holding_registers(0, 1))}, plant.system.time());
      while (sink.edges.empty()) plant.run_for(10 * kMicrosecond);
      const Time start_bits_end = sink.edges.front() + 104'166, at = plant.system.time() + within;
      ASSERT_LT(at, start_bits_end);
      Time told = 0;
      plant.system.schedule(at, [&] {
        told = plant.system.now();
        plant.system.power_off(*plant.plcs[0]);
      });
      plant.run_for(5 * kMillisecond);
      EXPECT_EQ(told, at);
      ASSERT_EQ(sink.edges.size(), 2U);
      EXPECT_EQ(sink.edges.back(), at) << "it drives the line no more";
    }
}

TEST(System, APlcWhosePowerComesBackWithinTheInstructionThatItHadBegunBeginsAfterIt) {
  Plant plant({slave(1), slave(2)});
  plant.start();
  const Time at = plant.system.time() + 1234567;
  plant.system.schedule(at, [&] { plant.system.power_off(*plant.plcs[0]); });
  plant.system.schedule(at + 1, [&] { plant.system.power_on(*plant.plcs[0]); });
  plant.run_for(kSecond);
  EXPECT_TRUE(plant.plcs[0]->powered());
  EXPECT_EQ(plant.ask(1, modbus::read_holding_registers(0, 1)), "01 03 02 00 00");
}

TEST(System, SomethingScheduledComesWithinAnExchange) {
  Plant plant({slave(1), slave(2)});
  plant.start();
  plant.system.schedule(plant.system.time() + 5 * kMillisecond, [&] { plant.system.power_off(*plant.plcs[0]); });
  EXPECT_EQ(plant.ask(1, modbus::read_holding_registers(0, 1)), "-") << "its power went off within the request";
  EXPECT_NE(plant.ask(2, modbus::read_holding_registers(0, 1)), "-");
}

}  // namespace
}  // namespace s7200::serial::system_test
