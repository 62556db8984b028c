// What strace prints of a program that talks to a line: `write(3, "\1\3…", 8) = 8`, `read(3, …`, also readv, sendto and
// their like, with the process and the time in front (-f, -t, -tt, -ttt, -r), hex (-x, -xx) and names of descriptors (-y).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/left_out.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/rows/notation.hpp"

namespace s7200::tools {
namespace {

/// A call that moves bytes.
struct Mover {
  std::string_view name;
  Direction direction;
};
constexpr std::array kMovers{
    Mover{"write", Direction::Request},  Mover{"read", Direction::Answer},      Mover{"writev", Direction::Request},
    Mover{"readv", Direction::Answer},   Mover{"send", Direction::Request},     Mover{"recv", Direction::Answer},
    Mover{"sendto", Direction::Request}, Mover{"recvfrom", Direction::Answer},  Mover{"sendmsg", Direction::Request},
    Mover{"recvmsg", Direction::Answer}, Mover{"pwrite64", Direction::Request}, Mover{"pread64", Direction::Answer},
};

const Mover* find_mover(std::string_view name) {
  const auto mover = std::ranges::find(kMovers, name, &Mover::name);
  return mover == kMovers.end() ? nullptr : &*mover;
}

/// A line of strace: `[pid 7] 10:00:00.000100 write(3</dev/ttyUSB0>, "\1\3", 2) = 2`.
struct Call {
  std::string process{};  ///< empty if the line does not say
  std::optional<LeadingTime> time{};
  std::string_view name{};
  std::string_view rest{};  ///< after the bracket
  bool resumed = false;     ///< `<... read resumed>`
};

void skip_blanks(std::string_view& text) { text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size())); }

std::string_view take_name(std::string_view& text) {
  const auto is_of_name = [](char c) { return stl::is_lower(c) || stl::is_digit(c) || c == '_'; };
  const std::string_view whole = text;
  while (!text.empty() && is_of_name(text.front())) text.remove_prefix(1);
  return whole.substr(0, whole.size() - text.size());
}

/// Takes the number of the process: `[pid  1234] ` or `1234  `; a number with a point or a colon is a time.
std::string take_process(std::string_view& line) {
  std::string_view text = line;
  const bool bracketed = text.starts_with("[pid ");
  if (bracketed) text.remove_prefix(5);
  skip_blanks(text);
  const std::string_view from = text;
  while (!text.empty() && stl::is_digit(text.front())) text.remove_prefix(1);
  const std::string process(from.substr(0, from.size() - text.size()));
  const bool ends = bracketed ? text.starts_with("] ") : text.starts_with(' ');
  if (process.empty() || !ends) return {};
  line = text.substr(1);
  return process;
}

std::optional<Call> call_of(std::string_view line) {
  Call call;
  skip_blanks(line);
  call.process = take_process(line);
  skip_blanks(line);
  if (const auto time = leading_time(line)) {
    call.time = time;
    line.remove_prefix(time->length);
  }
  constexpr std::string_view kResumed = "<... ";
  call.resumed = line.starts_with(kResumed);
  if (call.resumed) line.remove_prefix(kResumed.size());
  call.name = take_name(line);
  const std::string_view after = call.resumed ? " resumed>" : "(";
  if (call.name.empty() || !line.starts_with(after)) return {};
  call.rest = line.substr(after.size());
  return call;
}

/// A descriptor: `3`, `3</dev/ttyUSB0>`.
struct Descriptor {
  int number = -1;
  std::string path{};  ///< empty if the line does not say
};
std::optional<Descriptor> take_descriptor(std::string_view& rest) {
  const std::string_view from = rest;
  while (!rest.empty() && stl::is_digit(rest.front())) rest.remove_prefix(1);
  const auto number = parse_decimal<int>(from.substr(0, from.size() - rest.size()));
  if (!number) return {};
  Descriptor descriptor{.number = *number};
  if (rest.starts_with('<')) {
    const std::size_t end = rest.find('>');
    if (end == std::string_view::npos) return {};
    descriptor.path = rest.substr(1, end - 1);
    rest.remove_prefix(end + 1);
  }
  return descriptor;
}

/// The texts in quotation marks of a call's arguments, one after the other.
struct Literals {
  std::optional<Bytes> bytes = Bytes{};  ///< nothing: an escape in them is unknown
  bool cut = false;                      ///< `"\1\3"...`: strace printed the beginning only
  std::string_view rest{};               ///< after the last
};
Literals literals_of(std::string_view rest) {
  Literals found{.rest = rest};
  for (std::size_t begin = 0; (begin = found.rest.find('"')) != std::string_view::npos;) {
    std::size_t end = begin + 1;
    while (end < found.rest.size() && found.rest[end] != '"') end += found.rest[end] == '\\' ? 2U : 1U;
    if (end >= found.rest.size()) return {.bytes = {}, .rest = rest};
    const auto bytes = bytes_of_literal(found.rest.substr(begin + 1, end - begin - 1));
    if (!bytes) return {.bytes = {}, .rest = rest};
    found.bytes->insert(found.bytes->end(), bytes->begin(), bytes->end());
    found.rest.remove_prefix(end + 1);
    found.cut = found.cut || found.rest.starts_with("...");
  }
  return found;
}

/// The number after the `=` that ends a line; nothing if there is none, or an error, as in `-1 EAGAIN`.
std::optional<std::size_t> result_of(std::string_view rest) {
  const std::size_t equals = rest.rfind(" = ");
  if (equals == std::string_view::npos) return {};
  const std::string_view number = rest.substr(equals + 3);
  return parse_decimal<std::size_t>(number.substr(0, number.find_first_of(" <")));
}

/// The kind of a descriptor. Not every line of a trace tells it.
enum class Kind : std::uint8_t { Unknown, Line, Other };

Kind kind_of_path(std::string_view path) {
  const bool is_line = path.starts_with("/dev/") || path.starts_with("socket:") || path.starts_with("TCP");
  return is_line && path != "/dev/null" ? Kind::Line : Kind::Other;
}

/// Whether it is a standard descriptor, whose terminal is the user's; /dev/tty… is a line.
bool is_standard(const Descriptor& descriptor) {
  constexpr int kLastStandard = 2;
  return descriptor.number <= kLastStandard && !descriptor.path.starts_with("/dev/tty");
}

class StraceReader {
 public:
  void take(std::string_view line) {
    ++number_;
    if (stl::trim(line).empty()) return;
    const auto call = call_of(line);
    if (!call) return left_out_.without_bytes(number_);
    now_ = call->time ? std::optional(time_of(*call->time)) : std::nullopt;
    if (const Mover* const mover = find_mover(call->name))
      move(*call, *mover);
    else
      note_descriptor(*call);
  }

  Result<LineRecording> finish() {
    if (std::ranges::any_of(moved_, [](const Moved& each) { return each.kind == Kind::Line; }))
      std::erase_if(moved_, [](const Moved& each) { return each.kind != Kind::Line && each.descriptor != kNotKnown; });
    std::set<int> descriptors;
    bool known = false;
    for (const Moved& each : moved_) {
      if (each.descriptor == kNotKnown) continue;
      descriptors.insert(each.descriptor);
      known = each.kind == Kind::Line;
    }
    if (!known && descriptors.size() > 1)
      return trouble("it has calls of the descriptors {}; which of them is the line is not in it: trace with strace -y",
                     fmt::join(descriptors, ", "));
    add_frames();
    count_from_first(recording_);
    left_out_.tell(recording_);
    return std::move(recording_);
  }

 private:
  static constexpr int kNotKnown = -1;

  struct Moved {
    RecordedFrame frame{};
    int descriptor = 0;
    Kind kind = Kind::Unknown;
    std::size_t number = 0;  ///< of its line
    std::string doubt{};     ///< why it has no bytes
  };

  struct Unfinished {
    Descriptor descriptor;
    bool had_bytes = false;
  };

  Kind kind_of(const Descriptor& descriptor) const {
    if (is_standard(descriptor)) return Kind::Other;
    if (!descriptor.path.empty()) return kind_of_path(descriptor.path);
    const auto known = kinds_.find(descriptor.number);
    return known != kinds_.end() ? known->second : Kind::Unknown;
  }

  /// Notes the kind of a new descriptor: `openat(AT_FDCWD, "/dev/ttyUSB0", O_RDWR) = 3`, `socket(AF_INET, …) = 4`,
  /// `eventfd2(0, 0) = 5`.
  void note_descriptor(const Call& call) {
    const auto result = result_of(call.rest);
    if (!result) return;
    const int made = static_cast<int>(std::min<std::size_t>(*result, 1 << 30));
    if (call.name == "open" || call.name == "openat") {
      const auto path = literals_of(call.rest).bytes.value_or(Bytes{});
      kinds_[made] = kind_of_path(std::string(path.begin(), path.end()));
    } else if (call.name == "socket") {
      kinds_[made] = call.rest.starts_with("AF_INET") ? Kind::Line : Kind::Other;
    } else if (call.name.find("fd") != std::string_view::npos || call.name.starts_with("epoll_create") ||
               call.name.starts_with("inotify_init")) {
      kinds_[made] = Kind::Other;
    }
  }

  /// Reports that the descriptor of the bytes is not known.
  void not_read(std::string_view what) {
    moved_.push_back({.frame = {.at = now_}, .descriptor = kNotKnown, .number = number_, .doubt = not_understood(what)});
  }

  void move(const Call& call, const Mover& mover) {
    std::string_view rest = call.rest;
    Descriptor descriptor;
    if (call.resumed) {
      const auto begun = unfinished_.find(call.process);
      if (begun == unfinished_.end()) return not_read(call.name);
      const Unfinished unfinished = begun->second;
      unfinished_.erase(begun);
      if (unfinished.had_bytes) return;
      descriptor = unfinished.descriptor;
    } else if (const auto read = take_descriptor(rest)) {
      descriptor = *read;
    } else {
      return not_read(call.rest);
    }
    const Kind kind = kind_of(descriptor);
    if (kind == Kind::Other) return;
    const Literals literals = literals_of(rest);
    if (rest.find("<unfinished") != std::string_view::npos) {
      const bool has_bytes = mover.direction == Direction::Request && literals.bytes && !literals.bytes->empty();
      unfinished_[call.process] = {descriptor, has_bytes};
      if (!has_bytes) return;
    }
    add(call, mover, descriptor, kind, literals);
  }

  void add(const Call& call, const Mover& mover, const Descriptor& descriptor, Kind kind, const Literals& literals) {
    const auto result = result_of(literals.rest);
    const bool finished = literals.rest.find("<unfinished") == std::string_view::npos;
    if (finished && (!result || *result == 0)) return;  // an error, or the end of the file
    Moved moved{.descriptor = descriptor.number, .kind = kind, .number = number_};
    if (!literals.bytes)
      moved.doubt = not_understood(stl::trim(call.rest));
    else if (literals.cut || (finished && literals.bytes->size() < *result))
      moved.doubt = "strace printed the beginning of its bytes only; trace with -s 1000";
    else
      moved.frame.bytes = *literals.bytes;
    if (finished && result && moved.frame.bytes.size() > *result) moved.frame.bytes.resize(*result);
    moved.frame.direction = mover.direction;
    moved.frame.place = fmt::format("line {}", number_);
    moved.frame.at = now_;
    moved_.push_back(std::move(moved));
  }

  /// Seconds without a date are since 1970 with -ttt, and since the line before with -r.
  Time time_of(const LeadingTime& read) {
    constexpr Time kSince1970 = 100'000'000 * kSecond;
    if (read.of_day || read.time >= kSince1970) return days_.since_first_midnight(read);
    return since_start_ += read.time;
  }

  void add_frames() {
    for (Moved& each : moved_)
      recording_.frames.push_back(each.doubt.empty()
                                      ? std::move(each.frame)
                                      : row_not_read(each.number, each.doubt, each.frame.at, each.frame.direction));
  }

  LineRecording recording_;
  LeftOut left_out_;
  DayCounter days_;
  Time since_start_ = 0;
  std::optional<Time> now_;
  std::map<int, Kind> kinds_;
  std::map<std::string, Unfinished> unfinished_;  // of each process
  std::vector<Moved> moved_;
  std::size_t number_ = 0;
};

/// Whether a line is a call of strace with its result: `write(3, "` and its like.
bool is_of_strace(std::string_view line) {
  const auto call = call_of(line);
  if (!call || call->resumed || find_mover(call->name) == nullptr) return false;
  std::string_view rest = call->rest;
  return take_descriptor(rest) && rest.starts_with(", ") &&
         (line.find(" = ") != std::string_view::npos || line.find("<unfinished") != std::string_view::npos);
}

}  // namespace

bool looks_like_strace(std::string_view bytes) {
  return is_text(bytes) && std::ranges::any_of(Lines(beginning_of(bytes)), is_of_strace);
}

Result<LineRecording> read_strace(std::string_view bytes, const ReadingChoices& choices) {
  StraceReader reader;
  for (const std::string_view line : Lines(bytes, choices.stop)) reader.take(line);
  return reader.finish();
}

}  // namespace s7200::tools
