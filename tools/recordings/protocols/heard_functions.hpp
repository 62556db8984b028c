// Functions of Modbus that are read in recordings and that this project does not speak: 22, 23, and 43 with 14. Modbus
// Application Protocol V1.1b3, 6.16, 6.17 and 6.21.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace s7200::tools {

/// A request of such a function in words, by its data without station and CRC. Empty: it is none, or is not whole.
std::string heard_request_text(std::uint8_t function, std::span<const std::uint8_t> data);

/// The answer to it. Empty: it is none, or does not fit.
std::string heard_answer_text(std::uint8_t function, std::span<const std::uint8_t> asked,
                              std::span<const std::uint8_t> answer);

}  // namespace s7200::tools
