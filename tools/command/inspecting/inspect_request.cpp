#include "tools/command/inspecting/inspect_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "interpreter/base/text/nearest.hpp"

namespace s7200::tools {
namespace {

/// The first word after the first that looks more like a view than like a file, and the view that was meant.
void find_slip(InspectRequest& request) {
  std::vector<std::string_view> names;
  for (const InspectView& view : inspect_views()) names.push_back(view.name);
  const auto slip = std::find_if(std::next(request.paths.begin()), request.paths.end(), [&](const std::string& word) {
    return word.find_first_of("./") == std::string::npos && !nearest(word, names).empty();
  });
  if (slip == request.paths.end()) return;
  request.slip = *slip;
  request.meant = nearest(*slip, names);
}

}  // namespace

std::string views_text() {
  std::string text = "Views:\n";
  for (const InspectView& view : inspect_views()) text += fmt::format("  {:<9} {}\n", view.name, view.meaning);
  return text;
}

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
  if (request.view) return request;
  request.view = &inspect_views().front();
  if (!request.paths.empty()) find_slip(request);
  return request;
}

}  // namespace s7200::tools
