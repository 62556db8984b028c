// Bands of execution times: which tables they have, and how what came of them is added up.
#include "tools/measuring/band.hpp"

#include <gtest/gtest.h>

#include "interpreter/model/named_times.hpp"
#include "interpreter/program/load.hpp"

namespace s7200::tools {
namespace {

TEST(TimesBand, EachFigureIsWithinItsUncertaintyAndTheSameSeedGivesTheSameTable) {
  const TimeTable table = default_times(cpu214());
  for (std::uint32_t number = 0; number < 50; ++number) {
    const TimeTable random = random_times(table, 1, number);
    EXPECT_EQ(to_csv(random), to_csv(random_times(table, 1, number)));
    for (std::size_t i = 0; i < table.rows().size(); ++i) {
      const TimeRow &row = table.rows()[i], &other = random.rows()[i];
      const double factor = 1 + row.uncertainty / 100;
      EXPECT_GE(static_cast<double>(other.base), static_cast<double>(row.base) / factor - 1) << row.mnemonics[0];
      EXPECT_LE(static_cast<double>(other.base), static_cast<double>(row.base) * factor + 1) << row.mnemonics[0];
      EXPECT_EQ(other.base == 0, row.base == 0) << row.mnemonics[0];
    }
  }
  EXPECT_NE(to_csv(random_times(table, 1, 0)), to_csv(random_times(table, 2, 0)));
}

TEST(TimesBand, TheTableInUseComesFirstThenTheOthersOfTheCpuThenRandomOnes) {
  std::vector<std::string> errors;
  const auto band = load_band(cpu214(), "", {.random = 3, .seed = 1}, errors);
  ASSERT_TRUE(band);
  ASSERT_EQ(band->size(), 5U);
  EXPECT_EQ(to_csv((*band)[0]), to_csv(default_times(cpu214())));
  EXPECT_EQ((*band)[1].find("MOVB", {})->marker, "remembered");
}

TEST(TimesBand, ATableThatIsAskedForIsTheOnlyOneBesidesRandomOnes) {
  std::vector<std::string> errors;
  const auto band = load_band(cpu214(), "cpu214_from_22x", {.random = 3, .seed = 1}, errors);
  ASSERT_TRUE(band);
  EXPECT_EQ(band->size(), 4U);
  EXPECT_FALSE(load_band(cpu214(), "no such file", {.random = 3, .seed = 1}, errors));
  EXPECT_EQ(errors.size(), 1U);
}

TEST(ProgramBand, KeepsTheProgramsOfTheFirstTablesAndMakesTheOthersAnewAlike) {
  std::vector<std::string> errors;
  auto tables = load_band(cpu214(), "", {.random = 1000, .seed = 1}, errors);
  ASSERT_TRUE(tables);
  const ProgramBand band(stl::parse("LD I0.0\nMOVB 1, VB0\nMEND\n", "band.stl"), cpu214(), *tables, {});
  EXPECT_EQ(band.size(), 1002U);
  EXPECT_EQ(band.program(1), band.program(1));
  const auto one = band.program(1001), other = band.program(1001);
  EXPECT_NE(one, other);
  EXPECT_EQ(one->ops[1].cost, other->ops[1].cost);
  EXPECT_EQ(to_csv((*tables)[1001]), to_csv(random_times(default_times(cpu214()), 1, 999)));
}

TEST(ExchangeBand, CountsVerdictsAndLosersAndKeepsTheShortestAndLongestLatency) {
  const auto exchange = [](Time latency) {
    return serial::Exchange{.request = {}, .request_end = 0, .response = {{}}, .response_start = latency};
  };
  ExchangeBand band;
  band.add({exchange(16 * kMillisecond), "answered", 0});
  band.add({exchange(20 * kMillisecond), "answered", 2});
  band.add({std::nullopt, "no answer", 1});
  EXPECT_EQ(band.text(),
            "after 16.0 … 20.0 ms   answered: 2 of 3 tables; no answer: 1 of 3; characters or events lost: 2 of 3");
  EXPECT_EQ(band.json()["latency_us"].dump(), R"({"least":16000.0,"most":20000.0})");
}

}  // namespace
}  // namespace s7200::tools
