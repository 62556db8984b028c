// Logs in the tables of web pages, of Markdown and of programs that draw them.
#include "tools/recordings/rows/markup.hpp"

#include <gtest/gtest.h>

#include "tools/recordings/conversation.hpp"

namespace s7200::tools::markup_test {
namespace {

/// The request and its answer after 40 ms, if `table` has times.
void expect_the_conversation(const std::string& table, bool with_times = true) {
  const auto recording = read_recording(table, {});
  ASSERT_TRUE(recording) << recording.why() << '\n' << table;
  const auto frames = conversation(*recording, *find_recorded_protocol("modbus"));
  ASSERT_EQ(frames.size(), 2U) << table;
  EXPECT_EQ(frames[0].text, "station 1, read holding registers 40011, 2 of them") << table;
  EXPECT_EQ(frames[1].text, "2 registers: 16#1234 16#5678") << table;
  EXPECT_EQ(frames[1].other, 0U);
  if (with_times) {
    EXPECT_EQ(*frames[1].frame.at - *frames[0].frame.at, 40 * kMillisecond) << table;
  }
}

TEST(Markup, ATableOfMarkdownIsRead) {
  const std::string rows =
      "| 10:00:00.100 | TX | `01 03 00 0A 00 02 E4 09` |\n| 10:00:00.140 | RX | `01 03 04 12 34 56 78 81 07` |\n";
  expect_the_conversation("| time | dir | data |\n|---|---|---|\n" + rows);
  expect_the_conversation("|Zeit|Richtung|Telegramm|\r\n|:---|:-:|---:|\r\n" + rows);
  expect_the_conversation("This is what I see:\n\n| when | who | what |\n| --- | --- | --- |\n" + rows + "\nWhy?\n");
  expect_the_conversation(
      "time | dir | data\n--- | --- | ---\n10:00:00.100 | TX | 01 03 00 0A 00 02 E4 09\n"
      "10:00:00.140 | RX | 01 03 04 12 34 56 78 81 07\n");
  expect_the_conversation(
      "| bytes | dir |\n|---|---|\n| 01 03 00 0A 00 02 E4 09 | TX |\n| 01 03 04 12 34 56 78 81 07 | RX |\n", false);
}

TEST(Markup, ADrawnTableIsRead) {
  expect_the_conversation(
      "+--------------+----+----------------------------+\n| time         | di | data                       |\n"
      "+==============+====+============================+\n| 10:00:00.100 | TX | 01 03 00 0A 00 02 E4 09    |\n"
      "| 10:00:00.140 | RX | 01 03 04 12 34 56 78 81 07 |\n+--------------+----+----------------------------+\n");
  expect_the_conversation(
      "\u250C\u2500\u2500\u252C\u2500\u2500\u2510\n\u2502 time \u2502 dir \u2502 data \u2502\n"
      "\u251C\u2500\u2500\u253C\u2500\u2500\u2524\n"
      "\u2502 10:00:00.100 \u2502 TX \u2502 01 03 00 0A 00 02 E4 09 \u2502\n"
      "\u2502 10:00:00.140 \u2502 RX \u2502 01 03 04 12 34 56 78 81 07 "
      "\u2502\n\u2514\u2500\u2500\u2534\u2500\u2500\u2518\n");
  expect_the_conversation(
      "     time     | dir |            data\n--------------+-----+----------------------------\n"
      " 10:00:00.100 | TX  | 01 03 00 0A 00 02 E4 09\n 10:00:00.140 | RX  | 01 03 04 12 34 56 78 81 07\n(2 rows)\n");
}

TEST(Markup, ColumnsAreWhereARuleOfDashesHasThem) {
  const std::string head =
      "Phase - IN, OUT\n\nDevice  Length  Phase  Data                      Description  Date        Time\n"
      "------  ------  -----  ------------------------  -----------  ----------  ------------\n";
  expect_the_conversation(head +
                          "  26.2       8  OUT    01 03 00 0a  00 02 e4 09  ........     03/25/2010  10:00:00.100\n"
                          "  26.1       9  IN     01 03 04 12  34 56 78 81  ...4Vx.      03/25/2010  10:00:00.140\n"
                          "                       07                        .\n");
  expect_the_conversation(
      "time          dir  bytes\n------------  ---  -----\n10:00:00.100  TX   01 03 00 0A 00 02 E4 09\n"
      "10:00:00.140  RX   01 03 04 12 34 56 78 81 07\n");
}

TEST(Markup, LinesOfADrawnTableKeepTheirNumbers) {
  const auto recording = read_recording("|time|dir|data|\n|--|--|--|\n|10:00:00|TX|01 03 00 0A 00 02 E4 09|\n", {});
  ASSERT_TRUE(recording) << recording.why();
  EXPECT_EQ(recording->frames.front().place, "line 3");
  EXPECT_TRUE(recording->notes.empty());
}

TEST(Markup, LinesThatAreNoRowsOfATableAreNamed) {
  const auto recording =
      read_recording("My log:\n|time|dir|data|\n|--|--|--|\n|10:00:00|TX|01 03 00 0A 00 02 E4 09|\n\nWhy?\n", {});
  ASSERT_TRUE(recording) << recording.why();
  EXPECT_EQ(recording->frames.front().place, "line 4");
  EXPECT_EQ(recording->notes,
            std::vector<std::string>{"line 1: left out, and 1 more: no row of the table, and no bytes in it"});
}

TEST(Markup, ATableOfAPageIsRead) {
  expect_the_conversation(
      "<table><tr><td>10:00:00.100</td><td>TX</td><td>01 03 00 0A 00 02 E4 09</td></tr>\n"
      "<tr><td>10:00:00.140</td><td>RX</td><td>01 03 04 12 34 56 78 81 07</td></tr></table>\n");
  expect_the_conversation(
      "<!DOCTYPE html>\n<html><head><title>12 34</title><style>td { color: #aabbcc }</style></head><body>\n"
      "<TABLE border=1>\n <thead>\n  <tr>\n   <th>Time</th>\n   <th>Direction</th>\n   <th>Data</th>\n  </tr>\n </thead>\n"
      " <tr class=\"odd\">\n  <td>10:00:00.100</td>\n  <td>TX</td>\n"
      "  <td><span style=\"color:red\">01&nbsp;03</span> 00 0A\n   00 02 E4 09</td>\n </tr>\n"
      " <tr>\n  <td>10:00:00.140</td>\n  <td>RX</td>\n  <td>01 03 04 12<br>34 56 78 81 07</td>\n "
      "</tr>\n</TABLE></body></html>\n");
}

TEST(Markup, LinesOfAPageAreRead) {
  expect_the_conversation(
      "<pre>10:00:00.100 -&gt; 01 03 00 0A 00 02 E4 09\n10:00:00.140 &lt;- 01 03 04 12 34 56 78 81 07</pre>\n");
  expect_the_conversation(
      "<p>10:00:00.100 <b>TX</b>: 01 03 00 0A 00 02 E4 09<br/>10:00:00.140 <b>RX</b>: 01 03 04 12 34 56 78 81 07</p>\n");
  expect_the_conversation(
      "<div class='tx'>10:00:00.100&#160;TX 01 03 00 0A 00 02 E4 09</div>"
      "<div class='rx'>10:00:00.140&#xA0;RX 01 03 04 12 34 56 78 81 07</div>");
}

TEST(Markup, ATextWithoutItIsLeftAlone) {
  for (const char* const text :
       {"10:00:00 TX 01 03\n", "<CR><LF>\n", "<01><03><00>\n[01][03]\n", "a | b\n", "-- 01 03 --\n",
        "{\"html\": \"<td>\"}\n", "10:00:00 | TX | 01 03\n10:00:01 | RX | 01 03\n", "----------\n01 03\n----------\n", ""})
    EXPECT_FALSE(without_markup(text)) << text;
}

}  // namespace
}  // namespace s7200::tools::markup_test
