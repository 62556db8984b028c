// What the words after `s7200 inspect` ask for.
#pragma once

#include <string>
#include <vector>

#include "tools/views/inspection/inspect_views.hpp"

namespace s7200::tools {

/// The words of the command line: files, then a view, then what it is to be about.
struct InspectRequest {
  std::vector<std::string> paths, about;
  const InspectView* view = nullptr;  ///< the first of them all if none is named
  std::string slip, meant;            ///< a word that is probably a view with a slip, and that view; empty: there is none
};

/// The views with what each shows, for the help.
std::string views_text();

InspectRequest inspect_request(const std::vector<std::string>& words);

}  // namespace s7200::tools
