// Tables of execution times: what is read, what is refused, what is written.
#include "interpreter/model/times.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "interpreter/model/named_times.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/program/load_times.hpp"

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
    EXPECT_EQ(std::tie(a.form, a.areas, a.base, a.per_unit, a.unit, a.marker, a.source, a.uncertainty),
              std::tie(b.form, b.areas, b.base, b.per_unit, b.unit, b.marker, b.source, b.uncertainty));
  }
}

TEST(Times, WhatCannotBeReadIsNamedWithItsLine) {
  EXPECT_EQ(errors_in("MOVB,,60,,,estimate\nMOVW,,-1,,,estimate\n\nMOVD,,60,x,,estimate\n"),
            (Errors{"times.csv:3: '-1' is not a time in microseconds (0 to 1000000)",
                    "times.csv:5: 'x' is not a time in microseconds (0 to 1000000)"}));
  EXPECT_EQ(errors_in("MOVB,,60,,,guess\n"),
            Errors{"times.csv:2: 'guess' is not a marker; there are manual, measured, calibrated, remembered, estimate"});
  EXPECT_EQ(errors_in("MOVB,,0,,,manual\n"), Errors{"times.csv:2: MOVB: an execution time must be above 0"});
  EXPECT_EQ(errors_in("LBL SBR INT,,0,,,manual\n"), Errors{});
  EXPECT_EQ(errors_in(" ,,5,,,manual\n"), Errors{"times.csv:2: the mnemonic is missing"});
  EXPECT_EQ(errors_in("MOVB,60\n").at(0).substr(0, 43), "times.csv:2: 2 columns, but 6 are needed (m");
}

TEST(Times, TheMarkerSaysHowSureAFigureIsIfItsLineDoesNot) {
  const std::string header = "mnemonic,form,base_us,per_unit_us,unit,marker,source,uncertainty_percent\n";
  TimeTable times;
  EXPECT_EQ(times.add(header + "MOVB,,60,,,manual,,\nMOVW,,60,,,estimate,,12.5\nMOVD,,60,,,estimate\n", "t.csv"), Errors{});
  EXPECT_EQ(times.find("MOVB", {})->uncertainty, 5);
  EXPECT_EQ(times.find("MOVW", {})->uncertainty, 12.5);
  EXPECT_EQ(times.find("MOVD", {})->uncertainty, 50);
  EXPECT_EQ(times.add(header + "MOVB,,60,,,manual,,-3\n", "t.csv"),
            Errors{"t.csv:2: '-3' is not an uncertainty in percent (0 to 1000)"});
}

TEST(NamedTimes, ACpuRunsWithTheTableThatIsItsOwn) {
  for (const CpuModel* model : all_cpus()) {
    const auto own = std::ranges::find_if(named_times(),
                                          [&](const NamedTimes& times) { return times.own && (times.cpus & model->self); });
    ASSERT_NE(own, named_times().end()) << model->name;
    EXPECT_EQ(to_csv(own->table), to_csv(default_times(*model))) << model->name;
  }
}

TEST(NamedTimes, TheTableFromTheCpu22xIsItsFiguresTimesOneFactor) {
  const TimeTable &scaled = find_times("cpu214_from_22x")->table, &of_22x = find_times("cpu22x_release1")->table;
  for (const TimeRow& row : of_22x.rows()) {
    for (const std::string& mnemonic : row.mnemonics) {
      const bool of_system = mnemonic == "(EEPROM save)" || mnemonic == "(interrupt entry)";
      if (row.marker == "estimate" || of_system) continue;
      const auto found = std::ranges::find_if(
          scaled.rows(), [&](const TimeRow& other) { return other.mnemonics == row.mnemonics && other.form == row.form; });
      ASSERT_NE(found, scaled.rows().end()) << mnemonic;
      EXPECT_NEAR(static_cast<double>(found->base), 1.906 * static_cast<double>(row.base), 1) << mnemonic;
      EXPECT_NEAR(static_cast<double>(found->per_unit), 1.906 * static_cast<double>(row.per_unit), 1) << mnemonic;
    }
  }
  EXPECT_TRUE(std::ranges::all_of(scaled.rows(), [](const TimeRow& row) { return row.marker == "remembered"; }));
  EXPECT_EQ(scaled[SystemTime::InterruptEntry], 89'600);
}

TEST(NamedTimes, EachFigureOfTheCpu214IsAsUnsureAsTheRememberedOneIsFarFromIt) {
  const TimeTable &own = find_times("cpu214")->table, &other = find_times("cpu214_from_22x")->table;
  for (const TimeRow& row : own.rows())
    for (const std::string& mnemonic : row.mnemonics) {
      const TimeRow* remembered = other.find(mnemonic, {});
      if (!remembered || row.base == 0 || mnemonic == "SCRE") continue;  // SCRE has a line with LSCR, which is dear
      const double factor = 1 + row.uncertainty / 100, base = static_cast<double>(row.base);
      EXPECT_GE(static_cast<double>(remembered->base), base / factor * 0.999) << mnemonic;
      EXPECT_LE(static_cast<double>(remembered->base), base * factor * 1.001) << mnemonic;
    }
}

TEST(NamedTimes, ATableIsForItsOwnCpus) {
  std::vector<std::string> errors;
  EXPECT_FALSE(load_times(cpu224(), "cpu214_from_22x", errors));
  EXPECT_EQ(errors, Errors{"cpu214_from_22x has times of CPU 212, 214, 215 or 216; tables for CPU 224: cpu22x"});
  errors.clear();
  EXPECT_FALSE(load_times(cpu214(), "cpu214_from_23x", errors));
  EXPECT_EQ(errors, Errors{"cannot read cpu214_from_23x: No such file or directory; tables for CPU 214 that have a name: "
                           "cpu214, cpu214_from_22x"});
  const auto times = load_times(cpu214(), "cpu214_from_22x", errors = {});
  ASSERT_TRUE(times);
  EXPECT_EQ(times->find("MOVB", {})->marker, "remembered");
  EXPECT_EQ((*times)[SystemTime::ScanOverhead], default_times(cpu214())[SystemTime::ScanOverhead]) << "not remembered";
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
