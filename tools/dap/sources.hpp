// The files of a program, as an editor knows them: by their full names.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/program/program.hpp"
#include "tools/dap/messages.hpp"

namespace s7200::tools::dap {

class Sources {
 public:
  explicit Sources(const Program& program);

  /// {"source": …, "line": …} of a line of the program.
  Json place_of(std::uint32_t line) const;

  /// The line of the program that a line of a file is; nothing for a file that is not part of it.
  std::optional<std::uint32_t> line_in(const std::string& path, std::uint32_t line) const;

  /// How many lines a file of the program has; nothing if it is none.
  std::optional<std::uint32_t> lines_of(const std::string& path) const;

  Json all() const;

 private:
  struct File {
    std::string path;
    std::uint32_t before = 0;  ///< lines of the program in front of its first
  };
  static Json source_of(const File& file);
  std::uint32_t lines_of(std::size_t file) const;

  std::vector<File> files_;
  std::uint32_t lines_ = 0;
};

}  // namespace s7200::tools::dap
