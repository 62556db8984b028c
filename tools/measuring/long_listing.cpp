#include "tools/measuring/long_listing.hpp"

#include <fmt/format.h>

#include <iterator>

namespace s7200::tools {

std::string long_listing(std::uint32_t lines) {
  constexpr std::uint32_t kNetwork = 6, kEnd = 1;
  std::string text;
  const auto add = std::back_inserter(text);
  std::uint32_t written = 0;
  for (std::uint32_t network = 1; written + kNetwork + kEnd <= lines; ++network, written += kNetwork) {
    const std::uint32_t bit = network % 8, byte = network / 8 % 8;
    fmt::format_to(add, "NETWORK {} // Pump {}: runs while its tank is not full\n", network, network % 40);
    fmt::format_to(add, "// the float switch has a time of its own\nLD I{}.{}     // float switch\nAN M{}.{}\n", byte, bit,
                   byte, bit);
    fmt::format_to(add, "MOVW VW{}, VW{}\n= V{}.{}\n", 2 * (network % 400), 1000 + 2 * (network % 400),
                   2000 + network / 8 % 400, bit);
  }
  for (; written + kEnd < lines; ++written) text += "\n";
  return text + "MEND\n";
}

}  // namespace s7200::tools
