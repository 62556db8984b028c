#include "tools/record_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>

#include "tools/terminal.hpp"

namespace s7200::tools {

bool may_be_overwritten(const std::string& path, std::string_view beginning) {
  const auto kind = std::filesystem::status(path).type();
  if (kind == std::filesystem::file_type::character || kind == std::filesystem::file_type::fifo) return true;
  std::ifstream in(path);
  if (!in) return false;
  std::string first(beginning.size(), '\0');
  in.read(first.data(), static_cast<std::streamsize>(first.size()));
  return in.gcount() == 0 || first == beginning;
}

std::ostream* RecordFile::open(const std::string& path, std::string_view beginning, std::string_view kind) {
  path_ = path;
  if (path == "-") return &std::cout;
  if (std::filesystem::exists(path) && !may_be_overwritten(path, beginning)) {
    print_error(fmt::format("{} exists and is no {}; it is left alone", path, kind));
    return nullptr;
  }
  file_.open(path, std::ios::trunc | std::ios::binary);
  if (file_) return &file_;
  print_error(fmt::format("cannot write {}: {}", path, std::strerror(errno)));
  return nullptr;
}

bool RecordFile::close() {
  if (!file_.is_open()) return true;
  file_.close();
  if (file_) return true;
  print_error(fmt::format("cannot write all of {}: {}", path_, std::strerror(errno)));
  return false;
}

}  // namespace s7200::tools
