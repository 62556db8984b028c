// The networks of a program as ladder, as a picture that stands for itself: SVG with its own colours, light and dark.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "interpreter/analysis/drawn_networks.hpp"

namespace s7200::tools {

/// The first bytes of each picture, by which it is known as one that may be replaced.
inline constexpr std::string_view kPictureBegins = "<svg class=\"s7200-ladder\"";

/// The same networks, titles, comments and symbols as ladder_text(). Each element says its line and its instruction where
/// the pointer rests on it.
std::string ladder_svg(const std::vector<DrawnNetwork>& networks, const stl::Source& program);

}  // namespace s7200::tools
