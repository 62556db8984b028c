#include "tools/host/host_time.hpp"

#include <chrono>

namespace s7200::tools {

Time host_time() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace s7200::tools
