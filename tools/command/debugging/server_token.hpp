// The token of a server of ours (tools/host/net/server_rules.hpp), as its options say.
#pragma once

#include <string>

namespace s7200::tools {

/// The first line of `token_file`; a new token if that is empty. Empty, after an error, if the file is of no use.
std::string server_token(const std::string& token_file);

}  // namespace s7200::tools
