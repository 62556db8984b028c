// Programs of several instructions, for what a single one cannot show.
#include <map>

#include "tests/vectors/cases.hpp"

namespace s7200::vectors {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

std::vector<std::string> lines(std::string_view text) {
  std::vector<std::string> result(1);
  for (const char c : text) {
    if (c != '|')
      result.back() += c;
    else
      result.emplace_back();
  }
  return result;
}

Case steps(std::string title, std::string_view program, std::uint32_t count, std::vector<std::string> before = {},
           Levels stack = {false}) {
  return {std::move(title), lines(program), std::move(before), std::move(stack), count, 0, 0};
}

Case until(std::string title, std::string_view program, std::int64_t time, std::vector<std::string> before = {}) {
  return {std::move(title), lines(program), std::move(before), {false}, 1, time, 0};
}

constexpr std::string_view kNinthCall = "LD SM0.0|CALL 0|MEND|SBR 0|CALL 0|INCW VW10|RET";
constexpr std::string_view kLoop = "LD SM0.0|FOR VW10, VW20, VW30|INCW VW40|LDN SM0.0|NEXT|MEND";
constexpr std::string_view kEdges = "LBL 0|LD V0.0|EU|= V1.0|LDN V0.0|= V0.0|LD SM0.0|JMP 0|MEND";
constexpr std::string_view kFallingEdges = "LBL 0|LD V0.0|ED|= V1.0|LDN V0.0|= V0.0|LD SM0.0|JMP 0|MEND";
constexpr std::string_view kSegment = "LSCR S1.0|LD SM0.0|INCW VW10|LD V0.0|SCRT S1.1|SCRE|LD SM0.0|MEND";
constexpr std::string_view kCountUp = "LBL 0|LD V0.0|LD V0.1|CTU C1, 2|LDN V0.0|= V0.0|LD SM0.0|JMP 0|MEND";
constexpr std::string_view kCountBoth =
    "LBL 0|LD V0.0|LD V0.1|LD V0.2|CTUD C1, 2|LDN V0.0|= V0.0|LDN V0.1|= V0.1|LD SM0.0|JMP 0|MEND";
constexpr std::string_view kLoopWithPointers = "LD SM0.0|FOR *VD50, 1, *AC1|NEXT|MEND";

std::vector<Case> jumps() {
  return {steps("taken: the stack has a 1 on top", "LD V0.0|JMP 5|INCW VW10|LBL 5|MEND", 2, {"V0.0=1"}, {false, true}),
          steps("not taken", "LD V0.0|JMP 5|INCW VW10|LBL 5|MEND", 2),
          steps("back", "LBL 5|LD SM0.0|INCW VW10|JMP 5|MEND", 8)};
}

std::vector<Case> loops() {
  return {
      steps("three passes; INDX ends at FINAL + 1, the stack with a 1 on top", kLoop, 11, {"VW20=16#0001", "VW30=16#0003"}),
      steps("INIT above FINAL: the body is not run", kLoop, 2, {"VW20=16#0002", "VW30=16#0001"}),
      steps("INIT and FINAL are signed", kLoop, 5, {"VW20=16#FFFF", "VW30=16#0001"}),
      steps("INIT = FINAL: one pass", kLoop, 5, {"VW20=16#0005", "VW30=16#0005"}),
      steps("no power flow: goes on after NEXT", "LDN SM0.0|FOR VW10, 1, 3|INCW VW40|NEXT|MEND", 2),
      steps("INDX wraps after 32767", kLoop, 5, {"VW20=16#7FFF", "VW30=16#7FFF"}),
      steps("FINAL is read anew", "LD SM0.0|FOR VW10, 1, VW30|DECW VW30|NEXT|MEND", 6, {"VW30=16#0003"}),
      steps("FINAL overlaps INDX: INDX is stored first", "LD SM0.0|FOR VW10, 1, VW10|NEXT|MEND", 4),
      steps("pointers cost time in FOR and in NEXT", kLoopWithPointers, 3,
            {"VD50=16#0800003C", "AC1=16#02000004", "MW4=16#0002"}),
      steps("a bad pointer in FOR: not executed", kLoopWithPointers, 2, {"VD50=16#0800003C", "AC1=16#03000000"}),
      steps("a pointer gone bad in NEXT: not executed", "LD SM0.0|FOR *VD50, 1, 3|MOVD 16#03000000, VD50|NEXT|MEND", 4,
            {"VD50=16#0800003C"}),
      steps("nested", "LD SM0.0|FOR VW10, 1, 2|FOR VW20, 1, 2|INCW VW40|NEXT|NEXT|MEND", 14),
      steps("INDX in each area",
            "LD SM0.0|FOR IW0, 1, 1|NEXT|FOR QW0, 1, 1|NEXT|FOR MW4, 1, 1|NEXT|FOR SMW38, 1, 1|NEXT|"
            "FOR SW5, 1, 1|NEXT|FOR T37, 1, 1|NEXT|FOR C5, 1, 1|NEXT|FOR AC0, 1, 1|NEXT|FOR *AC1, 1, 1|NEXT|MEND",
            19, {"AC0=16#A5A5A5A5", "AC1=16#08000064"}),
      steps("INIT in each area",
            "LD SM0.0|FOR VW10, VW20, 0|NEXT|FOR VW10, IW0, 0|NEXT|FOR VW10, QW0, 0|NEXT|FOR VW10, MW4, 0|"
            "NEXT|FOR VW10, SMW22, 0|NEXT|FOR VW10, SW5, 0|NEXT|FOR VW10, T37, 0|NEXT|FOR VW10, C5, 0|NEXT|FOR VW10, AC0, "
            "0|NEXT|"
            "FOR VW10, AIW4, 0|NEXT|FOR VW10, *VD50, 0|NEXT|FOR VW10, *AC1, 0|NEXT|MEND",
            13,
            {"VW20=16#0001", "IW0=16#0002", "QW0=16#0003", "MW4=16#0004", "SMW22=16#0005", "SW5=16#0006", "T37=7", "C5=8",
             "AC0=16#A5A50009", "AIW4=16#000A", "VD50=16#08000014", "AC1=16#02000004"}),
      steps("FINAL in each area",
            "LD SM0.0|FOR VW10, 9, VW20|NEXT|FOR VW10, 9, IW0|NEXT|FOR VW10, 9, QW0|NEXT|FOR VW10, 9, MW4|"
            "NEXT|FOR VW10, 9, SMW22|NEXT|FOR VW10, 9, SW5|NEXT|FOR VW10, 9, T37|NEXT|FOR VW10, 9, C5|NEXT|FOR VW10, 9, "
            "AC0|NEXT|"
            "FOR VW10, 9, AIW4|NEXT|FOR VW10, 9, *VD50|NEXT|FOR VW10, 9, *AC1|NEXT|MEND",
            13, {"AC0=16#A5A50008", "VD50=16#08000014", "AC1=16#02000004"})};
}

std::vector<Case> calls() {
  return {steps("a subroutine starts with a stack of 1 0 0 …", "LD V0.0|LD V0.1|CALL 3|MEND|SBR 3|RET", 3, {"V0.1=1"},
                {true, true}),
          steps("the caller's stack comes back", "LD V0.0|LD V0.1|CALL 3|MEND|SBR 3|LDN SM0.0|LD SM0.0|RET", 7, {"V0.1=1"},
                {true, true}),
          steps("no power flow", "LDN SM0.0|CALL 3|MEND|SBR 3|RET", 2), steps("eight deep", kNinthCall, 16),
          steps("the ninth call is error 0008 and not executed", kNinthCall, 18)};
}

std::vector<Case> returns() {
  return {steps("return", "LD SM0.0|CALL 3|MEND|SBR 3|LD V0.0|CRET|INCW VW10|RET", 5, {"V0.0=1"}),
          steps("no power flow", "LD SM0.0|CALL 3|MEND|SBR 3|LD V0.0|CRET|INCW VW10|RET", 6)};
}

std::vector<Case> segments() {
  return {steps("the S bit is 0: a 0 is pushed", kSegment, 1, {"S1.0=0"}, {false, true}),
          steps("the S bit is 0: SM0.0 gives no power flow, the box does nothing", kSegment, 3, {"S1.0=0"}),
          steps("the S bit is 0: SCRT does nothing", kSegment, 5, {"S1.0=0", "V0.0=1"}),
          steps("after SCRE contacts have power again", kSegment, 7, {"S1.0=0"}),
          steps("the S bit is 0: coils become 0", "LSCR S1.0|= V1.0|LDN V0.0|= V1.1|LDB>= 1, 0|= V1.2|SCRE|MEND", 7,
                {"V1.0=1", "V1.1=1", "V1.2=1"}),
          steps("the S bit is 0: contacts in parallel are without power too",
                "LSCR S1.0|LD SM0.0|O SM0.0|ON V0.0|OB= 1, 1|= V1.0|SCRE|MEND", 6, {"V1.0=1"}),
          steps("the S bit is 0: NOT gives power flow, a contact in series passes it on",
                "LSCR S1.0|LD SM0.0|NOT|A SM0.0|INCW VW10|SCRE|MEND", 5),
          steps("the S bit is 0: TON is reset", "LSCR S1.0|LD SM0.0|TON T37, 5|SCRE|MEND", 3, {"T37=7", "T37.bit=1"}),
          steps("the S bit is 0: TONR keeps its value", "LSCR S1.0|LD SM0.0|TONR T5, 5|SCRE|MEND", 3, {"T5=7", "T5.bit=1"}),
          steps("a subroutine called from a segment that is off has power of its own",
                "LSCR S1.0|LD SM0.0|NOT|CALL 0|LD SM0.0|INCW VW10|SCRE|MEND|SBR 0|LD SM0.0|INCW VW20|RET", 9),
          steps("the S bit is 1: a 1 is pushed", kSegment, 1, {"S1.0=1"}, {false, true}),
          steps("transition", kSegment, 5, {"S1.0=1", "V0.0=1"}),
          steps("no power flow at SCRT", kSegment, 5, {"S1.0=1"}),
          steps("SCRE leaves memory and logic stack alone", kSegment, 6, {"S1.0=1", "V0.0=1"}),
          steps("a transition to the same segment leaves it on", "LSCR S1.0|LD SM0.0|SCRT S1.0|SCRE|MEND", 3, {"S1.0=1"})};
}

std::vector<Case> ends() {
  return {steps("END with power flow", "LD SM0.0|END|INCW VW10|MEND", 2),
          steps("END without", "LDN SM0.0|END|INCW VW10|MEND", 2),
          steps("the next scan: inputs are read, outputs written", "LD SM0.0|END|MEND", 3, {"PIB0=16#12", "QB1=16#34"})};
}

/// A timer switched on in a program that does nothing else; scans of about 0.9 ms.
std::vector<Case> timer_runs(const std::string& mnemonic, const std::string& fast, const std::string& medium,
                             const std::string& slow) {
  std::vector<Case> cases;
  for (const std::string& timer : {fast, medium, slow}) {
    const std::string program = "LD V0.0|" + mnemonic + " " + timer + ", 3|MEND";
    const std::int64_t base = (timer == fast ? 1 : timer == medium ? 10 : 100) * kMillisecond;
    cases.push_back(until(timer + " before its preset", program, 2 * base + base / 2, {"V0.0=1"}));
    cases.push_back(until(timer + " at its preset", program, 4 * base, {"V0.0=1"}));
    if (mnemonic == "TONR")
      cases.push_back(until(timer + " stops at 32767", program, 3 * base, {"V0.0=1", timer + "=32766"}));
  }
  cases.push_back(
      steps(fast + ": R clears value and bit", "LD SM0.0|R " + fast + ", 1|MEND", 2, {fast + "=5", fast + ".bit=1"}));
  for (const std::string& timer : {fast, medium})
    cases.push_back(
        until(timer + " stands still after R: it is not executed again",
              "LD V0.0|JMP 0|LD SM0.0|" + mnemonic + " " + timer + ", 3|LD SM0.0|R " + timer + ", 1|= V0.0|LBL 0|MEND",
              (timer == fast ? 4 : 40) * kMillisecond));
  cases.push_back(until(slow + " goes on after R",
                        "LD SM0.0|" + mnemonic + " " + slow + ", 3|LD SM0.1|R " + slow + ", 1|MEND", 250 * kMillisecond));
  return cases;
}

std::vector<Case> counts_up() {
  return {steps("a 1 at the first execution is not an edge", kCountUp, 4, {"V0.0=1"}),
          steps("one rising edge", kCountUp, 12),
          steps("two rising edges: the preset is reached", kCountUp, 28),
          steps("reset wins over an edge", kCountUp, 12, {"V0.1=1", "C1=7", "C1.bit=1"}),
          steps("stops at 32767", kCountUp, 12, {"C1=32767"}),
          steps("counts up from below 0", kCountUp, 12, {"C1=-5"})};
}

std::vector<Case> counts_both() {
  return {steps("up", kCountBoth, 15), steps("up wraps after 32767", kCountBoth, 15, {"C1=32767", "V0.1=1"}),
          steps("up and down together cancel", kCountBoth, 15, {"C1=5"}),
          steps("down", kCountBoth, 25, {"V0.0=1", "C1=-32768"}),
          steps("reset", kCountBoth, 15, {"V0.2=1", "C1=7", "C1.bit=1"})};
}

/// One instruction whose source and destination overlap.
Case overlap(std::string title, std::string_view op, std::vector<std::string> before) {
  return steps(std::move(title), op, 1, std::move(before), {true});
}

std::vector<Case> overlapping_moves(const std::string& op, const std::string& place, std::uint32_t size) {
  const auto at = [&](std::uint32_t i) { return place + std::to_string(10 + i * size); };
  const std::vector<std::string> before{at(0) + "=16#11", at(1) + "=16#22", at(2) + "=16#33", at(3) + "=16#44"};
  return {overlap("to a place further on", op + " " + at(0) + ", " + at(1) + ", 3", before),
          overlap("to a place further back", op + " " + at(1) + ", " + at(0) + ", 3", before)};
}

std::vector<Case> overlapping_digits() {
  return {overlap("digits to where their characters are", "ATH VB10, VB10, 4",
                  {"VB10=16#31", "VB11=16#32", "VB12=16#33", "VB13=16#34"}),
          overlap("a digit over a character that is still to be read", "ATH VB10, VB11, 3",
                  {"VB10=16#38", "VB11=16#31", "VB12=16#32"})};
}

std::vector<Case> overlapping_characters() {
  return {overlap("a character over digits that are still to be read", "HTA VB10, VB10, 4", {"VB10=16#12", "VB11=16#AB"}),
          overlap("characters further on", "HTA VB10, VB11, 4", {"VB10=16#12", "VB11=16#AB"})};
}

constexpr std::string_view kCountDown = "LBL 0|LD V0.0|LD V0.1|CTD C1, 2|LDN V0.0|= V0.0|LD SM0.0|JMP 0|MEND";
constexpr std::string_view kLeave = "LSCR S1.0|LD V0.0|CSCRE|LD SM0.0|INCW VW10|SCRE|LD SM0.0|MEND";
constexpr std::string_view kEno = "LD V0.0|LD V0.1|ITB VW10, VB20|LPP|AENO|= V1.0|MEND";

std::vector<Case> off_delays() {
  std::vector<Case> cases{
      steps("the bit is on with the input", "LD V0.0|TOF T37, 3|MEND", 2, {"V0.0=1", "T37=7"}),
      steps("an input that was never on does not start it", "LD V0.0|TOF T37, 3|MEND", 2, {"T37=2"}),
      steps("R: it needs the input to go on and off again",
            "LBL 0|LD V0.0|TOF T37, 3|LD SM0.0|R V0.0, 1|R T37, 1|JMP 0|MEND", 10, {"V0.0=1"}),
      steps("a preset of 0: off at once", "LBL 0|LD V0.0|TOF T37, VW10|LDN V0.0|= V0.0|LD SM0.0|JMP 0|MEND", 10, {"V0.0=1"}),
      steps("in a segment that is off: value and bit are 0", "LSCR S1.0|LD SM0.0|TOF T37, 3|SCRE|MEND", 3,
            {"T37=7", "T37.bit=1"}),
      steps("in a segment that goes off it does not time",
            "LD SM0.0|LBL 0|LSCR S1.0|LD SM0.0|TOF T37, 3|SCRT S1.1|SCRE|LD SM0.0|JMP 0|MEND", 15, {"S1.0=1"})};
  for (const auto& [timer, base] : {std::pair{"T32", 1}, {"T33", 10}, {"T37", 100}}) {
    const std::string program = std::string("LD V0.0|TOF ") + timer + ", 3|LD SM0.0|R V0.0, 1|MEND";
    cases.push_back(until(std::string(timer) + " times after the input has gone off", program,
                          (base * 5 / 2 + 1) * kMillisecond, {"V0.0=1"}));
    cases.push_back(until(std::string(timer) + " stops at its preset, its bit goes off", program,
                          (base * 6 + 2) * kMillisecond, {"V0.0=1"}));
  }
  return cases;
}

std::vector<Case> counts_down() {
  return {steps("a 1 at the first execution is not an edge", kCountDown, 4, {"V0.0=1", "C1=5"}),
          steps("one rising edge", kCountDown, 12, {"C1=5"}), steps("to 0: the bit is on", kCountDown, 28, {"C1=2"}),
          steps("stops at 0", kCountDown, 28, {"C1=1"}),
          steps("load: the preset, the bit off", kCountDown, 12, {"V0.1=1", "C1=0", "C1.bit=1"})};
}

std::vector<Case> enos() {
  return {
      steps("a box without error: 1", kEno, 6, {"V0.0=1", "V0.1=1"}, {false}),
      steps("a box that has failed: 0", kEno, 6, {"V0.0=1", "V0.1=1", "VW10=16#0100", "V1.0=1"}, {false}),
      steps("a box without power flow: 0", kEno, 6, {"V0.0=1", "V1.0=1"}, {false}),
      steps("the top of the stack stays 0", kEno, 6, {"V0.1=1"}, {false}),
      steps("a run-time error: 0", "LD SM0.0|MOVB *VD10, VB20|AENO|= V1.0|MEND", 4, {"VD10=16#FF000000", "V1.0=1"}, {false}),
      steps("the last bit of a shift is no failure", "LD SM0.0|SRW VW10, 1|AENO|= V1.0|MEND", 4, {"VW10=16#0003"}, {false}),
      steps("contacts and coils leave it alone", "LD SM0.0|ITB VW10, VB20|= V1.1|A V0.0|S V1.2, 1|LD SM0.0|AENO|= V1.0|MEND",
            8, {"VW10=16#0100", "V1.0=1"}, {false}),
      steps("after RET: 1", "LD SM0.0|CALL 0|AENO|= V1.0|MEND|SBR 0|ITB VW10, VB20|RET", 7, {"VW10=16#0100"}, {false})};
}

std::vector<Case> intervals() {
  return {until("milliseconds since power-up", "LD SM0.0|BITIM VD10|MEND", 123 * kMillisecond),
          until("milliseconds since IN", "LD SM0.1|BITIM VD10|LD SM0.0|CITIM VD10, VD20|MEND", 123 * kMillisecond)};
}

const std::map<std::string_view, std::vector<Case>>& programs() {
  static const std::map<std::string_view, std::vector<Case>> kPrograms{
      {"BMB", overlapping_moves("BMB", "VB", 1)},
      {"BMW", overlapping_moves("BMW", "VW", 2)},
      {"ATH", overlapping_digits()},
      {"HTA", overlapping_characters()},
      {"JMP", jumps()},
      {"LBL", {steps("takes no time", "LD V0.0|JMP 5|INCW VW10|LBL 5|MEND", 3, {"V0.0=1"})}},
      {"FOR", loops()},
      {"NEXT", {steps("leaves a 1 on top of the stack", "LD SM0.0|FOR VW10, 1, 1|LDN SM0.0|NEXT|MEND", 4)}},
      {"CALL", calls()},
      {"SBR", {steps("takes no time", "LD SM0.0|CALL 3|MEND|SBR 3|RET", 3)}},
      {"RET", {steps("back to after the CALL", "LD SM0.0|CALL 3|MEND|SBR 3|RET", 4)}},
      {"CRET", returns()},
      {"LSCR", segments()},
      {"SCRT", segments()},
      {"SCRE", {steps("the end of a segment that is on", kSegment, 6, {"S1.0=1"})}},
      {"END", ends()},
      {"MEND", {steps("the end of the main program", "LD SM0.0|MEND", 2)}},
      {"STOP",
       {steps("to STOP: the output points go off, the image stays", "LD SM0.0|STOP|MEND", 2, {"PQB0=16#FF", "QB0=16#FF"}),
        steps("no power flow", "LDN SM0.0|STOP|MEND", 2)}},
      {"EU",
       {steps("rising edge", kEdges, 12), steps("no falling edge", kEdges, 12, {"V0.0=1"}),
        steps("one execution long", "LBL 0|LD V0.0|EU|= V1.0|LD SM0.0|S V0.0, 1|JMP 0|MEND", 18)}},
      {"ED", {steps("falling edge", kFallingEdges, 12, {"V0.0=1"}), steps("no rising edge", kFallingEdges, 12)}},
      {"TON", timer_runs("TON", "T32", "T33", "T37")},
      {"TONR", timer_runs("TONR", "T0", "T1", "T5")},
      {"CTU", counts_up()},
      {"CTUD", counts_both()},
      {"INT", {}},
      {"TOF", off_delays()},
      {"CTD", counts_down()},
      {"AENO", enos()},
      {"BITIM", intervals()},
      {"CITIM", intervals()},
      {"CSCRE",
       {steps("to the SCRE", kLeave, 4, {"S1.0=1", "V0.0=1"}), steps("no power flow", kLeave, 5, {"S1.0=1"}),
        steps("a segment that is off", kLeave, 5, {"S1.0=0", "V0.0=1"}),
        steps("contacts have power again", kLeave, 5, {"S1.0=1", "V0.0=1"})}},
      {"DTCH",
       {steps("not attached: nothing", "LD SM0.0|DTCH 0|MEND", 2), steps("no power flow", "LDN SM0.0|DTCH 0|MEND", 2)}},
      {"ATCH",
       {steps("nothing yet", "LD SM0.0|ATCH 4, 0|MEND|INT 4|RETI", 2),
        steps("no power flow", "LDN SM0.0|ATCH 4, 0|MEND|INT 4|RETI", 2)}},
      {"ENI", {steps("SM4.4 shows it", "LD SM0.0|ENI|MEND", 2)}},
      {"DISI", {steps("SM4.4 shows it", "LD SM0.0|ENI|DISI|MEND", 3)}},
      {"WDR",
       {until("a program of 0.4 s", "LBL 0|LD SM0.0|WDR|AN V0.0|JMP 0|MEND", 400 * kMillisecond),
        steps("the watchdog: fatal error 0003", "LD SM0.0|FOR VW10, 1, 32767|NEXT|MEND", 2001)}},
  };
  return kPrograms;
}

}  // namespace

std::vector<Case> programs_of(std::string_view mnemonic) {
  const auto found = programs().find(mnemonic);
  return found == programs().end() ? std::vector<Case>{} : found->second;
}

}  // namespace s7200::vectors
