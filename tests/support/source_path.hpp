// Where the tree under test lies.
#pragma once

#include <string>

namespace s7200::test {

/// `relative` to the top of the tree, as an absolute path.
std::string source_path(const std::string& relative);

}  // namespace s7200::test
