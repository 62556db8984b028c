// What is put on the line and done to it, as people write it, and what is said of it then.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "interpreter/base/result.hpp"
#include "serial_sim/peers/requester.hpp"
#include "tools/session/past/actions/action.hpp"

namespace s7200::tools {

inline constexpr std::string_view kNoRoomForMaster =
    "this line has as many stations already as it takes: there is no place for one more master";

/// A frame as the master on the line of a station sends it, now. Trouble if that cannot be.
Result<SendFrame> send_of(const serial::Frame& frame, serial::Simulation& simulation, const serial::MasterSettings& master);

/// `on the line from now on: 41 42  'AB' (9600 baud, …)`; a line more if the program will not hear it.
std::string sent_text(const SendFrame& send, const serial::Simulation& simulation);

/// Gives up the request of the master on the line of a station, now. Trouble if it has none.
Result<CancelRequest> cancel_of(serial::Simulation& simulation);

/// `given up while it waited for the answer, 12 ms after its end: 41 42`, in front of that; a line more if the master is not
/// ready for the next request at once.
std::string cancelled_text(const CancelRequest& cancel, const serial::Simulation& simulation);

/// `flip:character=3,bit=5`, or `none`. Trouble if it is not a fault.
Result<InjectFault> inject_of(const std::string& text);

/// `on the line from now on: flip:character=3,bit=5`, and a line that describes it.
std::string injected_text(const InjectFault& inject);

}  // namespace s7200::tools
