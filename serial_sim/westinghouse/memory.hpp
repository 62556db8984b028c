// Memory of a PLC, of which most is 0.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>

namespace s7200::westinghouse {

/// Cells by address; a cell that nothing was written to holds 0. Only pages that were written to take room, so that a copy
/// is cheap.
template <class Cell>
class Memory {
 public:
  Cell read(std::uint32_t address) const {
    const auto page = pages_.find(address / kPage);
    return page == pages_.end() ? Cell{} : page->second[address % kPage];
  }

  void write(std::uint32_t address, Cell value) {
    if (value == Cell{} && !pages_.contains(address / kPage)) return;
    pages_[address / kPage][address % kPage] = value;
  }

  void clear() { pages_.clear(); }

  bool operator==(const Memory&) const = default;

 private:
  static constexpr std::uint32_t kPage = 256;
  std::map<std::uint32_t, std::array<Cell, kPage>> pages_;
};

using ByteMemory = Memory<std::uint8_t>;
using WordMemory = Memory<std::uint16_t>;

}  // namespace s7200::westinghouse
