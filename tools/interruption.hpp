// Ctrl-C and a polite kill: the run ends, what was asked for is still written.
#pragma once

namespace s7200::tools {

/// From now on SIGINT and SIGTERM are only noted.
void catch_interruption();

bool interrupted();

}  // namespace s7200::tools
