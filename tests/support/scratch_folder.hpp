// A folder for the files of one test process: tests run beside each other, and the temporary folder of gtest is the same for
// all.
#pragma once

#include <string>

namespace s7200::test {

/// With a slash at its end; removed when the process ends.
const std::string& scratch_folder();

}  // namespace s7200::test
