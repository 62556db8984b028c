// Manual pages in roff, out of the tree of verbs and options.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace s7200::tools {

/// s7200(1): the verbs, and what is the same for all.
std::string page_of_command(const CLI::App& app);

/// s7200-VERB(1). `app` is the command that it belongs to.
std::string page_of_verb(const CLI::App& app, const CLI::App& verb);

}  // namespace s7200::tools
