// Where pointers lead at each instruction that goes through them.
#include "interpreter/analysis/effects/reaching_values.hpp"

#include <fmt/format.h>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/effects/pointers.hpp"
#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text/joined.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::reaching_values_test {
namespace {

const CpuModel& cpu() { return *find_cpu("224"); }

std::string place_text(const PointerTarget& target) {
  const std::string first = memory_text({target.from * 8u, 8});
  return target.to == target.from + 1 ? first : first + "-" + memory_text({(target.to - 1) * 8u, 8});
}

/// Of each instruction that goes through a pointer, its line and where the pointer leads: `3: VB100; 5: VB100-VB107`.
std::string reached(std::string_view text) {
  const auto program = program_of(text, cpu());
  const Pointers pointers(*program);
  std::vector<std::string> all;
  for (std::uint32_t op = 0; op < program->ops.size(); ++op)
    for (const Operand& operand : program->ops[op].operand)
      if (operand.pointer)
        all.push_back(fmt::format("{}: {}", program->statement(op).position.line,
                                  stl::joined(pointers.targets(op, operand.at), place_text)));
  return stl::joined(
      all, [](const std::string& each) { return each; }, "; ");
}

/// The text of the op because of which the last pointer of a program may lead anywhere.
std::string blamed(std::string_view text) {
  const auto program = program_of(text, cpu());
  const Pointers pointers(*program);
  std::string found = "known";
  for (std::uint32_t op = 0; op < program->ops.size(); ++op)
    for (const Operand& operand : program->ops[op].operand)
      if (const auto unknown = operand.pointer ? pointers.unknown(op, operand.at) : std::nullopt)
        found = unknown->reason == Pointers::Unknown::Reason::NotSet
                    ? "not set"
                    : fmt::format("line {}{}", program->statement(unknown->op).position.line,
                                  unknown->reason == Pointers::Unknown::Reason::Counted ? " counts" : "");
  return found;
}

TEST(ReachingValues, AnAddressReachesWhatFollowsIt) {
  EXPECT_EQ(reached("LD SM0.0\nMOVD &VB100, AC1\nMOVB 1, *AC1\nMOVD &VB200, AC1\nMOVB 1, *AC1\nMEND\n"),
            "3: VB100; 5: VB200");
  EXPECT_EQ(reached("LD SM0.0\nCALL 1\nCALL 2\nMEND\nSBR 1\nLD SM0.0\nMOVD &VB100, AC1\nMOVB 1, *AC1\nRET\n"
                    "SBR 2\nLD I0.0\nMOVD &VB200, AC1\nMOVB 2, *AC1\nRET\n"),
            "8: VB100; 13: VB200")
      << "another routine loads the same accumulator";
  EXPECT_EQ(reached("LD SM0.0\nMOVD &VB100, AC1\n+D 16, AC1\nMOVD AC1, VD4\nINCD VD4\nMOVW 1, *VD4\nMEND\n"), "6: VB117");
}

TEST(ReachingValues, WhereWaysMeetEitherMayCome) {
  EXPECT_EQ(reached("LD SM0.0\nMOVD &VB100, AC1\nLD I0.0\nMOVD &VB200, AC1\nLD SM0.0\nMOVB 1, *AC1\nMEND\n"),
            "6: VB100, VB200");
  EXPECT_EQ(reached("LD SM0.0\nMOVD &VB100, AC1\nLD I0.0\nJMP 1\nLD SM0.0\nMOVD &VB300, AC1\nMOVB 1, *AC1\nLBL 1\nLD SM0.0\n"
                    "MOVB 1, *AC1\nMEND\n"),
            "7: VB300; 10: VB100, VB300");
}

TEST(ReachingValues, AForLoopCountsWhatItsPassesAdd) {
  EXPECT_EQ(reached("LD SM0.0\nMOVD &VB400, AC1\nFOR VW0, 1, 10\nLD SM0.0\nMOVW *AC1, AC2\n+D 2, AC1\nNEXT\nLD SM0.0\n"
                    "MOVB 1, *AC1\nMEND\n"),
            "5: VB400-VB418; 9: VB420");
  EXPECT_EQ(reached("LD SM0.0\nMOVD &VB400, AC1\nFOR VW0, 1, 3\nLD SM0.0\nFOR VW2, 0, 3\nLD SM0.0\nMOVB 0, *AC1\nINCD AC1\n"
                    "NEXT\nNEXT\nMEND\n"),
            "7: VB400-VB411")
      << "a loop in a loop";
  EXPECT_EQ(
      reached("LD SM0.0\nMOVD &VB400, AC1\nBTI VB9, VW4\nFOR VW0, 1, VW4\nLD SM0.0\nMOVB 0, *AC1\nINCD AC1\nNEXT\nMEND\n"),
      "6: VB400-VB654")
      << "a byte says how often";
  EXPECT_EQ(
      reached("LD SM0.0\nMOVD &VB400, AC1\nFOR VW0, 1, 10\nLD SM0.0\nMOVB 0, *AC1\nINCD AC1\nMOVW 1, VW0\nNEXT\nMEND\n"),
      "5: VB400-VB8191")
      << "its passes set its index";
}

TEST(ReachingValues, APointerThatMovesTowardsItsOwnPlaceIsStillBounded) {
  constexpr std::string_view kDown =
      "LD SM0.0\nMOVD &VB628, VD104\nMOVD &VB630, VD108\nFOR VW52, 1, 15\nLD SM0.0\n"
      "MOVW *VD104, *VD108\n-D 2, VD104\n-D 2, VD108\nNEXT\nLD SM0.0\nMOVW 0, *VD108\nMEND\n";
  EXPECT_EQ(reached(kDown), "6: VB600-VB628; 6: VB602-VB630; 11: VB600");
  EXPECT_EQ(reached("LD SM0.0\nMOVD &VB10, VD100\nFOR VW52, 1, 15\nLD SM0.0\nMOVW 0, *VD100\n+D 2, VD100\nNEXT\nMEND\n"),
            "5: VB10-VB38");
  EXPECT_TRUE(reached("LD SM0.0\nMOVD &VB90, VD100\nFOR VW52, 1, 15\nLD SM0.0\nMOVW 0, *VD100\n+D 2, VD100\nNEXT\nMEND\n")
                  .ends_with("AQB0-AQB63"))
      << "it overwrites itself";
}

TEST(ReachingValues, BehindALoopAPointerIsWhereAllPassesBroughtIt) {
  const auto behind = [](std::string_view loop) {
    const std::string all = reached(fmt::format("LD SM0.0\nMOVD &VB400, AC1\n{}LD SM0.0\nMOVB 1, *AC1\nMEND\n", loop));
    return all.substr(all.rfind(": ") + 2);
  };
  EXPECT_EQ(behind("FOR VW0, 1, 10\nLD SM0.0\n+D 2, AC1\nNEXT\n"), "VB420");
  EXPECT_EQ(behind("FOR VW0, 1, 10\nLD SM0.0\n+D 5, AC1\n-D 1, AC1\nNEXT\n"), "VB440");
  EXPECT_EQ(behind("FOR VW0, 1, 3\nLD SM0.0\nFOR VW2, 0, 3\nLD SM0.0\n+D 2, AC1\nNEXT\nNEXT\n"), "VB424")
      << "a loop in a loop";
  EXPECT_EQ(behind("FOR VW0, 1, 3\nLD SM0.0\nFOR VW2, 0, 3\nLD SM0.0\nINCD AC1\nNEXT\nLD SM0.0\nINCD AC1\nNEXT\n"), "VB415");
  EXPECT_EQ(behind("FOR VW0, 1, 10\nLD I0.0\n+D 2, AC1\nNEXT\n"), "VB400-VB420") << "under a condition";
  EXPECT_EQ(behind("FOR VW0, 1, 10\nLD I0.0\nJMP 1\nLD SM0.0\n+D 2, AC1\nLBL 1\nNEXT\n"), "VB400-VB420");
  EXPECT_EQ(behind("FOR VW0, 1, 3\nLD SM0.0\nBTI VB9, VW4\nFOR VW2, 1, VW4\nLD SM0.0\nINCD AC1\nNEXT\nNEXT\n"),
            "VB400-VB1165");
  EXPECT_EQ(behind("LDB<= VB9, 4\nMOVW 0, VW4\nMOVB VB9, VB5\nFOR VW0, 1, VW4\nLD SM0.0\nINCD AC1\nNEXT\n"), "VB400-VB404");
  EXPECT_EQ(behind("LD I0.0\nFOR VW0, 1, 10\nLD SM0.0\n+D 2, AC1\nNEXT\n"), "VB400, VB420") << "no pass, or all";
}

TEST(ReachingValues, TheIndexOfALoopIsBetweenItsEnds) {
  EXPECT_EQ(reached("LD SM0.0\nFOR VW0, 0, 7\nLD SM0.0\nMOVD &VB100, AC1\nITD VW0, AC0\nSLD AC0, 2\n+D AC0, AC1\n"
                    "MOVD VD20, *AC1\nNEXT\nMEND\n"),
            "8: VB100-VB128");
}

TEST(ReachingValues, ComparisonsBoundWhatFollowsThem) {
  constexpr std::string_view kTable = "MOVD &VB1000, AC1\n+D AC0, AC1\nMOVB 1, *AC1\n";
  EXPECT_EQ(reached(fmt::format("LDB<= VB0, 7\nMOVD 0, AC0\nMOVB VB0, AC0\n{}MEND\n", kTable)), "6: VB1000-VB1007");
  EXPECT_EQ(
      reached(fmt::format("LDB< VB0, 1\nOB> VB0, 8\nMOVB VB1, VB0\nEND\nLD SM0.0\nMOVD 0, AC0\nMOVB VB0, AC0\nDECD AC0\n"
                          "SLD AC0, 4\n{}MEND\n",
                          kTable)),
      "12: VB1000-VB1112")
      << "END without power flow: neither comparison holds";
  EXPECT_EQ(
      reached(fmt::format("LDW> VW0, 9\nMOVW 9, VW0\nLDW< VW0, 0\nMOVW 0, VW0\nLD SM0.0\nITD VW0, AC0\n{}MEND\n", kTable)),
      "9: VB1000-VB1009");
  EXPECT_EQ(reached(fmt::format("LDW> VW0, 9\nLPS\nMOVW 9, VW0\nLPP\nITD VW0, AC0\n{}MEND\n", kTable)), "8: VB0-VB1009")
      << "9 or what was not above it";
}

TEST(ReachingValues, WhatTheProgramCountsStaysBetweenItsLimitsFromScanToScan) {
  EXPECT_EQ(reached("LD I0.0\nMOVD &VB400, AC1\nITD VW300, AC0\n+D AC0, AC1\n+D AC0, AC1\nMOVW VW2, *AC1\nINCW VW300\n"
                    "LDW>= VW300, 10\nMOVW 0, VW300\nMEND\n"),
            "6: VB400-VB418");
  EXPECT_EQ(reached("LD SM0.1\nMOVD &VB100, VD0\nLD I0.0\nMOVB IB1, *VD0\nINCD VD0\nLDD>= VD0, 16#080000C8\n"
                    "MOVD &VB100, VD0\nMEND\n"),
            "4: VB100-VB199");
  EXPECT_EQ(reached("LD SM0.0\nMOVD &VB400, AC1\nITD VW300, AC0\n+D AC0, AC1\nMOVW VW2, *AC1\nLDW>= VW300, 10\n"
                    "MOVW 0, VW300\nMEND\n"),
            "5: VB0-VB8191")
      << "a master writes VW300";
}

TEST(ReachingValues, AJumpBackGoesOnToWhatEndsIt) {
  EXPECT_EQ(
      reached("LD SM0.0\nMOVD &VB100, AC1\nLBL 1\nLD SM0.0\nMOVB 0, *AC1\nINCD AC1\nLDD< AC1, 16#080000C8\nJMP 1\nMEND\n"),
      "5: VB100-VB199");
  EXPECT_EQ(reached("LD SM0.0\nMOVD &VB100, AC1\nLBL 1\nLD SM0.0\nMOVB 0, *AC1\nINCD AC1\nLD I0.0\nJMP 1\nMEND\n"),
            "5: VB100-VB8191");
}

TEST(ReachingValues, ASubroutineChangesWhatItWrites) {
  EXPECT_EQ(reached("LD SM0.0\nMOVD &VB100, AC1\nCALL 1\nMOVB 1, *AC1\nMEND\nSBR 1\nLD I0.0\nMOVD &VB300, AC2\nRET\n"),
            "4: VB100");
  EXPECT_EQ(reached("LD SM0.0\nMOVD &VB100, AC1\nCALL 1\nMOVB 1, *AC1\nMEND\nSBR 1\nLD I0.0\nMOVD &VB300, AC1\nRET\n"),
            "4: VB100, VB300");
  EXPECT_EQ(reached("LD SM0.0\nMOVD &VB100, AC1\nCALL 1\nMEND\nSBR 1\nLD SM0.0\nMOVB 1, *AC1\nRET\n"), "7: VB100")
      << "it shares the accumulators";
}

TEST(ReachingValues, InterruptsSaveAccumulatorsButNotMemory) {
  constexpr std::string_view kMain =
      "LD SM0.1\nATCH 0, 10\nENI\nLD SM0.0\nMOVD &VB100, {0}\nMOVB 1, *{0}\nMEND\nINT 0\nLD SM0.0\n"
      "MOVD &VB300, {0}\nMOVB 1, *{0}\nRETI\n";
  EXPECT_EQ(reached(fmt::format(fmt::runtime(kMain), "AC1")), "6: VB100; 11: VB300");
  EXPECT_EQ(reached(fmt::format(fmt::runtime(kMain), "VD0")), "6: VB100, VB300; 11: VB300");
}

TEST(ReachingValues, WritingThroughAPointerChangesOnlyWhatItReaches) {
  EXPECT_EQ(reached("LD SM0.1\nMOVD &VB1200, VD150\nLD I0.0\nBMB VB0, *VD150, 12\n+D 12, VD150\nMEND\n"), "4: VB1200-VB8191")
      << "and so not the pointer itself";
  EXPECT_EQ(reached("LD SM0.0\nMOVD &VB100, VD0\nMOVD &VB3, AC1\nMOVB 8, *AC1\nMOVB 1, *VD0\nMEND\n").substr(0, 20),
            "4: VB3; 5: IB0-IB15,")
      << "it does reach it";
}

TEST(ReachingValues, WhatStaysUnknownIsToldWithItsReason) {
  EXPECT_EQ(blamed("LD SM0.0\nMOVD &VB100, AC1\nITD VW0, AC0\n+D AC0, AC1\nMOVB 1, *AC1\nMEND\n"), "line 3");
  EXPECT_EQ(blamed("LD SM0.0\nMOVD VD0, AC1\nMOVB 1, *AC1\nMEND\n"), "line 2");
  EXPECT_EQ(blamed("LD SM0.0\nMOVB 1, *AC1\nMEND\n"), "not set");
  EXPECT_EQ(blamed("LD SM0.1\nMOVD &VB100, VD808\nATCH 0, 8\nENI\nMEND\nINT 0\nLD SM0.0\nMOVB SMB2, *VD808\nINCD VD808\n"
                   "RETI\n"),
            "line 9 counts")
      << "not line 8, which reaches the pointer because of that";
  EXPECT_EQ(blamed("LD SM0.1\nMOVD &VB0, AC1\nLD SM0.0\nINCD AC1\nMOVB 1, *AC1\nMEND\n"), "known") << "VB1 and up";
}

TEST(ReachingValues, WhatAccumulatorsKeepFromOtherRoutinesDoesNotGrow) {
  EXPECT_EQ(
      reached("LD SM0.0\nCALL 1\nCALL 2\nMEND\nSBR 1\nLD I0.0\nMOVD &VB100, AC1\nFOR VW0, 1, 8\nLD SM0.0\nMOVW 0, *AC1\n"
              "+D 2, AC1\nNEXT\nRET\nSBR 2\nLD I0.1\nMOVB 1, *AC1\nRET\n"),
      "10: VB100-VB114; 16: VB116");
}

/// Complains of a pointer that leads elsewhere than it may.
class PointerWatch final : public TraceSink {
 public:
  explicit PointerWatch(const Cpu& cpu) : cpu_(cpu), pointers_(cpu.program()) {}

  bool wants_instructions() const override { return true; }
  bool before(std::uint32_t op) override {
    const Op& now = cpu_.program().ops[op];
    for (const Operand& operand : now.operand)
      if (operand.pointer && cpu_.state().stack.top()) check(op, operand.at);
    return true;
  }

  int checked = 0;

 private:
  void check(std::uint32_t op, std::uint32_t at) {
    const std::uint32_t pointer = load32(&cpu_.state().image[at]), place = image::kV + (pointer & 0xFF'FFFF);
    if (pointer >> 24 != 8) return;
    ++checked;
    EXPECT_TRUE(std::ranges::any_of(pointers_.targets(op, at),
                                    [&](const PointerTarget& target) { return place >= target.from && place < target.to; }))
        << "line " << cpu_.program().statement(op).position.line << ": " << place_text({place, place + 1});
  }

  const Cpu& cpu_;
  Pointers pointers_;
};

TEST(ReachingValues, WhatPointersHoldInARunIsAmongThem) {
  for (const std::string_view text :
       {"LD SM0.1\nMOVD &VB100, VD0\nLD SM0.0\nMOVB IB1, *VD0\nINCD VD0\nLDD>= VD0, 16#080000C8\nMOVD &VB100, VD0\nMEND\n",
        "LD SM0.0\nMOVD &VB400, AC1\nITD VW300, AC0\n+D AC0, AC1\nMOVB 9, *AC1\nINCW VW300\nLDW>= VW300, 10\n"
        "MOVW 0, VW300\nMEND\n",
        "LD SM0.0\nMOVD &VB100, AC1\nFOR VW0, 1, 5\nLDW> VW0, 2\nCALL 1\nLD SM0.0\n+D 2, AC1\nNEXT\nMEND\n"
        "SBR 1\nLD SM0.0\nMOVB 1, *AC1\nINCD AC1\nRET\n",
        "LD SM0.1\nMOVD &VB10, VD0\nMOVB 5, SMB34\nATCH 0, 10\nENI\nLD SM0.0\nMOVD VD0, AC1\nMOVB 1, *AC1\nMEND\n"
        "INT 0\nLD SM0.0\nINCD VD0\nMOVD &VB50, AC1\nMOVB 2, *AC1\nRETI\n"}) {
    Plc plc(program_of(text, cpu()));
    PointerWatch watch(plc.cpu);
    plc.cpu.set_sink(&watch);
    plc.run_until(300 * ms);
    EXPECT_GT(watch.checked, 100) << text;
  }
}

TEST(ReachingValues, ALoopHasTheBoundOfWhatEndsIt) {
  const auto passes = [](std::string_view text) {
    const auto program = program_of(text, cpu());
    for (std::uint32_t op = 0; op < program->ops.size(); ++op)
      if (program->ops[op].instruction->mnemonic == "FOR") return Pointers(*program).passes(op);
    return std::optional<std::int64_t>();
  };
  EXPECT_EQ(passes("LD SM0.0\nBTI VB0, VW2\n-I 3, VW2\nFOR VW4, 1, VW2\nNEXT\nMEND\n"), 252);
  EXPECT_EQ(passes("LD SM0.0\nFOR VW4, 1, VW2\nNEXT\nMEND\n"), std::nullopt);
  EXPECT_EQ(passes("LDW<= VW2, 16\nFOR VW4, 1, VW2\nNEXT\nMEND\n"), 16);
}

/// The passes of the first of so many loops.
std::optional<std::int64_t> passes_beside(int loops) {
  std::string text;
  for (int i = 0; i < loops; ++i) text += fmt::format("LDW<= VW{}, 9\nFOR VW{}, 1, VW{}\nNEXT\n", 4 * i, 4 * i + 2, 4 * i);
  return Pointers(*program_of(text + "MEND\n", *find_cpu("226"))).passes(1);
}

TEST(ReachingValues, OfWhatTakesTooMuchMemoryNothingIsKnown) {
  EXPECT_EQ(passes_beside(20), 9);
  EXPECT_EQ(passes_beside(1000), std::nullopt);
}

}  // namespace
}  // namespace s7200::test::reaching_values_test
