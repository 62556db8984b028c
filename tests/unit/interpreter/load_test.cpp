// Which files are accepted as a program.
#include "interpreter/program/load.hpp"

#include <gtest/gtest.h>

namespace s7200::load_test {
namespace {

/// Why a text is not a program; empty if it is read as one.
std::string refusal(const std::string& text) {
  const auto read = read_source(text, "file");
  EXPECT_EQ(read.has_value(), read.why().empty());
  return read.why();
}

TEST(ReadSource, ProgramsWithMistakesAreStillPrograms) {
  for (const char* text : {"FROB\n", "LD\n", "MOVB 16#, VB0\n", "ld sm0.0\n", "  = Q0.0\n", "U E0.0\n= A0.0\n",
                           "Netzwerk 1\nUN E0.0\n", "NETWORK 1\n\x01\x02 and a title that is too long\n",
                           "ORGANIZATION_BLOCK MAIN:OB1\nTITLE=x\n", "// a comment\n", "", "TITLE=x\nLDB>= VB0, 5\n"})
    EXPECT_EQ(refusal(text), "") << text;
}

TEST(ReadSource, OtherFilesAreRefusedWithoutQuotingThem) {
  for (const char* text :
       {"root:x:0:0:root:/root:/bin/bash\ndaemon:x:1:1:daemon:/usr/sbin:/usr/sbin/nologin\n", "{\"port\": 502}\n",
        "program: a.stl\nsteps:\n  - wait: 1ms\n", "-----BEGIN PRIVATE KEY-----\nMC4CAQAwBQYDK2VwBCIEIA\n",
        "[server]\npassword = secret\n", "TOKEN=ghp_0123456789\n", "ghp_0123456789\n", "#!/bin/sh\nset -e\nexit 0\n",
        "<!DOCTYPE html>\n<html>404</html>\n", "time_ms,address,value\n2.000000,Q0.3,1\n", "A word\n", "port 22\n",
        "SELECT name FROM users\n"})
    EXPECT_EQ(
        refusal(text),
        "it is not an STL program: there is no instruction in its first lines; a symbol table has rows such as Motor = Q0.0")
        << text;
}

TEST(ReadSource, SaysThatBlanksBeforeOperandsAreMissing) {
  EXPECT_EQ(refusal("LDI0.0\nAI0.1\n=Q0.0\n"), "line 1: a blank is missing between LD and its operand");
  EXPECT_EQ(refusal("// pump\n\nMOVBVB0,VB1\nLDNSM0.1\n"), "line 4: a blank is missing between LDN and its operand");
}

TEST(ReadSource, OnlyTheStartOfAFileDecides) {
  std::string late;
  for (int line = 0; line < 20; ++line) late += "a=b\n\n";
  EXPECT_NE(refusal(late + "LD SM0.0\nMEND\n"), "");
  EXPECT_EQ(refusal("a=b\nLD SM0.0\nMEND\n"), "");
}

}  // namespace
}  // namespace s7200::load_test
