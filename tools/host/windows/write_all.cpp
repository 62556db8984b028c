#include "tools/host/files/write_all.hpp"

#include <io.h>

#include <algorithm>
#include <cerrno>

namespace s7200::tools {

int write_all(int fd, std::string_view bytes) {
  constexpr std::size_t kAtOnce = 1 << 20;
  while (!bytes.empty()) {
    const int count = _write(fd, bytes.data(), static_cast<unsigned>(std::min(bytes.size(), kAtOnce)));
    if (count < 0) return errno;
    if (count == 0) return ENOSPC;  // so the runtime tells that nothing more could be written
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return 0;
}

}  // namespace s7200::tools
