// THE table: all that is true of each instruction, once. See model/instruction.hpp for the columns, operand_rules.hpp for
// the operands, and README.md for how to add an instruction.
//
// Sources: facts 6, 3.5 (what may stand in interrupt routines), 6.13 (which CPU has what).
#include <algorithm>
#include <array>
#include <numeric>

#include "interpreter/instructions/bit_logic.hpp"
#include "interpreter/instructions/compare.hpp"
#include "interpreter/instructions/control.hpp"
#include "interpreter/instructions/conversion.hpp"
#include "interpreter/instructions/linked.hpp"
#include "interpreter/instructions/math.hpp"
#include "interpreter/instructions/move.hpp"
#include "interpreter/instructions/operand_rules.hpp"
#include "interpreter/instructions/peripherals.hpp"
#include "interpreter/instructions/pid.hpp"
#include "interpreter/instructions/real_math.hpp"
#include "interpreter/instructions/shift.hpp"
#include "interpreter/instructions/strings.hpp"
#include "interpreter/instructions/tables.hpp"
#include "interpreter/instructions/timer_counter.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/model/memory_alone.hpp"

namespace s7200 {
namespace {

using namespace bodies;
using namespace operands;
using enum Join;
using enum Relation;

constexpr Allowed kNotInInterrupt(kMain | kSubroutine);
constexpr Allowed kInterrupt22x(kMain | kSubroutine, kCpu22x);
constexpr Allowed kInterruptR2(kMain | kSubroutine, kCpu22xRelease2);

struct Group {
  std::string_view heading;
  std::span<const Instruction> rows;
  bool memory_alone = false;  ///< its instructions work on memory alone, except those of works_on_more()
};

// clang-format off

// A box is skipped without power flow, and so are the coils that are kPowered; everything else runs on every pass.
constexpr Rung kBox        {.needs_power_flow = true, .stack = {.needs = 1, .change =  0}, .writes_output = true, .eno = Eno::ErrorsAndFlags};
constexpr Rung kShiftBox   {.needs_power_flow = true, .stack = {.needs = 1, .change =  0}, .writes_output = true, .eno = Eno::Errors};
constexpr Rung kLoop       {                          .stack = {.needs = 1, .change =  0}, .writes_output = true, .eno = Eno::ErrorsAndFlags};  // PID
constexpr Rung kPowered    {.needs_power_flow = true, .stack = {.needs = 1, .change =  0}, .writes_output = true};  // S, JMP, END
constexpr Rung kCoil       {                          .stack = {.needs = 1, .change =  0}, .writes_output = true};  // =, TON
constexpr Rung kTwoInputs  {                          .stack = {.needs = 2, .change = -1}, .writes_output = true};  // CTU
constexpr Rung kThreeInputs{                          .stack = {.needs = 3, .change = -2}, .writes_output = true};  // CTUD
constexpr Rung kSegmentHead{                          .stack = {.needs = 0, .change =  1}, .writes_output = true};  // LSCR
constexpr Rung kMark       {                                                               .writes_output = true};  // LBL, RET
constexpr Rung kPush       {                          .stack = {.needs = 0, .change =  1}};                         // LD
constexpr Rung kTop        {                          .stack = {.needs = 1, .change =  0}};                         // A, O, NOT
constexpr Rung kOneToTwo   {                          .stack = {.needs = 1, .change =  1}};                         // LPS
constexpr Rung kTwoToOne   {                          .stack = {.needs = 2, .change = -1}};                         // ALD, LPP
constexpr Rung kReadSecond {                          .stack = {.needs = 2, .change =  0}};                         // LRD

// What is read and written besides operands, at most. The numbers of special memory are those of all ports. What the
// counters, the pulse outputs and the events at inputs touch is in analysis/effects/fast_units.hpp.
using AllBesides = decltype(Instruction::besides);
constexpr Besides kStatusByte   {sm::kInterruptStatus, 1, Role::InOut}, kLocalMemory{image::kL, image::kConstants - image::kL, Role::Out};

/// The SM bytes of each port's receive message service. Its loop goes over the ports themselves: with their number as its end
/// GCC 12 fails at it where it optimises at link time.
constexpr AllBesides besides_of_reception() {
  AllBesides all{kStatusByte};
  std::size_t next = 1;
  for (const auto& port : kPorts) {
    all[next++] = {port.message, 1, Role::InOut};
    all[next++] = {port.message + sm::message::kControl, 8, Role::In};
  }
  return all;
}

constexpr AllBesides kReadsInputs  {{{image::kInputs, image::kPointBytes, Role::In}}};
constexpr AllBesides kWritesOutputs{{{image::kOutputs, image::kPointBytes, Role::InOut}}};
constexpr AllBesides kChangesLevel {{kLocalMemory}};  // of another routine
constexpr AllBesides kReturning    {{kLocalMemory, {image::kAC, 16, Role::Out}, {sm::kFlags, 1, Role::Out}}};
constexpr AllBesides kEnabling     {{kStatusByte}};
constexpr AllBesides kSending      {{kStatusByte}};
constexpr AllBesides kReceiving    = besides_of_reception();

constexpr Instruction kBitLogic[] = {
    {.mnemonic = "LD",   .operand = {kBit},        .rung = kPush,                               .effect = Effect::LoadsBit, .body = kContact<Load, false>, .meaning = "push BIT"},
    {.mnemonic = "LDN",  .operand = {kBit},        .rung = kPush,                                                           .body = kContact<Load, true>,  .meaning = "push NOT BIT"},
    {.mnemonic = "LDI",  .operand = {kInputPoint}, .rung = kPush, .hidden = Hidden::InputPoint,                             .body = kContact<Load, false>, .meaning = "push the input point BIT"},
    {.mnemonic = "LDNI", .operand = {kInputPoint}, .rung = kPush, .hidden = Hidden::InputPoint,                             .body = kContact<Load, true>,  .meaning = "push NOT the input point BIT"},
    {.mnemonic = "A",    .operand = {kBit},        .rung = kTop,                                                            .body = kContact<And, false>,  .meaning = "top of stack AND BIT"},
    {.mnemonic = "AN",   .operand = {kBit},        .rung = kTop,                                                            .body = kContact<And, true>,   .meaning = "top of stack AND NOT BIT"},
    {.mnemonic = "AI",   .operand = {kInputPoint}, .rung = kTop,  .hidden = Hidden::InputPoint,                             .body = kContact<And, false>,  .meaning = "top of stack AND the input point BIT"},
    {.mnemonic = "ANI",  .operand = {kInputPoint}, .rung = kTop,  .hidden = Hidden::InputPoint,                             .body = kContact<And, true>,   .meaning = "top of stack AND NOT the input point BIT"},
    {.mnemonic = "O",    .operand = {kBit},        .rung = kTop,                                                            .body = kContact<Or, false>,   .meaning = "top of stack OR BIT"},
    {.mnemonic = "ON",   .operand = {kBit},        .rung = kTop,                                                            .body = kContact<Or, true>,    .meaning = "top of stack OR NOT BIT"},
    {.mnemonic = "OI",   .operand = {kInputPoint}, .rung = kTop,  .hidden = Hidden::InputPoint,                             .body = kContact<Or, false>,   .meaning = "top of stack OR the input point BIT"},
    {.mnemonic = "ONI",  .operand = {kInputPoint}, .rung = kTop,  .hidden = Hidden::InputPoint,                             .body = kContact<Or, true>,    .meaning = "top of stack OR NOT the input point BIT"},

    {.mnemonic = "NOT",                            .rung = kTop,                                                                                      .body = kOnStack<invert_top>,         .meaning = "invert the top of the stack"},
    {.mnemonic = "EU",                             .rung = kTop,                         .hidden = Hidden::RisingMemory,                              .body = kOnStack<edge<true>>,         .meaning = "1 for one execution when the top of the stack went from 0 to 1"},
    {.mnemonic = "ED",                             .rung = kTop,                         .hidden = Hidden::FallingMemory,                             .body = kOnStack<edge<false>>,        .meaning = "1 for one execution when the top of the stack went from 1 to 0"},
    {.mnemonic = "ALD",                            .rung = kTwoToOne,                                                                                 .body = kOnStack<combine_loads<And>>, .meaning = "AND the two upper levels into one"},
    {.mnemonic = "OLD",                            .rung = kTwoToOne,                                                                                 .body = kOnStack<combine_loads<Or>>,  .meaning = "OR the two upper levels into one"},
    {.mnemonic = "LPS",                            .rung = kOneToTwo,                                                                                 .body = kOnStack<push_copy>,          .meaning = "push a copy of the top of the stack"},
    {.mnemonic = "LRD",                            .rung = kReadSecond,                                                                               .body = kOnStack<read_second>,        .meaning = "copy the second level to the top"},
    {.mnemonic = "LPP",                            .rung = kTwoToOne,                                                                                 .body = kOnStack<pop_stack>,          .meaning = "pop the stack"},
    {.mnemonic = "LDS",  .operand = {kStackLevel}, .rung = kOneToTwo,   .cpus = kCpu22x,                                                              .body = kOnStack<push_level>,         .meaning = "push a copy of level n"},
    {.mnemonic = "AENO",                           .rung = kTop,        .cpus = kCpu22x,                                  .effect = Effect::ReadsEno, .body = and_eno,                      .meaning = "top of stack AND ENO, which the last box has set"},

    {.mnemonic = "=",   .operand = {kBitOut},               .rung = kCoil,                                   .effect = Effect::Coil,       .body = kCoilBody,                       .meaning = "write the top of the stack to BIT"},
    {.mnemonic = "=I",  .operand = {kOutputPoint},          .rung = kCoil,    .hidden = Hidden::OutputPoint,                               .body = immediate_coil,                  .meaning = "write the top of the stack to the output point and its image"},
    {.mnemonic = "S",   .operand = {kBits, kCount},         .rung = kPowered,                                .effect = Effect::SetsBits,   .body = kOnCore<set_bits<true, false>>,  .meaning = "set N bits from BIT on"},
    {.mnemonic = "R",   .operand = {kBits, kCount},         .rung = kPowered,                                .effect = Effect::ResetsBits, .body = kOnCore<set_bits<false, false>>, .meaning = "reset N bits from BIT on; of timers and counters the current values too"},
    {.mnemonic = "SI",  .operand = {kOutputPoints, kCount}, .rung = kPowered, .hidden = Hidden::OutputPoint,                               .body = kOnCore<set_bits<true, true>>,   .meaning = "set N output points and their image"},
    {.mnemonic = "RI",  .operand = {kOutputPoints, kCount}, .rung = kPowered, .hidden = Hidden::OutputPoint,                               .body = kOnCore<set_bits<false, true>>,  .meaning = "reset N output points and their image"},
    {.mnemonic = "NOP", .operand = {kAnyNumber},                                                                                           .body = kOnStack<no_operation>,          .meaning = "nothing"},
};

constexpr Instruction kCompareContacts[] = {
    {.mnemonic = "LDB=", .operand = {kIn1Byte, kIn2Byte},   .rung = kPush,                   .structure = Structure::Compare, .body = kCompare<Load, Equal, std::uint8_t>, .meaning = "push IN1 = IN2, unsigned bytes"},
    {.mnemonic = "AB=",  .operand = {kIn1Byte, kIn2Byte},   .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<And, Equal, std::uint8_t>,  .meaning = "top of stack AND IN1 = IN2, unsigned bytes"},
    {.mnemonic = "OB=",  .operand = {kIn1Byte, kIn2Byte},   .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<Or, Equal, std::uint8_t>,   .meaning = "top of stack OR IN1 = IN2, unsigned bytes"},
    {.mnemonic = "LDW=", .operand = {kIn1Word, kIn2Word},   .rung = kPush,                   .structure = Structure::Compare, .body = kCompare<Load, Equal, std::int16_t>, .meaning = "push IN1 = IN2, signed words"},
    {.mnemonic = "AW=",  .operand = {kIn1Word, kIn2Word},   .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<And, Equal, std::int16_t>,  .meaning = "top of stack AND IN1 = IN2, signed words"},
    {.mnemonic = "OW=",  .operand = {kIn1Word, kIn2Word},   .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<Or, Equal, std::int16_t>,   .meaning = "top of stack OR IN1 = IN2, signed words"},
    {.mnemonic = "LDD=", .operand = {kIn1Dword, kIn2Dword}, .rung = kPush,                   .structure = Structure::Compare, .body = kCompare<Load, Equal, std::int32_t>, .meaning = "push IN1 = IN2, signed double words"},
    {.mnemonic = "AD=",  .operand = {kIn1Dword, kIn2Dword}, .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<And, Equal, std::int32_t>,  .meaning = "top of stack AND IN1 = IN2, signed double words"},
    {.mnemonic = "OD=",  .operand = {kIn1Dword, kIn2Dword}, .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<Or, Equal, std::int32_t>,   .meaning = "top of stack OR IN1 = IN2, signed double words"},
    {.mnemonic = "LDR=", .operand = {kIn1Real, kIn2Real},   .rung = kPush, .cpus = kFrom214, .structure = Structure::Compare, .body = kCompare<Load, Equal, float>,        .meaning = "push IN1 = IN2, real numbers"},
    {.mnemonic = "AR=",  .operand = {kIn1Real, kIn2Real},   .rung = kTop,  .cpus = kFrom214, .structure = Structure::Compare, .body = kCompare<And, Equal, float>,         .meaning = "top of stack AND IN1 = IN2, real numbers"},
    {.mnemonic = "OR=",  .operand = {kIn1Real, kIn2Real},   .rung = kTop,  .cpus = kFrom214, .structure = Structure::Compare, .body = kCompare<Or, Equal, float>,          .meaning = "top of stack OR IN1 = IN2, real numbers"},

    {.mnemonic = "LDB>=", .operand = {kIn1Usint, kIn2Usint}, .rung = kPush,                   .structure = Structure::Compare, .body = kCompare<Load, GreaterEqual, std::uint8_t>, .meaning = "push IN1 >= IN2, unsigned bytes"},
    {.mnemonic = "AB>=",  .operand = {kIn1Usint, kIn2Usint}, .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<And, GreaterEqual, std::uint8_t>,  .meaning = "top of stack AND IN1 >= IN2, unsigned bytes"},
    {.mnemonic = "OB>=",  .operand = {kIn1Usint, kIn2Usint}, .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<Or, GreaterEqual, std::uint8_t>,   .meaning = "top of stack OR IN1 >= IN2, unsigned bytes"},
    {.mnemonic = "LDW>=", .operand = {kIn1Int, kIn2Int},     .rung = kPush,                   .structure = Structure::Compare, .body = kCompare<Load, GreaterEqual, std::int16_t>, .meaning = "push IN1 >= IN2, signed words"},
    {.mnemonic = "AW>=",  .operand = {kIn1Int, kIn2Int},     .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<And, GreaterEqual, std::int16_t>,  .meaning = "top of stack AND IN1 >= IN2, signed words"},
    {.mnemonic = "OW>=",  .operand = {kIn1Int, kIn2Int},     .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<Or, GreaterEqual, std::int16_t>,   .meaning = "top of stack OR IN1 >= IN2, signed words"},
    {.mnemonic = "LDD>=", .operand = {kIn1Dint, kIn2Dint},   .rung = kPush,                   .structure = Structure::Compare, .body = kCompare<Load, GreaterEqual, std::int32_t>, .meaning = "push IN1 >= IN2, signed double words"},
    {.mnemonic = "AD>=",  .operand = {kIn1Dint, kIn2Dint},   .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<And, GreaterEqual, std::int32_t>,  .meaning = "top of stack AND IN1 >= IN2, signed double words"},
    {.mnemonic = "OD>=",  .operand = {kIn1Dint, kIn2Dint},   .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<Or, GreaterEqual, std::int32_t>,   .meaning = "top of stack OR IN1 >= IN2, signed double words"},
    {.mnemonic = "LDR>=", .operand = {kIn1Real, kIn2Real},   .rung = kPush, .cpus = kFrom214, .structure = Structure::Compare, .body = kCompare<Load, GreaterEqual, float>,        .meaning = "push IN1 >= IN2, real numbers"},
    {.mnemonic = "AR>=",  .operand = {kIn1Real, kIn2Real},   .rung = kTop,  .cpus = kFrom214, .structure = Structure::Compare, .body = kCompare<And, GreaterEqual, float>,         .meaning = "top of stack AND IN1 >= IN2, real numbers"},
    {.mnemonic = "OR>=",  .operand = {kIn1Real, kIn2Real},   .rung = kTop,  .cpus = kFrom214, .structure = Structure::Compare, .body = kCompare<Or, GreaterEqual, float>,          .meaning = "top of stack OR IN1 >= IN2, real numbers"},

    {.mnemonic = "LDB<=", .operand = {kIn1Usint, kIn2Usint}, .rung = kPush,                   .structure = Structure::Compare, .body = kCompare<Load, LessEqual, std::uint8_t>, .meaning = "push IN1 <= IN2, unsigned bytes"},
    {.mnemonic = "AB<=",  .operand = {kIn1Usint, kIn2Usint}, .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<And, LessEqual, std::uint8_t>,  .meaning = "top of stack AND IN1 <= IN2, unsigned bytes"},
    {.mnemonic = "OB<=",  .operand = {kIn1Usint, kIn2Usint}, .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<Or, LessEqual, std::uint8_t>,   .meaning = "top of stack OR IN1 <= IN2, unsigned bytes"},
    {.mnemonic = "LDW<=", .operand = {kIn1Int, kIn2Int},     .rung = kPush,                   .structure = Structure::Compare, .body = kCompare<Load, LessEqual, std::int16_t>, .meaning = "push IN1 <= IN2, signed words"},
    {.mnemonic = "AW<=",  .operand = {kIn1Int, kIn2Int},     .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<And, LessEqual, std::int16_t>,  .meaning = "top of stack AND IN1 <= IN2, signed words"},
    {.mnemonic = "OW<=",  .operand = {kIn1Int, kIn2Int},     .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<Or, LessEqual, std::int16_t>,   .meaning = "top of stack OR IN1 <= IN2, signed words"},
    {.mnemonic = "LDD<=", .operand = {kIn1Dint, kIn2Dint},   .rung = kPush,                   .structure = Structure::Compare, .body = kCompare<Load, LessEqual, std::int32_t>, .meaning = "push IN1 <= IN2, signed double words"},
    {.mnemonic = "AD<=",  .operand = {kIn1Dint, kIn2Dint},   .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<And, LessEqual, std::int32_t>,  .meaning = "top of stack AND IN1 <= IN2, signed double words"},
    {.mnemonic = "OD<=",  .operand = {kIn1Dint, kIn2Dint},   .rung = kTop,                    .structure = Structure::Compare, .body = kCompare<Or, LessEqual, std::int32_t>,   .meaning = "top of stack OR IN1 <= IN2, signed double words"},
    {.mnemonic = "LDR<=", .operand = {kIn1Real, kIn2Real},   .rung = kPush, .cpus = kFrom214, .structure = Structure::Compare, .body = kCompare<Load, LessEqual, float>,        .meaning = "push IN1 <= IN2, real numbers"},
    {.mnemonic = "AR<=",  .operand = {kIn1Real, kIn2Real},   .rung = kTop,  .cpus = kFrom214, .structure = Structure::Compare, .body = kCompare<And, LessEqual, float>,         .meaning = "top of stack AND IN1 <= IN2, real numbers"},
    {.mnemonic = "OR<=",  .operand = {kIn1Real, kIn2Real},   .rung = kTop,  .cpus = kFrom214, .structure = Structure::Compare, .body = kCompare<Or, LessEqual, float>,          .meaning = "top of stack OR IN1 <= IN2, real numbers"},

    {.mnemonic = "LDB<>", .operand = {kIn1Byte, kIn2Byte},   .rung = kPush, .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Load, NotEqual, std::uint8_t>, .meaning = "push IN1 <> IN2, unsigned bytes"},
    {.mnemonic = "AB<>",  .operand = {kIn1Byte, kIn2Byte},   .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<And, NotEqual, std::uint8_t>,  .meaning = "top of stack AND IN1 <> IN2, unsigned bytes"},
    {.mnemonic = "OB<>",  .operand = {kIn1Byte, kIn2Byte},   .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Or, NotEqual, std::uint8_t>,   .meaning = "top of stack OR IN1 <> IN2, unsigned bytes"},
    {.mnemonic = "LDW<>", .operand = {kIn1Word, kIn2Word},   .rung = kPush, .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Load, NotEqual, std::int16_t>, .meaning = "push IN1 <> IN2, signed words"},
    {.mnemonic = "AW<>",  .operand = {kIn1Word, kIn2Word},   .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<And, NotEqual, std::int16_t>,  .meaning = "top of stack AND IN1 <> IN2, signed words"},
    {.mnemonic = "OW<>",  .operand = {kIn1Word, kIn2Word},   .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Or, NotEqual, std::int16_t>,   .meaning = "top of stack OR IN1 <> IN2, signed words"},
    {.mnemonic = "LDD<>", .operand = {kIn1Dword, kIn2Dword}, .rung = kPush, .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Load, NotEqual, std::int32_t>, .meaning = "push IN1 <> IN2, signed double words"},
    {.mnemonic = "AD<>",  .operand = {kIn1Dword, kIn2Dword}, .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<And, NotEqual, std::int32_t>,  .meaning = "top of stack AND IN1 <> IN2, signed double words"},
    {.mnemonic = "OD<>",  .operand = {kIn1Dword, kIn2Dword}, .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Or, NotEqual, std::int32_t>,   .meaning = "top of stack OR IN1 <> IN2, signed double words"},
    {.mnemonic = "LDR<>", .operand = {kIn1Real, kIn2Real},   .rung = kPush, .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Load, NotEqual, float>,        .meaning = "push IN1 <> IN2, real numbers"},
    {.mnemonic = "AR<>",  .operand = {kIn1Real, kIn2Real},   .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<And, NotEqual, float>,         .meaning = "top of stack AND IN1 <> IN2, real numbers"},
    {.mnemonic = "OR<>",  .operand = {kIn1Real, kIn2Real},   .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Or, NotEqual, float>,          .meaning = "top of stack OR IN1 <> IN2, real numbers"},

    {.mnemonic = "LDB>", .operand = {kIn1Usint, kIn2Usint}, .rung = kPush, .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Load, Greater, std::uint8_t>, .meaning = "push IN1 > IN2, unsigned bytes"},
    {.mnemonic = "AB>",  .operand = {kIn1Usint, kIn2Usint}, .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<And, Greater, std::uint8_t>,  .meaning = "top of stack AND IN1 > IN2, unsigned bytes"},
    {.mnemonic = "OB>",  .operand = {kIn1Usint, kIn2Usint}, .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Or, Greater, std::uint8_t>,   .meaning = "top of stack OR IN1 > IN2, unsigned bytes"},
    {.mnemonic = "LDW>", .operand = {kIn1Int, kIn2Int},     .rung = kPush, .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Load, Greater, std::int16_t>, .meaning = "push IN1 > IN2, signed words"},
    {.mnemonic = "AW>",  .operand = {kIn1Int, kIn2Int},     .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<And, Greater, std::int16_t>,  .meaning = "top of stack AND IN1 > IN2, signed words"},
    {.mnemonic = "OW>",  .operand = {kIn1Int, kIn2Int},     .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Or, Greater, std::int16_t>,   .meaning = "top of stack OR IN1 > IN2, signed words"},
    {.mnemonic = "LDD>", .operand = {kIn1Dint, kIn2Dint},   .rung = kPush, .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Load, Greater, std::int32_t>, .meaning = "push IN1 > IN2, signed double words"},
    {.mnemonic = "AD>",  .operand = {kIn1Dint, kIn2Dint},   .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<And, Greater, std::int32_t>,  .meaning = "top of stack AND IN1 > IN2, signed double words"},
    {.mnemonic = "OD>",  .operand = {kIn1Dint, kIn2Dint},   .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Or, Greater, std::int32_t>,   .meaning = "top of stack OR IN1 > IN2, signed double words"},
    {.mnemonic = "LDR>", .operand = {kIn1Real, kIn2Real},   .rung = kPush, .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Load, Greater, float>,        .meaning = "push IN1 > IN2, real numbers"},
    {.mnemonic = "AR>",  .operand = {kIn1Real, kIn2Real},   .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<And, Greater, float>,         .meaning = "top of stack AND IN1 > IN2, real numbers"},
    {.mnemonic = "OR>",  .operand = {kIn1Real, kIn2Real},   .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Or, Greater, float>,          .meaning = "top of stack OR IN1 > IN2, real numbers"},

    {.mnemonic = "LDB<", .operand = {kIn1Usint, kIn2Usint}, .rung = kPush, .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Load, Less, std::uint8_t>, .meaning = "push IN1 < IN2, unsigned bytes"},
    {.mnemonic = "AB<",  .operand = {kIn1Usint, kIn2Usint}, .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<And, Less, std::uint8_t>,  .meaning = "top of stack AND IN1 < IN2, unsigned bytes"},
    {.mnemonic = "OB<",  .operand = {kIn1Usint, kIn2Usint}, .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Or, Less, std::uint8_t>,   .meaning = "top of stack OR IN1 < IN2, unsigned bytes"},
    {.mnemonic = "LDW<", .operand = {kIn1Int, kIn2Int},     .rung = kPush, .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Load, Less, std::int16_t>, .meaning = "push IN1 < IN2, signed words"},
    {.mnemonic = "AW<",  .operand = {kIn1Int, kIn2Int},     .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<And, Less, std::int16_t>,  .meaning = "top of stack AND IN1 < IN2, signed words"},
    {.mnemonic = "OW<",  .operand = {kIn1Int, kIn2Int},     .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Or, Less, std::int16_t>,   .meaning = "top of stack OR IN1 < IN2, signed words"},
    {.mnemonic = "LDD<", .operand = {kIn1Dint, kIn2Dint},   .rung = kPush, .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Load, Less, std::int32_t>, .meaning = "push IN1 < IN2, signed double words"},
    {.mnemonic = "AD<",  .operand = {kIn1Dint, kIn2Dint},   .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<And, Less, std::int32_t>,  .meaning = "top of stack AND IN1 < IN2, signed double words"},
    {.mnemonic = "OD<",  .operand = {kIn1Dint, kIn2Dint},   .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Or, Less, std::int32_t>,   .meaning = "top of stack OR IN1 < IN2, signed double words"},
    {.mnemonic = "LDR<", .operand = {kIn1Real, kIn2Real},   .rung = kPush, .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Load, Less, float>,        .meaning = "push IN1 < IN2, real numbers"},
    {.mnemonic = "AR<",  .operand = {kIn1Real, kIn2Real},   .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<And, Less, float>,         .meaning = "top of stack AND IN1 < IN2, real numbers"},
    {.mnemonic = "OR<",  .operand = {kIn1Real, kIn2Real},   .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompare<Or, Less, float>,          .meaning = "top of stack OR IN1 < IN2, real numbers"},
};

constexpr Instruction kMove[] = {
    {.mnemonic = "MOVB", .operand = {kInByte, kOutByte},             .rung = kBox,                   .effect = Effect::CopiesByte,                            .body = kOnMemory<move<std::uint8_t>>,      .meaning = "copy byte IN to OUT"},
    {.mnemonic = "MOVW", .operand = {kInWord, kOutWordOrAnalog},     .rung = kBox,                                                                            .body = kOnMemory<move<std::uint16_t>>,     .meaning = "copy word IN to OUT"},
    {.mnemonic = "MOVD", .operand = {kInDwordOrAddress, kOutDword},  .rung = kBox,                                                                            .body = kOnMemory<move<std::uint32_t>>,     .meaning = "copy double word IN to OUT"},
    {.mnemonic = "MOVR", .operand = {kInReal, kOutReal},             .rung = kBox, .cpus = kFrom214,                                                          .body = kOnMemory<move<std::uint32_t>>,     .meaning = "copy real IN to OUT"},
    {.mnemonic = "BMB",  .operand = {kInBytes, kOutBytes, kCount},   .rung = kBox,                                                                            .body = kOnCore<move_block<std::uint8_t>>,  .meaning = "copy N bytes from IN on to OUT on"},
    {.mnemonic = "BMW",  .operand = {kInWords, kOutWords, kCount},   .rung = kBox,                                                                            .body = kOnCore<move_block<std::uint16_t>>, .meaning = "copy N words from IN on to OUT on"},
    {.mnemonic = "BMD",  .operand = {kInDwords, kOutDwords, kCount}, .rung = kBox, .cpus = kFrom215,                                                          .body = kOnCore<move_block<std::uint32_t>>, .meaning = "copy N double words from IN on to OUT on"},
    {.mnemonic = "FILL", .operand = {kInWord, kOutWords, kCount},    .rung = kBox,                                                                            .body = kOnCore<fill>,                      .meaning = "write word IN to N words from OUT on"},
    {.mnemonic = "SWAP", .operand = {kSwapped},                      .rung = kBox,                                                                            .body = kOnMemory<swap_bytes>,              .meaning = "exchange the two bytes of a word"},
    {.mnemonic = "BIR",  .operand = {kInputByte, kOutByte},          .rung = kBox, .cpus = kCpu22x,                                .besides = kReadsInputs,   .body = read_points,                        .meaning = "copy eight input points to OUT"},
    {.mnemonic = "BIW",  .operand = {kInByte, kOutputByte},          .rung = kBox, .cpus = kCpu22x,                                .besides = kWritesOutputs, .body = write_points,                       .meaning = "copy IN to eight output points and their image"},
};

constexpr Instruction kIntegerArithmetic[] = {
    {.mnemonic = "+I",   .operand = {kIn1Word, kInOutWord},   .rung = kBox, .flags = kArithmetic,                           .body = kOnMemory<add<std::int16_t>>,             .meaning = "OUT + IN1 to OUT, 16 bits"},
    {.mnemonic = "-I",   .operand = {kIn1Word, kInOutWord},   .rung = kBox, .flags = kArithmetic,                           .body = kOnMemory<subtract<std::int16_t>>,        .meaning = "OUT - IN1 to OUT, 16 bits"},
    {.mnemonic = "+D",   .operand = {kIn1Dword, kInOutDword}, .rung = kBox, .flags = kArithmetic,                           .body = kOnMemory<add<std::int32_t>>,             .meaning = "OUT + IN1 to OUT, 32 bits"},
    {.mnemonic = "-D",   .operand = {kIn1Dword, kInOutDword}, .rung = kBox, .flags = kArithmetic,                           .body = kOnMemory<subtract<std::int32_t>>,        .meaning = "OUT - IN1 to OUT, 32 bits"},
    {.mnemonic = "MUL",  .operand = {kIn1Int, kInOutDword},   .rung = kBox, .flags = kMultiplyDivide,                       .body = kOnMemory<multiply>,                      .meaning = "IN1 × low word of OUT to OUT, 32 bits"},
    {.mnemonic = "DIV",  .operand = {kIn1Int, kInOutDword},   .rung = kBox, .flags = kMultiplyDivide,                       .body = kOnMemory<divide>,                        .meaning = "low word of OUT / IN1: quotient to its low word, remainder to its high word"},
    {.mnemonic = "*I",   .operand = {kIn1Int, kInOutWord},    .rung = kBox, .flags = kMultiplyDivide,     .cpus = kCpu22x,  .body = kOnMemory<multiply_narrow<std::int16_t>>, .meaning = "OUT × IN1 to OUT, 16 bits"},
    {.mnemonic = "/I",   .operand = {kIn1Int, kInOutWord},    .rung = kBox, .flags = kMultiplyDivide,     .cpus = kCpu22x,  .body = kOnMemory<divide_narrow<std::int16_t>>,   .meaning = "OUT / IN1 to OUT, 16 bits, without remainder"},
    {.mnemonic = "*D",   .operand = {kIn1Dint, kInOutDword},  .rung = kBox, .flags = kMultiplyDivide,     .cpus = kCpu22x,  .body = kOnMemory<multiply_narrow<std::int32_t>>, .meaning = "OUT × IN1 to OUT, 32 bits"},
    {.mnemonic = "/D",   .operand = {kIn1Dint, kInOutDword},  .rung = kBox, .flags = kMultiplyDivide,     .cpus = kCpu22x,  .body = kOnMemory<divide_narrow<std::int32_t>>,   .meaning = "OUT / IN1 to OUT, 32 bits, without remainder"},
    {.mnemonic = "INCW", .operand = {kInOutWord},             .rung = kBox, .flags = kArithmetic,                           .body = kOnMemory<increment<std::int16_t, 1>>,    .meaning = "OUT + 1 to OUT, 16 bits"},
    {.mnemonic = "DECW", .operand = {kInOutWord},             .rung = kBox, .flags = kArithmetic,                           .body = kOnMemory<increment<std::int16_t, -1>>,   .meaning = "OUT - 1 to OUT, 16 bits"},
    {.mnemonic = "INCD", .operand = {kInOutDword},            .rung = kBox, .flags = kArithmetic,                           .body = kOnMemory<increment<std::int32_t, 1>>,    .meaning = "OUT + 1 to OUT, 32 bits"},
    {.mnemonic = "DECD", .operand = {kInOutDword},            .rung = kBox, .flags = kArithmetic,                           .body = kOnMemory<increment<std::int32_t, -1>>,   .meaning = "OUT - 1 to OUT, 32 bits"},
    {.mnemonic = "INCB", .operand = {kInOutByte},             .rung = kBox, .flags = kUnsignedArithmetic, .cpus = kFrom215, .body = kOnMemory<increment_byte<1>>,             .meaning = "OUT + 1 to OUT, unsigned byte"},
    {.mnemonic = "DECB", .operand = {kInOutByte},             .rung = kBox, .flags = kUnsignedArithmetic, .cpus = kFrom215, .body = kOnMemory<increment_byte<-1>>,            .meaning = "OUT - 1 to OUT, unsigned byte"},
};

constexpr Instruction kLogicOperations[] = {
    {.mnemonic = "ANDW", .operand = {kIn1Word, kInOutWord},   .rung = kBox, .flags = kZero,                   .body = kOnMemory<combine_words<Logic::And, std::uint16_t>>, .meaning = "OUT AND IN1 to OUT"},
    {.mnemonic = "ORW",  .operand = {kIn1Word, kInOutWord},   .rung = kBox, .flags = kZero,                   .body = kOnMemory<combine_words<Logic::Or, std::uint16_t>>,  .meaning = "OUT OR IN1 to OUT"},
    {.mnemonic = "XORW", .operand = {kIn1Word, kInOutWord},   .rung = kBox, .flags = kZero,                   .body = kOnMemory<combine_words<Logic::Xor, std::uint16_t>>, .meaning = "OUT XOR IN1 to OUT"},
    {.mnemonic = "INVW", .operand = {kInOutWord},             .rung = kBox, .flags = kZero,                   .body = kOnMemory<invert<std::uint16_t>>,                    .meaning = "NOT OUT to OUT"},
    {.mnemonic = "ANDD", .operand = {kIn1Dword, kInOutDword}, .rung = kBox, .flags = kZero,                   .body = kOnMemory<combine_words<Logic::And, std::uint32_t>>, .meaning = "OUT AND IN1 to OUT"},
    {.mnemonic = "ORD",  .operand = {kIn1Dword, kInOutDword}, .rung = kBox, .flags = kZero,                   .body = kOnMemory<combine_words<Logic::Or, std::uint32_t>>,  .meaning = "OUT OR IN1 to OUT"},
    {.mnemonic = "XORD", .operand = {kIn1Dword, kInOutDword}, .rung = kBox, .flags = kZero,                   .body = kOnMemory<combine_words<Logic::Xor, std::uint32_t>>, .meaning = "OUT XOR IN1 to OUT"},
    {.mnemonic = "INVD", .operand = {kInOutDword},            .rung = kBox, .flags = kZero,                   .body = kOnMemory<invert<std::uint32_t>>,                    .meaning = "NOT OUT to OUT"},
    {.mnemonic = "ANDB", .operand = {kIn1Byte, kInOutByte},   .rung = kBox, .flags = kZero, .cpus = kFrom215, .body = kOnMemory<combine_words<Logic::And, std::uint8_t>>,  .meaning = "OUT AND IN1 to OUT"},
    {.mnemonic = "ORB",  .operand = {kIn1Byte, kInOutByte},   .rung = kBox, .flags = kZero, .cpus = kFrom215, .body = kOnMemory<combine_words<Logic::Or, std::uint8_t>>,   .meaning = "OUT OR IN1 to OUT"},
    {.mnemonic = "XORB", .operand = {kIn1Byte, kInOutByte},   .rung = kBox, .flags = kZero, .cpus = kFrom215, .body = kOnMemory<combine_words<Logic::Xor, std::uint8_t>>,  .meaning = "OUT XOR IN1 to OUT"},
    {.mnemonic = "INVB", .operand = {kInOutByte},             .rung = kBox, .flags = kZero, .cpus = kFrom215, .body = kOnMemory<invert<std::uint8_t>>,                     .meaning = "NOT OUT to OUT"},
};

constexpr Instruction kShiftAndRotate[] = {
    {.mnemonic = "SLW",  .operand = {kInOutWord, kPlaces},                   .rung = kShiftBox, .flags = kShiftFlags,                   .body = kOnCore<shift<std::uint16_t, true>>,   .meaning = "shift OUT left by N, at most 16"},
    {.mnemonic = "SRW",  .operand = {kInOutWord, kPlaces},                   .rung = kShiftBox, .flags = kShiftFlags,                   .body = kOnCore<shift<std::uint16_t, false>>,  .meaning = "shift OUT right by N, at most 16"},
    {.mnemonic = "SLD",  .operand = {kInOutDword, kPlaces},                  .rung = kShiftBox, .flags = kShiftFlags,                   .body = kOnCore<shift<std::uint32_t, true>>,   .meaning = "shift OUT left by N, at most 32"},
    {.mnemonic = "SRD",  .operand = {kInOutDword, kPlaces},                  .rung = kShiftBox, .flags = kShiftFlags,                   .body = kOnCore<shift<std::uint32_t, false>>,  .meaning = "shift OUT right by N, at most 32"},
    {.mnemonic = "RLW",  .operand = {kInOutWord, kPlaces},                   .rung = kShiftBox, .flags = kShiftFlags,                   .body = kOnCore<rotate<std::uint16_t, true>>,  .meaning = "rotate OUT left by N modulo 16"},
    {.mnemonic = "RRW",  .operand = {kInOutWord, kPlaces},                   .rung = kShiftBox, .flags = kShiftFlags,                   .body = kOnCore<rotate<std::uint16_t, false>>, .meaning = "rotate OUT right by N modulo 16"},
    {.mnemonic = "RLD",  .operand = {kInOutDword, kPlaces},                  .rung = kShiftBox, .flags = kShiftFlags,                   .body = kOnCore<rotate<std::uint32_t, true>>,  .meaning = "rotate OUT left by N modulo 32"},
    {.mnemonic = "SLB",  .operand = {kInOutByte, kPlaces},                   .rung = kShiftBox, .flags = kShiftFlags, .cpus = kFrom215, .body = kOnCore<shift<std::uint8_t, true>>,    .meaning = "shift OUT left by N, at most 8"},
    {.mnemonic = "SRB",  .operand = {kInOutByte, kPlaces},                   .rung = kShiftBox, .flags = kShiftFlags, .cpus = kFrom215, .body = kOnCore<shift<std::uint8_t, false>>,   .meaning = "shift OUT right by N, at most 8"},
    {.mnemonic = "RLB",  .operand = {kInOutByte, kPlaces},                   .rung = kShiftBox, .flags = kShiftFlags, .cpus = kFrom215, .body = kOnCore<rotate<std::uint8_t, true>>,   .meaning = "rotate OUT left by N modulo 8"},
    {.mnemonic = "RRB",  .operand = {kInOutByte, kPlaces},                   .rung = kShiftBox, .flags = kShiftFlags, .cpus = kFrom215, .body = kOnCore<rotate<std::uint8_t, false>>,  .meaning = "rotate OUT right by N modulo 8"},
    {.mnemonic = "SHRB", .operand = {kDataBit, kShiftRegister, kShiftCount}, .rung = kShiftBox, .flags = kOverflow,                     .body = shift_register,                        .meaning = "shift DATA into the |N| bits from S_BIT on; N < 0: from the far end"},
    {.mnemonic = "RRD",  .operand = {kInOutDword, kPlaces},                  .rung = kShiftBox, .flags = kShiftFlags,                   .body = kOnCore<rotate<std::uint32_t, false>>, .meaning = "rotate OUT right by N modulo 32"},
};

constexpr Instruction kProgramControl[] = {
    {.mnemonic = "JMP",  .operand = {kLabel},                       .rung = kPowered,                                                    .outside_segments = true, .structure = Structure::Jump,                                                                       .body = kOnCore<jump>,                   .meaning = "go on at LBL n of the same routine"},
    {.mnemonic = "LBL",  .operand = {kLabel},                       .rung = kMark,                                                                                 .structure = Structure::Label,                                                                      .body = kOnStack<no_operation>,          .meaning = "place that JMP n goes to"},
    {.mnemonic = "FOR",  .operand = {kLoopIndex, kInitial, kFinal}, .rung = kBox,     .cpus = kFrom214,        .allowed = kInterrupt22x, .outside_segments = true, .structure = Structure::For,                                                                        .body = kOnCore<begin_loop>,             .meaning = "repeat up to NEXT with INDX from INIT to FINAL"},
    {.mnemonic = "NEXT",                                            .rung = kMark,    .cpus = kFrom214,        .allowed = kInterrupt22x, .outside_segments = true, .structure = Structure::Next,                                                                       .body = kOnCore<next_pass>,              .meaning = "end of a FOR loop; leaves the top of the stack at 1"},
    {.mnemonic = "CALL", .operand = {kSubroutineNumber},            .rung = kBox,                              .allowed = kInterrupt22x,                           .structure = Structure::Call,                                             .besides = kChangesLevel, .body = kOnCore<call>,                   .meaning = "call subroutine n"},
    {.mnemonic = "SBR",  .operand = {kSubroutineNumber},            .rung = kMark,                                                                                 .structure = Structure::SubroutineHead,                                                             .body = kOnStack<no_operation>,          .meaning = "head of subroutine n"},
    {.mnemonic = "RET",                                             .rung = kMark,                             .allowed = kSubroutine,                             .structure = Structure::SubroutineEnd,                                    .besides = kChangesLevel, .body = kOnCore<return_from_subroutine>, .meaning = "end of a subroutine"},
    {.mnemonic = "CRET",                                            .rung = kPowered,                          .allowed = kSubroutine,                                                                     .effect = Effect::ConditionalEnd, .besides = kChangesLevel, .body = kOnCore<return_from_subroutine>, .meaning = "return from a subroutine"},
    {.mnemonic = "END",                                             .rung = kPowered,                          .allowed = kMain,         .outside_segments = true,                                         .effect = Effect::ConditionalEnd,                           .body = kOnCore<end_main_program>,       .meaning = "end the main program of this scan"},
    {.mnemonic = "MEND",                                            .rung = kMark,                             .allowed = kMain,                                   .structure = Structure::MainEnd,                                                                    .body = kLastOnCore<end_main_program>,   .meaning = "end of the main program"},
    {.mnemonic = "STOP",                                            .rung = kPowered,                                                                                                                      .effect = Effect::ConditionalEnd,                           .body = stop,                            .meaning = "go to STOP"},
    {.mnemonic = "WDR",                                             .rung = kPowered,                                                                                                                                                                                  .body = reset_watchdog,                  .meaning = "restart the scan watchdog"},
    {.mnemonic = "DLED", .operand = {kInByte},                      .rung = kBox,     .cpus = kCpu22xRelease2,                                                                                                                                                         .body = switch_diagnostic_led,           .meaning = "diagnostic LED off if IN is 0, otherwise yellow"},
};

constexpr Instruction kInterrupts[] = {
    {.mnemonic = "INT",   .operand = {kRoutineNumber},   .rung = kMark,                                .structure = Structure::InterruptHead,                                                             .body = kOnStack<no_operation>,         .meaning = "head of interrupt routine n"},
    {.mnemonic = "RETI",                                 .rung = kMark,    .allowed = kInterrupt,      .structure = Structure::InterruptEnd,                                       .besides = kReturning, .body = kOnCore<return_from_interrupt>, .meaning = "end of an interrupt routine"},
    {.mnemonic = "CRETI",                                .rung = kPowered, .allowed = kInterrupt,                                             .effect = Effect::ConditionalEnd,    .besides = kReturning, .body = kOnCore<return_from_interrupt>, .meaning = "return from an interrupt routine"},
    {.mnemonic = "ENI",                                  .rung = kPowered, .allowed = kNotInInterrupt,                                        .effect = Effect::EnablesInterrupts, .besides = kEnabling,  .body = enable_interrupts<true>,        .meaning = "enable interrupts"},
    {.mnemonic = "DISI",                                 .rung = kPowered, .allowed = kNotInInterrupt,                                                                             .besides = kEnabling,  .body = enable_interrupts<false>,       .meaning = "disable interrupts: events wait in their queues"},
    {.mnemonic = "ATCH",  .operand = {kRoutine, kEvent}, .rung = kBox,                                 .structure = Structure::Attach,                                                                    .body = attach,                         .meaning = "attach interrupt routine INT to event EVNT"},
    {.mnemonic = "DTCH",  .operand = {kEvent},           .rung = kBox,                                                                                                                                    .body = detach,                         .meaning = "detach event EVNT: it is ignored"},
};

constexpr Instruction kCommunication[] = {
    {.mnemonic = "XMT",  .operand = {kMessage, kPort},    .rung = kBox,                   .effect = Effect::Transmits,   .besides = kSending,   .body = transmit,           .meaning = "Freeport: send the characters of TBL, their number in its first byte"},
    {.mnemonic = "RCV",  .operand = {kReceived, kPort},   .rung = kBox, .cpus = kFrom215, .effect = Effect::Receives,    .besides = kReceiving, .body = receive,            .meaning = "Freeport: receive a message into TBL, the number of its characters in the first byte"},
    {.mnemonic = "NETR", .operand = {kNetwork, kPort},    .rung = kBox, .cpus = kFrom214,                                                       .body = use_network<false>, .meaning = "PPI master: read 1 to 16 bytes of another station into TBL"},
    {.mnemonic = "NETW", .operand = {kNetwork, kPort},    .rung = kBox, .cpus = kFrom214,                                                       .body = use_network<true>,  .meaning = "PPI master: write 1 to 16 bytes of TBL to another station"},
    {.mnemonic = "GPA",  .operand = {kAddressOut, kPort}, .rung = kBox, .cpus = kCpu22x,                                                        .body = get_port_address,   .meaning = "station address of a port to ADDR"},
    {.mnemonic = "SPA",  .operand = {kAddressIn, kPort},  .rung = kBox, .cpus = kCpu22x,  .effect = Effect::SetsStation,                        .body = set_port_address,   .meaning = "ADDR becomes the station address of a port"},
};

constexpr Instruction kTimersAndCounters[] = {
    {.mnemonic = "TON",   .operand = {kOnDelayTimer, kPresetTime},   .rung = kCoil,                                 .hidden = Hidden::Number,                                      .body = kOnCore<time_on<false>>, .meaning = "on-delay timer: counts while the top of the stack is 1, else 0"},
    {.mnemonic = "TONR",  .operand = {kRetentiveTimer, kPresetTime}, .rung = kCoil,                                 .hidden = Hidden::Number,                                      .body = kOnCore<time_on<true>>,  .meaning = "retentive on-delay timer: keeps its value until it is reset"},
    {.mnemonic = "TOF",   .operand = {kOffDelayTimer, kPresetTime},  .rung = kCoil,        .cpus = kCpu22x,         .hidden = Hidden::Number,                                      .body = kOnCore<time_off>,       .meaning = "off-delay timer: its bit goes off PT after the top of the stack has gone off"},
    {.mnemonic = "CTU",   .operand = {kCounter, kPresetValue},       .rung = kTwoInputs,                            .hidden = Hidden::Number,                                      .body = kOnCore<count_up>,       .meaning = "count up: second level counts, top resets"},
    {.mnemonic = "CTD",   .operand = {kCounter, kPresetValue},       .rung = kTwoInputs,   .cpus = kCpu22x,         .hidden = Hidden::Number,                                      .body = kOnCore<count_down>,     .meaning = "count down: second level counts, top loads PV"},
    {.mnemonic = "CTUD",  .operand = {kCounter, kPresetInt},         .rung = kThreeInputs,                          .hidden = Hidden::Number,                                      .body = kOnCore<count_up_down>,  .meaning = "count up and down: third level up, second down, top resets"},
    {.mnemonic = "BITIM", .operand = {kOutDword},                    .rung = kBox,         .cpus = kCpu22xRelease2,                           .effect = Effect::ReadsMilliseconds, .body = begin_interval,          .meaning = "the CPU's milliseconds to OUT"},
    {.mnemonic = "CITIM", .operand = {kInDword, kOutDword},          .rung = kBox,         .cpus = kCpu22xRelease2,                           .effect = Effect::ReadsMilliseconds, .body = read_interval,           .meaning = "milliseconds since IN, which BITIM has written, to OUT"},
};

constexpr Instruction kRealArithmetic[] = {
    {.mnemonic = "+R",   .operand = {kIn1Real, kInOutReal},  .rung = kBox,  .flags = kArithmetic,     .cpus = kFrom214,                                  .body = real_arithmetic<RealOperation::Add>,      .meaning = "OUT + IN1 to OUT"},
    {.mnemonic = "-R",   .operand = {kIn1Real, kInOutReal},  .rung = kBox,  .flags = kArithmetic,     .cpus = kFrom214,                                  .body = real_arithmetic<RealOperation::Subtract>, .meaning = "OUT - IN1 to OUT"},
    {.mnemonic = "*R",   .operand = {kIn1Real, kInOutReal},  .rung = kBox,  .flags = kArithmetic,     .cpus = kFrom214,                                  .body = real_arithmetic<RealOperation::Multiply>, .meaning = "OUT * IN1 to OUT"},
    {.mnemonic = "/R",   .operand = {kIn1Real, kInOutReal},  .rung = kBox,  .flags = kMultiplyDivide, .cpus = kFrom214,                                  .body = real_divide,                              .meaning = "OUT / IN1 to OUT"},
    {.mnemonic = "SQRT", .operand = {kInReal, kOutReal},     .rung = kBox,  .flags = kArithmetic,     .cpus = kFrom214,                                  .body = square_root,                              .meaning = "square root of IN to OUT"},
    {.mnemonic = "SIN",  .operand = {kInReal, kOutReal},     .rung = kBox,  .flags = kArithmetic,     .cpus = kCpu22x,                                   .body = real_function<Function::Sine>,            .meaning = "sine of IN, in radians, to OUT"},
    {.mnemonic = "COS",  .operand = {kInReal, kOutReal},     .rung = kBox,  .flags = kArithmetic,     .cpus = kCpu22x,                                   .body = real_function<Function::Cosine>,          .meaning = "cosine of IN, in radians, to OUT"},
    {.mnemonic = "TAN",  .operand = {kInReal, kOutReal},     .rung = kBox,  .flags = kArithmetic,     .cpus = kCpu22x,                                   .body = real_function<Function::Tangent>,         .meaning = "tangent of IN, in radians, to OUT"},
    {.mnemonic = "LN",   .operand = {kInReal, kOutReal},     .rung = kBox,  .flags = kArithmetic,     .cpus = kCpu22x,                                   .body = real_function<Function::Logarithm>,       .meaning = "natural logarithm of IN to OUT"},
    {.mnemonic = "EXP",  .operand = {kInReal, kOutReal},     .rung = kBox,  .flags = kArithmetic,     .cpus = kCpu22x,                                   .body = real_function<Function::Exponential>,     .meaning = "e to the power of IN to OUT"},
    {.mnemonic = "PID",  .operand = {kPidLoop, kLoopNumber}, .rung = kLoop, .flags = kOverflow,       .cpus = kFrom215, .hidden = Hidden::LoopMemory,    .body = control_loop,                             .meaning = "one sample of a PID loop, from and to its table"},
};

constexpr Instruction kConversion[] = {
    {.mnemonic = "BCDI",  .operand = {kInOutWord},                    .rung = kBox, .flags = kNotBcd,                     .body = kOnMemory<from_bcd>,                                .meaning = "four BCD digits to an integer"},
    {.mnemonic = "IBCD",  .operand = {kInOutWord},                    .rung = kBox, .flags = kNotBcd,                     .body = kOnMemory<to_bcd>,                                  .meaning = "integer 0 to 9999 to BCD"},
    {.mnemonic = "DTR",   .operand = {kInDint, kOutReal},             .rung = kBox,                     .cpus = kFrom214, .body = kOnMemory<integer_to_real>,                         .meaning = "double integer to real"},
    {.mnemonic = "TRUNC", .operand = {kInReal, kOutDword},            .rung = kBox, .flags = kOverflow, .cpus = kFrom214, .body = kOnMemory<to_integer<false>>,                       .meaning = "real to double integer, toward zero"},
    {.mnemonic = "ROUND", .operand = {kInReal, kOutDword},            .rung = kBox, .flags = kOverflow, .cpus = kCpu22x,  .body = kOnMemory<to_integer<true>>,                        .meaning = "real to double integer, to the nearest"},
    {.mnemonic = "BTI",   .operand = {kInUsint, kOutWord},            .rung = kBox,                     .cpus = kCpu22x,  .body = kOnMemory<widen<std::uint8_t, std::int16_t>>,       .meaning = "unsigned byte to integer"},
    {.mnemonic = "ITB",   .operand = {kInInt, kOutByte},              .rung = kBox, .flags = kOverflow, .cpus = kCpu22x,  .body = kOnMemory<narrow<std::int16_t, std::uint8_t>>,      .meaning = "integer 0 to 255 to byte"},
    {.mnemonic = "ITD",   .operand = {kInInt, kOutDword},             .rung = kBox,                     .cpus = kCpu22x,  .body = kOnMemory<widen<std::int16_t, std::int32_t>>,       .meaning = "integer to double integer"},
    {.mnemonic = "DTI",   .operand = {kInDint, kOutWord},             .rung = kBox, .flags = kOverflow, .cpus = kCpu22x,  .body = kOnMemory<narrow<std::int32_t, std::int16_t>>,      .meaning = "double integer to integer, if it fits"},
    {.mnemonic = "DECO",  .operand = {kInByte, kOutWord},             .rung = kBox,                                       .body = kOnMemory<decode_bit>,                              .meaning = "set the one bit of OUT that the low half of IN numbers"},
    {.mnemonic = "ENCO",  .operand = {kInWord, kOutByte},             .rung = kBox,                                       .body = kOnMemory<encode_bit>,                              .meaning = "number of the lowest bit set in IN to OUT"},
    {.mnemonic = "SEG",   .operand = {kInByte, kOutByte},             .rung = kBox,                                       .body = kOnMemory<seven_segments>,                          .meaning = "seven-segment pattern of the low half of IN"},
    {.mnemonic = "ATH",   .operand = {kInBytes, kOutDigits, kLength}, .rung = kBox, .flags = kNotHex,                     .body = ascii_to_hex,                                       .meaning = "LEN characters to hexadecimal digits"},
    {.mnemonic = "HTA",   .operand = {kInDigits, kOutBytes, kLength}, .rung = kBox,                                       .body = hex_to_ascii,                                       .meaning = "LEN hexadecimal digits to characters"},
    {.mnemonic = "ITA",   .operand = {kInInt, kOutText8, kFormat},    .rung = kBox,                     .cpus = kCpu22x,  .body = integer_to_text<std::int16_t, kIntegerText, false>, .meaning = "integer to 8 characters"},
    {.mnemonic = "DTA",   .operand = {kInDint, kOutText12, kFormat},  .rung = kBox,                     .cpus = kCpu22x,  .body = integer_to_text<std::int32_t, kDoubleText, false>,  .meaning = "double integer to 12 characters"},
    {.mnemonic = "RTA",   .operand = {kInReal, kOutText, kFormat},    .rung = kBox,                     .cpus = kCpu22x,  .body = real_to_text<false>,                                .meaning = "real to as many characters as FMT says"},
};

constexpr Instruction kTables[] = {
    {.mnemonic = "ATT",   .operand = {kDataWord, kTable},                  .rung = kBox, .flags = kTableFull,  .cpus = kFrom214, .body = add_to_table,            .meaning = "append DATA to the table"},
    {.mnemonic = "FIFO",  .operand = {kTable, kDataOut},                   .rung = kBox, .flags = kTableEmpty, .cpus = kFrom214, .body = take_from_table<true>,   .meaning = "take the first entry out of the table"},
    {.mnemonic = "LIFO",  .operand = {kTable, kDataOut},                   .rung = kBox, .flags = kTableEmpty, .cpus = kFrom214, .body = take_from_table<false>,  .meaning = "take the last entry out of the table"},
    {.mnemonic = "FND=",  .operand = {kEntries, kPatternWord, kFindIndex}, .rung = kBox,                       .cpus = kFrom214, .body = find_in_table<Equal>,    .meaning = "number of the next entry equal to PATRN, from INDX on"},
    {.mnemonic = "FND<>", .operand = {kEntries, kPatternWord, kFindIndex}, .rung = kBox,                       .cpus = kFrom214, .body = find_in_table<NotEqual>, .meaning = "number of the next entry not equal to PATRN, from INDX on"},
    {.mnemonic = "FND<",  .operand = {kEntries, kPatternInt, kFindIndex},  .rung = kBox,                       .cpus = kFrom214, .body = find_in_table<Less>,     .meaning = "number of the next entry less than PATRN, from INDX on"},
    {.mnemonic = "FND>",  .operand = {kEntries, kPatternInt, kFindIndex},  .rung = kBox,                       .cpus = kFrom214, .body = find_in_table<Greater>,  .meaning = "number of the next entry greater than PATRN, from INDX on"},
};

constexpr Instruction kStrings[] = {
    {.mnemonic = "SLEN", .operand = {kInString, kOutByte},                 .rung = kBox,                     .cpus = kCpu22x, .body = string_length,                                     .meaning = "length of the string IN to OUT"},
    {.mnemonic = "SCPY", .operand = {kInString, kOutString},               .rung = kBox,                     .cpus = kCpu22x, .body = copy_string,                                       .meaning = "copy the string IN to OUT"},
    {.mnemonic = "SCAT", .operand = {kInString, kInOutString},             .rung = kBox,                     .cpus = kCpu22x, .body = join_strings,                                      .meaning = "append the string IN to OUT"},
    {.mnemonic = "SFND", .operand = {kIn1String, kIn2String, kIndexInOut}, .rung = kBox,                     .cpus = kCpu22x, .body = find_in_string<true>,                              .meaning = "where IN2 is in IN1, from character OUT on; 0: nowhere"},
    {.mnemonic = "CFND", .operand = {kIn1String, kIn2String, kIndexInOut}, .rung = kBox,                     .cpus = kCpu22x, .body = find_in_string<false>,                             .meaning = "where a character of IN2 is in IN1, from character OUT on; 0: nowhere"},
    {.mnemonic = "ITS",  .operand = {kInInt, kOutString8, kFormat},        .rung = kBox,                     .cpus = kCpu22x, .body = integer_to_text<std::int16_t, kIntegerText, true>, .meaning = "integer to a string of 8 characters"},
    {.mnemonic = "DTS",  .operand = {kInDint, kOutString12, kFormat},      .rung = kBox,                     .cpus = kCpu22x, .body = integer_to_text<std::int32_t, kDoubleText, true>,  .meaning = "double integer to a string of 12 characters"},
    {.mnemonic = "RTS",  .operand = {kInReal, kOutString, kFormat},        .rung = kBox,                     .cpus = kCpu22x, .body = real_to_text<true>,                                .meaning = "real to a string as long as FMT says"},
    {.mnemonic = "STI",  .operand = {kInString, kIndex, kOutWord},         .rung = kBox, .flags = kOverflow, .cpus = kCpu22x, .body = text_to_number<std::int16_t>,                      .meaning = "integer from character INDX of a string on"},
    {.mnemonic = "STD",  .operand = {kInString, kIndex, kOutDword},        .rung = kBox, .flags = kOverflow, .cpus = kCpu22x, .body = text_to_number<std::int32_t>,                      .meaning = "double integer from character INDX of a string on"},
    {.mnemonic = "STR",  .operand = {kInString, kIndex, kOutReal},         .rung = kBox, .flags = kOverflow, .cpus = kCpu22x, .body = text_to_number<float>,                             .meaning = "real from character INDX of a string on"},

    {.mnemonic = "LDS=",  .operand = {kIn1String, kIn2String}, .rung = kPush, .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompareStrings<Load, true>,  .meaning = "push IN1 = IN2, strings"},
    {.mnemonic = "AS=",   .operand = {kIn1String, kIn2String}, .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompareStrings<And, true>,   .meaning = "top of stack AND IN1 = IN2, strings"},
    {.mnemonic = "OS=",   .operand = {kIn1String, kIn2String}, .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompareStrings<Or, true>,    .meaning = "top of stack OR IN1 = IN2, strings"},
    {.mnemonic = "LDS<>", .operand = {kIn1String, kIn2String}, .rung = kPush, .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompareStrings<Load, false>, .meaning = "push IN1 <> IN2, strings"},
    {.mnemonic = "AS<>",  .operand = {kIn1String, kIn2String}, .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompareStrings<And, false>,  .meaning = "top of stack AND IN1 <> IN2, strings"},
    {.mnemonic = "OS<>",  .operand = {kIn1String, kIn2String}, .rung = kTop,  .cpus = kCpu22x, .structure = Structure::Compare, .body = kCompareStrings<Or, false>,   .meaning = "top of stack OR IN1 <> IN2, strings"},
};

constexpr Instruction kSequenceControl[] = {
    {.mnemonic = "LSCR",  .operand = {kSegmentIn},  .rung = kSegmentHead,                  .allowed = kInterruptR2, .structure = Structure::SegmentBegin,                                    .body = begin_segment,      .meaning = "start of a segment whose contacts have power while the S bit is 1"},
    {.mnemonic = "SCRT",  .operand = {kSegmentOut}, .rung = kPowered,                      .allowed = kInterruptR2, .structure = Structure::SegmentTransition, .hidden = Hidden::SegmentBit, .body = segment_transition, .meaning = "go over to the segment of the S bit"},
    {.mnemonic = "CSCRE",                           .rung = kPowered,     .cpus = kCpu22x, .allowed = kInterruptR2, .structure = Structure::SegmentExit,                                     .body = leave_segment,      .meaning = "go to the end of the segment"},
    {.mnemonic = "SCRE",                            .rung = kMark,                         .allowed = kInterruptR2, .structure = Structure::SegmentEnd,                                      .body = end_segment,        .meaning = "end of a segment"},
};

constexpr Instruction kPeripherals[] = {
    {.mnemonic = "TODR", .operand = {kClockOut},                .rung = kBox, .cpus = kFrom214,                                                                    .effect = Effect::ReadsTimeOfDay,  .body = read_clock,      .meaning = "read the clock into the 8 bytes at T"},
    {.mnemonic = "TODW", .operand = {kClockIn},                 .rung = kBox, .cpus = kFrom214,                                                                                                       .body = write_clock,     .meaning = "set the clock from the 8 bytes at T"},
    {.mnemonic = "HDEF", .operand = {kHighSpeedCounter, kMode}, .rung = kBox,                   .allowed = kNotInInterrupt, .structure = Structure::DefineCounter,                                    .body = define_counter,  .meaning = "give a high-speed counter its mode, once"},
    {.mnemonic = "HSC",  .operand = {kHighSpeedCounter},        .rung = kBox,                                                                                      .effect = Effect::ProgramsCounter, .body = program_counter, .meaning = "take over the counter's control byte, values and enable"},
    {.mnemonic = "PLS",  .operand = {kPulseOutput},             .rung = kBox, .cpus = kFrom214,                                                                    .effect = Effect::ProgramsPulses,  .body = program_pulses,  .meaning = "start the pulse train or PWM of Q0.X"},
};

// Known by name, so that a program that uses them is told so.
constexpr Instruction kNotModelled[] = {
    {.mnemonic = "SSCPY", .cpus = kCpu22x,         .meaning = "copy a part of a string",                .not_modelled = "instructions have three operands here; BMB copies the characters, MOVB writes the length before them"},
    {.mnemonic = "TODRX", .cpus = kCpu22xRelease2, .meaning = "read the clock and its daylight saving", .not_modelled = "the clock has no daylight saving here; TODR reads the same first 8 bytes"},
    {.mnemonic = "TODWX", .cpus = kCpu22xRelease2, .meaning = "set the clock and its daylight saving",  .not_modelled = "the clock has no daylight saving here; TODW sets the clock from the same first 8 bytes"},
};

// clang-format on

/// The groups in the order of the manual.
constexpr Group kGroups[] = {
    {"Bit logic", kBitLogic, true},
    {"Compare contacts", kCompareContacts, true},
    {"Move", kMove, true},
    {"Integer arithmetic", kIntegerArithmetic, true},
    {"Logic operations", kLogicOperations, true},
    {"Shift and rotate", kShiftAndRotate, true},
    {"Program control", kProgramControl, true},
    {"Interrupts", kInterrupts},
    {"Communication", kCommunication},
    {"Timers and counters", kTimersAndCounters},
    {"Real arithmetic", kRealArithmetic, true},
    {"Conversion", kConversion, true},
    {"Tables", kTables, true},
    {"Strings", kStrings, true},
    {"Sequence control relays", kSequenceControl, true},
    {"Clock, high-speed counters, pulse outputs", kPeripherals},
    {"Not modelled yet", kNotModelled},
};

constexpr std::size_t kRows = std::accumulate(std::begin(kGroups), std::end(kGroups), std::size_t{0},
                                              [](std::size_t sum, const Group& group) { return sum + group.rows.size(); });

/// The rows of all groups, each with its heading.
constexpr std::array<Instruction, kRows> kInstructions = [] {
  std::array<Instruction, kRows> table;
  auto next = table.begin();
  for (const Group& group : kGroups)
    for (Instruction row : group.rows) {
      row.group = group.heading;
      *next++ = row;
    }
  return table;
}();

/// These write output points, the watchdog, a lamp or the mode; PID begins anew with each change to RUN.
constexpr bool works_on_more(const Instruction& row) {
  constexpr Body kBodies[] = {write_points, stop, reset_watchdog, switch_diagnostic_led};
  return row.hidden == Hidden::OutputPoint || row.hidden == Hidden::LoopMemory || std::ranges::count(kBodies, row.body.usual) != 0;
}

/// Whether each row works on memory alone.
constexpr std::array<bool, kRows> kMemoryAlone = [] {
  std::array<bool, kRows> alone{};
  auto next = alone.begin();
  for (const Group& group : kGroups)
    for (const Instruction& row : group.rows) *next++ = group.memory_alone && !works_on_more(row);
  return alone;
}();

// --- what has to be true of every row ---

constexpr bool mnemonics_are_unique() {
  std::array<std::string_view, kRows> mnemonics;
  std::ranges::transform(kInstructions, mnemonics.begin(), &Instruction::mnemonic);
  std::ranges::sort(mnemonics);
  return std::ranges::adjacent_find(mnemonics) == mnemonics.end();
}

constexpr bool has_a_body_and_a_meaning(const Instruction& row) { return row.modelled() && !row.meaning.empty(); }

/// Whether a row has only a name, the CPUs that have it, and the reason why nothing executes it.
constexpr bool is_known_by_name(const Instruction& row) {
  return !row.modelled() && !row.not_modelled.empty() && row.rules().empty() && row.rung == Rung{};
}

constexpr bool operands_have_names(const Instruction& row) {
  return std::ranges::count(row.operand, OperandRule{}) + std::ranges::ssize(row.rules()) == std::ranges::ssize(row.operand);
}

constexpr bool has_room_for_a_hidden_operand(const Instruction& row) {
  return row.hidden == Hidden::None || row.rules().size() < row.operand.size();
}

static_assert(mnemonics_are_unique());
static_assert(std::ranges::all_of(kInstructions, [](const Instruction& row) {
  return has_a_body_and_a_meaning(row) || is_known_by_name(row);
}));
static_assert(std::ranges::all_of(kInstructions, operands_have_names));
static_assert(std::ranges::all_of(kInstructions, has_room_for_a_hidden_operand));

}  // namespace

std::span<const Instruction> all_instructions() { return kInstructions; }

bool works_on_memory_alone(const Instruction& instruction) {
  return kMemoryAlone[static_cast<std::size_t>(&instruction - kInstructions.data())];
}

Link link_of_any() { return linked::kTailCalls ? linked::on_core<nullptr> : nullptr; }
Link link_of_step(Body step) {
  if (step == run_with_pointer_first) return linked::on_core<run_with_pointer_first>;
  if (step == run_with_pointer_second) return linked::on_core<run_with_pointer_second>;
  return link_of_any();
}

}  // namespace s7200
