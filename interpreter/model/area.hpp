// The memory areas of the S7-200, and where each is in the flat image that holds them all.
//
// All areas, the accumulators and the program's constants are in one big-endian image, so a direct operand is just an
// offset. The places are the same for every CPU; a CPU model says how much of each area it has.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace s7200 {

enum class Area : std::uint8_t { I, Q, M, SM, S, AI, AQ, T, C, HC, AC, V, L };
inline constexpr std::size_t kAreas = 13;

/// A set of areas, as the operand rules of the instruction table use it.
using Areas = std::uint16_t;
constexpr Areas set_of(Area area) { return static_cast<Areas>(1u << static_cast<unsigned>(area)); }
constexpr bool contains(Areas set, Area area) { return (set & set_of(area)) != 0; }

enum class Width : std::uint8_t { Bit, Byte, Word, Double };
constexpr std::uint32_t bytes_of(Width width) { return width == Width::Double ? 4 : width == Width::Word ? 2 : 1; }

namespace image {

inline constexpr std::uint32_t kTimers = 256, kCounters = 256;

// Largest size of each area over all S7-200 CPUs (facts 1.1, 1.2), in bytes.
inline constexpr std::uint32_t kI = 0;                            // 16: image register
inline constexpr std::uint32_t kQ = kI + 16;                      // 16: image register
inline constexpr std::uint32_t kM = kQ + 16;                      // 32
inline constexpr std::uint32_t kSM = kM + 32;                     // 552
inline constexpr std::uint32_t kS = kSM + 552;                    // 32
inline constexpr std::uint32_t kAI = kS + 32;                     // 64
inline constexpr std::uint32_t kAQ = kAI + 64;                    // 64
inline constexpr std::uint32_t kT = kAQ + 64;                     // current values
inline constexpr std::uint32_t kC = kT + 2 * kTimers;             // current values
inline constexpr std::uint32_t kHC = kC + 2 * kCounters;          // 6 current values of 32 bits
inline constexpr std::uint32_t kAC = kHC + 24;                    // 4 cells of 4 bytes: byte at +3, word at +2
inline constexpr std::uint32_t kTBits = kAC + 16;                 // timer bits
inline constexpr std::uint32_t kCBits = kTBits + kTimers / 8;     // counter bits
inline constexpr std::uint32_t kInputs = kCBits + kCounters / 8;  // 16: the input points themselves
inline constexpr std::uint32_t kOutputs = kInputs + 16;           // 16: the output points themselves
inline constexpr std::uint32_t kEdges = kOutputs + 16;            // 512: one memory bit for each EU and ED
inline constexpr std::uint32_t kV = kEdges + 512;                 // 10240
inline constexpr std::uint32_t kL = kV + 10240;                   // 64: local memory of the routine that runs
inline constexpr std::uint32_t kConstants = kL + 64;              // the program's constants
inline constexpr std::uint32_t kSize = 20 * 1024;

inline constexpr std::uint32_t kPointBytes = 16;  // of input points, of output points, and of their images

}  // namespace image

inline constexpr std::uint32_t kNoBits = 0xFFFF'FFFF;

/// The name of an area, its place, and how it is addressed.
struct AreaInfo {
  Area area;
  std::string_view name;  ///< as in STL
  std::uint32_t base;     ///< of the values, in the image
  std::uint32_t bits;     ///< of the bits: equal to `base`, or elsewhere for T and C; kNoBits: no bit access
  std::uint32_t element;  ///< bytes of a numbered element (T, C, HC, AC); 0: byte-addressed
  std::optional<std::uint8_t> pointer_code;  ///< top byte of a pointer to it, on CPUs where one reaches it
  std::string_view meaning;

  std::uint32_t step() const { return element == 0 ? 1 : element; }  ///< bytes from one number to the next
};

const AreaInfo& info(Area area);
const std::array<AreaInfo, kAreas>& all_areas();
/// The area of a place in the image.
const AreaInfo& area_at(std::uint32_t place);
std::optional<Area> area_named(std::string_view name);  // upper case

}  // namespace s7200
