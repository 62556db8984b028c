// Which routine and which network an instruction belongs to, and where rungs begin.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interpreter/program/program.hpp"

namespace s7200 {

/// Whether an instruction is a box or a coil, which does nothing or writes 0 without power flow.
bool is_box_or_coil(const Op& op);

/// Whether an instruction is one of those but not one that is executed with and without power flow alike, as LBL and MEND.
bool depends_on_power_flow(const Op& op);

/// Whether it begins a rung within a network: an LD after a box or a coil.
bool begins_rung(const Program& program, std::uint32_t op);

/// A program without NETWORK lines has a network for each rung.
class Networks {
 public:
  explicit Networks(const Program& program);

  /// `main`, `SBR 51`, `INT 123`
  const std::string& routine_of(std::uint32_t op) const { return routine_[op]; }

  /// The first instruction of its network; a routine begins a network too.
  std::uint32_t first_of(std::uint32_t op) const { return first_[op]; }
  bool begins(std::uint32_t op) const { return first_[op] == op; }

  /// The number in the NETWORK line in front of a first instruction; 0 without one, or without a number.
  std::uint32_t number_of(std::uint32_t first) const { return number_[first]; }

 private:
  std::vector<std::string> routine_;  // all by op
  std::vector<std::uint32_t> first_, number_;
};

}  // namespace s7200
