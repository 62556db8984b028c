// The protocols of the Westinghouse PLCs in recordings, with what is chosen of their options.
#pragma once

#include <memory>

#include "tools/recordings/conversation.hpp"

namespace s7200::tools {

/// The six-byte messages and their blocks. A block has no address: whoever was addressed last is asked.
std::unique_ptr<FrameReader> block_reader(const ChosenWords& chosen);

/// Step after step of the handshake. Its sides take turns, so that a step says whose it is.
std::unique_ptr<FrameReader> pc500_loader_reader(const ChosenWords& chosen);

/// Reads HPPC frames with either table of the frame check.
std::unique_ptr<FrameReader> hppc_reader(const ChosenWords& chosen);

}  // namespace s7200::tools
