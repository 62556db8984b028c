#include "interpreter/trace/program_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "interpreter/trace/text/statement_text.hpp"

namespace s7200 {
namespace {

constexpr std::size_t kMostSteps = 100;  // of a routine; a loop may call many

/// Only a scan that WDR prolongs does more.
constexpr std::size_t kLongestCourse = 1'000'000;

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
      ended_ = in_interrupt_ = interrupt_ends_ = false;
      course_.clear();
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
      const bool stopped_meanwhile = known_ && record.code == 0 && !ended_ && !course_.empty();
      const std::string text = stopped_meanwhile ? "main program until then: " + text_of(way_of(course_)) : "";
      forget();
      return text;
    }
    default:
      break;
  }
  return {};
}

const std::string* ProgramPath::of(const InstructionRecord& record) {
  const bool failed = std::exchange(failed_, false);
  if (in_interrupt_) {
    if (interrupt_ends_) in_interrupt_ = interrupt_ends_ = false;
    return nullptr;
  }
  const Role role = role_[record.op];
  if (!known_ || ended_ || role == Role::None) return nullptr;
  const bool flows = role == Role::Coil ? record.top : record.powered;
  const bool happens = role == Role::Return || (flows && role != Role::End && !(role == Role::Call && failed));
  if (happens && course_.size() < kLongestCourse) course_.push_back(record.op);
  ended_ = role == Role::End || (role == Role::ConditionalEnd && record.powered);
  return ended_ && takes_new_way() ? &other_.text : nullptr;
}

/// At the end of the main program. `other_` is that way then.
bool ProgramPath::takes_new_way() {
  const auto known = before_.begin() + static_cast<std::ptrdiff_t>(known_before_);
  bool is_new = std::find(before_.begin(), known, course_) == known;
  if (is_new) {
    if (course_ != other_.course) other_ = {course_, way_of(course_), {}};
    is_new = std::none_of(before_.begin(), known, [&](const Course& one) { return way_of(one) == other_.way; });
    if (is_new && other_.text.empty()) other_.text = "main program: " + text_of(other_.way);
  }
  std::swap(before_[0], before_[1]);
  std::swap(before_[0], course_);
  known_before_ = std::min(known_before_ + 1, before_.size());
  return is_new;
}

void ProgramPath::add(Way& way, Step step) {
  const auto same = std::find_if(way.rbegin(), way.rend(), [&](const Step& known) { return known.repeats(step); });
  if (same != way.rend()) {
    same->times += step.what == What::Network ? 0 : 1;
  } else if (way.size() < kMostSteps) {
    way.push_back(std::move(step));
  } else if (way.size() == kMostSteps) {
    way.push_back({.what = What::More});
  }
}

void ProgramPath::return_from_subroutine(std::vector<Called>& open) {
  if (open.size() < 2) return;
  Called called = std::move(open.back());
  open.pop_back();
  add(open.back().way, {.what = What::Call, .op = called.by, .inside = std::move(called.way)});
}

void ProgramPath::take(std::vector<Called>& open, std::uint32_t op) const {
  const Role role = role_[op];
  if (role == Role::Return) return return_from_subroutine(open);
  Way& way = open.back().way;
  const std::uint32_t network = networks_.first_of(op);
  if (way.empty() || way.back().what != What::Network || way.back().op != network)
    add(way, {.what = What::Network, .op = network});
  if (role == Role::Box || role == Role::Coil) return;
  if (role == Role::Call) return open.push_back({.by = op});
  add(way, {.what = role == Role::Jump ? What::Jump : What::Leave, .op = op});
  if (role == Role::ConditionalReturn) return_from_subroutine(open);
}

ProgramPath::Way ProgramPath::way_of(const Course& course) const {
  std::vector<Called> open(1);
  for (const std::uint32_t op : course) take(open, op);
  while (open.size() > 1) return_from_subroutine(open);
  if (course.size() == kLongestCourse) open.front().way.push_back({.what = What::More});
  return std::move(open.front().way);
}

std::string ProgramPath::text_of(const Step& step, std::size_t depth) const {
  const std::string place = line_of(step.op, program_);
  const Op& op = program_.ops[step.op];
  switch (step.what) {
    case What::Network:
      return place;
    case What::Call:
      return fmt::format(
          "CALL {} in {}{}{}", op[0].at, place, times_text(step.times),
          step.inside.empty() || depth == deepest_ ? "" : fmt::format(" ({})", text_of(step.inside, depth + 1)));
    case What::Jump:
      return fmt::format("JMP {} in {}{}", op[0].at, place, times_text(step.times));
    case What::Leave:
      return fmt::format("{} in {}{}", op.instruction->mnemonic, place, times_text(step.times));
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
