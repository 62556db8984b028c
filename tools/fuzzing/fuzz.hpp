// Looks for what a program does wrong with inputs that nobody thought of: frames, characters, inputs and times by chance,
// guided by what its instructions have not done before.
//
// A run begins at a snapshot of a run that has done something new, gives the program one or two things more, and waits for
// what comes of it. Each kind of wrong is found once for each instruction.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/base/stop_token.hpp"
#include "interpreter/program/operands/address.hpp"
#include "tools/session/causes/expression.hpp"
#include "tools/trials/contacts_seen.hpp"
#include "tools/trials/trial.hpp"
#include "tools/trials/trial_scenario.hpp"
#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

struct FuzzSettings {
  std::uint64_t seed = 1, runs = 0;   ///< 0: any number
  double seconds = 10;                ///< of the host
  std::vector<MemoryRange> writes{};  ///< V memory that the program may write; empty: any
  std::vector<Expression> never{};    ///< what must not be at the end of any scan
  Time answers_within = 2 * kSecond;  ///< a request that was answered before
  StopToken stop{};
  std::function<void(std::uint64_t runs)> progress{};
};

struct FuzzFinding {
  enum class Kind : std::uint8_t {
    Fatal,       ///< STOP on a fatal error
    Stop,        ///< the program goes to STOP by itself
    Error,       ///< a run-time error
    Write,       ///< an instruction writes where none may
    Unanswered,  ///< a request that was answered before is not answered any more
    Rule         ///< of the user's is broken
  };
  Kind kind{};
  std::uint16_t code = 0;               ///< of an error
  std::optional<std::uint32_t> op{};    ///< that did it
  std::uint32_t place = 0;              ///< Write: in the image
  std::size_t rule = 0;                 ///< Rule: its number
  std::string what{};                   ///< in words
  Time at = 0;                          ///< since power-up
  Trial trial{};                        ///< the shortest that leads there
  std::vector<Time> begun{};            ///< when each stimulus comes
  bool comes_again = true;              ///< when the trial is run from power-up
  std::vector<std::uint8_t> request{};  ///< Unanswered
  std::string end{};                    ///< steps of a scenario that fail because of it

  bool same_as(const FuzzFinding& other) const {
    return kind == other.kind && code == other.code && op == other.op && rule == other.rule;
  }
};

struct FuzzResult {
  enum class End : std::uint8_t { Runs, Seconds, Interrupted };
  End end{};
  std::vector<FuzzFinding> findings{};
  std::uint64_t runs = 0;
  double host_seconds = 0;
  Time simulated = 0;
  std::size_t snapshots = 0, requests = 0;  ///< kept; that the program answers
  std::uint8_t port = 0;
  bool listens = false;  ///< at that port
  bool both_ports = false;
  std::size_t contacts = 0, both_ways = 0;
  std::vector<ContactsSeen::Never> never{};
};

/// The program has no errors. The same for the same seed and number of runs.
FuzzResult fuzz(const Inspection& inspection, const FuzzSettings& settings);

std::string fuzz_text(const Inspection& inspection, const FuzzResult& result);
nlohmann::ordered_json fuzz_json(const Inspection& inspection, const FuzzResult& result);

/// A scenario that fails as long as the program does what was found. Trouble if it does not show it.
Result<std::string> finding_scenario(const Inspection& inspection, const FuzzResult& result, const FuzzFinding& finding,
                                     const std::string& path, const ScenarioOrigin& origin);

}  // namespace s7200::tools
