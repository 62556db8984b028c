#include "tools/recordings/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interpreter/base/text/text.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/program/loading/dialect.hpp"
#include "interpreter/stl/text/encoding.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/left_out.hpp"
#include "tools/recordings/logs/rewritten.hpp"
#include "tools/recordings/logs/two_loggers.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/rows/markup.hpp"
#include "tools/recordings/stated.hpp"

namespace s7200::tools {
namespace {

/// The first that a file looks like is the one that it is read as.
constexpr std::array kForms{
    RecordingForm{
        "pcap",
        "pcap of a serial line, as --capture writes it (link types 147 to 162), of an RTAC (250), of a USB adapter "
        "(189, 220, 249: FTDI, CP210x, CH340, PL2303, CDC-ACM), of Modbus TCP, or of Modbus RTU in TCP",
        false, looks_like_pcap, read_pcap},
    RecordingForm{"VCD", "VCD with the levels of a line, as --capture and logic analysers write it", false, looks_like_vcd,
                  read_vcd},
    RecordingForm{".sr", "sessions of sigrok and PulseView with its levels", false, looks_like_sigrok_session,
                  read_sigrok_session, true},
    RecordingForm{"bits", "the samples that sigrok-cli prints by itself, and with -O bits", false, looks_like_sigrok_bits,
                  read_sigrok_bits, true},
    RecordingForm{"levels", "CSV of levels: sigrok-cli -O csv, PulseView, DSView, raw data of Saleae Logic", false,
                  looks_like_levels_table, read_levels_table, true},
    RecordingForm{"volts", "CSV of an oscilloscope: times and the volts of each channel, four samples or more in each bit",
                  false, looks_like_volts_table, read_volts_table},
    RecordingForm{"DSView", "the decoder list that DSView exports", true, looks_like_dsview, read_dsview},
    RecordingForm{"sigrok",
                  "what sigrok-cli -A uart prints, with --protocol-decoder-samplenum it says where frames end, and the "
                  "annotations that PulseView exports",
                  true, looks_like_sigrok_annotations, read_sigrok_annotations, true},
    RecordingForm{"tcpdump", "what tcpdump -x or -X prints of Modbus TCP", false, looks_like_tcpdump, read_tcpdump},
    RecordingForm{"tshark", "what tshark -x, or -P -x with times, prints of Modbus TCP", false, looks_like_tshark,
                  read_tshark},
    RecordingForm{"followed", "a TCP stream that Wireshark follows, saved as hex dump, C arrays or YAML", true,
                  looks_like_followed_stream, read_followed_stream},
    RecordingForm{"strace", "what strace prints of a program's reads and writes", true, looks_like_strace, read_strace},
    RecordingForm{"ESPHome", "what ESPHome logs with uart: debug:", true, looks_like_esphome, read_esphome},
    RecordingForm{"ESPHome modbus", "what ESPHome's component modbus logs: Modbus write, Modbus received Byte", true,
                  looks_like_esphome_modbus, read_esphome_modbus},
    RecordingForm{"eModbus", "what eModbus logs, with its dumps", true, looks_like_emodbus, read_emodbus},
    RecordingForm{"Tasmota", "a log of Tasmota with SerialSend5 and SerialReceived", true, looks_like_tasmota, read_tasmota},
    RecordingForm{"YAML",
                  "YAML with a map for each frame or exchange, in block or flow style: - {dir: tx, data: [0x01, 0x03]}",
                  true, looks_like_yaml_records, read_yaml_records},
    RecordingForm{"JSON",
                  "JSON, an object with bytes in each line: time, direction, data in hex, numbers or base64; packets of "
                  "tshark -T json",
                  true, looks_like_json_lines, read_json_lines},
    RecordingForm{"key=value", "key=value pairs in each line: time=… dir=tx data=…", true, looks_like_key_values,
                  read_key_values},
    RecordingForm{"mbpoll", "what mbpoll and other programs with libmodbus print; without -v mbpoll has values only", true,
                  looks_like_libmodbus, read_libmodbus},
    RecordingForm{"pymodbus", "what pymodbus logs at the level DEBUG", true, looks_like_pymodbus, read_pymodbus},
    RecordingForm{"pyserial", "what pyserial prints of a port spy://", true, looks_like_pyserial, read_pyserial},
    RecordingForm{"Python", "logs with bytes as Python shows them: b'\\x01\\x03', '\\x01\\x03', as of Home Assistant", true,
                  looks_like_python_bytes, read_python_bytes},
    RecordingForm{"CSV",
                  "CSV with a frame or a character in each row, as Saleae Logic 1 and 2 export it in any of their notations",
                  true, looks_like_csv, read_csv},
    RecordingForm{"characters", "text logs with the characters themselves: ?W<CR><LF>, \"?W\\r\\n\"", true,
                  looks_like_character_log, read_character_log},
    RecordingForm{"dump", "dumps of recorded bytes: xxd, hexdump, od with -t x1, x2, o1, o2; without times", true,
                  looks_like_dump, read_dump},
    RecordingForm{"text", "text logs with a frame or a character in each line", true, is_text, read_text_log},
};

void note_times_that_run_backwards(LineRecording& recording) {
  std::optional<Time> last;
  for (const RecordedFrame& frame : recording.frames) {
    if (frame.at && last && *frame.at < *last) {
      recording.notes.push_back(
          fmt::format("{}: its time is before that of the frame above it; no silence is known there", frame.place));
      return;
    }
    if (frame.at) last = frame.at;
  }
}

/// Takes what a log says of its line in words, as far as the user gives nothing else, with a note.
void take_stated_line(LineRecording& recording, std::string_view bytes, const ReadingChoices& choices) {
  const bool has_times =
      std::ranges::any_of(recording.frames, [](const RecordedFrame& frame) { return frame.at.has_value(); });
  if (recording.line || recording.over_tcp || !has_times) return;
  const StatedLine stated = stated_line(bytes);
  recording.timeout = stated.timeout;
  if (stated.number == 0) return;
  const auto note = [&](std::string_view said, std::string_view counts) {
    recording.notes.push_back(fmt::format("line {}: it says {}: {}", stated.number, said, counts));
  };
  if (stated.is_contradictory) return note("one rate, and other lines another", "--baud says which it is");
  const SerialFormat said = stated.line.over(choices.usual), taken = choices.line.over(said);
  recording.line = taken;
  if (taken == said && said != choices.usual) note(format_text(said), "silences are those of such a line");
  if (taken != said)
    note(format_text(said), fmt::format("silences are those of {}, as the options say", format_text(taken)));
}

/// The mark of UTF-16 that a file lacks: every other byte of ASCII in it is 00. Empty: it lacks none.
std::string_view missing_mark(std::string_view file) {
  constexpr std::size_t kFewest = 4;
  const std::string_view beginning = beginning_of(file);
  if (beginning.size() < 2 * kFewest || beginning.find('\0') > 1) return "";
  std::array<std::size_t, 2> zeros{};
  for (std::size_t i = 0; i < beginning.size(); ++i) zeros[i % 2] += beginning[i] == '\0';
  const std::size_t most = beginning.size() / 2 - beginning.size() / 20;
  if (zeros[0] == 0 && zeros[1] >= most) return "\xFF\xFE";
  return zeros[1] == 0 && zeros[0] >= most ? "\xFE\xFF" : "";
}

/// Logs that Windows programs write as UTF-16, with its mark or without, or in an encoding with two bytes for a sign, as
/// UTF-8; any other file as it is: its bytes may be recorded characters. `decoded` keeps what is converted.
std::string_view in_utf8(std::string_view file, std::string& decoded) {
  const std::string_view mark = missing_mark(file);
  const bool marked = file.starts_with("\xFF\xFE") || file.starts_with("\xFE\xFF");
  const std::string_view beginning = beginning_of(file);
  std::optional<stl::DecodedText> text;
  if (!mark.empty())
    text = stl::decode(std::string(mark).append(file)).if_any();
  else if (marked)
    text = stl::decode(file).if_any();
  else if (const auto guess = stl::is_valid_utf8(beginning) ? std::nullopt : stl::decode(beginning);
           guess && (guess->encoding == "GBK" || guess->encoding == "Shift-JIS") && !looks_like_character_log(file))
    text = stl::decode(file).if_any();
  if (!text) return stl::without_byte_order_mark(file);
  return decoded = std::move(text->text);
}

/// Whether signs beyond ASCII stand in words. One by itself is a damaged character.
bool has_words_beyond_ascii(std::string_view text) {
  const auto is_beyond = [](char c) { return (c & 0x80) != 0; };
  const auto is_of_word = [&](char c) { return stl::is_letter(c) || is_beyond(c); };
  return std::ranges::adjacent_find(text, [&](char a, char b) {
           return (is_beyond(a) && is_of_word(b)) || (is_of_word(a) && is_beyond(b));
         }) != text.end();
}

/// A text log in UTF-8, whatever its encoding. `decoded` keeps what is converted.
std::string_view log_in_utf8(std::string_view bytes, std::string& decoded) {
  const std::string_view beginning = beginning_of(bytes);
  if (stl::is_valid_utf8(beginning) || !has_words_beyond_ascii(beginning)) return bytes;
  auto text = stl::decode(bytes);
  return text ? decoded = std::move(text->text) : bytes;
}

constexpr std::string_view kIsOfStep7 =
    "it is a block of STEP 7 for the S7-300 and S7-400, neither a recording nor STL of the S7-200";
constexpr std::string_view kIsProgram = "it is a program in STL, not a recording; s7200 check reads it, s7200 run runs it";

/// A mnemonic with an operand, or one that cannot be hex; or the heading of a network or a block.
bool is_statement(const std::vector<std::string>& words) {
  const std::string first = stl::upper_case(words.front());
  if (words.size() <= 2 && (first == "NETWORK" || first.ends_with("_BLOCK"))) return true;
  const bool may_be_hex = first.find_first_not_of("0123456789ABCDEF") == std::string::npos;
  const bool has_operand = words.size() > 1 && std::ranges::any_of(words[1], stl::is_digit);
  return find_instruction(first) != nullptr && (words.size() == 1 ? !may_be_hex : has_operand);
}

/// Whether most of its lines are statements.
bool is_stl_program(std::string_view bytes) {
  std::size_t statements = 0, others = 0;
  for (const std::string_view line : Lines(beginning_of(bytes))) {
    const std::vector<std::string> words = stl::split_words(line);
    if (words.empty() || words.front().starts_with("//")) continue;
    (is_statement(words) ? statements : others) += 1;
  }
  return statements > others;
}

/// Whether a file is a recording of a CAN bus: of candump, `(1.5) can0 601#2B40` or `can0  601   [4]  2B 40`, or of CANoe,
/// whose head says how identifiers are written.
bool is_of_can(std::string_view bytes) {
  constexpr std::size_t kHead = 10;
  std::size_t number = 0;
  for (const std::string_view line : Lines(beginning_of(bytes))) {
    if (++number > kHead) return false;
    const std::vector<std::string> words = stl::split_words(line);
    if (words.size() > 2 && words[0] == "base" && words[2] == "timestamps") return true;
    const auto is_bus = [](std::string_view word) { return word.starts_with("can") || word.starts_with("vcan"); };
    const auto bus = std::ranges::find_if(words, is_bus);
    if (words.end() - bus < 2 || bus - words.begin() > 1) continue;
    if (bus[1].find('#') != std::string::npos || (words.end() - bus > 2 && bus[2].starts_with('['))) return true;
  }
  return false;
}

/// Whether a text is XML: a declaration, or an element around it all.
bool is_xml(std::string_view bytes) {
  if (!bytes.starts_with('<')) return false;
  if (bytes.starts_with("<?xml")) return true;
  const std::string_view text = bytes.substr(0, bytes.find_last_not_of(" \t\r\n") + 1);
  const std::size_t end = std::min(text.find_first_of(" >\r\n"), text.size());
  return end > 1 && stl::is_letter(text[1]) && text.ends_with(fmt::format("</{}>", text.substr(1, end - 1)));
}

/// A binary file that is no capture, by its first bytes, and what to do.
struct Binary {
  std::string_view begin, why;
};
constexpr std::array kBinaries{
    Binary{"\x1F\x8B", "it is compressed with gzip: gunzip it first"},
    Binary{"BZh", "it is compressed with bzip2: bunzip2 it first"},
    Binary{"\xFD"
           "7zXZ",
           "it is compressed with xz: unxz it first"},
    Binary{"\x28\xB5\x2F\xFD", "it is compressed with zstd: unzstd it first"},
    Binary{"RIFF", "it is sound, not levels; record the line with a logic analyser, or with a serial port"},
};

/// A text that is no recording of a line, and what to say of it.
struct OtherText {
  bool (*is_it)(std::string_view bytes);
  std::string_view why;
};
constexpr std::array kOtherTexts{
    OtherText{begins_as_step7, kIsOfStep7},
    OtherText{is_stl_program, kIsProgram},
    OtherText{is_of_can, "it is a recording of a CAN bus, not of a serial line"},
    OtherText{is_xml, "it is XML; write a line for each frame, with its time, its direction and its bytes in hex"},
};

}  // namespace

std::span<const RecordingForm> recording_forms() { return kForms; }

bool is_text(std::string_view bytes) { return bytes.find('\0') == std::string_view::npos; }

Result<LineRecording> read_recording(std::string_view file, const ReadingChoices& choices) {
  std::string decoded;
  std::string_view bytes = in_utf8(file, decoded);
  const auto rows = in_plain_rows(bytes);
  if (rows) bytes = *rows;
  const auto plain = without_markup(bytes);
  if (plain) bytes = plain->text;
  const auto form = std::ranges::find_if(kForms, [&](const RecordingForm& each) { return each.looks_like(bytes); });
  if (form == kForms.end()) {
    const auto packed = std::ranges::find_if(kBinaries, [&](const Binary& each) { return bytes.starts_with(each.begin); });
    return Trouble{
        packed != kBinaries.end()
            ? std::string(packed->why)
            : "it is binary, and not a capture that decode knows; for recorded bytes alone, decode what xxd prints of it"};
  }
  if (bytes.find_first_not_of(" \t\r\n") == std::string_view::npos) return Trouble{"the file is empty"};
  const auto other = std::ranges::find_if(kOtherTexts, [&](const OtherText& each) { return each.is_it(bytes); });
  const auto refuse = [&](std::string_view reason) {
    const std::string_view product = why_other_product(bytes);
    return Trouble{std::string(product.empty() ? reason : product)};
  };
  if (form->looks_like == is_text && other != kOtherTexts.end()) return refuse(other->why);
  std::string in_other_encoding;
  if (form->looks_like == is_text) bytes = log_in_utf8(bytes, in_other_encoding);
  auto recording = form->read(bytes, choices);
  if (!recording) return recording.trouble();
  recording->form = form->name;
  recording->is_log |= form->is_log;
  if (form->looks_like == is_text) keep_one_logger(*recording, bytes);
  name_rows_not_read(*recording);
  if (plain && !plain->note.empty()) recording->notes.push_back(plain->note);
  if (form->is_log) read_modbus_tcp(*recording);
  recording->over_tcp = std::ranges::any_of(recording->frames, [](const RecordedFrame& frame) { return frame.stream != 0; });
  note_times_that_run_backwards(*recording);
  if (is_text(bytes)) take_stated_line(*recording, bytes, choices);
  if (choices.samplerate != 0 && !form->counts_samples)
    recording->notes.emplace_back("--samplerate is not used: it does not count samples");
  const bool table = form->looks_like == is_text && is_table_without_bytes(bytes);
  const bool without_bytes = std::ranges::all_of(recording->frames, [](const RecordedFrame& frame) {
    return frame.doubt && frame.bytes.empty() && frame.doubt->readings.empty();
  });
  constexpr std::size_t kFewestBytes = 6;  // ten digits, the most of a double word, are five
  const bool one_value_each =              // `10:00:00,21,35` below `time,temp,pressure`
      std::ranges::all_of(recording->frames, [](const RecordedFrame& frame) { return frame.bytes.size() < kFewestBytes; });
  if (without_bytes || (table && one_value_each)) {
    std::string reason = table ? "no column found for the bytes: name it Hex" : "no frames found";
    for (const std::string& note : recording->notes) reason += "; " + note;
    return refuse(reason);
  }
  return recording;
}

}  // namespace s7200::tools
