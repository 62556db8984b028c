// The readers of each form of recording. What they read may have no frame.
#pragma once

#include "interpreter/base/result.hpp"
#include "tools/recordings/recording.hpp"

namespace s7200::tools {

/// Whether the bytes are a text: there is no byte 00 among them.
bool is_text(std::string_view bytes);

/// The part of a text by which its form is recognised.
inline std::string_view beginning_of(std::string_view bytes) { return bytes.substr(0, std::size_t{1} << 16); }

/// Recognises a capture by its first four bytes: pcap in microseconds and nanoseconds, in either order of bytes, and pcapng.
bool looks_like_pcap(std::string_view bytes);
Result<LineRecording> read_pcap(std::string_view bytes, const ReadingChoices& choices);

/// Whether a text begins with a row that names its columns.
bool looks_like_csv(std::string_view bytes);
Result<LineRecording> read_csv(std::string_view bytes, const ReadingChoices& choices);
/// Whether a text has a heading for its times, and no column with bytes.
bool is_table_without_bytes(std::string_view bytes);

/// Recognises libmodbus by a line that names mbpoll, or by a line that is a frame in brackets.
bool looks_like_libmodbus(std::string_view bytes);
Result<LineRecording> read_libmodbus(std::string_view bytes, const ReadingChoices& choices);

/// The frames of the reads whose values mbpoll printed.
void read_values_of_mbpoll(std::string_view bytes, const ReadingChoices& choices, LineRecording& recording);

/// Recognises pymodbus by a line of its own about bytes that are on their way; lines that repeat the bytes do not count.
bool looks_like_pymodbus(std::string_view bytes);
Result<LineRecording> read_pymodbus(std::string_view bytes, const ReadingChoices& choices);

/// Recognises a log of characters by names or escapes of those that cannot be printed: `<CR>`, `\r`.
bool looks_like_character_log(std::string_view bytes);
Result<LineRecording> read_character_log(std::string_view bytes, const ReadingChoices& choices);

/// Recognises a dump by its rows alone, whose offsets go on from 0: xxd, hexdump, od.
bool looks_like_dump(std::string_view bytes);
Result<LineRecording> read_dump(std::string_view bytes, const ReadingChoices& choices);

Result<LineRecording> read_text_log(std::string_view bytes, const ReadingChoices& choices);

/// Turns frames of a log that are messages of Modbus TCP, with their heads, into frames of a serial line; then a note says
/// so, and other frames are left out.
void read_modbus_tcp(LineRecording& recording);

/// Recognises VCD by the sections of its head.
bool looks_like_vcd(std::string_view bytes);
Result<LineRecording> read_vcd(std::string_view bytes, const ReadingChoices& choices);

/// Recognises any zip; the reader names those of other tools.
bool looks_like_sigrok_session(std::string_view bytes);
Result<LineRecording> read_sigrok_session(std::string_view bytes, const ReadingChoices& choices);

/// Recognises a table of levels by rows that have only levels after the time.
bool looks_like_levels_table(std::string_view bytes);
Result<LineRecording> read_levels_table(std::string_view bytes, const ReadingChoices& choices);

/// Recognises DSView by the names of its columns.
bool looks_like_dsview(std::string_view bytes);
Result<LineRecording> read_dsview(std::string_view bytes, const ReadingChoices& choices);

/// Recognises a table of an oscilloscope by its columns of numbers, and by a unit of voltage or a name of a channel above
/// them.
bool looks_like_volts_table(std::string_view bytes);
Result<LineRecording> read_volts_table(std::string_view bytes, const ReadingChoices& choices);

/// Recognises the samples that sigrok-cli prints by the line about its acquisition; rows of bits are read.
bool looks_like_sigrok_bits(std::string_view bytes);
Result<LineRecording> read_sigrok_bits(std::string_view bytes, const ReadingChoices& choices);

/// Recognises sigrok's annotations by a line of its decoder `uart`.
bool looks_like_sigrok_annotations(std::string_view bytes);
Result<LineRecording> read_sigrok_annotations(std::string_view bytes, const ReadingChoices& choices);

/// Recognises ESPHome by its tag `uart_debug`.
bool looks_like_esphome(std::string_view bytes);
Result<LineRecording> read_esphome(std::string_view bytes, const ReadingChoices& choices);

/// Recognises ESPHome's component `modbus` by its messages.
bool looks_like_esphome_modbus(std::string_view bytes);
Result<LineRecording> read_esphome_modbus(std::string_view bytes, const ReadingChoices& choices);

/// Recognises eModbus by a line with an address and a length before a dump.
bool looks_like_emodbus(std::string_view bytes);
Result<LineRecording> read_emodbus(std::string_view bytes, const ReadingChoices& choices);

/// Recognises Tasmota by SerialSend or SerialReceived with bytes in hex.
bool looks_like_tasmota(std::string_view bytes);
Result<LineRecording> read_tasmota(std::string_view bytes, const ReadingChoices& choices);

/// Recognises strace by a call that reads or writes, with its result.
bool looks_like_strace(std::string_view bytes);
Result<LineRecording> read_strace(std::string_view bytes, const ReadingChoices& choices);

/// Recognises tcpdump by a line about a packet with a row of its bytes below it.
bool looks_like_tcpdump(std::string_view bytes);
Result<LineRecording> read_tcpdump(std::string_view bytes, const ReadingChoices& choices);

/// Recognises tshark by rows of a packet with the head of IP, or by lines about packets alone, which are refused.
bool looks_like_tshark(std::string_view bytes);
Result<LineRecording> read_tshark(std::string_view bytes, const ReadingChoices& choices);

/// Recognises a followed TCP stream by rows of two peers whose offsets go on, by an array of C, or by the keys of its YAML.
bool looks_like_followed_stream(std::string_view bytes);
Result<LineRecording> read_followed_stream(std::string_view bytes, const ReadingChoices& choices);

/// Recognises JSON lines by an object in a line that has bytes.
bool looks_like_json_lines(std::string_view bytes);
Result<LineRecording> read_json_lines(std::string_view bytes, const ReadingChoices& choices);

/// Recognises records of YAML by a row of a list that is a map, or by several documents, with bytes.
bool looks_like_yaml_records(std::string_view bytes);
Result<LineRecording> read_yaml_records(std::string_view bytes, const ReadingChoices& choices);

/// Recognises key-value lines by a line with several pairs, one of which has bytes.
bool looks_like_key_values(std::string_view bytes);
Result<LineRecording> read_key_values(std::string_view bytes, const ReadingChoices& choices);

/// Recognises pyserial's spy by a row with seconds, TX or RX, and an offset.
bool looks_like_pyserial(std::string_view bytes);
Result<LineRecording> read_pyserial(std::string_view bytes, const ReadingChoices& choices);

/// Recognises bytes as Python shows them.
bool looks_like_python_bytes(std::string_view bytes);
Result<LineRecording> read_python_bytes(std::string_view bytes, const ReadingChoices& choices);

}  // namespace s7200::tools
