#include "tools/coverage/observed.hpp"

#include <utility>

namespace s7200::tools {

PlcObservers::PlcObservers(std::shared_ptr<const Program> program, const Observed& observed) {
  if (observed.profile) profile_.emplace(program);
  if (observed.coverage) coverage_.emplace(std::make_shared<const CoverageMap>(std::move(program)));
}

void PlcObservers::add_to(FanOut& sinks) {
  if (coverage_) sinks.add(&*coverage_);
  if (profile_) sinks.add(&*profile_);
}

void PlcObservers::begin(const Cpu& cpu) {
  if (coverage_) coverage_->begin(cpu);
  if (profile_) profile_->begin(cpu);
}

void PlcObservers::report(CoverageOfPrograms& coverage) const {
  if (coverage_) coverage.add(coverage_->shared_map(), coverage_->tried());
}

void PlcObservers::report(ProfileOfPrograms& profile, const std::string& plc) const {
  if (profile_) profile.add(profile_->profile(), {plc, {}, {}});
}

}  // namespace s7200::tools
