// Frames with random faults for a Modbus slave, and a judge of what it makes of them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "serial_sim/system/simulation.hpp"

namespace s7200::faults {

/// The judge knows what reached the slave's receiver, what the slave sent and what its memory became; of the program it
/// knows the quiet time only, by which what was received falls into frames.
///
/// A frame earns silence when one of its characters carried a parity error, which is all that SM3.0 shows a program on the
/// CPU 214, or when its CRC is wrong. Else it earns what a second slave does, set back to the state before the exchange,
/// that gets the same bytes undisturbed. A frame that follows another one in the same exchange may find the slave busy or
/// looking for silence: it earns that, or nothing.
struct Counts {
  std::uint64_t frames = 0;          ///< requests sent, each with one to three faults
  std::uint64_t untouched = 0;       ///< the receiver got the request as it was sent
  std::uint64_t with_errors = 0;     ///< a character with a parity error
  std::uint64_t with_wrong_crc = 0;  ///< no parity error, but a wrong CRC, or nothing received at all
  std::uint64_t with_framing_errors_only =
      0;                                   ///< right CRC, no parity error, a stop bit at space: nothing tells the program
  std::uint64_t zeros_at_its_end = 0;      ///< one or more zeros too many or too few at the end: that leaves the CRC right
  std::uint64_t right_by_chance = 0;       ///< other bytes, and their CRC is right
  std::uint64_t split = 0;                 ///< received as several frames
  std::uint64_t right_behind_another = 0;  ///< of those, with a right CRC in one that is not the first
  std::uint64_t answered = 0;
  std::uint64_t good_frames = 0;  ///< undisturbed ones after a quiet line
  std::array<std::uint64_t, serial::kFaultKinds> happened{};
  std::uint64_t wrong = 0;       ///< answers, silences or changes of memory that were not earned
  std::uint64_t unanswered = 0;  ///< good frames without their answer

  bool operator==(const Counts&) const = default;
  Counts& operator+=(const Counts& other);
};

struct Result {
  Counts counts;
  std::vector<std::string> wrong;  ///< the first few, with all that is needed to understand them
};

/// Frames go out in blocks of kBlock, each from a slave that was just powered up and from a seed of its own: `seed`, then
/// one more each time. So a block with something wrong is shown again by its seed and one block of frames. The program is a
/// slave that has station address 1 and ends a frame with timed interrupt 0 (SMB34).
inline constexpr std::uint64_t kBlock = 250;
Result run_faulted_frames(const std::shared_ptr<const Program>& program, std::uint64_t seed, std::uint64_t frames);

/// One line for each figure.
std::string to_text(const Counts& counts);

/// A checked program for the CPU 214 out of STL or a document. Throws std::runtime_error.
std::shared_ptr<const Program> program_of(const std::string& text, const std::string& name);
std::shared_ptr<const Program> load_program(const std::string& path);

}  // namespace s7200::faults
