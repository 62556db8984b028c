// What was tried of a program: contacts in every form, and which of them decided alone.
#include "tools/coverage/coverage.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "interpreter/base/split_mix.hpp"
#include "tests/support/plc.hpp"
#include "tools/coverage/coverage_files.hpp"
#include "tools/coverage/programs.hpp"

namespace s7200::tools::coverage_test {
namespace {

/// A program on a CPU whose coverage is watched.
class Watched {
 public:
  explicit Watched(std::string_view stl, const CpuModel& model = cpu214())
      : program(test::program_of(stl, model)), map(std::make_shared<CoverageMap>(program)), sink(map), plc(program) {
    sink.begin(plc.cpu);
    plc.cpu.set_sink(&sink);
  }

  bool was(std::uint32_t op, Tried::Mark mark) const { return sink.tried().was(op, mark); }
  std::vector<bool> deciding() const { return sink.tried().deciding(*map); }
  CoverageFigures figures() const { return figures_of(*map, sink.tried()); }
  /// A scan with the inputs as the bits of `inputs` say, from I0.0 on.
  void scan(std::uint8_t inputs) {
    plc.cpu.set_input(0, inputs, plc.cpu.time());
    plc.run_scans(plc.cpu.state().scans + 1);
  }

  std::shared_ptr<const Program> program;
  std::shared_ptr<const CoverageMap> map;
  CoverageSink sink;
  test::Plc plc;
};

/// `LDW>=` of AW>= and OW>=.
std::string load_form(const ContactForm& form, std::string_view mnemonic) {
  return form.join == Join::Load ? std::string(mnemonic) : "LD" + std::string(mnemonic.substr(1));
}

std::string operands_of(const ContactForm& form, std::string_view mnemonic) {
  if (form.kind == ContactForm::Kind::Bit) return mnemonic.ends_with('I') ? "I0.0" : "V0.0";
  if (form.kind == ContactForm::Kind::Strings) return "VB100, VB120";
  static constexpr std::string_view kLetters = "BWDD";
  const char letter = kLetters[static_cast<std::size_t>(form.type)];
  return fmt::format("V{0}10, V{0}20", letter);
}

/// Sets what the contacts of operands_of() look at.
void set_operands(test::Plc& plc, std::uint64_t& seed) {
  const bool same = draw_split_mix(seed) % 3 == 0;
  const auto draw = [&] { return static_cast<std::uint32_t>(draw_split_mix(seed)); };
  const std::uint32_t first =
      draw() % 2 ? std::bit_cast<std::uint32_t>(static_cast<float>(static_cast<int>(draw()))) : draw();
  const bool is_number = std::isfinite(std::bit_cast<float>(first));
  plc.set("VD10", is_number ? first : 0);
  plc.set("VD20", same ? static_cast<std::uint32_t>(plc.value("VD10")) : draw() & 0x7F7F'FFFF & 0x3FFF'FFFF);
  plc.set("VB0", draw() & 1);
  plc.set("VB100", 2), plc.set("VW101", 0x4142);
  plc.set("VB120", draw() % 2 ? 2 : 1), plc.set("VW121", draw() % 2 ? 0x4142 : 0x4143);
}

TEST(Coverage, EveryFormOfContactIsSeenAsTheCpuSeesIt) {
  std::uint64_t seed = 34;
  std::size_t forms = 0;
  for (const Instruction& instruction : all_instructions()) {
    if (!instruction.modelled()) continue;
    Op op;
    op.instruction = &instruction;
    const ContactForm form = contact_form(*op.instruction);
    if (form.kind != ContactForm::Kind::Bit && form.kind != ContactForm::Kind::Numbers &&
        form.kind != ContactForm::Kind::Strings)
      continue;
    ++forms;
    const std::string name(instruction.mnemonic), operands = operands_of(form, name);
    const std::string before = form.join == Join::Load ? "" : form.join == Join::And ? "LDN SM0.0\n" : "LD SM0.0\n";
    const std::string text =
        fmt::format("{} {}\n= M0.0\n{}{} {}\n= M0.1\nMEND\n", load_form(form, name), operands, before, name, operands);
    const std::uint32_t contact = form.join == Join::Load ? 2 : 3;
    for (int round = 0; round < 6; ++round) {
      Watched watched(text, cpu226());
      set_operands(watched.plc, seed);
      watched.scan(static_cast<std::uint8_t>(round & 1));
      const bool closed = watched.plc.value("M0.0") == 1;
      EXPECT_EQ(watched.was(contact, Tried::kClosed), closed) << text;
      EXPECT_EQ(watched.was(contact, Tried::kOpen), !closed) << text;
    }
  }
  EXPECT_GT(forms, 60U);
}

TEST(Coverage, NotAndEdgesAreClosedWhenPowerLeavesThem) {
  Watched watched("LD I0.0\nEU\n= M0.0\nLD I0.0\nED\n= M0.1\nLD I0.0\nNOT\n= M0.2\nMEND\n");
  watched.scan(0);
  for (const std::uint32_t op : {1U, 4U}) EXPECT_FALSE(watched.was(op, Tried::kClosed));
  EXPECT_TRUE(watched.was(7, Tried::kClosed));
  watched.scan(1);
  EXPECT_TRUE(watched.was(1, Tried::kClosed));
  EXPECT_FALSE(watched.was(4, Tried::kClosed));
  EXPECT_TRUE(watched.was(7, Tried::kOpen));
  watched.scan(0);
  EXPECT_TRUE(watched.was(4, Tried::kClosed));
}

TEST(Coverage, InASegmentThatIsOffNothingIsTriedOfAContact) {
  Watched watched("LSCR S0.0\nLD I0.0\nA I0.1\n= M0.0\nLDW<= VW2, 5\nEU\n= M0.1\nSCRE\nMEND\n");
  watched.scan(1);
  for (const std::uint32_t contact : {1U, 2U, 4U, 5U})
    EXPECT_FALSE(watched.was(contact, Tried::kOpen) || watched.was(contact, Tried::kClosed)) << contact;
  watched.plc.set("S0.0", 1);
  watched.scan(2);
  EXPECT_TRUE(watched.was(1, Tried::kOpen));
  EXPECT_TRUE(watched.was(2, Tried::kClosed));
  EXPECT_TRUE(watched.was(4, Tried::kClosed));
  EXPECT_FALSE(watched.was(4, Tried::kOpen));
  EXPECT_TRUE(watched.was(5, Tried::kClosed)) << "an edge, since the step went on";
}

TEST(Coverage, ABoxWithoutPowerFlowIsNotExecuted) {
  Watched watched("LD I0.0\nMOVB 1, VB0\nMOVB 2, VB1\nMEND\n");
  watched.scan(0);
  EXPECT_FALSE(watched.was(1, Tried::kExecuted));
  EXPECT_TRUE(watched.was(1, Tried::kSkipped));
  EXPECT_EQ(watched.figures().instructions, (Share{2, 4}));
  watched.scan(1);
  EXPECT_TRUE(watched.figures().instructions.complete());
}

TEST(Coverage, AContactDecidesAloneOnlyWhereTheOthersLetIt) {
  Watched watched("LD I0.0\nA I0.1\nO I0.2\n= Q0.0\nMEND\n");
  const auto decided = [&] {
    const auto all = watched.deciding();
    return fmt::format("{:d}{:d}{:d}", bool(all[0]), bool(all[1]), bool(all[2]));
  };
  watched.scan(0b001), watched.scan(0b100);
  EXPECT_EQ(decided(), "001") << "I0.2 was off with nothing beside it, and on with nothing beside it";
  watched.scan(0b011);
  EXPECT_EQ(decided(), "011") << "I0.1 was off and on with I0.0";
  watched.scan(0b110);
  EXPECT_EQ(decided(), "011") << "I0.2 hides I0.0";
  watched.scan(0b010);
  EXPECT_EQ(decided(), "111");
}

TEST(Coverage, BranchesBlocksAndNotAreFollowed) {
  Watched watched(
      "LD I0.0\nLPS\nLD I0.1\nO I0.2\nALD\n= Q0.0\nLRD\nAN I0.3\nS Q0.1, 1\nLPP\nA I0.4\nNOT\nMOVB 1, VB0\nMEND\n");
  for (unsigned inputs = 0; inputs < 32; ++inputs) watched.scan(static_cast<std::uint8_t>(inputs));
  EXPECT_TRUE(watched.figures().deciding.complete());
  EXPECT_EQ(watched.figures().deciding.all, 5U);
  EXPECT_TRUE(watched.figures().contacts.complete());
}

TEST(Coverage, AContactBeforeAnEdgeDecidesThePulse) {
  Watched watched("LD I0.0\nA I0.1\nEU\n= Q0.0\nMEND\n");
  watched.scan(0), watched.scan(1), watched.scan(1);
  EXPECT_FALSE(watched.deciding()[1]);
  watched.scan(0b11);
  EXPECT_TRUE(watched.deciding()[1]) << "without it no pulse came, with it one did";
  watched.scan(0b11), watched.scan(0b11);
  EXPECT_FALSE(watched.deciding()[0]);
  watched.scan(0b10), watched.scan(0b10);
  EXPECT_TRUE(watched.deciding()[0]) << "open, and no edge was remembered";
}

TEST(Coverage, ConstantContactsAreNotCounted) {
  Watched watched("LD SM0.0\nNOT\n= M0.0\nLDW= 3, 4\n= M0.1\nLD I0.0\n= M0.2\nMEND\n");
  watched.scan(0), watched.scan(1);
  EXPECT_EQ(watched.figures().contacts, (Share{1, 1}));
  EXPECT_EQ(watched.map->why_constant(0), "SM0.0 is always 1");
  EXPECT_EQ(watched.map->why_constant(1), "what reaches it never changes");
  EXPECT_EQ(watched.map->why_constant(3), "it compares two constants");
}

TEST(Coverage, AnOutputThatDependsOnWhatWasBeforeALabelIsLeftOut) {
  Watched watched("LD I0.0\n= Q0.0\nLBL 1\nA I0.1\n= Q0.1\nMEND\n");
  for (unsigned inputs = 0; inputs < 4; ++inputs) watched.scan(static_cast<std::uint8_t>(inputs));
  EXPECT_EQ(watched.figures().deciding, (Share{1, 1}));
  EXPECT_EQ(watched.figures().contacts, (Share{2, 2}));
}

TEST(Coverage, ARoutineThatAnInterruptCallsInBetweenIsNotMixedUp) {
  std::string wait;  // until the interrupt comes
  for (int i = 0; i < 1500; ++i) wait += "NOP 0\n";
  const std::string text =
      "LD SM0.1\nMOVB 20, SMB34\nATCH 0, 10\nENI\nLD SM0.0\nCALL 0\nMEND\n"
      "SBR 0\nLD V0.0\n" +
      wait +
      "A V0.1\n= V1.0\nRET\n"
      "INT 0\nLD SM0.0\nINCW VW2\nMOVB 1, VB0\nCALL 0\nMOVB 2, VB0\nRETI\n";
  Watched watched(text, cpu226());
  watched.plc.set("VB0", 2);
  watched.plc.run_until(300 * kMillisecond);
  EXPECT_GT(watched.plc.value("VW2"), 3) << "the interrupt comes while V0.0 has been looked at and V0.1 has not";
  const Tried& tried = watched.sink.tried();
  const auto decision =
      std::ranges::find_if(watched.map->decisions(), [](const Decision& d) { return d.contacts.size() == 2; });
  ASSERT_NE(decision, watched.map->decisions().end());
  const auto& alone = tried.alone[static_cast<std::size_t>(decision - watched.map->decisions().begin())];
  EXPECT_FALSE(alone[0] & kClosedOn) << "V0.0 and V0.1 were never on together";
}

/// What find_deciding() says, worked out by changing one contact after the other.
std::vector<std::uint8_t> deciding_one_by_one(const Decision& decision, const SeenContacts& seen) {
  const auto value = [&](std::size_t changed) -> bool {
    std::vector<bool> on;
    for (const Decision::Gate& gate : decision.gates) {
      using Kind = Decision::Gate::Kind;
      switch (gate.kind) {
        case Kind::True:
          on.push_back(true);
          break;
        case Kind::Contact:
          on.push_back(seen.closed[gate.a] != (gate.a == changed));
          break;
        case Kind::Not:
          on.push_back(!on[gate.a]);
          break;
        case Kind::And:
          on.push_back(on[gate.a] && on[gate.b]);
          break;
        case Kind::Or:
          on.push_back(on[gate.a] || on[gate.b]);
          break;
        case Kind::Rising:
          on.push_back((!seen.before[gate.b] && on[gate.a]) != (gate.b == changed));
          break;
        case Kind::Falling:
          on.push_back((seen.before[gate.b] && !on[gate.a]) != (gate.b == changed));
          break;
      }
    }
    return on.back();
  };
  const bool as_it_was = value(decision.contacts.size());
  std::vector<std::uint8_t> alone(decision.contacts.size());
  for (std::size_t i = 0; i < alone.size(); ++i)
    if (value(i) != as_it_was)
      alone[i] = static_cast<std::uint8_t>(seen.closed[i] ? (as_it_was ? kClosedOn : kClosedOff)
                                                          : (as_it_was ? kOpenOn : kOpenOff));
  return alone;
}

TEST(Coverage, ManyWorldsAtOnceSayWhatOneAfterTheOtherDoes) {
  std::uint64_t seed = 7200;
  const auto draw = [&](std::size_t below) { return static_cast<std::uint32_t>(draw_split_mix(seed) % below); };
  for (int round = 0; round < 300; ++round) {
    std::string text;
    const std::uint32_t contacts = 1 + draw(round % 10 == 0 ? 150 : 12);
    for (std::uint32_t i = 0; i < contacts; ++i) {
      static constexpr const char* kJoins[] = {"A", "O", "AN", "ON"};
      text += fmt::format("{} M{}.{}\n", i == 0 ? "LD" : kJoins[draw(4)], draw(8), draw(8));
      if (draw(6) == 0) text += "NOT\n";
      if (draw(8) == 0) text += draw(2) ? "EU\n" : "ED\n";
    }
    const auto program = test::program_of(text + "= Q0.0\nMEND\n");
    const CoverageMap map(program);
    ASSERT_EQ(map.decisions().size(), 1U) << text;
    const Decision& decision = map.decisions().front();
    SeenContacts seen{std::vector<bool>(decision.contacts.size()), std::vector<bool>(decision.contacts.size())};
    for (std::size_t i = 0; i < seen.closed.size(); ++i) seen.closed[i] = draw(2), seen.before[i] = draw(2);
    std::vector<std::uint8_t> alone(decision.contacts.size());
    find_deciding(decision, seen, alone);
    EXPECT_EQ(alone, deciding_one_by_one(decision, seen)) << text;
  }
}

TEST(Coverage, WatchingChangesNothing) {
  const std::string_view text =
      "LD I0.0\nEU\n= Q0.0\nLD SM0.0\nINCW VW0\nTON T33, 10\nLDW>= VW0, 5\nMOVW 0, VW0\nLD T33\nS M0.0, 1\nMEND\n";
  Watched watched(text, cpu226());
  test::Plc alone(watched.program);
  alone.cpu.set_sink(nullptr);
  for (test::Plc* plc : {&watched.plc, &alone}) {
    plc->input_at(3 * kMillisecond, "I0.0", true);
    plc->run_until(2 * kSecond);
  }
  EXPECT_EQ(watched.plc.cpu.state(), alone.cpu.state());
}

TEST(Coverage, WhatWasNotTriedIsListedWithItsLine) {
  Watched watched("LD I0.0\nCALL 0\nMEND\nSBR 0\nLD I0.1\nO I0.2\nMOVB 1, VB0\nRET\nSBR 1\nLD SM0.0\nRET\n");
  watched.scan(0), watched.scan(1);
  const std::string text = coverage_text({watched.map, watched.sink.tried()});
  for (const char* const each :
       {"instructions    66.6%  6 of 9", "never closed", "never had power flow", "never executed, nor the one after"})
    EXPECT_NE(text.find(each), std::string::npos) << each << " in\n" << text;
}

TEST(Coverage, LcovHasLinesRoutinesAndBothWaysOfContacts) {
  Watched watched("LD I0.0\n= Q0.0\nMEND\n");
  watched.scan(1);
  CoverageOfPrograms all;
  all.add(watched.map, watched.sink.tried());
  const std::string text = coverage_lcov(all);
  for (const char* const each : {"FN:1,MAIN\n", "FNDA:1,MAIN\n", "DA:1,1\n", "BRDA:1,0,0,1\nBRDA:1,0,1,0\n",
                                 "BRF:2\nBRH:1\n", "LF:3\nLH:3\nend_of_record\n"})
    EXPECT_NE(text.find(each), std::string::npos) << each << " in\n" << text;
  EXPECT_NE(coverage_page(all).find("<span class=\"part\">    1  LD I0.0   <i>&larr; never open</i></span>"),
            std::string::npos)
      << coverage_page(all);
}

TEST(Coverage, SeveralRunsAreMergedByProgram) {
  Watched one("LD I0.0\n= Q0.0\nMEND\n"), other("LD I0.0\n= Q0.0\nMEND\n");
  one.scan(0), other.scan(1);
  CoverageOfPrograms all;
  all.add(one.map, one.sink.tried());
  EXPECT_EQ(all.least(), 0);
  all.add(other.map, other.sink.tried());
  ASSERT_EQ(all.programs().size(), 1U);
  EXPECT_EQ(all.least(), 100);
}

TEST(Coverage, PlacesAreNamedWithoutFollowingPointersAndWithoutAnInterruption) {
  const Inspection places = for_places(test::program_of("LD SM0.0\nMOVD &VB10, VD0\nMOVW *VD0, VW20\nMEND\n"));
  EXPECT_FALSE(places.was_interrupted());
  EXPECT_FALSE(places.facts.pointers.is_known(image::kV));
  EXPECT_TRUE(Inspection(places.program).facts.pointers.is_known(image::kV));
}

}  // namespace
}  // namespace s7200::tools::coverage_test
