// What kept scenarios from being run, for the files that continuous integration reads.
#pragma once

#include <string>
#include <vector>

#include "tools/scenario/reporting/messages.hpp"

namespace s7200::tools {

struct Mistake {
  std::string file{};  ///< empty: it is in none
  stl::Position position{};
  std::string text{};
};

/// Every error of the messages; notes and warnings are none.
std::vector<Mistake> mistakes_in(const Messages& messages);

/// `pump.yaml:6:1: '5' is not a duration`
std::string mistake_text(const Mistake& mistake);

}  // namespace s7200::tools
