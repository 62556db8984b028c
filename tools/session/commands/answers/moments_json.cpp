#include "tools/session/commands/answers/moments_json.hpp"

namespace s7200::tools {
namespace {

std::string_view mode_of(const Session& session) {
  if (!session.simulation().plc().powered()) return "off";
  return session.cpu().state().mode == Mode::Run ? "RUN" : "STOP";
}

}  // namespace

Json moments_json(const Session& session) {
  const State& state = session.cpu().state();
  const std::optional<std::uint32_t> op = session.current_op();
  return {{"now_ns", session.history.now().time},
          {"oldest_ns", session.history.usage().oldest.time},
          {"newest_ns", session.history.newest().time},
          {"in_the_past", session.history.in_the_past()},
          {"station", session.is_system() ? session.name_of(session.focus()) : ""},
          {"scan", state.scans + 1},
          {"mode", mode_of(session)},
          {"op", op ? Json(*op) : Json()},
          {"line", op ? Json(session.listing().line_of(*op)) : Json()},
          {"routine", op ? Json(session.listing().routine_of(*op)) : Json()},
          {"fatal", state.fatal_code}};
}

}  // namespace s7200::tools
