// Execution times of the reference model: the figures of model/cpu*_times.csv, read by a few lines of its own.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace s7200::reference {

/// Nanoseconds.
struct Cost {
  std::int64_t base = 0;
  std::int64_t per_unit = 0;
};

class Times {
 public:
  explicit Times(const std::string& csv);

  /// For an instruction whose first operand is a direct address in `area` (upper case; empty: no such operand).
  Cost of(const std::string& mnemonic, const std::string& area = "") const;

  /// What operands in these areas (empty: not a direct address) add to the basic time.
  std::int64_t added_by(const std::string& mnemonic, const std::vector<std::string>& areas) const;

 private:
  struct Row {
    std::set<std::string> mnemonics;
    std::set<std::string> areas;  ///< empty: any operand
    Cost cost;
  };
  const Row* find(const std::string& mnemonic, const std::string& area) const;

  std::vector<Row> rows_;
};

const Times& cpu214_times();
const Times& cpu224_times();

}  // namespace s7200::reference
