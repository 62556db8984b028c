// Figures out of the times of loops: which of them loops tell apart, and how sure they are.
#include "tools/calibration/fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace s7200::tools {
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

TEST(Fit, LoopsThatDisagreeByMoreThanTheirErrorsAreAContradiction) {
  const Loops loops{{form("NEXT")}, {{1}, {2}}};
  EXPECT_EQ(fit(loops, {{150'000, 100}, {300'100, 100}}).contradiction, 0);
  EXPECT_NEAR(fit(loops, {{150'000, 100}, {302'000, 100}}).contradiction, 850, 1e-6) << "1000 of which 150 are the clock's";
}

TEST(Fit, ALineIsWrittenWithAllItsFiguresAndTheWorseOfTheirUncertainties) {
  const Loops loops{{form("SLW"), form("SLW", true)}, {{1, 1}, {1, 15}}};
  const Fit found = fit(loops, {{80'000, 140}, {136'000, 140}});
  EXPECT_EQ(fitted_csv(found, "a CPU"),
            "mnemonic,form,base_us,per_unit_us,unit,marker,source,uncertainty_percent\n"
            "SLW,,76.000,4.000,bit,measured,\"a CPU\",0.51\n");
  EXPECT_EQ(fitted_csv(fit({loops.forms, {{1, 1}}}, {{80'000, 140}}), "a CPU").find("SLW"), std::string::npos)
      << "base and unit are not told apart";
}

TEST(FindLoops, EachLoopOfTheProgramConsistsOfWhatIsWrittenInIt) {
  const TimeTable times = default_times(cpu214());
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
  EXPECT_EQ(count(2, "LD"), 9);
  EXPECT_EQ(count(2, "="), 9);
  bool any_shift_of_15 = false;
  for (std::size_t loop = 0; loop < loops.loops.size(); ++loop) any_shift_of_15 |= count(loop, "SLW", true) == 15;
  EXPECT_TRUE(any_shift_of_15);
}

}  // namespace
}  // namespace s7200::tools
