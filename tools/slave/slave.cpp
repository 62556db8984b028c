#include "tools/slave/slave.hpp"

namespace s7200::tools {

std::string beginning_in_hex(Bytes bytes) {
  constexpr std::size_t kShown = 16;
  const bool cut = bytes.size() > kShown;
  if (cut) bytes.resize(kShown);
  return serial::to_hex(bytes) + (cut ? " …" : "");
}

std::string ignored_text(const Bytes& bytes) {
  return bytes.empty() ? "" : "ignored what came before the request: " + beginning_in_hex(bytes);
}

}  // namespace s7200::tools
