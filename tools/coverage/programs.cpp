#include "tools/coverage/programs.hpp"

#include <utility>

#include "tools/coverage/coverage_report.hpp"

namespace s7200::tools {

bool is_same_program(const Program& a, const Program& b) {
  return coverage_name(a) == coverage_name(b) && a.model == b.model && a.ops.size() == b.ops.size() &&
         a.source.text == b.source.text;
}

std::vector<bool> reachable_ops(const ControlFlow& flow) {
  std::vector<bool> found(flow.nodes.size());
  std::vector<std::uint32_t> open;
  const auto reach = [&](std::uint32_t op) {
    if (op < found.size() && !found[op]) found[op] = true, open.push_back(op);
  };
  const auto enter = [&](std::uint32_t routine) { reach(flow.routines[routine].first); };
  if (!found.empty()) reach(0);
  while (!open.empty()) {
    const std::uint32_t op = open.back();
    open.pop_back();
    for (const std::uint32_t next : flow.nodes[op].next) reach(next);
    for (const CallSite& call : flow.calls)
      if (call.op == op) enter(call.routine);
    for (const Attachment& attachment : flow.attachments)
      if (attachment.op == op && attachment.routine) enter(*attachment.routine);
  }
  return found;
}

Inspection for_places(std::shared_ptr<const Program> program) {
  return {std::move(program), Inspection::WithoutPointers::Yes};
}

}  // namespace s7200::tools
