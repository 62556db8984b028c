// What a program listens to: where something from outside can reach it, and the values that mean something to it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "interpreter/analysis/effects/facts.hpp"

namespace s7200::tools {

struct Vocabulary {
  struct Bytes {
    std::uint32_t place = 0;  ///< in the image; of input points the number of the byte
    std::uint8_t count = 1;
    std::uint8_t mask = 0xFF;  ///< of input points: those that it looks at
    bool operator==(const Bytes&) const = default;
  };
  /// A comparison of whole numbers.
  struct Comparison {
    struct Side {
      std::optional<std::uint32_t> place{};  ///< in the image; nothing: a constant
      std::uint32_t value = 0;               ///< of a constant
      bool operator==(const Side&) const = default;
    };
    Side left, right;
    std::uint8_t count = 1;  ///< bytes of a side
    bool operator==(const Comparison&) const = default;

    /// How much larger the left side is, modulo its bits.
    std::uint32_t difference(std::span<const std::uint8_t> image) const;
  };
  std::vector<Bytes> inputs;                          ///< bytes of input points
  std::vector<Bytes> analog;                          ///< words of analog inputs
  std::vector<Bytes> commands;                        ///< V and M that it reads, and that only its data block or nobody sets
  std::vector<Comparison> comparisons{};              ///< at addresses that are known, each once
  std::vector<std::uint32_t> constants;               ///< that its instructions have, each once
  std::vector<Time> presets;                          ///< of its timers, in ns
  std::vector<std::uint32_t> counts{};                ///< presets of its counters
  std::optional<std::uint8_t> port{};                 ///< the first at which it receives; nothing: at none
  bool both_ports = false;                            ///< it receives at the other one too
  std::vector<std::vector<std::uint8_t>> requests{};  ///< frames that it has answered

  /// Adds what another program listens to.
  void add(const Vocabulary& other);
  /// Whether anything from outside reaches it but time.
  bool empty() const { return inputs.empty() && analog.empty() && commands.empty() && !port; }
};

Vocabulary vocabulary_of(const Facts& facts);

/// Requests of Modbus RTU that the program answers when it is ready, a few of each function; of a program in PPI mode none.
std::vector<std::vector<std::uint8_t>> answered_requests(std::shared_ptr<const Program> program, const Vocabulary& words);

}  // namespace s7200::tools
