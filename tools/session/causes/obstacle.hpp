// What holds a bit off, or on: a tree of contacts with what each of them has, what it would have to be, and who could change
// it.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/analysis/effects/bits.hpp"
#include "interpreter/base/time.hpp"

namespace s7200::tools {

/// A node of the answer. With a name it is about memory that has a value and is to have another one; otherwise its text says
/// all.
struct Obstacle {
  std::string_view kind{};  ///< for machines: `rung`, `ways`, `input`, `timer` … (tools/JSON.md)
  std::string name{}, value{}, wanted{};
  std::string text{};                 ///< who could change it, or what is in the way
  std::optional<std::uint32_t> op{};  ///< the instruction that looks at it, or that is meant
  std::string place{};                ///< the same in words: `LD I0.0 in line 4`
  Bits bits{0, 0};                    ///< of the memory; no bit of none
  std::optional<Time> since{};        ///< since when it has its value; nothing if that is not known
  bool since_longer = false;          ///< `since` is how far back it was looked
  std::uint32_t number = 0;           ///< from 1, of a node that others may refer to; 0 of one that has nothing below
  std::uint32_t same_as = 0;          ///< the number of the node that tells what is because of this one; 0: none
  std::size_t as_line = 0;            ///< the line of that one in lines_of(), from 1
  std::vector<Obstacle> because{};    ///< what in turn is in the way
};

/// Sets `as_line` of the nodes that refer to others; the line of the root is 1.
void number_lines(Obstacle& root);

/// Each node in a line, what is because of it below, two columns further in.
std::vector<std::string> lines_of(const Obstacle& obstacle);

/// The question that tells what is because of a node: `why not M0.0`; of the root, which needs all of the answer.
using FurtherQuestion = std::function<std::string(const Obstacle& node, bool is_root)>;

/// The same in about as many lines as a screen has: what is nearest to the root first. A node with more below it says which
/// question tells that.
std::vector<std::string> few_lines_of(const Obstacle& obstacle, const FurtherQuestion& question);

/// The node and all below: its kind, what it has of name, value, wanted, since_ns, text, as_line, and `because`. `line` is
/// that of the instruction, as `place` says it.
nlohmann::ordered_json to_json(const Obstacle& obstacle);

}  // namespace s7200::tools
