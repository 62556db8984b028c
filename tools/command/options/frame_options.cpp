#include "tools/command/options/frame_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

#include "interpreter/base/text/text.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/host/files/files.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

/// A line of a file of frames, without its end.
std::string without_comment(const std::string& line) {
  const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
  const std::size_t quotation = quotation_length(std::string_view(line).substr(begin));
  if (quotation == std::string_view::npos) return line;
  return line.substr(0, std::min(line.find('#', begin + quotation), line.find('\r', begin + quotation)));
}

bool is_crc(std::string_view word) { return stl::lower_case(word) == "crc"; }

/// Other verbs take the files of a project one after the other; here frames follow the PROGRAM.
bool names_a_file(const std::string& word) { return word.find('.') != std::string::npos && host_files().exists(word); }

/// A frame in hex; `crc` as its last word appends the Modbus CRC, as in the debugger.
serial::ParsedFrame parse_hex_with_crc(std::string_view text) {
  const std::string_view whole = stl::trim(text);
  const std::size_t last = whole.find_last_of(" \t");
  const bool crc = last != whole.npos && is_crc(whole.substr(last + 1));
  serial::ParsedFrame parsed = serial::parse_hex_frame(crc ? whole.substr(0, last) : text);
  if (crc && parsed.ok()) modbus::append_crc(parsed.frame);
  if (parsed.ok()) return parsed;
  std::string& message = parsed.errors[0].message;
  if (is_crc(whole)) message = "crc is the last word of a frame, which stands in quotes: '01 03 00 0a 00 02 crc'";
  if (whole.starts_with(':')) message += R"(; a frame of Modbus ASCII is text: --text ':0103000A0002F0\r\n')";
  if (whole == "read" || whole == "write" || whole.starts_with("read ") || whole.starts_with("write "))
    message += "; 's7200 master' asks with read and write";
  return parsed;
}

}  // namespace

void FrameOptions::add_to(CLI::App& app) {
  app_ = &app;
  hex_ =
      app.add_option("HEX", frames_,
                     "frames in hex, each in quotes if it has blanks: '01 03 …'; p after a byte sends it with wrong parity");
  text_ = app.add_option("--text", texts_, "frame of ASCII text, with \\r \\n \\t \\\\ \\' \\\" and \\xHH (repeatable)")
              ->type_name("TEXT")
              ->allow_extra_args(false)
              ->group(help_group::kRequests);
  app.add_option("--frames", file_, "file with one frame a line, in hex, or as text in quotation marks; # begins a comment")
      ->type_name("FILE")
      ->group(help_group::kRequests);
  app.add_flag("--crc", crc_, "append the Modbus CRC to each frame")->group(help_group::kRequests);
}

Result<std::vector<serial::Frame>> FrameOptions::read() const {
  struct Written {
    std::string text, place;
    serial::ParsedFrame (*parse)(std::string_view);
  };
  std::vector<Written> written;
  auto frame = frames_.begin(), text = texts_.begin();
  for (const CLI::Option* option : app_->parse_order()) {
    if (option != hex_ && option != text_) continue;
    const bool is_text = option == text_;
    const std::string& next = is_text ? *text++ : *frame++;
    if (!is_text && names_a_file(next))
      return trouble("'{}' is a file, and a frame in hex is expected here; {}", next, how_to_give(next));
    written.push_back({next, fmt::format("{} '{}'", is_text ? "--text" : "frame", stl::shortened(next)),
                       is_text ? parse_text : parse_hex_with_crc});
  }
  if (!file_.empty()) {
    const auto bytes = read_text(file_);
    if (!bytes) return trouble("cannot read {}: {}", file_, bytes.why());
    std::istringstream lines(*bytes);
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
      ++number;
      line = without_comment(line);
      if (line.find_first_not_of(" \t") != std::string::npos)
        written.push_back({line, fmt::format("{}:{}", file_, number), parse_hex_or_quoted});
    }
  }
  if (written.empty()) return Trouble{"no frame to send: give frames in hex, --text, or --frames FILE"};
  std::vector<serial::Frame> frames;
  for (const Written& w : written) {
    serial::ParsedFrame parsed = w.parse(w.text);
    if (!parsed.ok()) return trouble("{}: column {}: {}", w.place, parsed.errors[0].column, parsed.errors[0].message);
    if (crc_) modbus::append_crc(parsed.frame);
    frames.push_back(std::move(parsed.frame));
  }
  return frames;
}

}  // namespace s7200::tools
