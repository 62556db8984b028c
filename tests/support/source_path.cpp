#include "tests/support/source_path.hpp"

namespace s7200::test {

std::string source_path(const std::string& relative) { return std::string{S7200_SOURCE_DIR} + "/" + relative; }

std::string cpu_named_in(std::string_view program) {
  constexpr std::string_view kWords = "FOR THE CPU ";
  const std::string_view line = program.substr(0, program.find('\n'));
  const std::size_t at = line.find(kWords);
  if (at == std::string_view::npos) return "214";
  const std::string_view name = line.substr(at + kWords.size());
  return std::string(name.substr(0, name.find_first_not_of("0123456789XPMr")));
}

}  // namespace s7200::test
