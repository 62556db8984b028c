#include "interpreter/program/operands/operands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/checking/special_memory_use.hpp"
#include "interpreter/program/checking/warnings.hpp"
#include "interpreter/stl/parser.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/stl/text/look_alikes.hpp"

namespace s7200 {
namespace {

constexpr std::size_t kLongestStringConstant = 126;

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

std::string_view letter_of(Width width) {
  switch (width) {
    case Width::Bit:
      return "";
    case Width::Byte:
      return "B";
    case Width::Word:
      return "W";
    case Width::Double:
      return "D";
  }
  return {};
}

bool is_numbered(Area area) { return info(area).element != 0; }

std::string areas_text(const OperandRule& rule, const CpuModel& model) {
  std::string text;
  const auto add = [&](std::string_view what) { text.append(text.empty() ? "" : ", ").append(what); };
  for (const AreaInfo& area : all_areas())
    if (contains(rule.areas, area.area) && model.size_of(area.area) != 0)
      add(is_numbered(area.area) || area.area == Area::AI || area.area == Area::AQ
              ? std::string(area.name) + (area.element ? "" : "W")
              : std::string(area.name).append(letter_of(rule.width)));
  if (rule.constant) add(rule.text ? "a constant in double quotes" : "a constant");
  if (rule.pointer) add(model.size_of(Area::L) != 0 ? "*VD, *LD, *AC" : "*VD, *AC");
  if (rule.address_of) add("&…");
  return text;
}

/// "HSC0, HSC3, HSC4 and HSC5"
std::string counters_text(const CpuModel& model) {
  std::vector<std::string> names;
  for (std::size_t number = 0; number < model.counter_modes.size(); ++number)
    if (model.counter_modes[number] != 0) names.push_back(fmt::format("HSC{}", number));
  const std::string last = names.back();
  names.pop_back();
  return names.empty() ? last : fmt::format("{} and {}", fmt::join(names, ", "), last);
}

/// Checks one operand; if the result is not a PlacedOperand, a diagnostic has been added.
class Placing {
 public:
  Placing(const Instruction& instruction, const OperandRule& rule, const stl::Operand& written, const CpuModel& model,
          ConstantPool& constants, stl::Diagnostics& diagnostics)
      : instruction_(instruction),
        rule_(rule),
        written_(written),
        model_(model),
        constants_(constants),
        diagnostics_(diagnostics) {}

  std::optional<PlacedOperand> result() {
    if (rule_.kind != OperandKind::Memory) return plain_number();
    return std::visit(
        Overloaded{[&](const stl::Integer& v) { return integer(v); }, [&](const stl::Real& v) { return real(v); },
                   [&](const stl::Address& v) { return address(v); }, [&](const stl::AddressOf& v) { return address_of(v); },
                   [&](const stl::Indirect& v) { return indirect(v); }, [&](const stl::Name& v) { return name(v); }},
        written_.value);
  }

 private:
  using Result = std::optional<PlacedOperand>;

  Result error(std::string message, std::string hint = {}, std::string cause = {}) {
    diagnostics_.push_back({stl::Severity::Error, written_.position, std::move(message), std::move(hint), std::move(cause)});
    return {};
  }

  std::string text() const { return stl::shortened(stl::to_text(written_)); }
  std::string of_instruction() const { return fmt::format("{} of {}", rule_.name, instruction_.mnemonic); }
  std::uint16_t width() const { return static_cast<std::uint16_t>(bytes_of(rule_.width)); }

  Result wrong_kind() {
    return error(fmt::format("{} cannot be {}", of_instruction(), text()),
                 instruction_.hidden == Hidden::InputPoint
                     ? immediate_hint()
                     : fmt::format("{} takes {}", of_instruction(), areas_text(rule_, model_)));
  }

  /// The hint about LDI and its like. The I of other controllers is a closed contact.
  std::string immediate_hint() const {
    const std::string_view usual = instruction_.mnemonic.substr(0, instruction_.mnemonic.size() - 1);
    const std::string closed = usual.ends_with('N') ? "" : fmt::format(", or {}N {} for a closed contact", usual, text());
    return fmt::format("only inputs are read at once: write {} {}{}", usual, text(), closed);
  }

  // --- numbers that are part of the instruction ---

  Result plain_number() {
    const auto* value = std::get_if<stl::Integer>(&written_.value);
    const auto [what, last] = number_range();
    const std::string range =
        last == 0 ? fmt::format("the only {} is 0", what) : fmt::format("{}s are numbered 0 to {}", what, last);
    if (const auto* name = std::get_if<stl::Name>(&written_.value); name && !name->reason.empty())
      return error(name->reason, range);
    if (!value || value->form == stl::Integer::Form::Ascii)
      return error(fmt::format("{} takes a number here, not {}", instruction_.mnemonic, text()), range);
    if (rule_.kind == OperandKind::Number && (value->value < 0 || value->value > last))
      return error(fmt::format("{} must be 0 to {}, not {}", of_instruction(), last, text()));
    if (value->value < 0 || value->value > last)
      return error(fmt::format("{} {} does not exist on CPU {}", what, value->value, model_.name), range,
                   fmt::format("no such {}", what));
    if (rule_.kind == OperandKind::Event && !event_exists(value->value)) return {};
    if (rule_.kind == OperandKind::Counter && !counter_exists(static_cast<std::uint32_t>(value->value))) return {};
    return PlacedOperand{{.at = static_cast<std::uint32_t>(value->value)}, {}, value->value};
  }

  std::pair<std::string_view, std::int64_t> number_range() const {
    switch (rule_.kind) {
      case OperandKind::Label:
        return {"label", model_.labels - 1};
      case OperandKind::Subroutine:
        return {"subroutine", model_.subroutines - 1};
      case OperandKind::Interrupt:
        return {"interrupt routine", model_.interrupts - 1};
      case OperandKind::Event:
        return {"event", static_cast<std::int64_t>(kEvents) - 1};
      case OperandKind::Counter:
        return {"high-speed counter", model_.size_of(Area::HC) - 1};
      case OperandKind::Port:
        return {"port", model_.ports - 1};
      case OperandKind::StackLevel:
        return {"level", 8};
      default:
        return {"number", rule_.max};
    }
  }

  /// Whether a counter exists: not all of the numbers up to the last one do.
  bool counter_exists(std::uint32_t number) {
    if (model_.counter_modes[number] != 0) return true;
    error(fmt::format("CPU {} has no high-speed counter {}", model_.name, number),
          fmt::format("it has {}", counters_text(model_)), fmt::format("no counter {}", number));
    return false;
  }

  bool event_exists(std::int64_t number) {
    const InterruptEvent* event = find_event(number);
    if ((event->cpus & model_.self) != 0) return true;
    error(fmt::format("CPU {} has no event {} ({})", model_.name, number, event->cause), needs("it needs", event->cpus),
          fmt::format("no event {}", number));
    return false;
  }

  // --- constants ---

  Result integer(const stl::Integer& constant) {
    if (rule_.text && rule_.constant)
      return error(fmt::format("{} is a string, {} is a number", of_instruction(), text()),
                   "a string constant is written in double quotes");
    if (!rule_.constant) return constant_refused();
    if (rule_.real)
      return error(fmt::format("{} is a real number, {} is an integer", of_instruction(), text()),
                   constant.form == stl::Integer::Form::Decimal ? fmt::format("write {}.0", constant.value) : "");
    if (constant.form == stl::Integer::Form::Ascii && constant.characters != width())
      return error(fmt::format("{} has {}, {} is a {}", text(), counted(constant.characters, "character"), of_instruction(),
                               name_of(rule_.width)));
    if (constant.value < lowest() || constant.value > highest())
      return error(fmt::format("{} does not fit in {}, a {}", text(), of_instruction(), name_of(rule_.width)),
                   fmt::format("a {} is {} to {} signed, 0 to {} unsigned", name_of(rule_.width), lowest(), -lowest() - 1,
                               highest()));
    const std::int64_t read = as_read(constant.value);
    const bool decimal = constant.form == stl::Integer::Form::Decimal;  // other forms show the bits, whatever they mean
    const std::int64_t meant = decimal ? constant.value : read;
    if (!rule_.takes(meant)) return out_of_range(meant);
    if (meant != read) warn_of_other_sign(read);
    if (read < rule_.usual_from) warn_of_preset(read);
    PlacedOperand placed = pooled(static_cast<std::uint32_t>(constant.value));
    placed.constant = read;
    return placed;
  }

  std::int64_t lowest() const { return -(std::int64_t{1} << (8 * width() - 1)); }
  std::int64_t highest() const { return (std::int64_t{1} << (8 * width())) - 1; }

  /// The number that the instruction makes of the bits of a constant.
  std::int64_t as_read(std::int64_t value) const {
    const std::int64_t values = highest() + 1;
    if (rule_.sign == Sign::Signed && value >= values / 2) return value - values;
    if (rule_.sign == Sign::Unsigned && value < 0) return value + values;
    return value;
  }

  Result out_of_range(std::int64_t meant) {
    if (meant == 0 && rule_.not_zero)
      return error(fmt::format("{} cannot be 0 (count error 0092)", of_instruction()),
                   fmt::format("it must be {} to -1 or 1 to {}", rule_.min, rule_.max));
    return error(fmt::format("{} must be {} to {}, not {}", of_instruction(), rule_.usual_min(), rule_.max, text()));
  }

  void warn_of_other_sign(std::int64_t read) {
    const bool is_signed = rule_.sign == Sign::Signed;
    diagnostics_.push_back(warn(
        Warning::OtherSign, written_.position,
        fmt::format("{} is {} {}: {} is taken as {}", of_instruction(), is_signed ? "a signed" : "an unsigned",
                    name_of(rule_.width), text(), read),
        fmt::format("write {} if that is what you mean; {} {} is {} to {}", read, is_signed ? "a signed" : "an unsigned",
                    name_of(rule_.width), is_signed ? lowest() : 0, is_signed ? -lowest() - 1 : highest())));
  }

  void warn_of_preset(std::int64_t read) {
    diagnostics_.push_back(warn(Warning::Preset, written_.position,
                                fmt::format("{} is {}: there is nothing to count", of_instruction(), read),
                                fmt::format("a preset is {} to {}", rule_.usual_min(), rule_.max)));
  }

  Result real(const stl::Real& constant) {
    if (!rule_.constant && rule_.width == Width::Bit && constant.value >= 0 && constant.value < 20)
      return error(fmt::format("{} cannot be the constant {}", of_instruction(), text()),
                   "an address has a letter before it: I0.1 is an input, Q0.1 an output; a scanner reads I as 1 and Q as 0");
    if (!rule_.constant) return constant_refused();
    if (!rule_.real)
      return error(fmt::format("{} is an integer {}, {} is a real number", of_instruction(), name_of(rule_.width), text()),
                   "write an integer without a decimal point: 5, -5 or 16#FF");
    return pooled(std::bit_cast<std::uint32_t>(constant.value));
  }

  Result constant_refused() {
    return error(fmt::format("{} cannot be the constant {}", of_instruction(), text()),
                 fmt::format("{} takes {}", of_instruction(), areas_text(rule_, model_)));
  }

  PlacedOperand pooled(std::uint32_t value) { return {{.at = constants_.place(value, width()), .width = width()}, {}, {}}; }

  // --- addresses ---

  Result address(const stl::Address& address) {
    const auto area = known_area(address, rule_.width);
    if (!area || !width_fits(address, *area)) return {};
    if (!contains(rule_.areas, *area)) return area_refused(*area);
    if (!in_range(address, *area, rule_.width) || !may_use_special_memory(address, *area) || !timer_fits(address)) return {};
    return PlacedOperand{place(address, *area), *area, {}};
  }

  std::optional<Area> known_area(const stl::Address& address, Width meant) {
    const auto area = area_named(address.area);
    if (!area || model_.size_of(*area) == 0) {
      error(fmt::format("CPU {} has no {} memory", model_.name, address.area),
            address.area == "L" ? needs("local memory needs", kCpu22x) : "", fmt::format("no {} memory", address.area));
      return {};
    }
    if (!names_width(address, *area)) {
      error(fmt::format("{} does not say whether it is a byte, word or double word", text()),
            address.number >= model_.size_of(*area)
                ? fmt::format("{} memory is {}", address.area, range_text(model_, *area, meant))
            : meant == Width::Bit ? bits_text(*area, Width::Byte, address.number)
                                  : fmt::format("did you mean {}?", address_text(*area, meant, address.number, 0)));
      return {};
    }
    return area;
  }

  bool width_fits(const stl::Address& address, Area area) {
    if (rule_.width == Width::Bit && is_numbered(area) && info(area).bits != kNoBits && address.size == stl::Size::None)
      return true;  // T33, C4: the timer or counter bit
    const auto width = width_of(address, area);
    if (!width || *width == rule_.width) return true;
    std::string meant = fmt::format("{} takes {}", of_instruction(), areas_text(rule_, model_));
    if (!is_numbered(area) && area != Area::AI && area != Area::AQ) meant = width_hint(area, *width, address.number);
    error(fmt::format("{} is a {}, {} is a {}", of_instruction(), name_of(rule_.width), text(), name_of(*width)), meant);
    return false;
  }

  /// The byte at the highest address has the lowest bits.
  static std::string bits_text(Area area, Width width, std::uint32_t number) {
    const std::uint32_t last = number + bytes_of(width) - 1;
    const std::string bits = fmt::format("its bits are {} to {}", address_text(area, Width::Bit, number, 0),
                                         address_text(area, Width::Bit, last, 7));
    return last == number ? bits : fmt::format("{}; bit 0 is {}", bits, address_text(area, Width::Bit, last, 0));
  }

  /// The parts of `wide` at `number`: `VB0 and VB1`, `VB0 to VB3`.
  static std::string parts_text(Area area, Width wide, Width part, std::uint32_t number) {
    const std::uint32_t last = number + bytes_of(wide) - bytes_of(part);
    return fmt::format("{} {} {}", address_text(area, part, number, 0), bytes_of(wide) == 2 * bytes_of(part) ? "and" : "to",
                       address_text(area, part, last, 0));
  }

  /// The hint says what an address of the wrong width has to do with the one of the right width. That is other memory, so it
  /// is not what to write without a thought.
  std::string width_hint(Area area, Width width, std::uint32_t number) const {
    const std::string fitting = address_text(area, rule_.width, number, 0);
    if (rule_.counted != 0 && width != Width::Bit && rule_.width != Width::Bit)
      return fmt::format("{} works on {}s: {} is where {} begins", instruction_.mnemonic, name_of(rule_.width), fitting,
                         text());
    if (rule_.width == Width::Bit) return bits_text(area, width, number);
    if (width == Width::Bit)
      return fmt::format("{} is {} to {}", fitting, address_text(area, Width::Bit, number, 0),
                         address_text(area, Width::Bit, number + bytes_of(rule_.width) - 1, 7));
    if (width > rule_.width)
      return fmt::format("its {}s are {}", name_of(rule_.width), parts_text(area, width, rule_.width, number));
    return fmt::format("{} is {}{}", fitting, parts_text(area, rule_.width, width, number), conversion_hint(width));
  }

  /// `; BTI makes a word of a byte`, if the CPU can.
  std::string conversion_hint(Width width) const {
    const std::string_view mnemonic = width == Width::Byte && rule_.width == Width::Word     ? "BTI"
                                      : width == Width::Word && rule_.width == Width::Double ? "ITD"
                                                                                             : "";
    const Instruction* conversion = find_instruction(mnemonic);
    if (!conversion || rule_.role != Role::In || rule_.real || (conversion->cpus & model_.self) == 0) return {};
    return fmt::format("; {} makes a {} of a {}", mnemonic, name_of(rule_.width), name_of(width));
  }

  Result area_refused(Area area) {
    if (rule_.role != Role::In && (area == Area::AI || area == Area::HC))
      return error(fmt::format("{} is read-only", text()),
                   fmt::format("{} takes {}", of_instruction(), areas_text(rule_, model_)));
    if (rule_.role != Role::Out && area == Area::AQ)
      return error(fmt::format("{} is write-only", text()),
                   fmt::format("{} takes {}", of_instruction(), areas_text(rule_, model_)));
    return wrong_kind();
  }

  bool in_range(const stl::Address& address, Area area, Width width) {
    const std::uint32_t size = model_.size_of(area);
    const std::uint64_t end = std::uint64_t{address.number} + (is_numbered(area) ? 1 : bytes_of(width));
    const bool odd = (area == Area::AI || area == Area::AQ) && address.number % 2 != 0;
    if (end <= size && address.bit < 8 && !odd) return area != Area::HC || counter_exists(address.number);
    error(odd ? fmt::format("{} is an odd address; analog values are at even ones", text())
              : fmt::format("{} does not exist on CPU {}", text(), model_.name),
          fmt::format("{} memory is {}", info(area).name, range_text(model_, area, width)),
          odd ? "" : fmt::format("end of {}", info(area).name));
    return false;
  }

  bool timer_fits(const stl::Address& address) {
    if (rule_.timer == TimerKind::Any) return true;
    const TimerBase timer = timer_base(address.number);
    if (timer.retentive == (rule_.timer == TimerKind::Retentive)) return true;
    const std::string_view other = rule_.timer == TimerKind::OffDelay ? "off-delay timers" : "on-delay timers";
    error(fmt::format("{} is {}, {} takes {}", text(), timer.retentive ? "a retentive timer" : "an on-delay timer",
                      instruction_.mnemonic, timer.retentive ? other : "retentive timers"),
          timer.retentive ? fmt::format("{} are T32 to T63 and T96 and above; T0 to T31 and T64 to T95 are for TONR", other)
                          : "retentive timers are T0 to T31 and T64 to T95; T32 to T63 and T96 and above are for TON");
    return false;
  }

  bool may_use_special_memory(const stl::Address& address, Area area) {
    if (area != Area::SM) return true;
    if (rule_.role != Role::In && address.number < kReadOnlySpecialMemory) {
      error(fmt::format("{} is read-only", text()),
            fmt::format("only the CPU writes SM0.0 to SM{}.7", kReadOnlySpecialMemory - 1));
      return false;
    }
    const SpecialMemory* refused = refused_special_memory(model_, {address.number, width()});
    if (!refused) return true;
    error(fmt::format("{} ({}) are not modelled", bytes_text(*refused), refused->meaning), std::string(refused->why),
          bytes_text(*refused));
    return false;
  }

  Operand place(const stl::Address& address, Area area) const {
    const AreaInfo& a = info(area);
    if (rule_.width == Width::Bit && is_numbered(area))
      return {.at = a.bits + address.number / 8, .bit = static_cast<std::uint8_t>(address.number % 8)};
    if (rule_.width == Width::Bit) return {.at = a.bits + address.number, .bit = address.bit};
    if (area == Area::AC) return {.at = a.base + 4 * address.number + 4u - width(), .width = width()};
    return {.at = a.base + std::max(1u, a.element) * address.number, .width = width()};
  }

  // --- pointers ---

  Result address_of(const stl::AddressOf& operand) {
    if (!rule_.address_of) return wrong_kind();
    const auto area = known_area(operand.target, Width::Byte);
    if (!area) return {};
    const auto width = width_of(operand.target, *area);
    const auto pointer = pointer_to(model_, *area, width.value_or(Width::Double), operand.target.number);
    if (!pointer)
      return error(fmt::format("a pointer cannot point to {}", stl::to_text({operand.target, {}})),
                   pointer_targets_text(model_));
    if (!in_range(operand.target, *area, *width)) return {};
    return pooled(*pointer);
  }

  Result indirect(const stl::Indirect& operand) {
    if (!rule_.pointer) return wrong_kind();
    const auto area = known_area(operand.pointer, Width::Double);
    if (!area) return {};
    const bool in_accumulator = *area == Area::AC && operand.pointer.size != stl::Size::Byte &&
                                operand.pointer.size != stl::Size::Word && operand.pointer.size != stl::Size::Bit;
    const bool in_memory = (*area == Area::V || *area == Area::L) && operand.pointer.size == stl::Size::Double;
    if (!in_accumulator && !in_memory)
      return error(fmt::format("{} cannot hold a pointer", stl::to_text({operand.pointer, {}})),
                   fmt::format("a pointer is a double word of V memory (*VD100){} or an accumulator (*AC1 to *AC3)",
                               model_.size_of(Area::L) != 0 ? ", or of L memory," : ""));
    if (in_accumulator && operand.pointer.number == 0) return error("AC0 cannot hold a pointer", "use AC1, AC2 or AC3");
    if (!in_range(operand.pointer, *area, Width::Double)) return {};
    const AreaInfo& a = info(*area);
    return PlacedOperand{
        {.at = a.base + std::max(1u, a.element) * operand.pointer.number, .pointer = true, .width = width()}, {}, {}};
  }

  // --- strings ---

  /// A constant: its length byte and its characters.
  Result string(const std::string& written) {
    if (!rule_.constant) return constant_refused();
    const auto characters = stl::parse_characters(written);
    if (!characters) return error(characters.why());
    if (characters->size() > kLongestStringConstant)
      return error(fmt::format("{} has {} characters", text(), characters->size()),
                   fmt::format("a string constant has {} at most", kLongestStringConstant));
    return PlacedOperand{{.at = constants_.place(*characters)}, {}, {}};
  }

  Result name(const stl::Name& name) {
    if (rule_.text && name.text.size() >= 2 && name.text.front() == '"' && name.text.back() == '"')
      return string(name.text.substr(1, name.text.size() - 2));
    const std::string upper = stl::upper_case(name.text);
    if (rule_.real && (upper == "NAN" || upper == "INF" || upper == "INFINITY"))
      return error(fmt::format("{} cannot be {}", of_instruction(), text()),
                   "a real is 0.0, or 1.175495E-38 to 3.402823E+38 or its negative");
    if (!name.reason.empty() &&
        std::ranges::find(diagnostics_, name.reason, &stl::Diagnostic::cause) != diagnostics_.end())
      return {};  // its table has the message
    if (!name.reason.empty()) return error(name.reason);
    const bool constant = upper == "TRUE" || upper == "FALSE" || upper == "ON" || upper == "OFF";
    if (const auto meant = stl::look_alike_operand(name.text))
      return error(fmt::format("{} has {}", text(), meant->wrong), fmt::format("write {}", meant->meant), stl::kLookAlikes);
    return error(fmt::format("'{}' is neither an address nor a defined symbol", text()),
                 constant ? "constants such as TRUE are for parameters of CALL"
                          : "give its symbol table too, s7200 check PROGRAM SYMBOLS, or write the address itself",
                 kUndefinedSymbols);
  }

  const Instruction& instruction_;
  const OperandRule& rule_;
  const stl::Operand& written_;
  const CpuModel& model_;
  ConstantPool& constants_;
  stl::Diagnostics& diagnostics_;
};

}  // namespace

std::uint32_t ConstantPool::place(std::uint32_t value, std::uint32_t width) {
  if (width < 4) value &= (1u << (8 * width)) - 1;
  const auto [found, added] =
      places_.try_emplace({value, width}, image::kConstants + static_cast<std::uint32_t>(bytes_.size()));
  if (added)
    for (std::uint32_t shift = 8 * width; shift > 0; shift -= 8)
      bytes_.push_back(static_cast<std::uint8_t>(value >> (shift - 8)));
  return found->second;
}

std::uint32_t ConstantPool::place(const std::string& characters) {
  const auto [found, added] = texts_.try_emplace(characters, image::kConstants + static_cast<std::uint32_t>(bytes_.size()));
  if (added) {
    bytes_.push_back(static_cast<std::uint8_t>(characters.size()));
    bytes_.insert(bytes_.end(), characters.begin(), characters.end());
  }
  return found->second;
}

bool names_width(const stl::Address& address, Area area) {
  return address.size != stl::Size::None || is_numbered(area) || area == Area::AI || area == Area::AQ;
}

std::string_view name_of(Width width) {
  switch (width) {
    case Width::Bit:
      return "bit";
    case Width::Byte:
      return "byte";
    case Width::Word:
      return "word";
    case Width::Double:
      return "double word";
  }
  return {};
}

std::optional<std::uint32_t> pointer_to(const CpuModel& model, Area area, Width width, std::uint32_t number) {
  const auto code = model.pointer_code(area);
  if (!code || width == Width::Bit) return {};
  return std::uint32_t{*code} << 24 | std::max(1u, info(area).element) * number;
}

std::string pointer_targets_text(const CpuModel& model) {
  return model.pointer_code(Area::SM)
             ? "a pointer can point to bytes of I, Q, M, V, S or SM, to words of AI or AQ, or to the current value of a T "
               "or C"
             : "a pointer can point to bytes of I, Q, M, V or S, or to the current value of a T or C";
}

std::optional<Width> width_of(const stl::Address& address, Area area) {
  switch (address.size) {
    case stl::Size::Bit:
      return Width::Bit;
    case stl::Size::Byte:
      return Width::Byte;
    case stl::Size::Word:
      return Width::Word;
    case stl::Size::Double:
      return Width::Double;
    case stl::Size::None:
      break;
  }
  switch (area) {
    case Area::AC:
      return {};
    case Area::HC:
      return Width::Double;
    default:
      return Width::Word;  // T, C current values; AI, AQ
  }
}

std::string address_text(Area area, Width width, std::uint32_t number, std::uint8_t bit) {
  const std::string_view name = info(area).name;
  if (is_numbered(area)) return fmt::format("{}{}", name, number);
  if (width == Width::Bit) return fmt::format("{}{}.{}", name, number, bit);
  return fmt::format("{}{}{}", name, letter_of(width), number);
}

std::string byte_text(std::uint32_t place) {
  const AreaInfo& area = area_at(place);
  return address_text(area.area, Width::Byte, place - area.base, 0);
}

std::string range_text(const CpuModel& model, Area area, Width width) {
  const std::uint32_t size = model.size_of(area);
  if (is_numbered(area)) return fmt::format("{0}0 to {0}{1}", info(area).name, size - 1);
  if (width == Width::Bit) return fmt::format("{0}0.0 to {0}{1}.7", info(area).name, size - 1);
  const std::uint32_t last = area == Area::AI || area == Area::AQ ? size - 2 : size - bytes_of(width);
  return fmt::format("{} to {}", address_text(area, width, 0, 0), address_text(area, width, last, 0));
}

std::optional<PlacedOperand> place_operand(const Instruction& instruction, const OperandRule& rule,
                                           const stl::Operand& written, const CpuModel& model, ConstantPool& constants,
                                           stl::Diagnostics& diagnostics) {
  return Placing(instruction, rule, written, model, constants, diagnostics).result();
}

}  // namespace s7200
