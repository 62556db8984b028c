#include "tests/support/source_path.hpp"

namespace s7200::test {

std::string source_path(const std::string& relative) { return std::string{S7200_SOURCE_DIR} + "/" + relative; }

}  // namespace s7200::test
