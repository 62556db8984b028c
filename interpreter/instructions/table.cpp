// THE table: all that is true of each instruction, once. See instruction.hpp for the columns and README.md for how to add
// one.
//
// Sources: facts 6 (operand areas there are inferred from the manuals' operand lists), 3.5 (what may stand in interrupt
// routines), 6.13 (which CPU has what).
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "interpreter/instructions/bit_logic.hpp"
#include "interpreter/instructions/compare.hpp"
#include "interpreter/instructions/control.hpp"
#include "interpreter/instructions/conversion.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/instructions/math.hpp"
#include "interpreter/instructions/move.hpp"
#include "interpreter/instructions/peripherals.hpp"
#include "interpreter/instructions/real_math.hpp"
#include "interpreter/instructions/shift.hpp"
#include "interpreter/instructions/tables.hpp"
#include "interpreter/instructions/timer_counter.hpp"

namespace s7200 {
namespace {

using namespace bodies;

// --- operands ---

template <class... Area_>
constexpr Areas areas(Area_... area) {
  return static_cast<Areas>((set_of(area) | ...));
}

constexpr Areas kBits = areas(Area::I, Area::Q, Area::M, Area::SM, Area::T, Area::C, Area::V, Area::S);
constexpr Areas kBytes = areas(Area::V, Area::I, Area::Q, Area::M, Area::SM, Area::S);
constexpr Areas kWords = kBytes | areas(Area::T, Area::C);

constexpr OperandRule bit_in(Areas from = kBits) { return {.name = "BIT", .width = Width::Bit, .areas = from}; }
constexpr OperandRule bit_in_named(std::string_view name) {
  OperandRule rule = bit_in();
  rule.name = name;
  return rule;
}
constexpr OperandRule bit_out(Areas to = kBits) {
  return {.name = "BIT", .width = Width::Bit, .role = Role::Out, .areas = to};
}

constexpr Areas readable(Width width) {
  switch (width) {
    case Width::Word:
      return kWords | areas(Area::AC, Area::AI);
    case Width::Double:
      return kBytes | areas(Area::AC, Area::HC);
    default:
      return kBytes | areas(Area::AC);
  }
}
constexpr Areas writable(Width width) {
  return static_cast<Areas>((width == Width::Word ? kWords : kBytes) | areas(Area::AC));
}

constexpr OperandRule in(Width width, std::string_view name = "IN") {
  return {.name = name, .width = width, .areas = readable(width), .constant = true, .pointer = true};
}
constexpr OperandRule out(Width width, std::string_view name = "OUT") {
  return {.name = name, .width = width, .role = Role::Out, .areas = writable(width), .pointer = true};
}
/// The second operand of two-operand arithmetic: source and destination.
constexpr OperandRule in_out(Width width, std::string_view name = "OUT") {
  OperandRule rule = out(width, name);
  rule.role = Role::InOut;
  return rule;
}
constexpr OperandRule real(OperandRule rule) {
  rule.real = true;
  rule.areas &= static_cast<Areas>(~areas(Area::HC));
  return rule;
}
constexpr OperandRule with_analog_output(OperandRule rule) {
  rule.areas |= areas(Area::AQ);
  return rule;
}
/// So many elements as the instruction's count says; `counted` of what it counts lie in one.
constexpr OperandRule block(Role role, Width width, std::string_view name, std::uint8_t counted = 1) {
  const Areas analog = role == Role::In ? areas(Area::AI) : areas(Area::AQ);
  return {.name = name,
          .width = width,
          .role = role,
          .areas = static_cast<Areas>(width == Width::Word ? kWords | analog : kBytes),
          .pointer = true,
          .counted = counted};
}
/// S, R, SHRB: N bits from here on.
constexpr OperandRule bits_from(std::string_view name = "BIT", Areas to = kBits) {
  OperandRule rule = bit_out(to);
  rule.name = name;
  rule.counted = 1;
  return rule;
}
/// At least so many elements from here on, whatever they hold.
constexpr OperandRule from(OperandRule first, std::uint8_t elements) {
  first.elements = elements;
  return first;
}
constexpr OperandRule ranged(OperandRule rule, Sign sign, std::int64_t min, std::int64_t max) {
  rule.sign = sign;
  rule.min = min;
  rule.max = max;
  return rule;
}
constexpr OperandRule as_signed(OperandRule rule) {
  rule.sign = Sign::Signed;
  return rule;
}
/// How many elements the blocks of the instruction have: an unsigned byte.
constexpr OperandRule count(std::int64_t min = 1, std::string_view name = "N") {
  OperandRule rule = ranged(in(Width::Byte, name), Sign::Unsigned, min, 255);
  rule.count = true;
  return rule;
}
/// By how many places to shift: an unsigned byte. More than the width is no mistake, it stops there or is taken modulo it.
constexpr OperandRule kPlaces = ranged(in(Width::Byte, "N"), Sign::Unsigned, 0, 255);
/// SHRB: the sign is the direction, and 0 bits are count error 0092.
constexpr OperandRule directed_count() {
  OperandRule rule = ranged(in(Width::Byte, "N"), Sign::Signed, -64, 64);
  rule.not_zero = true;
  rule.count = true;
  return rule;
}
/// What timers and CTU count up to: a signed word, and they count from 0.
constexpr OperandRule preset(std::string_view name) { return ranged(in(Width::Word, name), Sign::Signed, 1, 32767); }
constexpr OperandRule number(OperandKind kind, std::string_view name, std::int64_t max = 255) {
  return {.name = name, .kind = kind, .constant = true, .min = 0, .max = max};
}

constexpr OperandRule kLabel = number(OperandKind::Label, "n");
constexpr OperandRule kSubroutineNumber = number(OperandKind::Subroutine, "n");
constexpr OperandRule kRoutine = number(OperandKind::Interrupt, "INT");
constexpr OperandRule kEvent = number(OperandKind::Event, "EVNT");
constexpr OperandRule kPort = number(OperandKind::Port, "PORT");

// --- rows ---

/// A row under construction; `|` joins what differs from the plain form.
struct Row : Instruction {};

Row row(std::string_view mnemonic, std::initializer_list<OperandRule> rules, Body body, std::string_view meaning) {
  Row r;
  r.mnemonic = mnemonic;
  std::copy(rules.begin(), rules.end(), r.operand.begin());
  r.operands = static_cast<std::uint8_t>(rules.size());
  r.body = body;
  r.meaning = meaning;
  return r;
}

/// Runs with power flow only and leaves the logic stack as it is.
Row box(std::string_view mnemonic, std::initializer_list<OperandRule> rules, Body body, std::string_view meaning,
        std::uint8_t flags = 0) {
  Row r = row(mnemonic, rules, body, meaning);
  r.needs_power_flow = true;
  r.stack = {1, 0};
  r.writes_output = true;
  r.flags = flags;
  return r;
}

/// Runs on every pass and uses the top of the stack.
Row uses_stack(std::string_view mnemonic, std::initializer_list<OperandRule> rules, Body body, StackUse stack,
               std::string_view meaning) {
  Row r = row(mnemonic, rules, body, meaning);
  r.stack = stack;
  return r;
}

Row on(CpuSet cpus, Row r) {
  r.cpus = cpus;
  return r;
}
Row only_in(std::uint8_t parts, Row r) {
  r.allowed = parts;
  return r;
}
/// `body` is what runs between LSCR and SCRE.
Row in_segments(Body body, Row r) {
  r.in_segment = body;
  return r;
}
Row outside_segments(Row r) {
  r.outside_segments = true;
  return r;
}
Row marks(Structure structure, Row r) {
  r.structure = structure;
  r.writes_output = true;
  return r;
}
Row has(Effect effect, Row r) {
  r.effect = effect;
  return r;
}
Row with(Hidden hidden, Row r) {
  r.hidden = hidden;
  return r;
}
Row writes(Row r) {
  r.writes_output = true;
  return r;
}
Row not_modelled(std::string_view mnemonic, CpuSet cpus, std::string_view meaning) {
  return on(cpus, row(mnemonic, {}, nullptr, meaning));
}

class Table {
 public:
  Table() {
    bit_logic();
    compares();
    moves();
    integer_math();
    byte_math();
    logic();
    shifts();
    program_control();
    interrupts();
    communication();
    timers_and_counters();
    real_math();
    conversions();
    tables();
    sequence();
    peripherals();
    later();
  }

  const std::vector<Instruction>& rows() const { return rows_; }

 private:
  void group(std::string_view name) { group_ = name; }
  void add(Row r) {
    r.group = group_;
    rows_.push_back(r);
  }

  template <Join join>
  void contacts(std::string_view plain, std::string_view negated, std::string_view point, std::string_view negated_point,
                StackUse stack, std::string_view verb) {
    const auto text = [&](std::string_view what) -> std::string_view {
      return texts_.emplace(std::string(verb) + std::string(what)).first->c_str();
    };
    const auto contact_row = [&](std::string_view mnemonic, OperandRule rule, Body body, Body in_segment,
                                 std::string_view what) {
      return in_segments(in_segment, uses_stack(mnemonic, {rule}, body, stack, text(what)));
    };
    constexpr Body straight = contact<join, false>, straight_fed = contact<join, false, Rail::Segment>;
    constexpr Body inverted = contact<join, true>, inverted_fed = contact<join, true, Rail::Segment>;
    const OperandRule input = bit_in(areas(Area::I));
    Row direct = contact_row(plain, bit_in(), straight, straight_fed, " BIT");
    add(join == Join::Load ? has(Effect::LoadsBit, direct) : direct);
    add(contact_row(negated, bit_in(), inverted, inverted_fed, " NOT BIT"));
    add(with(Hidden::InputPoint, contact_row(point, input, straight, straight_fed, " the input point BIT")));
    add(with(Hidden::InputPoint, contact_row(negated_point, input, inverted, inverted_fed, " NOT the input point BIT")));
  }

  void bit_logic() {
    group("Bit logic");
    contacts<Join::Load>("LD", "LDN", "LDI", "LDNI", {0, 1}, "push");
    contacts<Join::And>("A", "AN", "AI", "ANI", {1, 0}, "top of stack AND");
    contacts<Join::Or>("O", "ON", "OI", "ONI", {1, 0}, "top of stack OR");
    add(uses_stack("NOT", {}, invert_top, {1, 0}, "invert the top of the stack"));
    add(with(Hidden::RisingMemory,
             uses_stack("EU", {}, edge<true>, {1, 0}, "1 for one execution when the top of the stack went from 0 to 1")));
    add(with(Hidden::FallingMemory,
             uses_stack("ED", {}, edge<false>, {1, 0}, "1 for one execution when the top of the stack went from 1 to 0")));
    add(uses_stack("ALD", {}, combine_loads<Join::And>, {2, -1}, "AND the two upper levels into one"));
    add(uses_stack("OLD", {}, combine_loads<Join::Or>, {2, -1}, "OR the two upper levels into one"));
    add(uses_stack("LPS", {}, push_copy, {1, 1}, "push a copy of the top of the stack"));
    add(uses_stack("LRD", {}, read_second, {2, 0}, "copy the second level to the top"));
    add(uses_stack("LPP", {}, pop_stack, {2, -1}, "pop the stack"));
    add(has(Effect::Coil, writes(uses_stack("=", {bit_out()}, coil, {1, 0}, "write the top of the stack to BIT"))));
    add(with(Hidden::OutputPoint, writes(uses_stack("=I", {bit_out(areas(Area::Q))}, immediate_coil, {1, 0},
                                                    "write the top of the stack to the output point and its image"))));
    add(has(Effect::SetsBits, box("S", {bits_from(), count()}, set_bits<true, false>, "set N bits from BIT on")));
    add(box("R", {bits_from(), count()}, set_bits<false, false>,
            "reset N bits from BIT on; of timers and counters the current values too"));
    add(with(Hidden::OutputPoint, box("SI", {bits_from("BIT", areas(Area::Q)), count()}, set_bits<true, true>,
                                      "set N output points and their image")));
    add(with(Hidden::OutputPoint, box("RI", {bits_from("BIT", areas(Area::Q)), count()}, set_bits<false, true>,
                                      "reset N output points and their image")));
    add(row("NOP", {number(OperandKind::Number, "n")}, no_operation, "nothing"));
  }

  template <Relation relation>
  void compares_of(std::string_view sign, CpuSet cpus) {
    // Whether two numbers are equal does not depend on how their bits are read.
    constexpr bool equality = relation == Relation::Equal || relation == Relation::NotEqual;
    const auto ordered = [](OperandRule rule, Sign read_as) {
      rule.sign = equality ? Sign::Either : read_as;
      return rule;
    };
    compare_row<relation, std::uint8_t>(sign, "B", ordered(in(Width::Byte), Sign::Unsigned), cpus, "unsigned bytes");
    compare_row<relation, std::int16_t>(sign, "W", ordered(in(Width::Word), Sign::Signed), cpus, "signed words");
    compare_row<relation, std::int32_t>(sign, "D", ordered(in(Width::Double), Sign::Signed), cpus, "signed double words");
    compare_row<relation, float>(sign, "R", real(in(Width::Double)), cpus & kFrom214, "real numbers");
  }

  template <Relation relation, class Value>
  void compare_row(std::string_view sign, std::string_view type, OperandRule a, CpuSet cpus, std::string_view what) {
    OperandRule b = a;
    a.name = "IN1";
    b.name = "IN2";
    const auto one = [&](std::string_view prefix, Body body, Body in_segment, StackUse stack, std::string_view verb) {
      const auto keep = [&](std::string text) -> std::string_view { return *texts_.insert(std::move(text)).first; };
      const std::string_view mnemonic = keep(std::string(prefix).append(type).append(sign));
      Row r = uses_stack(mnemonic, {a, b}, body, stack,
                         keep(std::string(verb).append(" IN1 ").append(sign).append(" IN2, ").append(what)));
      r.structure = Structure::Compare;
      add(on(cpus, in_segments(in_segment, r)));
    };
    one("LD", compare<Join::Load, relation, Value>, compare<Join::Load, relation, Value, Rail::Segment>, {0, 1}, "push");
    one("A", compare<Join::And, relation, Value>, compare<Join::And, relation, Value, Rail::Segment>, {1, 0},
        "top of stack AND");
    one("O", compare<Join::Or, relation, Value>, compare<Join::Or, relation, Value, Rail::Segment>, {1, 0},
        "top of stack OR");
  }

  void compares() {
    group("Compare contacts");
    compares_of<Relation::Equal>("=", kEveryCpu);
    compares_of<Relation::GreaterEqual>(">=", kEveryCpu);
    compares_of<Relation::LessEqual>("<=", kEveryCpu);
    compares_of<Relation::NotEqual>("<>", kCpu22x);
    compares_of<Relation::Greater>(">", kCpu22x);
    compares_of<Relation::Less>("<", kCpu22x);
  }

  void moves() {
    group("Move");
    OperandRule any_double = in(Width::Double);
    any_double.address_of = true;
    add(box("MOVB", {in(Width::Byte), out(Width::Byte)}, move<std::uint8_t>, "copy byte IN to OUT"));
    add(box("MOVW", {in(Width::Word), with_analog_output(out(Width::Word))}, move<std::uint16_t>, "copy word IN to OUT"));
    add(box("MOVD", {any_double, out(Width::Double)}, move<std::uint32_t>, "copy double word IN to OUT"));
    add(on(kFrom214,
           box("MOVR", {real(in(Width::Double)), real(out(Width::Double))}, move<std::uint32_t>, "copy real IN to OUT")));
    add(box("BMB", {block(Role::In, Width::Byte, "IN"), block(Role::Out, Width::Byte, "OUT"), count()},
            move_block<std::uint8_t>, "copy N bytes from IN on to OUT on"));
    add(box("BMW", {block(Role::In, Width::Word, "IN"), block(Role::Out, Width::Word, "OUT"), count()},
            move_block<std::uint16_t>, "copy N words from IN on to OUT on"));
    add(on(kFrom215, box("BMD", {block(Role::In, Width::Double, "IN"), block(Role::Out, Width::Double, "OUT"), count()},
                         move_block<std::uint32_t>, "copy N double words from IN on to OUT on")));
    add(box("FILL", {in(Width::Word), block(Role::Out, Width::Word, "OUT"), count()}, fill,
            "write word IN to N words from OUT on"));
    add(box("SWAP", {in_out(Width::Word, "IN")}, swap_bytes, "exchange the two bytes of a word"));
  }

  void integer_math() {
    group("Integer arithmetic");
    add(box("+I", {in(Width::Word, "IN1"), in_out(Width::Word)}, add_body<std::int16_t>(), "OUT + IN1 to OUT, 16 bits",
            kArithmetic));
    add(box("-I", {in(Width::Word, "IN1"), in_out(Width::Word)}, subtract<std::int16_t>, "OUT - IN1 to OUT, 16 bits",
            kArithmetic));
    add(box("+D", {in(Width::Double, "IN1"), in_out(Width::Double)}, add_body<std::int32_t>(), "OUT + IN1 to OUT, 32 bits",
            kArithmetic));
    add(box("-D", {in(Width::Double, "IN1"), in_out(Width::Double)}, subtract<std::int32_t>, "OUT - IN1 to OUT, 32 bits",
            kArithmetic));
    add(box("MUL", {as_signed(in(Width::Word, "IN1")), in_out(Width::Double)}, multiply,
            "IN1 × low word of OUT to OUT, 32 bits", kArithmetic | kDivisionByZero));
    add(box("DIV", {as_signed(in(Width::Word, "IN1")), in_out(Width::Double)}, divide,
            "low word of OUT / IN1: quotient to its low word, remainder to its high word", kArithmetic | kDivisionByZero));
    add(box("INCW", {in_out(Width::Word)}, increment<std::int16_t, 1>, "OUT + 1 to OUT, 16 bits", kArithmetic));
    add(box("DECW", {in_out(Width::Word)}, increment<std::int16_t, -1>, "OUT - 1 to OUT, 16 bits", kArithmetic));
    add(box("INCD", {in_out(Width::Double)}, increment<std::int32_t, 1>, "OUT + 1 to OUT, 32 bits", kArithmetic));
    add(box("DECD", {in_out(Width::Double)}, increment<std::int32_t, -1>, "OUT - 1 to OUT, 32 bits", kArithmetic));
  }
  void byte_math() {
    add(on(kFrom215,
           box("INCB", {in_out(Width::Byte)}, increment_byte<1>, "OUT + 1 to OUT, unsigned byte", kZero | kOverflow)));
    add(on(kFrom215,
           box("DECB", {in_out(Width::Byte)}, increment_byte<-1>, "OUT - 1 to OUT, unsigned byte", kZero | kOverflow)));
  }
  template <class Signed>
  static Body add_body() {
    return bodies::add<Signed>;
  }

  void logic() {
    group("Logic operations");
    add(box("ANDW", {in(Width::Word, "IN1"), in_out(Width::Word)}, combine_words<Logic::And, std::uint16_t>,
            "OUT AND IN1 to OUT", kZero));
    add(box("ORW", {in(Width::Word, "IN1"), in_out(Width::Word)}, combine_words<Logic::Or, std::uint16_t>,
            "OUT OR IN1 to OUT", kZero));
    add(box("XORW", {in(Width::Word, "IN1"), in_out(Width::Word)}, combine_words<Logic::Xor, std::uint16_t>,
            "OUT XOR IN1 to OUT", kZero));
    add(box("INVW", {in_out(Width::Word)}, invert<std::uint16_t>, "NOT OUT to OUT", kZero));
    add(box("ANDD", {in(Width::Double, "IN1"), in_out(Width::Double)}, combine_words<Logic::And, std::uint32_t>,
            "OUT AND IN1 to OUT", kZero));
    add(box("ORD", {in(Width::Double, "IN1"), in_out(Width::Double)}, combine_words<Logic::Or, std::uint32_t>,
            "OUT OR IN1 to OUT", kZero));
    add(box("XORD", {in(Width::Double, "IN1"), in_out(Width::Double)}, combine_words<Logic::Xor, std::uint32_t>,
            "OUT XOR IN1 to OUT", kZero));
    add(box("INVD", {in_out(Width::Double)}, invert<std::uint32_t>, "NOT OUT to OUT", kZero));
    const auto from_215 = [&](Row r) { add(on(kFrom215, r)); };
    from_215(box("ANDB", {in(Width::Byte, "IN1"), in_out(Width::Byte)}, combine_words<Logic::And, std::uint8_t>,
                 "OUT AND IN1 to OUT", kZero));
    from_215(box("ORB", {in(Width::Byte, "IN1"), in_out(Width::Byte)}, combine_words<Logic::Or, std::uint8_t>,
                 "OUT OR IN1 to OUT", kZero));
    from_215(box("XORB", {in(Width::Byte, "IN1"), in_out(Width::Byte)}, combine_words<Logic::Xor, std::uint8_t>,
                 "OUT XOR IN1 to OUT", kZero));
    from_215(box("INVB", {in_out(Width::Byte)}, invert<std::uint8_t>, "NOT OUT to OUT", kZero));
  }

  void shifts() {
    group("Shift and rotate");
    add(box("SLW", {in_out(Width::Word), kPlaces}, shift<std::uint16_t, true>, "shift OUT left by N, at most 16",
            kZero | kOverflow));
    add(box("SRW", {in_out(Width::Word), kPlaces}, shift<std::uint16_t, false>, "shift OUT right by N, at most 16",
            kZero | kOverflow));
    add(box("SLD", {in_out(Width::Double), kPlaces}, shift<std::uint32_t, true>, "shift OUT left by N, at most 32",
            kZero | kOverflow));
    add(box("SRD", {in_out(Width::Double), kPlaces}, shift<std::uint32_t, false>, "shift OUT right by N, at most 32",
            kZero | kOverflow));
    add(box("RLW", {in_out(Width::Word), kPlaces}, rotate<std::uint16_t, true>, "rotate OUT left by N modulo 16",
            kZero | kOverflow));
    add(box("RRW", {in_out(Width::Word), kPlaces}, rotate<std::uint16_t, false>, "rotate OUT right by N modulo 16",
            kZero | kOverflow));
    add(box("RLD", {in_out(Width::Double), kPlaces}, rotate<std::uint32_t, true>, "rotate OUT left by N modulo 32",
            kZero | kOverflow));
    const auto from_215 = [&](Row r) { add(on(kFrom215, r)); };
    from_215(box("SLB", {in_out(Width::Byte), kPlaces}, shift<std::uint8_t, true>, "shift OUT left by N, at most 8",
                 kZero | kOverflow));
    from_215(box("SRB", {in_out(Width::Byte), kPlaces}, shift<std::uint8_t, false>, "shift OUT right by N, at most 8",
                 kZero | kOverflow));
    from_215(box("RLB", {in_out(Width::Byte), kPlaces}, rotate<std::uint8_t, true>, "rotate OUT left by N modulo 8",
                 kZero | kOverflow));
    from_215(box("RRB", {in_out(Width::Byte), kPlaces}, rotate<std::uint8_t, false>, "rotate OUT right by N modulo 8",
                 kZero | kOverflow));
    add(box("SHRB", {bit_in_named("DATA"), bits_from("S_BIT"), directed_count()}, shift_register,
            "shift DATA into the |N| bits from S_BIT on; N < 0: from the far end", kOverflow));
    add(box("RRD", {in_out(Width::Double), kPlaces}, rotate<std::uint32_t, false>, "rotate OUT right by N modulo 32",
            kZero | kOverflow));
  }

  void program_control() {
    group("Program control");
    constexpr std::uint8_t not_in_interrupt = kMain | kSubroutine;
    add(outside_segments(marks(Structure::Jump, box("JMP", {kLabel}, jump, "go on at LBL n of the same routine"))));
    add(marks(Structure::Label, row("LBL", {kLabel}, no_operation, "place that JMP n goes to")));
    add(on(kFrom214, only_in(not_in_interrupt,
                             outside_segments(marks(Structure::For,
                                                    box("FOR",
                                                        {out(Width::Word, "INDX"), as_signed(in(Width::Word, "INIT")),
                                                         as_signed(in(Width::Word, "FINAL"))},
                                                        begin_loop, "repeat up to NEXT with INDX from INIT to FINAL"))))));
    add(on(kFrom214,
           only_in(not_in_interrupt,
                   outside_segments(marks(Structure::Next, row("NEXT", {}, next_pass,
                                                               "end of a FOR loop; leaves the top of the stack at 1"))))));
    add(only_in(not_in_interrupt,
                marks(Structure::Call, box("CALL", {kSubroutineNumber}, bodies::call, "call subroutine n"))));
    add(marks(Structure::SubroutineHead, row("SBR", {kSubroutineNumber}, no_operation, "head of subroutine n")));
    add(only_in(kSubroutine,
                marks(Structure::SubroutineEnd, row("RET", {}, return_from_subroutine, "end of a subroutine"))));
    add(only_in(kSubroutine,
                has(Effect::ConditionalEnd, box("CRET", {}, return_from_subroutine, "return from a subroutine"))));
    add(only_in(kMain, outside_segments(has(Effect::ConditionalEnd,
                                            box("END", {}, end_main_program, "end the main program of this scan")))));
    add(only_in(kMain, marks(Structure::MainEnd, row("MEND", {}, end_main_program, "end of the main program"))));
    add(has(Effect::ConditionalEnd, box("STOP", {}, stop, "go to STOP")));
    add(box("WDR", {}, reset_watchdog, "restart the scan watchdog"));
  }

  void interrupts() {
    group("Interrupts");
    constexpr std::uint8_t not_in_interrupt = kMain | kSubroutine;
    add(marks(Structure::InterruptHead,
              row("INT", {number(OperandKind::Interrupt, "n")}, no_operation, "head of interrupt routine n")));
    add(only_in(kInterrupt,
                marks(Structure::InterruptEnd, row("RETI", {}, return_from_interrupt, "end of an interrupt routine"))));
    add(only_in(kInterrupt,
                has(Effect::ConditionalEnd, box("CRETI", {}, return_from_interrupt, "return from an interrupt routine"))));
    add(only_in(not_in_interrupt,
                has(Effect::EnablesInterrupts, box("ENI", {}, enable_interrupts<true>, "enable interrupts"))));
    add(only_in(not_in_interrupt,
                box("DISI", {}, enable_interrupts<false>, "disable interrupts: events wait in their queues")));
    add(marks(Structure::Attach, box("ATCH", {kRoutine, kEvent}, attach, "attach interrupt routine INT to event EVNT")));
    add(box("DTCH", {kEvent}, detach, "detach event EVNT: it is ignored"));
  }

  void communication() {
    group("Communication");
    OperandRule buffer{.name = "TBL", .areas = kBytes, .pointer = true};
    add(has(Effect::Transmits,
            box("XMT", {buffer, kPort}, transmit, "Freeport: send the characters of TBL, their number in its first byte")));
    add(not_modelled("RCV", kFrom215, "Freeport: receive a message"));
    add(not_modelled("NETR", kFrom214, "PPI master: read from another station"));
    add(not_modelled("NETW", kFrom214, "PPI master: write to another station"));
  }

  void timers_and_counters() {
    group("Timers and counters");
    const auto timer = [](TimerKind kind) {
      return OperandRule{.name = "T", .width = Width::Word, .role = Role::InOut, .areas = areas(Area::T), .timer = kind};
    };
    const OperandRule counter{.name = "C", .width = Width::Word, .role = Role::InOut, .areas = areas(Area::C)};
    add(with(Hidden::Number, writes(uses_stack("TON", {timer(TimerKind::OnDelay), preset("PT")}, time_on<false>, {1, 0},
                                               "on-delay timer: counts while the top of the stack is 1, else 0"))));
    add(with(Hidden::Number, writes(uses_stack("TONR", {timer(TimerKind::Retentive), preset("PT")}, time_on<true>, {1, 0},
                                               "retentive on-delay timer: keeps its value until it is reset"))));
    add(with(Hidden::Number, writes(uses_stack("CTU", {counter, preset("PV")}, count_up, {2, -1},
                                               "count up: second level counts, top resets"))));
    add(with(Hidden::Number, writes(uses_stack("CTUD", {counter, as_signed(in(Width::Word, "PV"))}, count_up_down, {3, -2},
                                               "count up and down: third level up, second down, top resets"))));
  }

  void real_math() {
    group("Real arithmetic");
    const OperandRule a = real(in(Width::Double, "IN1")), b = real(in_out(Width::Double));
    const auto from_214 = [&](Row r) { add(on(kFrom214, r)); };
    from_214(box("+R", {a, b}, real_arithmetic<RealOperation::Add>, "OUT + IN1 to OUT", kArithmetic));
    from_214(box("-R", {a, b}, real_arithmetic<RealOperation::Subtract>, "OUT - IN1 to OUT", kArithmetic));
    from_214(box("*R", {a, b}, real_arithmetic<RealOperation::Multiply>, "OUT * IN1 to OUT", kArithmetic));
    from_214(box("/R", {a, b}, real_divide, "OUT / IN1 to OUT", kArithmetic | kDivisionByZero));
    from_214(box("SQRT", {real(in(Width::Double)), real(out(Width::Double))}, square_root, "square root of IN to OUT",
                 kArithmetic));
  }

  void conversions() {
    group("Conversion");
    add(box("BCDI", {in_out(Width::Word)}, from_bcd, "four BCD digits to an integer", kNotBcd));
    add(box("IBCD", {in_out(Width::Word)}, to_bcd, "integer 0 to 9999 to BCD", kNotBcd));
    add(on(kFrom214,
           box("DTR", {as_signed(in(Width::Double)), real(out(Width::Double))}, integer_to_real, "double integer to real")));
    add(on(kFrom214, box("TRUNC", {real(in(Width::Double)), out(Width::Double)}, truncate,
                         "real to double integer, toward zero", kOverflow)));
    add(box("DECO", {in(Width::Byte), out(Width::Word)}, decode_bit,
            "set the one bit of OUT that the low half of IN numbers"));
    add(box("ENCO", {in(Width::Word), out(Width::Byte)}, encode_bit, "number of the lowest bit set in IN to OUT"));
    add(box("SEG", {in(Width::Byte), out(Width::Byte)}, seven_segments, "seven-segment pattern of the low half of IN"));
    add(box("ATH", {block(Role::In, Width::Byte, "IN"), block(Role::Out, Width::Byte, "OUT", 2), count(0, "LEN")},
            ascii_to_hex, "LEN characters to hexadecimal digits", kNotHex));
    add(box("HTA", {block(Role::In, Width::Byte, "IN", 2), block(Role::Out, Width::Byte, "OUT"), count(0, "LEN")},
            hex_to_ascii, "LEN hexadecimal digits to characters"));
  }

  void tables() {
    group("Tables");
    const OperandRule index = in_out(Width::Word, "INDX");
    // Its length, the number of its entries, and at least one of them; FND is given the number of entries on.
    const auto table = [](Role role, std::string_view name, std::uint8_t words = 3) {
      return OperandRule{
          .name = name, .width = Width::Word, .role = role, .areas = kWords, .pointer = true, .elements = words};
    };
    const auto from_214 = [&](Row r) { add(on(kFrom214, r)); };
    from_214(box("ATT", {in(Width::Word, "DATA"), table(Role::InOut, "TBL")}, add_to_table, "append DATA to the table",
                 kTableFull));
    from_214(box("FIFO", {table(Role::InOut, "TBL"), with_analog_output(out(Width::Word, "DATA"))}, take_from_table<true>,
                 "take the first entry out of the table", kTableEmpty));
    from_214(box("LIFO", {table(Role::InOut, "TBL"), with_analog_output(out(Width::Word, "DATA"))}, take_from_table<false>,
                 "take the last entry out of the table", kTableEmpty));
    const OperandRule pattern = in(Width::Word, "PATRN");
    const auto find = [&](std::string_view mnemonic, const OperandRule& what, Body body, std::string_view meaning) {
      from_214(box(mnemonic, {table(Role::In, "SRC", 1), what, index}, body, meaning));
    };
    find("FND=", pattern, find_in_table<Relation::Equal>, "number of the next entry equal to PATRN, from INDX on");
    find("FND<>", pattern, find_in_table<Relation::NotEqual>, "number of the next entry not equal to PATRN, from INDX on");
    find("FND<", as_signed(pattern), find_in_table<Relation::Less>,
         "number of the next entry less than PATRN, from INDX on");
    find("FND>", as_signed(pattern), find_in_table<Relation::Greater>,
         "number of the next entry greater than PATRN, from INDX on");
  }

  void sequence() {
    group("Sequence control relays");
    constexpr std::uint8_t not_in_interrupt = kMain | kSubroutine;
    const OperandRule s_in = bit_in(areas(Area::S)), s_out = bit_out(areas(Area::S));
    add(only_in(not_in_interrupt, marks(Structure::SegmentBegin,
                                        uses_stack("LSCR", {s_in}, begin_segment, {0, 1},
                                                   "start of a segment whose contacts have power while the S bit is 1"))));
    add(only_in(not_in_interrupt,
                with(Hidden::SegmentBit, marks(Structure::SegmentTransition, box("SCRT", {s_out}, segment_transition,
                                                                                 "go over to the segment of the S bit")))));
    add(only_in(not_in_interrupt, marks(Structure::SegmentEnd, row("SCRE", {}, end_segment, "end of a segment"))));
  }

  void peripherals() {
    group("Clock, high-speed counters, pulse outputs");
    constexpr std::uint8_t not_in_interrupt = kMain | kSubroutine;
    const OperandRule buffer = from({.name = "T", .areas = kBytes, .pointer = true}, 8);
    OperandRule written = buffer;
    written.role = Role::Out;
    add(on(kFrom214, box("TODR", {written}, read_clock, "read the clock into the 8 bytes at T")));
    add(on(kFrom214, box("TODW", {buffer}, write_clock, "set the clock from the 8 bytes at T")));
    const OperandRule counter = number(OperandKind::Counter, "HSC");
    add(only_in(not_in_interrupt,
                marks(Structure::DefineCounter, box("HDEF", {counter, number(OperandKind::Number, "MODE", 11)},
                                                    define_counter, "give a high-speed counter its mode, once"))));
    add(box("HSC", {counter}, program_counter, "take over the counter's control byte, values and enable"));
    add(on(kFrom214,
           box("PLS", {number(OperandKind::Number, "X", 1)}, program_pulses, "start the pulse train or PWM of Q0.X")));
  }

  /// Known by name, so that a program that uses them is told so.
  void later() {
    group("Not modelled yet");
    add(not_modelled("PID", kFrom215, "PID loop"));
    for (const char* mnemonic :
         {"TOF", "CTD", "*I",  "/I",  "*D",   "/D",  "BTI", "ITB", "ITD", "DTI", "ROUND", "ITA", "DTA",
          "RTA", "BIR", "BIW", "LDS", "AENO", "SIN", "COS", "TAN", "LN",  "EXP", "GPA",   "SPA"})
      add(not_modelled(mnemonic, kCpu22x, ""));
  }

  std::vector<Instruction> rows_;
  std::set<std::string> texts_;  // mnemonics and meanings put together here; the rows refer to them
  std::string_view group_;
};

const Table& table() {
  static const Table kTable;
  return kTable;
}

}  // namespace

std::span<const Instruction> all_instructions() { return table().rows(); }

}  // namespace s7200
