// Verbs for packages and shells, not in the help: what they print is derived from the verbs of commands.hpp.
// One file a verb: cmd_<verb>.cpp.
#pragma once

namespace CLI {
class App;
}

namespace s7200::tools {

/// `s7200 help [VERB|TOPIC]`: the help of a verb, or a list of a topic (help_topics.hpp).
void derive_help(CLI::App& app, int& exit_code);

/// `s7200 manual [VERB]`: the manual page, in roff.
void derive_manual(CLI::App& app, int& exit_code);

/// `s7200 complete -- WORD…`: what the last word may be, one candidate a line, with a tab and its meaning after it.
void derive_complete(CLI::App& app, int& exit_code);

}  // namespace s7200::tools
