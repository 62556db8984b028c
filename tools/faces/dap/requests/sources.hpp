// The files of a program, as an editor knows them: by their full names.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/program/program.hpp"
#include "tools/faces/dap/wire/messages.hpp"

namespace s7200::tools::dap {

/// The path in a name that a client has for a file: a path as it is, or that of a `file:` URI (RFC 8089). Other URIs stay as
/// they are, and so does %00, which no name of a file can have.
std::string path_of(const std::string& name);

/// `file:///home/me/my%20plant.stl` of a full path.
std::string uri_of(const std::string& path);

/// The one name that all spellings of a file have, such as `./a//b/../main.stl`, a link to it, or its URI. A relative path
/// begins at `folder`; the folder of the command if that is empty. Empty for an empty name; a stand-in for a library
/// (program/loading/stand_ins.hpp) is no file and keeps its name.
std::string full_name(const std::string& name, const std::string& folder = {});

class Sources {
 public:
  /// `as_uris`: how the client wants to be told their names.
  explicit Sources(const Program& program, bool as_uris = false);

  /// {"source": …, "line": …} of a line of the program.
  Json place_of(std::uint32_t line) const;

  /// The line of the program that a line of a file is, by the file's full name; nothing for a file that is not part of it.
  std::optional<std::uint32_t> line_in(const std::string& path, std::uint32_t line) const;

  /// How many lines a file of the program has, by its full name; nothing if it is none.
  std::optional<std::uint32_t> lines_of(const std::string& path) const;

  Json all() const;

 private:
  struct File {
    std::string path;
    std::uint32_t before = 0;  ///< lines of the program in front of its first
  };
  Json source_of(const File& file) const;
  /// A file may have several names: links, and in Windows capitals do not tell them apart.
  std::optional<std::size_t> file_named(const std::string& path) const;
  std::uint32_t lines_of(std::size_t file) const;

  std::vector<File> files_;
  std::uint32_t lines_ = 0;
  bool as_uris_;
};

}  // namespace s7200::tools::dap
