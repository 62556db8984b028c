#include "tools/faces/dap/requests/sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "interpreter/base/file_path.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/loading/stand_ins.hpp"

namespace s7200::tools::dap {
namespace {

/// `my%20plant.stl`
std::string percent_decoded(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape = text[i] == '%' && i + 2 < text.size();
    const auto high = escape ? hex_digit(text[i + 1]) : std::nullopt, low = escape ? hex_digit(text[i + 2]) : std::nullopt;
    const int code = high && low ? *high << 4 | *low : 0;
    plain += code != 0 ? static_cast<char>(code) : text[i];
    if (code != 0) i += 2;
  }
  return plain;
}

/// Those of RFC 3986 that stand for themselves in a path.
bool is_plain_in_uri(char c) {
  return stl::is_letter(c) || stl::is_digit(c) || std::string_view("-._~/!$&'()*+,;=:@").find(c) != std::string_view::npos;
}

}  // namespace

std::string path_of(const std::string& name) {
  constexpr std::string_view kScheme = "file:", kHere = "//localhost/";
  if (stl::lower_case(name.substr(0, kScheme.size())) != kScheme) return name;
  std::string_view rest = std::string_view(name).substr(kScheme.size());
  if (stl::lower_case(rest.substr(0, kHere.size())) == kHere)
    rest.remove_prefix(kHere.size() - 1);
  else if (rest.starts_with("///"))
    rest.remove_prefix(2);
  return rest.starts_with("/") && !rest.starts_with("//") ? percent_decoded(rest) : name;
}

std::string uri_of(const std::string& path) {
  std::string uri = "file://";
  for (const char c : path)
    uri += is_plain_in_uri(c) ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return uri;
}

std::string full_name(const std::string& name, const std::string& folder) {
  if (name.empty() || is_stand_in(name)) return name;
  std::error_code error;
  const auto path = file_path(path_of(folder)) / file_path(path_of(name));
  const auto full = std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
  return error ? path.string() : full.string();
}

Sources::Sources(const Program& program, bool as_uris)
    : lines_(static_cast<std::uint32_t>(program.source.text.size())), as_uris_(as_uris) {
  files_.push_back({full_name(program.source.name)});
  for (const stl::FurtherFile& file : program.source.further_files)
    files_.push_back({full_name(file.name), file.first_line - 1});
}

Json Sources::source_of(const File& file) const {
  if (const auto number = number_of_stand_in(file.path))
    return {{"name", file.path}, {"path", file.path}, {"sourceReference", *number}, {"origin", "part of s7200"}};
  return {{"name", file_path(file.path).filename().string()}, {"path", as_uris_ ? uri_of(file.path) : file.path}};
}

Json Sources::place_of(std::uint32_t line) const {
  const auto after = std::find_if(files_.begin() + 1, files_.end(), [&](const File& file) { return file.before >= line; });
  const File& file = *(after - 1);
  return {{"source", source_of(file)}, {"line", line - file.before}};
}

std::optional<std::size_t> Sources::file_named(const std::string& path) const {
  const auto is_named = [&](const File& file) {
    std::error_code error;
    return file.path == path || std::filesystem::equivalent(file_path(file.path), file_path(path), error);
  };
  const auto file = std::ranges::find_if(files_, is_named);
  return file == files_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(file - files_.begin()));
}

std::optional<std::uint32_t> Sources::line_in(const std::string& path, std::uint32_t line) const {
  const auto file = file_named(path);
  if (!file || line < 1 || line > lines_of(*file)) return {};
  return files_[*file].before + line;
}

std::optional<std::uint32_t> Sources::lines_of(const std::string& path) const {
  const auto file = file_named(path);
  return file ? std::optional(lines_of(*file)) : std::nullopt;
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
