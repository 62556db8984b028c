// Places and happenings by the words that people use for them: `40`, `SBR 51`, `event 8 occurs`, `error 0006`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "tools/session/past/history.hpp"
#include "tools/session/stops/stop_point.hpp"
#include "tools/views/program/listing.hpp"

namespace s7200::tools {

/// What may follow what a stop is set on.
struct StopOption {
  std::string_view word, takes;
  bool for_places_only = false;
};
inline constexpr StopOption kAlways{"always", "", true};
inline constexpr StopOption kStopOptions[] = {kAlways, {"if", "CONDITION"}, {"hits", "N"}, {"log", "'TEXT'"}};

/// Null: the word is no option.
const StopOption* find_stop_option(std::string_view word);

/// `always, if CONDITION, …`
std::string stop_options_text();

/// Why a stop cannot have an option; empty if it can.
std::string refused_option(const StopOption& option, const StopPoint& stop);

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

/// A line of the program, counted over all its files, that is named by its number in its own file: `12`, of another file
/// than the first `pump.awl:12`. Trouble if no instruction of that file is in it or after it; with nothing to say
/// if the text is not of this form or names no file of the program.
Result<std::uint32_t> find_program_line(std::string_view text, const Program& program, const Listing& listing);

/// `LINE`, `SBR n`, `INT n`, `LBL n`, `NETWORK n`. Trouble if there is no such place; `command` is named in it.
Result<NamedPlace> find_place(const std::vector<std::string>& words, const Program& program, const Listing& listing,
                              std::string_view command);

/// A happening, or a place: `received`, `error 0006`, `event 8 occurs`, `INT 123`. It has no number yet. `note`: as that of
/// the place.
Result<StopPoint> find_stop(const std::vector<std::string>& words, const Program& program, const Listing& listing,
                            std::string& note);

/// `0006`: of a run-time error. Trouble if there is no such error.
Result<std::uint16_t> error_code_of(std::string_view text);

/// The words for places with a number, for completion: `SBR`, `LBL` …
std::vector<std::string> place_words();
/// The numbers that the program has of one of them, in their order.
std::vector<std::string> numbers_of(std::string_view word, const Program& program);

/// The words for happenings, for completion: `received`, `xmt` …
std::vector<std::string_view> happening_words();

/// `answered 01 83 02 c0: wrong CRC`, of a hit of WrongAnswer.
std::string wrong_answer_text(const Hit& hit);

/// Whose request a master that polls has taken for its answer, or who has sent one into it; empty if nobody has.
std::string not_an_answer_text(const History& history, const Hit& hit);

/// Of a condition that has come to hold: `VW0 is 4`, as the simulation stands. Empty of all else.
std::string values_text(const Hit& hit, const Cpu& cpu);

/// `VW20 was 1, is 2`, or `VW20 is 2 as before`, of a hit of a watch.
std::string value_text(const Hit& hit, const Program& program);

/// `breakpoint 2 was passed 3 times without power flow` in the last run, and the same of a condition that could not be
/// computed; empty if it was not.
std::string skipped_text(const StopPoint& stop);
std::string unknown_text(const StopPoint& stop);

/// What may come after the words of `break` or `watch`, for completion.
std::vector<std::string> words_after_break(const std::vector<std::string>& words, const Program& program);
std::vector<std::string> words_after_watch(const std::vector<std::string>& words);

/// The message of a stop, filled in; what has happened has its own time, and an event.
std::string message_text(const StopPoint& stop, const Hit& hit, const Cpu& cpu, Time now);

}  // namespace s7200::tools
