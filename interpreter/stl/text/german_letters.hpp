// The letters of addresses that differ in the German set of Micro/WIN.
#pragma once

#include <array>
#include <string_view>

namespace s7200::stl {

struct GermanLetters {
  std::string_view german, international;
};

inline constexpr std::array kGermanLetters{
    GermanLetters{"E", "I"},   GermanLetters{"A", "Q"}, GermanLetters{"AE", "AI"},
    GermanLetters{"AA", "AQ"}, GermanLetters{"Z", "C"}, GermanLetters{"HZ", "HC"},
};

}  // namespace s7200::stl
