// Writing the STL that `import` and `convert` make.
#pragma once

#include <string>
#include <vector>

namespace s7200::tools {

/// Writes `text` to the file `output`, which is none of `inputs`; over an existing file only with `force`. Returns the exit
/// code, after a message if it is not kFine.
int write_stl(const std::string& output, const std::vector<std::string>& inputs, bool force, const std::string& text);

}  // namespace s7200::tools
