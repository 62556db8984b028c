// What faults have done, in words and as JSON.
#include <gtest/gtest.h>

#include "interpreter/base/event_queue.hpp"
#include "tools/views/state/faults.hpp"

namespace s7200::tools::faults_text_test {
namespace {

struct Bench {
  serial::Line line;
  EventQueue queue;
  serial::Uart master{line, queue, EventOwner{1}, 0};
  serial::Uart slave{line, queue, EventOwner{2}, 1};
  serial::Faults faults{line, queue, EventOwner{0}};

  void inject(const char* text, Time now, int driver = serial::Faults::kAnyDriver) {
    faults.inject(serial::parse_fault(text).fault, now, driver);
  }
  void send(std::uint8_t byte, Time at) { send(master, byte, at); }
  void send(serial::Uart& sender, std::uint8_t byte, Time at) {
    sender.send(byte, at);
    while (queue.next() != kNever) {
      const Event event = queue.pop();
      if (event.owner == EventOwner{1}) master.handle(event);
      if (event.owner == EventOwner{2}) slave.handle(event);
    }
  }
};

std::string name(int driver) { return driver == 0 ? "pump" : ""; }

TEST(FaultsText, AFaultOfOneStationHasItsName) {
  Bench bench;
  bench.inject("flip:character=each", 0, 0);
  bench.inject("flip:character=each", 0);
  bench.send(1, 0);
  EXPECT_EQ(fault_notes(bench.faults, name),
            (std::vector<std::string>{"fault flip:character=each of pump: 1×", "fault flip:character=each: 1×"}));
  EXPECT_EQ(faults_json(bench.faults, name).dump(),
            R"([{"fault":"flip:character=each","station":"pump","count":1,"impossible":0},)"
            R"({"fault":"flip:character=each","count":1,"impossible":0}])");
}

TEST(FaultsText, WhatHasHappenedSinceIsRightAlsoWhenFaultsHaveComeAndGone) {
  Bench bench;
  bench.inject("flip:character=each", 0);
  bench.inject("flip:character=each,bit=1", 0);
  bench.send(1, 0);
  const serial::Faults::State before = bench.faults.state();
  bench.faults.clear(kSecond);
  bench.inject("flip:character=each,bit=2", kSecond);
  bench.send(1, 2 * kSecond);
  EXPECT_EQ(faults_json(bench.faults, before).dump(), R"([{"fault":"flip:character=each,bit=2","count":1,"impossible":0}])");
}

TEST(FaultsText, AnAnswerThatWasNotChangedHasOneReason) {
  Bench bench;
  bench.faults.add_plc(bench.slave);  // whose answers have no known length
  for (const char* const fault : {"answer:stale", "answer:silent", "answer:short"}) bench.inject(fault, 0);
  bench.send(1, 0);
  bench.send(bench.slave, 2, 100 * kMillisecond);
  EXPECT_EQ(fault_notes(bench.faults, name),
            (std::vector<std::string>{"fault answer:stale: 0×, and 1× there was no earlier answer to repeat",
                                      "fault answer:silent: 0×, and 1× it was not known how long the answer is",
                                      "fault answer:short: 0×, and 1× the answer was too short, or of unknown length"}));
}

}  // namespace
}  // namespace s7200::tools::faults_text_test
