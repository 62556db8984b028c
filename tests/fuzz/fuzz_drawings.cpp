// Any bytes as a document with ladder drawings, and STL beside them.
//
// Promises: each diagnostic has its place in the text; no more networks are the same than are drawn.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "interpreter/program/ladder/ladder.hpp"
#include "interpreter/program/ladder/ladder_compare.hpp"

namespace {

using namespace s7200;

void must(bool promise) {
  if (!promise) std::abort();
}

void look_at_places(const stl::Diagnostics& diagnostics, const stl::SourceLines& source) {
  for (const stl::Diagnostic& d : diagnostics) {
    must(!d.message.empty() && d.position.line <= source.text.size() + 1);
    must(!render(d, source, false).empty());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (const auto text = read_drawings(bytes, "fuzz.txt")) look_at_places(text->parsed.diagnostics, text->parsed.source);
  if (const auto comparison = compare_drawings(bytes, "fuzz.txt")) {
    look_at_places(comparison->diagnostics, comparison->source);
    must(comparison->same <= comparison->networks);
  }
  return 0;
}
