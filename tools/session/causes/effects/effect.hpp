// What came of the last change of memory: forwards, where `why` goes back.
//
// The answer is a comparison. The known past is played from just before the change; then the same once more, with the same
// doings from outside at the same times, but with the memory kept as it was for as long as it kept its new value. What
// differs is an effect, and whatever is the same in both runs is none, however it came about. An effect is below what led to
// it: a bit or a word that differs at that time and was looked at by the contacts of its rung or by the instruction itself,
// a jump, a call or a segment that went another way, an interrupt.
//
// The same turn of a bit within two scans counts as the same in both runs, and so does the same character: scans take other
// times when a program goes another way. Differences that nothing leads to but those times are named apart.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "interpreter/program/operands/address.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// An effect, and what came of it in turn.
struct Effect {
  std::string_view kind{};            ///< for machines: `memory`, `way`, `interrupt`, `sent`, `error`, `mode`
  std::string text{};                 ///< `Q0.0 is 1, not 0`
  std::string name{};                 ///< of memory
  std::string value{}, otherwise{};   ///< of memory: as it was, and as it would have been
  Time from = 0;                      ///< when the runs first differ in it
  std::optional<Time> until{};        ///< when they last did; nothing if they differ at the end
  std::optional<std::uint32_t> op{};  ///< the instruction that did it
  std::string place{};                ///< the same in words: `= Q0.0 in line 17`
  std::string because{};              ///< the contact or instruction that looked at what is above
  std::vector<Effect> effects{};
};

struct EffectAnswer {
  std::string name, was, became;
  Time at = 0;
  std::string by{};                  ///< who has changed it
  std::optional<Time> until{};       ///< when it changed again; nothing if it has not
  Time followed_until = 0;           ///< how far the runs were compared
  std::string ended_by{};            ///< why no further
  std::optional<Time> alike_from{};  ///< from when on the runs are alike again; nothing if they differ at the end
  std::vector<Effect> effects{};
  std::vector<std::string> by_timing{};  ///< `VW0 from 12.3 ms on`
};

struct EffectSearch {
  std::optional<EffectAnswer> answer;
  std::string none{};  ///< what is to be said if there is none
  bool interrupted = false;
};

/// What came of the last change of memory of a station before now, at most for `within`; the history stands where it stood.
/// `name` is what the memory is called.
EffectSearch find_effect(History& history, std::size_t station, const MemoryRange& range, std::string_view name, Time within,
                         StopToken stop_request);

std::vector<std::string> lines_of(const EffectAnswer& answer);
nlohmann::ordered_json to_json(const EffectAnswer& answer);

}  // namespace s7200::tools
