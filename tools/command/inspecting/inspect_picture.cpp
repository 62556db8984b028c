#include "tools/command/inspecting/inspect_picture.hpp"

#include <fmt/format.h>

#include "tools/command/exit_code.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/views/ladder/ladder_svg.hpp"

namespace s7200::tools {

bool Picture::claim(const std::string& path, const InspectView& view, const std::vector<std::string>& inputs) {
  if (path.empty()) return true;
  if (!view.svg) return print_error(fmt::format("--svg: there is no picture of the view {}", view.name)), false;
  WrittenFiles files;
  for (const std::string& input : inputs) files.reads(input);
  auto claimed = files.claim("--svg", path, {"a picture", std::string(kPictureBegins)}, Replace::Own);
  if (!claimed) print_error(claimed.why());
  destination_ = std::move(claimed).if_any();
  return destination_.has_value();
}

int Picture::write(const InspectView& view, const Inspection& inspection) const {
  if (const auto done = write_result(*destination_, view.svg(inspection)); !done) return print_error(done.why()), kUnusable;
  print_note(fmt::format("{}: the {} of {}", destination_->path, view.name, inspection.program->source.name));
  return kFine;
}

}  // namespace s7200::tools
