// What a fuzzer of PPI says, out of the bytes of its input.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <span>

#include "tests/support/ppi_master.hpp"

namespace s7200::test::ppi {

inline void must(bool promise) {
  if (!promise) std::abort();
}

class Script {
 public:
  explicit Script(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool over() const { return bytes_.empty(); }
  std::uint8_t byte() {
    const std::uint8_t first = bytes_.empty() ? std::uint8_t{0} : bytes_[0];
    bytes_ = bytes_.subspan(bytes_.empty() ? 0 : 1);
    return first;
  }

  /// So many bytes, as they stand or as the PDU of a right frame, or a good frame with one bit changed.
  Bytes frame(const Bytes& good, std::uint8_t to, std::uint8_t from, std::uint8_t function) {
    const std::uint8_t kind = byte();
    if (kind % 4 == 3) return good;
    if (kind % 4 == 2) {
      Bytes changed = good;
      const std::uint8_t bit = byte();
      changed[byte() % changed.size()] ^= static_cast<std::uint8_t>(1U << bit % 8);
      return changed;
    }
    Bytes bytes;
    for (int count = byte() % 64; count > 0 && !over(); --count) bytes.push_back(byte());
    return kind % 4 == 0 ? bytes : sd2(to, from, function, bytes);
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace s7200::test::ppi
