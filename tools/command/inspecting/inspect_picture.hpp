// The picture that `s7200 inspect --svg` writes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/host/files/written_files.hpp"
#include "tools/views/inspection/inspect_views.hpp"

namespace s7200::tools {

class Picture {
 public:
  /// Takes the place of the file, which is none of `inputs`; an empty path is no picture. Returns false, after a message, if
  /// it cannot be written or the view has none.
  bool claim(const std::string& path, const InspectView& view, const std::vector<std::string>& inputs);

  explicit operator bool() const { return destination_.has_value(); }

  /// Returns the exit code, after a message if it is not kFine.
  int write(const InspectView& view, const Inspection& inspection) const;

 private:
  std::optional<Destination> destination_;
};

}  // namespace s7200::tools
