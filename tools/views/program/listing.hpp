// A program as people see it: lines, routines, and which instruction stands where.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/program/ladder/networks.hpp"
#include "interpreter/program/program.hpp"

namespace s7200::tools {

class Listing {
 public:
  /// The program must live as long as this.
  explicit Listing(const Program& program);

  /// The instruction of a line, or the next one after it.
  std::optional<std::uint32_t> op_from_line(std::uint32_t line) const;
  /// The first instruction of a network.
  std::optional<std::uint32_t> op_of_network(std::uint32_t number) const;
  std::uint32_t line_of(std::uint32_t op) const { return program_.statement(op).position.line; }
  std::uint32_t last_line() const;

  /// The name of an instruction's routine: `main`, `SBR 51`, `INT 123`
  const std::string& routine_of(std::uint32_t op) const { return networks_.routine_of(op); }

  /// The network of an instruction: `network 6 "SBR 51: is it undisturbed?"`; empty in front of the first NETWORK line of a
  /// routine, or without any.
  const std::string& network_of(std::uint32_t op) const { return network_[op]; }

  /// Whether it is the first instruction of a network, or of a routine. A program without NETWORK lines has a network for
  /// each rung.
  bool begins_network(std::uint32_t op) const { return networks_.begins(op); }

  /// The text of an instruction with its comment.
  std::string text_of(std::uint32_t op) const;

  /// Up to `count` lines, without blank ones, from `before` lines ahead of `line`. `mark` returns the text in front of an
  /// instruction's line.
  using Mark = std::function<std::string(std::uint32_t op)>;
  std::string around(std::uint32_t line, std::size_t before, std::size_t count, const Mark& mark) const;

 private:
  struct Entry {
    std::uint32_t line = 0;
    std::string text;
    std::optional<std::uint32_t> op;
  };

  const Program& program_;
  Networks networks_;
  std::vector<Entry> entries_;        ///< the lines that are not blank
  std::vector<std::string> network_;  ///< by op
};

}  // namespace s7200::tools
