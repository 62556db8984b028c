#include "tools/scenario/steps/expected/error_code.hpp"

#include "interpreter/base/text/text.hpp"

namespace s7200::tools {

std::optional<std::uint16_t> read_error_code(ValueReader& values, const YamlNode& node, bool none_allowed) {
  return values.value(&node, "an error code", none_allowed ? "0003, none" : "0092",
                      [&](const std::string& t) -> std::optional<std::uint16_t> {
                        if (none_allowed && stl::lower_case(t) == "none") return std::uint16_t{0};
                        const auto parsed = t.size() == 4 ? parse_number("16#" + t) : std::nullopt;
                        return parsed && *parsed > 0 ? std::optional(static_cast<std::uint16_t>(*parsed)) : std::nullopt;
                      });
}

}  // namespace s7200::tools
