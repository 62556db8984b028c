// The names of files are UTF-8 everywhere here.
#pragma once

#include <filesystem>
#include <string_view>

namespace s7200 {

/// The path that a text names. std::filesystem::path(text) would take the text for one of a code page on Windows, and
/// nothing in it would be found that has an umlaut; the other way, path.string(), gives UTF-8.
inline std::filesystem::path file_path(std::string_view text) { return std::u8string(text.begin(), text.end()); }

}  // namespace s7200
