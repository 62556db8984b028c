#include "serial_sim/line/character.hpp"

namespace s7200::serial {

BitTimes::BitTimes(const BitClock& of) : clock(of), bits(of.format.bits()), stop_bit(first_stop_bit(of.format)) {
  for (std::size_t count = 0; count < half_bits.size(); ++count) half_bits[count] = clock.half_bits(static_cast<int>(count));
}

unsigned character_levels(const SerialFormat& format, std::uint8_t data, bool parity_bit) {
  const int stop_bit = first_stop_bit(format);
  unsigned levels = unsigned{data} << 1 | 1U << stop_bit;
  if (format.parity != Parity::None && parity_bit) levels |= 1U << (stop_bit - 1);
  return levels;
}

}  // namespace s7200::serial
