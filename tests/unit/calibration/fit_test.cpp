// Figures out of the times of loops: which of them loops tell apart, and how sure they are.
#include "tools/calibration/fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace s7200::tools::fit_test {
namespace {

const TimeRow& line_of(const char* mnemonic) {
  static const TimeTable kTimes = default_times(cpu214());
  return *kTimes.find(mnemonic, Area::V);
}

Form form(const char* mnemonic, bool per_unit = false) { return {mnemonic, &line_of(mnemonic), per_unit}; }

TEST(Fit, AFormIsFoundIfTheLoopsTellItApart) {
  // NEXT alone; NEXT and two MOVB; NEXT, LPS and LPP, which are never one without the other.
  const Loops loops{{form("NEXT"), form("MOVB"), form("LPS"), form("LPP")}, {{1, 0, 0, 0}, {1, 2, 0, 0}, {1, 0, 1, 1}}};
  const Fit found = fit(loops, {{150'000, 100}, {210'000, 100}, {152'000, 100}});
  EXPECT_TRUE(found.forms[0].found && found.forms[1].found);
  EXPECT_FALSE(found.forms[2].found || found.forms[3].found);
  EXPECT_NEAR(found.forms[0].ns, 150'000, 1e-6);
  EXPECT_NEAR(found.forms[1].ns, 30'000, 1e-6);
  EXPECT_NEAR(found.forms[1].within, 100, 1e-6) << "two errors of 100 over two instructions";
  EXPECT_EQ(found.contradiction, 0);
}

TEST(Fit, APartOfASumIsInTheMiddleOfWhatIsKnownOfItAsFarAsTheSumLeavesItThat) {
  // Known: CALL 23 within 25 %, RET 18 within 40 %, CRET 17 within 195 %. This CPU takes twice as long for all of them.
  const Loops loops{{form("NEXT"), form("CALL"), form("RET"), form("CRET")}, {{1, 0, 0, 0}, {1, 1, 1, 0}, {1, 1, 0, 1}}};
  const Fit found = fit(loops, {{300'000, 0}, {300'000 + 82'000, 0}, {300'000 + 80'000, 0}});
  ASSERT_EQ(found.sums.size(), 2U);
  EXPECT_EQ(found.sums[0].text, "CALL + RET");
  EXPECT_NEAR(found.sums[0].ns, 82'000, 1e-6);
  EXPECT_EQ(found.sums[1].text, "CALL + CRET");
  const Fitted &call = found.forms[1], &ret = found.forms[2], &cret = found.forms[3];
  EXPECT_FALSE(call.found);
  EXPECT_EQ(call.sum, 0U);
  const double shortest = 82'000 - 2 * 18'000 * 1.4, longest = 2 * 23'000 * 1.25;
  EXPECT_NEAR(call.ns - call.within, shortest, 1e-6) << "RET twice as long, and as long as it may be";
  EXPECT_NEAR(call.ns + call.within, longest, 1e-6);
  EXPECT_NEAR(ret.ns - ret.within, 82'000 - longest, 1e-6);
  EXPECT_NEAR(ret.ns + ret.within, 82'000 - shortest, 1e-6);
  EXPECT_NEAR(call.ns + ret.ns, 82'000, 1e-6);
  EXPECT_EQ(cret.sum, 1U);
  EXPECT_NEAR(cret.ns, 80'000 - call.ns, 1e-6) << "what CALL leaves";
  EXPECT_NEAR(cret.within, call.within, 1e-6);
}

TEST(Fit, APartOfASumThatTheKnownFiguresCannotMakeIsAnythingUpToTheWholeOfIt) {
  const Loops loops{{form("NEXT"), form("CALL"), form("RET")}, {{1, 0, 0}, {1, 1, 1}}};
  const Fit found = fit(loops, {{150'000, 0}, {150'000 + 82'000, 0}});
  for (const std::size_t part : {1U, 2U}) {
    EXPECT_NEAR(found.forms[part].ns, 41'000, 1e-6);
    EXPECT_NEAR(found.forms[part].within, 41'000, 1e-6);
  }
}

TEST(Fit, InterruptsTakeTheirTimeFromTheWholeRun) {
  // NEXT of 100 us, which takes 102 while every 5 ms an interrupt comes.
  const Loops loops{{form("NEXT"), form("RETI")}, {{1, 0}, {1, 0}}, {{1, {0, 1}}}};
  const double whole = 102'000;
  const Fit found = fit(loops, {{100'000, 0, 100'000}, {whole, 0, whole}});
  EXPECT_NEAR(found.forms[1].ns, 2'000 / (whole / 5e6), 1e-6);
}

TEST(Fit, LoopsThatDisagreeByMoreThanTheirErrorsAreAContradiction) {
  const Loops loops{{form("NEXT")}, {{1}, {2}}};
  EXPECT_EQ(fit(loops, {{150'000, 100}, {300'100, 100}}).contradiction, 0);
  EXPECT_NEAR(fit(loops, {{150'000, 100}, {302'000, 100}}).contradiction, 850, 1e-6) << "1000 of which 150 are the clock's";
}

TEST(Fit, ALineIsWrittenWithAllItsFiguresAndWithTheBoundOfEach) {
  const TimeTable own = default_times(cpu214());
  const Loops loops{{form("SLW"), form("SLW", true)}, {{1, 1}, {1, 15}}};
  const TimeTable table = calibrated(fit(loops, {{80'000, 140}, {136'000, 140}}), own, own, "a CPU");
  const TimeRow& row = *table.find("SLW", Area::V);
  EXPECT_EQ(row.base, 76'000);
  EXPECT_EQ(row.per_unit, 4'000);
  EXPECT_EQ(row.marker, "measured");
  EXPECT_EQ(row.source, "a CPU");
  EXPECT_EQ(row.uncertainty, 0);
  EXPECT_NEAR(static_cast<double>(row.base_within), 160, 1);
  EXPECT_NEAR(static_cast<double>(row.per_unit_within), 20, 1);
  EXPECT_NE(calibrated(fit({loops.forms, {{1, 1}}}, {{80'000, 140}}), own, own, "a CPU").find("SLW", {})->marker, "measured")
      << "base and unit are not told apart";
}

TEST(Calibrated, WhatWasNotMeasuredIsAsMuchSlowerAsTheMiddleOfWhatWas) {
  const TimeTable own = default_times(cpu214());
  const Loops loops{{form("NEXT"), form("MOVB"), form("MOVW")}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const Fit found = fit(loops, {{225'000, 10}, {36'000, 10}, {22'000, 10}});  // 1.5, 1.2 and 0.5 times the estimates
  EXPECT_DOUBLE_EQ(ratio_to_known(found).value_or(0), 1.2);
  const TimeTable table = calibrated(found, own, own, "a CPU");
  const TimeRow& call = *table.find("CALL", {});
  EXPECT_EQ(call.base, 27'600);
  EXPECT_EQ(call.marker, "calibrated");
  EXPECT_EQ(call.source, "not measured: 1.20 × estimate, no page of the manual found");
  EXPECT_EQ(call.base_within, 9'200) << "down to 23 / 1.25, and up to 23 × 1.25 × 1.20";
  EXPECT_EQ(table[SystemTime::EepromSave], own[SystemTime::EepromSave]) << "a part of its own";
}

TEST(Calibrated, AfterAnInterruptionWithFewerThanHalfMeasuredTheOtherFiguresAreTheCpusOwn) {
  const TimeTable own = default_times(cpu214());
  const Loops loops{{form("NEXT"), form("MOVB"), form("MOVW")}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const Fit found = fit(loops, {{225'000, 10}});
  EXPECT_FALSE(ratio_to_known(found)) << "one of three";
  const TimeTable table = calibrated(found, own, own, "a CPU");
  EXPECT_EQ(table.find("NEXT", {})->base, 225'000);
  EXPECT_EQ(table.find("MOVB", {})->base, own.find("MOVB", {})->base);
  EXPECT_TRUE(ratio_to_known(fit(loops, {{225'000, 10}, {36'000, 10}}))) << "two of three";
  const auto why = [&](std::string_view name) {
    const auto missing = not_measured(found, cpu214());
    const auto it = std::ranges::find(missing, name, &NotMeasured::name);
    return it == missing.end() ? "measured" : std::string(it->why);
  };
  EXPECT_EQ(why("NEXT"), "measured");
  EXPECT_EQ(why("MOVB"), "interrupted before its loop ran");
  EXPECT_EQ(why("CALL"), "the loops do not tell it apart") << "it is in none of these";
}

TEST(ToldApart, FirstOperandsThatAnyTableOfTheCpuKnowsToDifferHaveLinesOfTheirOwn) {
  const TimeTable times = told_apart(cpu214());
  const auto same = [&](const char* mnemonic, Area one, Area other) {
    return times.find(mnemonic, one) == times.find(mnemonic, other);
  };
  EXPECT_TRUE(same("R", Area::V, Area::Q));
  EXPECT_FALSE(same("R", Area::V, Area::T));
  EXPECT_FALSE(same("R", Area::T, Area::C));
  EXPECT_FALSE(same("LD", Area::I, Area::Q));
  EXPECT_TRUE(same("LD", Area::V, Area::S));
  EXPECT_TRUE(same("MOVB", Area::V, Area::AC)) << "an accumulator adds the same to any instruction";
  EXPECT_TRUE(times.find(name_of(SystemTime::OperandArea), Area::AC));
  for (const CpuModel* model : all_cpus()) {
    const TimeTable own = default_times(*model), split = told_apart(*model);
    for (const TimeRow& row : own.rows())
      for (const std::string& mnemonic : row.mnemonics)
        for (const AreaInfo& area : all_areas()) {
          const TimeRow *before = own.find(mnemonic, area.area), *now = split.find(mnemonic, area.area);
          EXPECT_TRUE((!before && !now) || (before && now && before->base == now->base)) << mnemonic << ' ' << area.name;
        }
  }
}

TEST(FindLoops, EachLoopOfTheProgramConsistsOfWhatIsWrittenInIt) {
  const TimeTable times = told_apart(cpu214());
  const Loops loops = find_loops(cpu214(), times);
  ASSERT_GT(loops.loops.size(), 100U);
  const auto count = [&](std::size_t loop, const std::string& mnemonic, bool per_unit = false) {
    double sum = 0;
    for (std::size_t i = 0; i < loops.forms.size(); ++i)
      if (loops.forms[i].mnemonic == mnemonic && loops.forms[i].per_unit == per_unit) sum += loops.loops[loop][i];
    return sum;
  };
  EXPECT_EQ(count(0, "NEXT"), 1);
  EXPECT_EQ(count(0, "LD"), 0);
  EXPECT_EQ(count(1, "WDR"), 4);
  EXPECT_EQ(count(152, "JMP"), 1);
  EXPECT_EQ(count(152, "LBL"), 8) << "also where the table says that it takes no time";
  EXPECT_EQ(count(2, "LD"), 9);
  EXPECT_EQ(count(2, "="), 9);
  bool any_shift_of_15 = false;
  for (std::size_t loop = 0; loop < loops.loops.size(); ++loop) any_shift_of_15 |= count(loop, "SLW", true) == 15;
  EXPECT_TRUE(any_shift_of_15);
  EXPECT_EQ(count(163, "(operand area adds)"), 8) << "two accumulators in each of four";
  EXPECT_EQ(count(185, "CALL"), 1);
  EXPECT_EQ(count(185, "RET"), 1);
  const auto in_interrupt = [&](std::size_t loop, std::string_view mnemonic) {
    const auto form = std::ranges::find(loops.forms, mnemonic, &Form::mnemonic);
    return form == loops.forms.end() ? 0 : loops.interrupts.at(loop)[static_cast<std::size_t>(form - loops.forms.begin())];
  };
  EXPECT_EQ(loops.interrupts.size(), 2U);
  EXPECT_EQ(in_interrupt(189, "(interrupt entry)"), 1);
  EXPECT_EQ(in_interrupt(189, "RETI"), 1);
  EXPECT_EQ(in_interrupt(190, "CRETI"), 1);
  EXPECT_EQ(in_interrupt(190, "NEXT"), 0);
  EXPECT_EQ(count(189, "NEXT"), 1);
  EXPECT_EQ(count(loops.loops.size() - 1, "(scan overhead)"), 1) << "the last one runs scans";
  EXPECT_EQ(count(loops.loops.size() - 1, "MEND"), 1);
}

}  // namespace
}  // namespace s7200::tools::fit_test
