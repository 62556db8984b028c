// The protocols of the Westinghouse PLCs in recordings.
#pragma once

#include <memory>

#include "tools/recordings/conversation.hpp"

namespace s7200::tools {

/// The six-byte messages and their blocks. A block has no address: whoever was addressed last is asked.
std::unique_ptr<FrameReader> block_reader();

/// The same where the check of a block is the XOR of its data.
std::unique_ptr<FrameReader> block_xor_reader();

/// Step after step of the handshake. Its sides take turns, so that a step says whose it is.
std::unique_ptr<FrameReader> pc500_loader_reader();

/// The same of a PLC that does not double a byte 10 in its data.
std::unique_ptr<FrameReader> pc500_loader_plain_dle_reader();

/// With either table of the frame check.
std::unique_ptr<FrameReader> hppc_reader();

}  // namespace s7200::tools
