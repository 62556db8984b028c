#include "tools/scenario/limits.hpp"

#include <algorithm>

namespace s7200::tools {
namespace {

constexpr std::string_view kStep = "\n      - ";

std::size_t count(std::string_view text, std::string_view what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string_view::npos; at = text.find(what, at + what.size())) ++found;
  return found;
}

}  // namespace

Limits limits_of(std::string_view text) {
  const Limits usual;
  const bool is_recorded = text.starts_with(kTranscriptBeginning) || text.starts_with(kImportBeginning);
  if (!is_recorded || text.size() > kLongestTranscript) return usual;
  return {kLongestTranscript, std::max(usual.nodes, text.size() / 4), std::max(usual.steps, count(text, kStep))};
}

}  // namespace s7200::tools
