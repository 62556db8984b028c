// Files of a zip archive in memory, stored or deflated. Source: PKWARE, .ZIP File Format Specification (APPNOTE).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace s7200::tools {

class Zip {
 public:
  /// Opens an archive; `bytes` must live as long as it. Returns nothing and sets `why` if they have no directory of an
  /// archive.
  static std::optional<Zip> open(std::string_view bytes, std::string& why);

  bool has(std::string_view name) const { return entries_.find(name) != entries_.end(); }

  /// Hands a file to `tell` piece by piece, until that returns false. Returns false if it did, and false with `why` set if
  /// the file is damaged, encrypted or compressed in another way.
  bool read(std::string_view name, const std::function<bool(std::string_view piece)>& tell, std::string& why) const;

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
