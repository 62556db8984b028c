// The output of --json: one object, in which "s7200" says who printed it. JSON.md has the keys of every verb.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace s7200::tools {

/// The version of s7200: `0.1.0`
std::string_view version();

/// {"s7200": {"verb": "check", "version": "0.1.0"}}: the verb adds its results.
nlohmann::ordered_json results_of(std::string_view verb);

/// The JSON in several lines. Text that is not UTF-8, such as the name of a file, has replacement characters where it is
/// not.
std::string lines_of(const nlohmann::ordered_json& results);

/// The JSON in one line, for results that are printed as they come.
std::string line_of(const nlohmann::ordered_json& json);

/// A number with the digits that a REAL has: 0.1, not 0.10000000149. JSON has no NaN and no infinity: "nan", "inf", "-inf".
nlohmann::ordered_json real_json(float value);

}  // namespace s7200::tools
