#include "tests/support/scratch_folder.hpp"

#include <stdlib.h>

#include <filesystem>
#include <stdexcept>

namespace s7200::test {
namespace {

struct Folder {
  Folder() {
    if (mkdtemp(path.data()) == nullptr) throw std::runtime_error("no folder for the test's files at " + path);
    path += '/';
  }
  ~Folder() {
    std::error_code left;
    std::filesystem::remove_all(path, left);
  }

  std::string path = (std::filesystem::temp_directory_path() / "s7200-test-XXXXXX").string();
};

}  // namespace

const std::string& scratch_folder() {
  static const Folder folder;
  return folder.path;
}

}  // namespace s7200::test
