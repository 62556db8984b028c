#include "tools/command/reading/decode_results.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

#include "interpreter/base/text/wrapped.hpp"
#include "tools/command/terminal/terminal.hpp"

namespace s7200::tools {

using Json = nlohmann::ordered_json;

DecodeResults::DecodeResults(Json head, bool as_json, const ReportOption& report)
    : report_(report),
      head_(std::move(head)),
      as_json_(as_json),
      colour_(!as_json && colour_wanted(stdout)),
      width_(output_width()),
      streamed_(head_, "frames"),
      frames_(Json::array()) {
  if (!as_json_) fmt::print("{}", decoded_heading(colour_));
}

void DecodeResults::add(const ReadFrame& frame, bool unanswered) {
  summary_.add(frame);
  Json json = as_json_ || report_.wanted() ? decoded_json(frame, unanswered) : Json();
  if (as_json_)
    fmt::print("{}", streamed_.entry(json));
  else
    fmt::print("{}", stl::wrapped(decoded_text(frame, unanswered, colour_), width_));
  if (report_.wanted()) frames_.push_back(std::move(json));
}

bool DecodeResults::end() {
  fmt::print("{}", as_json_ ? streamed_.end({{"summary", summary_.json()}}) : summary_.text());
  head_["frames"] = std::move(frames_);
  head_["summary"] = summary_.json();
  return report_.write_conversation(head_);
}

}  // namespace s7200::tools
