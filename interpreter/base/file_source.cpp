#include "interpreter/base/file_source.hpp"

#include "interpreter/base/text/text.hpp"
#include "interpreter/base/text/utf16.hpp"

namespace s7200 {

bool FileSource::exists(const std::string& path) const { return read(path).has_value(); }

Result<std::string> FileSource::read_text(const std::string& path) const {
  auto text = read(path);
  if (!text) return text;
  if (auto converted = stl::from_marked_utf16(*text)) return *std::move(converted);
  text->erase(0, text->size() - stl::without_byte_order_mark(*text).size());
  return text;
}

bool is_standard_input(std::string_view path) {
  return path == "-" || path == "/dev/stdin" || path == "/dev/fd/0" || path == "/proc/self/fd/0";
}

}  // namespace s7200
