// Siemens' Application Tip 41, where the document is at hand.
#pragma once

#include <filesystem>
#include <string>

#include "interpreter/program/load.hpp"
#include "interpreter/stl/printer.hpp"
#include "tests/support/slave_bench.hpp"

namespace s7200::test::tip41 {

inline std::string path() { return source_path("../shared/seeds/tip41_modbus_rtu_slave.txt"); }
inline bool available() { return std::filesystem::exists(path()); }

/// Its STL, as `s7200 import` writes it.
inline std::string text() {
  const auto source = read_source(text_of(path()), path());
  EXPECT_TRUE(source) << source.why();
  return source ? stl::to_text(source->parsed.source) : std::string{};
}

}  // namespace s7200::test::tip41
