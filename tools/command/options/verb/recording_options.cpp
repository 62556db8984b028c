#include "tools/command/options/verb/recording_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>

#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/command/options/input.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/options/plc/line_options.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/files/files.hpp"
#include "tools/host/interruption.hpp"
#include "tools/master/protocol.hpp"
#include "tools/recordings/levels/samplerate.hpp"

namespace s7200::tools {

namespace {

/// The names of the protocols that have the option.
std::string protocols_with(std::string_view option) {
  std::vector<std::string_view> names;
  for (const RecordedProtocol& protocol : recorded_protocols())
    if (std::ranges::find(protocol.options, option, &ReaderOption::name) != protocol.options.end())
      names.push_back(protocol.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Those of all protocols. What several have means the same to each of them.
void add_reader_options(CLI::App& verb, std::map<std::string, std::string>& chosen) {
  for (const RecordedProtocol& protocol : recorded_protocols())
    for (const ReaderOption& option : protocol.options) {
      const std::string name(option.name);
      if (verb.get_option_no_throw(name) != nullptr) continue;
      verb.add_option_function<std::string>(
              name, [&chosen, name](const std::string& word) { chosen[name] = word; },
              fmt::format("of {}: {}", protocols_with(name), option.meaning))
          ->check(CLI::IsMember(std::vector<std::string>(option.words.begin(), option.words.end())))
          ->default_str(std::string(option.words.front()))
          ->type_name(std::string(option.value));
    }
}

}  // namespace

void RecordingOptions::add_to(CLI::App& verb) {
  std::vector<std::string> names;
  for (const RecordedProtocol& each : recorded_protocols()) names.emplace_back(each.name);
  verb.add_option("FILE", file,
                  "a recording (s7200 help recordings); - is standard input; or a line: a device, tcp://HOST:PORT")
      ->required();
  verb.add_option("--protocol", protocol, "what was spoken")
      ->check(CLI::IsMember(names))
      ->capture_default_str()
      ->type_name("NAME")
      ->group(help_group::kLine);
  add_reader_options(verb, chosen);
  add_line_options(verb, line, "as the protocol has it");
  for_files_.push_back(verb.add_option("--stamps", stamps, "which instant of a frame its time is, in a recording")
                           ->check(CLI::IsMember({"begin", "end"}))
                           ->capture_default_str()
                           ->type_name("WHICH"));
  add_duration(verb, "--gap", reading.gap,
               fmt::format("silence that ends a frame, in recordings with a character in each row, {} without it, and of a "
                           "line, 20 ms",
                           format_duration(kCharacterGap)),
               {1, kLongestDuration});
  timeout_ = add_duration(
      verb, "--timeout", timeout,
      fmt::format("of the master: the same frame after a longer silence is the request repeated, not its echo [{}]",
                  format_duration(kMasterTimeout)));
  add_whole_number(verb, "--tcp-port", reading.tcp_port, {1, 65'535}, "of the Modbus TCP server, in a recording", "502");
  for_files_.push_back(verb.get_option("--tcp-port"));
  for_files_.push_back(verb.add_flag("--mbpoll-0", reading.mbpoll_from_zero,
                                     "mbpoll had its option -0: the references that it printed count from 0"));
  for_files_.push_back(verb.add_option_function<std::string>(
                               "--samplerate",
                               [this](const std::string& text) {
                                 const auto rate = samplerate_of(text);
                                 if (!rate)
                                   throw CLI::ValidationError(
                                       "--samplerate", fmt::format("'{}' is not a rate such as 1MHz", stl::shortened(text)));
                                 reading.samplerate = *rate;
                               },
                               "of a recording that counts samples and does not say how many there are in a second")
                           ->type_name("RATE"));
  for_lines_.push_back(add_duration(verb, "--for", duration, "how long to listen to a line [until Ctrl-C]"));
  for (const char* often : {"--timeout", "--for"}) verb.get_option(often)->group(help_group::kLine);
}

std::optional<SlaveTarget> RecordingOptions::live() const {
  SlaveTarget target = parse_slave_target(file);
  const auto refuse = [](const std::vector<CLI::Option*>& options, const char* need) {
    for (const CLI::Option* option : options)
      if (option->count() > 0) throw std::invalid_argument(fmt::format("{} needs {}", option->get_name(), need));
  };
  switch (target.kind) {
    case SlaveTarget::Kind::Program:
    case SlaveTarget::Kind::System:
      refuse(for_lines_, "a line to listen to");
      return {};
    case SlaveTarget::Kind::Device:
    case SlaveTarget::Kind::Tcp:
      refuse(for_files_, "a recording");
      return target;
    case SlaveTarget::Kind::ModbusTcp:
    case SlaveTarget::Kind::Peer:
      break;
  }
  throw std::invalid_argument(
      fmt::format("{}: nothing is said there unless it is asked; listen to a serial device or tcp://HOST:PORT, or ask it "
                  "with 's7200 master'",
                  stl::shortened(file)));
}

bool RecordingOptions::has_timeout() const { return timeout_->count() > 0; }

bool RecordingOptions::was_cut_short() const { return (duration != kNever || !live()) && interrupted(); }

RecordedProtocol RecordingOptions::spoken() const {
  RecordedProtocol spoken = *find_recorded_protocol(protocol);
  for (const auto& [option, word] : chosen)
    if (!spoken.choose(option, word))
      throw std::invalid_argument(
          fmt::format("{} {}: {} has no such option; it is for {}", option, word, protocol, protocols_with(option)));
  return spoken;
}

Stamps RecordingOptions::complete(Stamps known) const {
  known.timeout = timeout;
  return known;
}

SerialFormat RecordingOptions::format() const {
  const Protocol* const master = find_protocol(protocol);
  return line.over(master != nullptr ? master->format : SerialFormat{});
}

std::string ReadRecording::silences_text() const {
  return line ? fmt::format("silences are those of a line with {}", format_text(*line)) : "";
}

std::unique_ptr<LineListener> open_line(const RecordingOptions& options, const SlaveTarget& line) {
  catch_interruption();
  try {
    auto listener = std::make_unique<LineListener>(line, options.format(), options.reading.gap);
    fmt::print(stderr, "listening to {}\n", stl::printable(listener->name()));
    return listener;
  } catch (const SlaveUnreachable& error) {
    return print_error(error.what()), nullptr;
  }
}

bool listen(LineListener& line, const RecordingOptions& options, const std::function<void(ReadFrame)>& tell) {
  const RecordedProtocol spoken = options.spoken();
  Conversation conversation(spoken, options.complete(line.stamps()));
  try {
    line.listen(options.duration, conversation, tell);
    return true;
  } catch (const SlaveLost& error) {
    return print_error(error.what()), false;
  }
}

std::optional<ReadRecording> read_file(const RecordingOptions& options) {
  ReadRecording read;
  catch_interruption();
  const auto bytes = read_input(options.file, read.name);
  if (interrupted()) return read;
  if (!bytes) return {};
  ReadingChoices choices = options.reading;
  choices.line = options.line;
  choices.usual = options.format();
  choices.stop = interruption();
  auto recording = read_recording(*bytes, choices);
  if (!recording && interrupted()) return read;
  if (!recording) return print_error(fmt::format("{}: {}", read.name, recording.why())), std::nullopt;
  read.recording = std::move(*recording);
  const bool over_tcp = read.recording.over_tcp;
  const SerialFormat format = read.recording.line.value_or(choices.usual);
  read.stamps = options.complete({.character = over_tcp ? 0 : format.character_time(), .at_end = options.stamps == "end"});
  const bool faster = is_faster_than_said(read.recording, read.stamps);
  read.stamps.exact = !read.recording.is_log && !over_tcp && !faster;
  const bool says_no_direction = std::ranges::any_of(
      read.recording.frames, [](const RecordedFrame& frame) { return frame.direction == Direction::Unknown; });
  if (const auto stated = read.recording.timeout; stated && says_no_direction && !options.has_timeout()) {
    read.stamps.timeout = *stated;
    read.recording.notes.push_back(
        fmt::format("it says a time-out of {}: the same frame after a longer silence is the request repeated, not its echo",
                    format_duration(*stated)));
  }
  settle_directions(read.recording, options.spoken(), read.stamps);
  print_notes(read.recording.notes);
  const bool has_times = std::ranges::any_of(read.recording.frames, [](const auto& frame) { return frame.at.has_value(); });
  if (!over_tcp && has_times) read.line = format;
  if (faster)
    print_note(
        fmt::format("most frames begin before the one before can be over at {} baud: name the rate of the line with "
                    "--baud, or silences are wrong",
                    format.baud));
  return read;
}

void tell_frames(const ReadRecording& read, const RecordingOptions& options, const std::function<void(ReadFrame&)>& tell) {
  ConversationNotes notes;
  RightFrames right;
  const RecordedProtocol spoken = options.spoken();
  tell_conversation(read.recording, spoken, read.stamps, [&](ReadFrame& frame) {
    notes.add(frame);
    right.add(frame);
    tell(frame);
    return !interrupted();
  });
  print_notes(notes.list());
  if (interrupted()) return;
  if (const RecordedProtocol* other = likelier_protocol(read.recording, spoken, right, read.stamps))
    print_note(fmt::format("hardly a frame is right; it looks like {0}: --protocol {0}", other->name));
}

std::optional<ReadRecording> read_conversation(const RecordingOptions& options) {
  const auto target = options.live();
  auto read = target ? std::optional(ReadRecording{}) : read_file(options);
  if (!read) return {};
  const auto keep = [&](ReadFrame&& frame) {
    if (frame.other) read->frames[*frame.other].other = read->frames.size();
    read->frames.push_back(std::move(frame));
  };
  if (!target) return tell_frames(*read, options, [&](ReadFrame& frame) { keep(std::move(frame)); }), read;
  const auto line = open_line(options, *target);
  if (!line) return {};
  read->name = line->name();
  read->stamps = options.complete(line->stamps());
  if (!listen(*line, options, keep)) return {};
  return read;
}

}  // namespace s7200::tools
