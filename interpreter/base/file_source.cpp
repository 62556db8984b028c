#include "interpreter/base/file_source.hpp"

#include "interpreter/base/text/text.hpp"
#include "interpreter/base/text/utf16.hpp"

namespace s7200 {

bool FileSource::exists(const std::string& path) const {
  std::string why;
  return read(path, why).has_value();
}

std::optional<std::string> FileSource::read_text(const std::string& path, std::string& why) const {
  auto text = read(path, why);
  if (!text) return text;
  if (auto converted = stl::from_marked_utf16(*text)) return converted;
  text->erase(0, text->size() - stl::without_byte_order_mark(*text).size());
  return text;
}

bool is_standard_input(std::string_view path) {
  return path == "-" || path == "/dev/stdin" || path == "/dev/fd/0" || path == "/proc/self/fd/0";
}

}  // namespace s7200
