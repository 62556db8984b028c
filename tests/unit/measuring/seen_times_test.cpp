// What is seen in a run is within the bounds.
#include "tools/measuring/seen_times.hpp"

#include <filesystem>

#include "interpreter/analysis/bounds.hpp"
#include "interpreter/analysis/flow/calls.hpp"
#include "tests/support/inspected.hpp"
#include "tests/support/source_path.hpp"
#include "tools/host/files/files.hpp"

namespace s7200::tools::seen_times_test {
namespace {

TEST(SeenTimes, AreWithinTheBoundsOfOurPrograms) {
  std::size_t compared = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_path("stl_programs"))) {
    if (entry.path().extension() != ".stl") continue;
    const auto bytes = read_file(entry.path().string());
    ASSERT_TRUE(bytes) << bytes.why();
    const Inspection inspection = test::inspected(*bytes, {}, *find_cpu(test::cpu_named_in(*bytes)));
    const Bounds bounds =
        bounds_of(inspection.facts, calls_of(*inspection.program, inspection.facts.flow), *inspection.program);
    const auto seen = seen_times(inspection);
    ASSERT_TRUE(seen) << entry.path();
    if (bounds.scan_with_interrupts && bounds.routines[0].loops.empty()) {
      EXPECT_LE(seen->scan, *bounds.scan_with_interrupts) << entry.path();
      ++compared;
    }
    for (const Bounds::OfEvent& event : bounds.events) {
      const auto found = seen->events.find(event.event);
      if (found == seen->events.end() || !event.loops.empty()) continue;
      EXPECT_LE(found->second.longest_routine, event.longest_routine) << entry.path() << " event " << int{event.event};
      if (event.latency) {
        EXPECT_LE(found->second.latency, *event.latency) << entry.path() << " event " << int{event.event};
      }
    }
  }
  EXPECT_GT(compared, 3U);
}

TEST(SeenTimes, HasNothingOfAnInterruptThatIsNeverServed) {
  constexpr std::string_view kAttached = "LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\n",
                             kRest = "MEND\nINT 0\nLD SM0.0\nINCW VW0\nRETI\n";
  const auto seen = [&](std::string_view enables) {
    return seen_times(test::inspected(std::string(kAttached) + std::string(enables) + std::string(kRest)))
        ->events.contains(10);
  };
  EXPECT_TRUE(seen("ENI\n"));
  EXPECT_FALSE(seen(""));
}

TEST(SeenTimes, TheSlowestTableTakesEachFigureAtTheEndOfItsRange) {
  TimeRow row;
  row.mnemonics = {"LD"};
  row.base = 100;
  row.marker = "estimate";
  row.uncertainty = 50;
  const TimeTable slow = slowest(TimeTable({row}));
  EXPECT_EQ(slow.rows()[0].base, 150);
}

}  // namespace
}  // namespace s7200::tools::seen_times_test
