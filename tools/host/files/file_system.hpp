// What the rule for written files (written_files.hpp) needs to know of files and to do with them: the system's side of it.
// Errors are those of errno, also on Windows; error_text() has the words.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <system_error>

namespace s7200::tools {

/// Tells files apart, under whatever names.
struct FileIdentity {
  std::uint64_t device = 0, number = 0;
  bool operator==(const FileIdentity&) const = default;
};

/// The words for an error of errno; 0 is no error.
std::string error_text(int error);
/// The words for what <filesystem> reports: on Windows not those of the system, which come in its language, or
/// as a number only.
std::string error_text(const std::error_code& error);

namespace file_system {

struct Found {
  enum class Kind : std::uint8_t {
    File,
    Folder,
    Device,  ///< a character device: it has nothing to lose
    Pipe,
    Link,
    Other
  };
  Kind kind = Kind::Other;
  FileIdentity identity{};
  std::uint64_t size = 0;
  bool is_stream() const { return kind == Kind::Device || kind == Kind::Pipe; }
};

/// What has this name: a link is itself; with look_behind() it is what it leads to.
std::optional<Found> look_at(const std::string& path);
std::optional<Found> look_behind(const std::string& path);

/// Whether it is a file, or a link that leads to one.
inline bool is_file(const std::string& path) {
  const auto found = look_behind(path);
  return found && found->kind == Found::Kind::File;
}

/// What standard output (1) and standard error (2) go to.
std::optional<Found> look_at_descriptor(int fd);

/// Whether two names in one folder are the same name.
bool is_same_name(const std::string& one, const std::string& other);

/// Without following a link.
bool begins_with(const std::string& path, const std::string& beginning);

/// Whether a writer of ours has it open; on Windows, whether anyone who lets nobody else write has. A file system without
/// locks knows no writer.
bool is_being_written(const std::string& path);

/// 0, or why no file can be made or replaced in a folder.
int why_no_new_file(const std::string& folder);

/// Opens a new file for writing, so that is_being_written() knows it, with the rights of the file `like`, if that exists.
/// The descriptor, or -1 with errno set.
int create_new(const std::string& path, const std::string& like);

/// Opens a pipe or a device for writing, which must be there; waits for the reader of a pipe until an interruption. The
/// descriptor, or -1 with errno set.
int open_stream(const std::string& path);

/// Gives a file another name: in one step, and only if nothing has that name, or in place of what has. 0 or the error.
int rename_to_new_name(const std::string& from, const std::string& to);
int rename_over(const std::string& from, const std::string& to);

/// Brings what was written onto the disk. 0 or the error.
int write_through(int fd);

/// Brings the names in a folder onto the disk, where the file system knows how.
void write_names_through(const std::string& folder);

/// 0 or the error.
int close(int fd);
void remove(const std::string& path);

/// Of this process, for names that no other has.
int process_number();

}  // namespace file_system
}  // namespace s7200::tools
