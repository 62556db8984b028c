// The fast loop does what the plain one does, however it is cut into pieces.
#include <pthread.h>

#include <random>

#include "interpreter/program/checking/chains.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::fast_loop_test {
namespace {

/// Makes the CPU execute op by op.
class Observer final : public TraceSink {
 public:
  bool wants_instructions() const override { return true; }
};

/// A first scan of 300 ms, to 10 us: MEND is the last instruction in it.
std::string long_scan(Time rest) {
  std::string program = "LD SM0.1\nATCH 0, 0\nENI\nLD SM0.0\nDIV VW100, VD104\nDIV VW100, VD104\n";
  for (int i = 0; i < 19; ++i) program += "SQRT VD0, VD4\n";
  for (Time spent = 0; spent + 10 * us <= rest; spent += 10 * us) program += "NOP 0\n";
  return program + "MEND\nINT 0\nRETI\n";
}

// The watchdog expires while an interrupt routine is entered: the error names the instruction before.
TEST(FastLoop, AFatalErrorAfterMendNamesItAsThePlainLoopDoes) {
  Plc measured(long_scan(0));
  measured.set("VW100", 1);
  measured.run_scans(1);
  const std::string program = long_scan(300 * ms - measured.cpu.time());
  std::vector<std::uint32_t> named;
  for (const bool observed : {false, true}) {
    Observer observer;
    Plc plc(program);
    if (observed) plc.cpu.set_sink(&observer);
    plc.set("VW100", 1);
    plc.input_at(300 * ms - 10 * us, "I0.0", true);
    plc.run_until(302 * ms);
    ASSERT_EQ(plc.cpu.state().fatal_code, 3);
    named.push_back(plc.cpu.state().fatal_op);
  }
  const auto mend = static_cast<std::uint32_t>(program_of(program)->ops.size() - 3);
  EXPECT_EQ(named, (std::vector{mend, mend}));
}

/// Networks of contacts, coils and boxes, drawn by lot: chains of every length and way to join.
std::string networks(std::mt19937& draw, int count) {
  const auto below = [&](unsigned n) { return static_cast<unsigned>(draw() % n); };
  const auto bit = [&] { return fmt::format("{}{}.{}", below(2) ? "M" : "V", below(8), below(8)); };
  static constexpr std::string_view kContacts[] = {"LD", "LDN", "A", "AN", "O", "ON"};
  static constexpr std::string_view kStack[] = {"NOT", "ALD", "OLD", "LPS", "LRD", "LPP", "EU", "ED"};
  std::string text;
  int depth = 0;
  const auto line = [&](const std::string& what) { text += what + "\n"; };
  for (int i = 0; i < count; ++i) {
    line(fmt::format("{} {}", kContacts[below(2)], bit()));
    for (depth = 1; below(8) != 0;) {
      const std::string_view contact = kContacts[below(6)], on_stack = kStack[below(8)];
      if (below(4) != 0) {
        if (contact.starts_with("LD") && depth == 4) continue;
        depth += contact.starts_with("LD");
        line(fmt::format("{} {}", contact, bit()));
      } else if (on_stack == "ALD" || on_stack == "OLD" || on_stack == "LRD" || on_stack == "LPP") {
        if (depth < 2) continue;
        depth -= on_stack != "LRD";
        line(std::string(on_stack));
      } else if (on_stack != "LPS" || depth < 4) {
        depth += on_stack == "LPS";
        line(std::string(on_stack));
      }
    }
    for (unsigned coils = below(4); coils > 0; --coils) line(fmt::format("= {}", bit()));
    switch (below(7)) {
      case 0:
        line("INCW VW2");
        break;
      case 1:
        line("MOVB MB1, VB3");
        break;
      case 2:
        line(fmt::format("S {}, 3", bit()));
        break;
      case 3:
        line("AW>= VW2, 100\nXORW VW2, VW4");
        break;
      case 4:
        line("TON T32, 3\nA T32\n= M7.7");
        break;
      case 5:
        line(fmt::format("LBL {}", i));  // takes no time
        break;
      default:
        break;
    }
  }
  return text + "MEND\n";
}

TEST(FastLoop, LeavesWhatThePlainLoopLeavesAtEveryDeadline) {
  std::mt19937 draw(7200);
  for (unsigned round = 0; round < 40; ++round) {
    const std::string text = networks(draw, 12);
    Plc fast(text), plain(text);
    Observer observer;
    plain.cpu.set_sink(&observer);
    fast.cpu.set_sink(nullptr);
    for (Plc* plc : {&fast, &plain})
      for (std::uint32_t byte = 0; byte < 8; ++byte) plc->set(fmt::format("MB{}", byte), 37 * byte + 11 * round);
    for (int piece = 0; piece < 300; ++piece) {
      const Time end = plain.cpu.time() + 1 + static_cast<Time>(draw() % (60 * us));
      plain.run_until(end);
      fast.run_until(piece % 2 == 0 ? end : plain.cpu.time());  // or when its instruction ends
      ASSERT_EQ(fast.cpu.state(), plain.cpu.state()) << "at " << plain.cpu.time() << " ns of\n" << text;
    }
  }
}

TEST(FastLoop, ChainsEndAtFourContactsAndTwoCoils) {
  const auto program =
      program_of("LD M0.0\nA M0.1\nO M0.2\nAN M0.3\nON M0.4\n= M1.0\n= M1.1\n= M1.2\nLDI I0.0\n=I Q0.0\nMEND\n");
  if (!link_of_any()) GTEST_SKIP() << "a build without tail calls";
  const auto lengths = [&] {
    std::vector<std::int32_t> of_each;
    for (const Op& op : program->ops) of_each.push_back(op.chain_cost / static_cast<std::int32_t>(10 * us));
    return of_each;
  };
  EXPECT_EQ(lengths(), (std::vector<std::int32_t>{1, 6, 5, 4, 3, 2, 2, 1, 1, 0, 0}));
}

// A coil of special memory, a contact in a segment, a pointer: each has a step around its body.
TEST(FastLoop, WhatNeedsAStepAroundItsBodyIsInNoChain) {
  const auto program =
      program_of("LD M0.0\n= SM34.0\nLSCR S0.0\nLD M0.1\n= M0.2\nSCRE\nMOVB *VD0, VB8\nMEND\n", *find_cpu("224"));
  for (const Op& op : program->ops)
    if (op.body != op.instruction->body.usual) {
      EXPECT_EQ(op.link, link_of_step(op.body)) << op.instruction->mnemonic;
    }
}

TEST(FastLoop, ABoxWithoutPowerFlowLeavesNoEno) {
  Plc plc("LD SM0.0\n+I VW0, VW2\nLD M0.0\n+I VW0, VW2\nLD SM0.0\nAENO\n= M1.0\nMEND\n", *find_cpu("224"));
  plc.cpu.set_sink(nullptr);
  plc.set("MB1", 1);
  plc.run_until(20 * ms);
  EXPECT_EQ(plc.value("MB1"), 0);
}

/// What a thread with little stack is given to do.
void* run_a_million(void* plc) {
  static_cast<Plc*>(plc)->run_until(12 * kSecond);
  return nullptr;
}

TEST(FastLoop, NeedsNoMoreStackForMoreInstructions) {
  std::string text = "LD SM0.0\n";
  for (int i = 0; i < 400; ++i) text += "MOVW VW0, VW2\nINCW VW4\nA SM0.0\n= M0.0\nWDR\n";
  Plc plc(text + "MEND\n");
  pthread_attr_t small;
  pthread_attr_init(&small);
  ASSERT_EQ(pthread_attr_setstacksize(&small, 256 * 1024), 0);
  pthread_t thread{};
  ASSERT_EQ(pthread_create(&thread, &small, run_a_million, &plc), 0);
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&small);
  EXPECT_GT(plc.cpu.state().instructions, 1'000'000u);
}

}  // namespace
}  // namespace s7200::test::fast_loop_test
