// The files that commands read and write, as whoever runs a session lets them.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"

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
  /// Writes all of it. Trouble if that fails; what was there before is as it was then.
  std::function<Result<>(std::string_view text)> write{};
};

class SessionFiles {
 public:
  virtual ~SessionFiles() = default;

  /// All of a file. Trouble if it cannot be read.
  virtual Result<std::string> read(const std::string& path) const = 0;

  /// Whether a file begins so.
  virtual bool begins(const std::string& path, std::string_view beginning) const = 0;

  /// Trouble if it may not be written there.
  virtual Result<FilePlace> place_for(const WantedFile& wanted) const = 0;

  /// Files and folders whose names begin so; folders end with `/`.
  virtual std::vector<std::string> names(std::string_view beginning) const = 0;

  /// A saved session as the text of a file, and out of one: to_text() and session_from_text() of session_file.hpp, which
  /// throw inside, as not every system that holds a session can.
  virtual std::string saved(const SessionFile& session) const = 0;
  virtual Result<SessionFile> loaded(std::string_view text, std::span<const CpuModel* const> models,
                                     std::span<const std::string> stations) const = 0;
};

}  // namespace s7200::tools
