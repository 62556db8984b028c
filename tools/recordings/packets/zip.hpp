// Files of a zip archive in memory, stored or deflated. Source: PKWARE, .ZIP File Format Specification (APPNOTE).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "interpreter/base/result.hpp"

namespace s7200::tools {

class Zip {
 public:
  /// Opens an archive; `bytes` must live as long as it. Trouble if they have no directory of an
  /// archive.
  static Result<Zip> open(std::string_view bytes);

  bool has(std::string_view name) const { return entries_.find(name) != entries_.end(); }

  /// Hands a file to `tell` piece by piece, until that returns false. Trouble with nothing to say if it did, and if
  /// the file is damaged, encrypted or compressed in another way.
  Result<> read(std::string_view name, const std::function<bool(std::string_view piece)>& tell) const;

 private:
  struct Entry {
    std::string_view packed;  ///< the bytes in the archive
    std::uint32_t checksum = 0;
    bool deflated = false;
  };

  std::optional<Entry> entry_at(std::string_view header) const;

  std::string_view bytes_;
  std::map<std::string, std::string_view, std::less<>> entries_;  // headers in the directory by their names
};

}  // namespace s7200::tools
