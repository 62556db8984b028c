// Any file as a recording of a line, in every protocol: the way of `decode` and `import-capture`. The first byte chooses the
// protocol, the second what the recording leaves open.
//
// Promises: it is read, or refused with a reason. No byte of its frames is lost or read twice, and an answer and its request
// name each other. What is said is text, and a scenario that is made of it can be read again.
#include <algorithm>
#include <cstdint>

#include "interpreter/base/text/text.hpp"
#include "tests/fuzz/promise.hpp"
#include "tools/recordings/decoded.hpp"
#include "tools/recordings/playback.hpp"
#include "tools/scenario/reading/reader.hpp"

namespace {

using namespace s7200;
using namespace s7200::tools;

/// Which bytes a row in doubt has is for the protocol to say: none, or those of one of its readings.
struct BytesRead {
  std::size_t sure = 0, perhaps = 0;
};

BytesRead bytes_of(const LineRecording& recording) {
  BytesRead bytes;
  for (const RecordedFrame& frame : recording.frames) {
    if (!frame.doubt) {
      bytes.sure += frame.bytes.size();
      continue;
    }
    std::size_t most = frame.bytes.size();
    for (const Reading& reading : frame.doubt->readings) most = std::max(most, reading.bytes.size());
    bytes.perhaps += most;
  }
  return bytes;
}

std::size_t bytes_of(const std::vector<ReadFrame>& frames) {
  std::size_t count = 0;
  for (const ReadFrame& each : frames) count += each.frame.doubt ? 0 : each.frame.bytes.size();
  return count;
}

/// Each request has one answer at most, which comes after it.
void look_at_pairs(const std::vector<ReadFrame>& frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto other = frames[i].other;
    if (!other) continue;
    const bool after = frames[i].direction == Direction::Answer ? *other < i : *other > i;
    must(after && *other < frames.size() && frames[*other].other == i, "a frame and its other one disagree",
         frames[i].frame.place);
  }
}

void look_at_texts(const std::vector<ReadFrame>& frames) {
  nlohmann::ordered_json json;
  add_decoded(json, frames);
  must(!json.dump().empty(), "no JSON", "");  // throws if it is not UTF-8
  const std::string text = decoded_text(frames, false);
  must(stl::is_valid_utf8(text), "not UTF-8", text);
}

void look_at_scenario(const std::vector<ReadFrame>& frames, const Stamps& stamps) {
  const Playback played = playback(frames, stamps, {.name = "fuzz", .program = "fuzz.stl", .cpu = "224"});
  if (played.scenario.empty()) return;
  const ScenarioFile file = read_scenarios(played.scenario, "fuzz.yaml");
  must(file.diagnostics.empty() && file.scenarios.size() == 1, "a scenario that cannot be read",
       played.scenario + (file.diagnostics.empty() ? "" : file.diagnostics.front().message));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const auto protocols = recorded_protocols();
  RecordedProtocol protocol = protocols[data[0] % protocols.size()];
  const unsigned choices = data[1];
  if ((choices & 1U) != 0)
    for (const ReaderOption& option : protocol.options) protocol.choose(option.name, option.words.back());
  const Stamps stamps{.character = (choices & 2U) != 0 ? 1'145'833 : 0, .at_end = (choices & 4U) != 0};
  const auto recording =
      read_recording({reinterpret_cast<const char*>(data + 2), size - 2}, {.gap = (choices & 8U) != 0 ? kSecond : 0});
  must(recording.has_value() == recording.why().empty(), "refused without a reason, or read with one", recording.why());
  if (!recording) return 0;
  const std::vector<ReadFrame> frames = conversation(*recording, protocol, stamps);
  const BytesRead bytes = bytes_of(*recording);
  must(bytes.sure <= bytes_of(frames), "bytes were lost", decoded_text(frames, false));
  must(bytes_of(frames) <= bytes.sure + bytes.perhaps, "bytes were read twice", decoded_text(frames, false));
  is_faster_than_said(*recording, stamps);
  look_at_pairs(frames);
  look_at_texts(frames);
  look_at_scenario(frames, stamps);
  return 0;
}
