// `s7200 inspect PROGRAM ladder`: the networks of a program as ladder, as text, JSON and picture.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

/// The networks of the selection, or all, and at the end the networks that have no form in ladder. Of an address in the
/// selection, the networks that use it.
std::string ladder_text(const Inspection& inspection);
nlohmann::ordered_json ladder_json(const Inspection& inspection);
std::string ladder_svg(const Inspection& inspection);

}  // namespace s7200::tools
