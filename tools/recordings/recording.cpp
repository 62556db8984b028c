#include "tools/recordings/recording.hpp"

namespace s7200::tools {
namespace {

/// By the first four bytes: pcap in microseconds and nanoseconds, in either order of bytes, and pcapng.
bool looks_like_pcap(std::string_view bytes) {
  using namespace std::string_view_literals;
  for (const std::string_view magic :
       {"\xA1\xB2\xC3\xD4"sv, "\xD4\xC3\xB2\xA1"sv, "\xA1\xB2\x3C\x4D"sv, "\x4D\x3C\xB2\xA1"sv, "\x0A\x0D\x0D\x0A"sv})
    if (bytes.starts_with(magic)) return true;
  return false;
}

}  // namespace

std::optional<LineRecording> read_recording(const std::string& bytes, const ReadingChoices& choices, std::string& why) {
  std::optional<LineRecording> recording;
  if (looks_like_pcap(bytes))
    recording = read_pcap(bytes, choices, why);
  else if (bytes.find('\0') != std::string::npos)
    why = "neither a pcap file nor text";
  else if (looks_like_csv(bytes))
    recording = read_csv(bytes, choices, why);
  else
    recording = read_text_log(bytes, choices);
  if (recording && recording->frames.empty()) {
    why = "no frame in it";
    for (const std::string& note : recording->notes) why += "; " + note;
    return {};
  }
  return recording;
}

}  // namespace s7200::tools
