#include "interpreter/trace/program_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace s7200 {
namespace {

constexpr std::size_t kMostSteps = 100;  // of a routine; a loop may call many

bool is_only_in(const Instruction& instruction, std::uint8_t part) { return instruction.allowed.parts == part; }

std::string times_text(std::uint64_t times) { return times == 1 ? "" : fmt::format(" {} times", times); }

/// `1-3, 7` of numbers in the order in which they came.
std::string ranges_text(const std::vector<std::uint32_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t first = i;
    while (i + 1 < numbers.size() && numbers[i + 1] == numbers[i] + 1) ++i;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", numbers[first]);
    if (i > first) text += fmt::format("-{}", numbers[i]);
  }
  return text;
}

}  // namespace

ProgramPath::ProgramPath(const Program& program, std::size_t deepest)
    : program_(program), deepest_(deepest), networks_(program) {
  std::ranges::transform(program.ops, std::back_inserter(role_), role_of);
}

ProgramPath::Role ProgramPath::role_of(const Op& op) {
  const Instruction& instruction = *op.instruction;
  const bool conditional = instruction.effect == Effect::ConditionalEnd;
  switch (instruction.structure) {
    case Structure::Jump:
      return Role::Jump;
    case Structure::Call:
      return Role::Call;
    case Structure::SubroutineEnd:
      return Role::Return;
    case Structure::MainEnd:
      return Role::End;
    case Structure::SegmentTransition:
      return Role::Leave;
    default:
      break;
  }
  if (conditional && is_only_in(instruction, kSubroutine)) return Role::ConditionalReturn;
  if (conditional && is_only_in(instruction, kMain)) return Role::ConditionalEnd;
  if (conditional) return Role::Leave;
  if (instruction.rung.needs_power_flow) return Role::Box;
  return instruction.rung.writes_output ? Role::Coil : Role::None;
}

void ProgramPath::forget() {
  known_ = in_interrupt_ = interrupt_ends_ = failed_ = false;
  known_before_ = 0;
}

std::string ProgramPath::of(const TraceRecord& record) {
  switch (record.kind) {
    case TraceKind::ScanBegin:
      known_ = true;
      in_interrupt_ = interrupt_ends_ = false;
      open_.assign(1, {});
      break;
    case TraceKind::ServiceBegin:
      in_interrupt_ = true;
      break;
    case TraceKind::ServiceEnd:
      interrupt_ends_ = true;
      break;
    case TraceKind::RuntimeError:
      failed_ = true;
      break;
    case TraceKind::ModeChange: {
      const bool stopped_meanwhile = known_ && record.code == 0 && !open_.empty() && !open_.front().way.empty();
      const std::string text = stopped_meanwhile ? "main program until then: " + text_of(whole()) : "";
      forget();
      return text;
    }
    default:
      break;
  }
  return {};
}

std::string ProgramPath::of(const InstructionRecord& record) {
  const bool failed = std::exchange(failed_, false);
  if (in_interrupt_) {
    if (interrupt_ends_) in_interrupt_ = interrupt_ends_ = false;
    return {};
  }
  const Role role = role_[record.op];
  if (!known_ || role == Role::None || open_.empty()) return {};
  if (!(role == Role::Call && failed)) take(record, role);
  const bool ends = role == Role::End || (role == Role::ConditionalEnd && record.powered);
  if (!ends) return {};
  Way way = whole();
  open_.clear();
  const auto known = before_.begin() + static_cast<std::ptrdiff_t>(known_before_);
  const bool as_before = std::find(before_.begin(), known, way) != known;
  std::swap(before_[0], before_[1]);
  before_[0] = std::move(way);
  known_before_ = std::min(known_before_ + 1, before_.size());
  return as_before ? "" : "main program: " + text_of(before_[0]);
}

void ProgramPath::take(const InstructionRecord& record, Role role) {
  const bool flows = role == Role::Coil ? record.top : record.powered;
  if (role == Role::Return) return return_from_subroutine();
  if (!flows || role == Role::End) return;
  add({.what = What::Network, .op = networks_.first_of(record.op)});
  switch (role) {
    case Role::Jump:
      return add({.what = What::Jump, .op = record.op});
    case Role::Call:
      return open_.push_back({.by = record.op});
    case Role::ConditionalReturn:
      add({.what = What::Leave, .op = record.op});
      return return_from_subroutine();
    case Role::ConditionalEnd:
    case Role::Leave:
      return add({.what = What::Leave, .op = record.op});
    default:
      return;
  }
}

void ProgramPath::add(Step step) {
  Way& way = open_.back().way;
  const auto same = std::find_if(way.rbegin(), way.rend(), [&](const Step& known) { return known.repeats(step); });
  if (same != way.rend()) {
    same->times += step.what == What::Network ? 0 : 1;
  } else if (way.size() < kMostSteps) {
    way.push_back(std::move(step));
  } else if (way.size() == kMostSteps) {
    way.push_back({.what = What::More});
  }
}

void ProgramPath::return_from_subroutine() {
  if (open_.size() < 2) return;
  Called called = std::move(open_.back());
  open_.pop_back();
  add({.what = What::Call, .op = called.by, .inside = std::move(called.way)});
}

ProgramPath::Way ProgramPath::whole() {
  while (open_.size() > 1) return_from_subroutine();
  return open_.front().way;
}

std::string ProgramPath::text_of(const Step& step, std::size_t depth) const {
  const stl::Position& place = program_.statement(step.op).position;
  const Op& op = program_.ops[step.op];
  switch (step.what) {
    case What::Network:
      return fmt::format("line {}", place.line);
    case What::Call:
      return fmt::format(
          "CALL {} in line {}{}{}", op[0].at, place.line, times_text(step.times),
          step.inside.empty() || depth == deepest_ ? "" : fmt::format(" ({})", text_of(step.inside, depth + 1)));
    case What::Jump:
      return fmt::format("JMP {} in line {}{}", op[0].at, place.line, times_text(step.times));
    case What::Leave:
      return fmt::format("{} in line {}{}", op.instruction->mnemonic, place.line, times_text(step.times));
    case What::More:
      return "…";
  }
  return {};
}

std::string ProgramPath::text_of(const Way& way, std::size_t depth) const {
  std::string text;
  const auto append = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  const auto number = [&](const Step& step) { return step.what == What::Network ? networks_.number_of(step.op) : 0; };
  for (std::size_t i = 0; i < way.size(); ++i) {
    std::vector<std::uint32_t> numbers;
    for (; i < way.size() && number(way[i]) != 0; ++i) numbers.push_back(number(way[i]));
    if (!numbers.empty()) append((numbers.size() == 1 ? "network " : "networks ") + ranges_text(numbers));
    if (i < way.size()) append(text_of(way[i], depth));
  }
  return text.empty() ? "no network has power flow" : text;
}

}  // namespace s7200
