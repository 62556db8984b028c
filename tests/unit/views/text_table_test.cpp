#include "tools/views/text_table.hpp"

#include <gtest/gtest.h>

namespace s7200::tools::text_table_test {
namespace {

TextTable times() {
  TextTable table({{.heading = "instructions", .breaks = true},
                   {.heading = "base", .align = TextTable::Align::Right},
                   {.heading = "source", .breaks = true}});
  table.add({"LD LDN A AN O ON", "2", "from memory"});
  table.add({"MOVB", "30.5", "S7-200 manual, French edition 2004"});
  return table;
}

TEST(TextTable, IsAsWideAsItsContentsIfTheyFit) {
  EXPECT_EQ(times().text(100),
            "instructions      base  source\n"
            "LD LDN A AN O ON     2  from memory\n"
            "MOVB              30.5  S7-200 manual, French edition 2004\n");
}

TEST(TextTable, TheWidestCellsGoOnBelowThemselves) {
  EXPECT_EQ(times().text(40),
            "instructions      base  source\n"
            "LD LDN A AN O ON     2  from memory\n"
            "MOVB              30.5  S7-200 manual,\n"
            "                        French edition\n"
            "                        2004\n");
}

TEST(TextTable, AWordThatIsTooLongStaysWhole) {
  EXPECT_EQ(times().text(10),
            "instructions  base  source\n"
            "LD LDN A AN      2  from\n"
            "O ON                memory\n"
            "MOVB          30.5  S7-200\n"
            "                    manual,\n"
            "                    French\n"
            "                    edition\n"
            "                    2004\n");
}

}  // namespace
}  // namespace s7200::tools::text_table_test
