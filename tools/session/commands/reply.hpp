// What a command answers.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace s7200::tools {

using Json = nlohmann::ordered_json;
using Words = std::vector<std::string>;

struct Reply {
  std::string text{};                  ///< what people read: lines
  Json json{};                         ///< the same for machines; null where a command has nothing for them
  bool moved = false;                  ///< the session stands at another moment than before
  bool interrupted = false;            ///< a stop request has ended it before it was done
  std::optional<std::string> error{};  ///< the command was wrong, or an expectation did not hold: what was expected
};

/// The command was wrong.
inline Reply wrong(std::string why) { return {.error = std::move(why)}; }

}  // namespace s7200::tools
