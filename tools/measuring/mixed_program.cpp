#include "tools/measuring/mixed_program.hpp"

#include <fmt/format.h>

#include <random>
#include <string_view>

namespace s7200::tools {
namespace {

class Writer {
 public:
  explicit Writer(std::uint32_t instructions) {
    while (count_ + kLongestNetwork < instructions) network();
    for (add("LD SM0.0"); count_ + 1 < instructions;) add(fmt::format("= M{}.{}", below(32), below(8)));
    add("MEND");
  }

  std::string take() { return std::move(text_); }

 private:
  static constexpr std::uint32_t kLongestNetwork = 8;

  std::uint32_t below(std::uint32_t limit) { return static_cast<std::uint32_t>(draw_() % limit); }
  std::string bit_of(std::string_view area, std::uint32_t bytes) {
    return fmt::format("{}{}.{}", area, below(bytes), below(8));
  }
  std::string bit() {
    switch (below(4)) {
      case 0:
        return bit_of("V", 400);
      case 1:
        return bit_of("I", 8);
      default:
        return bit_of("M", 32);
    }
  }
  std::string word() { return fmt::format("VW{}", 500 + 2 * below(400)); }
  void add(std::string_view line) {
    text_.append(line).append("\n");
    ++count_;
  }

  void network() {
    static constexpr std::string_view kContacts[] = {"A", "AN", "O", "A", "ON", "AN"};
    add(fmt::format("{} {}", below(4) ? "LD" : "LDN", bit()));
    for (std::uint32_t more = below(4); more > 0; --more) add(fmt::format("{} {}", kContacts[below(6)], bit()));
    if (below(4) == 0) add(fmt::format("AW>= {}, {}", word(), below(100)));
    if (below(8) == 0) {
      add(fmt::format("LD {}", bit()));
      add("OLD");
    }
    add(coil_or_box());
  }

  std::string coil_or_box() {
    const std::uint32_t kind = below(16);
    if (kind < 8) return fmt::format("= {}", bit_of("M", 32));
    if (kind < 11) return fmt::format("MOVW {}, {}", word(), word());
    if (kind < 12) return fmt::format("INCW {}", word());
    if (kind < 13) return fmt::format("XORW {}, {}", word(), word());
    if (kind < 14) return fmt::format("S {}, 1", bit_of("V", 400));
    if (kind < 15) return fmt::format("R {}, 1", bit_of("V", 400));
    return fmt::format("+I {}, {}", word(), word());
  }

  std::mt19937 draw_{7200};
  std::string text_;
  std::uint32_t count_ = 0;
};

}  // namespace

std::string mixed_program(std::uint32_t instructions) { return Writer(instructions).take(); }

}  // namespace s7200::tools
