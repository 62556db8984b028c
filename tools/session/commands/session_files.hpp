// The files that commands read and write, as whoever runs a session lets them.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace s7200 {
struct CpuModel;
}

namespace s7200::tools {

struct SessionFile;

/// What may be there already where a file is to be written.
enum class Replacing : std::uint8_t { Own, Nothing, Anything };

/// A file that a command is to write.
struct WantedFile {
  std::string_view command;  ///< that writes it
  std::string path;
  std::string_view what;    ///< with its article: "a saved session"
  std::string beginning{};  ///< of each such file: how it is known
  Replacing replacing = Replacing::Own;
};

/// A place where that file may be written.
struct FilePlace {
  std::string path;
  /// Writes all of it. False, and `why`, if that fails; what was there before is as it was then.
  std::function<bool(std::string_view text, std::string& why)> write{};
};

class SessionFiles {
 public:
  virtual ~SessionFiles() = default;

  /// All of a file. Nothing, and `why`, if it cannot be read.
  virtual std::optional<std::string> read(const std::string& path, std::string& why) const = 0;

  /// Whether a file begins so.
  virtual bool begins(const std::string& path, std::string_view beginning) const = 0;

  /// Nothing, and `why`, if it may not be written there.
  virtual std::optional<FilePlace> place_for(const WantedFile& wanted, std::string& why) const = 0;

  /// Files and folders whose names begin so; folders end with `/`.
  virtual std::vector<std::string> names(std::string_view beginning) const = 0;

  /// A saved session as the text of a file, and out of one: to_text() and session_from_text() of session_file.hpp, which
  /// throw inside, as not every system that holds a session can.
  virtual std::string saved(const SessionFile& session) const = 0;
  virtual std::optional<SessionFile> loaded(std::string_view text, std::span<const CpuModel* const> models,
                                            std::span<const std::string> stations, std::string& why) const = 0;
};

}  // namespace s7200::tools
