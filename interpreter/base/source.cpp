#include "interpreter/base/source.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace s7200::stl {

namespace {

/// The last of `parts` that begins at or before a line; null if none does.
template <typename Part>
const Part* part_at(const std::vector<Part>& parts, std::uint32_t line) {
  const auto next = std::ranges::upper_bound(parts, line, {}, &Part::first_line);
  return next == parts.begin() ? nullptr : &*std::prev(next);
}

}  // namespace

FileLine in_file(const SourceLines& source, std::uint32_t line) {
  const FurtherFile* file = part_at(source.further_files, line);
  if (!file) return {source.name, line};
  return {file->name, line - file->first_line + 1};
}

std::string line_text(const SourceLines& source, std::uint32_t line, std::uint32_t from) {
  const FileLine place = in_file(source, line);
  return &place.file == &in_file(source, from).file ? fmt::format("line {}", place.line)
                                                    : fmt::format("{}:{}", place.file, place.line);
}

std::string section_at(const SourceLines& source, std::uint32_t line) {
  const Section* section = part_at(source.sections, line);
  return section ? section->name : std::string();
}

}  // namespace s7200::stl
