// What the words after `s7200 why` ask for.
#pragma once

#include <string>
#include <vector>

namespace s7200::tools {

struct WhyRequest {
  std::vector<std::string> paths{};  ///< of the program and its parts: the first word, and files that follow it
  std::string about{};               ///< an address or a condition; empty if there is none
  bool not_so = false;               ///< what keeps it from being so: `not` in front of it or after it
  bool all = false;                  ///< `all` at the end: however long the answer is
};

WhyRequest why_request(std::vector<std::string> words);

}  // namespace s7200::tools
