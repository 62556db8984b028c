#include "tools/host/random_bytes.hpp"

#include <sys/random.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

namespace s7200::tools {

void fill_with_random_bytes(std::span<unsigned char> bytes) {
  for (std::size_t got = 0; got < bytes.size();) {
    const ssize_t count = getrandom(bytes.data() + got, bytes.size() - got, 0);
    if (count < 0 && errno != EINTR) throw std::runtime_error(std::string("no random numbers: ") + std::strerror(errno));
    if (count > 0) got += static_cast<std::size_t>(count);
  }
}

}  // namespace s7200::tools
