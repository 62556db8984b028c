// All facts about an instruction. One row of the table (table.cpp) is one Instruction. The checker, the CPU, the printer,
// `s7200 instructions` and the tests of the table read it; the grammar does not.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "interpreter/model/area.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/special_memory.hpp"

namespace s7200 {

class Core;
struct Op;

/// Executes one decoded instruction that has power flow or does not need it. The clock is already at the end of the
/// instruction's basic time; the body adds the time that depends on counts.
using Body = void (*)(Core& core, const Op& op);

/// Executes an op, or a chain of them, and goes on with the next one by a tail call (instructions/linked.hpp), so that what
/// each needs stays in registers: `left`, ns until the CPU has to look for other work; `stack`, the bits of the logic stack;
/// `executed`, the number of instructions so far.
using Link = void (*)(Core& core, const Op* op, Time left, std::uint64_t stack, std::uint64_t executed);

enum class OperandKind : std::uint8_t {
  Memory,      ///< a value: direct, through a pointer, or a constant, as the rule allows
  Label,       ///< a number that is part of the instruction: LBL, JMP
  Subroutine,  ///< SBR, CALL
  Interrupt,   ///< INT, ATCH
  Event,       ///< ATCH, DTCH
  Port,        ///< XMT, RCV
  Counter,     ///< HDEF, HSC
  StackLevel,  ///< a level of the logic stack, 0 on top: LDS
  Number,      ///< any other number that is part of the instruction, from 0 to max: NOP
};

enum class Role : std::uint8_t { In, Out, InOut };

/// The way in which an instruction reads a number. Either: the result has the same bits both ways.
enum class Sign : std::uint8_t { Either, Signed, Unsigned };

/// The kinds of timers that an operand may name (facts 1.1).
enum class TimerKind : std::uint8_t { Any, OnDelay, OffDelay, Retentive };

struct OperandRule {
  std::string_view name{};  ///< as the manual calls it: IN, OUT, N, TBL
  OperandKind kind = OperandKind::Memory;
  Width width = Width::Byte;
  Role role = Role::In;
  Areas areas = 0;  ///< that may be named directly
  bool constant = false;
  bool pointer = false;     ///< *VD100, *AC1
  bool address_of = false;  ///< &VB100
  bool real = false;        ///< the value is a real number
  bool text = false;        ///< a string: the address of its length byte, or a constant in double quotes
  Sign sign = Sign::Either;
  std::int64_t min = std::numeric_limits<std::int64_t>::min();  ///< of a constant, within its width
  std::int64_t max = std::numeric_limits<std::int64_t>::max();
  std::int64_t usual_from = std::numeric_limits<std::int64_t>::min();  ///< a constant below it runs, but is probably a slip
  bool not_zero = false;                                               ///< a constant between min and max, but not 0
  bool count = false;         ///< this operand says how far the counted operands reach
  std::uint8_t counted = 0;   ///< how many counted things fit in an element; 0: the operand is not counted
  std::uint8_t elements = 1;  ///< of an operand that is not counted: the fewest it takes
  std::uint16_t most = 0;     ///< bytes it reaches at most, if the memory there says how far: a table, a message, a string
  TimerKind timer = TimerKind::Any;

  std::int64_t usual_min() const { return std::max(min, usual_from); }
  bool takes(std::int64_t value) const { return value >= min && value <= max && !(not_zero && value == 0); }
  /// Elements from the address, if the operand that counts says `n`.
  std::int64_t reach(std::int64_t n) const { return counted == 0 ? elements : (n + counted - 1) / counted; }

  bool operator==(const OperandRule&) const = default;
};

/// The parts of a program in which an instruction may be used.
enum Part : std::uint8_t { kMain = 1, kSubroutine = 2, kInterrupt = 4, kAnywhere = 7 };

struct Allowed {
  constexpr Allowed(std::uint8_t in = kAnywhere, CpuSet anywhere = 0) : parts(in), anywhere_on(anywhere) {}

  std::uint8_t parts;  ///< Parts
  CpuSet anywhere_on;  ///< CPUs that allow it in any part

  constexpr std::uint8_t on(CpuSet cpu) const { return anywhere_on & cpu ? std::uint8_t{kAnywhere} : parts; }
  bool operator==(const Allowed&) const = default;
};

/// The meaning of an instruction for the structure of the program.
enum class Structure : std::uint8_t {
  None,
  Label,
  Jump,
  For,
  Next,
  Call,
  SubroutineHead,
  InterruptHead,
  MainEnd,
  SubroutineEnd,
  InterruptEnd,
  Attach,
  SegmentBegin,
  SegmentTransition,
  SegmentExit,  ///< CSCRE
  SegmentEnd,
  DefineCounter,
  Compare  ///< its errors stop the CPU
};

/// Whether it is the head of a routine: SBR or INT.
constexpr bool begins_routine(Structure structure) {
  return structure == Structure::SubroutineHead || structure == Structure::InterruptHead;
}

/// The analyses (interpreter/analysis/) look for these effects.
enum class Effect : std::uint8_t {
  None,
  LoadsBit,  ///< LD
  Coil,
  SetsBits,
  ResetsBits,      ///< R: and the current values of timers and counters
  ConditionalEnd,  ///< of a routine or of the scan
  EnablesInterrupts,
  Transmits,
  Receives,
  SetsStation,        ///< SPA
  ProgramsCounter,    ///< HSC
  ProgramsPulses,     ///< PLS
  CopiesByte,         ///< MOVB
  ReadsEno,           ///< AENO
  ReadsTimeOfDay,     ///< TODR
  ReadsMilliseconds,  ///< BITIM, CITIM
};

/// The operand that the decoder adds to those of an instruction.
enum class Hidden : std::uint8_t {
  None,
  InputPoint,     ///< operand 0 is the input point instead of its image
  OutputPoint,    ///< operand 2: the output point of operand 0
  RisingMemory,   ///< operand 2: a memory bit of its own; 1 at power-up
  FallingMemory,  ///< operand 2: a memory bit of its own; 0 at power-up
  LoopMemory,     ///< operand 2: a memory bit of its own; 1 at each change to RUN
  Number,         ///< operand 2: number of the timer or counter that is operand 0
  SegmentBit,     ///< operand 2: the S bit of the enclosing LSCR
};

/// The levels that an instruction needs on the logic stack, and how many more it leaves there.
struct StackUse {
  std::int8_t needs = 0;
  std::int8_t change = 0;

  bool operator==(const StackUse&) const = default;
};

/// The conditions, besides missing power flow, under which the ENO output of a box becomes 0 (facts 10.7).
enum class Eno : std::uint8_t {
  None,           ///< it is not a box with an ENO output
  Errors,         ///< a run-time error
  ErrorsAndFlags  ///< a run-time error, or a flag of SM1 that says that the box has failed
};

/// The part of an instruction in a rung, as a contact, a coil or a box.
struct Rung {
  bool needs_power_flow = false;  ///< skipped while the top of the logic stack is 0
  StackUse stack{};
  bool writes_output = false;  ///< a coil or box: an LD after it begins a new rung
  Eno eno = Eno::None;

  bool operator==(const Rung&) const = default;
};

/// The way in which a contact combines with what is on the logic stack: LD, A, O.
enum class Join : std::uint8_t { Load, And, Or };
inline constexpr std::size_t kJoins = 3;

/// The part of a contact or a coil in a chain, which is executed in one go (program/checking/chains.hpp). A part always
/// takes its op's `cost`: it needs no power flow and has no time per unit. It has no `target` of its own: link() puts its
/// Contact there.
struct ChainPart {
  enum class Kind : std::uint8_t { None, Contact, Coil };

  Kind kind = Kind::None;
  Join join = Join::Load;
  bool inverted = false;  ///< LDN, AN, ON
};

/// Bytes of the image that an instruction reads or writes besides its operands, at most.
struct Besides {
  std::uint32_t at = 0;
  std::uint32_t bytes = 0;  ///< 0: nothing
  Role role = Role::In;

  bool operator==(const Besides&) const = default;
};

/// The functions that execute an instruction.
struct Bodies {
  constexpr Bodies() = default;
  constexpr Bodies(Body everywhere, Body fed_by_segment = nullptr, Link in_link = nullptr, ChainPart in_chain = {})
      : usual(everywhere), in_segment(fed_by_segment), link(in_link), part(in_chain) {}

  Body usual = nullptr;       ///< null: not modelled, refused by name
  Body in_segment = nullptr;  ///< between LSCR and SCRE, if different: a contact on the segment's power rail
  Link link = nullptr;        ///< a faster way to do what `usual` does; null: there is none
  ChainPart part{};
};

/// A row of the table, in the order of its columns. What a row leaves out is as it stands here.
struct Instruction {
  std::string_view mnemonic{};
  std::string_view group{};              ///< heading in the documentation
  std::array<OperandRule, 3> operand{};  ///< those that it takes, the first one first; the rest have no name
  Rung rung{};
  std::uint8_t flags = 0;  ///< SM1 bits that it sets and resets
  CpuSet cpus = kEveryCpu;
  Allowed allowed{};
  bool outside_segments = false;  ///< not allowed between LSCR and SCRE
  Structure structure = Structure::None;
  Hidden hidden = Hidden::None;
  Effect effect = Effect::None;
  std::array<Besides, 5> besides{};
  Bodies body{};
  std::string_view meaning{};       ///< one line
  std::string_view not_modelled{};  ///< of one without a body: why, and what to write instead

  constexpr bool modelled() const { return body.usual != nullptr; }

  constexpr std::span<const OperandRule> rules() const {
    std::size_t named = 0;
    while (named < operand.size() && !operand[named].name.empty()) ++named;
    return {operand.data(), named};
  }
};

/// The table, in the order of the manual's groups.
std::span<const Instruction> all_instructions();

inline constexpr std::size_t kMostContacts = 4, kMostCoils = 2;  ///< of a chain

/// The link of a chain: up to kMostContacts contacts, joined as the digits of `joins` say, the first contact's the lowest;
/// and up to kMostCoils coils that end it.
Link link_of_chain(std::size_t contacts, std::size_t joins, std::size_t coils);
/// The link of any op: calls its body. Null in builds without tail calls.
Link link_of_any();
/// The link of an op with a step around its body, quicker for frequent ones.
Link link_of_step(Body step);

/// Returns null for an unknown mnemonic (upper case).
const Instruction* find_instruction(std::string_view mnemonic);

/// The instruction that a mnemonic of the German set means (upper case): U, UN, UW>=, ULD. Null for any other.
///
/// Only the pattern is documented, U for the A of the AND instructions; other German mnemonics are refused by name.
const Instruction* find_german_instruction(std::string_view mnemonic);

/// Advice about a mnemonic that the table does not have.
struct UnknownMnemonic {
  std::string what;  ///< of the German set or of another controller family: "a German mnemonic"; empty otherwise
  std::string hint;  ///< what to write instead, or what was probably meant; empty if none is close
};

/// A mnemonic (upper case) of the German set or of another controller family; nothing for any other word.
std::optional<UnknownMnemonic> mnemonic_of_others(std::string_view mnemonic);

/// The mnemonic is in upper case.
UnknownMnemonic unknown_mnemonic(std::string_view mnemonic);

/// The syntax of an instruction: `MOVW IN, OUT`
std::string syntax(const Instruction& instruction);

}  // namespace s7200
