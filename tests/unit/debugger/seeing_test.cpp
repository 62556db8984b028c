#include "interpreter/program/load.hpp"
#include "tests/unit/debugger/session.hpp"

namespace s7200::tools::seeing_test {
namespace {

TEST(Seeing, HistoryListsTheLastInstructionsWithOperandsAndCommentsWithoutGoingThere) {
  AtPrompt session(kNested);
  session("scan 3; step 4");
  const auto here = session.simulation.snapshot();
  const std::string text = session("history 3");
  EXPECT_TRUE(has(text, "main    line 2     CALL    1"));
  EXPECT_TRUE(has(text, "main    line 4     INCW    VW10                 S0=1 VW10=16#0004  // one more scan"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
  EXPECT_EQ(session.simulation.snapshot(), here);
  EXPECT_TRUE(session("history 10000").starts_with("      0.200000  main    line 1 "));
}

TEST(Seeing, TheParametersOfACallHaveTheirValuesInStepsHistoryAndStatus) {
  constexpr std::string_view kScale =
      "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL Scale, M0.0, VW10, 5, VD30, VW20\nINCW VW10\n"
      "= M0.0\nMOVR 2.5, VD30\nEND_ORGANIZATION_BLOCK\n"
      "SUBROUTINE_BLOCK Scale:SBR0\nVAR_INPUT\non : BOOL; raw : INT; add : INT; by : REAL;\nEND_VAR\n"
      "VAR_OUTPUT\nresult : INT;\nEND_VAR\nBEGIN\nNETWORK 1\nLD SM0.0\nMOVW #raw, #result\nEND_SUBROUTINE_BLOCK\n";
  AtPrompt session(check_text(kScale, "test.awl", cpu224(), default_times(cpu224())).program);
  const std::string values = "S0=1 M0.0=1 VW10=16#0003 VD30=16#40200000 (2.5)";
  const std::string stepped = session("scan 3; step 2");
  EXPECT_TRUE(has(stepped, values)) << "constants and results have none";
  EXPECT_FALSE(has(stepped, "VW20="));
  EXPECT_TRUE(has(session("history 1"), values + "\n"));
  EXPECT_TRUE(has(session("scan; status"), "S0=1 M0.0=1 VW10=16#0003"));
}

TEST(Seeing, LadderDrawsANetworkWithThePowerFlowOfItsLastExecution) {
  constexpr std::string_view kText =
      "NETWORK 1\nLD I0.0\nO M0.0\nA I0.1\n= Q0.0\nNETWORK 2\nLDW> VW0, -5\nEU\nMOVW VW2, VW4\nAENO\n= Q0.1\n"
      "NETWORK 3\nLD M1.0\nCALL 0\nMEND\nNETWORK 4\nSBR 0\nLD I0.5\nCRET\nRET\n";
  AtPrompt session(check_text(kText, "test.stl", cpu224(), default_times(cpu224())).program);
  const std::string first = session("force I0.0=1; scan 2; ladder NETWORK 1");
  EXPECT_TRUE(has(first, "1   ╠═┤   ├═╦═┤   ├───(     )\n"));
  EXPECT_TRUE(has(first, "    I0.0=1  M0.0=0  I0.1=0  Q0.0=0\n"));
  EXPECT_TRUE(has(session("force I0.1=1; scan 2; ladder 3"), "1   ╠═┤   ├═╦═┤   ├═══(     )\n"));
  EXPECT_TRUE(has(session("ladder NETWORK 2"), "2   ╠═┤ > W ├═══┤ P ├─────┤EN ENO├──────(     )\n"));
  EXPECT_TRUE(has(session("ladder SBR 0"), "not executed within "));
  EXPECT_TRUE(has(session.error_of("ladder 99"), "the last instruction is in line"));
}

TEST(Seeing, LadderInThePastDrawsThePast) {
  AtPrompt session("NETWORK 1\nLD SM0.1\n= Q0.0\nMEND\n");
  EXPECT_TRUE(has(session("scan 3; ladder NETWORK 1"), "1   ╠═┤   ├───(     )\n"));
  EXPECT_TRUE(has(session("at start; step 2; ladder NETWORK 1"), "1   ╠═┤   ├═══(     )\n"));
}

TEST(Seeing, WhoKnowsWhichInstructionAttachedAnEvent) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("continue 50ms; who event 10"),
                  "ATCH: INT 0 to event 10 (timed interrupt 0, SMB34), every 5 ms\n"
                  "  by SBR 1 line 11    ATCH    0, 10"));
  session("rwho event 10");
  EXPECT_EQ(session.line(), 11U);
  EXPECT_TRUE(has(session("who event 8"), "no instruction has attached or detached event 8 (port 0: character received)"));
}

TEST(Seeing, PrintTakesPointersFormsAndExpressions) {
  AtPrompt session("LD SM0.0\nMOVD &VB100, VD20\nMOVD &VB102, AC1\nMOVD 16#41424344, VD100\nTON T37, 50\nMEND\n");
  session("step 5");
  EXPECT_TRUE(has(session("print *VD20"), "*VD20 is VB100\nVB100    41 "));
  EXPECT_TRUE(has(session("print *AC1:word"), "*AC1:WORD is VW102\nVW102    16#4344"));
  EXPECT_TRUE(has(session("print /c VD100"), "VD100    'ABCD'\n"));
  EXPECT_TRUE(has(session("print /b VB100:2"), "VB100    2#0100_0001\nVB101    2#0100_0010\n"));
  EXPECT_TRUE(has(session("print /x VW100"), "VW100    16#4142\n"));
  EXPECT_TRUE(has(session("print /d VW100"), "VW100    16706\n"));
  EXPECT_EQ(session("print /b V100.6"), "V100.6   2#1\n");
  EXPECT_EQ(session("print /x V100.6"), "V100.6   16#1\n");
  EXPECT_EQ(session("set VD104:real=1.5; print /d VD104:real"), "VD104    1.5\n");
  EXPECT_TRUE(has(session("print VB100 * 2 + 1"), "VB100 * 2 + 1 = 131 (16#00000083)\n"));
  EXPECT_TRUE(has(session("print *AC1 = 16#43 and SM0.0"), " = 1 (16#00000001)\n"));
  EXPECT_TRUE(has(session("print T37"), "T37: bit 0, preset 50, counts 100 ms\n"));
  EXPECT_TRUE(has(session("print SMB30"), "         PPI slave\n"));
  EXPECT_FALSE(has(session("print /x SMB30"), "16#00 =")) << "the byte once";
  EXPECT_TRUE(has(session("print SMW30"), "         SMB30: PPI slave\n"));
  EXPECT_TRUE(has(session("print HC0"), "HSC0: not defined"));
  EXPECT_TRUE(has(session("print C1"), "C1: bit 0"));
}

TEST(Seeing, StatusHasPowerFlowAndOperandsOfTheLastExecutionBesideEachLine) {
  AtPrompt session(kNested);
  session("scan 3; step 2");
  const auto here = session.simulation.snapshot();
  const std::string text = session("status");
  EXPECT_TRUE(has(text, "   line 1     LD      SM0.1                S0=0 SM0.1=0"));
  EXPECT_TRUE(has(text, "   line 2     CALL    1                    S0=0 no power flow"));
  EXPECT_TRUE(has(text, " > line 3     LD      SM0.0                S0=1 SM0.0=1"));
  EXPECT_TRUE(has(session("status INT 0"), "   line 21    INCW    VW30                 not executed within "));
  EXPECT_EQ(session.simulation.snapshot(), here);
  EXPECT_TRUE(has(session("status SBR 2"), "   line 17    MOVW    7, VW20              S0=1 VW20=16#0007"));
}

TEST(Seeing, PrintShowsSpecialMemoryInWords) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("step; print SMB0"), "SM0.0 always 1, SM0.1 first scan, SM0.3 first scan after power-up"));
  EXPECT_TRUE(has(session("print SM0.1"), "SM0.1 first scan"));
  EXPECT_TRUE(has(session("print SMB1"), "none of SMB1 is set"));
  EXPECT_TRUE(has(session("set SMB37=16#88; print SMB37"), "SM37.3 up, SM37.7 enabled"));
  EXPECT_TRUE(has(session("print SMB67"), "none of SMB67 is set"));
}

TEST(Seeing, SymbolsAndTheirCommentsAreShownBesideAddresses) {
  const auto read = [](std::string_view text, const char* name) { return *read_source(std::string(text), name); };
  const CheckResult checked = check(join_files({read("LD SM0.0\nMOVW 5, Speed // set it\nINCW VW100\nMEND\n", "p.awl"),
                                                read("Symbol\tAddress\tComment\nSpeed\tVW100\tin rpm\n", "t.txt")})
                                        .parsed,
                                    cpu214(), default_times(cpu214()));
  ASSERT_TRUE(checked.program);
  AtPrompt session(checked.program);
  session("scan; step 3");
  EXPECT_TRUE(has(session("print VW100"), "         Speed  // in rpm\n"));
  EXPECT_TRUE(has(session("print speed"), "VW100    16#0006"));
  EXPECT_TRUE(has(session("who VW100"), "VW100 (Speed) was 16#0005 (5), became 16#0006 (6)"));
  EXPECT_TRUE(has(session("history 2"), "MOVW    5, Speed:VW100"));
  EXPECT_TRUE(has(session("history 2"), "// set it  [VW100 Speed  // in rpm]"));
  EXPECT_TRUE(has(session("watch VW100"), "watch 1: VW100 (Speed) is 16#0006 (6)"));
}

TEST(Seeing, ARunTimeErrorOfABadPointerTellsItsValueAndWhoWroteIt) {
  AtPrompt session("LD SM0.0\nMOVD 16#7FFFFFFF, VD100 // wrong\nMOVB 1, *VD100\nMEND\n");
  const std::string text = session("break error; continue");
  EXPECT_TRUE(
      has(text, "*VD100: VD100 is 16#7FFFFFFF, which points nowhere\nVD100 was 16#00000000 (0), became 16#7FFFFFFF"));
  EXPECT_TRUE(has(text, "by main line 2     MOVD    16#7FFFFFFF, VD100"));
}

TEST(Seeing, CompletionOffersCommandsAddressesPlacesAndFiles) {
  AtPrompt session(kNested);
  using Words = std::vector<std::string>;
  const auto offered = [&](std::string_view line) { return session.debugger->completions(line).candidates; };
  EXPECT_EQ(offered("conti"), Words{"continue"});
  EXPECT_EQ(offered("step; print vw1"), Words{"VW10"});
  EXPECT_EQ(offered("p VW"), (Words{"VW10", "VW20", "VW30"}));
  EXPECT_EQ(offered("break SBR "), (Words{"1", "2"}));
  EXPECT_EQ(offered("until i"), Words{"INT"});
  EXPECT_EQ(offered("trace o"), (Words{"on", "off"}));
  EXPECT_EQ(offered("help unf"), Words{"unforce"});
  EXPECT_EQ(offered("interrupt "), (Words{"begins", "ends"}));
  EXPECT_EQ(offered("rinterrupt e"), Words{"ends"});
  EXPECT_EQ(offered("at s"), Words{"start"});
  EXPECT_EQ(offered("delete a"), Words{"all"});
  EXPECT_EQ(offered("display o"), Words{"off"});
  EXPECT_EQ(offered("display VW10 o"), Words{});
  EXPECT_EQ(offered("print /"), (Words{"/x", "/d", "/b", "/c"}));
  EXPECT_EQ(offered("step 1"), Words{});
}

TEST(Seeing, CompletionOffersWhatMayBeWishedForAndWhoseChangeIsFollowed) {
  AtPrompt session(kNested);
  using Words = std::vector<std::string>;
  const auto offered = [&](std::string_view line) { return session.debugger->completions(line).candidates; };
  EXPECT_EQ(offered("until VW1"), Words{"VW10"});
  EXPECT_EQ(offered("until no"), Words{"not"});
  EXPECT_EQ(offered("until not VW3"), Words{"VW30"});
  EXPECT_EQ(offered("until VW10 > VW3"), Words{"VW30"});
  EXPECT_EQ(offered("until VW10 w"), Words{"within"});
  EXPECT_EQ(offered("until SBR "), (Words{"1", "2"}));
  EXPECT_EQ(offered("why VW2"), Words{"VW20"});
  EXPECT_EQ(offered("why not VW2"), Words{"VW20"});
  EXPECT_EQ(offered("why not no"), Words{"not"});
  EXPECT_EQ(offered("why not not VW2"), Words{"VW20"});
  EXPECT_EQ(offered("effect VW2"), Words{"VW20"});
  EXPECT_EQ(offered("effect VW20 "), (Words{"at", "within"}));
  EXPECT_EQ(offered("effect VW20 at st"), Words{"start"});
  EXPECT_EQ(offered("effect VW20 at start "), Words{"within"});
}

TEST(Seeing, CompletionOffersTheNumbersOfEventsWhoseRoutineIsAskedFor) {
  AtPrompt session(kNested);
  const auto offered = [&](std::string_view line) { return session.debugger->completions(line).candidates; };
  EXPECT_EQ(offered("who ev"), std::vector<std::string>{"event"});
  EXPECT_EQ(offered("who event 1"), offered("break event 1"));
  EXPECT_EQ(offered("rwho event 10"), std::vector<std::string>{"10"});
}

TEST(Seeing, CompletionOffersMomentsAtWhichSomethingWasDone) {
  AtPrompt session(kNested);
  session("continue 10ms");
  const Time done = session.simulation.time();
  session("set VW20=5");
  const std::vector<std::string> offered = session.debugger->completions("at ").candidates;
  ASSERT_EQ(offered.size(), 3U);
  EXPECT_EQ(offered[0], "start");
  EXPECT_EQ(offered[1], "end");
  EXPECT_EQ(parse_duration(offered[2]), done);
  session("continue 10ms; at " + offered[2]);
  EXPECT_EQ(session.simulation.time(), done);
}

TEST(Seeing, LabelsArePlacesAndAreCompleted) {
  AtPrompt session("LD SM0.0\nJMP 7\nINCW VW0\nLBL 7\nLD SM0.0\nINCW VW2\nLBL 20\nMEND\n");
  const auto offered = [&](std::string_view line) { return session.debugger->completions(line).candidates; };
  EXPECT_EQ(offered("until L"), std::vector<std::string>{"LBL"});
  EXPECT_EQ(offered("until LBL "), (std::vector<std::string>{"7", "20"}));
  EXPECT_TRUE(has(session("break LBL 7; continue"), ">     4  LBL     7"));
  EXPECT_EQ(session.error_of("until LBL 8"), "the program has no LBL 8");
}

TEST(Seeing, ATimelineShowsWhatTheCpuDidSinceTheLastSendOrForSoLong) {
  AtPrompt session(kEcho);
  EXPECT_TRUE(has(session.error_of("timeline"), "timeline expects a duration before the first 'send'"));
  EXPECT_TRUE(has(session.error_of("timeline 0ms"), "timeline expects a duration above 0"));
  const std::string text = session("continue 50ms; send 41; continue; timeline");
  EXPECT_TRUE(has(text, "received  41"));
  EXPECT_TRUE(has(text, "INT 1"));
  EXPECT_TRUE(has(text, "line 11: XMT     VB0, 0"));
  EXPECT_FALSE(has(session("continue 50ms; timeline 20ms"), "received"));
  EXPECT_TRUE(has(session("timeline"), "received  41")) << "it only looks, and shows the last frame again";
}

TEST(Seeing, ExpectIsAWrongCommandUnlessItHolds) {
  AtPrompt session(kNested);
  session("scan 3; expect VW10 = 3 and SM0.0");
  EXPECT_FALSE(session.debugger->expectation_failed());
  EXPECT_EQ(session.error_of("expect VW10 = 4"), "expected VW10 = 4, which does not hold here: VW10 is 3");
  EXPECT_TRUE(session.debugger->expectation_failed());
  session.error_of("expect VW10 +");
  EXPECT_FALSE(session.debugger->expectation_failed()) << "this one cannot be understood";
  session("set VD500=16#FF000000");
  EXPECT_EQ(session.error_of("expect VW10 = 4 and (M0.1 or VW10 > 8) or *VD500 = 1"),
            "expected VW10 = 4 and (M0.1 or VW10 > 8) or *VD500 = 1, which does not hold here: VW10 is 3, M0.1 is 0, *VD500 "
            "points nowhere: VD500 is 16#FF000000");
  EXPECT_TRUE(has(session("print 1/VW600"), "1/VW600 cannot be computed: a division by 0\n"));
  EXPECT_EQ(session.error_of("print 1/0"), "'1/0', column 3: a division by 0");
  EXPECT_TRUE(has(session("print 16#FFFFFFFF + 1"), "16#FFFFFFFF + 1 = 4294967296 (more than a double word)\n"));
  std::string infinite = "16#FFFFFFFF";
  for (int i = 0; i < 40; ++i) infinite += " * 16#FFFFFFFF";
  EXPECT_TRUE(has(session("print " + infinite + " - " + infinite), "nan (more than a double word)\n"));
  EXPECT_TRUE(has(session("print 16#FFFFFFFF"), "= 4294967295 (16#FFFFFFFF)\n"));
  session("set VW600=16#4849 VW602=16#FFFF");
  EXPECT_EQ(session("print /c VB600:4"), "VB600    'HI\\xff\\xff'\n");
  EXPECT_TRUE(has(session("print VW602 > 32767"), "= 0 ")) << "a word has a sign";
  EXPECT_TRUE(has(session("print VW602 = 16#FFFF"), "= 1 ")) << "a constant stands for its bits";
  EXPECT_TRUE(has(session("print *VD500 + 1"), "cannot be computed: *VD500 points nowhere: VD500 is 16#FF000000\n"));
  std::istringstream script("scan 2\nexpect VW10 = 5\nexpect VW10 = 6\nstep\n");
  const auto error = session.debugger->run_script(script);
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->line, 3U);
}

TEST(Seeing, APointerThatPointsNowhereSaysWhoWroteIt) {
  AtPrompt session("LD SM0.0\nMOVD 16#7FFFFFFF, VD100 // wrong\nMOVB 1, *VD100\nMEND\n");
  const std::string text = session("step 3; print *VD100");
  EXPECT_TRUE(
      has(text, "*VD100: VD100 is 16#7FFFFFFF, which points nowhere\nVD100 was 16#00000000 (0), became 16#7FFFFFFF"));
  EXPECT_TRUE(has(text, "by main line 2     MOVD    16#7FFFFFFF, VD100"));
}

TEST(Seeing, WrongCommandsTellWhatIsExpected) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session.error_of("status 99"), "the last instruction is in line 22"));
  EXPECT_TRUE(has(session.error_of("expect"), "expect expects what must hold"));
  EXPECT_TRUE(has(session.error_of("print /q VB0"),
                  "print expects a form (/x hex, /d decimal, /b binary, /c characters), then addresses"));
  EXPECT_TRUE(has(session.error_of("print *VW0"), "a pointer is *VD100"));
  EXPECT_TRUE(has(session.error_of("print VB0 +"), "column 6: an address or a number is missing"));
  EXPECT_TRUE(has(session.error_of("history x"), "history expects how many"));
  EXPECT_TRUE(has(session.error_of("history 99999"), "history expects how many"));
  EXPECT_TRUE(has(session.error_of("who event 99"), "who expects one address, or event and a number"));
}

TEST(Seeing, DisplayWatchAndWhoTakeTheAddressThatAPointerHoldsNowAndSayIt) {
  AtPrompt session("LD SM0.0\nMOVD &VB100, VD20\nMOVB 7, *VD20\nMOVD &VB200, AC1\nMOVR 1.5, VD40\nMEND\n");
  session("step 2");
  EXPECT_TRUE(has(session("display *VD20 VD40:real"), "*VD20 is VB100 now\n"));
  EXPECT_TRUE(has(session("display"), "VB100 "));
  EXPECT_TRUE(has(session("watch *VD20"), "*VD20 is VB100 now\nwatch 1: VB100 is 16#00 (0)\n"));
  EXPECT_TRUE(has(session("continue 10ms"), "watch 1: VB100 was 16#00 (0), is 16#07 (7)\n"));
  const std::string who = session("who *VD20");
  EXPECT_TRUE(has(who, "*VD20 is VB100 now\nVB100 was 16#00 (0), became 16#07 (7)"));
  EXPECT_TRUE(has(who, "by main line 3"));
  EXPECT_TRUE(has(session("step 2; display *AC1:word"), "*AC1:WORD is VW200 now\n"));
  EXPECT_TRUE(has(session("who VD40:real"), "VD40:REAL was"));
  session("rwho *VD20");
  EXPECT_EQ(session.line(), 3u);
}

TEST(Seeing, APointerThatPointsNowhereAndAnExpressionAreRefusedWithWhatToDo) {
  AtPrompt session("LD SM0.0\nMOVD 16#7FFFFFFF, VD100\nMEND\n");
  session("step 2");
  for (const char* command : {"who", "rwho", "watch", "display"})
    EXPECT_EQ(session.error_of(std::string(command) + " *VD100"), "*VD100: VD100 is 16#7FFFFFFF, which points nowhere");
  EXPECT_EQ(session.error_of("display VW2 + 1"), "display takes addresses; 'print VW2 + 1' computes an expression");
  EXPECT_EQ(session.error_of("watch VW2 > 1"), "watch takes addresses; 'print VW2 > 1' computes an expression");
}

TEST(Seeing, WhoOfAnEventThatDoesNotExistSaysWhichDo) {
  AtPrompt session(kEcho);
  for (const char* command : {"who", "rwho"}) {
    const std::string asks = std::string(command) + " event ";
    EXPECT_TRUE(
        has(session.error_of(asks + "99"), "there is no event 99; " + std::string(command) +
                                               " expects one address, or event and a number up to 33, for example:"));
    EXPECT_TRUE(has(session.error_of(asks + "x"), "expects one address, or event and a number"));
  }
}

TEST(Seeing, ThePlaceNamesTheNetworkAndItsTitle) {
  AtPrompt session(
      "NETWORK 1 // count\nLD SM0.0\nINCW VW0\nCALL 1\nNETWORK 2\nLD SM0.0\nINCW VW2\nMEND\nNETWORK 7 // SBR 1: again\n"
      "SBR 1\nLD SM0.0\nCRET\nRET\n");
  EXPECT_TRUE(has(session("until 3"), "main  S0=1  network 1 \"count\"\n >     3  INCW"));
  EXPECT_TRUE(has(session("until 12"), "SBR 1  S0=1  network 7 \"SBR 1: again\"\n"));
  EXPECT_TRUE(has(session("until 7"), "main  S0=1  network 2\n"));
  EXPECT_TRUE(has(session("why"), "SBR 1, network 7 \"SBR 1: again\": CRET in line 12 (LD SM0.0: SM0.0=1)\n"));
  AtPrompt bare("LD SM0.0\nINCW VW0\nMEND\n");
  EXPECT_TRUE(has(bare("until 2"), "main  S0=1\n")) << "without NETWORK lines";
}

TEST(Seeing, AConstantThatAnOperandCanNeverBeIsRefusedWithItsRange) {
  AtPrompt session(kNested);
  for (const auto& [condition, why] : {
           std::pair{"VW20 = 70000", "column 8: VW20 can never be 70000: a word is a whole number from -32768 to 32767"},
           std::pair{"VW20 > -32769", "VW20 can never be -32769: a word"},
           std::pair{"70000 <> VW20", "column 1: VW20 can never be 70000"},
           std::pair{"M0.1 and VB3 = -1", "column 16: VB3 can never be -1: a byte is a whole number from 0 to 255"},
           std::pair{"VB3 < 256", "VB3 can never be 256"},
           std::pair{"M0.1 = 2", "M0.1 can never be 2: a bit is 0 or 1"},
           std::pair{"VD0 = 4294967296", "VD0 can never be 4294967296: a double word is a whole number from -2147483648"},
           std::pair{"AC0 = -2147483649", "AC0 can never be -2147483649: a double word"},
           std::pair{"VW20 = 1.5", "VW20 can never be 1.5: a word is a whole number"},
           std::pair{"*VD0:word = 65536", "*VD0:word can never be 65536"},
           std::pair{"not (T37 = 70000)", "T37 can never be 70000"},
       }) {
    EXPECT_TRUE(has(session.error_of(std::string("break 4 if ") + condition), why)) << condition;
    EXPECT_TRUE(has(session.error_of(std::string("expect ") + condition), why)) << condition;
  }
}

TEST(Seeing, AConstantIsComparedAsTheInstructionsTakeIt) {
  AtPrompt session(kNested);
  session("set VW100=16#FFFF VD104=16#80000000 VB110=255 VD112:real=0.1 VW116=-32768");
  for (const char* const holds :
       {"VW100 = 16#FFFF", "VW100 = 65535", "VW100 = -1", "VW116 = 16#8000", "VW116 = -32768", "VD104 = 16#80000000",
        "VD104 = -2147483648", "VB110 = 255", "VD112:real = 0.1", "0.1 = VD112:real", "VD112:real < 70000",
        "VD112:real <= 0.1", "VW100 < 1.5", "VW100 + 70001 = 70000"})
    EXPECT_EQ(session.error_of(std::string("expect ") + holds), "no error") << holds;
}

TEST(Seeing, WhatIsDoneFromOutsideIsInTheTrace) {
  AtPrompt session("LD SM0.1\nATCH 0, 0\nENI\nMEND\nINT 0\nLD SM0.0\nINCW VW0\nRETI\n");
  const std::string text = session("continue 20ms; trace on; input I0.0=1; mode stop; mode run; set SMB30=16#49");
  EXPECT_TRUE(has(text, "event 0 (rising edge of I0.0) occurred"));
  EXPECT_TRUE(has(text, "STOP"));
  EXPECT_TRUE(has(text, "RUN"));
  EXPECT_TRUE(has(text, "SMB30 = 16#49"));
}

TEST(Seeing, OfCharactersIgnoredUpToASilenceATraceHasTheFirst) {
  AtPrompt session("LD SM0.0\nMEND\n");
  const std::string text = session("continue 20ms; trace on; send 01 03 00 0a; continue 100ms");
  EXPECT_TRUE(has(text, "ignored  01"));
  EXPECT_EQ(text.find("ignored"), text.rfind("ignored")) << text;
}

TEST(Seeing, ACounterHasThePresetOfItsInstruction) {
  AtPrompt session("LD I0.0\nLD I0.1\nCTU C1, 3\nMEND\n");
  EXPECT_TRUE(has(session("print C1"), "C1: bit 0, preset 3\n"));
  EXPECT_TRUE(has(session("print C2"), "C2: bit 0\n"));
}

TEST(Seeing, AColourMarksTheCurrentLineStopsErrorsAndTroubleInATrace) {
  serial::Simulation simulation(program_of("LD SM0.0\nMOVD 16#7F000000, VD0\nMOVB 1, *VD0\nMEND\n"));
  simulation.power_up();
  std::ostringstream out;
  PromptSettings options{};
  options.colour = true;
  Prompt debugger(std::vector{&simulation}, out, options);
  EXPECT_FALSE(debugger.execute("break 3; trace on; continue; step"));
  EXPECT_TRUE(has(out.str(), "\x1b[1mbreakpoint 1, hit for the first time\x1b[0m\n"));
  EXPECT_TRUE(has(out.str(), " \x1b[1m>\x1b[0m     3  MOVB")) << "where it stands";
  EXPECT_TRUE(has(out.str(), "\x1b[31mrun-time error 0006")) << "as it is reported";
  EXPECT_TRUE(has(out.str(), "\x1b[33m  ")) << "in the trace";
  out.str("");
  EXPECT_FALSE(debugger.execute("list"));
  EXPECT_TRUE(has(out.str(), "*      3  MOVB"));
  EXPECT_TRUE(has(out.str(), " \x1b[1m>\x1b[0m     4  MEND"));
}

}  // namespace
}  // namespace s7200::tools::seeing_test
