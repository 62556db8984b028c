// Which bits programs read and write. That it is so for each instruction is tried with all its vectors (vectors_test.cpp).
#include "interpreter/analysis/effects/effects.hpp"

#include <set>

#include "interpreter/program/checking/checker.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/program/operands/operands.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::effects_test {
namespace {

const CpuModel& model() { return *find_cpu("224"); }

std::string place_text(std::uint64_t bit) {
  auto place = static_cast<std::uint32_t>(bit / 8);
  if (place >= image::kInputs && place < image::kOutputs) place -= image::kInputs - image::kI;  // the points themselves
  const AreaInfo& area = area_at(place);
  return fmt::format("{}{}.{}", area.name, place - area.base, bit % 8);
}

/// `VB0: V0.0+8 must; V1.0+8 may`: the accesses of an operand, or of all that is besides.
std::string accesses(const Program& program, std::uint32_t op, std::uint8_t operand) {
  std::vector<std::string> all;
  for (const MemoryAccess& access : effects_of(program, op, Pointers(program)))
    if (access.operand == operand)
      all.push_back(fmt::format("{} {}+{} {}",
                                access.role == Role::In    ? "reads"
                                : access.role == Role::Out ? "writes"
                                                           : "changes",
                                place_text(access.bits.first), access.bits.count,
                                access.certainty == Certainty::Must ? "must" : "may"));
  return fmt::format("{}", fmt::join(all, "; "));
}

/// Of the last op before MEND.
std::string accesses(std::string_view text, std::uint8_t operand) {
  const auto program = program_of(std::string(text) + "MEND\n", model());
  return accesses(*program, static_cast<std::uint32_t>(program->ops.size() - 2), operand);
}

TEST(Effects, AnOperandIsAsWideAsItsInstructionSays) {
  EXPECT_EQ(accesses("LD I0.3\n", 0), "reads I0.3+1 must");
  EXPECT_EQ(accesses("LD SM0.0\nMOVW VW10, AQW0\n", 0), "reads V10.0+16 must");
  EXPECT_EQ(accesses("LD SM0.0\n+D VD10, VD20\n", 1), "changes V20.0+32 must");
  EXPECT_EQ(accesses("LD SM0.0\nMOVB 5, VB0\n", 0), "") << "a constant";
}

TEST(Effects, ABlockGoesAsFarAsItsCountSays) {
  EXPECT_EQ(accesses("LD SM0.0\nBMB VB0, VB100, 4\n", 1), "writes V100.0+32 must");
  EXPECT_EQ(accesses("LD SM0.0\nBMB VB0, VB100, VB9\n", 1), "writes V100.0+2040 may");
  EXPECT_EQ(accesses("LD SM0.0\nS M31.6, VB9\n", 0), "writes M31.6+2 may") << "and no further than its area";
  EXPECT_EQ(accesses("LD SM0.0\nSCPY VB0, VB300\n", 1), "writes V300.0+8 must; writes V301.0+2032 may");
}

TEST(Effects, ResetClearsTheValuesOfTimersAndCountersToo) {
  EXPECT_NE(accesses("LD I0.0\nR T37, 2\n", kNoOperand).find("writes T74.0+32 must"), std::string::npos);
  EXPECT_EQ(accesses("LD I0.0\nS T37, 2\n", kNoOperand).find("writes T"), std::string::npos);
}

TEST(Effects, APointerThatIsSetOnceLeadsToOnePlace) {
  EXPECT_EQ(accesses("LD SM0.0\nMOVD &VB100, AC1\nMOVB 1, *AC1\n", 1), "reads AC4.0+32 must; writes V100.0+8 may");
  EXPECT_EQ(accesses("LD SM0.0\nMOVD &VB100, AC1\nMOVD AC1, VD4\nLD I0.0\nMOVD &MB2, VD4\nLD SM0.0\nMOVW 1, *VD4\n", 1),
            "reads V4.0+32 must; writes M2.0+16 may; writes V100.0+16 may")
      << "copied, or another one";
}

TEST(Effects, APointerThatIsCountedWithoutEndLeadsAnywhereInItsArea) {
  const std::string to_the_end = "reads AC4.0+32 must; changes M2.0+240 may", first = "LD SM0.1\nMOVD &MB2, AC1\nLD I0.0\n";
  EXPECT_EQ(accesses(first + "INCB *AC1\nINCD AC1\nINCB *AC1\n", 0), "reads AC4.0+32 must; changes M3.0+232 may");
  EXPECT_EQ(accesses(first + "+D +4, AC1\nLD SM0.0\nINCB *AC1\n", 0), to_the_end);
  EXPECT_EQ(accesses(first + "INCD AC1\nLD SM0.0\nINCD *AC1\n", 0), to_the_end) << "no double word begins at its end";
  EXPECT_EQ(accesses("LD SM0.0\nMOVD &MB2, VD0\nMOVW VW90, VW2\nINCB *VD0\n", 0), "reads V0.0+32 must; changes M0.0+256 may")
      << "its lower bytes are another's";
}

/// Whether anything is known of the pointer VD0.
bool is_known(std::string_view text) {
  const auto program = program_of("LD SM0.0\n" + std::string(text) + "MOVB *VD0, QB0\nMEND\n", model());
  return Pointers(*program).is_known(image::kV);
}

TEST(Effects, NothingIsKnownOfAPointerThatSomethingElseMayWrite) {
  EXPECT_TRUE(is_known("MOVD &VB100, VD0\n"));
  EXPECT_FALSE(is_known("")) << "someone else sets it";
  EXPECT_FALSE(is_known("MOVD &VB100, VD0\n+D VD8, VD0\n"));
  EXPECT_FALSE(is_known("MOVD &VB100, VD0\n+D 16#01000000, VD0\n")) << "another area";
  EXPECT_FALSE(is_known("MOVD &VB100, VD0\nMOVB VB9, VB0\n")) << "the byte with the area";
  EXPECT_FALSE(is_known("MOVD &VB100, VD0\nFILL 0, VW0, VB9\n"));
  EXPECT_FALSE(is_known("MOVD &VB100, VD0\nMOVB 1, *VD20\n")) << "through a pointer that may lead there";
  EXPECT_FALSE(is_known("MOVD &VB100, VD0\nLD SM0.1\nMOVD &VB9, AC2\nLD SM0.0\nDECD AC2\nMOVB 1, *AC2\n"))
      << "through one that is counted down to it";
  EXPECT_TRUE(is_known("MOVD &VB100, VD0\nMOVD &VB1, AC2\nINCD AC2\nMOVB 1, *AC2\n")) << "VB2 does not hold its area";
  EXPECT_TRUE(is_known("MOVD &VB100, VD0\nMOVD &VB4, AC2\nMOVB 1, *AC2\n")) << "through one that does not";
  EXPECT_FALSE(is_known("MOVD *VD8, VD0\n"));
}

TEST(Effects, APointerOfASubroutineIsWhatItsCallersGive) {
  const auto program = program_of(
      "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL Work, &VB100\nNETWORK 2\nLD SM0.0\nCALL Work, &VB200\n"
      "END_ORGANIZATION_BLOCK\nSUBROUTINE_BLOCK Work:SBR0\nVAR_INPUT\n at : DWORD;\nEND_VAR\nBEGIN\nNETWORK 1\nLD SM0.0\n"
      "INCB *#at\nEND_SUBROUTINE_BLOCK\n",
      model());
  std::string found;
  for (std::uint32_t op = 0; op < program->ops.size(); ++op)
    if (program->ops[op].instruction->mnemonic == "INCB") found = accesses(*program, op, 0);
  EXPECT_EQ(found, "reads L0.0+32 must; changes V100.0+8 may; changes V200.0+8 may");
}

TEST(Effects, WhatASubroutineHandsBackIsWrittenByItsCallAndByItsReturn) {
  const auto program = program_of(
      "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL Work, VW10\nEND_ORGANIZATION_BLOCK\n"
      "SUBROUTINE_BLOCK Work:SBR0\nVAR_OUTPUT\n y : INT;\nEND_VAR\nBEGIN\nNETWORK 1\nLD SM0.0\nMOVW 1, #y\n"
      "END_SUBROUTINE_BLOCK\n",
      model());
  int writers = 0;
  for (std::uint32_t op = 0; op < program->ops.size(); ++op)
    if (accesses(*program, op, kNoOperand).find("writes V10.0+16 may") != std::string::npos) ++writers;
  EXPECT_EQ(writers, 2);
}

TEST(Effects, ACounterHasItsOwnSpecialMemoryAndInputs) {
  EXPECT_EQ(accesses("LD SM0.1\nHDEF 1, 11\n", kNoOperand),
            "writes SM4.3+1 may; reads SM47.0+8 must; reads I0.6+1 must; reads I0.7+1 must; reads I1.0+1 must; reads I1.1+1 "
            "must");
  EXPECT_EQ(accesses("LD SM0.1\nHDEF 4, 0\nHSC 4\n", kNoOperand),
            "writes SM4.3+1 may; changes SM146.0+8 may; reads SM147.0+72 may; changes HC16.0+32 may; reads I0.3+1 must");
}

TEST(Effects, OfACounterThatDoesNotExistNothingIsKnown) {
  const auto decoded = decode_program(read_text("LD SM0.1\nHDEF 9, 40\nHDEF 3, 11\nHSC 3\nPLS 7\nMEND\n", "x"), model(),
                                      default_times(model()));
  const Program& program = *decoded.known;
  EXPECT_EQ(accesses(program, 1, kNoOperand), "writes SM4.3+1 may");
  EXPECT_EQ(accesses(program, 3, kNoOperand),
            "writes SM4.3+1 may; changes SM136.0+8 may; reads SM137.0+72 may; changes HC12.0+32 may")
      << "none of the inputs of a mode that it does not have";
  EXPECT_EQ(accesses(program, 4, kNoOperand), "writes SM4.3+1 may");
}

TEST(Effects, APulseOutputChangesWhatCountsItsPulses) {
  const CpuModel& counting = *find_cpu("224");
  const auto program = program_of("LD SM0.1\nHDEF 3, 12\nPLS 0\nPLS 1\nMEND\n", counting);
  const std::string first = accesses(*program, 2, kNoOperand), second = accesses(*program, 3, kNoOperand);
  EXPECT_EQ(first.find("HC"), std::string::npos) << first;
  EXPECT_NE(second.find("changes HC12.0+32 may"), std::string::npos) << second;
}

TEST(Effects, AtAMomentAProfileIsWhereItsWordSays) {
  const auto program = program_of("LD SM0.1\nPLS 0\nMEND\n", model());
  std::array<std::uint8_t, image::kSize> memory{};
  const auto table = [&] {
    std::vector<Bits> all;
    for (const MemoryAccess& access : effects_now(*program, 1, memory))
      if (access.bits.first >= image::kV * 8u) all.push_back(access.bits);
    return all;
  };
  memory[sm::byte(67)] = 0x80;
  store16(&memory[sm::byte(168)], 40);
  memory[image::kV + 40] = 2;
  EXPECT_TRUE(table().empty());
  memory[sm::byte(67)] = 0xA0;
  EXPECT_EQ(table(), (std::vector<Bits>{{(image::kV + 40) * 8u, 17 * 8}}));
}

TEST(Effects, AtAMomentCountsAndPointersAreKnown) {
  const auto program = program_of("LD SM0.0\nBMB *VD0, VB100, VB9\nMEND\n", model());
  std::array<std::uint8_t, image::kSize> memory{};
  memory[image::kV + 9] = 3;
  const auto pointer = *pointer_to(model(), Area::M, Width::Byte, 2);
  store32(&memory[image::kV], pointer);
  std::vector<Bits> surely;
  for (const MemoryAccess& access : effects_now(*program, 1, memory))
    if (access.certainty == Certainty::Must && access.operand != 2) surely.push_back(access.bits);
  const std::vector<Bits> wanted{{image::kV * 8u, 32}, {(image::kM + 2) * 8u, 24}, {(image::kV + 100) * 8u, 24}};
  EXPECT_EQ(surely, wanted);
}

/// Complains of whatever an instruction changes beside its effects.
class ChangeWatch final : public TraceSink {
 public:
  explicit ChangeWatch(const Cpu& cpu) : cpu_(cpu) {
    for (std::uint32_t op = 0; op < program().ops.size(); ++op) {
      Image written{};
      for (const MemoryAccess& access : effects_of(program(), op, Pointers(program())))
        for (std::uint64_t bit = access.bits.first; access.writes() && bit < access.bits.end(); ++bit)
          written[bit / 8] = static_cast<std::uint8_t>(written[bit / 8] | 1 << bit % 8);
      written_.push_back(written);
    }
  }

  bool wants_instructions() const override { return true; }
  bool before(std::uint32_t) override {
    before_ = cpu_.state().image;
    return true;
  }
  void instruction(const InstructionRecord& record) override {
    executed.insert(std::string(program().ops[record.op].instruction->mnemonic));
    for (std::uint32_t at = 0; at < image::kConstants; ++at)
      EXPECT_EQ((before_[at] ^ cpu_.state().image[at]) & ~written_[record.op][at], 0)
          << program().ops[record.op].instruction->mnemonic << " in line " << program().statement(record.op).position.line
          << " changes " << byte_text(at);
  }

  std::set<std::string> executed;

 private:
  using Image = std::array<std::uint8_t, image::kSize>;

  const Program& program() const { return cpu_.program(); }

  const Cpu& cpu_;
  std::vector<Image> written_;  // by op
  Image before_{};
};

TEST(Effects, WhatControlInstructionsChangeIsAmongThem) {
  Plc plc(program_of(
      "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.1\nMOVB 5, SMB34\nATCH 1, 10\nENI\nHDEF 0, 0\nS S0.0, 1\n"
      "NETWORK 2\nLD SM0.0\nCALL Work, VW100, VW102\nNETWORK 3\nLD SM0.0\nFOR VW10, 1, 3\nNETWORK 4\nLD SM0.0\nINCW VW12\n"
      "NETWORK 5\nNEXT\nNETWORK 6\nLSCR S0.0\nNETWORK 7\nLD SM0.0\nSCRT S0.1\nNETWORK 8\nLD I0.1\nCSCRE\nNETWORK 9\nSCRE\n"
      "NETWORK 10\nLSCR S0.1\nNETWORK 11\nLD SM0.0\nCSCRE\nNETWORK 12\nSCRE\nNETWORK 13\nLD SM0.0\nJMP 1\n"
      "NETWORK 14\nLD I0.0\n= Q0.0\nNETWORK 15\nLBL 1\nNETWORK 16\nLD M9.0\nDTCH 10\nDISI\nEND\nEND_ORGANIZATION_BLOCK\n"
      "SUBROUTINE_BLOCK Work:SBR0\nVAR_INPUT\n x : INT;\nEND_VAR\nVAR_OUTPUT\n y : INT;\nEND_VAR\nBEGIN\nNETWORK 1\n"
      "LD SM0.0\nMOVW #x, #y\nINCW #y\nNETWORK 2\nLD SM0.0\nCRET\nEND_SUBROUTINE_BLOCK\n"
      "INTERRUPT_BLOCK Tick:INT1\nBEGIN\nNETWORK 1\nLD SM0.0\nINCW AC1\nINCW VW20\nMOVW VW20, VW100\nNETWORK 2\nLD "
      "M9.1\nCRETI\n"
      "END_INTERRUPT_BLOCK\n",
      model()));
  ChangeWatch watch(plc.cpu);
  plc.cpu.set_sink(&watch);
  plc.run_until(40 * ms);
  for (const char* mnemonic :
       {"ATCH", "ENI", "HDEF", "CALL", "FOR", "NEXT", "LSCR", "SCRT", "CSCRE", "SCRE", "JMP", "CRET", "RETI", "MEND"})
    EXPECT_TRUE(watch.executed.contains(mnemonic)) << mnemonic;
}

}  // namespace
}  // namespace s7200::test::effects_test
