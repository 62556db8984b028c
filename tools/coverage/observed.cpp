#include "tools/coverage/observed.hpp"

#include <utility>

namespace s7200::tools {

PlcObservers::PlcObservers(std::shared_ptr<const Program> program, const Observed& observed) {
  if (observed.coverage) coverage_.emplace(std::make_shared<const CoverageMap>(std::move(program)));
}

void PlcObservers::add_to(FanOut& sinks) {
  if (coverage_) sinks.add(&*coverage_);
}

void PlcObservers::begin(const Cpu& cpu) {
  if (coverage_) coverage_->begin(cpu);
}

void PlcObservers::report(CoverageOfPrograms& coverage) const {
  if (coverage_) coverage.add(coverage_->shared_map(), coverage_->tried());
}

}  // namespace s7200::tools
