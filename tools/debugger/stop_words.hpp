// Places and happenings by the words that people use for them: `40`, `SBR 51`, `event 8 occurs`, `error 0006`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/debugger/stop_point.hpp"
#include "tools/views/listing.hpp"

namespace s7200::tools {

/// What may follow what a stop is set on.
inline constexpr std::string_view kStopOptions[] = {"always", "if", "hits", "log"};

/// What a watch may wait for.
struct AccessWord {
  std::string_view word;
  StopPoint::On on{};
};
inline constexpr AccessWord kAccesses[] = {{"read write", StopPoint::On::ReadWrite},
                                           {"read", StopPoint::On::Read},
                                           {"write", StopPoint::On::Write},
                                           {"change", StopPoint::On::Change}};

struct NamedPlace {
  std::uint32_t op = 0;
  std::string note{};  ///< what is to be said: the line that was named has no instruction
};

/// `LINE`, `SBR n`, `INT n`, `LBL n`, `NETWORK n`. Nothing, and `why`, if there is no such place; `command` is named in it.
std::optional<NamedPlace> find_place(const std::vector<std::string>& words, const Program& program, const Listing& listing,
                                     std::string_view command, std::string& why);

/// A happening, or a place: `received`, `error 0006`, `event 8 occurs`, `INT 123`. It has no number yet. `note`: as that of
/// the place.
std::optional<StopPoint> find_stop(const std::vector<std::string>& words, const Program& program, const Listing& listing,
                                   std::string& why, std::string& note);

/// `0006`: of a run-time error. Nothing, and `why`, if there is no such error.
std::optional<std::uint16_t> error_code_of(std::string_view text, std::string& why);

/// The words for places with a number, for completion: `SBR`, `LBL` …
std::vector<std::string> place_words();
/// The numbers that the program has of one of them, in their order.
std::vector<std::string> numbers_of(std::string_view word, const Program& program);

/// The words for happenings, for completion: `received`, `xmt` …
std::vector<std::string_view> happening_words();

/// `answered 01 83 02 c0: wrong CRC`, of a hit of WrongAnswer.
std::string wrong_answer_text(const Hit& hit);

/// What may come after the words of `break` or `watch`, for completion.
std::vector<std::string> words_after_break(const std::vector<std::string>& words, const Program& program);
std::vector<std::string> words_after_watch(const std::vector<std::string>& words);

/// The message of a stop, filled in; what has happened has its own time, and an event.
std::string message_text(const StopPoint& stop, const Hit& hit, const Cpu& cpu, Time now);

}  // namespace s7200::tools
