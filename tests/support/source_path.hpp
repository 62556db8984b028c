// Where the tree under test lies, and what CPU a program in it is for.
#pragma once

#include <string>
#include <string_view>

namespace s7200::test {

/// `relative` to the top of the tree, as an absolute path.
std::string source_path(const std::string& relative);

/// `224` if the first line of a program says "FOR THE CPU 224"; 214 if it names none.
std::string cpu_named_in(std::string_view program);

}  // namespace s7200::test
