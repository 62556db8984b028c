// The readers of each form of recording. What they read may have no frame.
#pragma once

#include "tools/recordings/recording.hpp"

namespace s7200::tools {

/// Whether there is no byte 00 in it.
bool is_text(std::string_view bytes);

/// By the first four bytes: pcap in microseconds and nanoseconds, in either order of bytes, and pcapng.
bool looks_like_pcap(std::string_view bytes);
std::optional<LineRecording> read_pcap(std::string_view bytes, const ReadingChoices& choices, std::string& why);

/// Whether a text begins with a row that names its columns.
bool looks_like_csv(std::string_view bytes);
std::optional<LineRecording> read_csv(std::string_view bytes, const ReadingChoices& choices, std::string& why);

/// By a line that says it is mbpoll, or one that is a frame in brackets.
bool looks_like_libmodbus(std::string_view bytes);
std::optional<LineRecording> read_libmodbus(std::string_view bytes, const ReadingChoices& choices, std::string& why);

/// The frames of the reads whose values mbpoll printed.
void read_values_of_mbpoll(std::string_view bytes, const ReadingChoices& choices, LineRecording& recording);

/// By a line of its own about bytes that are on their way; those with bytes once more are none of the line.
bool looks_like_pymodbus(std::string_view bytes);
std::optional<LineRecording> read_pymodbus(std::string_view bytes, const ReadingChoices& choices, std::string& why);

std::optional<LineRecording> read_text_log(std::string_view bytes, const ReadingChoices& choices, std::string& why);

/// Frames of a log that are messages of Modbus TCP, with their heads, become frames as on a serial line; then a note says
/// so, and what is no such message is left out.
void read_modbus_tcp(LineRecording& recording);

}  // namespace s7200::tools
