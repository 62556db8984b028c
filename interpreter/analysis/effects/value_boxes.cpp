#include "interpreter/analysis/effects/value_boxes.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "interpreter/base/bytes.hpp"

namespace s7200 {
namespace {

ValueSet carried(const ValueSet& in, const ValueSet&) { return in; }
ValueSet added_up(const ValueSet& in, const ValueSet& old) { return old.plus(in); }
ValueSet taken_off(const ValueSet& in, const ValueSet& old) { return old.plus(in.negated()); }
ValueSet multiplied(const ValueSet& in, const ValueSet& old) { return old.times(in); }
ValueSet one_more(const ValueSet&, const ValueSet& old) { return old.plus({1, 1}); }
ValueSet one_less(const ValueSet&, const ValueSet& old) { return old.plus({-1, -1}); }

const ValueSet kAnyDouble = ValueSet::all_of(Width::Double);

ValueSet divided(const ValueSet& in, const ValueSet& old) {
  const auto divisor = in.single();
  return divisor && *divisor > 0 ? old.divided_by(*divisor) : kAnyDouble;
}
ValueSet masked_value(const ValueSet& in, const ValueSet& old) {
  std::optional<std::int64_t> most;
  for (const ValueSet* each : {&in, &old}) {
    if (each->empty()) return {};
    if (each->least() >= 0) most = std::min(most.value_or(each->most()), each->most());
  }
  return most ? ValueSet(0, *most) : kAnyDouble;
}
ValueSet shifted_left(const ValueSet& places, const ValueSet& old) {
  const auto by = places.single();
  return by && *by <= 31 ? old.times({std::int64_t{1} << *by, std::int64_t{1} << *by}) : kAnyDouble;
}
ValueSet shifted_right(const ValueSet& places, const ValueSet& old) {
  const auto by = places.single();
  return by && *by <= 31 && !old.empty() && old.least() >= 0 ? old.divided_by(std::int64_t{1} << *by) : kAnyDouble;
}

struct Computation {
  std::string_view mnemonic;
  ValueBox::Computes result;
};
constexpr std::array kComputations{
    Computation{"MOVB", carried},      Computation{"MOVW", carried},      Computation{"MOVD", carried},
    Computation{"BTI", carried},       Computation{"ITB", carried},       Computation{"ITD", carried},
    Computation{"DTI", carried},       Computation{"INCB", one_more},     Computation{"INCW", one_more},
    Computation{"INCD", one_more},     Computation{"DECB", one_less},     Computation{"DECW", one_less},
    Computation{"DECD", one_less},     Computation{"+I", added_up},       Computation{"+D", added_up},
    Computation{"-I", taken_off},      Computation{"-D", taken_off},      Computation{"*I", multiplied},
    Computation{"*D", multiplied},     Computation{"/I", divided},        Computation{"/D", divided},
    Computation{"ANDB", masked_value}, Computation{"ANDW", masked_value}, Computation{"ANDD", masked_value},
    Computation{"SLB", shifted_left},  Computation{"SLW", shifted_left},  Computation{"SLD", shifted_left},
    Computation{"SRB", shifted_right}, Computation{"SRW", shifted_right}, Computation{"SRD", shifted_right}};

}  // namespace

bool ValueBox::carries() const { return result == carried; }

std::optional<ValueBox> value_box_of(const Instruction& instruction) {
  const auto found = std::ranges::find(kComputations, instruction.mnemonic, &Computation::mnemonic);
  if (found == kComputations.end()) return {};
  ValueBox box{.result = found->result, .to = 0, .from = {}};
  for (std::uint8_t i = 0; i < instruction.rules().size(); ++i) {
    if (instruction.operand[i].role == Role::In)
      box.from = i;
    else
      box.to = i;
  }
  return box;
}

std::optional<std::int64_t> constant_value(const Program& program, const Operand& operand, Width width) {
  if (operand.pointer || operand.unread() || operand.at < image::kConstants) return {};
  const std::uint8_t* at = &program.constants[operand.at - image::kConstants];
  switch (width) {
    case Width::Double:
      return static_cast<std::int32_t>(load32(at));
    case Width::Word:
      return static_cast<std::int16_t>(load16(at));
    default:
      return *at;
  }
}

std::optional<std::int64_t> step_of(const Program& program, const Op& op) {
  const std::string_view mnemonic = op.instruction->mnemonic;
  const auto box = value_box_of(*op.instruction);
  if (!box) return {};
  if (box->result == one_more) return 1;
  if (box->result == one_less) return -1;
  if (box->result != added_up && box->result != taken_off) return {};
  const auto added = constant_value(program, op[*box->from], op.instruction->operand[*box->from].width);
  if (!added || std::abs(*added) >= kAreaSize) return {};
  return mnemonic.front() == '-' ? -*added : *added;
}

ValueSet result_of(const Program& program, std::uint32_t number, const ValueBox& box, const ValueSet& in,
                   const ValueSet& old) {
  const auto step = step_of(program, program.ops[number]);
  const bool adds = step || box.result == added_up || box.result == taken_off;
  const ValueSet by = step ? ValueSet(*step, *step) : box.result == added_up ? in : in.negated();
  if (!adds || by.empty() || by.least() <= -kAreaSize || by.most() >= kAreaSize) return box.result(in, old);
  ValueSet result;
  for (const ValueRange& range : by.ranges()) result.join(counted_on(old, range));
  const bool without_end = std::ranges::any_of(
      old.ranges(), [](const ValueRange& range) { return is_limit_of_area(range.least) || is_limit_of_area(range.most); });
  if (without_end) result.blame(number);
  return result;
}

ValueSet counted_on(const ValueSet& old, const ValueRange& by) {
  ValueSet result;
  for (const ValueRange& range : old.ranges())
    result.add({range.least + (is_limit_of_area(range.least) ? 0 : by.least),
                range.most + (is_limit_of_area(range.most) ? 0 : by.most)});
  return result;
}

ValueSet with_lower_part(const ValueSet& before, std::int64_t size, const ValueSet& part) {
  const bool fits = !part.empty() && part.least() >= 0 && part.most() < size;
  ValueSet result;
  for (const ValueRange& range : before.ranges()) {
    const std::int64_t least = range.least & -size, most = range.most & -size;
    if (least == most && fits)
      result.add({least + part.least(), most + part.most()});
    else
      result.add({least, most + size - 1});
  }
  for (const ValueSet* each : {&before, &part})
    if (each->cause() != ValueSet::kNoCause) result.blame(each->cause());
  return result;
}

}  // namespace s7200
