// Tables of execution times: what is read, what is refused, what is written.
#include "interpreter/model/times/times.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/model/times/named_times.hpp"
#include "interpreter/model/times/times_file.hpp"
#include "interpreter/program/loading/load_times.hpp"
#include "tools/host/files/files.hpp"

namespace s7200::times_test {
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

TEST(Times, OneLineMayServeSeveralMnemonics) {
  const TimeTable times = table("LD LDN A,I Q,0.8,,,estimate,\n");
  for (const char* mnemonic : {"LD", "LDN", "A"}) {
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
  EXPECT_TRUE(again.rows() == times.rows());
}

TEST(Times, WhatCannotBeReadIsNamedWithItsLine) {
  EXPECT_EQ(errors_in("MOVB,,60,,,estimate\nMOVW,,-1,,,estimate\n\nMOVD,,60,x,,estimate\n"),
            (Errors{"times.csv:3: '-1' is not a time in microseconds (0.001 to 100000)",
                    "times.csv:5: 'x' is not a time in microseconds (0.001 to 100000)"}));
  EXPECT_EQ(errors_in("MOVB,,60,,,guess\n"),
            Errors{"times.csv:2: 'guess' is not a marker; there are manual, measured, calibrated, remembered, estimate"});
  EXPECT_EQ(errors_in("MOVB,,0,,,manual\n"), Errors{"times.csv:2: MOVB: an execution time must be above 0"});
  EXPECT_EQ(errors_in("LBL SBR INT,,0,,,manual\n"), Errors{});
  EXPECT_EQ(errors_in(" ,,5,,,manual\n"), Errors{"times.csv:2: the mnemonic is missing"});
  EXPECT_EQ(errors_in("MOVB,60\n").at(0).substr(0, 43), "times.csv:2: 2 columns, but 6 are needed (m");
}

TEST(Times, AFigureIsAtMostWhatTheWatchdogLeavesToOneInstructionAndAtLeastANanosecond) {
  EXPECT_EQ(errors_in("MOVB,,100000,,,manual\n"), Errors{});
  EXPECT_EQ(errors_in("MOVB,,0.001,,,manual\n"), Errors{});
  EXPECT_EQ(errors_in("MOVB,,100000.1,,,manual\n"),
            Errors{"times.csv:2: '100000.1' is not a time in microseconds (0.001 to 100000)"});
  EXPECT_EQ(errors_in("MOVB,,0.0001,,,manual\n"),
            Errors{"times.csv:2: '0.0001' is not a time in microseconds (0.001 to 100000)"});
}

TEST(Times, ALineWithAQuoteLeftOpenOrTooManyColumnsAndATableWithoutLinesAreSlips) {
  EXPECT_EQ(errors_in("MOVB,,60,,,manual,\"page 9\n"), Errors{"times.csv:2: a double quote is not closed"});
  EXPECT_EQ(errors_in("MOVB,,60,,,manual,page 9, left, top,5,,\n").at(0).substr(0, 42),
            "times.csv:2: 12 columns, but there are 10 ");
  EXPECT_EQ(errors_in(""), Errors{"times.csv:1: the table has no line with a time"});
}

TEST(Times, CommentsAreLeftOutAndOneSaysWhoseTimesTheyAre) {
  std::vector<std::string> errors;
  const TimesFile file = read_times("# CPU 224,,,,,,,\n" + kHeader + "# mine\nMOVB,,60,,,manual\n", "times.csv", errors);
  EXPECT_EQ(errors, Errors{});
  EXPECT_EQ(file.cpu, "224");
  ASSERT_EQ(file.lines.size(), 1U);
  EXPECT_EQ(file.lines[0].number, 4U);
  for (const char* before : {"", "# CPU times measured by me\n", "# CPU\n", "# CPU ,,\n"})
    EXPECT_EQ(read_times(before + kHeader + "MOVB,,60,,,manual\n", "times.csv", errors).cpu, "") << before;
}

TEST(Times, SpreadsheetsMayWriteSemicolonsOrTabsAndDecimalCommas) {
  const std::string columns = "mnemonic,form,base_us,per_unit_us,unit,marker,source,uncertainty_percent\n";
  TimeTable usual, of_semicolons, of_tabs;
  ASSERT_EQ(usual.add("# CPU 214\n" + columns + "SLW,,80.5,4.25,bit,measured,\"page 9, left\",2.5\n", "t.csv"), Errors{});
  const auto with = [](std::string text, char separator) { return std::ranges::replace(text, ',', separator), text; };
  EXPECT_EQ(of_semicolons.add(
                "# CPU 214;;;;;;;\r\n" + with(columns, ';') + "SLW;;80,5;4,25;bit;measured;page 9, left;2,5\r\n;;;;;;;\r\n",
                "t.csv"),
            Errors{});
  EXPECT_EQ(of_tabs.add(with(columns, '\t') + "SLW\t\t80,5\t4,25\tbit\tmeasured\tpage 9, left\t2,5\n", "t.csv"), Errors{});
  EXPECT_EQ(to_csv(of_semicolons), to_csv(usual));
  EXPECT_EQ(to_csv(of_tabs), to_csv(usual));
}

TEST(Times, OnlyLinesThatGiveATimeAreInUse) {
  TimeTable times = table("LD LDN,I Q,0.8,,,estimate\nMOVB MOVW,,30,,,estimate\nLD,M,1,,,estimate\n");
  EXPECT_EQ(to_csv(in_use(times)), to_csv(times));
  times.add(table("MOVB,,37,,,manual\nLD,I,0.7,,,manual\nLDN,,2,,,manual\n"));
  EXPECT_EQ(to_csv(in_use(times)), to_csv(table("MOVB,,37,,,manual\nLD,I,0.7,,,manual\nLDN,,2,,,manual\n"
                                                "LD,I Q,0.8,,,estimate\nMOVW,,30,,,estimate\nLD,M,1,,,estimate\n")));
  for (const CpuModel* model : all_cpus())
    EXPECT_EQ(to_csv(in_use(default_times(*model))), to_csv(default_times(*model))) << model->name;
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

TEST(Times, ABoundInMicrosecondsTakesThePlaceOfThePercentage) {
  const std::string header =
      kHeader.substr(0, kHeader.size() - 1) + ",uncertainty_percent,base_within_us,per_unit_within_us\n";
  TimeTable times;
  ASSERT_EQ(times.add(header + "SLW,,80,4,bit,measured,me,,0.5,0.02\nNETW,,300,,byte,calibrated,me,10,,19\n", "t.csv"),
            Errors{});
  EXPECT_EQ(range_of_base(*times.find("SLW", {})), (TimeRange{79'500, 80'500}));
  EXPECT_EQ(range_of_unit(*times.find("SLW", {})), (TimeRange{3'980, 4'020}));
  EXPECT_EQ(range_of_unit(*times.find("NETW", {})), (TimeRange{0, 19'000})) << "nothing is within it";
  EXPECT_EQ(times.find("NETW", {})->uncertainty, 10) << "unless it is there, too";
  TimeTable again;
  EXPECT_EQ(again.add(to_csv(times), "t.csv"), Errors{});
  EXPECT_TRUE(again.rows() == times.rows());
  EXPECT_EQ(times.add(header + "SLW,,80,4,bit,measured,me,,x,\n", "t.csv"),
            Errors{"t.csv:2: 'x' is not a time in microseconds (0.001 to 100000)"});
  EXPECT_EQ(to_csv(default_times(cpu214())).find("within"), std::string::npos) << "columns that nothing needs are left out";
}

TEST(Times, SumsGiveNoTimeAndHideNoOtherSum) {
  const TimeTable times =
      table("(sum),CALL + RET,41,,,measured\n(sum),CALL + (interrupt entry),60,,,measured\nCALL,,23,,,measured\n");
  EXPECT_EQ(to_csv(in_use(times)), to_csv(times));
  EXPECT_EQ(times.find("CALL", {})->base, 23'000);
  EXPECT_EQ(parts_of_sum(times.rows()[1].form), (std::vector<std::string>{"CALL", "(interrupt entry)"}));
}

TEST(NamedTimes, ACpuRunsWithTheTableThatIsItsOwn) {
  for (const CpuModel* model : all_cpus()) {
    const auto tables = times_of(*model);
    EXPECT_EQ(std::ranges::count(tables, true, &NamedTimes::own), 1) << model->name;
    ASSERT_TRUE(tables.front()->own) << model->name << ": its own first";
    EXPECT_EQ(to_csv(tables.front()->table()), to_csv(default_times(*model))) << model->name;
  }
}

TEST(NamedTimes, TheTableFromTheCpu22xIsItsFiguresTimesOneFactor) {
  const TimeTable &scaled = find_times("cpu214_from_22x")->table(), &of_22x = find_times("cpu22x_release1")->table();
  for (const TimeRow& row : of_22x.rows()) {
    for (const std::string& mnemonic : row.mnemonics) {
      if (row.marker == "estimate" || mnemonic == "(EEPROM save)") continue;
      const auto found = std::ranges::find_if(
          scaled.rows(), [&](const TimeRow& other) { return other.mnemonics == row.mnemonics && other.form == row.form; });
      ASSERT_NE(found, scaled.rows().end()) << mnemonic;
      EXPECT_NEAR(static_cast<double>(found->base), 1.906 * static_cast<double>(row.base), 1) << mnemonic;
      EXPECT_NEAR(static_cast<double>(found->per_unit), 1.906 * static_cast<double>(row.per_unit), 1) << mnemonic;
    }
  }
  EXPECT_TRUE(std::ranges::all_of(scaled.rows(), [](const TimeRow& row) { return row.marker == "remembered"; }));
  EXPECT_EQ(scaled[SystemTime::InterruptEntry], 89'582);
  EXPECT_TRUE(std::ranges::all_of(scaled.rows(), [](const TimeRow& row) { return row.uncertainty >= 25; }))
      << "a figure that a page has is a guess with the factor";
  EXPECT_EQ(scaled.cost("CRETI", {})->base, scaled.cost("RETI", {})->base) << "as RETI";
}

TEST(NamedTimes, SAndROfOneBitTakeTheFiguresForAnyNumber) {
  const TimeTable& times = find_times("cpu22x_release1")->table();
  const auto of_one = [&](const char* statement) {
    return check_text(std::string("LD SM0.0\n") + statement + "\nMEND\n", "one.stl", *find_cpu("224r1"), times)
        .program->ops[1]
        .cost;
  };
  EXPECT_EQ(of_one("R C0, 1"), 19'000);
  EXPECT_EQ(of_one("R M0.0, 1"), 28'000);
  EXPECT_EQ(times.find("R", Area::M)->per_unit, 900);
  EXPECT_EQ(of_one("S M0.0, 1"), 27'000);
}

/// The areas that a line of a times file is for; one without area if it is for any operand.
std::vector<std::optional<Area>> operands_of(const TimeRow& row) {
  std::vector<std::optional<Area>> operands;
  for (std::size_t area = 0; area < kAreas; ++area)
    if (contains(row.areas, static_cast<Area>(area))) operands.emplace_back(static_cast<Area>(area));
  if (operands.empty()) operands.emplace_back();
  return operands;
}

/// `what` is known to within `range`, or nothing is known of it.
void expect_within(Time what, const TimeRange& range, const std::string& name) {
  if (range.most == 0) return;
  EXPECT_GE(static_cast<double>(what), range.least * 0.999) << name;
  EXPECT_LE(static_cast<double>(what), range.most * 1.001) << name;
}

TEST(NamedTimes, EachFigureOfTheCpu214IsAsUnsureAsTheRememberedOneIsFarFromIt) {
  const TimeTable &own = find_times("cpu214")->table(), &other = find_times("cpu214_from_22x")->table();
  for (const TimeRow& row : own.rows())
    for (const std::string& mnemonic : row.mnemonics)
      for (const std::optional<Area> operand : operands_of(row)) {
        const TimeRow* remembered = other.find(mnemonic, operand);
        if (!remembered || mnemonic == "SCRE") continue;  // SCRE has a line with LSCR, which is dear
        expect_within(remembered->base, range_of_base(row), mnemonic + " " + names_of(row.areas));
        if (remembered->unit == row.unit)
          expect_within(remembered->per_unit, range_of_unit(row), mnemonic + " for each " + row.unit);
      }
}

TEST(NamedTimes, ATableIsForItsOwnCpus) {
  std::vector<std::string> errors;
  EXPECT_FALSE(load_times(cpu224(), "cpu214_from_22x", tools::host_files(), errors));
  EXPECT_EQ(errors, Errors{"cpu214_from_22x has times of CPU 212, 214, 215 or 216; tables for CPU 224: cpu22x"});
  errors.clear();
  EXPECT_FALSE(load_times(cpu214(), "cpu214_from_23x", tools::host_files(), errors));
  EXPECT_EQ(errors, Errors{"cannot read cpu214_from_23x: No such file or directory; tables for CPU 214 that have a name: "
                           "cpu214, cpu214_from_22x"});
  const auto times = load_times(cpu214(), "cpu214_from_22x", tools::host_files(), errors = {});
  ASSERT_TRUE(times);
  EXPECT_EQ(times->find("MOVB", {})->marker, "remembered");
  EXPECT_EQ((*times)[SystemTime::ScanOverhead], default_times(cpu214())[SystemTime::ScanOverhead]) << "not remembered";
}

/// A file, as long as it lives.
class WrittenFile {
 public:
  explicit WrittenFile(const std::string& text) { std::ofstream(path_) << text; }
  ~WrittenFile() { std::filesystem::remove(path_); }
  WrittenFile(const WrittenFile&) = delete;
  WrittenFile& operator=(const WrittenFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_ = (std::filesystem::temp_directory_path() / ("s7200_times_" + std::to_string(getpid()))).string();
};

/// What load_times() says of a file with these lines below the header, without its name.
Errors slips_in(const std::string& lines, const CpuModel& model, const std::string& before = "") {
  const WrittenFile file(before + kHeader + lines);
  Errors errors;
  const bool loaded = load_times(model, file.path(), tools::host_files(), errors).has_value();
  EXPECT_EQ(loaded, errors.empty());
  for (std::string& error : errors) error.erase(0, file.path().size());
  return errors;
}

TEST(LoadTimes, ANameFormOrUnitThatTheCpusTablesDoNotHaveIsASlip) {
  EXPECT_EQ(slips_in("movb,,60,,,manual\n", cpu214()), Errors{":2: 'movb' is not an instruction; write MOVB"});
  EXPECT_EQ(slips_in("MOVV,,60,,,manual\n", cpu214()), Errors{":2: 'MOVV' is not an instruction; write MOVB"});
  EXPECT_EQ(slips_in("(scan),,60,,,manual\n", cpu214()),
            Errors{":2: '(scan)' is not an instruction; `s7200 times` lists them"});
  EXPECT_EQ(slips_in("(sum),CALL + MOVV,60,,,manual\n", cpu214()), Errors{":2: 'MOVV' is not an instruction; write MOVB"});
  EXPECT_EQ(slips_in("(sum),CALL + RET,60,,,manual\n(sum),CALL + CRET,60,,,manual\n", cpu214()), Errors{});
  EXPECT_EQ(slips_in("LD,Z,60,,,manual\n", cpu214()),
            Errors{":2: 'Z' is not a form of LD; write the areas of its first operand (I Q M SM V …), or nothing"});
  EXPECT_EQ(slips_in("MOVB,,60,3,byte,manual\n", cpu214()), Errors{":2: MOVB has no time per unit; leave column 4 empty"});
  EXPECT_EQ(slips_in("MOVB,,60,,,manual\nSLW,,60,,,manual\n", cpu214()),
            Errors{":3: SLW takes longer for each bit; write by how much into column 4"});
  EXPECT_EQ(slips_in("INCB,,60,,,manual\nR,T,19,16,bit,manual\nJMP,taken,1,,,manual\n", cpu214()), Errors{});
}

TEST(LoadTimes, AreasOfWhatHasNoOperandInMemoryAreASlip) {
  for (const std::string name : {"(scan overhead)", "(no power flow)", "(interrupt entry)", "(indirect operand)",
                                 "(EEPROM save)", "JMP", "ALD", "CALL"})
    EXPECT_EQ(slips_in(name + ",I Q,5000,,,manual\n", cpu214()),
              Errors{":2: " + name + " has no first operand in memory, so no line of it is for I Q; leave column 2 empty"});
  EXPECT_EQ(slips_in("(operand area adds),V,5,,,manual\nLD,V,1,,,manual\n", cpu214()), Errors{});
}

TEST(LoadTimes, ALineThatAnEarlierOneHidesIsASlip) {
  EXPECT_EQ(slips_in("MOVB,,60,,,manual\nMOVW MOVB,,70,,,manual\n", cpu214()),
            Errors{":3: an earlier line has the time of MOVB already; delete one of them"});
  EXPECT_EQ(slips_in("LD,I Q,1,,,manual\nLD,Q,2,,,manual\n", cpu214()),
            Errors{":3: an earlier line has the time of LD already, for Q; delete one of them"});
  EXPECT_EQ(slips_in("LD,Q,1,,,manual\nLD,I Q,2,,,manual\nLD,,3,,,manual\n", cpu214()), Errors{});
}

TEST(LoadTimes, AFileWithTheTimesOfAnotherCpuIsRefused) {
  const std::string line = "MOVB,,60,,,manual\n";
  EXPECT_EQ(slips_in(line, cpu214(), "# CPU 224\n"),
            Errors{":1: these are times of CPU 224, not of CPU 214; give --cpu 224, or delete this line and mend what does "
                   "not fit"});
  EXPECT_EQ(slips_in("BITIM,,60,,,manual\n", cpu214(), "# CPU 224\n").size(), 1) << "what else does not fit follows from it";
  EXPECT_EQ(slips_in(line, cpu214(), "# CPU 300\n"), Errors{":1: there is no CPU '300'"});
  EXPECT_EQ(slips_in(line, cpu214(), "# CPU 214\n"), Errors{});
  EXPECT_EQ(slips_in(line, cpu214(), "# CPU 212\n"), Errors{}) << "the same table";
  EXPECT_EQ(slips_in(line, cpu226()), Errors{});
}

TEST(LoadTimes, EachTableWithANameReadsBackFromAFile) {
  for (const CpuModel* model : all_cpus())
    for (const NamedTimes& named : named_times())
      if (named.cpus & model->self) {
        Errors errors;
        const WrittenFile file(to_csv(*load_times(*model, std::string(named.name), tools::host_files(), errors)));
        EXPECT_TRUE(load_times(*model, file.path(), tools::host_files(), errors)) << named.name;
        EXPECT_EQ(errors, Errors{});
      }
}

TEST(Times, ATextThatIsNotATableIsRefused) {
  TimeTable times;
  EXPECT_EQ(times.add("", "empty.csv"), Errors{"empty.csv: the table is empty"});
  EXPECT_EQ(times.add("\nhello\n", "letter.csv").at(0).substr(0, 68),
            "letter.csv:2: not a table of execution times: the first line must be");
  EXPECT_EQ(times[SystemTime::InterruptEntry], 0) << "no line gives it";
}

}  // namespace
}  // namespace s7200::times_test
