// Words for the values of an enumeration, as settings and options take them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace s7200::westinghouse {

template <class Value>
struct Named {
  Value value;
  std::string_view word;
};

/// The words of an enumeration, in its order.
template <std::size_t N>
struct Words : std::array<std::string_view, N> {
  operator std::vector<std::string_view>() const { return {this->begin(), this->end()}; }
};

/// The words alone. A value that does not stand at its own place does not compile.
template <class Value, std::size_t N>
consteval Words<N> words_of(const Named<Value> (&rows)[N]) {
  Words<N> words;
  for (std::size_t place = 0; place < N; ++place) {
    if (static_cast<std::size_t>(rows[place].value) != place) std::abort();
    words[place] = rows[place].word;
  }
  return words;
}

}  // namespace s7200::westinghouse
