// A steady view in the upper part of a terminal, above a lower part in which all else scrolls, as in a terminal of that
// height: the prompt, what commands print. What the terminal knows comes from ncurses' terminfo.
//
// It is taken away, and the terminal as it was, when the view is switched off, at the end, while the process is stopped
// (Ctrl-Z), and before a signal kills it.
#pragma once

#include <string>
#include <vector>

namespace s7200::tools {

class Screen {
 public:
  static constexpr int kFewestColumns = 80, kFewestRows = 24;
  static constexpr int kViewRows = 15;  ///< the last is a line between the two parts

  Screen() = default;
  ~Screen() { switch_off(); }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// False, and why not, if this terminal cannot do it or is too small.
  bool switch_on(std::string& why);
  void switch_off();
  bool on() const { return on_; }

  /// Rows of the view, the first in reverse; what is too wide is cut. Nothing while it is off.
  void draw(const std::vector<std::string>& rows);

  /// The terminal has another size, or the process goes on. The view goes when there is no room, and `why` says so.
  bool fit(std::string& why);

 private:
  bool on_ = false;
  int columns_ = 0, rows_ = 0;
};

}  // namespace s7200::tools
