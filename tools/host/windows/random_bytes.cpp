#include "tools/host/random_bytes.hpp"

#include <stdexcept>

#include "tools/host/windows/native_text.hpp"

// After the types of Windows.
#include <ntsecapi.h>

namespace s7200::tools {

void fill_with_random_bytes(std::span<unsigned char> bytes) {
  if (RtlGenRandom(bytes.data(), static_cast<ULONG>(bytes.size())) == 0) throw std::runtime_error("no random numbers");
}

}  // namespace s7200::tools
