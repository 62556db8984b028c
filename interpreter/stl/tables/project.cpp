#include "interpreter/stl/tables/project.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "interpreter/stl/text/places.hpp"

namespace s7200::stl {

namespace {

template <typename Item>
void move_to(std::vector<Item>& to, std::vector<Item>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

bool has_main_program(const Source& source) {
  return std::ranges::find(source.blocks, Block::Kind::Main, &Block::kind) != source.blocks.end();
}

}  // namespace

void append(ParseResult& source, ParseResult file) {
  source.notes.insert(source.notes.end(), std::make_move_iterator(file.notes.begin()),
                      std::make_move_iterator(file.notes.end()));
  Source &to = source.source, &from = file.source;
  const auto lines_before = static_cast<std::uint32_t>(to.text.size());
  move_places(file, [lines_before](Position& position) {
    if (position.line != 0) position.line += lines_before;
  });
  to.further_files.push_back({lines_before + 1, std::move(from.name)});
  if (!to.sections.empty()) to.sections.push_back({lines_before + 1, ""});
  to.text.insert(to.text.end(), std::make_move_iterator(from.text.begin()), std::make_move_iterator(from.text.end()));
  move_to(to.further_files, from.further_files);
  move_to(to.sections, from.sections);
  const auto lines_of_to = static_cast<std::ptrdiff_t>(to.lines.size());
  const bool main_is_new = has_main_program(from) && !has_main_program(to);
  move_to(to.lines, from.lines);
  if (main_is_new) std::rotate(to.lines.begin(), to.lines.begin() + lines_of_to, to.lines.end());
  move_to(to.blocks, from.blocks);
  move_to(to.symbols, from.symbols);
  move_to(to.data, from.data);
  move_to(source.diagnostics, file.diagnostics);
  move_to(source.left_out, file.left_out);
}

}  // namespace s7200::stl
