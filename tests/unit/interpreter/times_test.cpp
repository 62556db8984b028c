// Tables of execution times: what is read, what is refused, what is written.
#include "interpreter/model/times.hpp"

#include <gtest/gtest.h>

#include "interpreter/program/load.hpp"

namespace s7200 {
namespace {

const std::string kHeader = "mnemonic,form,base_us,per_unit_us,unit,marker,source\n";

TimeTable table(const std::string& lines) {
  TimeTable times;
  const auto errors = times.add(kHeader + lines, "times.csv");
  EXPECT_TRUE(errors.empty()) << errors[0];
  return times;
}

std::vector<std::string> errors_in(const std::string& lines) {
  TimeTable times;
  auto errors = times.add(kHeader + lines, "times.csv");
  EXPECT_EQ(times.rows().empty(), !errors.empty()) << "a text with errors changes nothing";
  return errors;
}

using Errors = std::vector<std::string>;

TEST(Times, OneLineMayServeSeveralMnemonicsAndTheirAAndOForms) {
  const TimeTable times = table("LD LDN (and A O),I Q,0.8,,,estimate,\n");
  for (const char* mnemonic : {"LD", "LDN", "A", "AN", "O", "ON"}) {
    ASSERT_TRUE(times.cost(mnemonic, Area::I)) << mnemonic;
    EXPECT_EQ(times.cost(mnemonic, Area::I)->base, 800);
    EXPECT_FALSE(times.cost(mnemonic, Area::V)) << "the line is for I and Q";
  }
}

TEST(Times, ACorrectionReplacesItsFigureAndLeavesTheOthers) {
  TimeTable times = table("MOVB,,60,,,estimate,\nSLW,,50,4.5,bit,estimate,\n");
  EXPECT_TRUE(times.add(kHeader + "MOVB,,37,,,manual,\"page 9, table \"\"A\"\"\"\n", "mine.csv").empty());
  EXPECT_EQ(times.cost("MOVB", {})->base, 37'000);
  EXPECT_EQ(times.find("MOVB", {})->source, "page 9, table \"A\"");
  EXPECT_EQ(times.cost("SLW", {})->per_unit, 4'500);
  EXPECT_FALSE(times.cost("MOVW", {}));
}

TEST(Times, WhatIsWrittenReadsBackAsItself) {
  TimeTable times = default_times(cpu215());
  EXPECT_TRUE(times.add(kHeader + "MOVB,\"V, M\",37,,,manual,\"page 9, table \"\"A\"\"\"\n", "mine.csv").empty());
  TimeTable again;
  EXPECT_TRUE(again.add(to_csv(times), "again.csv").empty());
  ASSERT_EQ(again.rows().size(), times.rows().size());
  for (std::size_t i = 0; i < times.rows().size(); ++i) {
    const TimeRow &a = times.rows()[i], &b = again.rows()[i];
    EXPECT_EQ(a.mnemonics, b.mnemonics);
    EXPECT_EQ(std::tie(a.form, a.areas, a.base, a.per_unit, a.unit, a.marker, a.source),
              std::tie(b.form, b.areas, b.base, b.per_unit, b.unit, b.marker, b.source));
  }
}

TEST(Times, WhatCannotBeReadIsNamedWithItsLine) {
  EXPECT_EQ(errors_in("MOVB,,60,,,estimate\nMOVW,,-1,,,estimate\n\nMOVD,,60,x,,estimate\n"),
            (Errors{"times.csv:3: '-1' is not a time in microseconds (0 to 1000000)",
                    "times.csv:5: 'x' is not a time in microseconds (0 to 1000000)"}));
  EXPECT_EQ(errors_in("MOVB,,60,,,guess\n"),
            Errors{"times.csv:2: 'guess' is not a marker; there are manual, estimate, calibrated, remembered"});
  EXPECT_EQ(errors_in("MOVB,,0,,,manual\n"), Errors{"times.csv:2: MOVB: an execution time must be above 0"});
  EXPECT_EQ(errors_in("LBL SBR INT,,0,,,manual\n"), Errors{});
  EXPECT_EQ(errors_in(" ,,5,,,manual\n"), Errors{"times.csv:2: the mnemonic is missing"});
  EXPECT_EQ(errors_in("MOVB,60\n").at(0).substr(0, 43), "times.csv:2: 2 columns, but 6 are needed (m");
}

TEST(Times, ATextThatIsNotATableIsRefused) {
  TimeTable times;
  EXPECT_EQ(times.add("", "empty.csv"), Errors{"empty.csv: the table is empty"});
  EXPECT_EQ(times.add("\nhello\n", "letter.csv").at(0).substr(0, 68),
            "letter.csv:2: not a table of execution times: the first line must be");
  EXPECT_EQ(times[SystemTime::InterruptEntry], 0) << "no line gives it";
}

}  // namespace
}  // namespace s7200
