#include "tests/reference_model/machine.hpp"

#include <algorithm>
#include <bit>
#include <set>
#include <stdexcept>

#include "tests/reference_model/instructions.hpp"

namespace s7200::reference {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000, kSecond = 1000 * kMillisecond;
constexpr std::int64_t kStopStep = 10'000;

/// How many bytes an element of an area takes, if the area is addressed by element numbers.
std::size_t element_size(const std::string& area) {
  if (area == "T" || area == "C") return 2;
  if (area == "HC" || area == "AC") return 4;
  return 1;
}

bool clock_is_high(std::int64_t time, std::int64_t half_period) { return time / half_period % 2 == 0; }

std::vector<std::string> areas_of_operands(const stl::Statement& statement) {
  std::vector<std::string> areas;
  for (const stl::Operand& operand : statement.operands) {
    const auto* address = std::get_if<stl::Address>(&operand.value);
    areas.push_back(address ? address->area : "");
  }
  return areas;
}

bool is_in_local_memory(const stl::Operand& operand) {
  if (const auto* address = std::get_if<stl::Address>(&operand.value)) return address->area == "L";
  const auto* indirect = std::get_if<stl::Indirect>(&operand.value);
  return indirect && indirect->pointer.area == "L";
}

/// Of what needs power flow, coils and what changes the course of the program have no ENO (facts 10.7).
bool has_eno(const std::string& mnemonic, const Instruction& instruction) {
  static const std::set<std::string> kWithout{"S",    "R",   "SI",   "RI",    "JMP",   "CRET", "END",
                                              "STOP", "WDR", "SCRT", "CSCRE", "CRETI", "ENI",  "DISI"};
  return instruction.needs_power && !kWithout.contains(mnemonic);
}

std::int64_t count_pointers(const stl::Statement& statement) {
  return std::count_if(statement.operands.begin(), statement.operands.end(),
                       [](const stl::Operand& operand) { return std::holds_alternative<stl::Indirect>(operand.value); });
}

}  // namespace

Machine::Machine(const stl::Source& source, const CpuKind& which)
    : kind(which),
      memory(which),
      no_power_flow_(which.times->of("(no power flow)").base),
      scan_overhead_(which.times->of("(scan overhead)").base) {
  const Times& times = *kind.times;
  for (const stl::Line& line : source.lines)
    if (const auto* statement = std::get_if<stl::Statement>(&line)) statements_.push_back(*statement);
  for (std::size_t i = 0; i < statements_.size(); ++i) {
    const stl::Statement& statement = statements_[i];
    instruction_.push_back(&instructions().at(statement.mnemonic));
    has_eno_.push_back(has_eno(statement.mnemonic, *instruction_.back()));
    uses_local_ = uses_local_ || std::ranges::any_of(statement.operands, is_in_local_memory);
    const stl::Statement& with_operands = statement.mnemonic == "NEXT" ? statements_[find_for(i)] : statement;
    const auto areas = areas_of_operands(with_operands);
    Cost cost = times.of(statement.mnemonic, areas.empty() ? "" : areas[0]);
    cost.base += times.added_by(statement.mnemonic, areas);
    cost.base += count_pointers(with_operands) * times.of("(indirect operand)").base;
    cost_.push_back(cost);
  }
}

// --- scan ---

void Machine::power_up() {
  memory = Memory(kind);
  local_.fill(Bytes(kind.L));
  level_ = 0;
  stack = {};
  errors.clear();
  calls.clear();
  edge_memory.clear();
  timers = {};
  counter_up.fill(true);
  counter_down.fill(true);
  time = scan_begin_ = inputs_read_ = milliseconds_counted_ = hundred_ms_ticks = 0;
  error_count = 0;
  fatal_code = 0;
  fatal_position.reset();
  interrupts_enabled = false;
  shortest_scan_ = longest_scan_ = 0;
  first_scan_ = true;
  running = true;
  in_program = false;
  memory.SM[0] = 0b1011'1011;  // always 1, first scan, RUN from power-up, both clocks high, mode switch in RUN
  memory.SM[4] = 0b0110'0000;  // transmitters idle
  memory.SM[6] = kind.identification;
  for (std::size_t module = 0; module < 7; ++module) memory.SM[8 + 2 * module] = 0x80;  // not there
  memory.SM[66] = memory.SM[76] = 0x80;  // pulse outputs idle
  watchdog_ = kind.watchdog;
}

void Machine::step() {
  if (!running) {
    time += kStopStep;
  } else if (time >= watchdog_) {
    fatal_error(0x03, in_program ? std::optional(executed_) : std::nullopt);
  } else if (in_program) {
    execute();
  } else {
    system_part();
  }
}

/// Whether the watchdog runs out before `end`; the next step then notices it and stops the CPU.
bool Machine::watchdog_runs_out(std::int64_t end) {
  if (end <= watchdog_) return false;
  time = watchdog_;
  return true;
}

/// Communication, self-test and output write, each a quarter of the scan overhead; then input read, the fourth quarter.
void Machine::system_part() {
  const std::int64_t quarter = scan_overhead_ / 4;
  if (!first_scan_) {
    if (watchdog_runs_out(time + scan_overhead_ - quarter)) return;
    time += scan_overhead_ - quarter;
    end_scan();
  }
  first_scan_ = false;
  time += quarter;
  read_inputs();
  in_program = true;
  position = 0;
  stack = {};
  rail = true;
  eno = true;
  calls.clear();
  enter_level(0);
}

void Machine::end_scan() {
  memory.output_points = memory.Q;
  const bool alternating = memory.SM[0] & 0x40;
  memory.SM[0] =
      static_cast<std::uint8_t>(0b1000'0001 | (alternating ? 0 : 0x40) | (clock_is_high(time, 30 * kSecond) ? 0x10 : 0) |
                                (clock_is_high(time, kSecond / 2) ? 0x20 : 0));
  const std::int64_t scan = (time - scan_begin_) / kMillisecond;
  const bool first = scan_begin_ == 0;
  shortest_scan_ = first ? scan : std::min(shortest_scan_, scan);
  longest_scan_ = std::max(longest_scan_, scan);
  write(Place{&memory.SM, 22}, 2, static_cast<std::uint32_t>(scan));
  write(Place{&memory.SM, 24}, 2, static_cast<std::uint32_t>(shortest_scan_));
  write(Place{&memory.SM, 26}, 2, static_cast<std::uint32_t>(longest_scan_));
  scan_begin_ = time;
  watchdog_ = time + kind.watchdog;
}

void Machine::read_inputs() {
  memory.I = memory.input_points;
  count_milliseconds();
  count_ten_milliseconds();
  hundred_ms_ticks = std::min<std::int64_t>(time / (100 * kMillisecond) - inputs_read_ / (100 * kMillisecond), 250);
  inputs_read_ = time;
}

bool Machine::has_power() const { return !instruction_[position]->needs_power || stack[0]; }

void Machine::execute() {
  count_milliseconds();
  const Instruction& instruction = *instruction_[position];
  next = position + 1;
  if (!has_power()) {
    time += no_power_flow_;
    if (has_eno_[position]) eno = false;
    if (statement().mnemonic == "FOR") next = find_next(position) + 1;
  } else {
    time += cost_[position].base;
    if (has_eno_[position]) eno = true;
    try {
      instruction.execute(*this);
      if (has_eno_[position] && has_failed()) eno = false;
    } catch (const RunTimeError& error) {
      if (has_eno_[position]) eno = false;
      report(error.code);
    }
  }
  executed_ = position;
  position = next;
}

/// Whether the box just executed says in SM1 that it has failed; a shift does not, whatever it has shifted out.
bool Machine::has_failed() const {
  static const std::map<std::string, std::uint8_t> kFailures{
      {"+I", 2},    {"-I", 2},   {"+D", 2},    {"-D", 2},    {"*I", 10},  {"/I", 10},  {"*D", 10},   {"/D", 10},
      {"MUL", 10},  {"DIV", 10}, {"INCW", 2},  {"DECW", 2},  {"INCD", 2}, {"DECD", 2}, {"INCB", 2},  {"DECB", 2},
      {"+R", 2},    {"-R", 2},   {"*R", 2},    {"/R", 10},   {"SQRT", 2}, {"SIN", 2},  {"COS", 2},   {"TAN", 2},
      {"LN", 2},    {"EXP", 2},  {"TRUNC", 2}, {"ROUND", 2}, {"ITB", 2},  {"DTI", 2},  {"BCDI", 64}, {"IBCD", 64},
      {"ATH", 128}, {"ATT", 16}, {"FIFO", 32}, {"LIFO", 32}, {"STI", 2},  {"STD", 2},  {"STR", 2}};
  const auto flags = kFailures.find(statement().mnemonic);
  return flags != kFailures.end() && (memory.SM[1] & flags->second) != 0;
}

void Machine::enter_level(std::size_t calls_open) {
  if (!uses_local_ || calls_open == level_) return;
  local_.at(level_) = memory.L;
  memory.L = local_.at(calls_open);
  level_ = calls_open;
}

void Machine::end_program() { in_program = false; }

void Machine::stop() {
  running = in_program = false;
  enter_level(0);
  interrupts_enabled = false;
  memory.SM[4] = static_cast<std::uint8_t>((memory.SM[4] & 0b1110'1000) | 0b0010'0000);
  std::fill(memory.output_points.begin(), memory.output_points.end(), std::uint8_t{0});
}

void Machine::restart_watchdog() { watchdog_ = time + kind.watchdog; }

void Machine::enable_interrupts(bool enabled) {
  interrupts_enabled = enabled;
  write(BitPlace{&memory.SM, 4 * 8 + 4}, enabled);
}

// --- errors ---

void Machine::report(int code) {
  write(BitPlace{&memory.SM, 4 * 8 + 3}, true);
  ++error_count;
  const auto known =
      std::find_if(errors.begin(), errors.end(), [&](const Error& e) { return e.code == code && e.position == position; });
  if (known != errors.end())
    ++known->count;
  else
    errors.push_back({code, position, time, 1});
}

void Machine::fatal_error(int code, std::optional<std::size_t> where) {
  fatal_code = code;
  fatal_position = where;
  stop();
}

// --- operands ---

Bytes& Machine::area(const std::string& name) {
  if (name == "V") return memory.V;
  if (name == "M") return memory.M;
  if (name == "AC") return memory.AC;
  if (name == "SM") return memory.SM;
  if (name == "I") return memory.I;
  if (name == "Q") return memory.Q;
  if (name == "S") return memory.S;
  if (name == "T") return memory.T;
  if (name == "C") return memory.C;
  if (name == "AI") return memory.AI;
  if (name == "AQ") return memory.AQ;
  if (name == "HC") return memory.HC;
  if (name == "L") return memory.L;
  throw std::invalid_argument("area " + name);
}

std::size_t Machine::number(std::size_t i) const {
  return static_cast<std::size_t>(std::get<stl::Integer>(statement().operands[i].value).value);
}

std::uint32_t Machine::value_of(const stl::Operand& operand, std::size_t width) {
  if (const auto* integer = std::get_if<stl::Integer>(&operand.value)) {
    const auto bits = static_cast<std::uint64_t>(integer->value);
    return static_cast<std::uint32_t>(bits & ((std::uint64_t{1} << (8 * width)) - 1));
  }
  if (const auto* real = std::get_if<stl::Real>(&operand.value)) return std::bit_cast<std::uint32_t>(real->value);
  if (const auto* target = std::get_if<stl::AddressOf>(&operand.value)) return pointer_to(target->target);
  return read(place_of(operand, width), width);
}

Place Machine::place_of(const stl::Operand& operand, std::size_t width) {
  if (const auto* indirect = std::get_if<stl::Indirect>(&operand.value)) return follow_pointer(indirect->pointer, width);
  const auto& direct = std::get<stl::Address>(operand.value);
  std::size_t at = direct.number * element_size(direct.area);
  if (direct.area == "AC") at += 4 - width;  // the low end of the register
  return {&area(direct.area), at};
}

Place Machine::follow_pointer(const stl::Address& pointer, std::size_t width) {
  const std::uint32_t value = read(Place{&area(pointer.area), pointer.number * element_size(pointer.area)}, 4);
  Place place;
  switch (value >> 24) {
    case 0x00:
      place.bytes = &memory.I;
      break;
    case 0x01:
      place.bytes = &memory.Q;
      break;
    case 0x02:
      place.bytes = &memory.M;
      break;
    case 0x04:
      place.bytes = &memory.S;
      break;
    case 0x06:
      place.bytes = &memory.C;
      break;
    case 0x07:
      place.bytes = &memory.T;
      break;
    case 0x08:
      place.bytes = &memory.V;
      break;
    default:
      throw RunTimeError{0x06};
  }
  place.at = value & 0xFF'FFFF;
  if (!holds(place, width)) throw RunTimeError{0x06};
  return place;
}

std::uint32_t Machine::pointer_to(const stl::Address& target) const {
  static const std::map<std::string, std::uint32_t> kCode{{"I", 0x00}, {"Q", 0x01}, {"M", 0x02}, {"S", 0x04},
                                                          {"T", 0x07}, {"C", 0x06}, {"V", 0x08}};
  return kCode.at(target.area) << 24 | static_cast<std::uint32_t>(target.number * element_size(target.area));
}

const stl::Address& Machine::address(std::size_t i) const { return std::get<stl::Address>(statement().operands[i].value); }

BitPlace Machine::bit(std::size_t i) {
  const stl::Address& a = address(i);
  if (a.area == "T") return {&memory.timer_bits, a.number};
  if (a.area == "C") return {&memory.counter_bits, a.number};
  return {&area(a.area), std::size_t{8} * a.number + a.bit};
}

BitPlace Machine::point(std::size_t i) {
  const stl::Address& a = address(i);
  return {a.area == "I" ? &memory.input_points : &memory.output_points, std::size_t{8} * a.number + a.bit};
}

// --- stack ---

void Machine::push(bool value) {
  for (std::size_t i = stack.size() - 1; i > 0; --i) stack[i] = stack[i - 1];
  stack[0] = value;
}

void Machine::pop() {
  for (std::size_t i = 0; i + 1 < stack.size(); ++i) stack[i] = stack[i + 1];
  stack.back() = false;
}

// --- the other end of a pair ---

std::size_t Machine::find(const std::string& mnemonic, std::size_t number) const {
  for (std::size_t i = 0; i < statements_.size(); ++i)
    if (statements_[i].mnemonic == mnemonic &&
        static_cast<std::size_t>(std::get<stl::Integer>(statements_[i].operands[0].value).value) == number)
      return i;
  throw std::out_of_range(mnemonic);
}

std::size_t Machine::find_label(std::size_t number) const { return find("LBL", number); }
std::size_t Machine::find_subroutine(std::size_t number) const { return find("SBR", number); }

std::size_t Machine::find_next(std::size_t for_position) const {
  int depth = 0;
  for (std::size_t i = for_position;; ++i) {
    if (statements_.at(i).mnemonic == "FOR") ++depth;
    if (statements_.at(i).mnemonic == "NEXT" && --depth == 0) return i;
  }
}

std::size_t Machine::find_for(std::size_t next_position) const {
  int depth = 0;
  for (std::size_t i = next_position;; --i) {
    if (statements_.at(i).mnemonic == "NEXT") ++depth;
    if (statements_.at(i).mnemonic == "FOR" && --depth == 0) return i;
  }
}

std::size_t Machine::find_lscr(std::size_t inner_position) const {
  std::size_t i = inner_position;
  while (statements_.at(i).mnemonic != "LSCR") --i;
  return i;
}

// --- timers ---

namespace {

bool is_one_of(std::size_t timer, std::initializer_list<std::array<std::size_t, 2>> ranges) {
  return std::any_of(ranges.begin(), ranges.end(), [&](const auto& r) { return timer >= r[0] && timer <= r[1]; });
}

bool is_1_ms(std::size_t timer) { return is_one_of(timer, {{0, 0}, {32, 32}, {64, 64}, {96, 96}}); }
bool is_10_ms(std::size_t timer) { return is_one_of(timer, {{1, 4}, {33, 36}, {65, 68}, {97, 100}}); }

}  // namespace

bool is_100_ms(std::size_t timer) {
  if (timer >= 101) return true;
  const std::size_t in_half = timer % 64;
  return (in_half >= 5 && in_half <= 31) || in_half >= 37;
}

void Machine::count_timer(std::size_t timer, std::int64_t ticks) {
  const Place current{&memory.T, 2 * timer};
  const std::int64_t before = static_cast<std::int16_t>(read(current, 2));
  std::int64_t now = std::min<std::int64_t>(before + ticks, 32767);
  if (timers[timer].off_delay && now > timers[timer].preset) now = std::max<std::int64_t>(before, timers[timer].preset);
  write(current, 2, static_cast<std::uint32_t>(now));
  compare_timer(timer);
}

void Machine::compare_timer(std::size_t timer) {
  const auto current = static_cast<std::int16_t>(read(Place{&memory.T, 2 * timer}, 2));
  const bool reached = current >= timers[timer].preset;
  write(BitPlace{&memory.timer_bits, timer}, timers[timer].off_delay ? !reached : reached);
  if (timers[timer].off_delay && reached) timers[timer].enabled = false;  // it stands still at its preset
}

void Machine::count_milliseconds() {
  for (; (milliseconds_counted_ + 1) * kMillisecond <= time; ++milliseconds_counted_) {
    const std::int64_t instant = (milliseconds_counted_ + 1) * kMillisecond;
    for (std::size_t timer = 0; timer < timers.size(); ++timer)
      if (is_1_ms(timer) && timers[timer].enabled && timers[timer].enabled_at < instant) count_timer(timer, 1);
  }
}

void Machine::count_ten_milliseconds() {
  const std::int64_t ticks = time / (10 * kMillisecond) - inputs_read_ / (10 * kMillisecond);
  for (std::size_t timer = 0; timer < timers.size(); ++timer)
    if (is_10_ms(timer) && timers[timer].enabled) count_timer(timer, ticks);
}

}  // namespace s7200::reference
