#include "tools/command/inspect_request.hpp"

namespace s7200::tools {

InspectRequest inspect_request(const std::vector<std::string>& words) {
  InspectRequest request;
  for (const std::string& word : words) {
    if (request.view)
      request.about.push_back(word);
    else if (const InspectView* view = request.paths.empty() ? nullptr : find_inspect_view(word))
      request.view = view;
    else
      request.paths.push_back(word);
  }
  return request;
}

}  // namespace s7200::tools
