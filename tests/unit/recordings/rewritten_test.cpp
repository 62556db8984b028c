// Logs whose rows are rewritten in hex first, and files in which two programs have logged.
#include "tests/unit/recordings/conversation.hpp"

namespace s7200::tools::rewritten_test {
namespace {

using namespace test;

TEST(Rewritten, CaretNotationHasItsBytes) {
  EXPECT_EQ(texts("10:00:00.000 TX ^A^C^@^@^@^BM-D^K\n10:00:00.050 RX ^A^C^D^@^J^@^TM-Z>\n"), kConversation);
  EXPECT_EQ(texts("10:00:00.000 TX ^A^C^@^@^@^B\\xC4^K\n10:00:00.050 RX ^A^C^D^@^J^@^T\\xDA>\n"), kConversation);
}

TEST(Rewritten, DumpsOfNettyAreReadWithTheirHeads) {
  const std::string rule = "+--------+-------------------------------------------------+----------------+\n";
  const std::string head =
      "         +-------------------------------------------------+\n"
      "         |  0  1  2  3  4  5  6  7  8  9  a  b  c  d  e  f |\n" +
      rule;
  EXPECT_EQ(texts("10:15:30.100 [nioEventLoopGroup-2-1] DEBUG LoggingHandler - [id: 0x1] WRITE: 8B\n" + head +
                  "|00000000| 01 03 00 00 00 02 c4 0b                         |........        |\n" + rule +
                  "10:15:30.150 [nioEventLoopGroup-2-1] DEBUG LoggingHandler - [id: 0x1] READ: 9B\n" + head +
                  "|00000000| 01 03 04 00 0a 00 14 da 3e                      |........>       |\n" + rule),
            kConversation);
}

TEST(Rewritten, SlsnifHasTheNumbersInBrackets) {
  EXPECT_EQ(texts("Host   --> [SOH](001) [ETX](003) [NUL](000) [NUL](000) [NUL](000) [STX](002) (196) [VT](011)\n"
                  "Device --> [SOH](001) [ETX](003) [EOT](004) [NUL](000) [LF](010) [NUL](000) [DC4](020) (218) >(062)\n"),
            kConversation);
  std::string single;
  for (const int byte : {1, 3, 0, 0, 0, 2, 196, 11})
    single += "Host   --> (" + std::to_string(1000 + byte).substr(1) + ")\n";
  for (const int byte : {1, 3, 4, 0, 10, 0, 20, 218, 62})
    single += "Device --> (" + std::to_string(1000 + byte).substr(1) + ")\n";
  EXPECT_EQ(texts(single), kConversation);
}

TEST(Rewritten, RowsOfSqlAreRead) {
  EXPECT_EQ(texts("INSERT INTO log VALUES (1,'2024-01-01 10:00:00.000','TX',X'010300000002C40B');\n"
                  "INSERT INTO log VALUES (2,'2024-01-01 10:00:00.050','RX',X'010304000A0014DA3E');\n"),
            kConversation);
  EXPECT_EQ(texts("INSERT INTO log (id, t, dir, data) VALUES\n(1,'2024-01-01 10:00:00.000','TX','\\x010300000002c40b'),\n"
                  "(2,'2024-01-01 10:00:00.050','RX','\\x010304000a0014da3e');\n"),
            kConversation);
}

TEST(Rewritten, MinimalModbusHasItsBytesInQuotes) {
  EXPECT_EQ(texts("DEBUG:minimalmodbus:Writing to instrument: '\\x01\\x03\\x00\\x00\\x00\\x02\\xc4\\x0b'\n"
                  "DEBUG:minimalmodbus:Response from instrument: '\\x01\\x03\\x04\\x00\\n\\x00\\x14\\xda>'\n"),
            kConversation);
}

const std::string kRequest = "01 03 00 00 00 02 C4 0B\n", kAnswer = "01 03 04 00 0A 00 14 DA 3E\n";

TEST(TwoLoggers, OneOfThemIsShownAndNothingIsAnEcho) {
  for (const std::string& text : {"10:00:00.000 TX " + kRequest + "10:00:00.050 RX " + kAnswer + "[plc] 10:00:00.001 RX " +
                                      kRequest + "[plc] 10:00:00.049 TX " + kAnswer,
                                  "10:00:00.000 modpoll: " + kRequest + "10:00:00.001 slave: " + kRequest +
                                      "10:00:00.049 slave: " + kAnswer + "10:00:00.050 modpoll: " + kAnswer}) {
    EXPECT_EQ(texts(text), kConversation) << text;
    const auto notes = recording_of(text).notes;
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_EQ(notes[0].substr(0, 38), "two programs have logged the same fram");
  }
}

TEST(TwoLoggers, TheTwoSidesOfOneLoggerAreNotTwo) {
  const std::string write = "01 06 00 01 00 0A 58 0D\n";
  EXPECT_EQ(recording_of("10:00:00.000 master: " + write + "10:00:00.050 slave: " + write + "10:00:01.000 master: " + write +
                         "10:00:01.050 slave: " + write)
                .frames.size(),
            4U);
}

}  // namespace
}  // namespace s7200::tools::rewritten_test
