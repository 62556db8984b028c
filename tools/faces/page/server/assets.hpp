// The files of the page, which the build puts into the command.
#pragma once

#include <vector>

#include "tools/host/net/web_server.hpp"

namespace s7200::tools::page {

/// `index.html` is the one without a name. They live as long as the program.
const std::vector<WebFile>& page_files();

}  // namespace s7200::tools::page
