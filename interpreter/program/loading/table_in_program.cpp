#include "interpreter/program/loading/table_in_program.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/block_words.hpp"
#include "interpreter/stl/tables/symbol_table.hpp"
#include "interpreter/stl/text/plain_line.hpp"

namespace s7200 {
namespace {

using stl::IsInstruction;
using stl::plain::first_word_of_code;
using stl::plain::words_of_code;

enum class LineKind : std::uint8_t { Blank, Statement, Head, Row, Other };

struct ReadLine {
  LineKind kind = LineKind::Other;
  std::string name{};  ///< of the symbol in a row, in capitals
};

/// `Symbol table:`, `Symboltabelle`, `Tabela de símbolos`, `符号表`: what may stand above a table.
bool is_title_of_table(std::string_view line) {
  constexpr std::size_t kMostWords = 5;
  constexpr std::array<std::string_view, 7> kWords{"SYMBOL", "SIMBOL", "MBOLO", "VARIABLE", "MNEMON", "符号", "變數"};
  const std::string text = stl::upper_case(line);
  return stl::split_words(text).size() <= kMostWords &&
         std::ranges::any_of(kWords, [&](std::string_view word) { return text.find(word) != text.npos; });
}

/// `TITLE=Filling, line 2`
bool is_title(std::string_view line) {
  const std::vector<std::string> words = words_of_code(line);
  return words[0].starts_with("TITLE=") || (words.size() > 1 && words[0] == "TITLE" && words[1].starts_with('='));
}

/// The lines between the head of a block of an export and its end: titles, declarations and code.
std::vector<bool> within_blocks(const std::vector<std::string_view>& lines) {
  const auto is_keyword = [](std::string_view word) {
    return word == "DATA_BLOCK" ||
           std::ranges::find(stl::kBlockWords, word, &stl::BlockWords::keyword) != stl::kBlockWords.end();
  };
  std::vector<bool> within(lines.size(), false);
  std::optional<std::size_t> head;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].find('_') == std::string_view::npos) continue;
    const std::string word = first_word_of_code(lines[i]).word;
    if (is_keyword(word)) head = i;
    if (head && word.starts_with("END_") && is_keyword(std::string_view(word).substr(4))) {
      std::fill(within.begin() + static_cast<std::ptrdiff_t>(*head), within.begin() + static_cast<std::ptrdiff_t>(i), true);
      head.reset();
    }
  }
  return within;
}

class TableFinder {
 public:
  /// The text must live as long as this.
  TableFinder(std::string_view text, const IsInstruction& is_instruction) : is_instruction_(is_instruction) {
    while (!text.empty()) lines_.push_back(stl::take_line(text));
    for (const std::string_view line : lines_) read_.push_back({kind_of(line)});
  }

  std::optional<ProgramWithTable> run() {
    if (std::ranges::find(read_, LineKind::Statement, &ReadLine::kind) == read_.end()) return {};
    in_table_.resize(lines_.size());
    above_table_.resize(lines_.size());
    read_rows();
    for (std::size_t i = 0; i < read_.size(); ++i)
      if (read_[i].kind == LineKind::Head || read_[i].kind == LineKind::Row) i = take_table(i);
    if (std::ranges::find(in_table_, true) == in_table_.end()) return {};
    ProgramWithTable result;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (!above_table_[i]) (in_table_[i] ? result.table : result.program) += lines_[i];
      result.table += '\n';
      result.program += '\n';
    }
    return result;
  }

 private:
  /// The kind of a line, but for those of a table.
  LineKind kind_of(std::string_view line) const {
    const auto [word, others] = first_word_of_code(line);
    if (word.empty() || line.find_first_not_of("-=+|: \t") == line.npos) return LineKind::Blank;
    return word == "NETWORK" || is_instruction_(word, others) ? LineKind::Statement : LineKind::Other;
  }

  /// Looks for lines of a table. In a block of an export there are none.
  void read_rows() {
    const std::vector<bool> within = within_blocks(lines_);
    for (std::size_t i = 0; i < lines_.size(); ++i)
      if (read_[i].kind == LineKind::Other && !within[i]) read_[i] = read_row(lines_[i]);
  }

  ReadLine read_row(std::string_view line) const {
    constexpr std::size_t kLongestRow = 300;
    const auto [word, others] = first_word_of_code(line);
    if (line.size() > kLongestRow || word.find_first_not_of("\"'") == std::string::npos) return {};
    const bool has_cells = others > 0 || line.find_first_of(";|") != line.npos;
    if (has_cells && stl::is_head_of_symbols(line)) return {LineKind::Head};
    const char begin = stl::trim(line).front();
    const bool begins = stl::is_letter(begin) || std::string_view("_\"|%").find(begin) != std::string_view::npos ||
                        static_cast<unsigned char>(begin) >= 0x80;
    if (!begins || std::ranges::none_of(line, stl::is_digit)) return {};
    const stl::ParseResult symbol = stl::read_symbol_table(line, {});
    if (symbol.source.symbols.size() != 1 || !symbol.diagnostics.empty()) return {};
    const stl::Symbol& row = symbol.source.symbols.front();
    const bool is_address = row.value && !std::holds_alternative<stl::Integer>(*row.value);
    if (!is_address && line.find('=') == line.npos) return {};  // `In network 1`
    std::string name = stl::upper_case(row.name);
    if (name != "TITLE" && is_title(line)) return {};
    // A mnemonic with operands, so that the address may be one of them: `LD: I0.0`, `LD I0.0 I0.1`, but not `STOP I0.0`.
    return stl::is_mnemonic(is_instruction_, name, 1) ? ReadLine{} : ReadLine{LineKind::Row, std::move(name)};
  }

  /// Takes the table that begins in a line if it is one. Returns its last line.
  std::size_t take_table(std::size_t first) {
    std::size_t last = first;
    std::set<std::string> names;
    for (std::size_t i = first; i < read_.size(); ++i) {
      if (read_[i].kind == LineKind::Row)
        names.insert(read_[i].name);
      else if (read_[i].kind != LineKind::Blank && (read_[i].kind != LineKind::Head || i > first))
        break;
      if (read_[i].kind != LineKind::Blank) last = i;
    }
    const bool headed = read_[first].kind == LineKind::Head;
    if (names.empty() || (!headed && 2 * count_used(names) < names.size())) return last;
    std::fill(in_table_.begin() + static_cast<std::ptrdiff_t>(first),
              in_table_.begin() + static_cast<std::ptrdiff_t>(last) + 1, true);
    std::size_t above = first;
    while (above > 0 && read_[above - 1].kind == LineKind::Blank) --above;
    if (above > 0 && read_[above - 1].kind == LineKind::Other && is_title_of_table(lines_[above - 1]))
      above_table_[above - 1] = true;
    return last;
  }

  /// The number of names that statements have as words.
  std::size_t count_used(const std::set<std::string>& names) {
    if (words_.empty())
      for (std::size_t i = 0; i < lines_.size(); ++i)
        if (read_[i].kind == LineKind::Statement)
          for (std::string& word : words_of_code(lines_[i])) {
            std::erase(word, '"');
            if (word != "NETWORK") words_.insert(std::move(word));
          }
    return static_cast<std::size_t>(
        std::ranges::count_if(names, [this](const std::string& name) { return words_.contains(name); }));
  }

  std::vector<std::string_view> lines_{};
  const IsInstruction& is_instruction_;
  std::vector<ReadLine> read_{};
  std::vector<bool> in_table_{}, above_table_{};  ///< above: its title
  std::set<std::string> words_{};                 // of statements
};

}  // namespace

std::optional<ProgramWithTable> table_in_program(std::string_view text, const IsInstruction& is_instruction) {
  return TableFinder(text, is_instruction).run();
}

}  // namespace s7200
