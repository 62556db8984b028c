// A decoded conversation as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/recordings/conversation.hpp"

namespace s7200::tools {

/// The numbers of requests by their outcome.
class DecodedSummary {
 public:
  void add(const ReadFrame& frame);

  /// Whether there were frames, and none of them was right.
  bool all_wrong() const { return frames_ > 0 && wrong_ + not_read_ == frames_; }

  /// The summary as text: `requests: 5, answered: 3 after 15.833 ms to 16.833 ms; wrong frames: 1, frames of no request: 0`
  std::string text() const;
  nlohmann::ordered_json json() const;

 private:
  std::size_t frames_ = 0, requests_ = 0, answered_ = 0, need_no_answer_ = 0, wrong_ = 0, strays_ = 0, echoes_ = 0;
  std::size_t not_read_ = 0, may_be_answers_ = 0;
  std::optional<Time> shortest_{}, longest_{};
};

/// The heading, and what is said of a frame: when, the silence before it, who, its bytes, what it says. What is wrong is
/// yellow, and so is a request if it is known that it was not answered.
std::string decoded_heading(bool colour);
std::string decoded_text(const ReadFrame& frame, bool unanswered, bool colour);
nlohmann::ordered_json decoded_json(const ReadFrame& frame, bool unanswered);

/// All frames and a summary, as text.
std::string decoded_text(const std::vector<ReadFrame>& frames, bool colour);

/// Adds the keys `frames` and `summary`.
void add_decoded(nlohmann::ordered_json& results, const std::vector<ReadFrame>& frames);

}  // namespace s7200::tools
