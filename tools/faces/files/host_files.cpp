#include "tools/faces/files/host_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "interpreter/base/file_path.hpp"
#include "tools/host/files/files.hpp"

namespace s7200::tools {
namespace {

namespace fs = std::filesystem;

Replace replace_of(Replacing replacing) {
  switch (replacing) {
    case Replacing::Own:
      return Replace::Own;
    case Replacing::Nothing:
      return Replace::Never;
    case Replacing::Anything:
      return Replace::Judged;
  }
  return Replace::Never;
}

}  // namespace

Result<std::string> HostFiles::read(const std::string& path) const { return read_file(path); }

bool HostFiles::begins(const std::string& path, std::string_view beginning) const {
  std::string first(beginning.size(), '\0');
  std::ifstream(file_path(path), std::ios::binary).read(first.data(), static_cast<std::streamsize>(first.size()));
  return first == beginning;
}

Result<FilePlace> HostFiles::place_for(const WantedFile& wanted) const {
  WrittenFiles files = taken_;
  const auto to = files.claim(wanted.command, wanted.path, {wanted.what, wanted.beginning}, replace_of(wanted.replacing));
  if (!to) return to.trouble();
  if (to->stream) return trouble("{} is not a file", wanted.path);
  return FilePlace{to->path, [to = *to](std::string_view text) { return write_result(to, text); }};
}

std::vector<std::string> HostFiles::names(std::string_view beginning) const {
  const std::size_t slash = beginning.rfind('/');
  const std::string folder(beginning.substr(0, slash == std::string_view::npos ? 0 : slash + 1));
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(file_path(folder.empty() ? "." : folder), error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code ignored;
    if (name.find(' ') == std::string::npos && (!name.starts_with('.') || beginning.ends_with('.')))
      names.push_back(folder + name + (entry->is_directory(ignored) ? "/" : ""));
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace s7200::tools
