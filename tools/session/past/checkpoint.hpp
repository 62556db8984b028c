// A moment of a run with all that it takes to go on from there; and the same as bytes, which every computer and WebAssembly
// read alike.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "serial_sim/system/system.hpp"
#include "tools/session/past/actions/plc_requests.hpp"
#include "tools/session/past/moment.hpp"

namespace s7200::tools {

struct Checkpoint {
  Moment moment;
  serial::System::Snapshot state;
  std::vector<std::uint32_t> ops;  ///< being executed last, by station: an error that comes now names it
  PlcRequests::State requests;
  bool lasts = false;  ///< it stays when checkpoints are thinned
};

/// Whether a state can be packed: no line has a level other than mark, or a disturbance, at or after `now`, nobody sends or
/// receives a character, and there is no station that answers without a PLC, whose memory nothing else knows.
bool can_be_packed(const serial::System::Snapshot& state, Time now);

/// As bytes: numbers of 7 bits a byte, the least first, and of a row of zeros its length. can_be_packed() must hold.
std::string packed(const Checkpoint& checkpoint);

/// A checkpoint of the same system as `like`. Returns nothing if the bytes are damaged, or of another system.
std::optional<Checkpoint> unpacked(std::string_view bytes, const Checkpoint& like);

}  // namespace s7200::tools
