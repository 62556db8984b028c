// What `decode` and `import-capture` read, and what the recording itself does not say.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/serial_format.hpp"
#include "serial_sim/line/line_settings.hpp"
#include "tools/command/reading/line_listener.hpp"
#include "tools/recordings/conversation.hpp"
#include "tools/slave/slave_target.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace s7200::tools {

struct RecordingOptions {
  std::string file;  ///< or a device, or an address
  std::string protocol = "modbus";
  ReadingChoices reading{};
  serial::LineSettings line{};
  std::map<std::string, std::string> chosen{};  ///< words of options that only some protocols have, by their names
  std::string stamps = "begin";
  Time timeout = kMasterTimeout;  ///< of the master
  Time duration = kNever;         ///< of what is heard live

  void add_to(CLI::App& verb);

  /// A line to listen to; nothing if a file is to be read. Throws std::invalid_argument for another kind of target, and for
  /// options that do not go with what it is.
  std::optional<SlaveTarget> live() const;

  /// Throws std::invalid_argument if the protocol has no such choice.
  RecordedProtocol spoken() const;

  /// Whether what ends by itself, with --for, was interrupted before that.
  bool was_cut_short() const;

  /// With the master's time-out.
  Stamps complete(Stamps known) const;

  /// Of the line: as the protocol has it where no option says otherwise.
  SerialFormat format() const;

  bool has_timeout() const;  ///< the user gives one

 private:
  std::vector<CLI::Option*> for_files_, for_lines_;
  CLI::Option* timeout_ = nullptr;
};

/// A recording with what it says.
struct ReadRecording {
  LineRecording recording;
  std::vector<ReadFrame> frames{};  ///< of the recording, or heard live
  Stamps stamps;
  std::string name;                    ///< what messages call the file
  std::optional<SerialFormat> line{};  ///< that the silences of a file are those of, if they are those of a serial line

  /// `silences are those of a line with 9600 baud, 8 data bits, even parity, 1 stop bit`; empty if there is none.
  std::string silences_text() const;
  /// The same as a line of a scenario.
  std::string silences_comment() const { return line ? "# Its " + silences_text() + ".\n" : ""; }
};

/// Says on standard error that it listens. Null after another message. Interruptions are noted from here on.
std::unique_ptr<LineListener> open_line(const RecordingOptions& options, const SlaveTarget& line);

/// Listens as the options say, and tells each frame. Ends by an interruption or after `duration`. False after a message: the
/// line is gone.
bool listen(LineListener& line, const RecordingOptions& options, const std::function<void(ReadFrame)>& tell);

/// What the help says of how listening ends.
inline constexpr std::string_view kEndOfListening =
    "Exit code 1 if --for was interrupted before its end; without it a line is listened to until Ctrl-C or "
    "SIGTERM, and that is 0.\n";

/// A file without its frames, which tell_frames() has. Nothing after a message; nothing is in it if an interruption came
/// while it was read. Notes are printed. Interruptions are noted from here on.
std::optional<ReadRecording> read_file(const RecordingOptions& options);

/// Tells each frame of a file, as long as there is no interruption, then prints notes on all of them.
void tell_frames(const ReadRecording& read, const RecordingOptions& options, const std::function<void(ReadFrame&)>& tell);

/// With all frames, of a file or of a line. Nothing after a message. Notes are printed.
std::optional<ReadRecording> read_conversation(const RecordingOptions& options);

}  // namespace s7200::tools
