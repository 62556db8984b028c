// A recording in a text, and what is said in it: for tests of one conversation in many forms.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tools/recordings/conversation.hpp"

namespace s7200::tools::test {

inline LineRecording recording_of(const std::string& bytes) {
  auto recording = read_recording(bytes, {});
  EXPECT_TRUE(recording) << recording.why() << '\n' << bytes;
  return recording.value_or(LineRecording{});
}

inline std::vector<std::string> texts(const std::string& bytes) {
  constexpr Stamps kStamps{.character = 1'145'833};
  std::vector<std::string> said;
  for (const ReadFrame& frame : conversation(recording_of(bytes), *find_recorded_protocol("modbus"), kStamps))
    said.push_back(frame.text);
  return said;
}

inline const std::vector<std::string> kConversation{"station 1, read holding registers 40001, 2 of them",
                                                    "2 registers: 16#000A 16#0014"};

}  // namespace s7200::tools::test
