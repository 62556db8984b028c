// A scenario on the page: where it failed, or at its end.
#pragma once

#include "tools/command/testing/opened_scenario.hpp"
#include "tools/faces/page/server/serve.hpp"

namespace s7200::tools {

/// Why commands of a page do nothing with files, unless they may.
inline constexpr const char* kWhyNoFiles = "this page lets no command read or write files; s7200 view --files does";

/// Serves it until an interruption. Returns the exit code, after messages. `files`: commands may read and write files.
int view_scenario(const CLI::App& verb, const WantedScenario& wanted, bool files, page::PageServer server,
                  page::PageFlags& flags);

}  // namespace s7200::tools
