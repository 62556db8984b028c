// What a fuzzer promises: a broken promise ends it with the text that broke it.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

namespace s7200 {

inline void must(bool promise, const char* what, const std::string& text) {
  if (promise) return;
  std::fprintf(stderr, "%s:\n%s\n", what, text.c_str());
  std::abort();
}

}  // namespace s7200
