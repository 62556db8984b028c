#include "tools/views/inspection/inspect_views.hpp"

#include <algorithm>
#include <array>

#include "tools/views/inspection/bounds_view.hpp"
#include "tools/views/inspection/calls_view.hpp"
#include "tools/views/inspection/document_view.hpp"
#include "tools/views/inspection/map_view.hpp"
#include "tools/views/inspection/overview_view.hpp"
#include "tools/views/inspection/races_view.hpp"
#include "tools/views/inspection/shared_view.hpp"
#include "tools/views/inspection/steps_view.hpp"
#include "tools/views/inspection/xref_view.hpp"
#include "tools/views/ladder/ladder_view.hpp"

namespace s7200::tools {

std::span<const InspectView> inspect_views() {
  static constexpr std::array kTable{
      InspectView{"overview", "the first look: size, routines, inputs and outputs, what stands out", false, overview_text,
                  overview_json},
      InspectView{"xref", "each address and constant: which instructions read and write it, also through pointers", true,
                  xref_text, xref_json},
      InspectView{"calls", "who calls whom, interrupt routines by event, routines that nothing starts", false, calls_text,
                  calls_json},
      InspectView{"map", "each memory area: used, free, retentive; timers, counters, data block, EEPROM", true, map_text,
                  map_json},
      InspectView{"steps", "the steps of the sequence: what activates each, its transitions, what it does", true, steps_text,
                  steps_json},
      InspectView{"races", "words that the main program and an interrupt share and do not access in one instruction", true,
                  races_text, races_json, nullptr, not_followed_json},
      InspectView{"shared", "memory that the main program and interrupt routines both use: who reads it and who writes it",
                  true, shared_text, shared_json},
      InspectView{"bounds", "how long a scan, a routine and the wait for an interrupt can take at most", false, bounds_text,
                  bounds_json},
      InspectView{"ladder", "the networks as ladder: contacts, coils and boxes; also as SVG", true, ladder_text, ladder_json,
                  ladder_svg},
      InspectView{"document", "all of it as one HTML page to print", false, document_text, document_json},
  };
  return kTable;
}

const InspectView* find_inspect_view(std::string_view name) {
  const auto found = std::ranges::find(inspect_views(), name, &InspectView::name);
  return found == inspect_views().end() ? nullptr : &*found;
}

}  // namespace s7200::tools
