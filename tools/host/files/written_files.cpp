#include "tools/host/files/written_files.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <filesystem>

#include "interpreter/base/file_path.hpp"
#include "tools/host/files/file_obstacles.hpp"
#include "tools/host/files/write_all.hpp"

namespace s7200::tools {
namespace {

namespace fs = std::filesystem;
using file_system::Found;
using file_system::look_at;
using file_system::look_behind;

std::string folder_of(const std::string& path) {
  const fs::path folder = file_path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

/// Why nothing can be written under a name that stands for this; empty if a record can go there as it is.
std::string why_not(const std::string& path, const Found& found, const FileKind& kind) {
  const auto target = look_behind(path);
  if (target && target->is_stream())
    return kind.record ? "" : fmt::format("cannot write {}: it is a device or a pipe, not a file", path);
  if (found.kind == Found::Kind::Link)
    return fmt::format("{} is a link; it is left alone, and so is what it leads to", path);
  return fmt::format("cannot write {}: it is {}", path, found.kind == Found::Kind::Folder ? "a folder" : "not a file");
}

/// Whether what is there now, maybe hours after it was claimed, may be replaced.
bool may_replace(const Destination& destination, const Found& found) {
  if (found.kind != Found::Kind::File) return false;
  const auto& replaced = destination.replaced;
  if (replaced && found.identity == replaced->file && (!replaced->empty || found.size == 0)) return true;
  const std::string& beginning = destination.kind.beginning;
  return !beginning.empty() && file_system::begins_with(destination.path, beginning);
}

}  // namespace

// --- claims ---

WrittenFiles::WrittenFiles(std::ostream* standard_output) : standard_output_(standard_output) {
  for (const auto& [fd, name] : {std::pair(1, "standard output"), std::pair(2, "standard error")}) {
    const auto found = file_system::look_at_descriptor(fd);
    if (found && found->kind != Found::Kind::Device) places_.push_back({name, found->identity, {}, {}});
  }
}

WrittenFiles::Place WrittenFiles::place_of(std::string user, const std::string& path) {
  Place place{std::move(user), {}, {}, file_path(path).filename().string()};
  if (const auto found = look_behind(path)) place.file = found->identity;
  if (const auto found = look_behind(folder_of(path))) place.folder = found->identity;
  return place;
}

void WrittenFiles::reads(const std::string& path) {
  const auto found = look_behind(path);
  if (found && found->kind == Found::Kind::File) places_.push_back(place_of("", path));
}

void WrittenFiles::links(std::string_view option, const std::string& path) {
  if (!path.empty()) places_.push_back(place_of(std::string(option), path));
}

Result<Destination> WrittenFiles::claim(std::string_view option, const std::string& path, FileKind kind, Replace replace) {
  const auto refuse = [](std::string message) { return Trouble{std::move(message)}; };
  if (const std::string reason = why_not_to_be_written(path); !reason.empty())
    return refuse(fmt::format("cannot write {}: {}", path, reason));
  Destination destination{.path = path, .kind = std::move(kind)};
  const auto found = look_at(path), target = look_behind(path);
  const bool device = target && target->kind == Found::Kind::Device;
  const Place here = place_of(std::string(option), path);
  for (const Place& other : places_) {
    const bool same_file = here.file && here.file == other.file;
    const bool same_name = here.folder && here.folder == other.folder && file_system::is_same_name(here.name, other.name);
    if (device || !(same_file || same_name)) continue;
    return refuse(other.user.empty()
                      ? fmt::format("{} {}: the command reads this file; name another", option, path)
                      : fmt::format("{} {}: this file is named twice; {} has it already", option, path, other.user));
  }
  places_.push_back(here);

  if (found && found->kind != Found::Kind::File) {
    if (std::string reason = why_not(path, *found, destination.kind); !reason.empty()) return refuse(std::move(reason));
    destination.stream = true;
    return destination;
  }
  const bool holds_something = found && found->size != 0;
  if (holds_something && replace == Replace::Own && !file_system::begins_with(path, destination.kind.beginning))
    return refuse(fmt::format("{} exists and is not {}; it is left alone", path, destination.kind.name));
  if (holds_something && replace == Replace::Never) return refuse(fmt::format("{} exists", path));
  if (found && file_system::is_being_written(path))
    return refuse(fmt::format("{} {}: another program has it open for writing; close it there, or name another", option, path));
  if (const int error = file_system::why_no_new_file(folder_of(path)); error != 0)
    return refuse(fmt::format("cannot write {}: {}", path,
                              error == ENOENT ? fmt::format("there is no folder {}", folder_of(path)) : error_text(error)));
  if (found) destination.replaced = {found->identity, found->size == 0};
  return destination;
}

// --- writing ---

NewFile::~NewFile() {
  close();
  if (!beside_.empty()) file_system::remove(beside_);
}

/// Creates the new file with the rights of the file that it is to replace. One of this name may be there: what could not be put in
/// its place before.
int NewFile::create(const Destination& destination) {
  constexpr int kNames = 100;
  const std::string name = fmt::format("{}.{}", destination.path, file_system::process_number());
  for (int i = 1; i <= kNames; ++i) {
    const std::string beside = i == 1 ? name + ".new" : fmt::format("{}.{}.new", name, i);
    fd_ = file_system::create_new(beside, destination.path);
    if (fd_ >= 0) {
      beside_ = beside;
      return 0;
    }
    if (errno != EEXIST) break;
  }
  return errno;
}

int NewFile::put(const Destination& destination) {
  const auto found = look_at(destination.path);
  if (found && !may_replace(destination, *found)) return EEXIST;
  const int error = found ? file_system::rename_over(beside_, destination.path)
                          : file_system::rename_to_new_name(beside_, destination.path);
  if (error == 0) beside_.clear();
  return error;
}

int NewFile::close() {
  if (fd_ < 0) return 0;
  const int error = file_system::close(fd_);
  fd_ = -1;
  return error;
}

Result<> GrowingResult::check(int error) const {
  if (error != 0) return trouble("cannot write {}: {}", destination_.path, error_text(error));
  return {};
}

Result<> GrowingResult::begin(const Destination& destination) {
  destination_ = destination;
  return check(file_.create(destination_));
}

Result<> GrowingResult::add(std::string_view text) { return check(write_all(file_.fd(), text)); }

Result<> GrowingResult::complete() {
  int error = file_system::write_through(file_.fd());
  if (error == 0) error = file_.close();
  if (const auto done = check(error); !done) return done.trouble();
  if (const auto done = check(file_.put(destination_)); !done)
    return trouble("{}; what was to be there is in {}", done.why(), file_.keep());
  // The new name itself on the disk as well; the content is safe already.
  file_system::write_names_through(folder_of(destination_.path));
  return {};
}

Result<> write_result(const Destination& destination, std::string_view text) {
  GrowingResult result;
  return result.begin(destination).and_then([&] { return result.add(text); }).and_then([&] { return result.complete(); });
}

}  // namespace s7200::tools
