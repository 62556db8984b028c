// A program as the views of `s7200 inspect` see it, for the CPU 224 unless another is named.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "interpreter/program/checking/checker.hpp"
#include "interpreter/program/load.hpp"
#include "tools/views/inspection/inspection.hpp"

namespace s7200::test {

/// The program may have errors. `about`: what is asked for, as words of the command line.
inline tools::Inspection inspected(std::string_view stl, const std::vector<std::string>& about = {},
                                   const CpuModel& model = *find_cpu("224")) {
  auto decoded = decode_program(read_text(stl, "folder/test.stl"), model, default_times(model));
  EXPECT_TRUE(decoded.known) << stl;
  tools::Inspection inspection(decoded.known);
  const auto selection = parse_selection(about, inspection.facts);
  EXPECT_TRUE(selection) << selection.why();
  if (selection) inspection.selection = *selection;
  return inspection;
}

}  // namespace s7200::test
