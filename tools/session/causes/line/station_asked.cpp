// Was another station asked, and who is that?
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "interpreter/trace/text/statement_text.hpp"
#include "serial_sim/modbus/functions.hpp"
#include "tools/session/causes/expression.hpp"
#include "tools/session/causes/inquiry.hpp"
#include "tools/session/causes/last/last_power_loss.hpp"
#include "tools/session/causes/last/last_stop.hpp"
#include "tools/session/causes/last/last_write.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

/// What a program does with the first character of a frame: a contact that compares it with the number of its station.
struct Compared {
  std::uint32_t op = 0;
  std::uint32_t with = 0;
};

/// Whether the byte has got the first character of the frame: RCV has put it there, or an instruction that reads SMB2.
bool has_first_character(Inquiry& inquiry, const Operand& byte, const TraceReasons::Unanswered& frame, Time second,
                         Time compared) {
  History& history = inquiry.history();
  if (!history.go_to(compared)) return inquiry.answers.interrupted = true, false;
  if (byte.at == sm::kReceivedCharacter) return compared < second;
  const Program& program = inquiry.program();
  const MessageReceiver& message = inquiry.here().cpu().state().port[inquiry.port()].message;
  const bool has_received = message.most > 0;
  if (has_received && message.table + 1 == byte.at) return true;
  const auto range = range_at(byte.at, Width::Byte, *program.model);
  if (!range) return false;
  const WriteSearch search = find_last_write(history, inquiry.station(), *range, inquiry.stop_request());
  inquiry.answers.interrupted |= search.interrupted;
  if (!search.write || !search.write->by || search.write->at < frame.since || search.write->at >= second) return false;
  return std::ranges::any_of(program.ops[search.write->by->op].operand,
                             [](const Operand& one) { return one.at == sm::kReceivedCharacter && !one.pointer; });
}

/// An equality contact of the first character, with another value than it has.
std::optional<Compared> compared_with(Inquiry& inquiry, const TraceReasons::Unanswered& frame, std::uint8_t asked) {
  const Time second = frame.since + 2 * inquiry.here().plc().line_format(inquiry.port()).character_time();
  for (const InstructionRecord& contact : frame.cause->looked_at) {
    const Op& op = inquiry.program().ops[contact.op];
    const std::string_view mnemonic = op.instruction->mnemonic;
    const bool is_equality = mnemonic == "LDB=" || mnemonic == "AB=" || mnemonic == "OB=";
    if (!is_equality || !contact.value[0] || !contact.value[1]) continue;
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
      const std::uint32_t other = *contact.value[1 - side];
      const bool differs = *contact.value[side] == asked && other != asked && other != modbus::kBroadcast;
      if (differs && !op[side].pointer && has_first_character(inquiry, op[side], frame, second, contact.at))
        return Compared{contact.op, other};
    }
  }
  return {};
}

/// The frames that the program has left, or taken without sending anything.
std::vector<TraceReasons::Unanswered> unanswered_frames(const Inquiry& inquiry) {
  std::vector<TraceReasons::Unanswered> frames = inquiry.witness().reasons.taken(inquiry.since());
  for (const Witness::Left& one : inquiry.frames_left()) frames.push_back(one.frame);
  return frames;
}

/// `; slave1 is station 1`, as the system file says; or with what the program compared the first character when it left the
/// frame. Empty if it was asked itself, or if that is not known.
std::string own_address(Inquiry& inquiry, std::uint8_t asked) {
  const History& history = inquiry.history();
  if (const auto known = history.address_of(inquiry.station()))
    return known == asked ? "" : fmt::format("; {} is station {}", history.name_of(inquiry.station()), *known);
  for (const TraceReasons::Unanswered& frame : unanswered_frames(inquiry)) {
    const auto compared = frame.cause ? compared_with(inquiry, frame, asked) : std::nullopt;
    if (compared)
      return fmt::format("; the program compared its first character with {}: {}", compared->with,
                         named_in_sentence(compared->op, inquiry.program()));
  }
  return {};
}

/// `slave2, which had no power from 700.000000 ms on`: when it was asked, as the simulation stands.
std::string state_of(Inquiry& inquiry, std::size_t station) {
  History& history = inquiry.history();
  const serial::Plc& plc = history.station(station).plc();
  const std::string name = history.name_of(station);
  if (const std::string cut = inquiry.witness().line.cut_to(*inquiry.request(), station); !cut.empty())
    return name + "; " + cut;
  const auto since = [&](std::optional<Time> at) {
    return at ? fmt::format("from {} on", moment_text(*at)) : since_oldest_text(history);
  };
  if (!plc.powered()) {
    const PowerLossSearch search = find_last_power_loss(history, station, inquiry.stop_request());
    inquiry.answers.interrupted |= search.interrupted;
    return name + ", which had no power " + since(search.loss ? std::optional(search.loss->at) : std::nullopt);
  }
  if (plc.cpu().state().mode == Mode::Stop)
    return name + ", which was in STOP " + since(find_last_stop(history, station, inquiry.stop_request()));
  return fmt::format("{0}: 'station {0}', then 'why' tells what became of it there", name);
}

bool knows_all_on(const Inquiry& inquiry, std::size_t line) {
  const History& history = inquiry.history();
  for (std::size_t station = 0; station < history.stations(); ++station) {
    const bool known = inquiry.request()->plc() == station || history.address_of(station);
    if (!known && history.requests().port_on(line, station)) return false;
  }
  return true;
}

/// Of the others on the line: `; station 2 is slave2 …`.
std::string who_is(Inquiry& inquiry, std::uint8_t address) {
  History& history = inquiry.history();
  history.go_to(inquiry.request()->end);
  const std::size_t line = history.requests().line_of(inquiry.station(), inquiry.port());
  for (std::size_t station = 0; station < history.stations(); ++station) {
    const bool is_it = station != inquiry.station() && history.address_of(station) == address;
    if (is_it && history.requests().port_on(line, station))
      return fmt::format("; station {} is {}", address, state_of(inquiry, station));
  }
  return knows_all_on(inquiry, line) ? fmt::format("; no S7-200 on this line is station {}", address) : "";
}

}  // namespace

void find_station_asked(Inquiry& inquiry) {
  const std::optional<AskedRequest>& request = inquiry.request();
  if (!request || !(request->unanswered || request->wrong) || request->end == 0) return;
  if (!is_rtu_frame(request->frame)) return;
  const std::uint8_t asked = request->frame.front();
  const std::string own = inquiry.is_by_others() ? own_address(inquiry, asked) : "";
  if (asked == modbus::kBroadcast || (own.empty() && inquiry.is_by_others())) return;
  inquiry.add_first({request->end, fmt::format("the request was for station {}{}{}", asked, own, who_is(inquiry, asked))});
}

}  // namespace s7200::tools
