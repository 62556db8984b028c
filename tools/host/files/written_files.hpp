// The files that the command writes. One rule for all of them:
//
// - What exists is replaced only if it is empty, as mktemp makes it, if the same option wrote it, which its first bytes
//   show, or if --force says so. All else is left alone, and so is what another command is still writing.
// - Links are not followed, and not replaced either: whoever wants to write what a link leads to names that.
// - No two outputs share a file, and none is a file that the command reads, under whatever names: files are told apart by
//   device and inode, and those that are not there yet by the folder and the name.
// - A file is whole or absent. It is written beside its place, as FILE.PID.new, and put there
//     when it is complete and on the disk, if it is a result: memory, a transcript, JUnit, STL;
//     with its first line, if it is a record of a run: a trace, outputs, a capture. A run may go on for days, and what it
//     records is looked at meanwhile. The record grows under its name, is whole up to where the run or the disk ended, and
//     is known by its first line from then on. It ends where it reaches its limit.
// - A record may also go to a pipe, a terminal or another character device, which have nothing to lose; so can a link to
//     one, such as /dev/fd/63, which a shell makes for `--trace >(grep LOST)`.
//
// All names are looked at before anything is written: a command that is refused has changed nothing.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interpreter/base/result.hpp"
#include "tools/host/files/file_system.hpp"

namespace s7200::tools {

/// The kind of file that an option writes.
struct FileKind {
  std::string_view name;    ///< with its article: "a trace"
  std::string beginning{};  ///< of each such file: how it is known
  bool record = false;      ///< of a run, not a result
};

/// The existing files that may be replaced.
enum class Replace : std::uint8_t {
  Own,     ///< files that the option wrote
  Never,   ///< no existing file
  Judged,  ///< any: --force, or the caller has read the file
};

struct ReplacedFile {
  FileIdentity file{};
  bool empty = false;  ///< it may be replaced as long as it still is
};

/// A place where a file may be written.
struct Destination {
  std::string path;
  FileKind kind;
  std::optional<ReplacedFile> replaced{};  ///< what is there already and may be replaced
  bool stream = false;                     ///< a pipe or a character device

  bool replaces_content() const { return replaced && !replaced->empty; }
};

/// How large a record may grow if nobody asks for more: two days of events of a poll a second, half an hour of instructions.
inline constexpr std::uint64_t kRecordLimit = 1'000'000'000;

/// All files that one command writes.
class WrittenFiles {
 public:
  /// Standard output and standard error are among the files that are taken, if they are files. `standard_output`: what `-`
  /// stands for; null where nothing may be written to it.
  explicit WrittenFiles(std::ostream* standard_output = nullptr);

  std::ostream* standard_output() const { return standard_output_; }

  /// Records end when they have that many bytes; those that go to a pipe or device do not.
  void limit_records(std::uint64_t bytes) { record_limit_ = bytes; }
  std::uint64_t record_limit() const { return record_limit_; }

  /// The command reads this file, if it is one.
  void reads(const std::string& path);

  /// Notes that `option` makes a link of this name.
  void links(std::string_view option, const std::string& path);

  /// Trouble if `option` cannot write there.
  Result<Destination> claim(std::string_view option, const std::string& path, FileKind kind, Replace replace);

 private:
  struct Place {
    std::string user;  ///< an option; empty for what the command reads
    std::optional<FileIdentity> file, folder;
    std::string name;  ///< in the folder
  };
  static Place place_of(std::string user, const std::string& path);

  std::ostream* standard_output_;
  std::uint64_t record_limit_ = kRecordLimit;
  std::vector<Place> places_;
};

/// A file that grows beside its place until it is put there.
class NewFile {
 public:
  NewFile() = default;
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Creates the file. Returns 0 or the error, like the others.
  int create(const Destination& destination);

  /// Takes a pipe or device, to which everything is written directly.
  void take(int fd) { fd_ = fd; }

  /// Puts it there unless something has come there meanwhile that may not be replaced: EEXIST. It stays open.
  int put(const Destination& destination);

  /// Leaves it beside its place when it could not be put there. Its name.
  std::string keep() { return std::exchange(beside_, {}); }

  int close();
  int fd() const { return fd_; }

 private:
  std::string beside_;  ///< name of the new file until it is put
  int fd_ = -1;
};

/// A result that is written piece by piece. Each brings trouble if it fails; a result that is not completed
/// leaves what was there before as it was. One that is complete, and whose place another program holds open, which only
/// Windows lets it do, stays beside it, and the trouble has its name.
class GrowingResult {
 public:
  Result<> begin(const Destination& destination);
  Result<> add(std::string_view text);
  Result<> complete();

 private:
  Result<> check(int error) const;

  Destination destination_;
  NewFile file_;
};

/// Writes a result. Trouble if that fails; what was there before is as it was.
Result<> write_result(const Destination& destination, std::string_view text);

}  // namespace s7200::tools
