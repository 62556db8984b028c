// Writing the STL that `import` and `convert` make.
#pragma once

#include <string>
#include <vector>

namespace s7200::tools {

struct StlFile {
  std::string path, text;
};

/// Writes the files, which are none of `inputs`; over existing ones only with `force`. If one of them cannot be written there,
/// none is. Returns the exit code, after a message if it is not kFine.
int write_stl(const std::vector<StlFile>& outputs, const std::vector<std::string>& inputs, bool force);

/// The same of a single file.
inline int write_stl(const std::string& output, const std::vector<std::string>& inputs, bool force, const std::string& text) {
  return write_stl({{output, text}}, inputs, force);
}

}  // namespace s7200::tools
