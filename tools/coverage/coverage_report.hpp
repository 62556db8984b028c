// How much of a program was tried, in figures and in words.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/coverage/coverage.hpp"
#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

/// So many of so many.
struct Share {
  std::size_t tried = 0, all = 0;

  void count(bool was_tried) {
    ++all;
    tried += was_tried;
  }
  /// 100 if there is nothing to try.
  double percent() const { return all == 0 ? 100 : 100 * static_cast<double>(tried) / static_cast<double>(all); }
  bool complete() const { return tried == all; }
  bool operator==(const Share&) const = default;
};

struct CoverageFigures {
  Share networks;      ///< of which an instruction was executed
  Share instructions;  ///< executed, with power flow if they need it
  Share contacts;      ///< seen open and closed
  Share deciding;      ///< contacts seen to decide an output alone, both ways (MC/DC)

  /// The least of what a limit asks for: instructions and contacts, each, in percent.
  double least() const { return std::min(instructions.percent(), contacts.percent()); }
  bool operator==(const CoverageFigures&) const = default;
};

/// What was tried of a program by all runs that had it.
struct ProgramCoverage {
  std::shared_ptr<const CoverageMap> map;
  Tried tried;
};

/// Programs with the same name, CPU and text are one; their times may differ.
class CoverageOfPrograms {
 public:
  void add(const std::shared_ptr<const CoverageMap>& map, const Tried& tried);
  const std::vector<ProgramCoverage>& programs() const { return programs_; }

  /// The least of CoverageFigures::least() of all programs; 100 if there is none.
  double least() const;

 private:
  std::vector<ProgramCoverage> programs_;
};

/// `stl_programs/modbus_slave.stl`: the name of a program's file, without `..` that leads back.
std::string coverage_name(const Program& program);

CoverageFigures figures_of(const CoverageMap& map, const Tried& tried);

/// An op of which something was not tried.
struct Untried {
  std::uint32_t op = 0, end = 0;  ///< further ops of its network up to before `end` were not executed either
  std::string what{};             ///< `never executed`, `never open`, `never decided alone`
  std::string why{};              ///< that no test can try it, as far as that is known
};

/// By op.
std::vector<Untried> untried_of(const CoverageMap& map, const Tried& tried, const Inspection& inspection);

/// Figures, a row for each routine and for each network that is not complete, and what was not tried.
std::string coverage_text(const ProgramCoverage& coverage);

/// `instructions 97.2%, contacts 91.0%, deciding 85.1%`
std::string figures_text(const CoverageFigures& figures);

nlohmann::ordered_json figures_json(const CoverageFigures& figures);
nlohmann::ordered_json coverage_json(const ProgramCoverage& coverage);

}  // namespace s7200::tools
