// The lines of a recording of any length; its text is not copied.
#pragma once

#include <iterator>
#include <string_view>

#include "interpreter/base/stop_token.hpp"
#include "interpreter/base/text/text.hpp"

namespace s7200::tools {

/// The text up to the first CR or LF.
inline std::string_view first_line(std::string_view text) { return text.substr(0, text.find_first_of("\r\n")); }

/// The lines of a text without their ends, CR LF, LF or CR: `for (const std::string_view line : Lines(text))`. There are no
/// more once `stop` is requested.
class Lines {
 public:
  class Iterator {
   public:
    using value_type = std::string_view;
    using difference_type = std::ptrdiff_t;

    Iterator() = default;
    Iterator(std::string_view text, StopToken stop) : rest_(text), stop_(stop) { ++*this; }
    std::string_view operator*() const { return line_; }
    Iterator& operator++() {
      at_end_ = rest_.empty() || stop_.stop_requested();
      line_ = at_end_ ? rest_ : stl::take_line(rest_);
      return *this;
    }
    void operator++(int) { ++*this; }
    bool operator==(std::default_sentinel_t) const { return at_end_; }

   private:
    std::string_view rest_{}, line_{};
    StopToken stop_;
    bool at_end_ = true;
  };

  explicit Lines(std::string_view text, StopToken stop = {}) : text_(text), stop_(stop) {}
  Iterator begin() const { return {text_, stop_}; }
  std::default_sentinel_t end() const { return {}; }

 private:
  std::string_view text_;
  StopToken stop_;
};

}  // namespace s7200::tools
