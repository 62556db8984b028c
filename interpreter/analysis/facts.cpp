#include "interpreter/analysis/facts.hpp"

namespace s7200 {

Facts facts_of(const Program& program) {
  Facts facts{program, control_flow(program), {}};
  const Pointers pointers(program);
  for (std::uint32_t op = 0; op < program.ops.size(); ++op) facts.effects.push_back(effects_of(program, op, pointers));
  return facts;
}

}  // namespace s7200
