#include "tests/reference_model/generator.hpp"

#include <bit>
#include <limits>
#include <set>

#include "interpreter/model/cpu_model.hpp"
#include "tests/reference_model/instructions.hpp"

namespace s7200::reference {
namespace {

// Where things are in V memory, so that instructions meet what they work on.
constexpr std::uint32_t kHot = 0, kHotSize = 64;
constexpr std::uint32_t kReals = 64, kRealsSize = 32;
constexpr std::uint32_t kPointers = 100, kPointerCount = 4;
constexpr std::uint32_t kDigits = 120, kDigitsSize = 32;
constexpr std::uint32_t kTables[] = {200, 260};
constexpr std::uint32_t kLocalPointers = 8;  // in L memory
constexpr std::uint32_t kStrings[] = {320, 340, 360};
constexpr std::uint32_t kEndSize = 12;  // at the end

/// Instructions that leave the program early: used rarely, or nothing after them would run.
bool is_rare(const s7200::Instruction& instruction) {
  static const std::set<std::string_view> kNames{"STOP", "END", "WDR", "ENI", "DISI", "ATCH", "DTCH"};
  return kNames.contains(instruction.mnemonic);
}

}  // namespace

/// What the generator may use anywhere in a rung: instructions that the reference model knows and that need no partner.
bool Generator::is_free(const s7200::Instruction& instruction) const {
  if (!instructions().contains(std::string(instruction.mnemonic)) || !(instruction.cpus & model_.self)) return false;
  const Structure s = instruction.structure;
  return s == Structure::None || s == Structure::Compare || s == Structure::Attach;
}

Generator::Generator(std::uint64_t seed, const CpuModel& model) : model_(model), random_(seed) {
  for (const auto& instruction : all_instructions())
    if (is_free(instruction)) (instruction.rung.writes_output ? outputs_ : logic_).push_back(&instruction);
}

// --- program ---

std::string Generator::program() {
  text_.clear();
  labels_ = 0;
  routine_ = 0;
  subroutines_ = below(4);
  body(kMain, 0);
  line("MEND");
  for (std::size_t i = 0; i < subroutines_; ++i) {
    line("SBR " + std::to_string(i));
    routine_ = i + 1;
    body(kSubroutine, 1);
    line("RET");
  }
  line("INT 0");
  line("RETI");
  return text_;
}

void Generator::body(std::uint8_t part, int level) {
  const std::size_t items = level == 0 ? 4 + below(12) : 1 + below(4);
  for (std::size_t i = 0; i < items; ++i) item(part, level);
}

void Generator::item(std::uint8_t part, int level) {
  const std::size_t kind = below(level < 3 ? 22 : 14);
  if (kind >= 19 && subroutines_ > 0)
    rung(part, "CALL " + std::to_string(below(subroutines_)));
  else if (kind < 14 && chance(6))
    timer_with_reset(part);
  else if (in_segment_)
    rung(part);
  else if (kind == 14 || kind == 15)
    loop(part, level);
  else if (kind == 16)
    jump_over(part, level);
  else if (kind == 17)
    jump_back(part, level);
  else if (kind == 18)
    segment(part, level);
  else
    rung(part);
}

/// A timer that counts in most scans, and an R that meets it now and then.
void Generator::timer_with_reset(std::uint8_t part) {
  const auto& instruction = *find_instruction(chance(50) ? "TON" : "TONR");
  const std::string name = timer(instruction.operand[0]);
  const auto reset = [&] {
    line(load());
    line("R " + name + ", " + std::to_string(1 + below(3)));
  };
  const bool before = chance(50);
  if (before) reset();
  line(chance(70) ? "LD SM0.0" : "LD I0." + std::to_string(below(8)));
  line(std::string(instruction.mnemonic) + " " + name + ", " + std::to_string(1 + below(20)));
  if (chance(50)) rung(part);
  if (!before) reset();
}

/// One or more contacts, logic, then boxes and coils; `last` ends the rung.
void Generator::rung(std::uint8_t part, const std::string& last) {
  int depth = 1;
  line(load());
  for (std::size_t i = below(5); i > 0;) {
    const auto& instruction = *one_of(logic_);
    const int after = depth + instruction.rung.stack.change;
    if (depth < instruction.rung.stack.needs || after < 1 || after > 9) continue;
    line(statement(instruction));
    depth = after;
    --i;
  }
  for (std::size_t i = last.empty() ? 1 + below(4) : below(3); i > 0;) {
    const auto& instruction = *one_of(outputs_);
    const bool unlikely = is_rare(instruction) && !chance(8);
    const bool allowed = (instruction.allowed.parts & part) && !(in_segment_ && instruction.outside_segments);
    if (unlikely || depth < instruction.rung.stack.needs || !allowed) continue;
    line(statement(instruction));
    depth += instruction.rung.stack.change;
    --i;
  }
  if (!last.empty()) line(last);
}

std::string Generator::load() {
  if (chance(55)) return "LD SM0.0";
  if (chance(10)) return "LDN SM0.0";
  while (true) {
    const auto& instruction = *one_of(logic_);
    if (instruction.rung.stack.needs == 0 && instruction.rung.stack.change == 1) return statement(instruction);
  }
}

void Generator::loop(std::uint8_t part, int level) {
  line(load());
  const auto& head = *find_instruction("FOR");
  if (chance(70)) {
    const auto from = static_cast<int>(below(5)) - 2;
    line("FOR " + operand(head.operand[0]) + ", " + std::to_string(from) + ", " +
         std::to_string(from + static_cast<int>(below(5)) - 1));
  } else {
    line(statement(head));
  }
  body(part, level + 1);
  line("NEXT");
}

void Generator::jump_over(std::uint8_t part, int level) {
  const std::string label = std::to_string(labels_++);
  rung(part, "JMP " + label);
  body(part, level + 1);
  line("LBL " + label);
}

void Generator::jump_back(std::uint8_t part, int level) {
  const std::string label = std::to_string(labels_++);
  line("LBL " + label);
  body(part, level + 1);
  rung(part, "JMP " + label);
}

void Generator::segment(std::uint8_t part, int level) {
  in_segment_ = true;
  line("LSCR S" + std::to_string(routine_) + "." + std::to_string(below(8)));
  if (chance(20)) line("= M0.0");  // on what LSCR has left on the logic stack
  body(part, level + 1);
  if (model_.self & kCpu22x && chance(30)) {
    rung(part, "CSCRE");
    rung(part);
  }
  if (chance(60)) rung(part, statement(*find_instruction("SCRT")));
  line("SCRE");
  in_segment_ = false;
}

std::string Generator::statement(const s7200::Instruction& instruction) {
  std::string text(instruction.mnemonic);
  const char* separator = " ";
  for (const OperandRule& rule : instruction.rules()) {
    text += separator + operand(rule);
    separator = ", ";
  }
  return text;
}

// --- operands ---

std::string Generator::operand(const OperandRule& rule) {
  if (rule.kind != OperandKind::Memory) return number(rule);
  if (rule.text && rule.constant && chance(25)) return string_constant();
  if (rule.constant && !rule.text && (rule.areas == 0 || chance(30))) return constant(rule);
  if (rule.address_of && chance(15)) {
    static const std::vector<std::string> kTargets{"VB0", "VB4095", "VW2", "VD100", "MB31",
                                                   "IB0", "QB7",    "SB3", "T33",   "C127"};
    return "&" + one_of(kTargets);
  }
  if (rule.pointer && chance(20))
    return size_of("L") != 0 && chance(25) ? "*LD" + std::to_string(kLocalPointers + 4 * below(2))
           : chance(50)                    ? "*AC" + std::to_string(1 + below(3))
                                           : "*VD" + std::to_string(kPointers + 4 * below(kPointerCount));
  return direct(rule);
}

std::string Generator::number(const OperandRule& rule) {
  switch (rule.kind) {
    case OperandKind::Interrupt:
      return "0";
    case OperandKind::Event:
      return std::to_string(below(8));
    case OperandKind::Subroutine:
      return std::to_string(below(subroutines_));
    case OperandKind::StackLevel:
      return std::to_string(below(3));
    default:
      return std::to_string(below(static_cast<std::size_t>(rule.max) + 1));
  }
}

std::string Generator::constant(const OperandRule& rule) {
  if (rule.real) {
    static const std::vector<std::string> kReal{"0.0",     "-0.0",         "1.0",          "-1.0",          "0.5",
                                                "2.5",     "-2.5",         "100.0",        "3.4E+38",       "-3.4E+38",
                                                "1.2E-38", "2147483520.0", "2147483648.0", "-2147483648.0", "16777217.0"};
    return one_of(kReal);
  }
  const std::size_t width = bytes_of(rule.width);
  while (true) {
    const std::uint32_t bits = interesting(width);
    const std::int64_t plain = bits;
    const std::int64_t wrap = std::int64_t{1} << (8 * width);
    const std::int64_t value = plain >= wrap / 2 && chance(50) ? plain - wrap : plain;
    if (rule.takes(value)) return std::to_string(value);
    if (rule.min == std::numeric_limits<std::int64_t>::min() || rule.max - rule.min >= 300) continue;
    const auto other = rule.min + static_cast<std::int64_t>(below(static_cast<std::size_t>(rule.max - rule.min) + 1));
    if (rule.takes(other)) return std::to_string(other);
  }
}

std::string Generator::string_constant() {
  return one_of(std::vector<std::string>{"\"\"", "\"1\"", "\"-12.5\"", "\"  +70000\"", "\"12AB\"", "\"ABBA\""});
}

std::string Generator::direct(const OperandRule& rule) {
  std::vector<std::string> areas;
  for (const AreaInfo& area : all_areas())
    if (contains(rule.areas, area.area) && model_.size_of(area.area) != 0) areas.emplace_back(area.name);
  std::string area = one_of(areas);
  if (contains(rule.areas, Area::V) && chance(50)) area = "V";
  if (area == "SM") {
    const std::string text = special_memory(rule);
    if (!text.empty()) return text;
    area = contains(rule.areas, Area::V) ? "V" : areas.front();
  }
  if (area == "T") return timer(rule);
  if (area == "C")
    return "C" + one_of(std::vector<std::string>{"0", "1", "2", "8", "126", std::to_string(size_of("C") - 1)});
  if (area == "AC") return "AC" + std::to_string(rule.role == Role::In || chance(10) ? below(4) : 0);
  if (area == "HC") return "HC" + std::to_string(below(size_of("HC")));
  if (area == "AI" || area == "AQ") return area + "W" + std::to_string(2 * below(16));
  if (area == "V") return address(area, rule.width, place_in_v(rule));
  return address(area, rule.width, static_cast<std::uint32_t>(below(size_of(area) - bytes_of(rule.width) + 1)));
}

std::string Generator::address(const std::string& area, Width width, std::uint32_t number) {
  switch (width) {
    case Width::Bit:
      return area + std::to_string(number) + "." + std::to_string(below(8));
    case Width::Byte:
      return area + "B" + std::to_string(number);
    case Width::Word:
      return area + "W" + std::to_string(number);
    default:
      return area + "D" + std::to_string(number);
  }
}

std::string Generator::timer(const OperandRule& rule) {
  static const std::vector<std::string> kOnDelay{"T32", "T96", "T33", "T36", "T100", "T37", "T63", "T127"};
  static const std::vector<std::string> kOffDelay{"T96", "T96", "T97", "T34", "T101", "T255"};
  static const std::vector<std::string> kRetentive{"T0", "T64", "T1", "T4", "T68", "T5", "T31", "T95"};
  if (rule.timer == TimerKind::OffDelay) return one_of(kOffDelay);
  const bool retentive = rule.timer == TimerKind::Retentive || (rule.timer == TimerKind::Any && chance(50));
  return one_of(retentive ? kRetentive : kOnDelay);
}

/// Special memory that may be read or written with this width; empty if there is none.
std::string Generator::special_memory(const OperandRule& rule) {
  const bool read_only = rule.role == Role::In;
  switch (rule.width) {
    case Width::Bit:
    case Width::Byte: {
      static const std::vector<std::uint32_t> kReadable{0, 0, 1, 1, 1, 2, 3, 4, 4, 6, 22, 23, 30, 34, 35},
          kWritable{30, 34, 35}, kBlocks{34, 35};  // a block from SMB30 on could ask for a save to EEPROM in SMB31
      return address("SM", rule.width, one_of(read_only ? kReadable : rule.counted != 0 ? kBlocks : kWritable));
    }
    case Width::Word:
      return read_only ? "SMW" + one_of(std::vector<std::string>{"0", "1", "3", "22", "24", "26", "34"}) : "SMW34";
    default:
      return read_only ? "SMD" + one_of(std::vector<std::string>{"0", "1", "4", "22", "24"}) : "";
  }
}

std::uint32_t Generator::place_in_v(const OperandRule& rule) {
  const std::uint32_t width = bytes_of(rule.width);
  const auto in = [&](std::uint32_t from, std::uint32_t size) {
    return from + static_cast<std::uint32_t>(below(size - width + 1));
  };
  if (rule.text && chance(80)) return kStrings[below(3)];
  if (rule.name == "TBL" && chance(80)) return kTables[below(2)];
  if (rule.name == "SRC" && chance(80)) return kTables[below(2)] + 2;
  if (rule.real && chance(80)) return kReals + 4 * static_cast<std::uint32_t>(below(kRealsSize / 4));
  if (rule.counted != 0 && rule.width == Width::Byte && chance(50)) return in(kDigits, kDigitsSize);
  if (chance(5)) return in(static_cast<std::uint32_t>(size_of("V")) - kEndSize, kEndSize);
  if (chance(3)) return in(kPointers, 4 * kPointerCount);
  if (chance(5)) return in(kTables[0], 24);
  return in(kHot, kHotSize);
}

// --- memory ---

std::uint32_t Generator::interesting(std::size_t width) {
  static const std::vector<std::uint32_t> kBytes{0,  1,  2,  3,  5,  7,   8,   9,   15,  16,  17,  31, 32,
                                                 33, 48, 64, 65, 70, 100, 127, 128, 191, 192, 254, 255};
  static const std::vector<std::uint32_t> kWords{0,      1,      2,      3,      10,     99,     100,
                                                 0x00FF, 0x0100, 0x0999, 0x1234, 9999,   10000,  0x7FFE,
                                                 0x7FFF, 0x8000, 0x8001, 0x9999, 0xA000, 0xFFFE, 0xFFFF};
  static const std::vector<std::uint32_t> kDoubles{0,           1,           2,           0xFFFF,      0x10000,
                                                   0x7FFF'FFFF, 0x8000'0000, 0x8000'0001, 0xFFFF'FFFE, 0xFFFF'FFFF,
                                                   0x0000'8000, 0xFFFF'8000, 0x0800'0000};
  if (chance(30)) return static_cast<std::uint32_t>(random_()) >> (32 - 8 * width);
  return width == 1 ? one_of(kBytes) : width == 2 ? one_of(kWords) : one_of(kDoubles);
}

std::uint32_t Generator::real_bits() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  static const std::vector<float> kReal{0.0f,           -0.0f,          1.0f,        -1.0f,         0.5f,
                                        4.0f,           2.25f,          -3.75f,      1e10f,         3.4e38f,
                                        -3.4e38f,       1e-38f,         1e-44f,      2147483520.0f, 2147483648.0f,
                                        -2147483648.0f, -2147483904.0f, 16777216.0f, kInfinity,     -kInfinity};
  if (chance(20)) return static_cast<std::uint32_t>(random_());
  if (chance(2)) return std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN());  // stops a real compare
  return std::bit_cast<std::uint32_t>(one_of(kReal));
}

std::uint32_t Generator::pointer() {
  const auto to = [](std::uint32_t code, std::size_t offset) { return code << 24 | static_cast<std::uint32_t>(offset); };
  if (chance(10)) return static_cast<std::uint32_t>(random_());
  const auto v_end = static_cast<std::uint32_t>(size_of("V"));
  if (size_of("L") != 0 && chance(10)) return to(0x08, kStrings[below(3)]);
  switch (below(12)) {
    case 0:
      return to(0x00, below(size_of("I") + 1));
    case 1:
      return to(0x01, below(size_of("Q") + 1));
    case 2:
      return to(0x02, below(33));
    case 3:
      return to(0x04, below(size_of("S") + 1));
    case 4:
      return to(0x05, 2 * below(size_of("T") + 1));
    case 5:
      return to(0x06, 2 * below(size_of("C") + 1));
    case 6:
      return to(0x08, v_end - 6 + below(8));
    case 7:
      return to(static_cast<std::uint32_t>(below(9)), below(64));
    case 8:
      return to(0x08, kTables[below(2)] + 2 * below(2));
    default:
      return to(0x08, below(96));
  }
}

void Generator::random_bytes(Bytes& bytes, std::size_t from, std::size_t count) {
  for (std::size_t i = from; i < from + count; ++i) bytes[i] = static_cast<std::uint8_t>(interesting(1));
}

void Generator::table(Bytes& bytes, std::size_t at) {
  static const std::vector<std::uint32_t> kLengths{1, 2, 3, 5, 10, 20, 100, 100, 0, 101, 0xFFFF};
  const std::uint32_t length = one_of(kLengths);
  const std::vector<std::uint32_t> counts{0, 1, 2, length / 2, length - 1, length, length + 1};
  write(Place{&bytes, at}, 2, length);
  write(Place{&bytes, at + 2}, 2, one_of(counts));
  for (std::size_t i = 0; i < 20; ++i) write(Place{&bytes, at + 4 + 2 * i}, 2, interesting(2));
}

/// Numbers, and what looks like one.
void Generator::string(Bytes& bytes, std::size_t at) {
  static const std::vector<std::string> kTexts{"",  "1",    "-32768", "32768", "  12,75",    "+5",
                                               "-", "12AB", "AB",     "B 7",   "2147483648", "ABBA ABBA"};
  const std::string& text = one_of(kTexts);
  write(Place{&bytes, at}, 1, chance(95) ? static_cast<std::uint32_t>(text.size()) : interesting(1));
  for (std::size_t i = 0; i < text.size(); ++i) write(Place{&bytes, at + 1 + i}, 1, static_cast<unsigned char>(text[i]));
}

void Generator::fill(Memory& m) {
  random_bytes(m.input_points, 0, m.input_points.size());
  for (Bytes* bytes : {&m.Q, &m.M, &m.S, &m.AI, &m.HC, &m.counter_bits}) random_bytes(*bytes, 0, bytes->size());
  for (std::size_t at = 0; at < m.T.size(); at += 2) write(Place{&m.T, at}, 2, interesting(2));
  for (std::size_t at = 0; at < m.C.size(); at += 2) write(Place{&m.C, at}, 2, interesting(2));
  for (std::size_t at = kHot; at < kHot + kHotSize; at += 4) {
    if (chance(60))
      write(Place{&m.V, at}, 4, interesting(2) << 16 | interesting(2));
    else
      write(Place{&m.V, at}, 4, interesting(4));
  }
  for (std::size_t at = kReals; at < kReals + kRealsSize; at += 4) write(Place{&m.V, at}, 4, real_bits());
  for (std::size_t i = 0; i < kPointerCount; ++i) write(Place{&m.V, kPointers + 4 * i}, 4, pointer());
  for (std::size_t i = 0; i < kDigitsSize; ++i)
    m.V[kDigits + i] =
        static_cast<std::uint8_t>(chance(6) ? below(256) : static_cast<std::size_t>("0123456789ABCDEF"[below(16)]));
  for (const std::uint32_t at : kTables) table(m.V, at);
  random_bytes(m.V, m.V.size() - kEndSize, kEndSize);
  if (!m.L.empty()) {
    for (const std::uint32_t at : kStrings) string(m.V, at);
    for (std::size_t at = 0; at < m.L.size(); at += 4) write(Place{&m.L, at}, 4, interesting(4));
    for (std::size_t i = 0; i < 2; ++i) write(Place{&m.L, kLocalPointers + 4 * i}, 4, pointer());
  }
  write(Place{&m.AC, 0}, 4, interesting(4));
  for (std::size_t i = 1; i < 4; ++i) write(Place{&m.AC, 4 * i}, 4, pointer());
  m.SM[1] = static_cast<std::uint8_t>(below(256));
}

}  // namespace s7200::reference
