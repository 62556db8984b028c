#include "interpreter/program/checking/routine_ends.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "interpreter/stl/block_words.hpp"
#include "interpreter/stl/document.hpp"

namespace s7200 {
namespace {

bool is_end(const stl::Line& line) {
  const auto* statement = std::get_if<stl::Statement>(&line);
  return statement &&
         std::ranges::find(stl::kBlockWords, statement->mnemonic, &stl::BlockWords::end) != stl::kBlockWords.end();
}

/// The words of the routine that a statement is the head of; null if it is none.
const stl::BlockWords* begun_by(const stl::Statement& statement) {
  const auto found = std::ranges::find(stl::kBlockWords, statement.mnemonic, &stl::BlockWords::head);
  return found == stl::kBlockWords.end() ? nullptr : &*found;
}

}  // namespace

void add_missing_ends(stl::Source& source) {
  std::vector<stl::Line> lines;
  lines.reserve(source.lines.size());
  const stl::BlockWords* routine = &stl::words(stl::Block::Kind::Main);
  std::size_t last = 0;  // the place in `lines` after the routine's last statement; 0: it has none
  const auto end_routine = [&] {
    if (last == 0 || is_end(lines[last - 1])) return;
    const stl::Position& position = std::get<stl::Statement>(lines[last - 1]).position;
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(last),
                 stl::Statement{std::string(routine->end), position, {}, {}});
  };
  for (stl::Line& line : source.lines) {
    const auto* statement = std::get_if<stl::Statement>(&line);
    if (const stl::BlockWords* begun = statement ? begun_by(*statement) : nullptr) {
      end_routine();
      routine = begun;
    }
    lines.push_back(std::move(line));
    if (std::holds_alternative<stl::Statement>(lines.back())) last = lines.size();
  }
  end_routine();
  source.lines = std::move(lines);
}

void forget_missing_ends(stl::ParseResult& parsed) {
  if (std::ranges::none_of(parsed.source.lines, is_end))
    std::erase_if(parsed.diagnostics,
                  [](const stl::Diagnostic& diagnostic) { return diagnostic.cause.starts_with(stl::kMissingEnd); });
}

void add_missing_ends(stl::ParseResult& parsed) {
  forget_missing_ends(parsed);
  add_missing_ends(parsed.source);
}

}  // namespace s7200
