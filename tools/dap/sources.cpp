#include "tools/dap/sources.hpp"

#include <algorithm>
#include <filesystem>

namespace s7200::tools::dap {
namespace {

std::string full_name(const std::string& path) {
  std::error_code error;
  const auto full = std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
  return error ? path : full.string();
}

}  // namespace

Sources::Sources(const Program& program) : lines_(static_cast<std::uint32_t>(program.source.text.size())) {
  files_.push_back({full_name(program.source.name)});
  for (const stl::FurtherFile& file : program.source.further_files)
    files_.push_back({full_name(file.name), file.first_line - 1});
}

Json Sources::source_of(const File& file) {
  return {{"name", std::filesystem::path(file.path).filename().string()}, {"path", file.path}};
}

Json Sources::place_of(std::uint32_t line) const {
  const auto after = std::find_if(files_.begin() + 1, files_.end(), [&](const File& file) { return file.before >= line; });
  const File& file = *(after - 1);
  return {{"source", source_of(file)}, {"line", line - file.before}};
}

std::optional<std::uint32_t> Sources::line_in(const std::string& path, std::uint32_t line) const {
  const std::string full = full_name(path);
  for (std::size_t i = 0; i < files_.size(); ++i)
    if (files_[i].path == full && line >= 1 && line <= lines_of(i)) return files_[i].before + line;
  return {};
}

std::optional<std::uint32_t> Sources::lines_of(const std::string& path) const {
  const auto file = std::ranges::find(files_, full_name(path), &File::path);
  return file == files_.end() ? std::nullopt : std::optional(lines_of(static_cast<std::size_t>(file - files_.begin())));
}

std::uint32_t Sources::lines_of(std::size_t file) const {
  return (file + 1 < files_.size() ? files_[file + 1].before : lines_) - files_[file].before;
}

Json Sources::all() const {
  Json all = Json::array();
  for (const File& file : files_) all.push_back(source_of(file));
  return all;
}

}  // namespace s7200::tools::dap
