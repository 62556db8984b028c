#include "interpreter/program/checking/checker.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>
#include <deque>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "interpreter/base/text/nearest.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/boxes.hpp"
#include "interpreter/model/times/named_times.hpp"
#include "interpreter/model/times/times_file.hpp"
#include "interpreter/program/checking/chains.hpp"
#include "interpreter/program/checking/routine_ends.hpp"
#include "interpreter/program/checking/special_memory_use.hpp"
#include "interpreter/program/checking/structure.hpp"
#include "interpreter/program/checking/warnings.hpp"
#include "interpreter/program/ladder/networks.hpp"
#include "interpreter/program/loading/data_block.hpp"
#include "interpreter/program/loading/german.hpp"
#include "interpreter/program/loading/stand_ins.hpp"
#include "interpreter/program/loading/unread.hpp"
#include "interpreter/program/operands/operands.hpp"
#include "interpreter/program/operands/other_width.hpp"
#include "interpreter/program/operands/parameters.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/stl/tables/project.hpp"
#include "interpreter/stl/tables/symbols.hpp"
#include "interpreter/stl/tables/system_symbols.hpp"
#include "interpreter/stl/text/look_alikes.hpp"
#include "interpreter/stl/text/plain_text.hpp"

namespace s7200 {
namespace {

class Checker {
 public:
  /// `source` must live as long as this; `diagnostics` are those that its reader already has.
  Checker(const stl::Source& source, stl::Diagnostics diagnostics, const CpuModel& model)
      : source_(source), diagnostics_(std::move(diagnostics)), model_(model) {
    for (const stl::Block& block : source_.blocks)
      if (block.kind == stl::Block::Kind::Subroutine) subroutine_blocks_.emplace(block.number, &block);
    for (const stl::Diagnostic& diagnostic : diagnostics_) {
      if (diagnostic.severity == stl::Severity::Error) unread_lines_.insert(diagnostic.position.line);
      causes_read_.insert(diagnostic.cause);
    }
  }

  /// All of a DecodedSource but its source.
  DecodedSource decoded(const TimeTable& times) {
    for (const stl::Line& line : source_.lines) read(line);
    const ProgramStructure structure = check_whole();
    DecodedSource result;
    if (!has_errors(diagnostics_))
      result.known = result.program = decode(structure, times);
    else if (!beyond_)  // otherwise the rest of it was not read at all
      result.known = what_is_known(structure);
    tell_undefined_symbols_apart();
    result.diagnostics = std::move(diagnostics_);
    return result;
  }

  /// Whether there are no errors, without looking for more than one.
  bool is_fine() {
    if (has_errors(diagnostics_)) return false;
    for (const stl::Line& line : source_.lines) {
      diagnostics_.clear();  // only warnings
      read(line);
      if (beyond_ || has_errors(diagnostics_)) return false;
    }
    check_whole();
    return !has_errors(diagnostics_);
  }

 private:
  void error(const stl::Position& at, std::string message, std::string hint = {}, std::string cause = {}) {
    diagnostics_.push_back({stl::Severity::Error, at, std::move(message), std::move(hint), std::move(cause)});
  }

  /// Gives each undefined name a cause of its own where there is a symbol table; without one they all have the same, but for
  /// those that are nearly a symbol of Micro/WIN.
  void tell_undefined_symbols_apart() {
    if (std::ranges::find(diagnostics_, kUndefinedSymbols, &stl::Diagnostic::cause) == diagnostics_.end()) return;
    const std::vector<stl::Symbol> own = users_symbols();
    const KnownNames known = known_names();
    for (stl::Diagnostic& diagnostic : diagnostics_) {
      if (diagnostic.cause != kUndefinedSymbols) continue;
      const std::string meant = nearest_symbol(written_at(diagnostic.position), known);
      if (!meant.empty())
        diagnostic.hint = fmt::format("did you mean {}?", meant);
      else if (!own.empty())
        diagnostic.hint = hint_with_table(written_at(diagnostic.position), own);
      if (!meant.empty() || !own.empty()) diagnostic.cause = diagnostic.message;
    }
  }

  /// The symbols of the tables that were given: a stand-in has its own.
  std::vector<stl::Symbol> users_symbols() const {
    std::vector<stl::Symbol> symbols = source_.symbols;
    std::erase_if(symbols, [this](const stl::Symbol& symbol) {
      return is_stand_in(stl::in_file(source_, symbol.position.line).file);
    });
    return symbols;
  }

  /// The hint for a name that is in no table that was given: `symbols.txt does not have it; the nearest are Pump_1 and
  /// Pump_2`.
  std::string hint_with_table(std::string_view written, const std::vector<stl::Symbol>& own) const {
    std::vector<std::string> tables;
    for (const stl::Symbol& symbol : own)
      if (std::string file = stl::in_file(source_, symbol.position.line).file; tables.empty() || tables.back() != file)
        tables.push_back(std::move(file));
    const std::vector<std::string> near = symbols_like(written, own);
    return fmt::format(
        "{} {} it{}; add it there, or write the address itself", fmt::join(tables, ", "),
        tables.size() == 1 ? "does not have" : "do not have",
        near.empty() ? "" : fmt::format("; the nearest {} {}", near.size() == 1 ? "is" : "are", fmt::join(near, ", ")));
  }

  /// Symbols of the user that have a word in common with a name, the longest such word first.
  static std::vector<std::string> symbols_like(std::string_view written, const std::vector<stl::Symbol>& own) {
    constexpr std::size_t kLeastCommon = 3, kShown = 3;
    const std::string name = stl::upper_case(written);
    std::vector<std::pair<std::size_t, std::string>> found;
    for (const stl::Symbol& symbol : own)
      if (const std::size_t common = longest_common(name, stl::upper_case(symbol.name)); common >= kLeastCommon)
        found.emplace_back(common, symbol.name);
    std::ranges::stable_sort(found, std::greater{}, &std::pair<std::size_t, std::string>::first);
    std::vector<std::string> names;
    for (const auto& [common, each] : std::span(found).first(std::min(kShown, found.size())))
      names.push_back(stl::shortened(each));
    return names;
  }

  /// The number of letters that two names have in common, one behind the other in both.
  static std::size_t longest_common(std::string_view a, std::string_view b) {
    std::size_t longest = 0;
    for (std::size_t from = 0; from < a.size(); ++from)
      while (from + longest < a.size() && b.find(a.substr(from, longest + 1)) != b.npos) ++longest;
    return longest;
  }

  static std::vector<std::string> in_capitals(std::span<const stl::Symbol> symbols) {
    std::vector<std::string> names;
    for (const stl::Symbol& symbol : symbols) names.push_back(stl::upper_case(symbol.name));
    return names;
  }

  /// The names of all symbols, and the same in capitals.
  struct KnownNames {
    std::vector<std::string_view> names{}, capitals{};
    std::vector<std::string> of_tables{};  ///< the first of these capitals
  };
  KnownNames known_names() const {
    static const std::vector<std::string> kOfSystem = in_capitals(stl::system_symbols());
    KnownNames known{.of_tables = in_capitals(source_.symbols)};
    for (const std::span<const stl::Symbol> table : {std::span(source_.symbols), stl::system_symbols()})
      for (const stl::Symbol& symbol : table) known.names.push_back(symbol.name);
    for (const std::vector<std::string>& names : {std::cref(known.of_tables), std::cref(kOfSystem)})
      known.capitals.insert(known.capitals.end(), names.begin(), names.end());
    return known;
  }

  /// The symbol that is written almost like a name, or that begins with it; empty if there is none.
  static std::string nearest_symbol(std::string_view written, const KnownNames& all) {
    constexpr std::string_view kMarks = "&*#\"";
    constexpr std::size_t kShort = 6;  // two changes make another word of it
    written.remove_prefix(std::min(written.find_first_not_of(kMarks), written.size()));
    const std::string name = stl::upper_case(written.substr(0, written.find_first_of("\":")));
    const auto near = all_nearest(name, all.capitals, name.size() < kShort ? 1 : 2);
    const auto longer = [&](std::string_view each) { return name.size() >= kShort && each.starts_with(name); };
    const auto found =
        near.empty() ? std::ranges::find_if(all.capitals, longer) : std::ranges::find(all.capitals, near.front());
    return std::string(found == all.capitals.end() ? "" : all.names[static_cast<std::size_t>(found - all.capitals.begin())]);
  }

  void no_statement() {
    const bool part = !source_.symbols.empty() || !source_.data.empty();
    error({1, 1, 1}, "no STL statement in the file",
          part                    ? "it is a part of a project: give the file with the program too"
          : model_.self & kCpu22x ? "a program needs at least one instruction"
                                  : "a program needs at least MEND");
  }

  /// The main program of a listing is in no block; there may be blocks all the same, those of stand-ins.
  bool lacks_main_program() const {
    const auto is_in_block = [this](const stl::Line& line) {
      const auto* statement = std::get_if<stl::Statement>(&line);
      return !statement || std::ranges::any_of(source_.blocks, [&](const stl::Block& block) {
        return statement->position.line >= block.position.line && statement->position.line <= block.last_line;
      });
    };
    return !source_.blocks.empty() &&
           std::ranges::find(source_.blocks, stl::Block::Kind::Main, &stl::Block::kind) == source_.blocks.end() &&
           std::ranges::all_of(source_.lines, is_in_block);
  }

  void read(const stl::Line& line) {
    if (const auto* head = std::get_if<stl::NetworkHead>(&line)) {
      add_unread_lines(head->position.line);
      begins_network_ = true;
    }
    const auto* statement = std::get_if<stl::Statement>(&line);
    if (!statement) return;
    add_unread_lines(statement->position.line);
    const Instruction* instruction = known_instruction(*statement);
    if (!instruction) {
      check_box(*statement);
      return add_unread(*statement);
    }
    placed_.emplace_back();
    const bool good = place_operands(*instruction, *statement);
    if (!good) mark_unread_operands(*instruction);
    statements_.push_back({statement, instruction, good, begins_network_});
    count_words(statements_.back());
    begins_network_ = false;
  }

  /// A statement without a known instruction: it may be anything.
  void add_unread(const stl::Statement& statement) {
    placed_.emplace_back();
    statements_.push_back({&statement, &unread_instruction(), false, std::exchange(begins_network_, false)});
  }

  /// The operands of a box in place of a mnemonic, so that their mistakes show in the same run as that of the box.
  void check_box(const stl::Statement& statement) {
    std::set<std::size_t> refused;
    for (const BoxStep& step : steps_of_box(statement.mnemonic, statement.operands.size()))
      for (std::size_t i = 0; i < step.operands.size(); ++i) {
        const std::size_t number = step.operands[i];
        const stl::Operand& operand = statement.operands[number];
        if (refused.contains(number)) continue;
        if (!place_operand(*step.instruction, step.instruction->operand[i], operand, model_, constants_, diagnostics_))
          refused.insert(number);
      }
  }

  /// Reports what the parser could not read above a line of the source.
  void add_unread_lines(std::uint32_t above) {
    const auto end = unread_lines_.lower_bound(above);
    for (auto line = unread_lines_.begin(); line != end; ++line)
      add_unread(unread_.emplace_back(stl::Statement{unread_text(*line), {*line, 1, 1}, {}, {}}));
    unread_lines_.erase(unread_lines_.begin(), end);
  }

  /// What is written in a line that the parser could not read; it stands in place of a mnemonic.
  std::string unread_text(std::uint32_t line) const {
    if (line < 1 || line > source_.text.size()) return {};
    const std::string_view text = source_.text[line - 1];
    return stl::printable(stl::shortened(stl::trim(text.substr(0, text.find("//")))));
  }

  /// The lines of the source, with those that the parser could not read as statements, so that each op has one.
  std::vector<stl::Line> lines_with_unread() const {
    std::vector<stl::Line> lines;
    auto next = unread_.begin();
    const auto add_unread_above = [&](std::uint32_t line) {
      for (; next != unread_.end() && next->position.line < line; ++next) lines.emplace_back(*next);
    };
    for (const stl::Line& line : source_.lines) {
      if (const auto* head = std::get_if<stl::NetworkHead>(&line)) add_unread_above(head->position.line);
      if (const auto* statement = std::get_if<stl::Statement>(&line)) add_unread_above(statement->position.line);
      lines.push_back(line);
    }
    return lines;
  }

  void mark_unread_operands(const Instruction& instruction) {
    for (std::size_t i = 0; i < instruction.rules().size(); ++i)
      if (PlacedOperand& operand = placed_.back()[i]; !operand.read) operand.operand.at = kUnread;
  }

  /// Checks what can be said only when all statements are there.
  ProgramStructure check_whole() {
    if (statements_.empty() && !has_errors(diagnostics_)) no_statement();
    if (lacks_main_program())
      error(source_.blocks.front().position, "there is no main program (ORGANIZATION_BLOCK)",
            "give the file that has it too");
    ProgramStructure structure;
    const std::size_t before = diagnostics_.size();
    if (!lacks_main_program()) structure = check_structure(statements_, source_.text, model_, diagnostics_);
    note_broken_structure(before);
    check_logic_stack(statements_, diagnostics_);
    check_size();
    data_ = place_data(source_, model_, diagnostics_);
    check_timer_kinds();
    return structure;
  }

  static std::pair<std::uint32_t, std::uint32_t> place_of(const stl::Position& at) { return {at.line, at.column}; }

  /// The errors from `first` on are those of the structure.
  void note_broken_structure(std::size_t first) {
    for (std::size_t i = first; i < diagnostics_.size(); ++i) {
      const stl::Diagnostic& diagnostic = diagnostics_[i];
      if (diagnostic.severity == stl::Severity::Error) misplaced_.insert(place_of(diagnostic.position));
    }
  }

  const Instruction* known_instruction(const stl::Statement& statement) {
    const Instruction* instruction = find_instruction(statement.mnemonic);
    const std::string& mnemonic = statement.mnemonic;
    if (const auto [what, hint] = other_use(mnemonic, statement.operands.size()); !what.empty()) {
      error(statement.position, fmt::format("{} with {} is {}", mnemonic, counted(statement.operands.size()), what), hint,
            fmt::format("{}: {}", what, hint));
      return nullptr;
    }
    if (instruction && (instruction->cpus & model_.self) && instruction->modelled()) return instruction;
    const std::string cause = fmt::format("mnemonic {}", mnemonic);
    if (!instruction)
      unknown_instruction(statement, cause);
    else if (!(instruction->cpus & model_.self))
      error(statement.position, fmt::format("CPU {} has no {}", model_.name, mnemonic),
            needs(mnemonic + " needs", instruction->cpus), cause);
    else
      error(statement.position, fmt::format("{} is not modelled", mnemonic), std::string(instruction->not_modelled), cause);
    return nullptr;
  }

  void unknown_instruction(const stl::Statement& statement, const std::string& cause) {
    const std::string shown = stl::shortened(statement.mnemonic);
    if (statement.mnemonic == "CPU")  // as the head of a printed program; one that is modelled is a comment
      return error(statement.position, "this line names no CPU that is modelled",
                   "take the line out and name one with --cpu", cause);
    if (is_library_routine(statement.mnemonic))
      return error(statement.position, fmt::format("{} is a routine of a library, not an instruction", shown),
                   fmt::format("write CALL {} and its parameters", shown), cause);
    if (begins_with_not(statement))
      if (const auto [what, hint] = unknown_mnemonic(statement.mnemonic + "NOT"); !what.empty())
        return error(statement.position, fmt::format("{} NOT is {}", shown, what),
                     fmt::format("{} {}", hint, written_from(statement, 1)));
    const auto [what, hint] = unknown_mnemonic(statement.mnemonic);
    if (what.empty()) return error(statement.position, fmt::format("unknown instruction '{}'", shown), hint, cause);
    // What is said of one mnemonic of another family with the same words is said once.
    error(statement.position, fmt::format("{} is {}", shown, what), hint, fmt::format("{}: {}", what, hint));
  }

  static bool begins_with_not(const stl::Statement& statement) {
    const auto* name = statement.operands.size() > 1 ? std::get_if<stl::Name>(&statement.operands[0].value) : nullptr;
    return name && stl::upper_case(name->text) == "NOT";
  }

  /// The operands from `first` on as they are written.
  std::string written_from(const stl::Statement& statement, std::size_t first) const {
    std::vector<std::string> written;
    for (const stl::Operand& operand : std::span(statement.operands).subspan(first))
      written.push_back(written_at(operand.position));
    return fmt::format("{}", fmt::join(written, ", "));
  }

  /// `LD NOT I0.0`, as other controllers have it. True after a message.
  bool has_not_as_operand(const Instruction& instruction, const stl::Statement& statement) {
    if (!begins_with_not(statement)) return false;
    constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kNegated{
        {{"LD", "LDN"}, {"A", "AN"}, {"O", "ON"}, {"LDI", "LDNI"}, {"AI", "ANI"}, {"OI", "ONI"}}};
    const auto row = std::ranges::find(kNegated, instruction.mnemonic, [](const auto& each) { return each.first; });
    const std::string rest = written_from(statement, 1);
    error(statement.operands[0].position, fmt::format("{} takes no NOT", instruction.mnemonic),
          row == kNegated.end() ? fmt::format("write NOT, then {} {}", instruction.mnemonic, rest)
                                : fmt::format("write {} {}", row->second, rest));
    return true;
  }

  /// `+I VW0, VW2, VW4`; parameters for a subroutine without any. True after a message.
  bool has_operands_of_another(const Instruction& instruction, const stl::Statement& statement) {
    const std::size_t given = statement.operands.size();
    if (instruction.structure == Structure::Call && given > 1) {
      const std::string callee = written_at(statement.operands[0].position);
      error(statement.operands[1].position, fmt::format("{} declares no parameters", callee),
            fmt::format("write CALL {}; the subroutines of a listing have none, those of an export declare theirs in "
                        "VAR_INPUT, VAR_IN_OUT and VAR_OUTPUT",
                        callee));
      return true;
    }
    const std::string steps = in_steps(instruction, statement);
    if (steps.empty()) return false;
    error(statement.operands.back().position,
          fmt::format("{} takes {}, not {}", instruction.mnemonic, counted(instruction.rules().size()), given), steps);
    return true;
  }

  /// `1,5` is two operands; if there is only room for one, it is a real number with a German comma.
  bool has_decimal_comma(const Instruction& instruction, const stl::Statement& statement) {
    const auto& given = statement.operands;
    if (given.size() != instruction.rules().size() + std::size_t{1}) return false;
    for (std::size_t i = 0; i < instruction.rules().size(); ++i) {
      const stl::Position &whole = given[i].position, &fraction = given[i + 1].position;
      const bool joined = whole.column + whole.length + 1 == fraction.column;
      if (!instruction.operand[i].real || !joined || !is_number(given[i]) || !is_number(given[i + 1])) continue;
      const stl::Position both{whole.line, whole.column, whole.length + 1 + fraction.length};
      std::string text = written_at(both);
      if (text.size() <= whole.length || text[whole.length] != ',') continue;
      std::string hint = text;
      hint[whole.length] = '.';
      error(both, fmt::format("{} has a decimal comma", text), fmt::format("write {}", hint));
      return true;
    }
    return false;
  }

  /// `I0,0`: the byte and the bit of an address with a comma between them are two operands. True after a message.
  bool has_comma_in_address(const Instruction& instruction, const stl::Statement& statement) {
    const auto& given = statement.operands;
    if (given.size() != instruction.rules().size() + std::size_t{1}) return false;
    for (std::size_t i = 0; i < instruction.rules().size(); ++i) {
      const auto* byte = std::get_if<stl::Address>(&given[i].value);
      const auto* bit = std::get_if<stl::Integer>(&given[i + 1].value);
      const stl::Position &whole = given[i].position, &part = given[i + 1].position;
      const bool joined = whole.column + whole.length + 1 == part.column;
      if (instruction.operand[i].width != Width::Bit || !byte || byte->size != stl::Size::None || !bit || !joined) continue;
      const stl::Position both{whole.line, whole.column, whole.length + 1 + part.length};
      std::string text = written_at(both);
      if (text.size() <= whole.length || text[whole.length] != ',') continue;
      std::string hint = text;
      hint[whole.length] = '.';
      error(both, fmt::format("{} has a comma before its bit", text), fmt::format("write {}", hint));
      return true;
    }
    return false;
  }

  /// `l0` with the small letter L: an address of L memory has a size or a bit. True after a message.
  bool has_letter_for_one(const Instruction& instruction, const stl::Statement& statement) {
    for (std::size_t i = 0; i < std::min(instruction.rules().size(), statement.operands.size()); ++i) {
      const stl::Operand& given = statement.operands[i];
      const auto* address = std::get_if<stl::Address>(&given.value);
      const bool name = std::holds_alternative<stl::Name>(given.value);
      const bool unfinished = address && address->area == "L" && address->size == stl::Size::None;
      if (!instruction.operand[i].constant || !given.symbol.empty() || !(name || unfinished)) continue;
      std::string text = written_at(given.position);
      if (!text.starts_with('l') || !std::ranges::all_of(text.substr(1), stl::is_digit)) continue;
      error(given.position, fmt::format("{} has the letter l in place of the digit 1", text),
            fmt::format("write 1{}", text.substr(1)), stl::kLookAlikes);
      return true;
    }
    return false;
  }

  static bool is_number(const stl::Operand& operand) {
    return std::holds_alternative<stl::Integer>(operand.value) || std::holds_alternative<stl::Real>(operand.value);
  }

  /// The characters of the source at a place.
  std::string written_at(const stl::Position& at) const {
    return stl::plain_characters(stl::characters_at(source_.text[at.line - 1], at.column, at.length));
  }

  bool place_operands(const Instruction& instruction, const stl::Statement& statement) {
    const std::size_t given = statement.operands.size(), taken = instruction.rules().size();
    auto& placed = placed_.back();
    for (std::size_t i = 0; i < taken; ++i) placed[i].read = false;
    if (has_decimal_comma(instruction, statement) || has_comma_in_address(instruction, statement)) return false;
    if (has_letter_for_one(instruction, statement)) return false;
    if (is_missing_block(instruction, statement) || has_not_as_operand(instruction, statement)) return false;
    const stl::Block* called = called_block(instruction, statement);
    if (given != taken && !called) {
      if (is_two_statements(statement, taken) || has_blank_in_address(statement, taken)) return false;
      if (has_operands_of_another(instruction, statement)) return false;
      const stl::Position at = given > taken ? statement.operands[taken].position : statement.position;
      error(at, fmt::format("{} takes {}, not {}", instruction.mnemonic, counted(taken), given),
            fmt::format("write {}", syntax(instruction)));
      return false;
    }
    bool good = true;
    const std::size_t diagnostics_before = diagnostics_.size();
    for (std::size_t i = 0; i < taken; ++i) {
      const auto operand =
          place_operand(instruction, instruction.operand[i], statement.operands[i], model_, constants_, diagnostics_);
      if (operand) placed[i] = *operand;
      placed[i].read = operand.has_value();
      good = good && operand;
    }
    if (!good) offer_other_width(instruction, statement, diagnostics_before);
    if (called && good) return pass_parameters(instruction, statement, *called);
    return good && blocks_fit(instruction, statement) && mode_fits(instruction, statement);
  }

  /// `LD I 0.0`: the letters and the number of an address with a blank between them are two operands. True after a message.
  bool has_blank_in_address(const stl::Statement& statement, std::size_t taken) {
    if (statement.operands.size() <= taken) return false;
    bool found = false;
    for (std::size_t i = 0; i + 1 < statement.operands.size(); ++i) {
      const stl::Position &letters = statement.operands[i].position, &number = statement.operands[i + 1].position;
      const auto* name = std::get_if<stl::Name>(&statement.operands[i].value);
      if (!name || written_at({letters.line, letters.column + letters.length, 1}) != " ") continue;
      const std::string joined = name->text + written_at(number);
      const auto operand = stl::parse_operand(joined);
      if (!operand || !std::holds_alternative<stl::Address>(operand->value)) continue;
      error({letters.line, letters.column, number.column + number.length - letters.column},
            "there is a blank in this address", fmt::format("write {}", joined));
      found = true;
    }
    return found;
  }

  /// `LD I0.0 A I0.1`: after its operands, a statement has the mnemonic of another. True after a message.
  bool is_two_statements(const stl::Statement& statement, std::size_t taken) {
    const auto is_mnemonic = [](const stl::Operand& operand) {
      const auto* name = std::get_if<stl::Name>(&operand.value);
      return name && find_instruction(stl::upper_case(name->text));
    };
    const auto begin = statement.operands.begin() + static_cast<std::ptrdiff_t>(std::min(taken, statement.operands.size()));
    const auto second = std::find_if(begin, statement.operands.end(), is_mnemonic);
    if (second == statement.operands.end()) return false;
    std::vector<std::string> later;
    for (auto each = second; each != statement.operands.end(); ++each)
      if (is_mnemonic(*each)) later.push_back(std::get<stl::Name>(each->value).text);
    error(second->position, stl::several_statements(later), stl::new_lines_with(later));
    return true;
  }

  /// One instruction that takes all the operands as they are is better than what can be said of each of them.
  void offer_other_width(const Instruction& instruction, const stl::Statement& statement, std::size_t first_diagnostic) {
    const std::string fitting = in_other_width(instruction, statement, model_);
    if (fitting.empty()) return;
    for (std::size_t i = first_diagnostic; i < diagnostics_.size(); ++i) diagnostics_[i].hint = "write " + fitting;
  }

  /// The name in `CALL MeinUP:SBR3, VW0` if the program has no such block. A call without parameters may be of a listing's
  /// subroutine, which has no name.
  std::optional<stl::Name> missing_callee(const Instruction& instruction, const stl::Statement& statement) const {
    if (instruction.structure != Structure::Call || statement.operands.size() < 2) return {};
    if (called_block(instruction, statement)) return {};
    const stl::Operand& callee = statement.operands[0];
    if (callee.symbol.empty() || !std::holds_alternative<stl::Integer>(callee.value) || has_subroutine(callee.value))
      return {};
    const std::string shown = stl::shortened(callee.symbol.substr(0, callee.symbol.rfind(':')));
    return stl::Name{callee.symbol, fmt::format("there is no subroutine {}", shown)};
  }

  /// Whether a listing has the head `SBR 3` of a routine.
  bool has_subroutine(const stl::OperandValue& number) const {
    return std::ranges::any_of(source_.lines, [&](const stl::Line& line) {
      const auto* head = std::get_if<stl::Statement>(&line);
      return head && head->mnemonic == "SBR" && !head->operands.empty() && head->operands[0].value == number;
    });
  }

  /// A CALL or ATCH of a name that stands for no routine. True after a message.
  bool is_missing_block(const Instruction& instruction, const stl::Statement& statement) {
    const bool names = instruction.structure == Structure::Call || instruction.structure == Structure::Attach;
    const auto* name = names && !statement.operands.empty() ? std::get_if<stl::Name>(&statement.operands[0].value) : nullptr;
    const auto named = missing_callee(instruction, statement);
    if (!name && named) name = &*named;
    if (!name || !name->reason.starts_with("there is no")) return false;
    if (causes_read_.contains(name->reason)) return true;
    if (instruction.structure == Structure::Attach) {
      error(statement.operands[0].position, name->reason, "give the file with its block too");
      return true;
    }
    auto [message, hint, cause] = missing_routine(*name, model_);
    error(statement.operands[0].position, std::move(message), std::move(hint), std::move(cause));
    return true;
  }

  /// The block that a CALL calls; null if the program has no blocks, whose listing has no parameters.
  const stl::Block* called_block(const Instruction& instruction, const stl::Statement& statement) const {
    if (instruction.structure != Structure::Call || statement.operands.empty()) return nullptr;
    const auto* number = std::get_if<stl::Integer>(&statement.operands[0].value);
    const auto found = number ? subroutine_blocks_.find(number->value) : subroutine_blocks_.end();
    return found == subroutine_blocks_.end() ? nullptr : found->second;
  }

  bool pass_parameters(const Instruction& call, const stl::Statement& statement, const stl::Block& block) {
    auto parameters = place_parameters(call, statement, block, model_, constants_, diagnostics_);
    if (!parameters) return false;
    if (!parameters->empty()) parameters_.emplace(statements_.size(), std::move(*parameters));
    return true;
  }

  static std::string counted(std::size_t operands) {
    return operands == 0 ? "no operand" : operands == 1 ? "1 operand" : fmt::format("{} operands", operands);
  }

  /// Whether blocks of bytes, words or bits end inside their areas, if their length is known: fixed, or by a constant count.
  bool blocks_fit(const Instruction& instruction, const stl::Statement& statement) {
    const auto& placed = placed_.back();
    const auto rules = instruction.rules();
    const auto rule = std::ranges::find_if(rules, &OperandRule::count);
    const auto count = rule == rules.end() ? 0 : placed[static_cast<std::size_t>(rule - rules.begin())].constant;
    bool good = true;
    for (std::size_t i = 0; i < rules.size(); ++i) {
      if (!placed[i].area) continue;
      const bool known = rules[i].counted == 0 || count.has_value();
      const std::int64_t elements = known ? rules[i].reach(std::abs(count.value_or(0))) : 1;
      if (!block_fits(rules[i], placed[i], elements, statement.operands[i]))
        good = false;
      else if (*placed[i].area == Area::SM)
        warn_of_special_memory(model_, special_bytes(rules[i], placed[i], elements), rules[i], statement, i, diagnostics_);
    }
    return good;
  }

  bool block_fits(const OperandRule& rule, const PlacedOperand& placed, std::int64_t elements, const stl::Operand& written) {
    if (elements <= 1) return true;
    const AreaInfo& area = info(*placed.area);
    const auto block = [&] { return fmt::format("{} {} from {}", elements, unit(rule.width), stl::to_text(written)); };
    if (!fits(rule, placed, elements)) {
      error(written.position, fmt::format("{} run past the end of {} memory (range error 0091)", block(), area.name),
            fmt::format("{} memory is {}", area.name, range_text(model_, *placed.area, rule.width)));
      return false;
    }
    const SpecialMemory* refused =
        *placed.area == Area::SM ? refused_special_memory(model_, special_bytes(rule, placed, elements)) : nullptr;
    if (!refused) return true;
    error(written.position,
          fmt::format("{} reach {} ({}), which are not modelled", block(), bytes_text(*refused), refused->meaning),
          std::string(refused->why));
    return false;
  }

  static SpecialBytes special_bytes(const OperandRule& rule, const PlacedOperand& placed, std::int64_t elements) {
    const std::int64_t bytes =
        rule.width == Width::Bit ? (placed.operand.bit + elements + 7) / 8 : elements * bytes_of(rule.width);
    return {placed.operand.at - image::kSM, static_cast<std::uint32_t>(bytes)};
  }

  bool mode_fits(const Instruction& instruction, const stl::Statement& statement) {
    if (instruction.structure != Structure::DefineCounter) return true;
    const auto& placed = placed_.back();
    const auto counter = static_cast<std::size_t>(*placed[0].constant);
    const CounterModes modes = model_.counter_modes[counter];
    if (modes >> *placed[1].constant & 1) return true;
    error(statement.operands[1].position, fmt::format("HSC{} has no mode {}", counter, *placed[1].constant),
          fmt::format("HSC{} has {}", counter, modes_text(modes)));
    return false;
  }

  static std::string modes_text(CounterModes modes) {
    if (modes == kMode0) return "only mode 0";
    std::vector<int> numbers;
    for (int mode = 0; modes >> mode; ++mode)
      if (modes >> mode & 1) numbers.push_back(mode);
    return fmt::format("the modes {}", fmt::join(numbers, ", "));
  }

  static std::string_view unit(Width width) {
    return width == Width::Bit ? "bits" : width == Width::Byte ? "bytes" : width == Width::Word ? "words" : "double words";
  }

  bool fits(const OperandRule& rule, const PlacedOperand& placed, std::int64_t count) const {
    const AreaInfo& area = info(*placed.area);
    const std::int64_t size = model_.size_of(*placed.area);
    if (rule.width == Width::Bit) {
      const std::int64_t first = std::int64_t{placed.operand.at - area.bits} * 8 + placed.operand.bit;
      return first + count <= size * (area.element ? 1 : 8);
    }
    return placed.operand.at - area.base + count * placed.operand.width <= size * std::max(1u, area.element);
  }

  /// The words of program memory that a statement takes at least: one, and its constants where they cannot be part of that.
  static std::size_t least_words(const CheckedStatement& s) {
    std::size_t words = 1;
    const auto rules = s.instruction->rules();
    for (std::size_t i = 0; i < std::min(rules.size(), s.statement->operands.size()); ++i) {
      const stl::OperandValue& value = s.statement->operands[i].value;
      const auto* integer = std::get_if<stl::Integer>(&value);
      const bool number = integer && rules[i].kind == OperandKind::Memory;
      if (std::holds_alternative<stl::Real>(value) ||
          (number && (integer->value < INT16_MIN || integer->value > UINT16_MAX)))
        words += 2;
      else if (number && (integer->value < INT8_MIN || integer->value > UINT8_MAX))
        words += 1;
    }
    return words;
  }

  void count_words(const CheckedStatement& s) {
    words_ += least_words(s);
    if (!beyond_ && words_ > model_.program_words) beyond_ = s.statement;
  }

  void check_size() {
    if (beyond_)
      error(beyond_->position,
            fmt::format("the program is too large: at least {} words for {} instructions and their constants, CPU {} has {} "
                        "words (compile rule 0080)",
                        words_, statements_.size(), model_.name, model_.program_words),
            larger_cpu(words_));
    if (constants_.bytes().size() > image::kSize - image::kConstants)
      error({1, 1, 1}, "the program has too many different constants (compile rule 0080)");
  }

  /// A CPU that may hold the program. It may still be too large for that one: its words are not counted exactly.
  std::string larger_cpu(std::size_t words) const {
    const CpuModel* larger = smallest_cpu([&](const CpuModel& model) { return model.program_words >= words; });
    return larger ? fmt::format("{} bytes at least; CPU {} holds {}: --cpu {}", 2 * words, larger->name,
                                2 * larger->program_words, larger->name)
                  : fmt::format("{} bytes at least: no CPU that is modelled holds them", 2 * words);
  }

  /// A timer is a TON or a TOF, not both: they share their numbers (facts 1.1).
  void check_timer_kinds() {
    std::map<std::uint32_t, const CheckedStatement*> first_use;
    for (const CheckedStatement& s : statements_) {
      const TimerKind kind = s.instruction->operand[0].timer;
      if (!s.operands_good || (kind != TimerKind::OnDelay && kind != TimerKind::OffDelay)) continue;
      const stl::Operand& timer = s.statement->operands[0];
      const auto [first, added] = first_use.emplace(std::get<stl::Address>(timer.value).number, &s);
      if (added || first->second->instruction->operand[0].timer == kind) continue;
      const CheckedStatement& other = *first->second;
      error(timer.position,
            fmt::format("{} is a {} in line {}; it cannot be a {} too", stl::to_text(timer), other.instruction->mnemonic,
                        other.statement->position.line, s.instruction->mnemonic),
            "use another timer");
    }
  }

  // --- what is known of a program with errors ---

  static bool is_end(Structure structure) {
    return structure == Structure::MainEnd || structure == Structure::SubroutineEnd || structure == Structure::InterruptEnd;
  }

  /// Whether the routines of a program are known from their heads to their ends.
  bool routines_are_known() const {
    if (statements_.empty() || lacks_main_program() || !is_end(statements_.back().instruction->structure)) return false;
    return std::ranges::none_of(statements_, [&](const CheckedStatement& s) {
      const Structure structure = s.instruction->structure;
      const bool bounds = is_end(structure) || begins_routine(structure);
      return bounds && (!s.operands_good || misplaced_.contains(place_of(s.statement->position)));
    });
  }

  /// Whether nothing is known of a statement: not even where it leads to.
  bool is_unread(const CheckedStatement& s) const {
    const Structure structure = s.instruction->structure;
    const bool leads_elsewhere = structure == Structure::Jump || structure == Structure::Call;
    return s.instruction == &unread_instruction() || (leads_elsewhere && !s.operands_good) ||
           misplaced_.contains(place_of(s.statement->position));
  }

  /// The program in which to look for warnings although it has errors; null if too little of it is known.
  std::shared_ptr<const Program> what_is_known(const ProgramStructure& structure) {
    if (!routines_are_known()) return nullptr;
    auto program = program_of(structure);
    program->source.lines = lines_with_unread();
    for (std::uint32_t i = 0; i < statements_.size(); ++i)
      program->ops.push_back(is_unread(statements_[i]) ? what_is_known(*statements_[i].statement) : decode(i, structure));
    program->constants = constants_.bytes();
    return program;
  }

  /// Of a line with a wrong operand the instruction is known, so that it hides no warnings of others.
  Op what_is_known(const stl::Statement& statement) const {
    Op op;
    op.instruction = &unread_instruction();
    const auto unread = std::ranges::lower_bound(unread_, statement.position.line, {},
                                                 [](const stl::Statement& each) { return each.position.line; });
    const bool of_parser = unread != unread_.end() && &*unread == &statement;
    const auto words = of_parser ? stl::split_words(statement.mnemonic) : std::vector<std::string>{};
    const Instruction* const instruction = words.empty() ? nullptr : find_instruction(stl::upper_case(words.front()));
    if (!instruction || instruction->structure != Structure::None) return op;
    op.instruction = instruction;
    for (std::size_t i = 0; i < instruction->rules().size(); ++i) op.operand[i].at = kUnread;
    return op;
  }

  // --- decoding ---

  /// A program with all but its ops.
  std::shared_ptr<Program> program_of(const ProgramStructure& structure) const {
    auto program = std::make_shared<Program>();
    program->model = &model_;
    program->source = source_;
    program->subroutine = structure.subroutine;
    program->interrupt = structure.interrupt;
    for (const CheckedStatement& s : statements_) {
      program->statements.push_back(*s.statement);
      note_pointers(*s.statement, *program);
    }
    for (const AreaInfo& area : all_areas())
      if (const auto code = model_.pointer_code(area.area))
        program->reach[*code] = {area.base, model_.size_of(area.area) * std::max(1u, area.element)};
    return program;
  }

  std::shared_ptr<Program> decode(const ProgramStructure& structure, const TimeTable& times) {
    auto program = program_of(structure);
    program->times = times;
    for (std::uint32_t i = 0; i < statements_.size(); ++i) {
      program->ops.push_back(decode(i, structure));
      set_cost(program->ops.back(), operands_of(i, structure), times);
      if (const auto found = parameters_.find(i); found != parameters_.end())
        add_parameters(program->ops.back(), found->second, *program);
      note_timer(program->ops.back(), *program);
      note_reals(placed_[i], program->ops.back(), *program);
      note_reception(program->ops.back(), *program);
      note_counter_mode(program->ops.back(), *program);
      program->uses_local_memory |= std::ranges::any_of(program->ops.back().operand, is_local);
    }
    follow_eno(*program);
    link(*program);
    std::sort(program->reals.begin(), program->reals.end());
    program->constants = constants_.bytes();
    program->data = std::move(data_);
    program->no_power_flow = times[SystemTime::NoPowerFlow];
    program->interrupt_entry = times[SystemTime::InterruptEntry];
    program->eeprom_save = times[SystemTime::EepromSave];
    const Time overhead = times[SystemTime::ScanOverhead];
    program->scan_phase = {overhead / 4, overhead / 4, overhead / 4, overhead - 3 * (overhead / 4)};
    return program;
  }

  /// Operands 1 and 2 of a CALL are where its parameters are.
  static void add_parameters(Op& op, const std::vector<Parameter>& parameters, Program& program) {
    op.operand[1].at = static_cast<std::uint32_t>(program.parameters.size());
    op.operand[2].at = static_cast<std::uint32_t>(parameters.size());
    op.body = run_with_parameters;
    program.parameters.insert(program.parameters.end(), parameters.begin(), parameters.end());
    program.uses_local_memory = true;
    for (const Parameter& parameter : parameters)
      if (parameter.real && !parameter.actual.pointer && parameter.actual.at < image::kConstants)
        program.reals.push_back(parameter.actual.at);
  }

  /// NEXT works on the operands of its FOR.
  const std::array<PlacedOperand, 3>& operands_of(std::uint32_t i, const ProgramStructure& structure) const {
    return placed_[statements_[i].instruction->structure == Structure::Next ? structure.head[i] : i];
  }

  /// Decodes a statement, without what it costs.
  Op decode(std::uint32_t i, const ProgramStructure& structure) {
    const Instruction& instruction = *statements_[i].instruction;
    const auto& placed = operands_of(i, structure);
    Op op;
    op.instruction = &instruction;
    op.power_mask = instruction.rung.needs_power_flow;
    op.in_segment = structure.in_segment[i];
    op.target = structure.target[i];
    op.skip_to = instruction.structure == Structure::For ? op.target : i + 1;
    op.is_contact =
        (instruction.structure == Structure::None || instruction.structure == Structure::Compare) && !is_box_or_coil(op);
    for (std::size_t k = 0; k < instruction.rules().size(); ++k)
      (instruction.operand[k].role == Role::In ? op.inputs : op.outputs) |= static_cast<std::uint8_t>(1u << k);
    Areas written = 0;
    for (std::size_t k = 0; k < op.operand.size(); ++k) {
      op.operand[k] = placed[k].operand;
      op.has_pointer |= placed[k].operand.pointer;
      if (!placed[k].area || k >= instruction.rules().size()) continue;
      const OperandRule& rule = instruction.operand[k];
      if (rule.role != Role::In) written |= set_of(*placed[k].area);
      if (rule.width == Width::Bit && rule.counted != 0) op.target = bits_left(*placed[k].area, placed[k].operand);
    }
    add_hidden_operand(op, placed_[structure.head[i]]);
    op.body = body_of(op, written);
    return op;
  }

  /// The number of bits from the operand to the end of its area.
  std::uint32_t bits_left(Area area, const Operand& first) const {
    const AreaInfo& is = info(area);
    const std::uint32_t bits = model_.size_of(area) * (is.element != 0 ? 1 : 8);
    return bits - ((first.at - is.bits) * 8 + first.bit);
  }

  /// Whether an operand is in local memory, or a pointer held there.
  static bool is_local(const Operand& operand) { return operand.at >= image::kL && operand.at < image::kConstants; }

  /// Lets each box set ENO in a program that reads it.
  static void follow_eno(Program& program) {
    const auto reads_eno = [](const Op& op) { return op.instruction->effect == Effect::ReadsEno; };
    if (std::ranges::none_of(program.ops, reads_eno)) return;
    for (Op& op : program.ops) {
      program.box_body.push_back(op.body);
      op.sets_eno = op.instruction->rung.eno != Eno::None;
      if (op.sets_eno) op.body = run_with_eno;
    }
  }

  /// The body, or a step around it if the operands need one.
  static Body body_of(const Op& op, Areas written) {
    if (contains(written, Area::SM)) return run_with_port_control;
    if (contains(written, Area::AQ)) return run_with_analog_output;
    if (!op.has_pointer) return op.direct_body();
    const bool first = op.operand[0].pointer, second = op.operand[1].pointer, third = op.operand[2].pointer;
    if (third || (first && second)) return run_with_pointers;
    return first ? run_with_pointer_first : run_with_pointer_second;
  }

  static void note_reception(const Op& op, Program& program) {
    if (op.instruction->effect == Effect::Receives && !op[1].unread()) program.receives_messages.at(op[1].at) = true;
  }

  /// In a program with errors the numbers may be any.
  static void note_counter_mode(const Op& op, Program& program) {
    const bool defines = op.instruction->structure == Structure::DefineCounter && !op[0].unread() && !op[1].unread();
    if (!defines || op[0].at >= program.counter_modes.size() || op[1].at > kLastMode) return;
    CounterModes& modes = program.counter_modes[op[0].at];
    modes = static_cast<CounterModes>(modes | 1u << op[1].at);
  }

  /// Timers that are also updated outside their instructions.
  static void note_timer(const Op& op, Program& program) {
    if (op.instruction->hidden != Hidden::Number || op.instruction->operand[0].areas != set_of(Area::T)) return;
    const auto number = static_cast<std::uint8_t>(op[2].at);
    program.uses_timers = true;
    const Time base = timer_base(number).base;
    auto& timers = base == kMillisecond        ? program.timers_1ms
                   : base == 10 * kMillisecond ? program.timers_10ms
                                               : program.timers_100ms;
    if (std::find(timers.begin(), timers.end(), number) == timers.end()) timers.push_back(number);
  }

  /// `&SB0`
  static void note_pointers(const stl::Statement& statement, Program& program) {
    for (const stl::Operand& operand : statement.operands)
      if (const auto* to = std::get_if<stl::AddressOf>(&operand.value))
        if (const auto area = area_named(to->target.area)) program.pointed_at |= set_of(*area);
  }

  /// Double words that are real numbers.
  static void note_reals(const std::array<PlacedOperand, 3>& placed, const Op& op, Program& program) {
    for (std::size_t k = 0; k < op.instruction->rules().size(); ++k)
      if (op.instruction->operand[k].real && placed[k].area) program.reals.push_back(op[k].at);
  }

  /// Operands that are not written in the source.
  void add_hidden_operand(Op& op, const std::array<PlacedOperand, 3>& segment) {
    const Operand& first = op.operand[0];
    Operand& hidden = op.operand[2];
    switch (op.instruction->hidden) {
      case Hidden::None:
        break;
      case Hidden::InputPoint:
        op.operand[0].at += image::kInputs - image::kI;
        break;
      case Hidden::OutputPoint:
        hidden = first;
        hidden.at += image::kOutputs - image::kQ;
        break;
      case Hidden::RisingMemory:
      case Hidden::FallingMemory:
      case Hidden::LoopMemory:
        hidden = {.at = image::kEdges + edges_ / 8, .bit = static_cast<std::uint8_t>(edges_ % 8)};
        ++edges_;
        break;
      case Hidden::Number:
        hidden = {.at = (first.at - (first.at < image::kC ? image::kT : image::kC)) / 2};
        break;
      case Hidden::SegmentBit:
        hidden = segment[0].operand;
        break;
    }
  }

  using OperandAreas = std::array<std::optional<Area>, 3>;

  /// The cost without what pointers add. Many statements have the same: the table is searched once for each.
  Cost cost_of(const Instruction& instruction, const OperandAreas& areas, const TimeTable& times) {
    const auto [found, added] = costs_.try_emplace({&instruction, areas});
    if (!added) return found->second;
    const auto cost = times.cost(instruction.mnemonic, areas[0]);
    assert(cost && "the table of times has a line for every instruction");
    found->second = {cost->base + times.added_by(instruction.mnemonic, areas), cost->per_unit};
    return found->second;
  }

  void set_cost(Op& op, const std::array<PlacedOperand, 3>& placed, const TimeTable& times) {
    const Cost cost = cost_of(*op.instruction, {placed[0].area, placed[1].area, placed[2].area}, times);
    const auto pointers = std::count_if(op.operand.begin(), op.operand.end(), [](const Operand& o) { return o.pointer; });
    const Time of_pointers = pointers == 0 ? 0 : pointers * times[SystemTime::IndirectOperand];
    // Its own figure, and for each operand at most one for its area and one as a pointer.
    constexpr Time kParts = 1 + 2 * std::tuple_size_v<decltype(op.operand)>;
    static_assert(kParts * kLongestFigure <= std::numeric_limits<std::int32_t>::max());
    op.cost = static_cast<std::int32_t>(cost.base + of_pointers);
    op.unit_cost = static_cast<std::int32_t>(cost.per_unit);
  }

  const stl::Source& source_;
  stl::Diagnostics diagnostics_;
  const CpuModel& model_;
  ConstantPool constants_;
  std::map<std::int64_t, const stl::Block*> subroutine_blocks_;  // of source_
  std::map<std::size_t, std::vector<Parameter>> parameters_;     // of the CALLs among statements_
  std::vector<InitialData> data_;
  std::map<std::pair<const Instruction*, OperandAreas>, Cost> costs_;
  std::vector<CheckedStatement> statements_;
  std::vector<std::array<PlacedOperand, 3>> placed_;  // one for each of statements_
  std::size_t words_ = 0;                             // of statements_, at least
  const stl::Statement* beyond_ = nullptr;            // the first that does not fit in the CPU's program memory
  std::uint32_t edges_ = 0;
  bool begins_network_ = false;                                  // the next statement
  std::set<std::uint32_t> unread_lines_;                         // of errors of the parser, below the line that is read
  std::set<std::string, std::less<>> causes_read_{};             // of messages of the parser and of tables
  std::deque<stl::Statement> unread_;                            // in their places among statements_
  std::set<std::pair<std::uint32_t, std::uint32_t>> misplaced_;  // lines and columns where the structure has errors
};

/// Puts addresses in place of names, ends where a CPU 22x needs none, and stand-ins in place of the routines of libraries.
void read_names(stl::ParseResult& parsed, const CpuModel& model) {
  read_german(parsed);
  StandInFiles stand_ins = link_stand_ins(parsed, model);
  stl::resolve_symbols(parsed);
  if (model.self & kCpu22x) add_missing_ends(parsed);
  for (stl::ParseResult& file : stand_ins) stl::append(parsed, std::move(file));
}

/// A source as the CPUs 21x take it, and as the CPUs 22x do; one that needs stand-ins, as each CPU does.
class ForEachCpu {
 public:
  explicit ForEachCpu(stl::ParseResult parsed) : source_(std::move(parsed)), same_for_family_(!may_need_stand_ins(source_)) {
    if (same_for_family_) {
      read_names(for_21x_ = source_, cpu214());
      read_names(for_22x_ = std::move(source_), cpu224());
    }
  }

  bool is_fine_for(const CpuModel& model) const {
    if (same_for_family_) return is_fine(model.self & kCpu22x ? for_22x_ : for_21x_, model);
    stl::ParseResult own = source_;
    read_names(own, model);
    return is_fine(own, model);
  }

 private:
  static bool is_fine(const stl::ParseResult& read, const CpuModel& model) {
    return !has_errors(read.diagnostics) && Checker(read.source, {}, model).is_fine();
  }

  stl::ParseResult source_;
  bool same_for_family_;
  stl::ParseResult for_21x_{}, for_22x_{};
};

}  // namespace

DecodedSource decode_program(stl::ParseResult parsed, const CpuModel& model, const TimeTable& times) {
  read_names(parsed, model);
  DecodedSource result = Checker(parsed.source, std::move(parsed.diagnostics), model).decoded(times);
  result.source = std::move(parsed.source);
  return result;
}

std::vector<const CpuModel*> cpus_without_errors(stl::ParseResult parsed) {
  const ForEachCpu read(std::move(parsed));
  std::vector<const CpuModel*> fine;
  std::ranges::copy_if(all_cpus(), std::back_inserter(fine),
                       [&](const CpuModel* model) { return read.is_fine_for(*model); });
  return fine;
}

const CpuModel* first_cpu_without_errors(stl::ParseResult parsed, std::span<const CpuModel* const> tried) {
  const ForEachCpu read(std::move(parsed));
  const auto first = std::ranges::find_if(tried, [&](const CpuModel* model) { return read.is_fine_for(*model); });
  return first == tried.end() ? nullptr : *first;
}

TimeTable default_times(const CpuModel& model) {
  const auto tables = times_of(model);
  assert(!tables.empty() && tables.front()->own);
  return tables.front()->table();
}

}  // namespace s7200
