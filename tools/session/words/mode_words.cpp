#include "tools/session/words/mode_words.hpp"

#include <fmt/format.h>

#include "interpreter/base/text/text.hpp"
#include "tools/session/words/words.hpp"

namespace s7200::tools {

Result<SetMode> mode_of(std::string_view word, const serial::Simulation& simulation) {
  const std::string name = stl::lower_case(word);
  const State& state = simulation.cpu().state();
  if (name != "run" && name != "stop") return Trouble{expects("mode", "run or stop")};
  const Mode mode = name == "run" ? Mode::Run : Mode::Stop;
  if (mode == state.mode) return trouble("mode: the CPU is in {} already", stl::upper_case(name));
  if (state.fatal_code != 0)
    return trouble("mode: after fatal error {:04X} the CPU stays in STOP until it is powered up again: 'restart'",
                   state.fatal_code);
  return SetMode{mode};
}

}  // namespace s7200::tools
