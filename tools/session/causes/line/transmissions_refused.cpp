// Which XMT that was to answer was refused, and what had the port then?
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/model/errors.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "tools/session/causes/inquiry.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

/// What has kept the port: a message that is being sent or received, or PPI mode.
Keeper what_had_the_port(Inquiry& inquiry, Time at) {
  if (!inquiry.history().go_to(at)) return inquiry.answers.interrupted = true, Keeper{};
  const Freeport& port = inquiry.here().cpu().state().port[inquiry.port()];
  if (!port.active) return {.text = fmt::format("port {} was in PPI mode", inquiry.port())};
  if (port.transmitting) return {.text = "another XMT was still sending"};
  Keeper keeper = inquiry.kept_by_rcv(inquiry.port());
  if (!keeper.text.empty()) keeper.text = "RCV was waiting for " + keeper.text;
  return keeper;
}

}  // namespace

void find_transmissions_refused(Inquiry& inquiry) {
  if (!inquiry.has_unanswered()) return;
  const auto& all = inquiry.witness().refused();
  const auto first =
      std::ranges::find_if(all, [&](const Witness::Refused& one) { return one.at >= inquiry.request()->start; });
  if (first == all.end()) return;
  const Keeper keeper = what_had_the_port(inquiry, first->at);
  inquiry.add(first->at,
              fmt::format("no answer: {} was refused with run-time error {:04X}, {}{}",
                          named_without_comment(first->op, inquiry.program()), first->code, meaning_of(RunError{first->code}),
                          keeper.text.empty() ? "" : ": " + keeper.text),
              keeper);
}

}  // namespace s7200::tools
