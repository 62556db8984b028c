#include "serial_sim/faults/fault.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/slave_bench.hpp"
#include "tests/support/source_path.hpp"

namespace s7200::serial::fault_test {
namespace {

Fault fault_of(const std::string& text) {
  const ParsedFault parsed = parse_fault(text);
  EXPECT_TRUE(parsed.ok()) << text << ": " << parsed.error->message;
  return parsed.fault;
}

TEST(Fault, EveryKindStandsInTheTableOnceAndItsExampleIsRead) {
  for (std::size_t i = 0; i < kFaultKinds; ++i) {
    const FaultKindInfo& info = fault_kinds()[i];
    EXPECT_EQ(static_cast<std::size_t>(info.kind), i);
    EXPECT_EQ(fault_of(std::string(info.example)).kind, info.kind);
  }
}

TEST(Fault, EveryParameterBelongsToAKind) {
  for (const FaultParameter& parameter : fault_parameters()) {
    bool used = false;
    for (const FaultKindInfo& kind : fault_kinds())
      for (const ParameterOfKind& p : kind.parameters) used |= p.name == parameter.name;
    EXPECT_TRUE(used) << parameter.name;
  }
}

TEST(Fault, WhatStandsInForAParameterIsAValueOfIt) {
  for (const FaultKindInfo& kind : fault_kinds())
    for (const ParameterOfKind& p : kind.parameters) {
      const std::string example(kind.example), name(p.name), standard(p.standard);
      if (p.standard == kRequired || p.standard == kLeftOut || example.find(name + "=") != std::string::npos) continue;
      const char separator = example.find(':') == std::string::npos ? ':' : ',';
      EXPECT_EQ(fault_of(example + separator + name + "=" + standard), fault_of(example)) << kind.name << " " << name;
    }
}

TEST(Fault, TextIsReadAsTheFaultItWasWrittenOf) {
  for (const char* text : {"noise:ber=1e-06,from=1.5s,for=200ms,of=answer,seed=12",
                           "flip:character=each,bit=parity,of=both,every=3",
                           "flip:bit=start",
                           "flip:bit=stop",
                           "parity:probability=0.25,seed=0",
                           "framing:exchange=7",
                           "break:length=1ms,from=2min",
                           "glitch:at=3.25bit,length=5us",
                           "missing:character=2,count=3",
                           "extra:behind=0,bytes=00ff,count=2",
                           "extra",
                           "gap:character=each,length=1.000001bit",
                           "echo:every=2",
                           "collision:bytes=0103,from=10ms",
                           "collision:count=8",
                           "baud:error=0.0001%,station=plc",
                           "baud:error=-50%",
                           "cut",
                           "cut:from=1s,for=1h",
                           "cut:character=3,at=0.5bit,of=answer",
                           "answer:delay=300ms",
                           "answer:delay=12bit,exception=6,every=3",
                           "answer:station=7,exchange=2",
                           "answer:function=4,probability=0.5",
                           "answer:stale",
                           "answer:delay=1s,twice",
                           "answer:short,every=2",
                           "answer:silent"}) {
    const Fault fault = fault_of(text);
    EXPECT_EQ(to_text(fault), text);
    EXPECT_EQ(fault_of(to_text(fault)), fault);
  }
}

TEST(Fault, BlanksCasesAndPlainNumbersAreRead) {
  EXPECT_EQ(fault_of(" flip : character = 3 , bit = 5 "), fault_of("flip:character=3,bit=5"));
  EXPECT_EQ(to_text(fault_of("noise:ber=2%")), "noise:ber=0.02");
  EXPECT_EQ(to_text(fault_of("baud:error=+2.5%")), "baud:error=2.5%");
  EXPECT_EQ(to_text(fault_of("flip:character=1,bit=0,of=request,every=1,probability=1,seed=1")), "flip");
}

struct WrongText {
  const char* text;
  std::size_t column, length;
  const char* message;
};

TEST(Fault, WrongTextIsRefusedWithItsPlace) {
  for (const WrongText& wrong : std::initializer_list<WrongText>{
           {"", 1, 1, "a fault is missing here; there are noise, flip,"},
           {"flop:bit=1", 1, 4, "there is no fault 'flop'; there are noise, flip,"},
           {"flip:", 6, 1, "a parameter of flip is missing here; there are character, bit, of, exchange"},
           {"flip:bit=1,", 12, 1, "is missing here"},
           {"flip:bits=1", 6, 4, "there is no parameter of flip 'bits'"},
           {"flip:bit", 6, 3, "bit needs a value (0…7, start, parity, stop): write bit=VALUE"},
           {"flip:bit=", 10, 1, "bit: '' is not a bit"},
           {"flip:character=3,bit=8", 22, 1, "bit: '8' is not a bit: 0 (sent first) to 7, start, parity or stop"},
           {"flip:character=0", 16, 1, "is not a character"},
           {"flip:character=4294967297", 16, 10, "is not a character"},
           {"flip:bit=1,bit=2", 12, 3, "bit is given twice"},
           {"flip:of=me", 9, 2, "of: 'me' is none of request, answer, both"},
           {"flip:every=0", 12, 1, "is not a whole number from 1"},
           {"flip:seed=-1", 11, 2, "is not a whole number from 0"},
           {"flip:probability=0", 18, 1, "is not a share above 0 and up to 1"},
           {"flip:probability=1.5", 18, 3, "is not a share"},
           {"flip:probability=nan", 18, 3, "is not a share"},
           {"noise", 1, 5, "noise needs ber=VALUE (share), for example noise:ber=1e-4,seed=7"},
           {"noise:ber=x", 11, 1, "is not a share"},
           {"noise:ber=1e-4,for=0s", 20, 2, "is not a duration above 0 and up to 10000h"},
           {"noise:ber=1e-4,from=now", 21, 3, "is not a time up to 10000h"},
           {"gap", 1, 3, "gap needs length=VALUE"},
           {"gap:length=5", 12, 1, "is not a length above 0; write for example 30us, 1.5ms, 0.3bit or 12bit"},
           {"glitch:length=0bit", 15, 4, "is not a length above 0"},
           {"glitch:length=2h", 15, 2, "is not a length above 0"},
           {"glitch:at=-1bit", 11, 5, "is not a length;"},
           {"glitch:from=1s,at=2bit", 16, 2, "at says where in an exchange, from=1s at which instant; give one of the two"},
           {"extra:bytes=0", 13, 1, "is neither random nor 1 to 256 bytes in hex"},
           {"extra:bytes=0x", 13, 2, "is neither random"},
           {"extra:count=257", 13, 3, "is not a whole number from 1 to 256"},
           {"baud:error=5", 12, 1, "is not a deviation up to 50%"},
           {"baud:error=51%", 12, 3, "is not a deviation"},
           {"baud:error=0%", 12, 2, "is not a deviation"},
           {"baud:error=nan%", 12, 4, "is not a deviation"},
           {"baud:error=-3%,station=me", 24, 2, "is none of master, plc"},
           {"cut:exchange=3,for=200ms", 5, 8, "exchange says where in an exchange, but at no character of it"},
           {"cut:of=answer", 5, 2, "of says where in an exchange, but at no character of it: write character=N too"},
           {"cut:for=soon", 9, 4, "is not a duration"},
           {"answer", 1, 6, "answer needs one of delay, exception, station, function, stale, twice, short, silent, for example"},
           {"answer:every=2", 1, 6, "answer needs one of delay"},
           {"answer:stale=1", 8, 5, "stale has no value: write stale alone"},
           {"answer:exception", 8, 9, "exception needs a value (1…255): write exception=VALUE"},
           {"answer:exception=256", 18, 3, "is not a whole number from 1 to 255"},
           {"answer:station=7,stale", 18, 5, "stale comes after another misbehaviour of the same answer"},
           {"answer:stale,stale", 14, 5, "stale is given twice"},
           {"answer:of=answer", 8, 2, "there is no parameter of answer 'of'; there are delay, exception"},
           {"echo:of=request", 6, 2, "there is no parameter of echo 'of'; there are exchange"},
       }) {
    const ParsedFault parsed = parse_fault(wrong.text);
    ASSERT_FALSE(parsed.ok()) << wrong.text;
    EXPECT_EQ(parsed.error->column, wrong.column) << wrong.text;
    EXPECT_EQ(parsed.error->length, wrong.length) << wrong.text;
    EXPECT_NE(parsed.error->message.find(wrong.message), std::string::npos) << wrong.text << ": " << parsed.error->message;
  }
}

TEST(Fault, WhatWasGivenIsToldWithItsPlaceEvenIfItIsTheStandard) {
  const ParsedFault parsed = parse_fault("missing: of = request ,character=1");
  ASSERT_TRUE(parsed.ok());
  EXPECT_EQ(parsed.given, (std::vector<GivenParameter>{{"of", 10, 12}, {"character", 24, 11}}));
  ASSERT_TRUE(parsed.find("of"));
  EXPECT_FALSE(parsed.find("count"));
}

TEST(Fault, ReadmeHasTheTables) {
  EXPECT_NE(test::text_of(test::source_path("serial_sim/faults/README.md")).find(fault_tables()), std::string::npos)
      << "serial_sim/faults/README.md should contain\n"
      << fault_tables();
}

}  // namespace
}  // namespace s7200::serial::fault_test
