// Bands of execution times: which tables they have, and how what came of them is added up.
#include "tools/measuring/band.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/model/times/named_times.hpp"
#include "interpreter/model/times/times_file.hpp"
#include "tools/host/files/files.hpp"

namespace s7200::tools::band_test {
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

TEST(TimesBand, ACpuIsFasterOrSlowerAsAWholeByAsMuchAsTheTipsFirstScanLeavesOpen) {
  const std::string header = "mnemonic,form,base_us,per_unit_us,unit,marker,source,uncertainty_percent\n";
  TimeTable table;
  for (const Instruction& instruction : all_instructions())
    ASSERT_TRUE(table.add(header + std::string(instruction.mnemonic) + ",,100,,,estimate,,25\n", "t.csv").empty());
  double least = 1, most = 1;
  for (std::uint32_t number = 0; number < 200; ++number) {
    double sum = 0;
    const TimeTable drawn = random_times(table, 1, number);
    for (const TimeRow& row : drawn.rows()) sum += static_cast<double>(row.base);
    const double mean = sum / 100'000 / static_cast<double>(table.rows().size());
    least = std::min(least, mean);
    most = std::max(most, mean);
  }
  EXPECT_LT(least, 0.96) << "errors of single figures cancel to a percent or two";
  EXPECT_GT(most, 1.04);
  EXPECT_GT(least, 0.90);
  EXPECT_LT(most, 1.10);
}

TEST(TimesBand, PartsOfASumMoveByTheSameShareOfTheirWay) {
  const auto settled = [](double sum) {
    std::vector<PartOfSum> parts{{30, {20, 36}}, {10, {8, 14}}};
    settle(parts, sum);
    return std::pair(parts[0].figure, parts[1].figure);
  };
  EXPECT_EQ(settled(45), std::pair(33.0, 12.0));
  EXPECT_EQ(settled(34), std::pair(25.0, 9.0)) << "downwards, half of 10 and of 2";
  EXPECT_EQ(settled(40), std::pair(30.0, 10.0));
  EXPECT_EQ(settled(60), std::pair(36.0, 14.0)) << "as far as their ranges allow";
}

TEST(TimesBand, WhatAnEarlierSumHasSettledStaysInALaterOne) {
  TimeTable times;
  ASSERT_EQ(times.add("mnemonic,form,base_us,per_unit_us,unit,marker,source,uncertainty_percent,base_within_us\n"
                      "(sum),CALL + RET,45,,,measured,,,0.001\n(sum),CALL + (interrupt entry),60,,,measured,,,0.001\n"
                      "CALL,,30,,,measured,,,10\nRET,,10,,,measured,,,10\n(interrupt entry),,50,,,measured,,,40\n",
                      "sums.csv"),
            std::vector<std::string>{});
  for (std::uint32_t number = 0; number < 50; ++number) {
    const TimeTable drawn = random_times(times, 1, number);
    const Time call = drawn.find("CALL", {})->base;
    EXPECT_NEAR(static_cast<double>(call + drawn.find("RET", {})->base), 45'000, 2) << number;
    EXPECT_NEAR(static_cast<double>(call + drawn.find("(interrupt entry)", {})->base), 60'000, 2) << number;
  }
}

TEST(TimesBand, ALineWithSeveralMnemonicsOfASumCountsForEachOfThem) {
  TimeTable times;
  ASSERT_EQ(times.add("mnemonic,form,base_us,per_unit_us,unit,marker,source,uncertainty_percent,base_within_us\n"
                      "(sum),MOVW + RET + MOVB,45,,,measured,,,0.001\n(sum),MOVB + (interrupt entry),60,,,measured,,,0.001\n"
                      "MOVB MOVW,,15,,,measured,,,10\nRET,,10,,,measured,,,10\n(interrupt entry),,50,,,measured,,,40\n",
                      "sums.csv"),
            std::vector<std::string>{});
  for (std::uint32_t number = 0; number < 50; ++number) {
    const TimeTable drawn = random_times(times, 1, number);
    const Time move = drawn.find("MOVW", {})->base;
    EXPECT_NEAR(static_cast<double>(2 * move + drawn.find("RET", {})->base), 45'000, 3) << number;
    EXPECT_NEAR(static_cast<double>(move + drawn.find("(interrupt entry)", {})->base), 60'000, 3) << number;
  }
}

TEST(TimesBand, NoFigureIsDrawnBeyondTheLongestThatATableMayHave) {
  const std::string header = "mnemonic,form,base_us,per_unit_us,unit,marker,source,uncertainty_percent\n";
  TimeTable table = default_times(cpu214());
  ASSERT_TRUE(table.add(header + "MOVB,,100000,,,measured,me,1000\nSLW,,100000,100000,bit,measured,me,1000\n", "t").empty());
  for (std::uint32_t number = 0; number < 50; ++number) {
    const TimeTable random = random_times(table, 1, number);
    EXPECT_LE(random.find("MOVB", {})->base, kLongestFigure);
    EXPECT_LE(random.find("SLW", {})->per_unit, kLongestFigure);
    const auto program = check_text("LD I0.0\nMOVB *AC1, *AC2\nMEND\n", "slow.stl", cpu214(), random).program;
    for (const Op& op : program->ops) EXPECT_GE(op.cost, 0);
  }
}

TEST(TimesBand, TheTableInUseComesFirstThenTheOthersOfTheCpuThenRandomOnes) {
  std::vector<std::string> errors;
  const auto band = load_band(cpu214(), "", host_files(), {.random = 3, .seed = 1}, errors);
  ASSERT_TRUE(band);
  ASSERT_EQ(band->size(), 5U);
  EXPECT_EQ(to_csv((*band)[0]), to_csv(default_times(cpu214())));
  EXPECT_EQ((*band)[1].find("MOVB", {})->marker, "remembered");
}

TEST(TimesBand, ATableThatIsAskedForComesFirstAndWithoutTheOthersIfItIsNoneOfTheCpus) {
  std::vector<std::string> errors;
  const auto band = load_band(cpu214(), "cpu214_from_22x", host_files(), {.random = 3, .seed = 1}, errors);
  ASSERT_TRUE(band);
  EXPECT_EQ(band->size(), 5U);
  EXPECT_EQ(band->name(0), "cpu214_from_22x");
  EXPECT_EQ((*band)[0].find("MOVB", {})->marker, "remembered");
  EXPECT_EQ(band->name(1), "cpu214");
  EXPECT_EQ(band_around(cpu214(), "measured.csv", default_times(cpu214()), {.random = 3, .seed = 1}).size(), 4U);
  EXPECT_FALSE(load_band(cpu214(), "no such file", host_files(), {.random = 3, .seed = 1}, errors));
  EXPECT_EQ(errors.size(), 1U);
}

TEST(ProgramBand, KeepsTheProgramsOfTheFirstTablesAndMakesTheOthersAnewAlike) {
  std::vector<std::string> errors;
  auto tables = load_band(cpu214(), "", host_files(), {.random = 1000, .seed = 1}, errors);
  ASSERT_TRUE(tables);
  const ProgramBand band(stl::parse("LD I0.0\nMOVB 1, VB0\nMEND\n", "band.stl"), cpu214(), *tables, {});
  EXPECT_EQ(band.size(), 1002U);
  EXPECT_EQ(band.program(1), band.program(1));
  const auto one = band.program(1001), other = band.program(1001);
  EXPECT_NE(one, other);
  EXPECT_EQ(one->ops[1].cost, other->ops[1].cost);
  EXPECT_EQ(to_csv((*tables)[1000]), to_csv(random_times(default_times(cpu214()), 1, 998)));
  EXPECT_EQ(to_csv((*tables)[1001]), to_csv(random_times((*tables)[1], 1, 999))) << "around each of the named in turn";
}

TEST(ExchangeBand, CountsVerdictsAndLosersAndKeepsTheShortestAndLongestLatency) {
  const auto exchange = [](Time latency) {
    return serial::Exchange{.request = {}, .request_end = 0, .response = {{}}, .response_start = latency};
  };
  ExchangeBand band;
  band.add({exchange(16 * kMillisecond), "answered", 0});
  band.add({exchange(20 * kMillisecond), "answered", 2});
  band.add({std::nullopt, "no answer", 1, "CPU in STOP"});
  EXPECT_EQ(band.text(),
            "after 16.0 … 20.0 ms   answered: 2 of 3 tables; no answer: 1 of 3; CPU in STOP: 1 of 3; characters or events "
            "lost: 2 of 3");
  EXPECT_EQ(band.json()["stops"].dump(), R"([{"why":"CPU in STOP","tables":1}])");
  EXPECT_EQ(band.json()["latency_us"].dump(), R"({"least":16000.0,"most":20000.0})");
}

}  // namespace
}  // namespace s7200::tools::band_test
