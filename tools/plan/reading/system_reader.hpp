// A system file: YAML that names PLCs, lines and who is on them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/diagnostic.hpp"
#include "interpreter/base/file_source.hpp"
#include "interpreter/base/source.hpp"
#include "tools/plan/system_plan.hpp"
#include "tools/yaml/values.hpp"

namespace s7200::tools {

/// Whether a path is that of a system file, and not of a program: a YAML file.
bool is_system_file(std::string_view path);

/// The system that was read, and its errors and warnings. A plan with errors must not be used; it can be run with warnings.
struct SystemFile {
  struct Text {
    std::shared_ptr<const stl::SourceLines> source;
    stl::Diagnostics diagnostics;
  };
  SystemPlan plan;
  Text file;
  std::vector<Text> programs;  ///< texts of programs with errors

  bool ok() const { return !stl::has_errors(file.diagnostics); }
};

/// Reads the text of the file `path`; the files that it names are read from `files`.
SystemFile read_system(const std::string& text, const std::string& path, const FileSource& files);

/// The same of the tree of such a file.
SystemFile read_system(const YamlNode& root, const std::string& path, const FileSource& files);

/// What a system file is called in complaints about its YAML.
inline constexpr YamlDocument kSystemDocument{"a system file", "'plcs:' and 'lines:'"};

}  // namespace s7200::tools
