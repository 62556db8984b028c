#include "interpreter/stl/text/plain_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/text/foreign_comments.hpp"
#include "interpreter/stl/text/places.hpp"
#include "interpreter/stl/text/wrappings.hpp"

namespace s7200::stl {
namespace plain {
namespace {

bool is_identity(const std::vector<std::uint32_t>& columns) {
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i] != i + 1) return false;
  return true;
}

bool has_such_a_line(std::string_view text) {
  while (!text.empty())
    if (const std::string_view line = take_line(text);
        may_be_different(line) || may_need_page(line) || may_have_foreign_comment(line) || may_open_wrapping(line))
      return true;
  return false;
}

/// Reads the lines one by one.
std::vector<Row> read_lines(const std::vector<std::string>& lines, const std::vector<Part>& parts, bool html) {
  std::vector<Row> rows;
  for (std::uint32_t i = 0; i < lines.size(); ++i) {
    const std::string_view line = lines[i];
    const bool all = parts[i].from == 0 && parts[i].to == line.size();
    const bool has_entity = html && line.find('&') != std::string_view::npos;  // in a comment
    if (all && !has_entity && !may_be_different(line) && !may_have_margin(line)) {
      rows.push_back({i + 1, lines[i]});
      continue;
    }
    for (auto& [text, columns, changes] : written_lines(line, parts[i], html))
      rows.push_back(
          {i + 1, std::move(text), is_identity(columns) ? std::vector<std::uint32_t>{} : std::move(columns), changes});
  }
  return rows;
}

}  // namespace
}  // namespace plain

PlainText::PlainText(std::string_view original, const IsInstruction& is_instruction) : original_(original) {
  using namespace plain;
  if (!has_such_a_line(original)) return;
  original_lines_ = split_lines(original);
  std::vector<std::string> lines = original_lines_;
  const std::vector<bool> with_comments = rewrite_foreign_comments(lines);
  const bool html = std::ranges::any_of(lines, has_html);
  std::vector<Part> parts;
  if (auto wrapped = wrapped_program(lines, html, is_instruction)) {
    parts = std::move(wrapped->parts);
    around_ = wrapped->change;
  } else {
    for (const std::string& line : lines) parts.push_back({0, line.size()});
  }
  for (std::uint32_t i = 0; i < lines.size(); ++i)
    if (parts[i].empty() && !trim(lines[i]).empty()) left_out_.push_back(i + 1);
  std::vector<Row> rows = read_lines(lines, parts, html);
  for (Row& row : rows)
    if (!with_comments.empty() && with_comments[row.original - 1]) row.changes |= kComments;
  Page page = read_page(std::move(rows), lines, is_instruction);
  around_ |= page.around;
  left_out_.insert(left_out_.end(), page.left_out.begin(), page.left_out.end());
  std::ranges::sort(left_out_);
  const bool same = around_ == 0 && page.rows.size() == lines.size() &&
                    std::ranges::all_of(page.rows, [](const Row& row) { return row.changes == 0; });
  if (same) return;
  const bool has_symbols = std::ranges::any_of(page.rows, [](const Row& row) { return !row.symbol.empty(); });
  for (Row& row : page.rows) {
    text_.append(row.text).push_back('\n');
    if (has_symbols) symbols_.append(row.symbol).push_back('\n');
    lines_.push_back({row.original, std::move(row.columns), row.changes});
  }
}

Position PlainText::in_original(const Position& place) const {
  if (place.line == 0 || place.line > lines_.size()) return place;
  const Line& line = lines_[place.line - 1];
  if (place.column == 0 || line.columns.empty()) return {line.original, place.column, place.length};
  const auto column = [&line](std::size_t character) { return line.columns[std::min(character, line.columns.size()) - 1]; };
  const std::uint32_t first = column(place.column);
  const std::uint32_t last = column(std::size_t{place.column} + std::max(1U, place.length) - 1);
  return {line.original, first, last - first + 1};
}

std::string PlainText::note(const ParseResult& read) const {
  std::uint32_t changes = around_, first = 0;
  const auto see = [&](const stl::Position& place) {
    if (place.line == 0 || place.line > lines_.size()) return;
    const Line& line = lines_[place.line - 1];
    changes |= line.changes;
    if (line.changes != 0 && (first == 0 || line.original < first)) first = line.original;
  };
  for (const stl::Line& line : read.source.lines) {
    if (const auto* statement = std::get_if<Statement>(&line)) see(statement->position);
    if (const auto* head = std::get_if<NetworkHead>(&line)) see(head->position);
  }
  for (const Symbol& symbol : read.source.symbols) see(symbol.position);
  for (const DataLine& data : read.source.data) see(data.position);
  const auto names = plain::names_of(changes);
  if (names.empty()) return {};
  std::string text = fmt::format("{}: read as plain text: {}", read.source.name, fmt::join(names, ", "));
  if (first != 0) text += fmt::format("; the first in line {}", first);
  constexpr std::size_t kShown = 20;
  const auto shown = std::span(left_out_).first(std::min(kShown, left_out_.size()));
  if (!shown.empty())
    text += fmt::format("; left out around the program: {} {}{}", left_out_.size() == 1 ? "line" : "lines",
                        fmt::join(shown, ", "), left_out_.size() > kShown ? ", …" : "");
  return text;
}

void PlainText::restore(ParseResult& read) const {
  if (lines_.empty()) return;
  if (std::string text = note(read); !text.empty()) read.notes.push_back(std::move(text));
  move_places(read, [this](Position& position) { position = in_original(position); });
  read.source.text = original_lines_;
}

std::string plain_characters(std::string_view written) {
  return plain::written_lines(written, {0, written.size()}, false).front().text;
}

}  // namespace s7200::stl
