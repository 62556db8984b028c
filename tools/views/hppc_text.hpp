// What answers of an HPPC say, in words.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace s7200::tools {

/// Of the operands of an answer to 0D, an address of three bytes at least, and what stands there:
/// `parameter table at 16#80000, holding register 1 at 16#ABFFE: 8a 00`
std::string hppc_parameters_text(std::span<const std::uint8_t> operands);

/// The first byte of an answer to a monitor: `status 16#10: processor not running`
std::string hppc_status_text(std::uint8_t status);

}  // namespace s7200::tools
