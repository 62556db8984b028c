#include "tools/recordings/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ranges>

#include "interpreter/base/text.hpp"
#include "tools/recordings/forms.hpp"

namespace s7200::tools {
namespace {

/// The first that a file looks like is the one that it is read as.
constexpr std::array kForms{
    RecordingForm{"pcap", "pcap of a serial line (link type 147) or of Modbus TCP", looks_like_pcap, read_pcap},
    RecordingForm{"CSV", "CSV with a frame or a character in each row", looks_like_csv, read_csv},
    RecordingForm{"text", "text logs with a frame or a character in each line", is_text, read_text_log},
};

}  // namespace

std::span<const RecordingForm> recording_forms() { return kForms; }

bool is_text(std::string_view bytes) { return bytes.find('\0') == std::string_view::npos; }

std::optional<LineRecording> read_recording(const std::string& file, const ReadingChoices& choices, std::string& why) {
  const std::string bytes(stl::without_byte_order_mark(file));
  const auto form = std::ranges::find_if(kForms, [&](const RecordingForm& each) { return each.looks_like(bytes); });
  if (form == kForms.end()) {
    why = fmt::format("it has none of the forms {}", fmt::join(kForms | std::views::transform(&RecordingForm::name), ", "));
    return {};
  }
  auto recording = form->read(bytes, choices, why);
  if (!recording) return {};
  recording->form = form->name;
  if (recording->frames.empty()) {
    why = "no frame in it";
    for (const std::string& note : recording->notes) why += "; " + note;
    return {};
  }
  return recording;
}

}  // namespace s7200::tools
