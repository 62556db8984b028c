// A session with the stations of a system, for tests: commands in, text out.
#pragma once

#include <memory>
#include <string_view>

#include "tests/unit/debugger/session.hpp"
#include "tests/unit/debugger/system_bench.hpp"
#include "tools/rig/event_words.hpp"
#include "tools/session/past/seen_rig.hpp"

namespace s7200::tools {

struct SystemSession : Talk<SystemBench> {
  explicit SystemSession(std::string_view text = kPolled, std::size_t first = kMaster, Time timeout = kSecond) : Talk(text) {
    PromptSettings options{.session = {.files = &files_of_commands()}};
    options.session.master.timeout = timeout;
    for (const PlcPlan& plc : rig->plan().plcs) options.session.stations.push_back({.name = plc.name});
    options.session.station = first;
    for (std::size_t peer = 0; peer < rig->plan().peers.size(); ++peer)
      if (const serial::Poller* const poller = rig->poller(peer))
        options.history.pollers.push_back({rig->plan().peers[peer].name, poller});
    options.history.line_stations = line_stations(*rig);
    for (const PlcPlan& plc : rig->plan().plcs) options.history.plcs.push_back({plc.name, plc.address});
    options.history.planned = event_texts(rig->plan());
    debugger = std::make_unique<Prompt>(stations, out, options);
  }
};

}  // namespace s7200::tools
