// What a CPU does for its programming devices, panels and other masters: the S7 services that PPI carries (facts 10.9; the
// codes are in model/s7_pdu.hpp).
//
// Setup of the communication, read and write of variables, the CPU's identification, RUN and STOP, the upload of blocks
// (s7_blocks.hpp), and as user data, 32 07, the clock, lists of blocks, forced values (forcing.hpp) and outputs in STOP. A
// request with several variables gets a return code for each: FF done, 03 not allowed, 05 outside the area, 06 a type that
// does not go with it, 0A no such area.
//
// Not documented, modelled so:
// - SMB0 to SMB29, analog inputs and high-speed counters cannot be written. [S7Services.WhatIsReadOnlyIsNotWritten]
// - An answer that would be longer than 240 bytes is refused as a whole, with error 85 00. So it is whatever shorter length
//   the setup of the communication has agreed on: PPI has no connection that it could belong to.
//   [S7Services.AnAnswerThatIsTooLongIsRefused, S7Services.TheLengthThatWasAgreedOnIsNotKept]
// - RUN and STOP are allowed in any position of the mode switch, and leave SM0.7 alone. [S7Services.StopAndRunChangeTheMode]
// - The clock is read and set with the services that other S7 CPUs have for it. A time that does not exist is refused like
//   one that is not BCD, with error 87 04. [S7Services.TheClockIsReadAndSet, S7Services.ATimeThatDoesNotExistIsRefused]
// - V memory is data block 1 (facts 10.9), and no other block exists: return code 0A. Other areas have no block, so that
//   number is not looked at. [S7Services.VMemoryIsDataBlockOneAndThereIsNoOther]
// - The answer to forcing repeats the first two bytes of the list, and then has a return code for each variable: 03 for what
//   cannot be forced, and for the seventeenth value of memory. [S7Services.ForcedValuesHold,
//   S7Services.WhatCannotBeForcedIsRefused]
// - Several variables stand before their values, as in a write. Releasing what is not forced is no error.
//   [S7Services.SeveralValuesAreForcedAndReleasedAtOnce]
// - Outputs are set in STOP only, in RUN that is not allowed: 03.
//   [S7Services.OutputsAreSetInStopUntilTheNextChangeOfTheMode]
// Not modelled: download of the program, password, status lists, the modules' data. They are refused with error 81 04.
#pragma once

#include <cstdint>
#include <span>

#include "interpreter/cpu/core.hpp"

namespace s7200::s7_services {

/// Carries out a request that has come to a port, and returns its answer: at most s7::kLongestPdu bytes, none if `request`
/// is not one. `source`: the master's station, for the trace. Belongs into the communication part of the scan. RUN and STOP
/// are left to PpiPort::wanted_mode.
Bytes carry_out(Core& core, std::uint8_t port, std::uint8_t source, std::span<const std::uint8_t> request);

}  // namespace s7200::s7_services
