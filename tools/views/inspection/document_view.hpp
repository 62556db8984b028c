// A program on one page to print: contents, and all views of `s7200 inspect`, for the folder in the cabinet.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

/// An HTML page that needs nothing else: no network, no script, no picture. What the program says is text in it, never
/// markup. The same program gives the same page.
std::string document_text(const Inspection& inspection);

/// The page as a string.
nlohmann::ordered_json document_json(const Inspection& inspection);

}  // namespace s7200::tools
