#include "tools/session/words/mode_words.hpp"

#include <fmt/format.h>

#include "interpreter/base/text/text.hpp"
#include "tools/session/words/words.hpp"

namespace s7200::tools {

std::optional<SetMode> mode_of(std::string_view word, const serial::Simulation& simulation, std::string& why) {
  const std::string name = stl::lower_case(word);
  const State& state = simulation.cpu().state();
  if (name != "run" && name != "stop") return why = expects("mode", "run or stop"), std::nullopt;
  const Mode mode = name == "run" ? Mode::Run : Mode::Stop;
  if (mode == state.mode)
    why = fmt::format("mode: the CPU is in {} already", stl::upper_case(name));
  else if (state.fatal_code != 0)
    why = fmt::format("mode: after fatal error {:04X} the CPU stays in STOP until it is powered up again: 'restart'",
                      state.fatal_code);
  return why.empty() ? std::optional(SetMode{mode}) : std::nullopt;
}

}  // namespace s7200::tools
