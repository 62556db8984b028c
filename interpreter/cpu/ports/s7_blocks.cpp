#include "interpreter/cpu/ports/s7_blocks.hpp"

#include <algorithm>
#include <array>

namespace s7200::s7_blocks {
namespace {

using s7::append16;

struct Block {
  std::uint8_t type;
  std::uint16_t number;
  std::uint8_t language;
};
constexpr Block kDb1{'A', 1, 5};
constexpr std::array kBlocks{Block{'8', 1, 1}, kDb1, Block{'B', 0, 7}};

// Places in the head and the foot of a block, which have as many bytes each.
constexpr std::size_t kAroundBlock = 36, kNumber = 6, kLoadLength = 8, kLength = 34;
constexpr std::uint8_t kSubtypeOfDb = 0x0A;

Bytes head(const CpuModel& model) {
  Bytes bytes{'p', 'p', 1, 0, kDb1.language, kSubtypeOfDb};
  bytes.resize(kAroundBlock);
  store16(&bytes[kNumber], kDb1.number);
  store32(&bytes[kLoadLength], static_cast<std::uint32_t>(upload_length(model)));
  store16(&bytes[kLength], static_cast<std::uint16_t>(model.size_of(Area::V)));
  return bytes;
}

}  // namespace

s7::Refusal refusal_of(const s7::BlockName& name) {
  if (s7::name_of_blocks(name.type).empty()) return s7::Refusal::BlockType;
  const auto is_it = [&](const Block& block) { return block.type == name.type && block.number == name.number; };
  if (std::ranges::none_of(kBlocks, is_it)) return s7::Refusal::NoBlock;
  return is_it(kDb1) ? s7::Refusal::None : s7::Refusal::Protected;
}

Bytes counts() {
  Bytes bytes;
  for (const s7::BlockType& type : s7::kBlockTypes) {
    bytes.insert(bytes.end(), {'0', type.letter});
    append16(bytes, static_cast<std::size_t>(std::ranges::count(kBlocks, type.letter, &Block::type)));
  }
  return bytes;
}

std::optional<Bytes> of_type(std::uint8_t type) {
  if (s7::name_of_blocks(type).empty()) return {};
  Bytes bytes;
  for (const Block& block : kBlocks)
    if (block.type == type) {
      append16(bytes, block.number);
      bytes.insert(bytes.end(), {0, block.language});
    }
  return bytes;
}

Bytes information(const CpuModel& model) {
  Bytes bytes{1, kDb1.type, 0, 0x4A, 0, 0x22};
  const Bytes around = head(model);
  bytes.insert(bytes.end(), around.begin(), around.end());
  bytes.resize(bytes.size() + kAroundBlock);
  return bytes;
}

std::size_t upload_length(const CpuModel& model) { return kAroundBlock + model.size_of(Area::V) + kAroundBlock; }

Bytes upload(const Core& core, std::size_t first, std::size_t most) {
  Bytes block = head(core.model());
  const auto v = core.s.image.begin() + image::kV;
  block.insert(block.end(), v, v + core.model().size_of(Area::V));
  block.resize(upload_length(core.model()));
  const auto from = block.begin() + static_cast<std::ptrdiff_t>(std::min(first, block.size()));
  return {from, from + std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(most), block.end() - from)};
}

}  // namespace s7200::s7_blocks
