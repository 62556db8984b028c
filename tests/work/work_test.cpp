// How much work a listing or a recording is grows as it does and no faster. Work is counted in what is allocated for it, by
// number and by bytes: that is the same on every machine, and what is done again and again for each line allocates again and
// again.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <string>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/program/load.hpp"
#include "tools/measuring/long_listing.hpp"
#include "tools/recordings/conversation.hpp"
#include "tools/views/program/check_report.hpp"

namespace {

struct Work {
  std::uint64_t allocations = 0, bytes = 0;
};
Work done;

}  // namespace

void* operator new(std::size_t size) {
  ++done.allocations;
  done.bytes += size;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace s7200::tools {
namespace {

/// Of all that `s7200 check` does with a text.
Work work_of(const std::string& listing) {
  const Work before = done;
  const CpuModel& model = *find_cpu("226XM");
  const auto text = read_source(listing, "long.stl");
  const CheckResult result = check(text->parsed, model, default_times(model));
  const std::string shown = render(result.diagnostics, result.source, false);
  EXPECT_FALSE(check_summary(*text, result, model, fine_for(*text, result, model)).empty());
  return {done.allocations - before.allocations, done.bytes - before.bytes};
}

/// `times` as long a listing is so many times the work, and a little more for what grows by doubling.
void expect_in_proportion(const std::string& listing, const std::string& longer, double times) {
  work_of(listing);  // what is made only once
  const Work one = work_of(listing), more = work_of(longer);
  EXPECT_LT(static_cast<double>(more.allocations), 1.1 * times * static_cast<double>(one.allocations));
  EXPECT_LT(static_cast<double>(more.bytes), 1.3 * times * static_cast<double>(one.bytes));
}

std::string repeated(std::uint32_t times, auto network) {
  std::string text;
  for (std::uint32_t i = 0; i < times; ++i) text += network(i);
  return text + "MEND\n";
}

TEST(WorkOfChecking, GrowsAsTheListingDoes) { expect_in_proportion(long_listing(4'000), long_listing(40'000), 10); }

TEST(WorkOfChecking, GrowsAsTheMistakesDo) {
  const auto network = [](std::uint32_t i) {
    return fmt::format("NETWORK {0}\nLD X{0}\nFRO{0} VW{0}\nMOVB VW0, VB1\n= M3.9\nA I0.0 (\n", i);
  };
  expect_in_proportion(repeated(500, network), repeated(5'000, network), 10);
}

TEST(WorkOfChecking, GrowsAsTheCommentsDo) {
  const auto network = [](std::uint32_t i) { return fmt::format("// {} is what the text says\n\n   // and why\n", i); };
  expect_in_proportion(repeated(1'000, network), repeated(10'000, network), 10);
}

TEST(WorkOfChecking, GrowsAsTheCoilsDoOfWhichEachIsThereTwice) {
  const auto program = [](std::uint32_t coils) {
    return repeated(2 * coils, [=](std::uint32_t i) { return fmt::format("LD SM0.0\n= V{}.{}\n", i % coils / 8, i % 8); });
  };
  expect_in_proportion(program(96), program(1'920), 20);
}

/// Of what `s7200 decode` reads.
Work work_of_reading(const std::string& recording) {
  const Work before = done;
  auto read = read_recording(recording, {});
  EXPECT_TRUE(read.has_value() || recording.find_first_not_of("\r\n") == std::string::npos) << read.why();
  if (!read) return {done.allocations - before.allocations, done.bytes - before.bytes};
  settle_directions(*read, *find_recorded_protocol("modbus"));
  std::size_t right = 0;
  tell_conversation(*read, *find_recorded_protocol("modbus"), {},
                    [&](const ReadFrame& frame) { return right += frame.right, true; });
  EXPECT_GT(right, read->frames.size() / 2) << recording.substr(0, 200);
  return {done.allocations - before.allocations, done.bytes - before.bytes};
}

TEST(WorkOfReading, GrowsAsARecordingOfAnyFormDoes) {
  const std::string request = "01 03 00 0a 00 02 e4 09", answer = "01 03 04 12 34 56 78 81 07";
  const std::string tcp_request = "00 01 00 00 00 06 01 03 00 0a 00 02",
                    tcp_answer = "00 01 00 00 00 07 01 03 04 12 34 56 78";
  struct Form {
    std::string head, rows;
  };
  for (const Form& form :
       {Form{"", "10:00:00.000 TX " + request + "\n10:00:00.030 RX " + answer + "\n"},
        Form{"", request + "\n" + answer + "\n"}, Form{"", "TX " + tcp_request + "\nRX " + tcp_answer + "\n"},
        Form{"", "10:00:00.000  length=8\n0000  " + request + "   |........|\n10:00:00.030  length=9\n0000  " + answer +
                     "   |....4Vx..|\n"},
        Form{"Time,Direction,Data\n", "10:00:00.000,TX," + request + "\n10:00:00.030,RX," + answer + "\n"},
        Form{"", R"({"t":"10:00:00.000","tx":")" + request + "\"}\n" + R"({"t":"10:00:00.030","rx":")" + answer + "\"}\n"},
        Form{"", "t=10:00:00.000 dir=tx data=\"" + request + "\"\nt=10:00:00.030 dir=rx data=\"" + answer + "\"\n"},
        Form{"", "\n"}}) {
    const auto rows = [&](std::size_t times) {
      std::string text = form.head;
      for (std::size_t i = 0; i < times; ++i) text += form.rows;
      return text;
    };
    const std::string one = rows(1'000), more = rows(10'000);
    work_of_reading(one);
    const Work work = work_of_reading(one), more_work = work_of_reading(more);
    EXPECT_LT(static_cast<double>(more_work.allocations), 11 * static_cast<double>(work.allocations) + 100) << form.rows;
    EXPECT_LT(static_cast<double>(more_work.bytes), 18 * static_cast<double>(work.bytes) + 10'000) << form.rows;
  }
}

}  // namespace
}  // namespace s7200::tools
