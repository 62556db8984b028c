// The lines of earlier sessions: a text file in the state folder of the user (XDG_STATE_HOME, ~/.local/state). A line is
// added to it at once, so sessions at the same time lose none. A file that cannot be read or written is as if there were
// none.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace s7200::tools {

class LineHistory {
 public:
  static constexpr std::size_t kMost = 1000;  ///< lines that are kept

  /// `name`: of the file.
  explicit LineHistory(std::string_view name);

  /// Oldest first.
  std::vector<std::string> lines() const;

  void add(std::string_view line) const;

 private:
  std::string path_;  ///< empty: nowhere
};

}  // namespace s7200::tools
