#include "tools/session/past/digest.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <set>

namespace s7200::tools::digest_test {
namespace {

TEST(Digest, OfAStateKnowsEachOfItsParts) {
  const std::function<void(State&)> changes[]{
      [](State&) {},
      [](State& s) { s.time = 1; },
      [](State& s) { s.mode = Mode::Run; },
      [](State& s) { s.stack.push(true); },
      [](State& s) { s.interrupts_enabled = true; },
      [](State& s) { s.calls[2].return_to = 7; },
      [](State& s) { s.local[1][5] = 1; },
      [](State& s) { s.saved.accumulators[3] = 1; },
      [](State& s) { s.attached[8] = 1; },
      [](State& s) { s.queue[1].count = 1; },
      [](State& s) { s.queue[0].entry[3].at = 5; },
      [](State& s) { s.queue[0].entry[3].event = 5; },
      [](State& s) { s.timed_interval[1] = 5; },
      [](State& s) { s.port[0].left = 3; },
      [](State& s) { s.port[1].format.baud = 19200; },
      [](State& s) { s.port[0].message.stored = 4; },
      [](State& s) { s.ppi[0].message[9] = 1; },
      [](State& s) { s.network[0].jobs[2].station = 3; },
      [](State& s) { s.timer[37].since = 9; },
      [](State& s) { s.timer[37].preset = 9; },
      [](State& s) { s.counter_inputs[5] = 1; },
      [](State& s) { s.counter[0].current = -1; },
      [](State& s) { s.pulse[1].next.cycle = 3; },
      [](State& s) { s.clock.hour = 12; },
      [](State& s) { s.clock_set_at = 1; },
      [](State& s) { s.eeprom[10] = 1; },
      [](State& s) { s.errors[0].count = 2; },
      [](State& s) { s.forcing.memory[0].value = 1; },
      [](State& s) { s.terminals[0] = 1; },
      [](State& s) { s.image[100] = 1; },
  };
  std::set<std::string> digests;
  for (const auto& change : changes) {
    const auto state = std::make_unique<State>();
    change(*state);
    digests.insert(digest_of(*state));
  }
  EXPECT_EQ(digests.size(), std::size(changes));
}

TEST(Digest, OfWhatDrivesTheInputsKnowsItsValues) {
  const serial::FieldScript rises{.changes = {{.at = 1, .place = 2, .value = 1}}, .pulses = {}};
  serial::FieldScript falls = rises;
  falls.changes[0].value = 0;
  EXPECT_NE(digest_of(rises), digest_of(falls));
  EXPECT_EQ(digest_of(rises), digest_of(serial::FieldScript(rises)));
}

}  // namespace
}  // namespace s7200::tools::digest_test
