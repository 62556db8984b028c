#include "tools/host/files/own_folder.hpp"

#include <filesystem>
#include <system_error>

#include "interpreter/base/file_path.hpp"
#include "tools/host/process.hpp"

namespace s7200::tools {

std::string own_folder() {
  std::error_code gone;
  return std::filesystem::canonical(file_path(own_executable()), gone).parent_path().string();
}

}  // namespace s7200::tools
