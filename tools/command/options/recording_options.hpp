// What `decode` and `import-capture` read, and what the recording itself does not say.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/serial_format.hpp"
#include "tools/recordings/conversation.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

struct RecordingOptions {
  std::string file;
  std::string protocol = "modbus";
  ReadingChoices reading{};
  SerialFormat format{};  ///< of the line
  std::string stamps = "begin";

  void add_to(CLI::App& verb);
};

/// A recording with what it says.
struct ReadRecording {
  LineRecording recording;
  std::vector<ReadFrame> frames;  ///< of the recording
  Stamps stamps;
  std::string name;  ///< what messages call the file
};

/// Nothing after a message. Notes are printed.
std::optional<ReadRecording> read_conversation(const RecordingOptions& options);

}  // namespace s7200::tools
