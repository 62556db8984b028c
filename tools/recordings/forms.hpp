// The readers of each form of recording. What they read may have no frame.
#pragma once

#include "tools/recordings/recording.hpp"

namespace s7200::tools {

/// Whether there is no byte 00 in it.
bool is_text(std::string_view bytes);

/// By the first four bytes: pcap in microseconds and nanoseconds, in either order of bytes, and pcapng.
bool looks_like_pcap(std::string_view bytes);
std::optional<LineRecording> read_pcap(const std::string& bytes, const ReadingChoices& choices, std::string& why);

/// Whether a text begins with a row that names its columns.
bool looks_like_csv(std::string_view bytes);
std::optional<LineRecording> read_csv(const std::string& bytes, const ReadingChoices& choices, std::string& why);

std::optional<LineRecording> read_text_log(const std::string& bytes, const ReadingChoices& choices, std::string& why);

}  // namespace s7200::tools
