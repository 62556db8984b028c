#include "interpreter/stl/blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/block_words.hpp"
#include "interpreter/stl/headings.hpp"
#include "interpreter/stl/tables/data_block.hpp"

namespace s7200::stl {

namespace {

using namespace std::string_view_literals;

// --- the keywords ---

constexpr std::string_view kDataBlock = "DATA_BLOCK";
constexpr std::size_t kLongestKeyword = 22;  // END_ORGANIZATION_BLOCK

std::string_view code_of_line(std::string_view line) { return trim(line.substr(0, line.find("//"))); }

/// The first word of a line in capitals, if it may be a keyword.
std::string keyword_of(std::string_view code) {
  std::size_t end = 0;
  while (end < code.size() && (is_letter(code[end]) || code[end] == '_')) ++end;
  return end > kLongestKeyword ? std::string() : upper_case(code.substr(0, end));
}

bool opens_block(std::string_view keyword) {
  return keyword == kDataBlock || std::ranges::find(kBlockWords, keyword, &BlockWords::keyword) != kBlockWords.end();
}

bool closes_block(std::string_view keyword) { return keyword.starts_with("END_") && opens_block(keyword.substr(4)); }

// --- headings of published listings ---

struct ChineseHeading {
  std::string_view word;
  Block::Kind kind;
};

// Headings in short and long characters, for PRC and Taiwan. The longer of two that end alike comes first.
constexpr std::array kChineseHeadings{
    ChineseHeading{"主程序", Block::Kind::Main},
    ChineseHeading{"主程式", Block::Kind::Main},
    ChineseHeading{"中断服务程序", Block::Kind::Interrupt},
    ChineseHeading{"中斷服務程序", Block::Kind::Interrupt},
    ChineseHeading{"中断子程序", Block::Kind::Interrupt},
    ChineseHeading{"中斷子程序", Block::Kind::Interrupt},
    ChineseHeading{"中断程序", Block::Kind::Interrupt},
    ChineseHeading{"中斷程序", Block::Kind::Interrupt},
    ChineseHeading{"中斷程式", Block::Kind::Interrupt},
    ChineseHeading{"子程序", Block::Kind::Subroutine},
    ChineseHeading{"子程式", Block::Kind::Subroutine},
};

struct Heading {
  Block::Kind kind;
  std::string_view name;
};

/// A line that is nothing but a name and what it is the name of, perhaps with a colon; the main program has none.
std::optional<Heading> chinese_heading(std::string_view line) {
  std::string_view text = trim(line);
  for (const std::string_view colon : {":", "："})
    if (text.ends_with(colon)) text = trim(text.substr(0, text.size() - colon.size()));
  auto row = std::ranges::find_if(kChineseHeadings, [&](const ChineseHeading& each) { return text.ends_with(each.word); });
  const bool name_first = row != kChineseHeadings.end();
  if (!name_first)  // `中断程序 INT_0`
    row = std::ranges::find_if(kChineseHeadings, [&](const ChineseHeading& each) {
      return text.starts_with(each.word) && default_routine(trim(text.substr(each.word.size())));
    });
  if (row == kChineseHeadings.end()) return std::nullopt;
  const std::string_view name =
      trim(name_first ? text.substr(0, text.size() - row->word.size()) : text.substr(row->word.size()));
  const bool plain = std::ranges::all_of(name, [](char c) { return is_letter(c) || is_digit(c) || c == '_'; });
  if (!plain || name.empty() != (row->kind == Block::Kind::Main)) return std::nullopt;
  return Heading{row->kind, name};
}

std::optional<Variable::Kind> declaration_kind(std::string_view keyword) {
  if (keyword == "VAR_TEMP") return Variable::Kind::Temporary;
  const auto found = std::ranges::find(kDeclarationWords, keyword);
  if (found == kDeclarationWords.end()) return std::nullopt;
  return static_cast<Variable::Kind>(found - kDeclarationWords.begin());
}

// --- local memory ---

std::uint32_t bytes_of(Size size) { return size == Size::Double ? 4 : size == Size::Word ? 2 : 1; }

/// Puts variables into local memory: one to eight consecutive bits share a byte, everything else is at the next whole byte
/// (S7-200 manual, CALL).
class LocalMemory {
 public:
  Address place(Size size) {
    if (size != Size::Bit) {
      bits_ = 0;
      return {"L", size, std::exchange(next_, next_ + bytes_of(size)), 0};
    }
    if (bits_ == 0) ++next_;
    const Address address{"L", size, next_ - 1, bits_};
    bits_ = static_cast<std::uint8_t>((bits_ + 1) % 8);
    return address;
  }

  std::uint32_t used() const { return next_; }

 private:
  std::uint32_t next_ = 0;
  std::uint8_t bits_ = 0;  // of the byte before `next_` that are taken; 0: all, or it is not a byte of bits
};

// --- the reader ---

/// Whether a line is a statement, an instruction or a mnemonic and operands one of which is a whole address: `LD I0.0`, but
/// not `Version 2` or `Pump M1`.
bool is_statement(std::string_view code, const IsInstruction& is_instruction) {
  const ParseResult parsed = parse(code, {});
  const auto* statement = parsed.source.lines.empty() ? nullptr : std::get_if<Statement>(&parsed.source.lines.front());
  if (!statement) return false;
  const std::size_t operands = statement->operands.size();
  if (is_instruction && is_instruction(statement->mnemonic, operands)) return true;
  if (is_instruction && statement->mnemonic == "CALL" && operands > 0) return true;
  const auto is_name = [](const Operand& operand) { return std::holds_alternative<Name>(operand.value); };
  const auto is_whole = [](const Operand& operand) {
    const auto* address = std::get_if<Address>(&operand.value);
    return address ? address->size != Size::None
                   : std::holds_alternative<AddressOf>(operand.value) || std::holds_alternative<Indirect>(operand.value);
  };
  return std::ranges::none_of(statement->operands, is_name) && std::ranges::any_of(statement->operands, is_whole);
}

class BlockReader {
 public:
  enum class Heads : std::uint8_t { Keywords, Headings };

  BlockReader(std::string_view text, std::string name, Heads heads, const IsInstruction& is_instruction)
      : lines_(split_lines(text)), in_document_(heads == Heads::Headings), is_instruction_(is_instruction) {
    result_.source.name = std::move(name);
  }

  ParseResult result() {
    find_begins();
    for (number_ = 1; number_ <= lines_.size(); ++number_) read_line(lines_[number_ - 1]);
    if (open_) close_block(static_cast<std::uint32_t>(lines_.size()), false);
    drop_title();
    number_blocks_without_number();
    parse_code();
    sort(result_.diagnostics);
    return std::move(result_);
  }

 private:
  enum class State : std::uint8_t { Outside, Head, Declarations, Code, Data };

  /// A line of a block that is not STL: its head, its end, a comment before BEGIN.
  struct Mark {
    enum class Kind : std::uint8_t { Head, End, Comment } kind;
    std::uint32_t line;
    std::size_t block;
    std::string comment{};
    bool after_line = false;  ///< the end of a block that the text does not end
  };

  // --- places ---

  /// Parts of a line are mostly asked for in order, so the line is counted only once.
  Position position_of(std::string_view part) {
    const std::string_view line = lines_[number_ - 1];
    const auto before = static_cast<std::size_t>(part.data() - line.data());
    if (counted_line_ != number_ || before < counted_) {
      counted_line_ = number_;
      counted_ = 0;
      column_ = 1;
    }
    column_ += count_characters(line.substr(counted_, before - counted_));
    counted_ = before;
    return {number_, static_cast<std::uint32_t>(column_),
            static_cast<std::uint32_t>(std::max<std::size_t>(1, count_characters(part)))};
  }

  // A line full of wrong declarations must not drown the other messages.
  static constexpr std::size_t kMostErrorsOfALine = 10;

  void error(const Position& at, std::string message, std::string hint = {}, std::string cause = {}) {
    if (std::exchange(error_line_, at.line) != at.line) errors_ = 0;
    if (++errors_ > kMostErrorsOfALine + 1) return;
    if (errors_ > kMostErrorsOfALine) message = "there are more errors in this line";
    result_.diagnostics.push_back({Severity::Error, at, std::move(message), std::move(hint), std::move(cause)});
  }

  Block& block() { return result_.source.blocks.back(); }

  // --- lines ---

  /// Finds the heads that have a BEGIN: everything between the two is not code.
  void find_begins() {
    has_begin_.assign(lines_.size(), false);
    std::optional<std::size_t> head;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const std::string keyword = keyword_of(code_of_line(lines_[i]));
      if (opens_block(keyword)) head = i;
      if (keyword == "BEGIN" && head) has_begin_[*std::exchange(head, std::nullopt)] = true;
      if (keyword == "NETWORK") head.reset();
    }
  }

  void read_line(std::string_view line) {
    const std::string_view code = code_of_line(line);
    const std::string keyword = keyword_of(code);
    if (in_document_) {
      if (const auto heading = chinese_heading(line)) return open_block(*heading, line);
      if (state_ == State::Outside) return;  // text before the listing
    }
    if (opens_block(keyword)) return open_block(keyword, code);
    if (closes_block(keyword)) return end_block(keyword, code);
    switch (state_) {
      case State::Outside:
        return read_outside(code, line);
      case State::Head:
        return read_head(keyword, code, line);
      case State::Declarations:
        return read_declaration(keyword, code, line);
      case State::Code:
        return read_code(keyword, code, line);
      case State::Data:
        if (keyword == "BEGIN" || keyword == "TITLE") return;
        return read_data_line(line, number_, result_);
    }
  }

  void read_outside(std::string_view code, std::string_view line) {
    if (code.empty()) return keep(line);
    if (keyword_of(code) == "TITLE") {  // written before the head of its block
      drop_title();
      title_before_ = title_of(code, line);
      return;
    }
    error(position_of(code), "this line is in no block",
          "a block ends with END_ and its keyword; what follows begins with the head of another block", "outside of blocks");
  }

  void read_head(const std::string& keyword, std::string_view code, std::string_view line) {
    if (keyword == "BEGIN") {
      state_ = State::Code;
    } else if (keyword == "TITLE") {
      if (const auto title = title_of(code, line); block().title.empty() || title == block().title)
        block().title = title;
      else
        marks_.push_back({Mark::Kind::Comment, number_, block_index(), std::string(title)});
    } else if (const auto kind = declaration_kind(keyword)) {
      if (block().kind == Block::Kind::Interrupt && *kind != Variable::Kind::Temporary)
        error(position_of(code), "an interrupt routine has no parameters", "declare its variables with VAR");
      kind_ = *kind;
      state_ = State::Declarations;
      declaration_start_ = position_of(code);
    } else if (keyword == "NETWORK" || (!code.empty() && !begins_later_)) {
      state_ = State::Code;
      read_code(keyword, code, line);
    } else if (keyword.starts_with("VAR_") || keyword == "END_VAR") {
      error(position_of(code), fmt::format("{} does not begin declarations", shortened(code)),
            "they begin with VAR_INPUT, VAR_IN_OUT, VAR_OUTPUT, or VAR for those that are no parameters");
      state_ = keyword == "END_VAR" ? State::Head : State::Declarations;
      kind_ = Variable::Kind::Temporary;
      declaration_start_ = position_of(code);
    } else if (is_statement(code, is_instruction_)) {
      error(position_of(code), "a statement before BEGIN is not part of the program",
            "BEGIN comes before the first network; in front of a comment write //", "before BEGIN");
    } else if (!trim(line).empty()) {
      std::string_view text = trim(line);
      if (text.starts_with("//")) text.remove_prefix(2);
      marks_.push_back({Mark::Kind::Comment, number_, block_index(), std::string(trim_end(text))});
    }
  }

  /// Names a title that no block has taken.
  void drop_title() {
    if (const std::string title = std::exchange(title_before_, {}); !title.empty())
      result_.notes.push_back(
          fmt::format("{}: TITLE={} is left out: the head of no block follows it", result_.source.name, shortened(title)));
  }

  static std::string_view title_of(std::string_view code, std::string_view line) {
    const std::size_t equals = line.find('=');
    std::string_view title = equals == std::string_view::npos ? code.substr("TITLE"sv.size()) : line.substr(equals + 1);
    title = trim(title);
    if (title.starts_with("//")) title = trim(title.substr(2));
    return title;
  }

  void read_code(const std::string& keyword, std::string_view code, std::string_view line) {
    if (keyword == "BEGIN") return;
    if (keyword == "TITLE") {  // of a network; on a line of its own in some exports
      if (code.find('=') != std::string_view::npos)
        return marks_.push_back(
            {Mark::Kind::Comment, number_, block_index(), std::string(trim(line.substr(line.find('=') + 1)))});
    }
    if (const auto kind = declaration_kind(keyword)) {
      error(position_of(code), fmt::format("{} comes after BEGIN", keyword),
            "declare variables between the head of the block and BEGIN");
      kind_ = *kind;
      state_ = State::Declarations;
      declaration_start_ = position_of(code);
      resume_in_code_ = true;
      return;
    }
    if (keyword == "NETWORK") begin_network(code);
    keep(line);
  }

  /// The line goes to the parser of statements.
  void keep(std::string_view line) {
    code_lines_.resize(number_ - 1);
    code_lines_.push_back(line);
  }

  void begin_network(std::string_view code) {
    ++networks_;
    std::string_view written = trim(code.substr("NETWORK"sv.size()));
    std::uint32_t number = networks_;
    std::from_chars(written.data(), written.data() + written.size(), number);
    section(fmt::format("{}, network {}", name_of(block()), number));
  }

  void section(std::string name) { result_.source.sections.push_back({number_, std::move(name)}); }

  static std::string name_of(const Block& block) {
    return block.name.empty() ? fmt::format("{}{}", words(block.kind).letters, block.number) : shortened(block.name);
  }

  // --- heads and ends ---

  void open_block(const std::string& keyword, std::string_view code) {
    if (open_) close_block(number_ - 1, false);
    begins_later_ = has_begin_[number_ - 1];
    networks_ = 0;
    declared_.clear();
    if (keyword == kDataBlock) {
      title_before_.clear();  // a data block has a title that nothing shows
      state_ = State::Data;
      section("data block");
      return;
    }
    const auto kind = std::ranges::find(kBlockWords, keyword, &BlockWords::keyword) - kBlockWords.begin();
    result_.source.blocks.push_back({.kind = static_cast<Block::Kind>(kind), .position = position_of(code)});
    const bool numbered = read_name(trim(code.substr(keyword.size())), code);
    if (!numbered) without_number_.push_back(block_index());
    begin_block();
  }

  void open_block(const Heading& heading, std::string_view line) {
    if (open_) close_block(number_ - 1, false);
    begins_later_ = false;
    networks_ = 0;
    result_.source.blocks.push_back(
        {.kind = heading.kind, .name = std::string(heading.name), .position = position_of(trim(line))});
    without_number_.push_back(block_index());
    begin_block();
  }

  void begin_block() {
    open_ = true;
    block().title = std::exchange(title_before_, {});
    state_ = State::Head;
    if (block().kind == Block::Kind::Main && std::exchange(has_main_, true))
      error(block().position, "the main program is defined twice", "a program has one ORGANIZATION_BLOCK");
    marks_.push_back({Mark::Kind::Head, number_, block_index()});
    section(name_of(block()));
  }

  std::size_t block_index() const { return result_.source.blocks.size() - 1; }

  /// Reads a block's name: `SBR_0:SBR0`, `"Pump control":SBR0`, `SBR0`, `0`. Returns false after a message if there is no
  /// number.
  bool read_name(std::string_view text, std::string_view head) {
    const BlockWords& kind = words(block().kind);
    const std::size_t colon = text.rfind(':');
    std::string_view number = colon == std::string_view::npos ? text : trim(text.substr(colon + 1));
    std::string_view name = colon == std::string_view::npos ? std::string_view{} : trim(text.substr(0, colon));
    if (name.size() > 1 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
    block().name = name;
    std::string_view digits = number;
    if (upper_case(digits.substr(0, kind.letters.size())) == kind.letters) digits = trim(digits.substr(kind.letters.size()));
    std::uint32_t value = 0;
    const auto [end, trouble] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (trouble == std::errc{} && end == digits.data() + digits.size()) {
      block().number = value;
      return true;
    }
    error(position_of(number.empty() ? head : number),
          number.empty() ? fmt::format("{} has no number", kind.keyword)
                         : fmt::format("{} takes {} and a number, not {}", kind.keyword, kind.letters, shortened(number)),
          fmt::format("write {} NAME:{}{}", kind.keyword, kind.letters, block().kind == Block::Kind::Main ? 1 : 0));
    return false;
  }

  void number_blocks_without_number() {
    std::array<std::set<std::uint32_t>, kBlockWords.size()> taken;
    auto& blocks = result_.source.blocks;
    for (std::size_t i = 0, missing = 0; i < blocks.size(); ++i) {
      if (missing < without_number_.size() && without_number_[missing] == i)
        ++missing;
      else
        taken[static_cast<std::size_t>(blocks[i].kind)].insert(blocks[i].number);
    }
    std::uint32_t next = 0;
    for (const std::size_t index : without_number_) {
      auto& numbers = taken[static_cast<std::size_t>(blocks[index].kind)];
      while (!numbers.insert(next).second) ++next;
      blocks[index].number = next;
    }
  }

  void end_block(const std::string& keyword, std::string_view code) {
    const std::string_view own = open_                   ? words(block().kind).keyword
                                 : state_ == State::Data ? kDataBlock
                                                         : std::string_view{};
    if (own.empty()) {
      error(position_of(code), fmt::format("{} does not end any block", keyword), "its head is missing");
      return;
    }
    if (keyword.substr(4) != own)
      error(position_of(code), fmt::format("{} ends a block that began with {}", keyword, own),
            fmt::format("write END_{}", own));
    if (open_) close_block(number_, true);
    state_ = State::Outside;
    result_.source.sections.push_back({number_ + 1, ""});
  }

  void close_block(std::uint32_t line, bool ended) {
    if (state_ == State::Declarations) unclosed_declarations();
    if (!ended && !in_document_)
      error(block().position, fmt::format("{} has no END_{}", name_of(block()), words(block().kind).keyword),
            "the export is not complete: export it again");
    place_variables();
    block().last_line = line;
    marks_.push_back({Mark::Kind::End, line, block_index(), {}, !ended});
    open_ = false;
    state_ = State::Outside;
  }

  // --- variables ---

  void read_declaration(const std::string& keyword, std::string_view code, std::string_view line) {
    if (keyword == "END_VAR") {
      state_ = std::exchange(resume_in_code_, false) ? State::Code : State::Head;
      return;
    }
    if (keyword == "BEGIN" || keyword == "NETWORK" || declaration_kind(keyword)) {
      unclosed_declarations();
      state_ = State::Head;
      return read_head(keyword, code, line);
    }
    const std::size_t comment = line.find("//");
    const std::string note(comment == std::string_view::npos ? std::string_view{} : trim(line.substr(comment + 2)));
    while (!code.empty()) {
      const std::size_t end = std::min(code.find(';'), code.size());
      if (const std::string_view one = trim(code.substr(0, end)); !one.empty()) declare(one, note);
      code.remove_prefix(std::min(end + 1, code.size()));
    }
  }

  void unclosed_declarations() { error(declaration_start_, "the declarations have no END_VAR", "end them with END_VAR"); }

  /// Declares variables: `ptr : DWORD`, `a, b : INT`, `ptr:LD0 : DWORD`
  void declare(std::string_view text, const std::string& comment) {
    const std::size_t colon = text.rfind(':');
    const std::string_view type_name = colon == std::string_view::npos ? std::string_view{} : trim(text.substr(colon + 1));
    const auto type = std::ranges::find(kTypeWords, upper_case(type_name), &TypeWord::name);
    if (type == kTypeWords.end()) {
      constexpr std::string_view kHint = "write NAME : TYPE; with BOOL BYTE CHAR WORD INT DWORD DINT REAL or STRING";
      if (type_name.empty())
        error(position_of(text), fmt::format("'{}' does not declare a variable", shortened(text)), std::string(kHint));
      else
        error(position_of(type_name), fmt::format("there is no type {}", shortened(type_name)), std::string(kHint));
      return;
    }
    for (std::string_view names = text.substr(0, colon); !names.empty();) {
      const std::size_t end = std::min(names.find(','), names.size());
      add_variable(trim(names.substr(0, end)), static_cast<Variable::Type>(type - kTypeWords.begin()), comment);
      names.remove_prefix(std::min(end + 1, names.size()));
    }
  }

  void add_variable(std::string_view name, Variable::Type type, const std::string& comment) {
    const std::string_view whole = name;
    if (name.starts_with('#')) name.remove_prefix(1);
    if (name.size() > 1 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
    if (name.empty()) return error(position_of(whole), "a variable has no name", "write NAME : TYPE;");
    if (!declared_.insert(upper_case(name)).second)
      error(position_of(whole), fmt::format("{} is declared twice in {}", shortened(name), name_of(block())));
    block().variables.push_back({std::string(name), kind_, type, {}, position_of(whole), comment});
  }

  void place_variables() {
    if (const Variable* const last = stl::place_variables(block().variables))
      error(last->position,
            fmt::format("{} does not fit: the local memory of a block has {} bytes", shortened(last->name), kLocalBytes),
            "use V memory for some of the variables");
  }

  // --- the listing ---

  void parse_code() {
    std::string text;
    for (const std::string_view line : code_lines_) text.append(line).push_back('\n');
    ParseResult parsed = parse(text, {});
    result_.source.text = std::move(lines_);
    result_.diagnostics.insert(result_.diagnostics.end(), std::make_move_iterator(parsed.diagnostics.begin()),
                               std::make_move_iterator(parsed.diagnostics.end()));
    merge(std::move(parsed.source.lines));
    main_program_first();
  }

  static std::uint32_t line_of(const Line& line) {
    if (const auto* comment = std::get_if<CommentLine>(&line)) return comment->line;
    if (const auto* blank = std::get_if<BlankLine>(&line)) return blank->line;
    if (const auto* head = std::get_if<NetworkHead>(&line)) return head->position.line;
    return std::get<Statement>(line).position.line;
  }

  void merge(std::vector<Line> code) {
    std::vector<Line>& lines = result_.source.lines;
    auto mark = marks_.begin();
    for (Line& line : code) {
      const std::uint32_t number = line_of(line);
      const auto first = mark;
      for (; mark != marks_.end() && mark->line + mark->after_line <= number; ++mark) add(*mark);
      const bool skipped = std::holds_alternative<BlankLine>(line) && (mark != first || !is_blank_in_text(number));
      if (!skipped) lines.push_back(std::move(line));
    }
    for (; mark != marks_.end(); ++mark) add(*mark);
  }

  bool is_blank_in_text(std::uint32_t number) const { return trim(result_.source.text[number - 1]).empty(); }

  void add(const Mark& mark) {
    const Block& block = result_.source.blocks[mark.block];
    std::vector<Line>& lines = result_.source.lines;
    if (mark.kind == Mark::Kind::Comment) {
      lines.emplace_back(CommentLine{mark.comment, mark.line});
    } else if (mark.kind == Mark::Kind::Head) {
      begin_of_[mark.block] = lines.size();
      add_head(block);
    } else if (!is_ended(block)) {
      lines.emplace_back(Statement{std::string(words(block.kind).end), {mark.line, 1, 1}, {}, {}});
    }
    if (mark.kind == Mark::Kind::End) end_of_[mark.block] = lines.size();
  }

  void add_head(const Block& block) {
    std::string comment = block.name;
    if (!block.title.empty()) comment += (comment.empty() ? "" : ": ") + block.title;
    if (!comment.empty()) comment.insert(0, " ");
    const std::string_view head = words(block.kind).head;
    if (head.empty()) {
      if (!comment.empty()) result_.source.lines.emplace_back(CommentLine{comment, block.position.line});
      return;
    }
    result_.source.lines.emplace_back(
        Statement{std::string(head), block.position, {{Integer{block.number}, block.position}}, comment});
  }

  /// Whether the block's instruction for its end is there already: some exports write RET and the like before the end of the
  /// block.
  bool is_ended(const Block& block) const {
    const auto& lines = result_.source.lines;
    const auto last =
        std::find_if(lines.rbegin(), lines.rend(), [](const Line& l) { return std::holds_alternative<Statement>(l); });
    if (last == lines.rend()) return false;
    const auto& statement = std::get<Statement>(*last);
    return statement.position.line > block.position.line && statement.mnemonic == words(block.kind).end;
  }

  /// Moves the main program to the front; lines before all blocks stay there.
  void main_program_first() {
    const auto& blocks = result_.source.blocks;
    const auto main = std::ranges::find(blocks, Block::Kind::Main, &Block::kind);
    if (main == blocks.end()) return;
    const auto index = static_cast<std::size_t>(main - blocks.begin());
    const auto place = [&](std::size_t line) { return result_.source.lines.begin() + static_cast<std::ptrdiff_t>(line); };
    std::rotate(place(begin_of_[0]), place(begin_of_[index]), place(end_of_[index]));
  }

  std::vector<std::string> lines_;
  bool in_document_;  // blocks have headings in place of keywords, and no ends
  const IsInstruction& is_instruction_;
  std::vector<bool> has_begin_;
  std::vector<std::string_view> code_lines_;  // of `lines_`; what is not STL is empty
  std::vector<Mark> marks_;
  std::map<std::size_t, std::size_t> begin_of_, end_of_;  // of a block, in Source::lines
  ParseResult result_;

  std::uint32_t number_ = 0;  // of the line that is being read
  std::uint32_t counted_line_ = 0, error_line_ = 0;
  std::size_t errors_ = 0;                // errors in error_line_
  std::size_t counted_ = 0, column_ = 1;  // how far it is counted, and to which column
  State state_ = State::Outside;
  bool open_ = false;            // a block that is not the data block
  bool begins_later_ = false;    // the open block has a BEGIN
  bool resume_in_code_ = false;  // declarations came after BEGIN
  std::uint32_t networks_ = 0;   // of the open block
  Variable::Kind kind_{};        // of the declarations that are being read
  Position declaration_start_{};
  std::set<std::string> declared_;  // variables of the open block, in capitals
  bool has_main_ = false;
  std::string title_before_{};  ///< that stands before the head of the block
  std::vector<std::size_t> without_number_;
};

}  // namespace

bool is_block_export(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    const bool may_open_block = line.find('_') != std::string_view::npos;
    if (may_open_block && opens_block(keyword_of(code_of_line(line)))) return true;
  }
  return false;
}

const Variable* place_variables(std::vector<Variable>& variables) {
  std::ranges::stable_sort(variables, {}, &Variable::kind);
  LocalMemory memory;
  const Variable* too_many = nullptr;
  for (Variable& variable : variables) {
    variable.address = memory.place(word(variable.type).size);
    if (memory.used() > kLocalBytes && !too_many) too_many = &variable;
  }
  return too_many;
}

ParseResult read_blocks(std::string_view text, std::string name, const IsInstruction& is_instruction) {
  return BlockReader(text, std::move(name), BlockReader::Heads::Keywords, is_instruction).result();
}

bool has_routine_headings(std::string_view text) {
  if (is_ascii(text)) return false;
  bool after_main = false;
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    const auto heading = chinese_heading(line);
    if (after_main && !trim(line).empty() && keyword_of(code_of_line(line)) == "NETWORK") return true;
    if (heading || !trim(line).empty()) after_main = heading && heading->kind == Block::Kind::Main;
  }
  return false;
}

ParseResult read_headed_document(std::string_view text, std::string name) {
  return BlockReader(text, std::move(name), BlockReader::Heads::Headings, {}).result();
}

}  // namespace s7200::stl
