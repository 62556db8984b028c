// Words for what a PPI port does: the requests of masters, and the jobs of NETR and NETW.
#pragma once

#include <string>
#include <string_view>

#include "interpreter/trace/trace.hpp"

namespace s7200 {

/// The variable of a PpiAccess: `VB100, 4 bytes`; `M3.1`; `VW300`; `T37, 3 in all`; as far as it is known `T37 as 2 bytes`.
std::string variable_text(const TraceRecord& record);

/// `reads`, `writes`, `forces`, `unforces`, `sets in STOP`
std::string_view does_text(PpiVerb verb);

/// What a PpiService asks the CPU for: `asks for RUN`, `reads the clock`.
std::string asked_text(const TraceRecord& record);

/// A PpiService or a PpiAccess as a sentence, and whether the master got what it asked for.
std::string ppi_text(const TraceRecord& record);

/// A frame of a PpiNotModelled, and what becomes of it.
std::string unmodelled_ppi_text(const TraceRecord& record);

/// A NetworkJob: what has become of a job of the CPU as a master.
std::string network_text(const TraceRecord& record);

}  // namespace s7200
