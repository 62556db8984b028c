#include "tools/plan/plc_settings.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/stl/text/encoding.hpp"

namespace s7200::tools {

std::optional<serial::FieldScript> read_field(const std::string& path, const AddressSpace& space, const FileSource& files,
                                              std::vector<std::string>& problems) {
  if (path.empty()) return serial::FieldScript{};
  const auto csv = stl::read_decoded(files, path);
  if (!csv) {
    problems.push_back(fmt::format("cannot read {}: {}", path, csv.why()));
    return {};
  }
  std::vector<std::string> errors;
  auto field = serial::parse_field_script(*csv, path, space, errors);
  constexpr std::size_t kShown = 10;
  problems.insert(problems.end(), errors.begin(),
                  errors.begin() + static_cast<std::ptrdiff_t>(std::min(kShown, errors.size())));
  if (errors.size() > kShown) problems.push_back(fmt::format("{}: and {} more mistakes", path, errors.size() - kShown));
  return errors.empty() ? std::optional(std::move(field)) : std::nullopt;
}

}  // namespace s7200::tools
