// The known statements about the times of real CPUs, and whether a table of execution times agrees with them.
#pragma once

#include <string>
#include <vector>

#include "interpreter/program/load.hpp"

namespace s7200::tools {

struct Statement {
  enum class Verdict : std::uint8_t {
    Holds,
    Fails,
    NotChecked,  ///< it needs a program that is not at hand
  };

  std::string says{};    ///< what is known: `the first scan takes about 690 ms`
  std::string source{};  ///< source of the statement
  std::string found{};   ///< the same with the table; of one that was not checked, what it takes
  Verdict verdict = Verdict::NotChecked;
  bool fitted = false;  ///< figures of the table are from there, so that it says nothing about the others
};

/// Checks the statements about this CPU. `tip41`: Application Tip 41, a program for the CPU 214 that is not part of this
/// project; null if it is not at hand.
std::vector<Statement> check_statements(const CpuModel& model, const TimeTable& times, const SourceText* tip41);

/// Whether a program is Application Tip 41, by its routines.
bool is_tip41(const SourceText& text);

}  // namespace s7200::tools
