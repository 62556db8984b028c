// The S7-200 SMART, which has instructions of its own beside those of the S7-200.
#pragma once

#include <string_view>

namespace s7200 {

/// What messages say of such a program.
inline constexpr std::string_view kSmartProgram = "a program for the SMART runs here as CPU 226 as far as it goes";

/// Whether only the SMART has an instruction, `GET`; in capitals.
bool is_instruction_of_smart(std::string_view mnemonic);

}  // namespace s7200
