// A steady view in the upper part of a terminal, above a lower part in which all else scrolls, as in a terminal of that
// height: the prompt, what commands print. What the terminal knows comes from ncurses' terminfo.
//
// It is taken away, and the terminal as it was, when the view is switched off, at the end, while the process is stopped
// (Ctrl-Z), and before a signal kills it.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "interpreter/base/result.hpp"

namespace s7200::tools {

class Screen {
 public:
  struct Plan {
    std::string name;  ///< of the view, in messages
    int fewest_columns = 0, fewest_rows = 0;
    std::function<int(int columns, int rows)> view;  ///< its rows in such a terminal; the last is a line between the parts
  };

  explicit Screen(Plan plan) : plan_(std::move(plan)) {}
  ~Screen() { switch_off(); }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// False, and why not, if this terminal cannot do it or is too small.
  Result<> switch_on();
  void switch_off();
  bool on() const { return on_; }

  /// Rows that there are for the view, without the line between the parts.
  std::size_t view_rows() const { return static_cast<std::size_t>(view_rows_ - 1); }
  int columns() const { return columns_; }

  /// Rows of the view, the first in reverse; what is too wide is cut. Nothing while it is off.
  void draw(const std::vector<std::string>& rows);

  /// The terminal has another size, or the process goes on. The view goes when there is no room, which is trouble.
  Result<> fit();

 private:
  Result<> measure();

  Plan plan_;
  bool on_ = false;
  int columns_ = 0, rows_ = 0, view_rows_ = 1;
};

}  // namespace s7200::tools
