#include "interpreter/program/checking/structure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include "interpreter/base/text/among.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/checking/warnings.hpp"
#include "interpreter/program/loading/unread.hpp"

namespace s7200 {
namespace {

std::string routine_text(Part part, std::uint32_t number) {
  if (part == kMain) return "the main program";
  return fmt::format("{} {}", part == kSubroutine ? "SBR" : "INT", number);
}

std::string_view end_of(Part part) { return part == kMain ? "MEND" : part == kSubroutine ? "RET" : "RETI"; }

/// The number after a mnemonic such as LBL, JMP, SBR, CALL or INT; already checked to be there.
std::uint32_t number_of(const CheckedStatement& s, std::size_t i = 0) {
  return static_cast<std::uint32_t>(std::get<stl::Integer>(s.statement->operands[i].value).value);
}

/// Beginnings of words for a routine in headings that people translate: `INTERRUPTPROGRAMM 0`, `Sous-programme 1`.
struct WordOfHeading {
  Part part;
  std::string_view word;
};
constexpr std::array kWordsOfHeadings{WordOfHeading{kSubroutine, "SBR"},   WordOfHeading{kSubroutine, "SUB"},
                                      WordOfHeading{kSubroutine, "UNTER"}, WordOfHeading{kSubroutine, "SOUS"},
                                      WordOfHeading{kSubroutine, "SOTTO"}, WordOfHeading{kSubroutine, "\u5B50\u7A0B\u5E8F"},
                                      WordOfHeading{kInterrupt, "INT"},    WordOfHeading{kInterrupt, "\u4E2D\u65AD"}};

/// Whether a line that could not be read may be the heading of a routine: it has the routine's number and such a word.
bool may_be_heading(std::string_view line, Part part, std::uint32_t number) {
  const std::string capitals = stl::upper_case(line), digits = std::to_string(number);
  const auto is_in_line = [&](const WordOfHeading& each) {
    return each.part == part && capitals.find(each.word) != std::string::npos;
  };
  if (std::ranges::none_of(kWordsOfHeadings, is_in_line)) return false;
  const auto has_digit = [&](std::size_t at) { return at < line.size() && stl::is_digit(line[at]); };
  for (std::size_t at = line.find(digits); at != std::string_view::npos; at = line.find(digits, at + 1))
    if ((at == 0 || !has_digit(at - 1)) && !has_digit(at + digits.size())) return true;
  return false;
}

class StructureCheck {
 public:
  StructureCheck(const std::vector<CheckedStatement>& statements, const std::vector<std::string>& text,
                 const CpuModel& model, stl::Diagnostics& diagnostics)
      : statements_(statements), text_(text), model_(model), diagnostics_(diagnostics) {
    result_.target.assign(statements.size(), 0);
    result_.head.assign(statements.size(), 0);
    result_.in_segment.assign(statements.size(), false);
    segment_of_.assign(statements.size(), kNoSegment);
    result_.subroutine.fill(kNoRoutine);
    result_.interrupt.fill(kNoRoutine);
  }

  ProgramStructure run() {
    for (std::uint32_t i = 0; i < statements_.size(); ++i) visit(i);
    end_routine();
    if (!ended_ && !statements_.empty()) missing_end(statements_.back().statement->position);
    check_jumps();
    check_calls();
    check_attachments();
    warn_of_unused();
    warn_of_recursion();
    return std::move(result_);
  }

 private:
  static constexpr std::uint32_t kNoSegment = 0xFFFF'FFFF;

  /// The main program, a subroutine or an interrupt routine.
  struct Routine {
    Part part = kMain;
    std::uint32_t number = 0;
    bool operator==(const Routine&) const = default;
    auto operator<=>(const Routine&) const = default;
  };

  struct Place {
    std::uint32_t statement;
    Routine routine;
  };

  void error(const stl::Position& at, std::string message, std::string hint = {}, std::string cause = {}) {
    diagnostics_.push_back({stl::Severity::Error, at, std::move(message), std::move(hint), std::move(cause)});
  }
  void warning(Warning warning, const stl::Position& at, std::string message, std::string hint = {}) {
    diagnostics_.push_back(warn(warning, at, std::move(message), std::move(hint)));
  }
  const stl::Position& position(std::uint32_t i) const { return statements_[i].statement->position; }

  void visit(std::uint32_t i) {
    const CheckedStatement& s = statements_[i];
    if (s.instruction == &unread_instruction()) return may_be_anything(i);
    switch (s.instruction->structure) {
      case Structure::SubroutineHead:
        return begin_routine(i, kSubroutine, subroutines_);
      case Structure::InterruptHead:
        return begin_routine(i, kInterrupt, interrupts_);
      default:
        break;
    }
    if (ended_) return stray(i);
    if (!(s.instruction->allowed.on(model_.self) & routine_.part)) return not_allowed(i);
    if (segment_) {
      segment_of_[i] = *segment_;
      result_.in_segment[i] = true;
      if (s.instruction->outside_segments) not_allowed_in_segment(i);
    }
    note(i, s);
  }

  /// A statement that could not be read may jump to any label, and call or attach any routine.
  void may_be_anything(std::uint32_t i) {
    unread_lines_.push_back(position(i).line);
    all_jumps_known_ = all_calls_known_ = all_attachments_known_ = false;
    some_unread_ = true;
  }

  /// Whether the heading of a routine may be in the program, and could not be read: that is the only mistake then.
  bool may_have_heading(Part part, std::uint32_t number) const {
    return std::ranges::any_of(unread_lines_, [&](std::uint32_t line) {
      return line > 0 && line <= text_.size() && may_be_heading(text_[line - 1], part, number);
    });
  }

  /// Whether an ATCH with a mistake in another operand says its routine all the same.
  static bool names_a_routine(const CheckedStatement& s) {
    constexpr std::int64_t kLast = 127;
    if (s.statement->operands.size() != 2) return false;
    const auto* const number = std::get_if<stl::Integer>(&s.statement->operands.front().value);
    return number != nullptr && number->value >= 0 && number->value <= kLast;
  }

  /// Notes what a statement means for the structure of its routine.
  void note(std::uint32_t i, const CheckedStatement& s) {
    some_read_ = true;
    switch (s.instruction->structure) {
      case Structure::Label:
        return label(i);
      case Structure::Jump:
        if (s.operands_good)
          jumps_.push_back({i, routine_});
        else
          all_jumps_known_ = false;
        return;
      case Structure::Call:
        if (s.operands_good)
          calls_.push_back({i, routine_});
        else
          all_calls_known_ = false;
        return;
      case Structure::Attach:
        if (s.operands_good || names_a_routine(s)) attachments_.push_back({i, routine_});
        if (!s.operands_good) all_attachments_known_ = false;
        return;
      case Structure::For:
        return begin_loop(i);
      case Structure::Next:
        return end_loop(i);
      case Structure::SegmentBegin:
        return begin_segment(i);
      case Structure::SegmentTransition:
        return segment_transition(i);
      case Structure::SegmentExit:
        return segment_exit(i);
      case Structure::SegmentEnd:
        return end_segment(i);
      case Structure::MainEnd:
      case Structure::SubroutineEnd:
      case Structure::InterruptEnd:
        end_routine();
        ended_ = true;
        return;
      default:
        return;
    }
  }

  // --- routines ---

  void begin_routine(std::uint32_t i, Part part, std::map<std::uint32_t, std::uint32_t>& defined) {
    if (!ended_) missing_end(position(i));
    end_routine();
    ended_ = some_unread_ = some_read_ = false;
    stray_reported_ = false;
    if (!statements_[i].operands_good) {
      routine_ = {part, kNoRoutine};
      return;
    }
    routine_ = {part, number_of(statements_[i])};
    const auto [first, added] = defined.emplace(routine_.number, i);
    if (!added)
      error(position(i), fmt::format("{} is defined twice", routine_text(part, routine_.number)),
            fmt::format("it is first defined in line {}", position(first->second).line));
    auto& entry = part == kSubroutine ? result_.subroutine[routine_.number] : result_.interrupt[routine_.number];
    entry = i;
  }

  /// Reports a missing end; on a CPU 22x only of a main program without statements: the others are ended (routine_ends.hpp).
  /// A routine of which no line could be read may have its end in one of them.
  void missing_end(const stl::Position& at) {
    if (some_unread_ && !some_read_) return;
    if (model_.self & kCpu22x)
      return error(at, "the main program has no statement",
                   "a listing begins with the main program: give the file that has it too");
    static constexpr std::string_view kRule[] = {"0083", "0088", "0089"};
    const std::size_t rule = routine_.part == kMain ? 0 : routine_.part == kSubroutine ? 1 : 2;
    error(at,
          fmt::format("{} has no {} (compile rule {})", routine_text(routine_.part, routine_.number), end_of(routine_.part),
                      kRule[rule]),
          fmt::format("end it with {}", end_of(routine_.part)));
  }

  void end_routine() {
    for (const std::uint32_t loop : loops_)
      error(position(loop), "FOR without NEXT (compile rule 0086)", "close the loop with NEXT in the same routine");
    loops_.clear();
    if (segment_) error(position(*segment_), "LSCR without SCRE (compile rule 0096)", "close the segment with SCRE");
    segment_.reset();
    exits_.clear();
  }

  void stray(std::uint32_t i) {
    if (!stray_reported_)
      error(position(i), fmt::format("only SBR or INT may follow {}", end_of(routine_.part)),
            routine_.part == kSubroutine  ? "a conditional return is CRET"
            : routine_.part == kInterrupt ? "a conditional return is CRETI"
                                          : "a conditional end is END");
    stray_reported_ = true;
  }

  void not_allowed(std::uint32_t i) {
    const Instruction& instruction = *statements_[i].instruction;
    const std::string where = routine_.part == kMain         ? "the main program"
                              : routine_.part == kSubroutine ? "a subroutine"
                                                             : "an interrupt routine";
    std::string hint;
    const std::uint8_t allowed = instruction.allowed.on(model_.self);
    if (allowed == kMain) hint = "it belongs to the main program";
    if (allowed == kSubroutine) hint = "it belongs to a subroutine";
    if (allowed == (kMain | kSubroutine)) hint = "let the routine set a bit and the main program act on it";
    if (allowed == kInterrupt) hint = "it belongs to an interrupt routine";
    if (instruction.structure == Structure::MainEnd && routine_.part != kMain)
      hint = fmt::format("{} ends with {}", routine_text(routine_.part, routine_.number), end_of(routine_.part));
    error(position(i), fmt::format("{} is not allowed in {}", instruction.mnemonic, where), hint);
  }

  void not_allowed_in_segment(std::uint32_t i) {
    const bool jumps = statements_[i].instruction->structure == Structure::Jump;  // a jump has a rule of its own
    error(position(i),
          fmt::format("{} is not allowed between LSCR and SCRE (compile rule {})", statements_[i].instruction->mnemonic,
                      jumps ? "008B" : "0096"),
          fmt::format("the segment of line {} has not ended; close it with SCRE first", position(*segment_).line));
  }

  // --- labels and loops ---

  void label(std::uint32_t i) {
    if (!statements_[i].operands_good) return;
    const auto [first, added] = labels_.emplace(number_of(statements_[i]), Place{i, routine_});
    if (!added)
      error(position(i), fmt::format("label {} is defined twice (compile rule 008C)", number_of(statements_[i])),
            fmt::format("it is first defined in line {}", position(first->second.statement).line));
  }

  void check_jumps() {
    std::set<std::uint32_t> used;
    for (const Place& jump : jumps_) {
      const std::uint32_t number = number_of(statements_[jump.statement]);
      const auto found = labels_.find(number);
      if (found == labels_.end()) {
        error(position(jump.statement), fmt::format("label {} is missing (compile rule 0087)", number),
              fmt::format("write LBL {} in {}, where JMP is to go", number,
                          routine_text(jump.routine.part, jump.routine.number)),
              fmt::format("no LBL {}", number));
        continue;
      }
      used.insert(number);
      if (!(found->second.routine == jump.routine))
        error(position(jump.statement),
              fmt::format("LBL {} is in {}; a jump cannot leave {}", number,
                          routine_text(found->second.routine.part, found->second.routine.number),
                          routine_text(jump.routine.part, jump.routine.number)),
              "JMP and its LBL must be in the same routine");
      else if (segment_of_[jump.statement] == kNoSegment && segment_of_[found->second.statement] != kNoSegment)
        error(position(jump.statement),
              fmt::format("LBL {} is inside the segment of line {}; a jump cannot enter a segment (compile rule 008B)",
                          number, position(segment_of_[found->second.statement]).line),
              "put LBL before LSCR or after SCRE");
      result_.target[jump.statement] = found->second.statement;
    }
    for (const auto& [number, place] : labels_)
      if (all_jumps_known_ && !used.contains(number))
        warning(Warning::UnusedLabel, position(place.statement), fmt::format("label {} is never used", number));
  }

  void begin_loop(std::uint32_t i) {
    loops_.push_back(i);
    if (loops_.size() == model_.for_depth + 1)
      error(position(i), fmt::format("FOR loops nested deeper than {} (compile rule 0093)", model_.for_depth));
  }

  void end_loop(std::uint32_t i) {
    if (loops_.empty()) {
      error(position(i), "NEXT without FOR (compile rule 0085)", "each NEXT closes the nearest open FOR in its own routine");
      return;
    }
    const std::uint32_t head = loops_.back();
    loops_.pop_back();
    result_.target[head] = i + 1;
    result_.target[i] = head + 1;
    result_.head[i] = head;
  }

  // --- sequence control relays ---

  void begin_segment(std::uint32_t i) {
    if (segment_)
      error(position(i), "LSCR inside a segment (compile rule 0096)",
            fmt::format("the segment of line {} has no SCRE yet", position(*segment_).line));
    segment_ = i;
    if (statements_[i].operands_good) note_segment_bit(i);
  }

  void segment_transition(std::uint32_t i) {
    if (!segment_)
      error(position(i), "SCRT outside a segment (compile rule 0095)", "a segment begins with LSCR");
    else
      result_.head[i] = *segment_;
  }

  /// CSCRE goes to the SCRE of its segment.
  void segment_exit(std::uint32_t i) {
    if (!segment_)
      error(position(i), "CSCRE outside a segment (compile rule 0095)", "a segment begins with LSCR");
    else
      exits_.push_back(i);
  }

  void end_segment(std::uint32_t i) {
    if (!segment_) error(position(i), "SCRE without LSCR (compile rule 0095)");
    for (const std::uint32_t exit : exits_) result_.target[exit] = i;
    exits_.clear();
    segment_.reset();
  }

  /// An S bit belongs to one routine (S7-200 manual, restrictions of SCR).
  void note_segment_bit(std::uint32_t i) {
    const auto& bit = std::get<stl::Address>(statements_[i].statement->operands[0].value);
    const auto [first, added] = segment_bits_.emplace(std::pair(bit.number, bit.bit), Place{i, routine_});
    if (added || first->second.routine == routine_) return;
    error(position(i),
          fmt::format("S{}.{} already has a segment in {}; one S bit cannot serve two routines", bit.number, bit.bit,
                      routine_text(first->second.routine.part, first->second.routine.number)),
          fmt::format("its LSCR is in line {}; use another S bit here", position(first->second.statement).line));
  }

  // --- calls ---

  void check_calls() {
    for (const Place& call : calls_) {
      const std::uint32_t number = number_of(statements_[call.statement]);
      if (!subroutines_.contains(number)) {
        if (may_have_heading(kSubroutine, number)) continue;
        error(position(call.statement), fmt::format("subroutine {} is missing (compile rule 0087)", number),
              fmt::format("the program has no SBR {}", number), fmt::format("no SBR {}", number));
        continue;
      }
      result_.target[call.statement] = result_.subroutine[number];
      called_[call.routine].insert(number);
    }
  }

  void check_attachments() {
    for (const Place& attach : attachments_) {
      const std::uint32_t number = number_of(statements_[attach.statement]);
      if (!interrupts_.contains(number) && !may_have_heading(kInterrupt, number))
        error(position(attach.statement), fmt::format("interrupt routine {} is missing (compile rule 0087)", number),
              fmt::format("the program has no INT {}", number), fmt::format("no INT {}", number));
      attached_.insert(number);
    }
  }

  /// A CALL or ATCH with a mistake may mean any routine.
  void warn_of_unused() {
    std::set<std::uint32_t> called;
    for (const auto& [routine, numbers] : called_) called.insert(numbers.begin(), numbers.end());
    for (const auto& [number, i] : subroutines_)
      if (all_calls_known_ && !called.contains(number) && !is_empty(i))
        warning(Warning::UnusedRoutine, position(i), fmt::format("SBR {} is never called", number));
    for (const auto& [number, i] : interrupts_)
      if (all_attachments_known_ && !attached_.contains(number) && !is_empty(i))
        warning(Warning::UnusedRoutine, position(i), fmt::format("INT {} is never attached to an event", number));
  }

  /// Whether a routine has no instruction, as SBR_0 and INT_0 of every new project of Micro/WIN.
  bool is_empty(std::uint32_t head) const {
    if (head + 1 == statements_.size()) return true;
    switch (statements_[head + 1].instruction->structure) {
      case Structure::SubroutineHead:
      case Structure::InterruptHead:
      case Structure::SubroutineEnd:
      case Structure::InterruptEnd:
        return true;
      default:
        return false;
    }
  }

  void warn_of_recursion() {
    for (const auto& [number, i] : subroutines_) {
      std::set<std::uint32_t> reached, open{number};
      while (!open.empty()) {
        const std::uint32_t next = *open.begin();
        open.erase(open.begin());
        for (const std::uint32_t callee : called_[{kSubroutine, next}])
          if (reached.insert(callee).second) open.insert(callee);
      }
      if (reached.contains(number))
        warning(Warning::Recursion, position(i), fmt::format("SBR {} calls itself", number),
                fmt::format("the CPU nests {} calls; one more is run-time error 0008", model_.call_depth));
    }
  }

  const std::vector<CheckedStatement>& statements_;
  const std::vector<std::string>& text_;
  const CpuModel& model_;
  stl::Diagnostics& diagnostics_;
  ProgramStructure result_;

  Routine routine_{};
  bool ended_ = false;                            // the routine's last instruction has been seen
  bool some_unread_ = false, some_read_ = false;  // statements of the routine so far
  bool stray_reported_ = false;
  std::vector<std::uint32_t> loops_;                                      // open FORs
  std::optional<std::uint32_t> segment_;                                  // open LSCR
  std::vector<std::uint32_t> exits_;                                      // CSCREs of the open segment
  std::vector<std::uint32_t> segment_of_;                                 // for each statement: its LSCR, or kNoSegment
  std::map<std::pair<std::uint32_t, std::uint8_t>, Place> segment_bits_;  // S bit -> its first LSCR
  std::map<std::uint32_t, std::uint32_t> subroutines_, interrupts_;       // number -> statement of the head
  std::map<std::uint32_t, Place> labels_;
  std::vector<Place> jumps_, calls_, attachments_;
  std::map<Routine, std::set<std::uint32_t>> called_;
  std::set<std::uint32_t> attached_;
  std::vector<std::uint32_t> unread_lines_;
  bool all_jumps_known_ = true, all_calls_known_ = true, all_attachments_known_ = true;
};

/// The depth of the logic stack within a network, and how much of it the current rung has put there.
class StackCheck {
 public:
  explicit StackCheck(stl::Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  void visit(const CheckedStatement& s) {
    const Instruction& instruction = *s.instruction;
    const bool load = instruction.rung.stack.needs == 0 && instruction.rung.stack.change == 1;
    if (&instruction == &unread_instruction()) return give_up(s.begins_network);
    if (!known_ && !knows_again(s, load)) return;
    if (s.begins_network) depth_ = 0;
    if (s.begins_network || (load && after_output_)) begin_rung();
    if (leaves_one(instruction)) {
      begin_rung();
      depth_ = rung_ = 1;
      after_output_ = true;
      return;
    }
    use(s, stack_use(s));
    after_output_ = instruction.rung.writes_output;
    last_ = s.statement;
  }

  void begin_rung() {
    if (rung_ > 1 && last_ && !reported_)
      diagnostics_.push_back(warn(Warning::LogicStack, last_->position,
                                  fmt::format("the rung leaves {} values on the logic stack; 1 is usual", rung_),
                                  "an ALD, OLD or LPP may be missing"));
    rung_ = 0;
    reported_ = false;
    last_ = nullptr;
  }

 private:
  /// Gives up on the stack: nobody knows what a statement that could not be read does to it.
  void give_up(bool at_network) {
    if (at_network) begin_rung();
    known_ = false;
    after_output_ = false;
    rung_ = 0;
    last_ = nullptr;
  }

  /// The next network, or the next rung: what the one before has left is not known there.
  bool knows_again(const CheckedStatement& s, bool load) {
    const bool rung = load && after_output_;
    after_output_ = s.instruction->rung.writes_output;
    if (!s.begins_network && !rung && !leaves_one(*s.instruction)) return false;
    known_ = after_output_ = true;
    depth_ = LevelsOfStack;
    return true;
  }

  /// SBR, INT, LBL, NEXT and LSCR leave a value on top of the stack for what follows: no LD is needed.
  static bool leaves_one(const Instruction& instruction) {
    switch (instruction.structure) {
      case Structure::SubroutineHead:
      case Structure::InterruptHead:
      case Structure::Label:
      case Structure::Next:
      case Structure::SegmentBegin:
        return true;
      default:
        return false;
    }
  }

  /// LDS needs the level that it copies and all above it.
  static StackUse stack_use(const CheckedStatement& s) {
    StackUse use = s.instruction->rung.stack;
    if (s.instruction->operand[0].kind == OperandKind::StackLevel && s.operands_good)
      use.needs = static_cast<std::int8_t>(use.needs + static_cast<int>(number_of(s)));
    if (use.needs == LevelsOfStack) use.change = 0;  // the level that is lost is the one copied
    return use;
  }

  static std::string hint_for_missing_value(const Instruction& instruction, int needed) {
    if (is_among(instruction.mnemonic, {"LPP", "LRD"}))
      return fmt::format("an LPS is missing before it: LPS saves the value that {} takes", instruction.mnemonic);
    return needed == 1   ? "begin the rung with LD"
           : needed == 2 ? "load the other value with LD first"
                         : "load the other values with LD first";
  }

  void use(const CheckedStatement& s, StackUse stack) {
    if (depth_ < stack.needs && !reported_) {
      reported_ = true;
      diagnostics_.push_back(
          {stl::Severity::Error, s.statement->position,
           fmt::format("{} needs {} on the logic stack and finds {} (compile rule 0081)", s.instruction->mnemonic,
                       stack.needs == 1 ? "a value" : fmt::format("{} values", stack.needs),
                       depth_ == 0 ? "none" : std::to_string(depth_)),
           hint_for_missing_value(*s.instruction, stack.needs)});
    }
    depth_ = std::min(std::max<int>(depth_, stack.needs) + stack.change, LevelsOfStack);
    rung_ = std::max<int>(rung_, stack.needs) + stack.change;
    if (rung_ > LevelsOfStack && !reported_) {
      reported_ = true;
      diagnostics_.push_back({stl::Severity::Error, s.statement->position,
                              fmt::format("more than {} values on the logic stack: the first is lost", LevelsOfStack),
                              "split the rung"});
    }
  }

  static constexpr int LevelsOfStack = 9;

  stl::Diagnostics& diagnostics_;
  const stl::Statement* last_ = nullptr;
  int depth_ = 0;  // values there since the start of the network; what a rung leaves stays for the next one
  int rung_ = 0;   // values that the rung has put there or used
  bool after_output_ = true;
  bool reported_ = false;  // one report for each rung
  bool known_ = true;      // what is on the stack
};

}  // namespace

ProgramStructure check_structure(const std::vector<CheckedStatement>& statements, const std::vector<std::string>& text,
                                 const CpuModel& model, stl::Diagnostics& diagnostics) {
  return StructureCheck(statements, text, model, diagnostics).run();
}

void check_logic_stack(const std::vector<CheckedStatement>& statements, stl::Diagnostics& diagnostics) {
  StackCheck check(diagnostics);
  for (const CheckedStatement& statement : statements) check.visit(statement);
  check.begin_rung();
}

}  // namespace s7200
