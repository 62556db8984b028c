#include "tests/vectors/cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <stdexcept>

#include "interpreter/model/cpu_model.hpp"

namespace s7200::vectors {
namespace {

using s7200::OperandRule;

/// How an operand is written.
struct Form {
  enum Kind { Direct, Constant, AddressOf, PointerInV, PointerInAc, PointerInL } kind = Direct;
  Area area = Area::V;

  bool operator==(const Form&) const = default;
};

/// What an operand is called in a vector, and what must be there before.
struct Written {
  std::string text;
  std::vector<std::string> before;
};

// --- places ---

char letter(Width width) { return width == Width::Byte ? 'B' : width == Width::Word ? 'W' : 'D'; }

std::uint32_t first_number(Area area, const OperandRule& rule, std::size_t operand) {
  switch (area) {
    case Area::V:
      return 10 + 10 * static_cast<std::uint32_t>(operand);
    case Area::L:
      return 10 + 10 * static_cast<std::uint32_t>(operand);
    case Area::M:
      return 4;
    case Area::SM:
      return rule.role == Role::In ? 22 : 38;
    case Area::S:
      return 5;
    case Area::T:
      return rule.timer == TimerKind::Retentive ? 5 : 37;
    case Area::C:
      return 5;
    case Area::AI:
      return 4;
    case Area::AQ:
      return 6;
    case Area::HC:
      return 1;
    default:
      return 0;
  }
}

/// The address `k` elements after a first one; `in_vector`: as vectors write it.
std::string address(Area area, Width width, std::uint32_t first, std::uint32_t k, bool in_vector) {
  const std::string_view name = info(area).name;
  if (width == Width::Bit) {
    if (area == Area::T || area == Area::C) return fmt::format("{}{}{}", name, first + k, in_vector ? ".bit" : "");
    return fmt::format("{}{}.{}", name, first + (3 + k) / 8, (3 + k) % 8);
  }
  if (area == Area::AC || area == Area::HC || area == Area::T || area == Area::C)
    return fmt::format("{}{}", name, first + k);
  return fmt::format("{}{}{}", name, letter(width), first + k * bytes_of(width));
}

std::string value_text(Area area, Width width, std::uint32_t value) {
  if (width == Width::Bit) return std::to_string(value);
  if (area == Area::T || area == Area::C) return std::to_string(static_cast<std::int16_t>(value));
  if (area == Area::HC) return fmt::format("16#{:08X}", value);
  return fmt::format("16#{:0{}X}", value, 2 * bytes_of(width));
}

/// The upper bytes of an accumulator, to show that they stay.
std::uint32_t in_accumulator(Width width, std::uint32_t value) {
  return width == Width::Byte ? 0xA5A5'A500 | (value & 0xFF) : width == Width::Word ? 0xA5A5'0000 | (value & 0xFFFF) : value;
}

std::vector<std::string> elements_at(Area area, Width width, std::uint32_t first, const Elements& elements) {
  std::vector<std::string> result;
  for (std::uint32_t k = 0; k < elements.size(); ++k) {
    const std::string place = address(area, width, first, k, true);
    const std::string value = area == Area::AC ? fmt::format("16#{:08X}", in_accumulator(width, elements[k]))
                                               : value_text(area, width, elements[k]);
    result.push_back(place + "=" + value);
  }
  return result;
}

/// The pointer to a place, and what is there: inputs or outputs for an operand that can be nothing else.
struct Target {
  Area area;
  std::uint32_t first;

  std::uint32_t pointer() const { return std::uint32_t{*info(area).pointer_code} << 24 | first; }
};

Target target_of(const OperandRule& rule, Target usual) {
  for (const Area points : {Area::I, Area::Q})
    if (rule.areas == set_of(points)) return {points, 4};
  return usual;
}

/// A string from its length and its characters.
std::string string_text(const Elements& elements) {
  std::string text = "\"";
  for (std::size_t i = 1; i < elements.size() && i <= elements[0]; ++i) text += static_cast<char>(elements[i]);
  return text + "\"";
}

std::string constant_text(const OperandRule& rule, std::uint32_t value) {
  if (rule.kind != OperandKind::Memory) return std::to_string(value);
  if (rule.real) return fmt::format("{:.1f}", static_cast<double>(std::bit_cast<float>(value)));
  if (rule.min < 0 && rule.min > -1000) return std::to_string(static_cast<std::int8_t>(value));
  return value < 100 || rule.name == "N" ? std::to_string(value) : fmt::format("16#{:X}", value);
}

Written pointed(const std::string& holder, const Target& target, Width width, const Elements& elements) {
  Written written{"*" + holder, {fmt::format("{}=16#{:08X}", holder, target.pointer())}};
  std::ranges::copy(elements_at(target.area, width, target.first, elements), std::back_inserter(written.before));
  return written;
}

Written write_operand(const Form& form, const OperandRule& rule, std::size_t operand, const Elements& elements) {
  const auto i = static_cast<std::uint32_t>(operand);
  const Target in_v = target_of(rule, {Area::V, 60 + 20 * i}), in_m = target_of(rule, {Area::M, 4 + 8 * i});
  switch (form.kind) {
    case Form::Constant:
      return {rule.text ? string_text(elements) : constant_text(rule, elements.at(0)), {}};
    case Form::AddressOf:
      return {"&VB100", {}};
    case Form::PointerInV:
      return pointed(fmt::format("VD{}", 40 + 4 * i), in_v, rule.width, elements);
    case Form::PointerInAc:
      return pointed(fmt::format("AC{}", 1 + i), in_m, rule.width, elements);
    case Form::PointerInL:
      return pointed(fmt::format("LD{}", 40 + 4 * i), in_v, rule.width, elements);
    case Form::Direct:
      break;
  }
  const std::uint32_t first = first_number(form.area, rule, operand);
  return {address(form.area, rule.width, first, 0, false), elements_at(form.area, rule.width, first, elements)};
}

// --- forms ---

bool is_count(const OperandRule& rule) { return rule.name == "N" || rule.name == "LEN"; }
bool is_format(const OperandRule& rule) { return rule.name == "FMT"; }

/// How an operand is written if the case is not about its form.
Form usual_form(const OperandRule& rule) {
  if (rule.kind != OperandKind::Memory || is_count(rule) || is_format(rule)) return {Form::Constant};
  if (contains(rule.areas, Area::V)) return {Form::Direct, Area::V};
  for (const AreaInfo& area : all_areas())
    if (contains(rule.areas, area.area)) return {Form::Direct, area.area};
  return {Form::Constant};
}

std::vector<Form> forms_of(const OperandRule& rule, const CpuModel& model) {
  std::vector<Form> forms;
  if (rule.kind != OperandKind::Memory) return forms;
  for (const AreaInfo& area : all_areas())
    if (contains(rule.areas, area.area) && model.size_of(area.area) != 0) forms.push_back({Form::Direct, area.area});
  if (rule.constant) forms.push_back({Form::Constant});
  if (rule.address_of) forms.push_back({Form::AddressOf});
  if (rule.pointer) forms.push_back({Form::PointerInV});
  if (rule.pointer) forms.push_back({Form::PointerInAc});
  if (rule.pointer && model.size_of(Area::L) != 0) forms.push_back({Form::PointerInL});
  return forms;
}

/// Puts the cases of one instruction together.
class Cases {
 public:
  Cases(const Instruction& instruction, const CpuModel& model)
      : instruction_(instruction), model_(model), values_(values_of(instruction.mnemonic)) {}

  std::vector<Case> all() {
    const bool adds = &model_ != &cpu214() && (instruction_.cpus & kCpu214);
    if (!adds)
      for (const Case& program : programs_of(instruction_.mnemonic)) cases_.push_back(program);
    if (values_.empty()) return std::move(cases_);
    for (const Values& values : values_) add(values, usual_forms());
    if (adds) {
      for (std::size_t i = 0; i < instruction_.rules().size(); ++i)
        vary_form(i, forms_of(instruction_.operand[i], cpu214()));
      return std::move(cases_);
    }
    for (std::size_t i = 0; i < instruction_.rules().size(); ++i) vary_form(i);
    all_pointers();
    for (std::size_t i = 0; i < instruction_.rules().size(); ++i) bad_pointers(i);
    count_errors();
    if (instruction_.rung.needs_power_flow) without_power();
    return std::move(cases_);
  }

 private:
  std::vector<Form> usual_forms() const {
    std::vector<Form> forms;
    for (const OperandRule& rule : instruction_.rules()) forms.push_back(usual_form(rule));
    return forms;
  }

  /// Adds a case and returns it, to be changed.
  Case& add(const Values& values, const std::vector<Form>& forms, std::string title = {}) {
    Case result;
    result.title = std::move(title);
    result.stack = values.stack;
    result.flags = instruction_.flags;
    std::string op(instruction_.mnemonic);
    for (std::size_t i = 0; i < instruction_.rules().size(); ++i) {
      const Written written = write_operand(forms[i], instruction_.operand[i], i, values.operand.at(i));
      op += (i == 0 ? " " : ", ") + written.text;
      std::ranges::copy(written.before, std::back_inserter(result.before));
    }
    result.ops = {op};
    add_points(result);
    add_current_values(result);
    cases_.push_back(std::move(result));
    return cases_.back();
  }

  /// Immediate instructions meet a point that differs from its image.
  void add_points(Case& result) const {
    if (instruction_.hidden == Hidden::InputPoint) {
      for (std::string& text : result.before) {
        Assignment point = *parse_assignment(text);
        Assignment image = point;
        point.area = "PI";
        image.value = 1 - image.value;
        text = to_text(point);
        result.before.push_back(to_text(image));
        return;
      }
    }
    if (instruction_.mnemonic == "BIR")
      for (std::string& text : result.before) {
        Assignment point = *parse_assignment(text);
        if (point.area != "I") continue;
        point.area = "PI";
        text = to_text(point);
      }
    if (instruction_.hidden != Hidden::OutputPoint) return;
    result.before.insert(result.before.begin(), instruction_.mnemonic == "RI" ? "PQB0=16#FF" : "PQB0=16#00");
  }

  /// S and R on timers and counters: what happens to the current values.
  void add_current_values(Case& result) const {
    if (instruction_.mnemonic != "S" && instruction_.mnemonic != "R") return;
    for (const std::string& text : std::vector(result.before)) {
      const Assignment bit = *parse_assignment(text);
      if (bit.area.ends_with(".bit"))
        result.before.push_back(fmt::format("{}{}=5", bit.area.substr(0, 1), bit.at * 8 + bit.bit));
    }
  }

  /// Each form but the usual one, and those in `known`.
  void vary_form(std::size_t i, const std::vector<Form>& known = {}) {
    for (const Form& form : forms_of(instruction_.operand[i], model_)) {
      if (std::ranges::find(known, form) != known.end()) continue;
      const Form usual = usual_form(instruction_.operand[i]);
      if (form.kind == usual.kind && (form.kind == Form::Constant || form.area == usual.area)) continue;
      std::vector<Form> forms = usual_forms();
      forms[i] = form;
      add(values_.front(), forms);
    }
  }

  void all_pointers() {
    std::vector<Form> forms = usual_forms();
    std::ptrdiff_t pointers = 0;
    for (std::size_t i = 0; i < forms.size(); ++i)
      if (instruction_.operand[i].pointer) {
        forms[i] = {pointers % 2 == 0 ? Form::PointerInV : Form::PointerInAc};
        ++pointers;
      }
    if (pointers > 1) add(values_.front(), forms, "each pointer costs its time");
  }

  void bad_pointers(std::size_t i) {
    const OperandRule& rule = instruction_.operand[i];
    if (!rule.pointer) return;
    std::vector<Form> forms = usual_forms();
    forms[i] = {Form::PointerInV};
    const auto with_pointer = [&](std::uint32_t pointer, std::string title) {
      Case& added = add(values_.front(), forms, std::move(title));
      const std::string holder = fmt::format("VD{}=", 40 + 4 * i);
      for (std::string& text : added.before)
        if (text.starts_with(holder)) text = fmt::format("{}16#{:08X}", holder, pointer);
    };
    with_pointer(0x0300'0000, "a pointer to no area");
    with_pointer(0x0800'0000 + model_.size_of(Area::V) - bytes_of(rule.width) + 1, "a pointer across the end of V memory");
  }

  /// N in memory: 0, and more than the area holds from its last element.
  void count_errors() {
    if (instruction_.rules().empty()) return;
    const std::size_t last = instruction_.rules().size() - 1;
    if (!is_count(instruction_.operand[last])) return;
    std::vector<Form> forms = usual_forms();
    forms[last] = {Form::Direct, Area::V};
    Values values = values_.front();
    values.operand[last] = {0};
    add(values, forms, "a count of 0");
    if (instruction_.mnemonic == "SHRB") {
      for (const std::uint32_t count : {65u, 0xBFu, 0x80u}) {
        values.operand[last] = {count};
        add(values, forms, "a count beyond 64");
      }
    }
    for (std::size_t i = 0; i < last; ++i)
      if (instruction_.operand[i].counted != 0) over_the_end(i, last);
  }

  void over_the_end(std::size_t i, std::size_t last) {
    std::vector<Form> forms = usual_forms();
    forms[last] = {Form::Direct, Area::V};
    Values values = values_.front();
    Case& added = add(values, forms, "beyond the end of the area: nothing is done");
    const OperandRule& rule = instruction_.operand[i];
    const std::string here = write_operand(forms[i], rule, i, values.operand[i]).text;
    const std::string end = forms[i].area == Area::Q ? fmt::format("Q{}.6", model_.size_of(Area::Q) - 1)
                            : rule.width == Width::Bit
                                ? fmt::format("V{}.6", model_.size_of(Area::V) - 1)
                                : fmt::format("V{}{}", letter(rule.width), model_.size_of(Area::V) - bytes_of(rule.width));
    added.ops[0].replace(added.ops[0].find(here), here.size(), end);
  }

  void without_power() {
    Values values = values_.front();
    values.stack = {false, true};
    Case& added = add(values, usual_forms(), "no power flow");
    added.flags = 0;
  }

  const Instruction& instruction_;
  const CpuModel& model_;
  std::vector<Values> values_;
  std::vector<Case> cases_;
};

}  // namespace

std::vector<Case> cases_of(const Instruction& instruction, const CpuModel& model) { return Cases(instruction, model).all(); }

std::string source_of(const Instruction& instruction) {
  static const std::map<std::string_view, std::string_view> kSections{{"Bit logic", "6.2"},
                                                                      {"Compare contacts", "6.3"},
                                                                      {"Timers and counters", "6.4"},
                                                                      {"Move", "6.5"},
                                                                      {"Integer arithmetic", "6.6"},
                                                                      {"Real arithmetic", "6.6"},
                                                                      {"Logic operations", "6.7"},
                                                                      {"Shift and rotate", "6.8"},
                                                                      {"Conversion", "6.9"},
                                                                      {"Tables", "6.10"},
                                                                      {"Strings", "10.7"},
                                                                      {"Program control", "6.12"},
                                                                      {"Sequence control relays", "6.12"},
                                                                      {"Interrupts", "3.3"}};
  const auto found = kSections.find(instruction.group);
  if (found == kSections.end()) throw std::runtime_error(fmt::format("no section for group {}", instruction.group));
  return fmt::format("facts {}", found->second);
}

}  // namespace s7200::vectors
