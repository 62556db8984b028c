// The same requests give the same state: traced or not, in one run or in slices, straight on or from a snapshot.
#include <gtest/gtest.h>

#include <array>
#include <string_view>

#include "tests/support/slave_bench.hpp"

namespace s7200::test::determinism_test {
namespace {

constexpr std::array<std::string_view, 6> kFrames{"0106000a1234a4bf",  "0103000a0001a408", "010f0000000801ffbed5",
                                                  "0103p000a0001a408", "01030000007d85eb", "0203000a0001a43b"};

/// Requests at fixed times, 600 ms apart.
Time begin_of(std::size_t frame) { return kSecond + static_cast<Time>(frame) * 600 * kMillisecond; }
constexpr Time kEnd = 6 * kSecond;

void start_request(SlaveBench& bench, std::size_t frame) {
  bench.simulation().configure_master(bench.format());
  bench.simulation().master().start({.frame = serial::parse_hex_frame(kFrames[frame]).frame, .timeout = 500 * kMillisecond},
                                    begin_of(frame));
}

/// Runs to `end`, `slice` at a time.
void run_to(SlaveBench& bench, Time end, Time slice) {
  while (bench.simulation().time() < end) bench.simulation().run_until(std::min(end, bench.simulation().time() + slice));
}

/// What is left of the conversation from `frame` on.
void converse(SlaveBench& bench, Time slice, std::size_t frame = 0) {
  for (; frame < kFrames.size(); ++frame) {
    run_to(bench, begin_of(frame) - kMillisecond, slice);
    start_request(bench, frame);
  }
  run_to(bench, kEnd, slice);
}

TEST(Determinism, TheWholeConversationHappens) {
  SlaveBench bench(slave_text());
  CountingSink sink;
  bench.cpu().set_sink(&sink);
  bench.simulation().power_up();
  converse(bench, kEnd);
  EXPECT_EQ(sink.of(TraceKind::Transmit), 4U);
}

TEST(Determinism, ATraceChangesNothing) {
  SlaveBench plain(slave_text()), traced(slave_text()), counted(slave_text());
  CountingSink every_instruction(true), records_only;
  traced.cpu().set_sink(&every_instruction);
  counted.cpu().set_sink(&records_only);
  for (SlaveBench* bench : {&plain, &traced, &counted}) {
    bench->simulation().power_up();
    converse(*bench, kEnd);
  }
  EXPECT_GT(every_instruction.instructions, 10'000U);
  EXPECT_TRUE(plain.simulation().snapshot() == traced.simulation().snapshot());
  EXPECT_TRUE(plain.simulation().snapshot() == counted.simulation().snapshot());
}

TEST(Determinism, SlicesChangeNothing) {
  SlaveBench whole(slave_text());
  whole.simulation().power_up();
  converse(whole, kEnd);
  for (const Time slice : {kMillisecond, 7 * kMicrosecond}) {
    SlaveBench sliced(slave_text());
    sliced.simulation().power_up();
    converse(sliced, slice);
    EXPECT_TRUE(whole.simulation().snapshot() == sliced.simulation().snapshot()) << slice;
  }
}

TEST(Determinism, ASnapshotGoesOnAsTheOriginal) {
  SlaveBench bench(slave_text());
  bench.simulation().power_up();
  converse(bench, kEnd);
  const auto end = bench.simulation().snapshot();

  // In the middle of a request, of the work on it, and of its answer.
  for (const Time into : {4 * kMillisecond, 17 * kMillisecond, 40 * kMillisecond, 200 * kMillisecond}) {
    SlaveBench first(slave_text());
    first.simulation().power_up();
    for (std::size_t frame = 0; frame < 5; ++frame) {
      run_to(first, begin_of(frame) - kMillisecond, kEnd);
      start_request(first, frame);
    }
    run_to(first, begin_of(4) + into, kEnd);
    const auto middle = first.simulation().snapshot();
    run_to(first, begin_of(5) + 50 * kMillisecond, kEnd);
    first.simulation().restore(middle);
    converse(first, kEnd, 5);
    EXPECT_TRUE(end == first.simulation().snapshot()) << "back to where it was, " << into;

    SlaveBench other(slave_text());
    other.simulation().restore(middle);
    converse(other, kEnd, 5);
    EXPECT_TRUE(end == other.simulation().snapshot()) << "in another simulation, " << into;
  }
}

void power_up_with_faults(SlaveBench& bench) {
  for (const char* const fault : {"noise:ber=0.002", "extra:probability=0.5", "collision:every=2", "echo", "baud:error=1%"})
    bench.simulation().inject(serial::parse_fault(fault).fault);
  bench.simulation().power_up();
}

TEST(Determinism, HoldsOnALineWithFaults) {
  SlaveBench whole(slave_text()), sliced(slave_text()), first(slave_text()), other(slave_text());
  for (SlaveBench* bench : {&whole, &sliced, &first}) power_up_with_faults(*bench);
  converse(whole, kEnd);
  converse(sliced, kMillisecond);
  EXPECT_TRUE(whole.simulation().snapshot() == sliced.simulation().snapshot());

  for (std::size_t frame = 0; frame < 3; ++frame) {
    run_to(first, begin_of(frame) - kMillisecond, kEnd);
    start_request(first, frame);
  }
  run_to(first, begin_of(2) + 4 * kMillisecond, kEnd);
  other.simulation().restore(first.simulation().snapshot());
  converse(other, kEnd, 3);
  EXPECT_TRUE(whole.simulation().snapshot() == other.simulation().snapshot()) << "from a snapshot inside a request";
  EXPECT_GT(whole.simulation().faults().state().injected[0].count, 50U);
}

}  // namespace
}  // namespace s7200::test::determinism_test
