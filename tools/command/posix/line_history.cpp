#include "tools/command/posix/line_history.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace s7200::tools {
namespace {

namespace fs = std::filesystem;

fs::path state_folder() {
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state && *state == '/') return state;
  const char* home = std::getenv("HOME");
  return home && *home == '/' ? fs::path(home) / ".local/state" : fs::path();
}

/// Readable for the user alone, with all of `text` or nothing.
void append(const std::string& path, const std::string& text, int flags) {
  const int fd = open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | flags, 0600);
  if (fd < 0) return;
  [[maybe_unused]] const ssize_t written = write(fd, text.data(), text.size());
  close(fd);
}

}  // namespace

LineHistory::LineHistory(std::string_view name) {
  const fs::path state = state_folder();
  if (state.empty()) return;
  std::error_code ignored;
  fs::create_directories(state / "s7200", ignored);
  path_ = (state / "s7200" / name).string();
}

std::vector<std::string> LineHistory::lines() const {
  std::vector<std::string> all;
  std::ifstream file(path_);
  for (std::string line; std::getline(file, line);)
    if (!line.empty()) all.push_back(line);
  if (all.size() <= kMost) return all;
  all.erase(all.begin(), all.end() - static_cast<std::ptrdiff_t>(kMost));
  std::string kept;
  for (const std::string& line : all) kept += line + '\n';
  append(path_, kept, O_TRUNC);
  return all;
}

void LineHistory::add(std::string_view line) const {
  if (!path_.empty()) append(path_, std::string(line) + '\n', 0);
}

}  // namespace s7200::tools
