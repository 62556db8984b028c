#include "tools/session/causes/effects/point_samples.hpp"

#include <algorithm>
#include <cstring>

namespace s7200::tools {

PointSamples::PointSamples(RunRecord& run)
    : run_(run), last_(run.places.size()), between_(run.image), last_change_(run.image.size() * 8) {}

std::vector<std::size_t> PointSamples::last_changes(const Bits& place) const {
  const auto first = last_change_.begin() + static_cast<std::ptrdiff_t>(place.first);
  return {first, first + static_cast<std::ptrdiff_t>(place.count)};
}

void PointSamples::set_last_changes(const Bits& place, const std::vector<std::size_t>& changes) {
  std::ranges::copy(changes, last_change_.begin() + static_cast<std::ptrdiff_t>(place.first));
}

/// Those in which it is, of a bit with that one alone.
std::vector<std::uint8_t> PointSamples::bytes_of(const Bits& place, const std::vector<std::uint8_t>& image) {
  const std::uint64_t first = place.first / 8, end = (place.end() + 7) / 8;
  std::vector<std::uint8_t> bytes{image.begin() + static_cast<std::ptrdiff_t>(first),
                                  image.begin() + static_cast<std::ptrdiff_t>(end)};
  if (place.count == 1) bytes[0] = static_cast<std::uint8_t>(bytes[0] & 1U << (place.first % 8));
  return bytes;
}

bool PointSamples::is_new(Point point, const Bits& place, const std::vector<std::uint8_t>& image) const {
  const std::vector<Bits>& known = run_.places[point];
  const auto found = std::ranges::find(known, place);
  const std::vector<std::uint8_t> now = bytes_of(place, image);
  if (found == known.end()) return now != bytes_of(place, run_.image);
  return now != last_[point][static_cast<std::size_t>(found - known.begin())];
}

void PointSamples::look(Point point, const std::vector<Bits>& places, const std::vector<std::uint8_t>& image, Time now) {
  std::vector<Bits>& known = run_.places[point];
  for (const Bits& place : places) {
    const auto found = static_cast<std::size_t>(std::ranges::find(known, place) - known.begin());
    if (found == known.size()) {
      known.push_back(place);
      last_[point].push_back(bytes_of(place, run_.image));
    }
    std::vector<std::uint8_t>& last = last_[point][found];
    if (place.count != 1) {
      compare(point, place.first / 8, image.data() + place.first / 8, last.data(), last.size(), now);
      continue;
    }
    const auto value = static_cast<std::uint8_t>(image[place.first / 8] & 1U << (place.first % 8));
    compare(point, place.first / 8, &value, last.data(), 1, now);
  }
}

void PointSamples::look_between_scans(const std::vector<std::uint8_t>& image, Time now) {
  compare(kBetweenScans, 0, image.data(), between_.data(), between_.size(), now);
}

void PointSamples::compare(Point point, std::uint64_t first_byte, const std::uint8_t* now, std::uint8_t* last,
                           std::size_t bytes, Time seen) {
  if (std::memcmp(now, last, bytes) == 0) return;
  for (std::size_t byte = 0; byte < bytes; ++byte) {
    const auto differ = static_cast<std::uint8_t>(now[byte] ^ last[byte]);
    last[byte] = now[byte];
    for (std::uint64_t number = 0; differ != 0 && number < 8; ++number) {
      const std::uint64_t bit = (first_byte + byte) * 8 + number;
      if ((differ >> number & 1) == 0 || last_change_[bit] == 0) continue;
      const std::size_t happening = last_change_[bit] - 1;
      run_.series[memory_key(bit, point)].push_back(
          {run_.happenings[happening].at, happening, (now[byte] >> number & 1) != 0, seen});
    }
  }
}

}  // namespace s7200::tools
