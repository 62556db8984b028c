// `--report FILE.html`: a page that computes a run again. It has the program, what came from outside and the engine, so that
// any moment can be looked at in a browser, without s7200 and without a network.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/faces/page/engine/carried_system.hpp"
#include "tools/faces/page/engine/surroundings.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// What a scenario expected and did not find.
struct ReportedFinding {
  std::string text{};
  std::vector<std::string> why{};         ///< a line each
  std::uint32_t line = 0;                 ///< in the file of the scenario; 0: none
  std::optional<std::size_t> power_up{};  ///< the recording that it is in; nothing: at no moment of one
  Time at = 0;                            ///< there
};

/// A run of one PLC or of a system, or a scenario that ran otherwise.
struct ReportedRun {
  std::string file{}, name{}, outcome{}, reason{};  ///< of a scenario; empty: it is none
  std::shared_ptr<const Program> program{};         ///< of one PLC; null: it is none, or cannot be run again
  page::Surroundings around{};
  Repairs repairs{};
  std::shared_ptr<const page::CarriedSystem> system{};  ///< null: it is none
  std::vector<Recording> recordings{};                  ///< by power-up
  std::vector<ReportedFinding> findings{};
};

/// What surrounds the PLC of a plan of one PROGRAM.
page::Surroundings surroundings_of(const SystemPlan& plan);

/// The page `page` with the runs in it. `verb`: what ran them. Of long runs a coarse picture is computed, which the page
/// shows until it has computed its own.
std::string with_runs(std::string_view page, std::string_view verb, const std::vector<ReportedRun>& runs);

/// The page `page` with the conversation of a recording in it, which nothing can compute again: `decoded` is the object that
/// `decode --json` prints.
std::string with_conversation(std::string_view page, const nlohmann::ordered_json& decoded);

/// The place in a report, for links: `report.html#run=3`; of a run that cannot be opened the report alone.
std::string link_to_run(const std::string& report, std::size_t number);

}  // namespace s7200::tools
