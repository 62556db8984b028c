#include "tools/command/options/recording_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/command/options/input.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/terminal.hpp"

namespace s7200::tools {

void RecordingOptions::add_to(CLI::App& verb) {
  std::vector<std::string> names;
  for (const RecordedProtocol& each : recorded_protocols()) names.emplace_back(each.name);
  verb.add_option("FILE", file,
                  "pcap (serial, or Modbus TCP), CSV, or a text log with a frame in each line; - is standard input")
      ->required();
  verb.add_option("--protocol", protocol, "what was spoken")
      ->check(CLI::IsMember(names))
      ->capture_default_str()
      ->type_name("NAME");
  add_whole_number(verb, "--baud", format.baud, {300, 115'200}, "of a serial line, for latencies", "9600");
  verb.add_option("--stamps", stamps, "which instant of a frame its time is")
      ->check(CLI::IsMember({"begin", "end"}))
      ->capture_default_str()
      ->type_name("WHICH");
  add_duration(verb, "--gap", reading.gap,
               "silence that ends a frame, in recordings with a character in each row; 5ms without it",
               {1, kLongestDuration});
  add_whole_number(verb, "--tcp-port", reading.tcp_port, {1, 65'535}, "of the Modbus TCP server", "502");
}

std::optional<ReadRecording> read_conversation(const RecordingOptions& options) {
  ReadRecording read;
  const auto bytes = read_input(options.file, read.name);
  if (!bytes) return {};
  std::string why;
  auto recording = read_recording(*bytes, options.reading, why);
  if (!recording) return print_error(fmt::format("{}: {}", read.name, why)), std::nullopt;
  print_notes(recording->notes);
  read.recording = std::move(*recording);
  const bool over_tcp =
      std::ranges::any_of(read.recording.frames, [](const RecordedFrame& frame) { return frame.stream != 0; });
  read.stamps = {.character = over_tcp ? 0 : options.format.character_time(), .at_end = options.stamps == "end"};
  read.frames = conversation(read.recording, *find_recorded_protocol(options.protocol));
  return read;
}

}  // namespace s7200::tools
