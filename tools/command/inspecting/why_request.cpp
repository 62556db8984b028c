#include "tools/command/inspecting/why_request.hpp"

#include <utility>

#include "interpreter/base/text/text.hpp"
#include "tools/host/files/file_system.hpp"
#include "tools/session/words/words.hpp"

namespace s7200::tools {
namespace {

bool is_not(const std::string& word) { return stl::lower_case(word) == "not"; }
bool is_all(const std::string& word) { return stl::lower_case(word) == "all"; }

}  // namespace

WhyRequest why_request(std::vector<std::string> words) {
  WhyRequest request{.paths = {words.front()}};
  words.erase(words.begin());
  std::vector<std::string> about;
  for (std::string& word : words)
    (about.empty() && file_system::is_file(word) ? request.paths : about).push_back(std::move(word));
  request.all = about.size() > 1 && is_all(about.back());
  if (request.all) about.pop_back();
  request.not_so = about.size() > 1 && (is_not(about.front()) || is_not(about.back()));
  if (request.not_so) about.erase(is_not(about.back()) ? about.end() - 1 : about.begin());
  request.about = joined(about);
  return request;
}

}  // namespace s7200::tools
