#include "tools/session/causes/writer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/text.hpp"
#include "interpreter/cpu/units/forcing.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "interpreter/trace/text/text_trace.hpp"
#include "tools/session/causes/last/last_attachment.hpp"
#include "tools/session/causes/last/last_write.hpp"
#include "tools/session/past/actions/access.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/views/program/execution_text.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

/// `  by INT 123 line 40 …, serving event 8 (…)  // comment`
std::string by_text(const LastWrite& write, const History& history, const Program& program, const Listing& listing) {
  if (write.by)
    return fmt::format("  by {} {}{}{}{}", listing.routine_of(write.by->op), describe(*write.by, program),
                       write.call ? fmt::format(", as an output of {}", named_in_sentence(*write.call, program)) : "",
                       write.in_interrupt ? fmt::format(", serving {}", event_text(write.event)) : "",
                       remark_on(write.by->op, program));
  return "  by " + changer_text(history, write.action, write.planned);
}

/// `; the data block sets VB290 to VB302`, where that is part of a range; else empty.
std::string data_text(const Program& program, const MemoryRange& range) {
  for (const InitialData& data : program.data) {
    const std::uint32_t first = image::kV + data.offset, end = first + static_cast<std::uint32_t>(data.bytes.size());
    if (range.at < end && first < range.at + range.bytes())
      return fmt::format("; the data block sets VB{} to VB{}", data.offset, data.offset + data.bytes.size() - 1);
  }
  return {};
}

}  // namespace

/// A wider value of which it is a part is named, and each part of it that is forced alone.
ForcedPlace forced_place(const Forcing& forcing, const Bits& bits) {
  ForcedPlace found;
  std::uint64_t count = 0;
  for (const Assignment& forced : forcing::listed(forcing)) {
    const Bits place = bits_of(forced.place);
    if (!place.overlaps(bits)) continue;
    const std::string name = forced.place.name_of(0);
    const std::string what = place == bits          ? "it is forced"
                             : place.contains(bits) ? fmt::format("it is forced with {}", name)
                                                    : fmt::format("{} is forced", name);
    found.text += fmt::format("{}{}; 'unforce {}' releases it", found.text.empty() ? "" : "; ", what, name);
    count += std::min(place.end(), bits.end()) - std::max(place.first, bits.first);
  }
  found.all = count >= bits.count;
  return found;
}

std::string asked_by_text(const History& history, const Asker& asker, const std::string& plc) {
  switch (asker.kind) {
    case Asker::Kind::Send:
      return {};
    case Asker::Kind::Plc:
      return "asked by " + (plc.empty() ? "the program" : stl::printable(plc));
    case Asker::Kind::Bridge:
      return history.bridge_of(asker.number).empty() ? "" : "asked by " + history.name_of(asker);
    case Asker::Kind::Poller:
      break;
  }
  return "asked by " + history.name_of(asker);
}

std::string changer_text(const History& history, std::optional<std::size_t> number, std::optional<std::size_t> planned) {
  const Action* const action = number ? history.action(*number) : nullptr;
  if (action) return fmt::format("'{}', from outside", describe(*action));
  if (planned && *planned < history.planned().size())
    return fmt::format("'{}', in the system file", stl::printable(history.planned()[*planned]));
  return "the system, between two instructions";
}

WriterSearch find_writer(History& history, std::size_t station, const Listing& listing, const MemoryRange& range,
                         std::string_view name, StopToken stop_request) {
  const Program& program = history.station(station).cpu().program();
  const WriteSearch search = find_last_write(history, station, range, stop_request);
  if (search.interrupted) return {.writer = {}, .interrupted = true};
  if (!search.write) {
    const auto now = range.bytes_in(history.station(station).cpu().state().image);
    return {.writer = {},
            .none = fmt::format("nothing has written {} {}; it is {}{}", name, since_oldest_text(history),
                                value_text(program, range, now), data_text(program, range))};
  }
  const LastWrite& write = *search.write;
  return {.writer =
              Writer{.moment = write.moment,
                     .by = write.by,
                     .by_system = !write.by && !write.action && !write.planned,
                     .text = fmt::format("{} was {}, became {}, at {}\n{}", name, value_text(program, range, write.before),
                                         value_text(program, range, write.after), moment_text(write.at),
                                         by_text(write, history, program, listing))}};
}

WriterSearch find_writer(History& history, std::size_t station, const Listing& listing, std::uint8_t event,
                         StopToken stop_request) {
  const Program& program = history.station(station).cpu().program();
  const AttachmentSearch search = find_last_attachment(history, station, event, stop_request);
  if (search.interrupted) return {.writer = {}, .interrupted = true};
  if (!search.attachment)
    return {
        .writer = {},
        .none = fmt::format("no instruction has attached or detached {} {}", event_text(event), since_oldest_text(history))};
  const auto& [moment, what, by] = *search.attachment;
  return {.writer = Writer{.moment = moment,
                           .by = by,
                           .text = fmt::format("{}  {}\n  by {} {}", moment_text(what.at), describe(what, program),
                                               listing.routine_of(by.op), execution_text(by, program))}};
}

}  // namespace s7200::tools
