// What a word that is to be an address may become.
#pragma once

#include <string>
#include <vector>

#include "interpreter/program/program.hpp"

namespace s7200::tools {

/// Symbols, and the addresses and pointers that the program uses.
std::vector<std::string> address_words(const Program& program);

/// How addresses of the CPU begin: `VB`, `VW`, `VD`, `T`, `AIW` …
std::vector<std::string> area_words(const CpuModel& model);

}  // namespace s7200::tools
