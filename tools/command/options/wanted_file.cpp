#include "tools/command/options/wanted_file.hpp"

#include <stdexcept>
#include <utility>

#include "tools/command/terminal/terminal.hpp"

namespace s7200::tools {

std::optional<Destination> claim_wanted(WrittenFiles& files, std::string_view option, const std::string& path,
                                        FileKind kind) {
  if (path.empty()) return {};
  auto place = files.claim(option, path, std::move(kind), Replace::Own);
  if (!place) throw std::invalid_argument(place.why());
  return *std::move(place);
}

bool write_wanted(const std::optional<Destination>& to, const std::string& text) {
  if (!to) return true;
  const auto done = write_result(*to, text);
  if (!done) print_error(done.why());
  return bool(done);
}

}  // namespace s7200::tools
